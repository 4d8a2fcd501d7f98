// SPDX-License-Identifier: Apache-2.0
// From radiance to a finished picture, by hand: exposure, tone curves, alpha, blending and masks,
// with and without the finishing pass.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "draw_test.h"
#include "relief/mesh/error.h"
#include "support/shapes.h"

namespace relief {
namespace {

using test::pixel;

class FinishedPicture : public test::DrawTest {};

/// The sRGB code of a linear value up to 1.
double code(double linear) {
    return 255.0 *
           (linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055);
}

double aces(double x) {
    return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
}

/// A square that shines with this radiance.
Scene glowing(float radiance) {
    Material material = test::black_material();
    material.emission = glm::vec3(radiance);
    Scene scene = test::scene_of(test::facing_square(), material);
    scene.background = {0, 0, 0, 1};
    return scene;
}

/// Half a code for rounding, and another for half floats and llvmpipe's pow.
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
        }
    }
}

TEST_F(FinishedPicture, OfInfiniteLightIsWhiteByEveryCurve) {
    for (const ToneMapping curve : {ToneMapping::none, ToneMapping::reinhard, ToneMapping::aces}) {
        for (const int samples : {1, 4}) {
            Scene scene = glowing(max_reflectance);
            scene.exposure = max_reflectance;
            scene.tone_mapping = curve;
            const Image image = render(scene, {8, 8, samples, OutputCoding::srgb}).image;
            EXPECT_EQ(pixel(image, 4, 4), glm::dvec4(255, 255, 255, 255));
        }
    }
}

TEST_F(FinishedPicture, HoldsRadianceWhereItIsLinear) {
    Scene scene = glowing(3.0F);
    scene.exposure = 0.1F;
    scene.tone_mapping = ToneMapping::aces;
    for (const int samples : {1, 4}) {
        const Image image = render(scene, {8, 8, samples, OutputCoding::linear}).image;
        EXPECT_EQ(pixel(image, 4, 4).r, 3.0);  // Neither exposed nor mapped.
    }
}

TEST_F(FinishedPicture, LeavesItsBackgroundAsItIs) {
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
    // Half of white; averaging radiance first would show 500 / 501, nearly white.
    EXPECT_NEAR(pixel(image, 8, 8).r, code(0.5), finished_tolerance);
}

/// Two squares, one behind the other, of these colours and opacities.
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

TEST_F(FinishedPicture, BlendedOverNothingKeepsItsColourAndItsShare) {
    const Scene scene = layered({1, 0.5F, 0, 0.5F}, {0, 0, 0, 0});
    for (const int samples : {1, 4}) {
        const glm::dvec4 color =
            pixel(render(scene, {8, 8, samples, OutputCoding::srgb}).image, 4, 4);
        EXPECT_NEAR(color.r, 255.0, finished_tolerance);
        EXPECT_NEAR(color.g, code(0.5), finished_tolerance);
        EXPECT_NEAR(color.a, 127.5, finished_tolerance);
    }
}

TEST_F(FinishedPicture, OfWhatIsOpaqueAllOverHasNoBlending) {
    const Scene scene = layered({1, 0, 0, 1}, {0, 1, 0, 1});
    const FramePlan plan = plan_effects(scene, {.samples = 1});
    EXPECT_FALSE(plan.sorted_blending);
    EXPECT_FALSE(plan.finishing_pass);
    EXPECT_EQ(pixel(render(scene, {8, 8, 1, OutputCoding::srgb}).image, 4, 4),
              glm::dvec4(255, 0, 0, 255));
}

TEST_F(FinishedPicture, HasHolesWhereAMaskIsBelowItsCutoff) {
    Scene scene = glowing(1.0F);
    Image opacity = make_image(2, 1, 1, 8, ColorSpace::data);
    opacity.samples = std::vector<std::uint8_t>{127, 128};
    scene.images = {{"opacity", opacity}};
    Texture use;
    use.filter = TextureFilter::nearest;
    use.wrap_u = use.wrap_v = TextureWrap::clamp;
    Material& material = scene.materials[0];
    material.opacity_texture = use;
    material.alpha_mode = AlphaMode::mask;
    material.alpha_cutoff = 0.5F;
    scene.background = {0, 0, 0, 0};
    const Image image = render(scene, {8, 8, 1, OutputCoding::srgb}).image;
    EXPECT_EQ(pixel(image, 2, 4), glm::dvec4(0, 0, 0, 0));
    EXPECT_EQ(pixel(image, 6, 4), glm::dvec4(255, 255, 255, 255));
    material.alpha_cutoff = 1.5F;  // Nothing reaches it.
    EXPECT_EQ(pixel(render(scene, {8, 8, 1, OutputCoding::srgb}).image, 6, 4),
              glm::dvec4(0, 0, 0, 0));
}

TEST_F(FinishedPicture, FollowsWhatMoves) {
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

}  // namespace
}  // namespace relief
