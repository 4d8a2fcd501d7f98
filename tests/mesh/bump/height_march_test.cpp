// SPDX-License-Identifier: Apache-2.0
// The methods of relief mapping against the exact hits of HeightField::first_hit().
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "bump/height_field_data.h"
#include "portable_math.h"
#include "relief/mesh/height_march.h"
#include "relief/mesh/report.h"
#include "support/hard_meshes.h"
#include "support/images.h"

namespace relief {
namespace {

using detail::MaximumLevel;
using detail::Random;
using test::all_wraps;
using test::heights_of;
using test::image_of;
using test::not_a_number;
using test::rough;

/// Two exact methods differ by the rounding_of_hits of coordinates of some hundred texels, divided
/// by the angle between ray and surface.
constexpr double rounding_of_hits = 1e-8;

Image smooth(int width, int height) {
    return heights_of(width, height, [=](int x, int y) {
        const double turn = 2.0 * 3.141592653589793;
        return 0.5 + 0.25 * std::sin(turn * x / width) * std::cos(turn * y / height) +
               0.2 * std::sin(turn * (2.0 * x / width + 1.0 * y / height));
    });
}

HeightRay downward_ray(Random& random, double steepest) {
    HeightRay ray;
    ray.texcoord = {random.between(-2.0, 3.0), random.between(-2.0, 3.0)};
    ray.direction = {random.between(-steepest, steepest), random.between(-steepest, steepest), 1.0};
    ray.black_depth = random.between(0.5, 20.0);
    return ray;
}

HeightMarch settings(HeightMethod method, int layers = 16, int bisections = 6) {
    HeightMarch march;
    march.method = method;
    march.layers = layers;
    march.bisections = bisections;
    march.max_steps = 1024;
    return march;
}

/// A ramp from black to white over four texels; the height is x / 3 from the first center on.
HeightField ramp() {
    return {image_of(1, std::vector<float>{0.0F, 1.0F / 3, 2.0F / 3, 1.0F}), Wrap::clamp};
}

/// The depth of the ramp is 3 - x. The ray begins at x = 0 and meets it at x = 2, depth 1.
HeightRay ray_to_ramp() {
    HeightRay ray;
    ray.texcoord = {0.125, 0.5};
    ray.direction = {4.0, 0.0, 2.0};
    ray.black_depth = 3.0;
    return ray;
}

TEST(HeightMarches, HaveHandComputedDepthsOnARamp) {
    const HeightField field = ramp();
    const HeightRay ray = ray_to_ramp();
    // Parallax mapping takes the depth under the beginning.
    HeightHit hit = field.march(ray, settings(HeightMethod::parallax));
    EXPECT_NEAR(hit.depth, 3.0, 1e-6);
    EXPECT_EQ(hit.lookups, 1);
    // Layers at 0, 0.75 and 1.5; the secant is exact on a plane.
    hit = field.march(ray, settings(HeightMethod::parallax_occlusion, 4));
    EXPECT_NEAR(hit.depth, 1.0, 1e-6);
    EXPECT_NEAR(hit.texcoord.x, 0.125 + 2.0 / 4, 1e-6);
    EXPECT_NEAR(hit.slope.x, 1.0, 1e-6);
    EXPECT_EQ(hit.lookups, 3);
    // The interval 0.75 to 1.5 is divided at 1.125 and 0.9375; its end below the surface stands.
    hit = field.march(ray, settings(HeightMethod::relief_mapping, 4, 2));
    EXPECT_EQ(hit.depth, 1.125);
    EXPECT_EQ(hit.lookups, 5);
    hit = field.march(ray, settings(HeightMethod::maximum_mipmaps));
    EXPECT_NEAR(hit.depth, 1.0, 1e-6);
}

TEST(HeightMarches, OfRelaxedConesStepToTheFlankOfTheCone) {
    const HeightField field = ramp();
    HeightRay ray = ray_to_ramp();
    // A root of 0.5 is the ratio 0.25 of a map of size 1 and a depth of 1: with 4 texels and depth
    // 3 the radius is 1/3 of the height. The ray moves by 2 for each depth, so the first step is
    // (1/3) 3 / (2 + 1/3) = 3/7.
    const HeightField cones(heights_of(4, 1, [](int, int) { return 0.5; }), Wrap::clamp);
    HeightHit hit = field.march(ray, settings(HeightMethod::relaxed_cones, 1, 0), &cones);
    EXPECT_NEAR(hit.depth, 3.0 / 7, 1e-6);
    EXPECT_EQ(hit.lookups, 1);
    // Each step goes 3/7 of the way to the hit on a plane: the gap falls by 1 - 3/7.
    hit = field.march(ray, settings(HeightMethod::relaxed_cones, 5, 0), &cones);
    EXPECT_NEAR(hit.depth, 1.0 - std::pow(4.0 / 7, 5), 1e-6);
    EXPECT_THROW((void)field.march(ray, settings(HeightMethod::relaxed_cones)), InvalidInput);
    const HeightField other(heights_of(3, 1, [](int, int) { return 0.5; }), Wrap::clamp);
    EXPECT_THROW((void)field.march(ray, settings(HeightMethod::relaxed_cones), &other),
                 InvalidInput);
}

TEST(HeightMarches, OfMaximumMipmapsAreExact) {
    const glm::ivec2 sizes[] = {{16, 16}, {13, 7}, {1, 1}, {1, 9}, {6, 1}, {2, 31}, {33, 65}};
    for (const glm::ivec2 size : sizes) {
        for (const Wrap wrap : all_wraps) {
            for (const Image& image : {smooth(size.x, size.y), rough(size.x, size.y)}) {
                const HeightField field(image, Wraps(wrap, Wrap::repeat));
                Random random(11);
                for (int i = 0; i < 200; ++i) {
                    const HeightRay ray = downward_ray(random, 5.0);
                    const HeightHit exact = field.first_hit(ray);
                    const HeightHit hit = field.march(ray, settings(HeightMethod::maximum_mipmaps));
                    ASSERT_EQ(hit.end, HeightRayEnd::hit);
                    EXPECT_NEAR(hit.depth, exact.depth, rounding_of_hits);
                    EXPECT_NEAR(hit.texcoord.x, exact.texcoord.x, rounding_of_hits);
                    EXPECT_NEAR(hit.texcoord.y, exact.texcoord.y, rounding_of_hits);
                }
            }
        }
    }
}

TEST(HeightMarches, OfMaximumMipmapsBoundTheirSteps) {
    const HeightField field(heights_of(4, 64, [](int, int y) { return y == 40 ? 1.0 : 0.5; }),
                            Wrap::repeat);
    HeightRay ray;
    ray.texcoord = {0.0, 0.1};
    ray.direction = {1e5, 0.0, 1.0};
    ray.black_depth = 4.0;
    HeightMarch method = settings(HeightMethod::maximum_mipmaps);
    method.max_steps = 100;
    const HeightHit hit = field.march(ray, method);
    EXPECT_EQ(hit.end, HeightRayEnd::exceeded);
    EXPECT_GE(hit.depth, 0.0);
    EXPECT_LT(hit.depth, 2.0);
    EXPECT_LE(hit.lookups, 400);
}

TEST(HeightMarches, WithMoreLayersConvergeOnSmoothMaps) {
    const HeightField field(smooth(64, 64), Wrap::repeat);
    // Rays that cross the surface clearly: the others have no order of convergence.
    std::vector<double> errors_of_secant;
    std::vector<double> errors_of_layers;
    for (const int layers : {16, 32, 64}) {
        Random random(12);
        double secant = 0.0;
        double bracket = 0.0;
        for (int i = 0; i < 500; ++i) {
            HeightRay ray = downward_ray(random, 1.0);
            ray.black_depth = 8.0;
            const double exact = field.first_hit(ray).depth;
            secant += std::abs(
                field.march(ray, settings(HeightMethod::parallax_occlusion, layers)).depth - exact);
            bracket += std::abs(
                field.march(ray, settings(HeightMethod::relief_mapping, layers, 0)).depth - exact);
        }
        errors_of_secant.push_back(secant);
        errors_of_layers.push_back(bracket);
    }
    for (const std::size_t i : {0U, 1U}) {
        // Second order; patches end at lines, where heights have kinks of their own.
        EXPECT_GT(errors_of_secant[i] / errors_of_secant[i + 1], 3.0);
        EXPECT_NEAR(errors_of_layers[i] / errors_of_layers[i + 1], 2.0, 0.2);
    }
}

TEST(HeightMarches, OfBisectionAreWithinTheirLastInterval) {
    const HeightField field(smooth(32, 32), Wrap::mirror);
    Random random(13);
    for (int i = 0; i < 500; ++i) {
        HeightRay ray = downward_ray(random, 0.5);
        ray.black_depth = 4.0;
        const double exact = field.first_hit(ray).depth;
        const HeightHit hit = field.march(ray, settings(HeightMethod::relief_mapping, 16, 6));
        EXPECT_GE(hit.depth, exact - rounding_of_hits);
        EXPECT_LE(hit.depth, exact + 4.0 / 16 / 64 + rounding_of_hits);
        EXPECT_LE(hit.lookups, 17 + 6);
    }
}

TEST(HeightMarches, MissFeaturesThinnerThanALayer) {
    // A pole of one texel, higher than the ground by the whole depth.
    const HeightField field(heights_of(64, 1, [](int x, int) { return x == 20 ? 1.0 : 0.0; }),
                            Wrap::repeat);
    HeightRay ray;
    ray.texcoord = {0.5 / 64, 0.5};
    ray.direction = {8.0, 0.0, 1.0};
    ray.black_depth = 4.0;
    const HeightHit exact = field.first_hit(ray);
    EXPECT_LT(exact.texcoord.x, 20.5 / 64);
    // The layers are at x = 0, 8, 16, 24, 32: on both sides of the pole.
    EXPECT_EQ(field.march(ray, settings(HeightMethod::relief_mapping, 4)).depth, 4.0);
    EXPECT_NEAR(field.march(ray, settings(HeightMethod::maximum_mipmaps)).depth, exact.depth,
                rounding_of_hits);
}

TEST(HeightMarches, OfAllMethodsAreExactStraightBelowAndOnConstantMaps) {
    const HeightField cones(heights_of(5, 3, [](int, int) { return 1.0; }), Wrap::repeat);
    const HeightField field(rough(5, 3), Wrap::repeat);
    const HeightField flat(heights_of(5, 3, [](int, int) { return 0.25; }), Wrap::repeat);
    for (const auto& [name, method, label] : enum_names<HeightMethod>) {
        // Bisection of 1 / 512 by 2^16.
        const HeightMarch march = settings(method, 512, 16);
        Random random(14);
        for (int i = 0; i < 50; ++i) {
            HeightRay ray = downward_ray(random, 0.0);
            HeightHit hit = field.march(ray, march, &cones);
            EXPECT_EQ(hit.end, HeightRayEnd::hit) << name;
            EXPECT_EQ(hit.texcoord, ray.texcoord) << name;
            if (method == HeightMethod::parallax_occlusion || method == HeightMethod::parallax ||
                method == HeightMethod::maximum_mipmaps)
                EXPECT_NEAR(hit.depth, field.first_hit(ray).depth, rounding_of_hits) << name;
            else
                EXPECT_NEAR(hit.depth, field.first_hit(ray).depth, 1e-5) << name;
            ray.direction.x = 3.0;
            hit = flat.march(ray, march, &cones);
            EXPECT_NEAR(hit.depth, 0.75 * ray.black_depth, 1e-5) << name;
            EXPECT_EQ(hit.slope, glm::dvec2(0.0)) << name;
            ray.black_depth = 0.0;
            hit = field.march(ray, march, &cones);
            EXPECT_EQ(hit.depth, 0.0) << name;
            EXPECT_EQ(hit.texcoord, ray.texcoord) << name;
        }
    }
}

TEST(HeightMarches, EndAtTheirBeginningWithoutAWayDown) {
    const HeightField cones(heights_of(5, 3, [](int, int) { return 0.5; }), Wrap::repeat);
    const HeightField field(rough(5, 3), Wrap::repeat);
    for (const auto& [name, method, label] : enum_names<HeightMethod>) {
        for (const glm::dvec3 direction :
             {glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(1.0, 0.0, -1.0), glm::dvec3(0.0),
              glm::dvec3(1e7, 0.0, 1.0), glm::dvec3(not_a_number, 0.0, 1.0)}) {
            HeightRay ray;
            ray.texcoord = {0.3, 0.4};
            ray.direction = direction;
            ray.black_depth = 4.0;
            const HeightHit hit = field.march(ray, settings(method), &cones);
            EXPECT_EQ(hit.end, HeightRayEnd::left) << name;
            EXPECT_EQ(hit.texcoord, ray.texcoord) << name;
            EXPECT_EQ(hit.lookups, 0) << name;
        }
    }
}

TEST(HeightMarches, RejectSettingsOutOfRange) {
    const HeightField field = ramp();
    for (const auto member : {&HeightMarch::layers, &HeightMarch::max_steps}) {
        for (const int value : {0, -1, 1025}) {
            HeightMarch march;
            march.*member = value;
            EXPECT_THROW((void)field.march(ray_to_ramp(), march), InvalidInput);
        }
    }
    HeightMarch march;
    march.bisections = 17;
    EXPECT_THROW((void)field.march(ray_to_ramp(), march), InvalidInput);
}

TEST(HeightMarches, HavePyramidsOfTheMaximaOfPatches) {
    for (const glm::ivec2 size : {glm::ivec2(16, 8), glm::ivec2(13, 7), glm::ivec2(1, 9)}) {
        const Image image = rough(size.x, size.y);
        const detail::BilinearHeights heights(image.as<float>(), size.x, size.y, Wrap::repeat);
        const std::vector<MaximumLevel> levels = detail::maximum_levels(heights);
        EXPECT_EQ(levels.back().maxima.size(), 1U);
        for (std::size_t n = 0; n < levels.size(); ++n) {
            const MaximumLevel& level = levels[n];
            EXPECT_EQ(level.width, std::max(size.x >> n, 1));
            EXPECT_EQ(level.height, std::max(size.y >> n, 1));
            std::vector<float> expected(level.maxima.size(), 0.0F);
            for (int y = 0; y < size.y; ++y) {
                for (int x = 0; x < size.x; ++x) {
                    const int node = std::min(y >> n, level.height - 1) * level.width +
                                     std::min(x >> n, level.width - 1);
                    float& max = expected[static_cast<std::size_t>(node)];
                    max = std::max(max, static_cast<float>(heights.patch(x, y).max()));
                }
            }
            EXPECT_EQ(level.maxima, expected);
        }
    }
}

}  // namespace
}  // namespace relief
