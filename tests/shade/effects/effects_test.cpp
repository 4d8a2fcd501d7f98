// SPDX-License-Identifier: Apache-2.0
// canonical() over every set of effects, and by hand.
#include <gtest/gtest.h>

#include "all_features.h"
#include "support/shapes.h"

namespace relief {
namespace {

Features lit() {
    Features f;
    f.directional_lights = 1;
    f.diffuse = true;
    return f;
}

/// Enough random sets that every triple of values meets many times over.
constexpr std::size_t many = 200000;

bool has_lamps(const Features& f) {
    return f.directional_lights + f.point_lights + f.spot_lights > 0;
}

TEST(CanonicalFeatures, AreAFixedPointForEverySet) {
    std::size_t fixed = 0;
    test::for_random_features(many, [&](const Features& f) {
        const Features once = canonical(f);
        if (once == f) ++fixed;
        if (canonical(once) != once) ADD_FAILURE() << describe(f);
    });
    EXPECT_LT(fixed, many / 4);  // Most sets hold something that cannot show.
}

TEST(CanonicalFeatures, HoldNothingThatCannotShow) {
    test::for_random_features(many, [](const Features& f) {
        const Features c = canonical(f);
        const bool uses_lamps = c.diffuse || c.specular != SpecularTerm::none;
        const bool reflects = c.reflection != ReflectionTerm::none;
        const bool uses_normal = uses_lamps || reflects || c.refraction || c.environment_diffuse;
        const bool all_around =
            c.ambient || c.environment_diffuse || (c.metallic_roughness && reflects);
        const bool scatters = c.unlit || all_around || c.diffuse;
        const bool sound =
            has_lamps(c) == uses_lamps && (uses_normal || c.detail == NormalDetail::none) &&
            (uses_normal || !c.double_sided) && (has_lamps(c) || !c.lights_in_buffer) &&
            (c.point_lights + c.spot_lights > 0 ||
             (!c.light_ranges && c.falloff == FalloffTerm::inverse_square)) &&
            (c.emission || !c.emission_texture) && (all_around || !c.occlusion_texture) &&
            (c.metallic_roughness || !c.metallic_roughness_texture) &&
            (c.specular != SpecularTerm::none || (!c.specular_texture && !c.highlight_colors)) &&
            (scatters || c.alpha != AlphaMode::opaque ||
             (!c.diffuse_texture && !c.vertex_colors)) &&
            (c.alpha != AlphaMode::opaque || !c.opacity_texture) &&
            (c.interpolation == Interpolation::per_pixel || c.detail == NormalDetail::none) &&
            (reflects || c.fresnel == FresnelTerm::constant) &&
            !(c.metallic_roughness && c.refraction) &&
            (c.output == OutputCoding::srgb ||
             (c.tone_mapping == ToneMapping::none && !c.exposure)) &&
            !(c.unlit && (has_lamps(c) || uses_normal || c.ambient || c.emission)) &&
            c.output == f.output;
        if (!sound) ADD_FAILURE() << describe(f) << " became " << describe(c);
    });
}

TEST(CanonicalFeatures, AddNothing) {
    test::for_random_features(many, [](const Features& f) {
        const Features c = canonical(f);
        for (const test::FeatureField& field : test::feature_fields()) {
            // A rough reflection is glTF's only one, and many lamps must go to the buffer.
            const bool turned_glossy =
                c.reflection == ReflectionTerm::glossy && f.reflection == ReflectionTerm::mirror;
            const unsigned now = field.get(c);
            if (now != 0 && now != field.get(f) && !turned_glossy) {
                ADD_FAILURE() << describe(f) << " became " << describe(c) << ": " << field.name;
            }
        }
    });
}

TEST(CanonicalFeatures, OfGltfsModelHaveNothingOfPhongs) {
    Features f = lit();
    f.metallic_roughness = true;
    f.specular = SpecularTerm::phong;
    f.reflection = ReflectionTerm::mirror;
    f.fresnel = FresnelTerm::conductor;
    f.refraction = f.highlight_colors = f.specular_texture = true;
    Features expected = lit();
    expected.metallic_roughness = true;
    expected.reflection = ReflectionTerm::glossy;
    EXPECT_EQ(canonical(f), expected);
}

TEST(CanonicalFeatures, OfGouraudShadingHaveNoNormalMap) {
    Features f = lit();
    f.interpolation = Interpolation::gouraud;
    f.detail = NormalDetail::bump_map;
    EXPECT_EQ(canonical(f).detail, NormalDetail::none);
    EXPECT_EQ(canonical(f).interpolation, Interpolation::gouraud);
    f.directional_lights = 0;  // Nothing is interpolated: the same program as per pixel.
    EXPECT_EQ(canonical(f).interpolation, Interpolation::per_pixel);
}

TEST(CanonicalFeatures, WithoutLightHaveNoNormalMap) {
    Features f = lit();
    f.detail = NormalDetail::normal_map;
    EXPECT_EQ(canonical(f).detail, NormalDetail::normal_map);
    f.directional_lights = 0;
    EXPECT_EQ(canonical(f), Features{});
    f.reflection = ReflectionTerm::mirror;  // A reflection shows the normal too.
    EXPECT_EQ(canonical(f).detail, NormalDetail::normal_map);
}

TEST(CanonicalFeatures, OfABlackSurfaceHaveNoLights) {
    Features f = lit();
    f.diffuse = false;
    f.diffuse_texture = true;
    EXPECT_EQ(canonical(f), Features{});
}

TEST(CanonicalFeatures, PutManyLightsIntoABuffer) {
    Features f = lit();
    f.directional_lights = 512;  // Two rows each: exactly the 1024 that a block holds.
    EXPECT_FALSE(canonical(f).lights_in_buffer);
    f.directional_lights = 513;
    EXPECT_TRUE(canonical(f).lights_in_buffer);
}

TEST(Features, AreDescribedInWords) {
    Features f = lit();
    f.point_lights = 2;
    f.specular = SpecularTerm::blinn_phong;
    EXPECT_EQ(describe(f),
              "1 directional light, 2 point lights, diffuse, Blinn-Phong highlights, sRGB");
}

TEST(Effects, AreSetSeenAndTakenOutByName) {
    for (const Effect& effect : effects()) {
        SCOPED_TRACE(effect.name);
        Features f;
        EXPECT_FALSE(effect.on(f));
        effect.set(f, true);
        EXPECT_TRUE(effect.on(f));
        EXPECT_NE(f, Features{});
        effect.set(f, false);
        EXPECT_EQ(f, Features{});
    }
}

TEST(Effects, AreInTheOrderOfThePlansReasons) {
    Scene scene;
    scene.meshes = {test::grid(1)};
    scene.instances = {{0, glm::mat4(1.0F), "grid"}};
    std::vector<std::string> planned;
    const FramePlan plan = plan_effects(scene, {});
    for (const EffectReason& reason : plan.draws.at(0).reasons)
        planned.push_back(reason.effect);
    std::vector<std::string> expected;
    for (const Effect& effect : effects())
        expected.emplace_back(effect.name);
    expected.emplace_back("computed tangents");  // Follows from the effects.
    EXPECT_EQ(planned, expected);
}

TEST(Effects, AndTheLampsTellSetsApart) {
    // Two sets that differ have different effects on, or different counts, or another coding.
    for (const test::FeatureField& field : test::feature_fields()) {
        for (unsigned value = 1; value < field.count; ++value) {
            Features f;
            field.set(f, value);
            if (f == Features{}) continue;  // The coding's own default.
            EXPECT_NE(describe(f), describe(Features{})) << field.name << ' ' << value;
        }
    }
}

}  // namespace
}  // namespace relief
