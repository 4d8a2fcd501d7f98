// SPDX-License-Identifier: Apache-2.0
// Effects forced by name, without OpenGL: what a plan becomes, what its reasons say, and what is
// refused with which words.
#include "relief/shade/effect_forcing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "all_features.h"
#include "relief/mesh/error.h"
#include "scene_calling_for.h"
#include "support/message_of.h"
#include "support/shapes.h"

namespace relief {
namespace {

using testing::Contains;
using testing::ElementsAre;

const FrameSettings one_sample{.samples = 1};

/// A square under one directional light; every Material given is the range of one of its copies.
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

Material named(const char* name) {
    Material material;
    material.name = name;
    return material;
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

TEST(EffectForcing, OfNothingLeavesThePlanAsItIs) {
    const Scene scene = scene_with({named("body")});
    const FramePlan plan = plan_effects(scene, one_sample);
    EXPECT_EQ(forced(scene, EffectRequest{}).draws[0].features, plan.draws[0].features);
    EXPECT_THAT(effects_in(plan), ElementsAre("directional lights", "diffuse"));
}

TEST(EffectForcing, PutsAnEffectInAndTakesItOutWhateverItsNamesCaseAndSeparators) {
    const Scene scene = scene_with({named("body")});
    const FramePlan with = forced(scene, {{"Normal-Map", true}});
    EXPECT_EQ(with.draws[0].features.detail, NormalDetail::normal_map);
    EXPECT_TRUE(reason(with.draws[0], "normal map").on);
    EXPECT_EQ(reason(with.draws[0], "normal map").reason,
              "forced on: the scene does not call for it");
    EXPECT_TRUE(with.draws[0].needs_tangents);
    EXPECT_EQ(reason(with.draws[0], "computed tangents").reason,
              "a forced normal map lies in their frame");

    const FramePlan without = forced(scene, {{"directional_lights", false}});
    EXPECT_EQ(without.draws[0].features, Features{});
    EXPECT_EQ(reason(without.draws[0], "directional lights").reason, "taken out");
    EXPECT_EQ(reason(without.draws[0], "diffuse").reason, "no light source reaches the surface");
}

TEST(EffectForcing, FromNothingKeepsWhatTheSceneHasOfThoseForcedOn) {
    Scene scene = scene_with({named("body")});
    scene.directional_lights.resize(3, scene.directional_lights[0]);
    scene.ambient = glm::vec3(0.1F);
    const FramePlan plan = forced(
        scene,
        EffectRequest{EffectBase::nothing, {{"directional lights", true}, {"diffuse", true}}});
    EXPECT_EQ(plan.draws[0].features.directional_lights, 3U);
    EXPECT_FALSE(plan.draws[0].features.ambient);
    EXPECT_EQ(forced(scene, EffectRequest{EffectBase::nothing, {}}).draws[0].features, Features{});
}

TEST(EffectForcing, ShowsWhereverItCanAndSaysWhereNot) {
    Scene scene = scene_with({named("body"), named("sign")});
    scene.materials[1].unlit = true;
    const FramePlan plan = forced(scene, {{"emission", true}});
    EXPECT_TRUE(plan.draws[0].features.emission);
    EXPECT_FALSE(plan.draws[1].features.emission);
    EXPECT_EQ(reason(plan.draws[1], "emission").reason,
              "cannot be forced on: the material is unlit");
}

TEST(EffectForcing, ThatNoDrawCanHaveIsRefusedByEffectMaterialAndReason) {
    Scene scene = scene_with({named("body")});
    EXPECT_EQ(refusal(scene, {{"Schlick's Fresnel", true}}),
              "effect 'Schlick's Fresnel' cannot be forced on: material 'body': nothing is "
              "reflected");
    scene.materials[0].interpolation = Interpolation::gouraud;
    EXPECT_EQ(refusal(scene, {{"normal map", true}}),
              "effect 'normal map' cannot be forced on: material 'body': Gouraud shading knows the "
              "normal at vertices only");
    scene.materials[0].interpolation = Interpolation::per_pixel;
    scene.materials[0].metallic_roughness = MetallicRoughness{};
    EXPECT_EQ(refusal(scene, {{"Phong highlights", true}}),
              "effect 'Phong highlights' cannot be forced on: material 'body': metallic-roughness "
              "has its own");
}

TEST(EffectForcing, OfAChoiceOfTheSceneIsRefused) {
    const Scene scene = scene_with({named("body")});
    for (const char* effect : {"unlit", "metallic-roughness", "Gouraud", "flat", "alpha blending",
                               "object-space normal map", "ACES tone mapping"}) {
        EXPECT_THAT(refusal(scene, {{effect, true}}),
                    testing::ContainsRegex("choice|neutral|behind"))
            << effect;
    }
}

TEST(EffectForcing, InThePlaceOfAnotherIsRefused) {
    Scene scene = scene_with({named("body")});
    scene.materials[0].specular = glm::vec3(0.5F);
    EXPECT_EQ(refusal(scene, {{"Phong highlights", true}}),
              "effect 'Phong highlights' cannot be forced on: material 'body': it would take the "
              "place of 'Blinn-Phong highlights'");
    EXPECT_EQ(refusal(scene, {{"normal map", true}, {"bump map", true}}),
              "effects 'normal map' and 'bump map' exclude each other: a surface has one of them "
              "at most");
}

TEST(EffectForcing, OfAnUnknownNameSuggestsNearOnes) {
    const Scene scene = scene_with({named("body")});
    EXPECT_EQ(refusal(scene, {{"norml map", true}}),
              "'norml map' is no effect; did you mean 'normal map'?");
    EXPECT_EQ(refusal(scene, {{"zzz", false}}), "'zzz' is no effect");
    EXPECT_EQ(refusal(scene, {{"emission", true}, {"Emission", false}}),
              "effect 'emission' is forced both on and off");
}

TEST(EffectForcing, OfTheFrameTakesOutTheSkyboxAndItsMap) {
    Scene scene = scene_with({named("body")});
    EXPECT_EQ(refusal(scene, {{"skybox", true}}),
              "effect 'skybox' cannot be forced on: the scene does not show its environment");
    scene.environment = Environment{};
    EXPECT_TRUE(plan_effects(scene, one_sample).environment_map);
    const FramePlan plan = forced(scene, {{"skybox", false}});
    EXPECT_FALSE(plan.skybox);
    EXPECT_FALSE(plan.environment_map);
    EXPECT_TRUE(forced(scene, {{"mirror reflection", true}, {"skybox", false}}).environment_map);
    EXPECT_EQ(refusal(scene, {{"sorted blending", true}}),
              "effect 'sorted blending' cannot be forced on: it follows from the surfaces' effects "
              "and the settings");
}

TEST(EffectForcing, OfAFinishingPassIsRefused) {
    Scene scene = scene_with({named("body")});
    scene.exposure = 2.0F;
    const EffectRequest without{EffectBase::planned, {{"exposure", false}}};
    EXPECT_FALSE(forced(scene, without).draws[0].features.exposure);
    EXPECT_EQ(test::message_of<InvalidInput>([&] { forced(scene, without, {.samples = 4}); }),
              "effect 'exposure' is in the finishing pass, which follows the scene: change the "
              "scene's");
}

TEST(ScenesCallingFor, EveryCoveringSetArePlannedWithIt) {
    for (const Features& features : test::covering_features()) {
        const test::CallingScene calling = test::scene_calling_for(features);
        const FramePlan plan = plan_effects(calling.scene, calling.settings);
        EXPECT_EQ(describe(plan.draws[0].features), describe(calling.expected));
        EXPECT_EQ(plan.draws[0].features, calling.expected);
    }
}

TEST(EffectForcing, OfAllThatIsNeutralIsAFixedPointAndKeepsWhatIsPlanned) {
    for (const Features& features : test::covering_features()) {
        const test::CallingScene calling = test::scene_calling_for(features);
        const FramePlan plan = plan_effects(calling.scene, calling.settings);
        const EffectRequest all{EffectBase::all_neutral, {}};
        const FramePlan once = force_effects(calling.scene, calling.settings, plan, all);
        const FramePlan twice = force_effects(calling.scene, calling.settings, once, all);
        EXPECT_EQ(twice.draws[0].features, once.draws[0].features) << describe(features);
        const std::vector<std::string> after = effects_in(once);
        for (const std::string& name : effects_in(plan)) {
            if (name == "no falloff") continue;  // Mixed falloff is both laws.
            EXPECT_THAT(after, Contains(name)) << describe(features);
        }
    }
}

}  // namespace
}  // namespace relief
