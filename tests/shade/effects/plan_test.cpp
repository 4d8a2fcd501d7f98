// SPDX-License-Identifier: Apache-2.0
// The planner's decisions and their reasons on single scenes, without OpenGL.
#include <gtest/gtest.h>

#include <algorithm>

#include "relief/shade/effects.h"
#include "shade/effects/feature_sets.h"
#include "support/shapes.h"

namespace relief {
using namespace relief::shade;

namespace {

using test::gray;
using test::lit_scene;
using test::reason;

Features features(const Scene& scene) {
    return plan_effects(scene, {.samples = 1}).draws.at(0).features;
}

TEST(EffectPlan, GraySurfaceHasOnlyDiffuseLight) {
    Features expected;
    expected.directional_lights = 1;
    expected.diffuse = true;
    EXPECT_EQ(features(lit_scene(gray())), expected);
}

TEST(EffectPlan, IsEmptyWithoutLight) {
    Scene scene = lit_scene(gray());
    scene.directional_lights.clear();
    scene.materials[0].normal_map = NormalMap{};
    EXPECT_EQ(features(scene), Features{});
    const FramePlan plan = plan_effects(scene, {.samples = 1});
    EXPECT_EQ(reason(plan.draws[0].reasons, "diffuse").reason,
              "no light source reaches the surface");
    EXPECT_EQ(reason(plan.draws[0].reasons, "normal map").reason,
              "neither light nor reflection shows the normal");
    EXPECT_FALSE(plan.draws[0].needs_tangents);
}

TEST(EffectPlan, LeavesBlackLightsOut) {
    Scene scene = lit_scene(gray());
    scene.directional_lights.push_back({{0, -1, 0}, {0, 0, 0}});
    scene.point_lights.push_back({{0, 0, 1}, {0, 0, 0}, 3.0F});
    EXPECT_EQ(features(scene), features(lit_scene(gray())));
    const FramePlan plan = plan_effects(scene, {.samples = 1});
    EXPECT_EQ(reason(plan.draws[0].reasons, "directional lights").reason,
              "the scene has 2, 1 of them black or off");
    EXPECT_FALSE(reason(plan.draws[0].reasons, "point lights").on);
}

TEST(EffectPlan, NeedsTextureCoordinatesForTextures) {
    Scene scene = lit_scene(gray());
    scene.images = {{"image", Image{}}};
    scene.materials[0].diffuse_texture = Texture{};
    scene.materials[0].normal_map = NormalMap{};
    EXPECT_TRUE(features(scene).diffuse_texture);
    EXPECT_EQ(features(scene).detail, NormalDetail::normal_map);
    FramePlan plan = plan_effects(scene, {.samples = 1});
    EXPECT_EQ(reason(plan.draws[0].reasons, "normal map").reason,
              "material 'body' has one and the mesh has texture coordinates");
    EXPECT_TRUE(plan.draws[0].needs_tangents);

    scene.meshes[0].edit().texcoords.clear();
    EXPECT_FALSE(features(scene).diffuse_texture);
    EXPECT_EQ(features(scene).detail, NormalDetail::none);
    plan = plan_effects(scene, {.samples = 1});
    EXPECT_EQ(reason(plan.draws[0].reasons, "normal map").reason,
              "material 'body' has one, but mesh 'plane' has no texture coordinates");
}

TEST(EffectPlan, ComputesOnlyMissingTangents) {
    Scene scene = lit_scene(gray());
    scene.materials[0].normal_map = NormalMap{};
    scene.meshes[0].edit().tangents.assign(4, glm::vec4(1, 0, 0, 1));
    const FramePlan plan = plan_effects(scene, {.samples = 1});
    EXPECT_EQ(plan.draws[0].features.detail, NormalDetail::normal_map);
    EXPECT_FALSE(plan.draws[0].needs_tangents);
    EXPECT_EQ(reason(plan.draws[0].reasons, "computed tangents").reason,
              "mesh 'plane' has its own");
}

TEST(EffectPlan, UsesOnlyVertexColorsThatTint) {
    Scene scene = lit_scene(gray());
    scene.meshes[0].edit().colors.assign(4, glm::vec4(1, 1, 1, 0.5F));
    EXPECT_FALSE(features(scene).vertex_colors);
    scene.meshes[0].edit().colors[2] = glm::vec4(1, 0.5F, 1, 1);
    EXPECT_TRUE(features(scene).vertex_colors);
}

TEST(EffectPlan, HasAmbientLightOnlyIfChannelsOverlap) {
    Scene scene = lit_scene(gray());
    scene.ambient = {0.2F, 0, 0};
    EXPECT_TRUE(features(scene).ambient);
    scene.materials[0].ambient = {0, 1, 1};
    EXPECT_FALSE(features(scene).ambient);
}

TEST(EffectPlan, UnlitMaterialHasOnlyColors) {
    Material material = gray();
    material.unlit = true;
    material.specular = {1, 1, 1};
    material.emission = {1, 0, 0};
    material.diffuse_texture = Texture{};
    Scene scene = lit_scene(material);
    scene.ambient = {1, 1, 1};
    Features expected;
    expected.unlit = true;
    expected.diffuse_texture = true;
    EXPECT_EQ(features(scene), expected);
    EXPECT_EQ(reason(plan_effects(scene, {.samples = 1}).draws[0].reasons, "emission").reason,
              "the material is unlit");
}

TEST(EffectPlan, ReflectsOnlyWithAnEnvironmentAndReflectivity) {
    Material mirror = gray();
    mirror.reflectivity = {0, 0, 0.5F};
    Scene scene = lit_scene(mirror);
    EXPECT_EQ(features(scene).reflection, ReflectionTerm::none);
    scene.environment = Environment{Equirectangular{}, 1.0F, false};
    FramePlan plan = plan_effects(scene, {.samples = 1});
    EXPECT_EQ(plan.draws[0].features.reflection, ReflectionTerm::mirror);
    EXPECT_EQ(plan.draws[0].features.fresnel, FresnelTerm::schlick);
    EXPECT_TRUE(plan.environment_map);
    EXPECT_FALSE(plan.skybox);
    EXPECT_EQ(reason(plan.reasons, "environment map").reason, "a material shows it without blur");

    scene.materials[0].reflectivity = {0, 0, 0};
    plan = plan_effects(scene, {.samples = 1});
    EXPECT_FALSE(plan.environment_map);
    EXPECT_EQ(reason(plan.reasons, "environment map").reason, "nothing shows it");
}

TEST(EffectPlan, ShowsTheSkyboxOnRequest) {
    Scene scene = lit_scene(gray());
    scene.environment = Environment{Equirectangular{}, 1.0F, true};
    const FramePlan plan = plan_effects(scene, {.samples = 1});
    EXPECT_TRUE(plan.skybox);
    EXPECT_TRUE(plan.environment_map);
    EXPECT_EQ(reason(plan.reasons, "environment map").reason, "the effects above are made from it");
}

TEST(EffectPlan, KnowsHighlightsAndRanges) {
    Material shiny = gray();
    shiny.specular = {0.5F, 0.5F, 0.5F};
    Scene scene = lit_scene(shiny);
    EXPECT_EQ(features(scene).specular, SpecularTerm::blinn_phong);
    scene.materials[0].specular_model = SpecularModel::phong;
    EXPECT_EQ(features(scene).specular, SpecularTerm::phong);
    scene.point_lights = {{{0, 0, 1}, {1, 1, 1}, std::nullopt}};
    EXPECT_FALSE(features(scene).light_ranges);
    scene.point_lights[0].range = 5.0F;
    EXPECT_TRUE(features(scene).light_ranges);
}

TEST(EffectPlan, HasOneDrawForEachRangeOfEachInstance) {
    Scene scene = lit_scene(gray("first"));
    Material second = gray("second");
    second.specular = {1, 1, 1};
    scene.materials.push_back(second);
    scene.meshes[0].edit().material_ranges = {{0, 1, 1}, {1, 1, std::nullopt}};
    scene.instances.push_back({0, glm::mat4(2), "again"});
    const FramePlan plan = plan_effects(scene, {.samples = 1, .output = OutputCoding::linear});
    ASSERT_EQ(plan.draws.size(), 4U);
    EXPECT_EQ(plan.draws[0].features.specular, SpecularTerm::blinn_phong);
    EXPECT_EQ(plan.draws[1].features.specular, SpecularTerm::none);  // The default material.
    EXPECT_EQ(plan.draws[3].instance, 1U);
    EXPECT_EQ(plan.draws[3].range, (MaterialRange{1, 1, std::nullopt}));
    EXPECT_EQ(plan.draws[0].features.output, OutputCoding::linear);
}

TEST(EffectPlan, DrawsThatAreAlikeShareTheirReasons) {
    Scene scene = lit_scene(gray());
    scene.instances.resize(3, scene.instances.at(0));
    scene.instances[2].open_shares =
        std::vector<float>(scene.meshes[0]->positions.size(), 0.5F);  // It has another plan.
    FramePlan plan = plan_effects(scene, {.samples = 1});
    EXPECT_EQ(&*plan.draws.at(0).reasons, &*plan.draws.at(1).reasons);
    EXPECT_NE(&*plan.draws[0].reasons, &*plan.draws.at(2).reasons);

    const std::vector<EffectReason>* const planned = &*plan.draws[0].reasons;
    plan = force_effects(scene, {.samples = 1}, std::move(plan),
                         {EffectBase::planned, {{"diffuse", false}}});
    EXPECT_NE(&*plan.draws[0].reasons, planned);
    EXPECT_EQ(&*plan.draws[0].reasons, &*plan.draws[1].reasons);
    EXPECT_NE(&*plan.draws[0].reasons, &*plan.draws[2].reasons);
    EXPECT_EQ(reason(plan.draws[1].reasons, "diffuse").reason, "removed");
    EXPECT_EQ(plan.draws[1].instance, 1U);
}

TEST(EffectPlan, MeshesWithEqualReasonsShareThem) {
    Scene scene = lit_scene(gray());
    scene.meshes.push_back(scene.meshes[0]);
    scene.meshes[1].edit().name = "another";  // No reason names a mesh that has nothing special.
    scene.instances.push_back(scene.instances[0]);
    scene.instances[1].mesh = 1;
    FramePlan plan = plan_effects(scene, {.samples = 1});
    EXPECT_EQ(&*plan.draws.at(0).reasons, &*plan.draws.at(1).reasons);

    scene.meshes[1].edit().colors.assign(scene.meshes[1]->positions.size(), glm::vec4(0.5F));
    plan = plan_effects(scene, {.samples = 1});
    EXPECT_NE(&*plan.draws[0].reasons, &*plan.draws[1].reasons);
    EXPECT_FALSE(reason(plan.draws[0].reasons, "vertex colors").on);
    EXPECT_TRUE(reason(plan.draws[1].reasons, "vertex colors").on);
}

TEST(EffectPlan, ExplainsEveryEffect) {
    const FramePlan plan = plan_effects(lit_scene(gray()), {.samples = 1});
    // There is a reason for every effect, and one for computed tangents.
    EXPECT_EQ(plan.draws[0].reasons.size(), effects().size() + 1);
    for (const Effect& effect : effects())
        EXPECT_NO_THROW((void)reason(plan.draws[0].reasons, effect.name));
    for (const EffectReason& r : plan.draws[0].reasons)
        EXPECT_FALSE(r.reason.empty()) << r.effect;
    const auto on = std::count_if(plan.draws[0].reasons.begin(), plan.draws[0].reasons.end(),
                                  [](const EffectReason& r) { return r.on; });
    EXPECT_EQ(on, 2);  // Directional lights and diffuse reflection.
}

Material metallic() {
    Material material = gray("metal");
    material.metallic_roughness = MetallicRoughness{};
    return material;
}

TEST(EffectPlan, MetallicRoughnessNeedsTheBlurredEnvironmentAndItsTable) {
    Scene scene = lit_scene(metallic());
    scene.environment = Environment{Equirectangular{}, 1.0F, false, true};
    const FramePlan plan = plan_effects(scene, {.samples = 1});
    const Features& f = plan.draws[0].features;
    EXPECT_TRUE(f.metallic_roughness);
    EXPECT_EQ(f.reflection, ReflectionTerm::glossy);
    EXPECT_EQ(f.fresnel, FresnelTerm::constant);
    EXPECT_TRUE(f.environment_diffuse);
    EXPECT_TRUE(plan.prefiltered_map);
    EXPECT_TRUE(plan.environment_brdf);
    EXPECT_TRUE(plan.environment_irradiance);
    EXPECT_EQ(reason(plan.draws[0].reasons, "Schlick's Fresnel").reason,
              "material 'metal' has its own model's");
}

TEST(EffectPlan, MirrorNeedsNoBlur) {
    Material mirror = gray();
    mirror.reflectivity = glm::vec3(0.5F);
    Scene scene = lit_scene(mirror);
    scene.environment = Environment{Equirectangular{}, 1.0F, false};
    FramePlan plan = plan_effects(scene, {.samples = 1});
    EXPECT_FALSE(plan.prefiltered_map);
    EXPECT_FALSE(plan.environment_brdf);
    EXPECT_FALSE(plan.environment_irradiance);
    scene.materials[0].reflection_roughness = 0.3F;
    plan = plan_effects(scene, {.samples = 1});
    EXPECT_TRUE(plan.prefiltered_map);
    EXPECT_FALSE(plan.environment_brdf);  // Phong surfaces use Fresnel's factor instead.
}

TEST(EffectPlan, HasNoFresnelForConstantReflectivity) {
    Material mirror = gray();
    mirror.reflectivity = mirror.grazing_reflectivity = glm::vec3(1.0F);
    Scene scene = lit_scene(mirror);
    scene.environment = Environment{Equirectangular{}, 1.0F, false};
    EXPECT_EQ(features(scene).fresnel, FresnelTerm::constant);
    EXPECT_EQ(
        reason(plan_effects(scene, {.samples = 1}).draws[0].reasons, "Schlick's Fresnel").reason,
        "reflectivity is the same at every angle");
    scene.materials[0].fresnel = FresnelModel::conductor;
    EXPECT_EQ(features(scene).fresnel, FresnelTerm::conductor);
    scene.materials[0].transmission = 0.5F;
    EXPECT_TRUE(features(scene).refraction);
    scene.materials[0].reflectivity = glm::vec3(0.0F);
    EXPECT_TRUE(features(scene).refraction);  // A surface without reflection can be transparent.
    EXPECT_EQ(features(scene).reflection, ReflectionTerm::none);
    scene.environment.reset();
    EXPECT_FALSE(features(scene).refraction);
}

TEST(EffectPlan, GouraudAndFlatShadingHaveNoNormalMap) {
    Material mapped = gray();
    mapped.normal_map = NormalMap{};
    mapped.interpolation = Interpolation::gouraud;
    Scene scene = lit_scene(mapped);
    EXPECT_EQ(features(scene).detail, NormalDetail::none);
    EXPECT_EQ(features(scene).interpolation, Interpolation::gouraud);
    EXPECT_EQ(reason(plan_effects(scene, {.samples = 1}).draws[0].reasons, "normal map").reason,
              "Gouraud shading uses normals only at vertices");
    scene.materials[0].interpolation = Interpolation::flat;
    EXPECT_EQ(features(scene).detail, NormalDetail::none);
    EXPECT_EQ(reason(plan_effects(scene, {.samples = 1}).draws[0].reasons, "normal map").reason,
              "flat shading uses only the triangle's normal");
}

TEST(EffectPlan, ComputesNoTangentsForFramesFromDerivativesOrObjectSpaceMaps) {
    Material mapped = gray();
    mapped.bump_map = BumpMap{};
    Scene scene = lit_scene(mapped);
    EXPECT_TRUE(plan_effects(scene, {.samples = 1}).draws[0].needs_tangents);
    scene.materials[0].tangent_frame = TangentFrame::derivatives;
    EXPECT_FALSE(plan_effects(scene, {.samples = 1}).draws[0].needs_tangents);
    scene.materials[0].bump_map.reset();
    scene.materials[0].normal_map = NormalMap{};
    scene.materials[0].normal_map->space = NormalSpace::object;
    EXPECT_EQ(features(scene).detail, NormalDetail::object_normal_map);
    EXPECT_EQ(features(scene).frame, TangentFrame::stored);  // There is no image whose frame could
                                                             // be chosen.
    EXPECT_FALSE(plan_effects(scene, {.samples = 1}).draws[0].needs_tangents);
}

TEST(EffectPlan, UsesAlphaOnlyIfSomethingIsNotOpaque) {
    Scene scene = lit_scene(gray());
    scene.materials[0].alpha_mode = AlphaMode::blend;
    EXPECT_EQ(features(scene).alpha, AlphaMode::opaque);
    scene.materials[0].opacity = 0.5F;
    EXPECT_EQ(features(scene).alpha, AlphaMode::blend);
    const FramePlan plan = plan_effects(scene, {.samples = 1});
    EXPECT_TRUE(plan.sorted_blending);
    EXPECT_TRUE(plan.finishing_pass);
    EXPECT_EQ(plan.draws[0].features.output, OutputCoding::half);
    EXPECT_EQ(reason(plan.reasons, "finishing pass").reason,
              "what is blended must be in linear light");
    scene.materials[0].opacity = 1.0F;
    scene.materials[0].alpha_mode = AlphaMode::mask;
    EXPECT_EQ(features(scene).alpha, AlphaMode::opaque);
    scene.meshes[0].edit().colors.assign(4, glm::vec4(1, 1, 1, 0.5F));
    EXPECT_EQ(features(scene).alpha, AlphaMode::mask);
    EXPECT_TRUE(features(scene).vertex_colors);  // They are white, but their alpha matters now.
}

TEST(EffectPlan, CoversFalloffAndHighlightsOfLights) {
    Material shiny = gray();
    shiny.specular = glm::vec3(0.5F);
    Scene scene = lit_scene(shiny);
    scene.point_lights = {{{0, 0, 1}, {1, 1, 1}, std::nullopt, Falloff::none}};
    EXPECT_EQ(features(scene).falloff, FalloffTerm::none);
    scene.point_lights.push_back({{0, 0, 1}, {1, 1, 1}});
    EXPECT_EQ(features(scene).falloff, FalloffTerm::mixed);
    scene.point_lights.erase(scene.point_lights.begin());
    EXPECT_EQ(features(scene).falloff, FalloffTerm::inverse_square);
    EXPECT_FALSE(features(scene).highlight_colors);
    scene.point_lights[0].highlight_intensity = glm::vec3(1.0F);  // Equal to the color of the
                                                                  // light.
    EXPECT_FALSE(features(scene).highlight_colors);
    scene.point_lights[0].highlight_intensity = glm::vec3(1, 0, 0);
    EXPECT_TRUE(features(scene).highlight_colors);
}

TEST(EffectPlan, AveragedSamplesNeedAFinishingPass) {
    Scene scene = lit_scene(gray());
    scene.tone_mapping = ToneMapping::aces;
    scene.exposure = 2.0F;
    FramePlan plan = plan_effects(scene, {.samples = 4});
    EXPECT_TRUE(plan.finishing_pass);
    EXPECT_EQ(plan.draws[0].features.output, OutputCoding::half);
    EXPECT_FALSE(plan.draws[0].features.exposure);  // The finishing pass applies the exposure.
    plan = plan_effects(scene, {.samples = 1});
    EXPECT_FALSE(plan.finishing_pass);
    EXPECT_TRUE(plan.draws[0].features.exposure);
    EXPECT_EQ(plan.draws[0].features.tone_mapping, ToneMapping::aces);
    plan = plan_effects(scene, {.samples = 4, .output = OutputCoding::linear});
    EXPECT_EQ(plan.draws[0].features.output, OutputCoding::linear);
}

TEST(EffectPlan, FollowsPosesUnlessTheirEffectsAreForced) {
    Scene scene = lit_scene(gray());
    scene.instances[0].pose.emplace().joint_matrices.assign(1, glm::mat4(1.0F));
    const FrameSettings settings{.samples = 1};
    FramePlan plan = plan_effects(scene, settings);
    const FramePlan at_rest = plan;
    FramePlan without = force_effects(scene, settings, plan, {{}, {{"skinning", false}}});
    FramePlan with = force_effects(scene, settings, plan, {{}, {{"skinning", true}}});
    scene.instances[0].pose->joint_matrices[0][3].x = 1.0F;
    for (FramePlan* each : {&plan, &without, &with})
        plan_pose(scene, *each);
    EXPECT_TRUE(plan.draws[0].features.skinning);
    EXPECT_EQ(plan.draws[0].features, plan_effects(scene, settings).draws[0].features);
    EXPECT_EQ(reason(plan.draws[0].reasons, "skinning").reason, "joints move the vertices");
    EXPECT_FALSE(without.draws[0].features.skinning);
    scene.instances[0].pose->joint_matrices[0] = glm::mat4(1.0F);
    for (FramePlan* each : {&plan, &with})
        plan_pose(scene, *each);
    EXPECT_EQ(plan.draws[0].features, at_rest.draws[0].features);
    EXPECT_TRUE(with.draws[0].features.skinning);
}

TEST(FeaturesOf, AgreeWithThePlan) {
    const Scene scene = lit_scene(gray());
    EXPECT_EQ(features_of(scene, scene.materials[0], scene.meshes[0]), features(scene));
}

}  // namespace
}  // namespace relief
