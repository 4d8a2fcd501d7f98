// SPDX-License-Identifier: Apache-2.0
// Rays against height maps as bilinear surfaces: hand-computed hits, a dense march, and hard rays.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "parallel.h"
#include "portable_math.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/height_march.h"
#include "relief/mesh/report.h"
#include "support/hard_meshes.h"
#include "support/images.h"

namespace relief {
namespace {

using detail::Random;
using test::all_wraps;
using test::heights_of;
using test::image_of;
using test::infinite;
using test::not_a_number;
using test::rough;

/// The rounding of coordinates of some hundred texels in double, with room for the sums of a hit.
constexpr double rounding = 1e-10;

Image waves(int width, int height) {
    return heights_of(width, height, [=](int x, int y) {
        const double phase = 2.0 * 3.141592653589793;
        return 0.5 + 0.2 * std::sin(phase * 3.0 * x / width) +
               0.2 * std::cos(phase * (2.0 * y / height + 1.0 * x / width));
    });
}

HeightRay random_ray(Random& random, double steepest) {
    HeightRay ray;
    ray.texcoord = {random.between(-2.0, 3.0), random.between(-2.0, 3.0)};
    ray.direction = {random.between(-steepest, steepest), random.between(-steepest, steepest), 1.0};
    ray.black_depth = random.between(0.5, 20.0);
    return ray;
}

/// How far the point of the ray at a depth is above the surface, in texels.
double above_surface(const HeightField& field, const HeightRay& ray, double depth) {
    const glm::dvec2 texcoord = ray.texcoord + glm::dvec2(ray.direction) / ray.direction.z *
                                                   (depth - ray.start_depth) /
                                                   glm::dvec2(field.size());
    return ray.black_depth * (1.0 - field.height(texcoord)) - depth;
}

TEST(HeightFields, AreHitAtHandComputedPoints) {
    // A ramp from black to white over four texels: the height is x / 3 from the first center on.
    const HeightField ramp(image_of(1, std::vector<float>{0.0F, 1.0F / 3, 2.0F / 3, 1.0F}),
                           Wrap::clamp);
    HeightRay ray;
    ray.texcoord = {0.125, 0.5};
    ray.direction = {2.0, 0.0, 1.0};
    ray.black_depth = 3.0;
    // The depth of the surface is 3 - x, that of the ray x / 2: both are 1 at x = 2.
    const HeightHit hit = ramp.first_hit(ray);
    EXPECT_EQ(hit.end, HeightRayEnd::hit);
    EXPECT_NEAR(hit.depth, 1.0, 1e-7) << "heights are float";
    EXPECT_NEAR(hit.texcoord.x, 0.125 + 2.0 / 4, 1e-7);
    EXPECT_EQ(hit.texcoord.y, 0.5);
    EXPECT_NEAR(hit.slope.x, 1.0, 1e-6);
    EXPECT_EQ(hit.slope.y, 0.0);
    EXPECT_LE(hit.lookups, 3);
}

TEST(HeightFields, AreHitInsideASaddle) {
    // The height is x y between the four centers; along the diagonal it is t^2.
    const HeightField saddle(image_of(2, 2, 1, ColorSpace::data, std::vector<float>{0, 0, 0, 1}),
                             Wrap::clamp);
    HeightRay ray;
    ray.texcoord = {0.25, 0.25};
    ray.direction = {1.0, 1.0, 1.0};
    ray.black_depth = 1.0;
    // 1 - t^2 = t.
    const double t = (std::sqrt(5.0) - 1.0) / 2.0;
    const HeightHit hit = saddle.first_hit(ray);
    EXPECT_NEAR(hit.depth, t, 1e-15);
    EXPECT_NEAR(hit.texcoord.x, 0.25 + t / 2, 1e-15);
    EXPECT_NEAR(hit.slope.y, t, 1e-15);
}

TEST(HeightFields, AreHitStraightBelow) {
    const Image image = rough(9, 7);
    for (const Wrap wrap : all_wraps) {
        const HeightField field(image, wrap);
        Random random(3);
        for (int i = 0; i < 200; ++i) {
            HeightRay ray = random_ray(random, 0.0);
            const HeightHit hit = field.first_hit(ray);
            EXPECT_EQ(hit.end, HeightRayEnd::hit);
            EXPECT_EQ(hit.texcoord, ray.texcoord);
            EXPECT_NEAR(hit.depth, ray.black_depth * (1.0 - field.height(ray.texcoord)), rounding);
            const glm::dvec2 slope = ray.black_depth * field.slope(ray.texcoord);
            EXPECT_NEAR(hit.slope.x, slope.x, rounding);
            EXPECT_NEAR(hit.slope.y, slope.y, rounding);
            EXPECT_EQ(hit.lookups, 1);
        }
    }
}

TEST(HeightFields, AgreeWithADenseMarch) {
    constexpr int steps = 20000;
    for (const Wrap wrap : all_wraps) {
        const HeightField field(rough(13, 8, 77), wrap);
        Random random(5);
        for (int i = 0; i < 60; ++i) {
            const HeightRay ray = random_ray(random, 8.0);
            const HeightHit hit = field.first_hit(ray);
            ASSERT_EQ(hit.end, HeightRayEnd::hit);
            EXPECT_NEAR(above_surface(field, ray, hit.depth), 0.0, rounding);
            double last_above = 0.0;
            for (int k = 0; k <= steps; ++k) {
                const double depth = ray.black_depth * k / steps;
                if (above_surface(field, ray, depth) <= 0.0) break;
                last_above = depth;
            }
            // The hit is the first crossing. The march may step over a ridge that the ray enters
            // and leaves, so the hit may be before its last step, but never after the next one.
            EXPECT_LE(hit.depth, last_above + ray.black_depth / steps + rounding);
            for (int k = 0; k <= 2000; ++k)
                EXPECT_GT(above_surface(field, ray, hit.depth * k / 2000.0), -rounding);
        }
    }
}

TEST(HeightFields, HaveTheirHitsInMirroredMaps) {
    const Image image = rough(11, 6, 9);
    const Image mirrored = heights_of(11, 6, [&](int x, int y) {
        return image.as<float>()[static_cast<std::size_t>(y * 11 + 10 - x)];
    });
    const HeightField field(image, Wraps(Wrap::repeat, Wrap::clamp));
    const HeightField other(mirrored, Wraps(Wrap::repeat, Wrap::clamp));
    Random random(8);
    for (int i = 0; i < 100; ++i) {
        HeightRay ray = random_ray(random, 3.0);
        const HeightHit hit = field.first_hit(ray);
        ray.texcoord.x = 1.0 - ray.texcoord.x;
        ray.direction.x = -ray.direction.x;
        const HeightHit same = other.first_hit(ray);
        EXPECT_NEAR(hit.depth, same.depth, rounding);
        EXPECT_NEAR(hit.texcoord.x, 1.0 - same.texcoord.x, rounding);
        EXPECT_NEAR(hit.slope.x, -same.slope.x, 1e-6);
    }
}

TEST(HeightFields, RepeatAndMirrorBeyondTheirBorder) {
    const Image image = rough(6, 5, 4);
    const HeightField repeated(image, Wrap::repeat);
    const HeightField reflected(image, Wrap::mirror);
    Random random(21);
    for (int i = 0; i < 100; ++i) {
        HeightRay ray = random_ray(random, 6.0);
        const double first = repeated.first_hit(ray).depth;
        const double first_reflected = reflected.first_hit(ray).depth;
        ray.texcoord += glm::dvec2(2.0, -4.0);
        EXPECT_NEAR(repeated.first_hit(ray).depth, first, rounding);
        EXPECT_NEAR(reflected.first_hit(ray).depth, first_reflected, rounding);
        ray.texcoord *= -1.0;
        ray.direction.x *= -1.0;
        ray.direction.y *= -1.0;
        EXPECT_NEAR(reflected.first_hit(ray).depth, first_reflected, rounding);
    }
}

TEST(HeightFields, DoNotDependOnTheLengthOfTheDirection) {
    const HeightField field(rough(16, 16), Wrap::repeat);
    Random random(2);
    for (int i = 0; i < 50; ++i) {
        HeightRay ray = random_ray(random, 4.0);
        const HeightHit hit = field.first_hit(ray);
        ray.direction *= 0x1p500;
        EXPECT_EQ(hit.depth, field.first_hit(ray).depth);
        ray.direction *= 0x1p-1000;
        EXPECT_EQ(hit.depth, field.first_hit(ray).depth);
    }
}

TEST(HeightFields, OfOneValueAreHitAtTheirDepth) {
    for (const Wrap wrap : all_wraps) {
        for (const float value : {0.0F, 0.25F, 1.0F}) {
            for (const HeightField& field :
                 {HeightField(image_of(1, std::vector<float>{value}), wrap),
                  HeightField(heights_of(5, 3, [=](int, int) { return value; }), wrap)}) {
                Random random(1);
                for (int i = 0; i < 20; ++i) {
                    const HeightRay ray = random_ray(random, 5.0);
                    const HeightHit hit = field.first_hit(ray);
                    EXPECT_EQ(hit.end, HeightRayEnd::hit);
                    EXPECT_NEAR(hit.depth, ray.black_depth * (1.0 - value), rounding);
                    EXPECT_EQ(hit.slope, glm::dvec2(0.0));
                }
            }
        }
    }
}

TEST(HeightFields, WithoutDepthAreHitWhereRaysBegin) {
    const HeightField field(rough(5, 5), Wrap::repeat);
    HeightRay ray;
    ray.texcoord = {0.3, 0.4};
    ray.direction = {1e9, -1e9, 1.0};
    const HeightHit hit = field.first_hit(ray);
    EXPECT_EQ(hit.end, HeightRayEnd::hit);
    EXPECT_EQ(hit.texcoord, ray.texcoord);
    EXPECT_EQ(hit.depth, 0.0);
    EXPECT_EQ(hit.slope, glm::dvec2(0.0));
}

TEST(HeightFields, AreNotEnteredAlongOrAgainstTheirSurface) {
    const HeightField field(rough(5, 5), Wrap::repeat);
    for (const glm::dvec3 direction :
         {glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(1.0, 0.0, -1.0), glm::dvec3(0.0),
          glm::dvec3(not_a_number, 0.0, 1.0), glm::dvec3(0.0, 0.0, infinite)}) {
        HeightRay ray;
        ray.texcoord = {0.3, 0.4};
        ray.direction = direction;
        ray.black_depth = 4.0;
        const HeightHit hit = field.first_hit(ray);
        EXPECT_EQ(hit.end, HeightRayEnd::left);
        EXPECT_EQ(hit.texcoord, ray.texcoord);
        EXPECT_EQ(hit.depth, 0.0);
        EXPECT_EQ(hit.lookups, 0);
    }
}

TEST(HeightFields, BoundRaysAlongTheSurface) {
    // The surface has its only white texel far from the ray, so the ray meets nothing.
    const HeightField field(heights_of(4, 64, [](int, int y) { return y == 40 ? 1.0 : 0.0; }),
                            Wrap::repeat);
    HeightRay ray;
    ray.texcoord = {0.0, 0.1};
    ray.direction = {1e12, 0.0, 1.0};
    ray.black_depth = 4.0;
    const HeightHit hit = field.first_hit(ray);
    EXPECT_EQ(hit.end, HeightRayEnd::exceeded);
    EXPECT_EQ(hit.lookups, HeightField::max_patches);
    EXPECT_NEAR(hit.texcoord.x, HeightField::max_patches / 4.0, 1.0);
    // The same view meets a wall at once.
    ray.texcoord.y = 40.5 / 64;
    EXPECT_EQ(field.first_hit(ray).end, HeightRayEnd::hit);
}

TEST(HeightFields, LetRaysLeaveUpwards) {
    const HeightField field(heights_of(16, 1, [](int x, int) { return x == 12 ? 1.0 : 0.0; }),
                            Wrap::clamp);
    HeightRay ray;
    ray.texcoord = {4.5 / 16, 0.5};
    ray.start_depth = 2.0;
    ray.black_depth = 3.0;
    ray.direction = {1.0, 0.0, -1.0};
    const HeightHit left = field.first_hit(ray);
    EXPECT_EQ(left.end, HeightRayEnd::left);
    EXPECT_EQ(left.depth, 0.0);
    EXPECT_NEAR(left.texcoord.x, 6.5 / 16, rounding);
    // A lower ray meets the pole, whose flank is at depth 3 (12 - x) in texels of x.
    ray.direction.z = -0.1;
    const HeightHit hit = field.first_hit(ray);
    EXPECT_EQ(hit.end, HeightRayEnd::hit);
    EXPECT_NEAR(hit.depth, 3.0 * (12.0 - (hit.texcoord.x * 16 - 0.5)), 1e-9);
}

/// A wall that ends at x = 7, and a floor from x = 8 on, in texels between centers.
HeightField step() {
    return {heights_of(32, 4, [](int x, int) { return x < 8 ? 1.0 : 0.0; }), Wrap::clamp};
}

/// The shadow of a wall is as long as its height times the tangent of the angle of light.
TEST(HeightFields, CastShadowsOfTheLengthOfATangent) {
    constexpr double depth = 6.0;
    for (const double tangent : {0.3, 1.0, 1.7320508, 3.0}) {
        HeightRay ray;
        ray.black_depth = depth;
        ray.direction = {-tangent, 0.0, -1.0};
        const double end = 7.0 + depth * (1.0 - HeightField::shadow_lift) * tangent;
        for (const double beside : {-1e-6, 1e-6}) {
            ray.texcoord = {(std::max(end, 8.0) + beside + 0.5) / 32, 0.5};
            EXPECT_EQ(step().is_shadowed(ray), beside < 0.0 && end > 8.0) << tangent;
        }
        // Against the other side of the wall, all is lit.
        ray.direction.x = tangent;
        EXPECT_FALSE(step().is_shadowed(ray));
    }
}

TEST(HeightFields, AreShadowedWhereADenseMarchFindsThemHigher) {
    const HeightField field(waves(24, 16), Wrap::repeat);
    Random random(11);
    int shadowed = 0;
    int decided = 0;
    for (int i = 0; i < 2000; ++i) {
        HeightRay ray = random_ray(random, 2.0);
        ray.direction.z = -1.0;
        const double start =
            ray.black_depth * (1.0 - field.height(ray.texcoord) - HeightField::shadow_lift);
        double lowest = infinite;
        constexpr int steps = 4000;
        ray.start_depth = start;
        for (int step = 1; step < steps; ++step)
            lowest =
                std::min(lowest, above_surface(field, ray, start * (1.0 - 1.0 * step / steps)));
        if (std::abs(lowest) < 1e-3) continue;
        ++decided;
        shadowed += lowest < 0.0 ? 1 : 0;
        EXPECT_EQ(field.is_shadowed(ray), lowest < 0.0);
    }
    EXPECT_GT(decided, 1500);
    EXPECT_GT(shadowed, 300);
}

TEST(HeightFields, AreLitFromAboveOnly) {
    const HeightField field(rough(5, 5), Wrap::repeat);
    const HeightField flat(image_of(1, std::vector<float>{0.25F}), Wrap::repeat);
    const HeightField white(image_of(1, std::vector<float>{1.0F}), Wrap::repeat);
    HeightRay ray;
    ray.texcoord = {0.3, 0.4};
    ray.black_depth = 4.0;
    for (const glm::dvec3 below :
         {glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(1.0, 0.0, 1.0), glm::dvec3(0.0),
          glm::dvec3(not_a_number, 0.0, -1.0), glm::dvec3(1e7, 0.0, -1.0)}) {
        ray.direction = below;
        EXPECT_TRUE(field.is_shadowed(ray));
    }
    ray.direction = {0.0, 0.0, -1.0};
    EXPECT_FALSE(field.is_shadowed(ray));
    for (const glm::dvec3 above : {glm::dvec3(0.3, 0.1, -1e-3), glm::dvec3(9e5, 0.0, -1.0)}) {
        ray.direction = above;
        EXPECT_FALSE(white.is_shadowed(ray));
        EXPECT_FALSE(flat.is_shadowed(ray));
        HeightRay shallow = ray;
        shallow.black_depth = 0.0;
        EXPECT_FALSE(field.is_shadowed(shallow));
    }
}

TEST(HeightFields, CoverLongThinMaps) {
    const HeightField field(heights_of(16384, 4, [](int x, int) { return x == 16000 ? 1.0 : 0.0; }),
                            Wrap::clamp);
    HeightRay ray;
    ray.texcoord = {0.5 / 16384, 0.5};
    ray.direction = {1e6, 0.0, 1.0};
    ray.black_depth = 5.0;
    const HeightHit hit = field.first_hit(ray);
    EXPECT_EQ(hit.end, HeightRayEnd::hit);
    EXPECT_EQ(hit.lookups, 16000);
    EXPECT_NEAR(hit.texcoord.x * 16384 - 0.5, 16000.0, 0.01);
}

TEST(HeightFields, AcceptDepthsBeyondTheMap) {
    const HeightField field(waves(4, 4), Wrap::repeat);
    Random random(4);
    for (int i = 0; i < 20; ++i) {
        HeightRay ray = random_ray(random, 2.0);
        ray.black_depth = 1e4;
        const HeightHit hit = field.first_hit(ray);
        EXPECT_EQ(hit.end, HeightRayEnd::hit);
        EXPECT_NEAR(above_surface(field, ray, hit.depth), 0.0, 1e-6) << "ten thousand texels deep";
    }
}

TEST(HeightFields, FillHolesAndClampHeights) {
    Report report;
    const HeightField field(image_of(5, 1, 1, ColorSpace::data,
                                     std::vector<float>{0.5F, not_a_number, 0.5F, 2.0F, -1.0F}),
                            Wrap::clamp, report);
    EXPECT_EQ(report.count("non-finite height"), 1U);
    EXPECT_EQ(report.count("height outside of 0 to 1"), 2U);
    EXPECT_EQ(field.height({0.3, 0.5}), 0.5);
    EXPECT_EQ(field.height({0.7, 0.5}), 1.0);
    EXPECT_EQ(field.height({0.9, 0.5}), 0.0);
}

TEST(HeightFields, AreTheSameForIntegerSamples) {
    const HeightField bytes(image_of(1, std::vector<std::uint8_t>{0, 51, 255}), Wrap::repeat);
    const HeightField words(image_of(1, std::vector<std::uint16_t>{0, 13107, 65535}), Wrap::repeat);
    for (const double u : {0.1, 0.4, 0.77})
        EXPECT_EQ(bytes.height({u, 0.5}), words.height({u, 0.5}));
}

TEST(HeightFields, RejectUnusableImages) {
    EXPECT_THROW(HeightField(Image{}, Wrap::repeat), InvalidInput);
    EXPECT_THROW(HeightField(image_of(2, std::vector<float>{0, 0}), Wrap::repeat), InvalidInput);
}

TEST(HeightFields, HaveTheSameHitsForAnyNumberOfThreads) {
    const HeightField field(rough(64, 64), Wrap::repeat);
    std::vector<HeightRay> rays;
    Random random(6);
    for (int i = 0; i < 2000; ++i)
        rays.push_back(random_ray(random, 10.0));
    const auto all_hits = [&] {
        std::vector<double> depths(rays.size());
        detail::parallel_for(rays.size(), 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                depths[i] = field.first_hit(rays[i]).depth;
        });
        return depths;
    };
    set_thread_limit(1);
    const std::vector<double> alone = all_hits();
    set_thread_limit(0);
    EXPECT_EQ(alone, all_hits());
}

}  // namespace
}  // namespace relief
