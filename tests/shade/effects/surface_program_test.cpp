// SPDX-License-Identifier: Apache-2.0
// The table of shader parts: for every canonical set of effects each step has code, and the sources
// are assembled without errors.
#include "effects/surface_program.h"

#include <gtest/gtest.h>

#include <set>

#include "all_features.h"

namespace relief {
namespace {

TEST(SurfaceProgram, ComesTogetherForEveryCanonicalSet) {
    test::for_random_features(5000, [](const Features& f) {
        ASSERT_NO_THROW((void)surface_program(canonical(f))) << describe(f);
    });
}

/// The parts that a stage's steps name and its source does not hold; neutral code is no part.
std::vector<std::string> unused_parts(const ShaderSteps& steps, const ShaderSource& source) {
    const std::set<std::string> parts(source.parts.begin(), source.parts.end());
    std::vector<std::string> unused;
    for (const auto& [step, code] : steps) {
        if (!code.part.empty() && !parts.contains(std::string(code.part)))
            unused.emplace_back(code.part);
    }
    return unused;
}

TEST(SurfaceProgram, ChoosesNoPartThatItDoesNotUse) {
    // These implement a step in every program, used or not: they take nothing from outside.
    const std::set<std::string> idle = {"inputs.glsl#position", "color.glsl#tint",
                                        "metallic_roughness.glsl#factors",
                                        "metallic_roughness.glsl#tint"};
    for (const Features& f : test::covering_features()) {
        const SurfaceProgram program = surface_program(f);
        const ChosenSteps steps = chosen_steps(f);
        for (const auto& [chosen, source] : {std::pair(steps.vertex, program.vertex),
                                             std::pair(steps.fragment, program.fragment)}) {
            for (const std::string& part : unused_parts(chosen, source)) {
                EXPECT_TRUE(idle.contains(part)) << describe(f) << " chooses " << part;
            }
        }
    }
}

TEST(SurfaceProgram, OfADiffuseSurfaceHasNoCodeForAnythingElse) {
    Features f;
    f.directional_lights = 1;
    f.diffuse = true;
    const SurfaceProgram program = surface_program(f);
    for (const char* absent : {"texture(", "sampler", "tangent", "eye_world", "exp(", "pow_",
                               "shininess", "reflect(", "emission_color", "position_world"}) {
        EXPECT_EQ(program.fragment.text.find(absent), std::string::npos) << absent;
        EXPECT_EQ(program.vertex.text.find(absent), std::string::npos) << absent;
    }
}

TEST(SurfaceProgram, HasNeutralCodeForAnAbsentEffect) {
    Features f;
    f.ambient = true;
    EXPECT_EQ(chosen_steps(f).fragment.at("occlusion"),
              (StepCode{.neutral = "float occlusion() { return 1.0; }"}));
    f.occlusion_texture = true;
    EXPECT_EQ(chosen_steps(f).fragment.at("occlusion"),
              (StepCode{.part = "ambient.glsl#occlusion"}));
}

TEST(PlannedInterface, IsKnownByHandForANormalMappedSurface) {
    Features f;
    f.directional_lights = 2;
    f.diffuse = true;
    f.detail = NormalDetail::normal_map;
    const PlannedInterface planned = planned_interface(f);
    using Names = std::vector<std::string>;
    EXPECT_EQ(planned.attributes,
              (Names{"normal_object", "position_object", "tangent_object", "texcoord"}));
    EXPECT_EQ(planned.uniforms,
              (Names{"clip_from_object", "diffuse_color", "handedness", "normal_map_bias",
                     "normal_map_scale", "world_from_object_normal", "world_from_object_tangent"}));
    EXPECT_EQ(planned.samplers, (Names{"normal_texture"}));
    EXPECT_EQ(planned.uniform_blocks, (Names{"Lights"}));
}

TEST(PlannedInterface, OfNothingIsThePositionAlone) {
    const PlannedInterface planned = planned_interface(Features{});
    EXPECT_EQ(planned.attributes, (std::vector<std::string>{"position_object"}));
    EXPECT_EQ(planned.uniforms, (std::vector<std::string>{"clip_from_object"}));
    EXPECT_TRUE(planned.samplers.empty());
    EXPECT_TRUE(planned.uniform_blocks.empty());
}

TEST(CoveringFeatures, MeetEveryPairThatCanMeet) {
    const std::vector<Features> covering = test::covering_features();
    EXPECT_GE(covering.size(), 16U);  // Two fields of four values.
    EXPECT_LE(covering.size(), 200U);
    const auto met = [&](const auto& condition) {
        return std::any_of(covering.begin(), covering.end(), condition);
    };
    // Pairs by hand that a careless choice would miss.
    EXPECT_TRUE(met(
        [](const Features& f) { return f.lights_in_buffer && f.specular == SpecularTerm::phong; }));
    EXPECT_TRUE(met([](const Features& f) {
        return f.interpolation == Interpolation::gouraud && f.fresnel == FresnelTerm::conductor;
    }));
    EXPECT_TRUE(met([](const Features& f) {
        return f.metallic_roughness && f.frame == TangentFrame::derivatives;
    }));
    EXPECT_TRUE(met([](const Features& f) {
        return f.alpha == AlphaMode::mask && f.detail == NormalDetail::bump_map;
    }));
}

}  // namespace
}  // namespace relief
