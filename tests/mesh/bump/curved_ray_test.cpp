// SPDX-License-Identifier: Apache-2.0
// Rays of view over curved surfaces: against closed forms of cylinders and spheres, and their
// intersection by all methods.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "portable_math.h"
#include "relief/mesh/height_march.h"

namespace relief {

namespace {

using detail::Random;
using std::numbers::pi;

constexpr int side = 64;

HeightRay ray_of(double degrees, double azimuth, double depth) {
    const double slant = std::tan(degrees * pi / 180.0);
    HeightRay ray;
    ray.texcoord = {0.4, 0.3};
    ray.direction = {slant * std::cos(azimuth), slant * std::sin(azimuth), 1.0};
    ray.black_depth = depth;
    return ray;
}

/// Square texels on a surface with these curvatures to the right and down, in radians per texel.
HeightCurvature curved(double right, double down) {
    HeightCurvature curvature;
    curvature.turn = glm::dmat2(right, 0.0, 0.0, down);
    return curvature;
}

/// Heights of one value.
HeightField constant(double height) {
    Image image = make_image(side, side, 1, 32, ColorSpace::data);
    for (float& sample : image.as<float>())
        sample = static_cast<float>(height);
    return {image, Wrap::repeat};
}

HeightField noise() {
    Image image = make_image(side, side, 1, 32, ColorSpace::data);
    Random random(5);
    for (float& sample : image.as<float>())
        sample = static_cast<float>(random.between(0.0, 1.0));
    return {image, Wrap::repeat};
}

/// Returns where a ray at an angle to the normal of a circle is at a depth d, as an angle of the
/// circle: by the law of sines, (R - d) / sin(a) = R / sin(a + turn).
double turn_at(double degrees, double radius, double depth) {
    const double angle = degrees * pi / 180.0;
    return std::asin(radius * std::sin(angle) / (radius - depth)) - angle;
}

}  // namespace

/// Around a cylinder, along it and across it. The parabola is exact at both ends and in the middle;
/// between them, it is off by the third order.
TEST(CurvedRays, AreThoseOfACylinder) {
    constexpr double radius = 100.0;
    constexpr double depth = 10.0;
    for (const double degrees : {10.0, 30.0, 45.0, 60.0}) {
        const HeightRay straight = ray_of(degrees, 0.0, depth);
        const HeightRay ray = curved_ray(straight, curved(1.0 / radius, 0.0)).ray;
        EXPECT_GT(ray.bend, 0.0);
        for (const double height : {0.0, 0.25, 0.5, 0.75}) {
            const double below = depth * (1.0 - height);
            const HeightHit hit = constant(height).first_hit(ray);
            ASSERT_EQ(hit.end, HeightRayEnd::hit);
            EXPECT_NEAR(hit.depth, below, 1e-4);
            const double expected = radius * turn_at(degrees, radius, below);
            const double moved = (hit.texcoord.x - ray.texcoord.x) * side;
            EXPECT_NEAR(moved, expected, 0.08) << degrees << ", " << height;
            // The plane alone is off by 10 times that and more.
            if (height == 0.0) {
                EXPECT_GT(expected - below * straight.direction.x, 0.05 * expected);
            }
            EXPECT_EQ(hit.texcoord.y, ray.texcoord.y);
        }
        // Along the cylinder, nothing changes.
        const CurvedHeightRay along =
            curved_ray(ray_of(degrees, pi / 2.0, depth), curved(1.0 / radius, 0.0));
        EXPECT_NEAR(along.ray.bend, 0.0, 1e-15);
        EXPECT_NEAR(along.ray.direction.y, straight.direction.x, 1e-12);
        EXPECT_NEAR(along.plane.x, 1.0, 1e-12);
        // Across it, both coordinates follow from the way on the plane. The line is that through
        // the middle, so that the end is off.
        const HeightRay skew =
            curved_ray(ray_of(degrees, 0.7, depth), curved(1.0 / radius, 0.0)).ray;
        const HeightHit hit = constant(0.5).first_hit(skew);
        const double slant = std::tan(degrees * pi / 180.0);
        const double around = slant * std::cos(0.7);
        const double angle = std::atan(around) * 180.0 / pi;
        const double turn = turn_at(angle, radius, 0.5 * depth);
        const double way = (radius - 0.5 * depth) * std::sin(turn) / around;
        EXPECT_NEAR((hit.texcoord.x - skew.texcoord.x) * side, radius * turn, 0.1);
        EXPECT_NEAR((hit.texcoord.y - skew.texcoord.y) * side, way * slant * std::sin(0.7), 0.1);
    }
}

/// A sphere bends rays of all azimuths alike; within it, they meet black sooner.
TEST(CurvedRays, AreThoseOfASphereFromBothSides) {
    constexpr double depth = 10.0;
    for (const double radius : {100.0, -100.0}) {
        for (const double azimuth : {0.0, 1.0, 2.5, 4.0}) {
            const HeightRay ray =
                curved_ray(ray_of(50.0, azimuth, depth), curved(1.0 / radius, 1.0 / radius)).ray;
            const HeightHit hit = constant(0.0).first_hit(ray);
            const glm::dvec2 moved = (hit.texcoord - ray.texcoord) * static_cast<double>(side);
            const double expected = radius * turn_at(50.0, radius, depth);
            EXPECT_NEAR(glm::length(moved), expected, 0.003 * expected) << radius;
            EXPECT_NEAR(moved.x * std::sin(azimuth), moved.y * std::cos(azimuth), 1e-9);
        }
    }
}

/// A ray is deepest at R (1 - sin a): above a constant height below that, it leaves. The outline of
/// the displaced cylinder is where it begins to hit.
TEST(CurvedRays, LeaveAConvexSurfaceAtTheOutline) {
    constexpr double radius = 80.0;
    constexpr double depth = 12.0;
    for (const double height : {0.0, 0.3, 0.6, 0.9}) {
        const HeightField field = constant(height);
        double outline = 0.0;
        for (double degrees = 40.0; degrees < 89.95; degrees += 0.05) {
            const HeightRay ray =
                curved_ray(ray_of(degrees, 0.0, depth), curved(1.0 / radius, 0.0)).ray;
            const HeightHit hit = field.first_hit(ray);
            ASSERT_NE(hit.end, HeightRayEnd::exceeded);
            if (hit.end == HeightRayEnd::hit) outline = radius * std::sin(degrees * pi / 180.0);
            if (hit.end == HeightRayEnd::left) {
                EXPECT_NEAR(hit.depth, 0.0, 1e-9);
            }
        }
        EXPECT_NEAR(outline, radius - depth * (1.0 - height), 0.25) << height;
    }
}

/// The way of the bent ray gives the depth on the tangent plane.
TEST(CurvedRays, KnowTheDepthOnThePlane) {
    constexpr double radius = 100.0;
    constexpr double depth = 10.0;
    for (const double degrees : {20.0, 50.0}) {
        const CurvedHeightRay curve =
            curved_ray(ray_of(degrees, 0.0, depth), curved(1.0 / radius, 0.0));
        for (const double height : {0.0, 0.5}) {
            const double below = depth * (1.0 - height);
            const HeightHit hit = constant(height).first_hit(curve.ray);
            const double turn = turn_at(degrees, radius, below);
            const double expected = radius - (radius - below) * std::cos(turn);
            const double s = (curve.plane.x + curve.plane.y * hit.way) * hit.way;
            EXPECT_NEAR(s, expected, 0.02) << degrees << ", " << height;
        }
    }
}

/// Mirrored, stretched and sheared texels describe the same surface.
TEST(CurvedRays, DoNotDependOnTheCoordinatesOfTheMap) {
    const glm::dvec3 normal(0.0, 0.0, 1.0);
    const glm::dmat2 turn(0.012, 0.003, 0.003, -0.004);  // Of the normal, on the plane.
    const auto ends_at = [&](const glm::dmat2& texels) {
        // The columns are the edges of a texel, of area 1.
        const glm::dmat2 turned = turn * texels;
        const HeightCurvature curvature =
            height_curvature(3.0 * normal, glm::dvec3(texels[0], 0.0), glm::dvec3(texels[1], 0.0),
                             3.0 * glm::dvec3(turned[0], 0.5), 3.0 * glm::dvec3(turned[1], -0.5));
        HeightRay ray;
        ray.direction = glm::dvec3(glm::inverse(texels) * glm::dvec2(1.2, 0.4), 1.0);
        ray.black_depth = 8.0;
        const HeightHit hit = constant(0.0).first_hit(curved_ray(ray, curvature).ray);
        EXPECT_EQ(hit.end, HeightRayEnd::hit);
        return texels * hit.texcoord * static_cast<double>(side);
    };
    const glm::dvec2 expected = ends_at(glm::dmat2(1.0));
    EXPECT_GT(glm::length(expected - glm::dvec2(9.6, 3.2)), 0.5);
    for (const glm::dmat2& texels : {glm::dmat2(-1.0, 0.0, 0.0, 1.0), glm::dmat2(0, 1, -1, 0),
                                     glm::dmat2(2.0, 0.0, 0.0, 0.5), glm::dmat2(1, 0, 0.7, 1)}) {
        EXPECT_NEAR(glm::length(ends_at(texels) - expected), 0.0, 1e-9);
    }
}

TEST(CurvedRays, AreStraightWithoutACurvature) {
    const HeightRay straight = ray_of(60.0, 1.0, 10.0);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    for (const HeightCurvature& none :
         {curved(0.0, 0.0), curved(nan, 0.0), curved(0.1, infinity),
          height_curvature({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 1, 0}),
          height_curvature({1, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 1, 0})}) {
        const CurvedHeightRay curve = curved_ray(straight, none);
        EXPECT_EQ(curve.ray.direction, straight.direction);
        EXPECT_EQ(curve.ray.bend, 0.0);
        EXPECT_EQ(curve.plane, glm::dvec2(1.0, 0.0));
    }
    const CurvedHeightRay down = curved_ray(ray_of(0.0, 0.0, 10.0), curved(0.02, 0.01));
    EXPECT_EQ(down.ray.direction, glm::dvec3(0.0, 0.0, 1.0));
    EXPECT_EQ(down.ray.bend, 0.0);
    HeightRay flat = straight;
    flat.black_depth = 0.0;
    EXPECT_EQ(curved_ray(flat, curved(0.02, 0.01)).ray.bend, 0.0);
}

/// A radius below twice the depth counts as twice the depth: rays straight down still meet black.
TEST(CurvedRays, BoundTheCurvature) {
    for (const double sign : {1.0, -1.0}) {
        for (const double degrees : {0.1, 10.0, 20.0, 89.0}) {
            const HeightRay straight = ray_of(degrees, 0.0, 10.0);
            const HeightRay bounded = curved_ray(straight, curved(sign / 20.0, 0.0)).ray;
            for (const double curvature : {0.2, 1e3, 1e30}) {
                const HeightRay ray = curved_ray(straight, curved(sign * curvature, 0.0)).ray;
                EXPECT_NEAR(ray.bend, bounded.bend, 1e-12 * std::abs(bounded.bend));
                EXPECT_NEAR(ray.direction.x, bounded.direction.x, 1e-9 * bounded.direction.x);
            }
            const HeightHit hit = constant(0.0).first_hit(bounded);
            const bool meets_black = sign < 0.0 || degrees < 30.0;
            EXPECT_EQ(hit.end, meets_black ? HeightRayEnd::hit : HeightRayEnd::left) << degrees;
        }
    }
}

/// Maximum mipmaps skip nothing that a bent ray meets, on convex and on concave surfaces.
TEST(CurvedRays, MeetTheSamePointsByMaximumMipmaps) {
    const HeightField field = noise();
    Random random(9);
    HeightMarch march;
    march.max_steps = 1024;
    int left = 0;
    int moved = 0;
    for (int i = 0; i < 4000; ++i) {
        const double degrees = random.between(0.0, 88.0);
        const HeightRay straight =
            ray_of(degrees, random.between(0.0, 2.0 * pi), random.between(1.0, 20.0));
        const double most = 0.5 / straight.black_depth;
        const HeightRay ray =
            curved_ray(straight, curved(random.between(-most, most), random.between(-most, most)))
                .ray;
        const HeightHit exact = field.first_hit(ray);
        const HeightHit hit = field.march(ray, march);
        ASSERT_NE(hit.end, HeightRayEnd::exceeded);
        EXPECT_EQ(hit.end, exact.end) << i;
        EXPECT_NEAR(hit.depth, exact.depth, 1e-6) << i;
        EXPECT_NEAR(hit.texcoord.x, exact.texcoord.x, 1e-6) << i;
        EXPECT_NEAR(hit.way, exact.way, 1e-6) << i;
        left += exact.end == HeightRayEnd::left ? 1 : 0;
        moved += std::abs(exact.texcoord.x - field.first_hit(straight).texcoord.x) * side > 1.0;
    }
    EXPECT_GT(left, 50);
    EXPECT_GT(moved, 400);
}

/// Layers divide the way to where the ray ends, and converge to the exact hits; cones end above
/// them.
TEST(CurvedRays, ConvergeWithMoreLayers) {
    Image image = make_image(side, side, 1, 32, ColorSpace::data);
    for (int i = 0; i < side * side; ++i)
        image.as<float>()[static_cast<std::size_t>(i)] =
            static_cast<float>(0.5 + 0.3 * std::sin(0.1 * pi * 2.0 * (i % side) / 6.4) *
                                         std::cos(pi * (i / side) / 16.0));
    const HeightField field(image, Wrap::repeat);
    const HeightField cones(channel_of(relaxed_cones(field), 1), Wrap::repeat);
    const auto misses = [&](HeightMethod method, int layers) {
        HeightMarch march;
        march.method = method;
        march.layers = layers;
        march.bisections = 12;
        Random random(9);
        int count = 0;
        for (int i = 0; i < 1000; ++i) {
            const HeightRay straight =
                ray_of(random.between(30.0, 85.0), random.between(0.0, 2.0 * pi), 8.0);
            const HeightRay ray = curved_ray(straight, curved(random.between(-0.02, 0.02),
                                                              random.between(-0.02, 0.02)))
                                      .ray;
            const HeightHit exact = field.first_hit(ray);
            const HeightHit hit = field.march(ray, march, &cones);
            const glm::dvec2 apart = (hit.texcoord - exact.texcoord) * static_cast<double>(side);
            count += hit.end != exact.end || glm::length(apart) > 1.0 ? 1 : 0;
        }
        return count;
    };
    for (const HeightMethod method :
         {HeightMethod::parallax_occlusion, HeightMethod::relief_mapping}) {
        EXPECT_LT(misses(method, 512), 10) << enum_name(method);
        EXPECT_GT(misses(method, 4), misses(method, 64)) << enum_name(method);
    }
    EXPECT_LT(misses(HeightMethod::relaxed_cones, 512), 10);
    EXPECT_GT(misses(HeightMethod::parallax, 1), 400);
}

/// Rays that go up, and those of another start, ignore or add to it.
TEST(CurvedRays, BeginAtAnyDepth) {
    HeightRay ray;
    ray.direction = {1.0, 0.0, 1.0};
    ray.black_depth = 8.0;
    ray.start_depth = 2.0;
    ray.bend = 0.1;
    // 2 + s - s^2 / 10 is 4 at s = 5 - sqrt(5), and at most 4.5.
    HeightHit hit = constant(0.5).first_hit(ray);
    EXPECT_EQ(hit.end, HeightRayEnd::hit);
    EXPECT_NEAR(hit.way, 5.0 - std::sqrt(5.0), 1e-9);
    EXPECT_NEAR(hit.texcoord.x, (5.0 - std::sqrt(5.0)) / side, 1e-9);
    // Without a hit, it leaves where the depth is 0: s = 5 + sqrt(45).
    hit = constant(0.4).first_hit(ray);
    EXPECT_EQ(hit.end, HeightRayEnd::left);
    EXPECT_NEAR(hit.way, 5.0 + std::sqrt(45.0), 1e-9);
    ray.direction.z = -1.0;
    hit = constant(0.0).first_hit(ray);
    EXPECT_EQ(hit.end, HeightRayEnd::left);
    EXPECT_NEAR(hit.texcoord.x, 2.0 / side, 1e-9);
}

}  // namespace relief
