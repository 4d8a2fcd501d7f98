// SPDX-License-Identifier: Apache-2.0
// Sets of effects: their canonical form, effects forced by name, and the plans of debug views.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "effects/features.h"
#include "effects/shader_source.h"
#include "relief/mesh/report.h"
#include "relief/shade/effects.h"
#include "relief/shade/frame_settings.h"
#include "shade/effects/feature_sets.h"
#include "support/invariants.h"
#include "support/labels.h"
#include "support/shapes.h"

namespace relief {
using namespace relief::shade;
using namespace relief::shade::detail;

namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

Features lit() {
    Features f;
    f.directional_lights = 1;
    f.diffuse = true;
    return f;
}

/// With this number of random sets, every triple of values occurs many times.
constexpr std::size_t many = 200000;

bool has_lights(const Features& f) {
    return f.directional_lights + f.point_lights + f.spot_lights > 0;
}

TEST(CanonicalFeatures, AreAFixedPointForEverySet) {
    std::size_t fixed = 0;
    test::for_random_features(many, [&](const Features& f) {
        const Features once = canonical(f);
        if (once == f) ++fixed;
        if (canonical(once) != once) ADD_FAILURE() << describe(f);
    });
    EXPECT_LT(fixed, many / 4);  // Most sets contain effects that cannot show.
}

TEST(CanonicalFeatures, ContainOnlyVisibleFeatures) {
    test::for_random_features(many, [](const Features& f) {
        const Features c = canonical(f);
        const bool uses_lights = c.diffuse || c.specular != SpecularTerm::none;
        const bool reflects = c.reflection != ReflectionTerm::none;
        const bool uses_map = uses_lights || reflects || c.refraction || c.environment_diffuse ||
                              c.sheen || c.transmission || c.environment_tint;
        const bool uses_normal = uses_map || c.clearcoat;
        const bool lit =
            has_lights(c) || c.ambient || c.environment_diffuse || reflects || c.transmission;
        const bool all_around =
            c.ambient || c.environment_diffuse || (c.metallic_roughness && reflects);
        const bool scatters = c.unlit || all_around || c.diffuse || c.transmission;
        const bool sound =
            has_lights(c) == uses_lights && (uses_map || c.detail == NormalDetail::none) &&
            (uses_normal || !c.double_sided) && (has_lights(c) || !c.lights_in_buffer) &&
            (c.point_lights + c.spot_lights > 0 ||
             (!c.light_ranges && c.falloff == FalloffTerm::inverse_square)) &&
            (c.emission || !c.emission_texture) && (all_around || !c.occlusion_texture) &&
            (c.metallic_roughness || (!c.metallic_roughness_texture && !c.dielectric_reflectance &&
                                      !c.energy_compensation && !c.sheen && !c.clearcoat &&
                                      !c.iridescence && !c.transmission)) &&
            (c.transmission || (!c.transmission_texture && !c.volume)) &&
            (c.volume || (!c.thickness_texture && !c.dispersion)) && (lit || !c.iridescence) &&
            (lit || !c.sheen) && (lit || c.emission || !c.clearcoat) &&
            ((c.metallic_roughness && (has_lights(c) || reflects)) || !c.anisotropy) &&
            (has_lights(c) || reflects || c.environment_diffuse || !c.energy_compensation) &&
            (c.dielectric_reflectance ||
             (!c.specular_weight_texture && !c.specular_color_texture)) &&
            (c.sheen || (!c.sheen_color_texture && !c.sheen_roughness_texture)) &&
            (c.anisotropy || !c.anisotropy_texture) &&
            (c.clearcoat || (!c.clearcoat_texture && !c.clearcoat_normal_map)) &&
            ((c.clearcoat && (has_lights(c) || reflects)) || !c.clearcoat_roughness_texture) &&
            (c.interpolation == Interpolation::per_pixel || !c.clearcoat_normal_map) &&
            (c.iridescence || (!c.iridescence_texture && !c.film_thickness_texture)) &&
            (lies_in_frame(c) || c.frame == TangentFrame::stored) &&
            (c.specular != SpecularTerm::none || (!c.specular_texture && !c.highlight_colors)) &&
            (scatters || c.alpha != AlphaMode::opaque ||
             (!c.diffuse_texture && !c.vertex_colors)) &&
            (c.alpha != AlphaMode::opaque || !c.opacity_texture) &&
            (c.interpolation == Interpolation::per_pixel || c.detail == NormalDetail::none) &&
            (reflects || c.fresnel == FresnelTerm::constant) &&
            !(c.metallic_roughness && (c.refraction || c.environment_tint || c.clamped_terms)) &&
            (c.ambient || c.environment_diffuse || uses_lights || !c.environment_tint) &&
            (c.output == OutputCoding::srgb ||
             (c.tone_mapping == ToneMapping::none && !c.exposure)) &&
            !(c.unlit && (has_lights(c) || uses_normal || c.ambient || c.emission)) &&
            c.output == f.output;
        if (!sound) ADD_FAILURE() << describe(f) << " became " << describe(c);
    });
}

TEST(CanonicalFeatures, AddNothing) {
    test::for_random_features(many, [](const Features& f) {
        const Features c = canonical(f);
        for (const test::FeatureField& field : test::feature_fields()) {
            // glTF has only a rough reflection, and many lights need the buffer.
            const bool turned_glossy =
                c.reflection == ReflectionTerm::glossy && f.reflection == ReflectionTerm::mirror;
            const unsigned now = field.get(c);
            if (now != 0 && now != field.get(f) && !turned_glossy) {
                ADD_FAILURE() << describe(f) << " became " << describe(c) << ": " << field.name;
            }
        }
    });
}

TEST(CanonicalFeatures, MetallicRoughnessHasNoPhongFeatures) {
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

TEST(CanonicalFeatures, GouraudHasNoNormalMap) {
    Features f = lit();
    f.interpolation = Interpolation::gouraud;
    f.detail = NormalDetail::bump_map;
    EXPECT_EQ(canonical(f).detail, NormalDetail::none);
    EXPECT_EQ(canonical(f).interpolation, Interpolation::gouraud);
    f.directional_lights = 0;  // Nothing is interpolated, so the program equals the per-pixel one.
    EXPECT_EQ(canonical(f).interpolation, Interpolation::per_pixel);
}

TEST(CanonicalFeatures, WithoutLightHaveNoNormalMap) {
    Features f = lit();
    f.detail = NormalDetail::normal_map;
    EXPECT_EQ(canonical(f).detail, NormalDetail::normal_map);
    f.directional_lights = 0;
    EXPECT_EQ(canonical(f), Features{});
    f.reflection = ReflectionTerm::mirror;  // A reflection shows the normal, too.
    EXPECT_EQ(canonical(f).detail, NormalDetail::normal_map);
}

TEST(CanonicalFeatures, BlackSurfaceHasNoLights) {
    Features f = lit();
    f.diffuse = false;
    f.diffuse_texture = true;
    EXPECT_EQ(canonical(f), Features{});
}

TEST(CanonicalFeatures, PutManyLightsIntoABuffer) {
    Features f = lit();
    f.directional_lights = 512;  // Two rows for each light fill the 1024 rows of a block exactly.
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
    expected.emplace_back("computed tangents");  // This entry follows from the effects.
    EXPECT_EQ(planned, expected);
}

TEST(Effects, AndLightsDistinguishSets) {
    // Two different sets have different effects, counts or codings.
    for (const test::FeatureField& field : test::feature_fields()) {
        for (unsigned value = 1; value < field.count; ++value) {
            Features f;
            field.set(f, value);
            if (f == Features{}) continue;  // The default of the coding.
            EXPECT_NE(describe(f), describe(Features{})) << field.name << ' ' << value;
        }
    }
}

const FrameSettings one_sample{.samples = 1};

/// A square under one directional light. It has a material range for each given Material.
Scene scene_with(const std::vector<Material>& materials) {
    Scene scene;
    scene.materials = materials;
    for (std::uint32_t i = 0; i < materials.size(); ++i) {
        scene.meshes.push_back(test::grid(1));
        scene.meshes.back().edit().name = "plane";
        scene.meshes.back().edit().material_ranges = {{0, 2, i}};
        scene.instances.push_back({i, glm::mat4(1), "node"});
    }
    scene.directional_lights = {{{0, 0, -1}, {1, 1, 1}}};
    return scene;
}

FramePlan forced(const Scene& scene, const EffectRequest& requests,
                 const FrameSettings& settings = one_sample) {
    return force_effects(scene, settings, plan_effects(scene, settings), requests);
}

FramePlan forced(const Scene& scene, const std::vector<ForcedEffect>& list) {
    return forced(scene, EffectRequest{EffectBase::planned, list});
}

std::string refusal(const Scene& scene, const std::vector<ForcedEffect>& list) {
    return test::message_of<InvalidInput>([&] { forced(scene, list); });
}

const EffectReason& reason(const DrawPlan& draw, const char* effect) {
    const auto found = std::find_if(draw.reasons.begin(), draw.reasons.end(),
                                    [&](const EffectReason& r) { return r.effect == effect; });
    if (found == draw.reasons.end()) throw std::runtime_error(effect);
    return *found;
}

TEST(EffectForcing, NoneLeavesThePlanUnchanged) {
    const Scene scene = scene_with({test::gray("body")});
    const FramePlan plan = plan_effects(scene, one_sample);
    EXPECT_EQ(forced(scene, EffectRequest{}).draws[0].features, plan.draws[0].features);
    EXPECT_THAT(effects_in(plan), ElementsAre("directional lights", "diffuse"));
}

TEST(EffectForcing, IgnoresCaseAndSeparatorsOfNames) {
    const Scene scene = scene_with({test::gray("body")});
    const FramePlan with = forced(scene, {{"Normal-Map", true}});
    EXPECT_EQ(with.draws[0].features.detail, NormalDetail::normal_map);
    EXPECT_TRUE(reason(with.draws[0], "normal map").on);
    EXPECT_EQ(reason(with.draws[0], "normal map").reason, "forced on: the scene does not need it");
    EXPECT_TRUE(with.draws[0].needs_tangents);
    EXPECT_EQ(reason(with.draws[0], "computed tangents").reason,
              "a forced effect lies in their frame");

    const FramePlan without = forced(scene, {{"directional_lights", false}});
    EXPECT_EQ(without.draws[0].features, Features{});
    EXPECT_EQ(reason(without.draws[0], "directional lights").reason, "removed");
    EXPECT_EQ(reason(without.draws[0], "diffuse").reason, "no light source reaches the surface");
}

TEST(EffectForcing, FromNoneKeepsTheValuesOfTheScene) {
    Scene scene = scene_with({test::gray("body")});
    scene.directional_lights.resize(3, scene.directional_lights[0]);
    scene.ambient = glm::vec3(0.1F);
    const FramePlan plan = forced(
        scene,
        EffectRequest{EffectBase::nothing, {{"directional lights", true}, {"diffuse", true}}});
    EXPECT_EQ(plan.draws[0].features.directional_lights, 3U);
    EXPECT_FALSE(plan.draws[0].features.ambient);
    EXPECT_EQ(forced(scene, EffectRequest{EffectBase::nothing, {}}).draws[0].features, Features{});
}

TEST(EffectForcing, ReportsDrawsThatCannotShowTheEffect) {
    Scene scene = scene_with({test::gray("body"), test::gray("sign")});
    scene.materials[1].unlit = true;
    const FramePlan plan = forced(scene, {{"emission", true}});
    EXPECT_TRUE(plan.draws[0].features.emission);
    EXPECT_FALSE(plan.draws[1].features.emission);
    EXPECT_EQ(reason(plan.draws[1], "emission").reason,
              "cannot be forced on: the material is unlit");
}

TEST(EffectForcing, ThatNoDrawCanHaveIsRefusedByEffectMaterialAndReason) {
    Scene scene = scene_with({test::gray("body")});
    EXPECT_EQ(refusal(scene, {{"Schlick's Fresnel", true}}),
              "effect 'Schlick's Fresnel' cannot be forced on: material 'body': nothing is "
              "reflected");
    scene.materials[0].interpolation = Interpolation::gouraud;
    EXPECT_EQ(refusal(scene, {{"normal map", true}}),
              "effect 'normal map' cannot be forced on: material 'body': Gouraud shading uses "
              "normals only at vertices");
    scene.materials[0].interpolation = Interpolation::per_pixel;
    scene.materials[0].metallic_roughness = MetallicRoughness{};
    EXPECT_EQ(refusal(scene, {{"Phong highlights", true}}),
              "effect 'Phong highlights' cannot be forced on: material 'body': metallic-roughness "
              "has its own");
}

TEST(EffectForcing, RefusesChoicesOfTheScene) {
    const Scene scene = scene_with({test::gray("body")});
    for (const char* effect : {"unlit", "metallic-roughness", "Gouraud", "flat", "alpha blending",
                               "object-space normal map", "ACES tone mapping"}) {
        EXPECT_THAT(refusal(scene, {{effect, true}}),
                    testing::ContainsRegex("choice|determines|neutral|behind"))
            << effect;
    }
}

TEST(EffectForcing, RefusesReplacements) {
    Scene scene = scene_with({test::gray("body")});
    scene.materials[0].specular = glm::vec3(0.5F);
    EXPECT_EQ(refusal(scene, {{"Phong highlights", true}}),
              "effect 'Phong highlights' cannot be forced on: material 'body': it would replace "
              "'Blinn-Phong highlights'");
    EXPECT_EQ(refusal(scene, {{"normal map", true}, {"bump map", true}}),
              "effects 'normal map' and 'bump map' exclude each other: a surface has one of them "
              "at most");
}

TEST(EffectForcing, SuggestsNamesForUnknownOnes) {
    const Scene scene = scene_with({test::gray("body")});
    EXPECT_EQ(refusal(scene, {{"norml map", true}}),
              "'norml map' is not an effect; did you mean 'normal map'?");
    EXPECT_EQ(refusal(scene, {{"zzz", false}}), "'zzz' is not an effect");
    EXPECT_EQ(refusal(scene, {{"emission", true}, {"Emission", false}}),
              "effect 'emission' is forced both on and off");
}

TEST(EffectForcing, RemovesTheSkyboxAndItsMap) {
    Scene scene = scene_with({test::gray("body")});
    EXPECT_EQ(refusal(scene, {{"skybox", true}}),
              "effect 'skybox' cannot be forced on: the scene does not show its environment");
    scene.environment = Environment{};
    EXPECT_TRUE(plan_effects(scene, one_sample).environment_map);
    const FramePlan plan = forced(scene, {{"skybox", false}});
    EXPECT_FALSE(plan.skybox);
    EXPECT_FALSE(plan.environment_map);
    EXPECT_TRUE(forced(scene, {{"mirror reflection", true}, {"skybox", false}}).environment_map);
    scene.environment->skybox_blur = 0.5F;
    EXPECT_TRUE(plan_effects(scene, one_sample).prefiltered_map);
    const FramePlan sharp = forced(scene, {{"skybox", false}});
    EXPECT_FALSE(sharp.blurred_skybox || sharp.prefiltered_map || sharp.environment_map);
    EXPECT_EQ(refusal(scene, {{"sorted blending", true}}),
              "effect 'sorted blending' cannot be forced on: it follows from the surfaces' effects "
              "and the settings");
}

TEST(EffectForcing, RefusesFinishingPasses) {
    Scene scene = scene_with({test::gray("body")});
    scene.exposure = 2.0F;
    const EffectRequest without{EffectBase::planned, {{"exposure", false}}};
    EXPECT_FALSE(forced(scene, without).draws[0].features.exposure);
    EXPECT_EQ(test::message_of<InvalidInput>([&] { forced(scene, without, {.samples = 4}); }),
              "effect 'exposure' is in the finishing pass, which follows the scene: change the "
              "scene's");
}

TEST_LABELS(not_sanitized);
TEST(ScenesCallingFor, EveryCoveringSetArePlannedWithIt) {
    for (const Features& features : test::covering_features()) {
        const test::CallingScene calling = test::scene_calling_for(features);
        const FramePlan plan = plan_effects(calling.scene, calling.settings);
        EXPECT_EQ(describe(plan.draws[0].features), describe(calling.expected));
        EXPECT_EQ(plan.draws[0].features, calling.expected);
    }
}

TEST_LABELS(not_sanitized);
TEST(EffectForcing, AllIsAFixedPointThatKeepsThePlan) {
    for (const Features& features : test::covering_features()) {
        const test::CallingScene calling = test::scene_calling_for(features);
        const FramePlan plan = plan_effects(calling.scene, calling.settings);
        const EffectRequest all{EffectBase::all_neutral, {}};
        const FramePlan once = force_effects(calling.scene, calling.settings, plan, all);
        const FramePlan twice = force_effects(calling.scene, calling.settings, once, all);
        EXPECT_EQ(twice.draws[0].features, once.draws[0].features) << describe(features);
        const std::vector<std::string> after = effects_in(once);
        for (const std::string& name : effects_in(plan)) {
            if (name == "no falloff") continue;  // Mixed falloff contains both laws.
            EXPECT_THAT(after, Contains(name)) << describe(features);
        }
    }
}

TEST(DebugViews, HaveNamesOfTheirOwnAndAKind) {
    std::set<std::string_view> names;
    for (const DebugViewInfo& info : debug_views()) {
        EXPECT_TRUE(names.insert(info.name).second) << info.name;
        EXPECT_FALSE(info.what.empty());
        EXPECT_EQ(&debug_view_info(info.view), &info);
        const bool counts = info.kind == DebugViewKind::count;
        EXPECT_EQ(is_data(info.view), info.kind == DebugViewKind::data || counts) << info.name;
        EXPECT_EQ(is_term(info.view), info.kind == DebugViewKind::term) << info.name;
    }
    EXPECT_EQ(names.size(), 17U);
}

TEST_LABELS(not_sanitized);
TEST(DebugViews, OfAnyEffectsAreCanonical) {
    std::size_t at = 0;
    test::for_random_features(4000, [&](const Features& random) {
        Features f = random;
        f.view = static_cast<DebugView>(++at %
                                        (static_cast<std::size_t>(DebugView::nothing_to_show) + 1));
        const Features once = canonical(f);
        EXPECT_EQ(canonical(once), once) << describe(f);
        ASSERT_NO_THROW((void)surface_program(once)) << describe(once);
    });
}

TEST(DebugViews, AreNotPartOfThePicturesPrograms) {
    const std::set<std::string> foreign = {"data.frag.glsl", "refraction.glsl#dimming"};
    for (const Features& f : test::covering_features()) {
        ASSERT_EQ(f.view, DebugView::picture);
        const SurfaceProgram program = surface_program(f);
        for (const ShaderSource& source : {program.vertex, program.fragment}) {
            for (const std::string& part : source.parts) {
                EXPECT_FALSE(part.starts_with("view.glsl") || foreign.contains(part))
                    << describe(f) << " holds " << part;
            }
        }
    }
}

TEST(DebugViews, OfDataHaveNoLightAndNoCoding) {
    Features f;
    f.directional_lights = 2;
    f.diffuse = f.diffuse_texture = f.ambient = f.exposure = true;
    f.tone_mapping = ToneMapping::aces;
    f.view = DebugView::texcoords;
    const PlannedInterface planned = planned_interface(canonical(f));
    EXPECT_EQ(planned.attributes, (std::vector<std::string>{"position_object", "texcoord"}));
    EXPECT_EQ(planned.uniforms, (std::vector<std::string>{"clip_from_object"}));
    EXPECT_TRUE(planned.samplers.empty());
}

TEST(DebugViews, KeepMasksAndIgnoreBlending) {
    Features f;
    f.alpha = AlphaMode::mask;
    f.diffuse_texture = true;
    f.view = DebugView::geometric_normal;
    EXPECT_EQ(planned_interface(canonical(f)).samplers,
              (std::vector<std::string>{"diffuse_texture"}));
    f.opacity_texture = true;
    EXPECT_EQ(planned_interface(canonical(f)).samplers,
              (std::vector<std::string>{"diffuse_texture", "opacity_texture"}));
    f.alpha = AlphaMode::blend;
    EXPECT_TRUE(planned_interface(canonical(f)).samplers.empty());
    EXPECT_EQ(canonical(f).alpha, AlphaMode::opaque);
}

/// A square with texture coordinates and one without, with the default material.
Scene two_squares() {
    Scene scene;
    Mesh plain = test::grid(1);
    plain.name = "plain";
    plain.texcoords.clear();
    Mesh mapped = test::grid(1);
    mapped.name = "mapped";
    scene.meshes = {plain, mapped};
    scene.instances = {{0, glm::mat4(1.0F), "a"}, {1, glm::mat4(1.0F), "b"}};
    return scene;
}

FramePlan view_of(const Scene& scene, DebugView view, Report& report) {
    FrameSettings settings;
    settings.view = view;
    return plan_view(scene, settings, plan_effects(scene, settings), report);
}

TEST(PlanView, LeavesThePlanOfAPictureUnchanged) {
    Report report;
    const Scene scene = two_squares();
    const FrameSettings settings;
    const FramePlan plan = plan_effects(scene, settings);
    const FramePlan viewed = plan_view(scene, settings, plan, report);
    ASSERT_EQ(viewed.draws.size(), plan.draws.size());
    for (std::size_t i = 0; i < plan.draws.size(); ++i)
        EXPECT_EQ(viewed.draws[i].features, plan.draws[i].features);
    EXPECT_EQ(viewed.finishing_pass, plan.finishing_pass);
}

TEST(PlanView, HatchesAndCountsSurfacesWithoutTheData) {
    Report report;
    const FramePlan plan = view_of(two_squares(), DebugView::tangent, report);
    EXPECT_EQ(plan.draws[0].features.view, DebugView::nothing_to_show);
    EXPECT_EQ(plan.draws[1].features.view, DebugView::tangent);
    EXPECT_FALSE(plan.draws[0].needs_tangents);
    EXPECT_TRUE(plan.draws[1].needs_tangents);
    EXPECT_FALSE(plan.finishing_pass) << "data is not averaged";
    ASSERT_EQ(report.findings().size(), 1U);
    EXPECT_EQ(report.findings()[0].kind, "surface without what the view shows");
    EXPECT_EQ(report.findings()[0].first, (std::vector<std::size_t>{0}));
}

TEST(PlanView, IsIdempotent) {
    Report report;
    const Scene scene = two_squares();
    FrameSettings settings;
    settings.view = DebugView::tangent;
    const FramePlan once = view_of(scene, DebugView::tangent, report);
    const FramePlan twice = plan_view(scene, settings, once, report);
    for (std::size_t i = 0; i < once.draws.size(); ++i)
        EXPECT_EQ(twice.draws[i].features, once.draws[i].features);
    EXPECT_EQ(report.count("surface without what the view shows"), 1U);
}

TEST(PlanView, ExplainsWhyAViewIsEmpty) {
    Report report;
    Scene scene = two_squares();
    const auto message = [&](DebugView view) {
        return test::message_of<InvalidInput>([&] { (void)view_of(scene, view, report); });
    };
    EXPECT_THAT(message(DebugView::height),
                HasSubstr("height cannot be shown: the default material has no bump map"));
    EXPECT_THAT(message(DebugView::normal_map), HasSubstr("has no normal map and no bump map"));
    EXPECT_THAT(message(DebugView::reflection),
                HasSubstr("reflection cannot be shown: the default material reflects nothing"));
    EXPECT_THAT(message(DebugView::diffuse), HasSubstr("diffuse cannot be shown"));
    EXPECT_THAT(message(DebugView::emission), HasSubstr("emission cannot be shown"));
    EXPECT_THAT(message(DebugView::nothing_to_show), HasSubstr("cannot be requested"));
    scene.meshes[1] = scene.meshes[0];
    EXPECT_THAT(message(DebugView::texcoords),
                HasSubstr("texcoords cannot be shown: mesh 'plain' has no texture coordinates"));
    EXPECT_THAT(message(DebugView::tangent), HasSubstr("no tangent frame"));
}

TEST(PlanView, TermNeedsNoEnvironmentThatOnlyDimsIt) {
    Features f;
    f.reflection = ReflectionTerm::mirror;
    f.refraction = f.ambient = true;
    f.view = DebugView::ambient;
    FramePlan plan;
    plan.draws.push_back({0, {}, canonical(f), {}, false});
    EXPECT_EQ(plan.draws[0].features.reflection, ReflectionTerm::mirror) << "it dims";
    EXPECT_FALSE(environment_needs(plan).any());
    EXPECT_TRUE(planned_interface(plan.draws[0].features).samplers.empty());
    f.view = DebugView::reflection;
    plan.draws[0].features = canonical(f);
    EXPECT_TRUE(environment_needs(plan).sharp);
    EXPECT_FALSE(plan.draws[0].features.refraction);
}

}  // namespace
}  // namespace relief
