// SPDX-License-Identifier: Apache-2.0
// Rendered shading against the CPU reference, effect by effect, and the conversion of radiance to
// a picture: exposure, tone curves, alpha, blending and masks.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "relief/mesh/report.h"
#include "relief/shade/reference.h"
#include "relief/shade/scene_fields.h"
#include "shade/effects/feature_sets.h"
#include "shade/render/draw_support.h"
#include "support/invariants.h"
#include "support/shapes.h"

namespace relief {
using namespace relief::shade;

namespace {

using test::pixel;

constexpr int shaded_size = 64;
/// In codes: half a code of rounding, and the errors of float and of pow and exp in llvmpipe.
constexpr double shading_tolerance = 1.0;
/// Relative, in linear float.
constexpr double radiance_tolerance = 2e-4;

class Shading : public test::DrawTest {
  protected:
    /// Compares every pixel away from edges with the reference, in codes and in radiance.
    void expect_formula(const Scene& scene, double tolerance = radiance_tolerance) const {
        Report report;
        const Reference reference = render_reference(scene, {shaded_size, shaded_size}, report);
        const Image& expected = reference.radiance;
        const Image expected_codes = reference_picture(expected, scene, OutputCoding::srgb);
        const Image coded = render(scene, {shaded_size, shaded_size, 1, OutputCoding::srgb}).image;
        const Image linear = radiance(scene, shaded_size, shaded_size);
        double worst_code = 0.0;
        double worst_radiance = 0.0;
        double brightest = 0.0;
        int compared = 0;
        for (int y = 0; y < shaded_size; ++y) {
            for (int x = 0; x < shaded_size; ++x) {
                if (pixel(reference.edges, x, y)[0] > 0.0) continue;
                ++compared;
                for (int i = 0; i < 3; ++i) {
                    const double light = pixel(expected, x, y)[i];
                    const double code = 255.0 * pixel(expected_codes, x, y)[i];
                    worst_code = std::max(worst_code, std::abs(pixel(coded, x, y)[i] - code));
                    worst_radiance =
                        std::max(worst_radiance,
                                 std::abs(pixel(linear, x, y)[i] - light) / std::max(light, 0.01));
                    brightest = std::max(brightest, light);
                }
            }
        }
        EXPECT_LE(worst_code, shading_tolerance);
        EXPECT_LE(worst_radiance, tolerance);
        EXPECT_GT(brightest, 0.05) << "the test shows nothing";
        EXPECT_GT(compared, shaded_size * shaded_size / 2) << "edges nearly everywhere";
    }
};

/// A material with highlights under three lights of different kinds.
Scene shiny_square(SpecularModel model, float shininess) {
    Material material = test::black_material();
    material.specular = {0.9F, 0.5F, 0.2F};
    material.shininess = shininess;
    material.specular_model = model;
    Scene scene = test::square_scene(material);
    scene.directional_lights = {{{0.3F, -0.2F, -1.0F}, {0.8F, 0.8F, 0.8F}}};
    scene.point_lights = {{{-1, 1, 1.5F}, {1, 1, 2}, std::nullopt}};
    return scene;
}

TEST_F(Shading, AmbientLightFollowsTheFormula) {
    Material material = test::black_material();
    material.ambient = {0.9F, 0.4F, 0.1F};
    Scene scene = test::square_scene(material);
    scene.ambient = {0.5F, 0.6F, 0.7F};
    expect_formula(scene);
}

TEST_F(Shading, DiffuseLightFollowsTheFormula) {
    Material material = test::black_material();
    material.diffuse = {0.9F, 0.4F, 0.1F};
    Scene scene = test::square_scene(material);
    scene.directional_lights = {{{1, -2, -3}, {0.9F, 1.0F, 0.5F}}, {{0, 0, 1}, {1, 1, 1}}};
    expect_formula(scene);
}

TEST_F(Shading, PointLightFallsOffWithTheSquaredDistance) {
    Material material = test::black_material();
    material.diffuse = {0.8F, 0.8F, 0.8F};
    Scene scene = test::square_scene(material);
    scene.point_lights = {{{1, 0.5F, 0.7F}, {0.6F, 0.5F, 0.4F}, std::nullopt},
                          // This light is behind the square and has no effect.
                          {{-1, -1, -0.5F}, {5, 5, 5}, std::nullopt}};
    expect_formula(scene);
}

TEST_F(Shading, LightEndsAtItsRange) {
    Material material = test::black_material();
    material.diffuse = {0.8F, 0.8F, 0.8F};
    Scene scene = test::square_scene(material);
    scene.point_lights = {{{0, 0, 0.7F}, {0.6F, 0.6F, 0.6F}, 1.5F},
                          {{1, 1, 1}, {0.3F, 0.2F, 0.1F}, std::nullopt}};
    expect_formula(scene);
    scene.point_lights.pop_back();
    // The corner is at a distance of 2.8, beyond the range, so its light is exactly zero.
    EXPECT_EQ(pixel(radiance(scene, shaded_size, shaded_size), 0, 0), glm::dvec4(0, 0, 0, 1));
}

TEST_F(Shading, SpotLightStaysWithinItsCone) {
    Material material = test::black_material();
    material.diffuse = {0.8F, 0.8F, 0.8F};
    Scene scene = test::square_scene(material);
    SpotLight spot;
    spot.point = {{0.5F, 0, 2}, {3, 3, 3}, std::nullopt};
    spot.direction_world = {-0.2F, 0, -2};
    spot.inner_cone = 0.2F;
    spot.outer_cone = 0.6F;
    scene.spot_lights = {spot};
    expect_formula(scene);
    EXPECT_EQ(pixel(radiance(scene, shaded_size, shaded_size), 0, 0), glm::dvec4(0, 0, 0, 1));
}

TEST_F(Shading, PhongsHighlightFollowsTheFormula) {
    for (const float shininess : {0.0F, 1.0F, 12.5F, 100.0F}) {
        SCOPED_TRACE(shininess);
        expect_formula(shiny_square(SpecularModel::phong, shininess));
    }
}

TEST_F(Shading, BlinnPhongHighlightFollowsTheFormula) {
    for (const float shininess : {0.0F, 1.0F, 12.5F, 100.0F, 1000.0F}) {
        SCOPED_TRACE(shininess);
        expect_formula(shiny_square(SpecularModel::blinn_phong, shininess));
    }
}

TEST_F(Shading, EmissionFollowsTheFormula) {
    Material material = test::black_material();
    material.emission = {0.7F, 0.2F, 0.05F};
    expect_formula(test::square_scene(material));
}

TEST_F(Shading, UnlitSurfaceHasItsColor) {
    Material material = test::black_material();
    material.diffuse = {0.7F, 0.2F, 0.05F};
    material.unlit = true;
    Scene scene = test::square_scene(material);
    scene.ambient = {1, 1, 1};
    scene.directional_lights = {{}};
    expect_formula(scene);
}

TEST_F(Shading, ReflectionFollowsSchlick) {
    Material material = test::black_material();
    material.ambient = {0.5F, 0.5F, 0.5F};
    material.reflectivity = {0.04F, 0.3F, 0.9F};
    Scene scene = test::square_scene(material);
    scene.ambient = {1, 1, 1};
    const glm::vec3 surroundings(0.25F, 0.5F, 0.75F);  // The values are exact in half floats.
    scene.environment = test::constant_environment(surroundings, false);
    expect_formula(scene);
    // There is no Fresnel effect.
    scene.materials[0].grazing_reflectivity = scene.materials[0].reflectivity;
    expect_formula(scene);
    scene.environment->intensity = 0.5F;
    expect_formula(scene);
}

TEST_F(Shading, TexturesTintScatteredLight) {
    Material material = test::black_material();
    material.ambient = {0.2F, 0.2F, 0.2F};
    material.diffuse = {0.9F, 0.8F, 0.7F};
    material.specular = {0.1F, 0.1F, 0.1F};
    material.emission = {0.1F, 0.1F, 0.1F};
    material.diffuse_texture = Texture{0};
    material.emission_texture = Texture{1};
    Scene scene = test::square_scene(material);
    scene.ambient = {1, 1, 1};
    scene.directional_lights = {{{0.3F, 0, -1}, {1, 1, 1}}};
    scene.images = {
        {"diffuse", test::constant_image({0.8F, 0.2F, 0.4F, 1}, 3, 8, ColorSpace::srgb)},
        {"emission", test::constant_image({0.4F, 1.0F, 0.6F, 1}, 3, 8, ColorSpace::srgb)}};
    scene.meshes[0].edit().colors.assign(4, glm::vec4(0.5F, 0.75F, 1.0F, 0.1F));
    // llvmpipe decodes sRGB texels with a polynomial whose error is up to half a percent.
    expect_formula(scene, 6e-3);
}

TEST_F(Shading, AllTermsTogetherFollowTheFormula) {
    Material material;
    material.ambient = {0.1F, 0.2F, 0.3F};
    material.specular = {0.2F, 0.2F, 0.2F};
    material.shininess = 20;
    material.emission = {0.01F, 0.0F, 0.02F};
    material.reflectivity = {0.1F, 0.1F, 0.1F};
    Scene scene = test::square_scene(material);
    scene.ambient = {0.3F, 0.3F, 0.3F};
    scene.directional_lights = {{{1, -1, -1}, {0.3F, 0.2F, 0.1F}}};
    scene.point_lights = {{{1, 1, 2}, {0.5F, 0.5F, 0.5F}, 8.0F}};
    scene.spot_lights = {
        {{{-1, 0, 2}, {0.5F, 0.6F, 0.7F}, std::nullopt}, {0.3F, 0, -1}, 0.1F, 0.7F}};
    scene.environment = test::constant_environment({0.5F, 0.5F, 0.5F}, true);
    expect_formula(scene);
}

TEST_F(Shading, SphereFollowsItsNormals) {
    Material material;
    material.specular = {0.3F, 0.3F, 0.3F};
    Scene scene = test::scene_of(test::sphere(48, 24), material);
    scene.directional_lights = {{{1, -1, -2}, {0.6F, 0.6F, 0.6F}}};
    expect_formula(scene);
}

TEST_F(Shading, ManyLightsAddUp) {
    Material material = test::black_material();
    material.diffuse = {0.8F, 0.8F, 0.8F};
    Scene scene = test::square_scene(material);
    for (int i = 0; i < 700; ++i) {  // 1400 rows exceed a uniform block.
        const float angle = 0.1F * static_cast<float>(i);
        scene.point_lights.push_back(
            {{2 * std::cos(angle), 2 * std::sin(angle), 1.0F + 0.001F * static_cast<float>(i)},
             {0.002F, 0.001F, 0.0015F},
             std::nullopt});
    }
    EXPECT_TRUE(plan_effects(scene, {.samples = 1}).draws[0].features.lights_in_buffer);
    expect_formula(scene);
}

class FinishedPicture : public test::DrawTest {};

/// The sRGB code of a linear value up to 1.
double code(double linear) {
    return 255.0 *
           (linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055);
}

double aces(double x) {
    return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
}

/// Returns the light of gray by Hill's fit. The rows of its matrices add up to 1.
double filmic(double x) {
    return (x * (x + 0.0245786) - 0.000090537) / (x * (0.983729 * x + 0.4329510) + 0.238081);
}

/// Returns the light of gray above 0.76 + 0.04 by Khronos PBR Neutral.
double bright_neutral(double x) {
    return 1.0 - 0.24 * 0.24 / (x - 0.04 + 0.24 - 0.76);
}

/// A square that emits this radiance.
Scene glowing(float radiance) {
    Material material = test::black_material();
    material.emission = glm::vec3(radiance);
    Scene scene = test::scene_of(test::facing_square(), material);
    scene.background = {0, 0, 0, 1};
    return scene;
}

/// In codes: half a code of rounding, and another half for half floats and pow in llvmpipe.
constexpr double finished_tolerance = 1.0;

TEST_F(FinishedPicture, IsExposedAndToneMapped) {
    for (const int samples : {1, 4}) {
        for (const float radiance : {0.01F, 0.25F, 1.0F, 4.0F, 1000.0F}) {
            SCOPED_TRACE(radiance);
            Scene scene = glowing(radiance);
            const FrameSettings settings{8, 8, samples, OutputCoding::srgb};
            const double light = 0.5 * static_cast<double>(radiance);
            scene.exposure = 0.5F;
            EXPECT_NEAR(pixel(render(scene, settings).image, 4, 4).r, code(std::min(light, 1.0)),
                        finished_tolerance);
            scene.tone_mapping = ToneMapping::reinhard;
            EXPECT_NEAR(pixel(render(scene, settings).image, 4, 4).r, code(light / (1.0 + light)),
                        finished_tolerance);
            scene.tone_mapping = ToneMapping::aces;
            EXPECT_NEAR(pixel(render(scene, settings).image, 4, 4).r,
                        code(std::min(aces(light), 1.0)), finished_tolerance);
            scene.tone_mapping = ToneMapping::aces_hill;
            EXPECT_NEAR(pixel(render(scene, settings).image, 4, 4).r,
                        code(std::clamp(filmic(light), 0.0, 1.0)), finished_tolerance);
            scene.tone_mapping = ToneMapping::aces_hill_boost;
            EXPECT_NEAR(pixel(render(scene, settings).image, 4, 4).r,
                        code(std::clamp(filmic(light / 0.6), 0.0, 1.0)), finished_tolerance);
            scene.tone_mapping = ToneMapping::khronos_neutral;
            const double neutral = light < 0.08  ? 6.25 * light * light
                                   : light < 0.8 ? light - 0.04
                                                 : bright_neutral(light);
            EXPECT_NEAR(pixel(render(scene, settings).image, 4, 4).r, code(neutral),
                        finished_tolerance);
        }
    }
}

TEST_F(FinishedPicture, InfiniteLightIsWhiteByEveryCurve) {
    for (const auto& [name, curve, label] : enum_names<ToneMapping>) {
        SCOPED_TRACE(name);
        for (const int samples : {1, 4}) {
            Scene scene = glowing(max_reflectance);
            scene.exposure = max_reflectance;
            scene.tone_mapping = curve;
            const Image image = render(scene, {8, 8, samples, OutputCoding::srgb}).image;
            EXPECT_EQ(pixel(image, 4, 4), glm::dvec4(255, 255, 255, 255));
        }
    }
}

TEST_F(FinishedPicture, ContainsRadianceIfLinear) {
    Scene scene = glowing(3.0F);
    scene.exposure = 0.1F;
    scene.tone_mapping = ToneMapping::aces;
    for (const int samples : {1, 4}) {
        const Image image = render(scene, {8, 8, samples, OutputCoding::linear}).image;
        EXPECT_EQ(pixel(image, 4, 4).r, 3.0);  // Linear output has neither exposure nor tone
                                               // mapping.
    }
}

TEST_F(FinishedPicture, KeepsItsBackground) {
    for (const int samples : {1, 4}) {
        Scene scene = glowing(1.0F);
        scene.background = {0.5F, 0.5F, 0.5F, 1};
        scene.exposure = 4.0F;
        scene.tone_mapping = ToneMapping::reinhard;
        scene.instances[0].world_from_object[3].x = 2.0F;  // The left half is empty.
        const Image image = render(scene, {8, 8, samples, OutputCoding::srgb}).image;
        EXPECT_EQ(pixel(image, 1, 4).r, 188.0);  // 0.5.
    }
}

TEST_F(FinishedPicture, ToneMapsEverySampleOfAnEdge) {
    Scene scene = glowing(1000.0F);
    scene.background = {0, 0, 0, 1};
    for (glm::vec3& p : scene.meshes[0].edit().positions)
        p.x = p.x < 0.0F ? -2.0F : 0.125F;  // Half of pixel 8 of 16.
    scene.tone_mapping = ToneMapping::reinhard;
    const Image image = render(scene, {16, 16, 4, OutputCoding::srgb}).image;
    // The result is half of white. The mean of radiance before tone mapping would give 500 / 501,
    // almost white.
    EXPECT_NEAR(pixel(image, 8, 8).r, code(0.5), finished_tolerance);
}

/// Two squares, one behind the other, with these colors and opacities.
Scene layered(const glm::vec4& near, const glm::vec4& far) {
    Scene scene = test::scene_of(test::facing_square(), test::black_material());
    scene.meshes.push_back(scene.meshes[0]);
    scene.meshes[1].edit().material_ranges[0].material = 1;
    scene.materials.push_back(scene.materials[0]);
    const std::array<glm::vec4, 2> layers{near, far};
    for (std::size_t i = 0; i < 2; ++i) {
        scene.materials[i].emission = glm::vec3(layers[i]);
        scene.materials[i].opacity = layers[i].a;
        scene.materials[i].alpha_mode = AlphaMode::blend;
    }
    scene.instances.push_back({1, glm::mat4(1.0F), "far"});
    scene.instances[1].world_from_object[3].z = -0.5F;
    return scene;
}

TEST_F(FinishedPicture, BlendsLayersInLinearLightFarthestFirst) {
    for (const int samples : {1, 4}) {
        for (const bool swapped : {false, true}) {
            Scene scene = layered({1, 0, 0, 0.5F}, {0, 1, 0, 0.25F});
            if (swapped) std::swap(scene.instances[0], scene.instances[1]);
            scene.background = {0, 0, 1, 1};
            const glm::dvec4 color =
                pixel(render(scene, {8, 8, samples, OutputCoding::srgb}).image, 4, 4);
            EXPECT_NEAR(color.r, code(0.5), finished_tolerance);
            EXPECT_NEAR(color.g, code(0.5 * 0.25), finished_tolerance);
            EXPECT_NEAR(color.b, code(0.5 * 0.75), finished_tolerance);
            EXPECT_EQ(color.a, 255.0);
        }
    }
}

TEST_F(FinishedPicture, SortsTheTrianglesOfAShearedInstanceByTheirDepthInTheWorld) {
    // Both triangles cover the middle. The first one is green and to the right.
    Mesh mesh;
    mesh.positions = {{-2, -3, 0}, {3, -3, 0}, {0.5F, 3, 0},
                      {-3, -3, 0}, {2, -3, 0}, {-0.5F, 3, 0}};
    mesh.normals.assign(6, {0, 0, 1});
    for (int i = 0; i < 6; ++i)
        mesh.colors.emplace_back(i < 3 ? 0 : 1, i < 3 ? 1 : 0, 0, 1);
    mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
    Material material;
    material.unlit = true;
    material.diffuse = glm::vec3(1.0F);
    material.alpha_mode = AlphaMode::blend;
    material.opacity = 0.5F;
    Scene scene = test::scene_of(mesh, material);
    scene.background = {0, 0, 0, 1};
    for (const float shear : {0.25F, -0.25F}) {
        scene.instances[0].world_from_object[0].z = shear;  // z = shear * x
        const glm::dvec4 color = pixel(render(scene, {8, 8, 1, OutputCoding::srgb}).image, 4, 4);
        // With a positive shear, the right triangle is nearer and is drawn last.
        EXPECT_NEAR(color.r, code(shear > 0.0F ? 0.25 : 0.5), finished_tolerance) << shear;
        EXPECT_NEAR(color.g, code(shear > 0.0F ? 0.5 : 0.25), finished_tolerance) << shear;
    }
}

TEST_F(FinishedPicture, BlendedOverTransparencyKeepsColorAndAlpha) {
    const Scene scene = layered({1, 0.5F, 0, 0.5F}, {0, 0, 0, 0});
    for (const int samples : {1, 4}) {
        const glm::dvec4 color =
            pixel(render(scene, {8, 8, samples, OutputCoding::srgb}).image, 4, 4);
        EXPECT_NEAR(color.r, 255.0, finished_tolerance);
        EXPECT_NEAR(color.g, code(0.5), finished_tolerance);
        EXPECT_NEAR(color.a, 127.5, finished_tolerance);
    }
}

TEST_F(FinishedPicture, OpaqueAlphaNeedsNoBlending) {
    const Scene scene = layered({1, 0, 0, 1}, {0, 1, 0, 1});
    const FramePlan plan = plan_effects(scene, {.samples = 1});
    EXPECT_FALSE(plan.sorted_blending);
    EXPECT_FALSE(plan.finishing_pass);
    EXPECT_EQ(pixel(render(scene, {8, 8, 1, OutputCoding::srgb}).image, 4, 4),
              glm::dvec4(255, 0, 0, 255));
}

TEST_F(FinishedPicture, HasHolesBelowTheCutoffOfAMask) {
    Scene scene = glowing(1.0F);
    Image opacity = make_image(2, 1, 1, 8, ColorSpace::data);
    opacity.samples = std::vector<std::uint8_t>{127, 128};
    scene.images = {{"opacity", opacity}};
    Texture use;
    use.filter = TextureFilter::nearest;
    use.wrap_u = use.wrap_v = Wrap::clamp;
    Material& material = scene.materials[0];
    material.opacity_texture = use;
    material.alpha_mode = AlphaMode::mask;
    material.alpha_cutoff = 0.5F;
    scene.background = {0, 0, 0, 0};
    const Image image = render(scene, {8, 8, 1, OutputCoding::srgb}).image;
    EXPECT_EQ(pixel(image, 2, 4), glm::dvec4(0, 0, 0, 0));
    EXPECT_EQ(pixel(image, 6, 4), glm::dvec4(255, 255, 255, 255));
    material.alpha_cutoff = 1.5F;  // No alpha reaches this value.
    EXPECT_EQ(pixel(render(scene, {8, 8, 1, OutputCoding::srgb}).image, 6, 4),
              glm::dvec4(0, 0, 0, 0));
}

TEST_F(FinishedPicture, FollowsMovedObjects) {
    Scene scene = glowing(0.0F);
    scene.materials[0].diffuse = glm::vec3(1.0F);
    scene.directional_lights = {{{0, 0, -1}, glm::vec3(1.0F)}};
    Report report;
    Renderer renderer(context(), scene, {8, 8, 1, OutputCoding::srgb}, report);
    EXPECT_EQ(pixel(renderer.draw(*scene.camera).image, 1, 4).r, 255.0);
    scene.instances[0].world_from_object[3].x = 2.0F;
    scene.directional_lights[0].irradiance = glm::vec3(0.5F);
    renderer.move(scene);
    const Image moved = renderer.draw(*scene.camera).image;
    EXPECT_EQ(pixel(moved, 1, 4).r, 0.0);
    EXPECT_EQ(pixel(moved, 6, 4).r, 188.0);
    EXPECT_TRUE(test::same_bits(moved, render(scene, {8, 8, 1, OutputCoding::srgb}).image));
    scene.instances.pop_back();
    EXPECT_THROW(renderer.move(scene), InvalidInput);
}

TEST_F(FinishedPicture, FollowsPosesWithoutUploadingMeshes) {
    Material material = test::black_material();
    material.diffuse = glm::vec3(0.8F);
    for (const bool blends : {false, true}) {
        if (blends) {
            material.alpha_mode = AlphaMode::blend;
            material.opacity = 0.5F;
        }
        Scene scene = test::scene_of(test::sphere(24, 12), material);
        scene.directional_lights = {{{0, 0, -1}, glm::vec3(1.0F)}};
        Features bent;
        bent.morphing = bent.skinning = true;
        const MeshPose at_rest = test::pose_calling_for(scene.meshes[0], {});
        const MeshPose deformed = test::pose_calling_for(scene.meshes[0], bent);
        MeshPose skinned = deformed;
        skinned.weights.clear();
        scene.instances[0].pose = at_rest;
        FrameSettings settings{48, 48, 1, OutputCoding::srgb};
        settings.overlays.wireframe = true;
        settings.overlays.vertex_frames = 0.1F;
        RenderCache cache(context());
        Renderer renderer(cache, context(), scene, plan_effects(scene, settings), settings);
        const Image rest = renderer.draw(*scene.camera).image;
        for (const MeshPose& pose : {deformed, skinned, at_rest, deformed}) {
            scene.instances[0].pose = pose;
            renderer.move(scene);
            const Image moved = renderer.draw(*scene.camera).image;
            EXPECT_TRUE(test::same_bits(moved, render(scene, settings).image));
            EXPECT_EQ(test::same_bits(moved, rest), pose.joint_matrices.empty());
            EXPECT_EQ(renderer.plan().draws[0].features.skinning, !pose.joint_matrices.empty());
            EXPECT_EQ(renderer.plan().draws[0].features.morphing, !pose.weights.empty());
            EXPECT_EQ(cache.contents().meshes, 1U);
        }
        scene.instances[0].pose->deformation.edit().targets[0].positions.pop_back();
        EXPECT_THROW(renderer.move(scene), InvalidInput);
    }
}

}  // namespace
}  // namespace relief
