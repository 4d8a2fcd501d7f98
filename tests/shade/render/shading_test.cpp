// SPDX-License-Identifier: Apache-2.0
// Rendered pictures against the CPU reference in double precision, effect by effect: on a square
// that faces the camera, and on a sphere.
#include <gtest/gtest.h>

#include <cmath>

#include "draw_test.h"
#include "relief/shade/reference.h"
#include "support/angle.h"
#include "support/shapes.h"

namespace relief {
namespace {

using test::pixel;

constexpr int shaded_size = 64;
/// Codes: half a code of rounding, and what float and llvmpipe's pow and exp lose.
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

Scene square(const Material& material) {
    return test::scene_of(test::facing_square(), material);
}

/// A material with highlights under three lights of different kinds.
Scene shiny_square(SpecularModel model, float shininess) {
    Material material = test::black_material();
    material.specular = {0.9F, 0.5F, 0.2F};
    material.shininess = shininess;
    material.specular_model = model;
    Scene scene = square(material);
    scene.directional_lights = {{{0.3F, -0.2F, -1.0F}, {0.8F, 0.8F, 0.8F}}};
    scene.point_lights = {{{-1, 1, 1.5F}, {1, 1, 2}, std::nullopt}};
    return scene;
}

TEST_F(Shading, OfAmbientLightFollowsTheFormula) {
    Material material = test::black_material();
    material.ambient = {0.9F, 0.4F, 0.1F};
    Scene scene = square(material);
    scene.ambient = {0.5F, 0.6F, 0.7F};
    expect_formula(scene);
}

TEST_F(Shading, OfDiffuseLightFollowsTheFormula) {
    Material material = test::black_material();
    material.diffuse = {0.9F, 0.4F, 0.1F};
    Scene scene = square(material);
    scene.directional_lights = {{{1, -2, -3}, {0.9F, 1.0F, 0.5F}}, {{0, 0, 1}, {1, 1, 1}}};
    expect_formula(scene);
}

TEST_F(Shading, OfAPointLightFallsOffWithTheSquaredDistance) {
    Material material = test::black_material();
    material.diffuse = {0.8F, 0.8F, 0.8F};
    Scene scene = square(material);
    scene.point_lights = {{{1, 0.5F, 0.7F}, {0.6F, 0.5F, 0.4F}, std::nullopt},
                          {{-1, -1, -0.5F}, {5, 5, 5}, std::nullopt}};  // Behind: nothing.
    expect_formula(scene);
}

TEST_F(Shading, OfALightWithARangeEndsThere) {
    Material material = test::black_material();
    material.diffuse = {0.8F, 0.8F, 0.8F};
    Scene scene = square(material);
    scene.point_lights = {{{0, 0, 0.7F}, {0.6F, 0.6F, 0.6F}, 1.5F},
                          {{1, 1, 1}, {0.3F, 0.2F, 0.1F}, std::nullopt}};
    expect_formula(scene);
    scene.point_lights.pop_back();
    // The corner is 2.8 away: beyond the range, exactly nothing.
    EXPECT_EQ(pixel(radiance(scene, shaded_size, shaded_size), 0, 0), glm::dvec4(0, 0, 0, 1));
}

TEST_F(Shading, OfASpotLightKeepsToItsCone) {
    Material material = test::black_material();
    material.diffuse = {0.8F, 0.8F, 0.8F};
    Scene scene = square(material);
    SpotLight spot;
    spot.point = {{0.5F, 0, 2}, {3, 3, 3}, std::nullopt};
    spot.direction_world = {-0.2F, 0, -2};
    spot.inner_cone = 0.2F;
    spot.outer_cone = 0.6F;
    scene.spot_lights = {spot};
    expect_formula(scene);
    EXPECT_EQ(pixel(radiance(scene, shaded_size, shaded_size), 0, 0), glm::dvec4(0, 0, 0, 1));
}

TEST_F(Shading, OfPhongsHighlightFollowsTheFormula) {
    for (const float shininess : {0.0F, 1.0F, 12.5F, 100.0F}) {
        SCOPED_TRACE(shininess);
        expect_formula(shiny_square(SpecularModel::phong, shininess));
    }
}

TEST_F(Shading, OfBlinnAndPhongsHighlightFollowsTheFormula) {
    for (const float shininess : {0.0F, 1.0F, 12.5F, 100.0F, 1000.0F}) {
        SCOPED_TRACE(shininess);
        expect_formula(shiny_square(SpecularModel::blinn_phong, shininess));
    }
}

TEST_F(Shading, OfEmissionFollowsTheFormula) {
    Material material = test::black_material();
    material.emission = {0.7F, 0.2F, 0.05F};
    expect_formula(square(material));
}

TEST_F(Shading, OfAnUnlitSurfaceIsItsColour) {
    Material material = test::black_material();
    material.diffuse = {0.7F, 0.2F, 0.05F};
    material.unlit = true;
    Scene scene = square(material);
    scene.ambient = {1, 1, 1};
    scene.directional_lights = {{}};
    expect_formula(scene);
}

TEST_F(Shading, OfAReflectionFollowsSchlick) {
    Material material = test::black_material();
    material.ambient = {0.5F, 0.5F, 0.5F};
    material.reflectivity = {0.04F, 0.3F, 0.9F};
    Scene scene = square(material);
    scene.ambient = {1, 1, 1};
    const glm::vec3 surroundings(0.25F, 0.5F, 0.75F);  // Exact in half floats.
    scene.environment = test::constant_environment(surroundings, false);
    expect_formula(scene);
    scene.materials[0].grazing_reflectivity = scene.materials[0].reflectivity;  // No Fresnel.
    expect_formula(scene);
    scene.environment->intensity = 0.5F;
    expect_formula(scene);
}

TEST_F(Shading, OfTexturesTintsWhatIsScattered) {
    Material material = test::black_material();
    material.ambient = {0.2F, 0.2F, 0.2F};
    material.diffuse = {0.9F, 0.8F, 0.7F};
    material.specular = {0.1F, 0.1F, 0.1F};
    material.emission = {0.1F, 0.1F, 0.1F};
    material.diffuse_texture = Texture{0};
    material.emission_texture = Texture{1};
    Scene scene = square(material);
    scene.ambient = {1, 1, 1};
    scene.directional_lights = {{{0.3F, 0, -1}, {1, 1, 1}}};
    scene.images = {
        {"diffuse", test::constant_image({0.8F, 0.2F, 0.4F, 1}, 3, 8, ColorSpace::srgb)},
        {"emission", test::constant_image({0.4F, 1.0F, 0.6F, 1}, 3, 8, ColorSpace::srgb)}};
    scene.meshes[0].edit().colors.assign(4, glm::vec4(0.5F, 0.75F, 1.0F, 0.1F));
    // llvmpipe decodes sRGB texels by a polynomial that is up to half a percent off.
    expect_formula(scene, 6e-3);
}

TEST_F(Shading, OfEverythingTogetherFollowsTheFormula) {
    Material material;
    material.ambient = {0.1F, 0.2F, 0.3F};
    material.specular = {0.2F, 0.2F, 0.2F};
    material.shininess = 20;
    material.emission = {0.01F, 0.0F, 0.02F};
    material.reflectivity = {0.1F, 0.1F, 0.1F};
    Scene scene = square(material);
    scene.ambient = {0.3F, 0.3F, 0.3F};
    scene.directional_lights = {{{1, -1, -1}, {0.3F, 0.2F, 0.1F}}};
    scene.point_lights = {{{1, 1, 2}, {0.5F, 0.5F, 0.5F}, 8.0F}};
    scene.spot_lights = {
        {{{-1, 0, 2}, {0.5F, 0.6F, 0.7F}, std::nullopt}, {0.3F, 0, -1}, 0.1F, 0.7F}};
    scene.environment = test::constant_environment({0.5F, 0.5F, 0.5F}, true);
    expect_formula(scene);
}

TEST_F(Shading, OfASphereFollowsItsNormals) {
    Material material;
    material.specular = {0.3F, 0.3F, 0.3F};
    Scene scene = test::scene_of(test::sphere(48, 24), material);
    scene.directional_lights = {{{1, -1, -2}, {0.6F, 0.6F, 0.6F}}};
    expect_formula(scene);
}

TEST_F(Shading, OfManyLightsIsTheSumOfAll) {
    Material material = test::black_material();
    material.diffuse = {0.8F, 0.8F, 0.8F};
    Scene scene = square(material);
    for (int i = 0; i < 700; ++i) {  // 1400 rows: more than a uniform block is given.
        const float angle = 0.1F * static_cast<float>(i);
        scene.point_lights.push_back(
            {{2 * std::cos(angle), 2 * std::sin(angle), 1.0F + 0.001F * static_cast<float>(i)},
             {0.002F, 0.001F, 0.0015F},
             std::nullopt});
    }
    EXPECT_TRUE(plan_effects(scene, {.samples = 1}).draws[0].features.lights_in_buffer);
    expect_formula(scene);
}

}  // namespace
}  // namespace relief
