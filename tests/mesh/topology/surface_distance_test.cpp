// SPDX-License-Identifier: Apache-2.0
// The distance between surfaces, against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "relief/mesh/execution.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "relief/mesh/topology.h"
#include "support/shapes.h"

namespace relief {
namespace {

/// The sampled means have an error of this relative size.
constexpr double sampling = 0.01;

Mesh triangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    Mesh mesh;
    mesh.positions = {a, b, c};
    mesh.triangles = {{0, 1, 2}};
    return mesh;
}

TEST(SurfaceDistance, AShiftedPlaneHasTheDistanceOfTheShift) {
    const Mesh grid = test::grid(4);
    Mesh shifted = grid;
    for (glm::vec3& p : shifted.positions)
        p.z += 0.25F;
    const SurfaceDistance distance = surface_distance(grid, shifted);
    for (const DistanceStats& stats : {distance.from_a, distance.from_b}) {
        EXPECT_NEAR(stats.mean, 0.25, 1e-12);
        EXPECT_NEAR(stats.rms, 0.25, 1e-12);
        EXPECT_NEAR(stats.max, 0.25, 1e-12);
        EXPECT_NEAR(stats.max_degrees, 0.0, 1e-6);
        EXPECT_NEAR(stats.area, 1.0, 1e-6);
    }
}

TEST(SurfaceDistance, TheTwoDirectionsDiffer) {
    // b is half of the unit square; the corner (1, 1) of the other half has a distance of
    // sqrt(1 / 2) from the diagonal, and the mean over that half is a third of it.
    const Mesh a = test::grid(8);
    const Mesh b = triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    const SurfaceDistance distance = surface_distance(a, b);
    EXPECT_NEAR(distance.from_a.max, std::sqrt(0.5), 1e-6);
    EXPECT_NEAR(distance.from_a.mean, std::sqrt(0.5) / 6.0, sampling * std::sqrt(0.5) / 6.0);
    EXPECT_NEAR(distance.from_b.max, 0.0, 1e-6);
    // The part of a that is farther than d is (1 - d / sqrt(1 / 2))^2 / 2.
    const double p95 = std::sqrt(0.5) * (1.0 - std::sqrt(0.1));
    EXPECT_NEAR(distance.from_a.p95, p95, sampling * p95);
    EXPECT_NEAR(sampled_distance(a, b, 4000, 10).from_a.p95, p95, 0.02);
    EXPECT_NEAR(distance.from_b.p95, 0.0, 1e-6);
}

TEST(SurfaceDistance, FindsTheMaximumBetweenVertices) {
    // A ridge over a flat triangle: its ends are on the triangle, and its middle is not.
    const Mesh flat = triangle({-4, -4, 0}, {4, -4, 0}, {0, 6, 0});
    Mesh ridge = triangle({-1, 0, 0}, {1, 0, 0}, {0, 0, 0.5});
    EXPECT_NEAR(surface_distance(flat, ridge).from_b.max, 0.5, 1e-9);
    // Points between the corners of a triangle are farther from two walls than its corners are.
    Mesh walls = triangle({-1, -2, -2}, {-1, 2, -2}, {-1, 0, 2});
    walls.positions.insert(walls.positions.end(), {{1, -2, -2}, {1, 2, -2}, {1, 0, 2}});
    walls.triangles.emplace_back(3, 4, 5);
    const Mesh bridge = triangle({-1, -0.1F, 0}, {1, -0.1F, 0}, {1, 0.1F, 0});
    const double largest = surface_distance(bridge, walls).from_a.max;
    EXPECT_NEAR(largest, 1.0, 1e-9);
}

TEST(SurfaceDistance, ASphereOfManyTrianglesIsAsFarFromAPolyhedronAsItsFacesAreDeep) {
    // The middle of a face of the octahedron has a distance of 1 - 1 / sqrt(3) from the sphere.
    Mesh octahedron;
    octahedron.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    octahedron.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                            {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    const SurfaceDistance distance = surface_distance(make_sphere(96, 48), octahedron);
    const double depth = 1.0 - 1.0 / std::sqrt(3.0);
    EXPECT_NEAR(distance.from_a.max, depth, 0.005 * depth);
    EXPECT_NEAR(distance.from_b.max, depth, 0.005 * depth);
    EXPECT_NEAR(distance.from_b.mean_degrees, distance.from_a.mean_degrees, 2.0);
}

/// A flat fan around the origin, in a plane with the given normal. Its boxes overlap.
Mesh fan(std::size_t triangles, const glm::dvec3& normal) {
    const glm::dvec3 side = glm::normalize(glm::cross(normal, glm::dvec3(1, 0, 0)));
    const glm::dvec3 up = glm::cross(normal, side);
    Mesh mesh;
    mesh.positions.emplace_back(0.0F);
    for (std::uint32_t i = 0; i < triangles; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / static_cast<double>(triangles);
        mesh.positions.emplace_back(std::cos(angle) * side + std::sin(angle) * up);
        mesh.triangles.emplace_back(0, 1 + i, 1 + (i + 1) % triangles);
    }
    return mesh;
}

TEST(SurfaceDistance, TheTimeIsNearlyLinearInTheTrianglesOfAFan) {
    const glm::dvec3 normal = glm::normalize(glm::dvec3(1, 2, 3));
    const Mesh a = fan(20'000, normal);
    Mesh b = a;
    for (glm::vec3& p : b.positions)
        p += glm::vec3(0.25 * normal);
    const std::clock_t begin = std::clock();
    const SurfaceDistance distance = surface_distance(a, b);
    const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    for (const DistanceStats& stats : {distance.from_a, distance.from_b}) {
        EXPECT_NEAR(stats.mean, 0.25, 1e-6);
        EXPECT_NEAR(stats.max, 0.25, 1e-6);
        EXPECT_NEAR(stats.area, std::numbers::pi, 1e-5);
    }
    // Processor time: about 1 s, and 100 s if each point is compared with all triangles.
    EXPECT_LT(seconds, 20.0);
}

TEST(SurfaceDistance, FindsTheNearestOfManyThinTriangles) {
    std::mt19937 random(1);
    const auto coordinate = [&] { return static_cast<float>(random() % 2001) / 1000.0F - 1.0F; };
    const auto point = [&] {
        const float x = coordinate();
        const float y = coordinate();
        return glm::vec3(x, y, coordinate());
    };
    Mesh all;
    std::vector<Mesh> needles;
    for (std::uint32_t i = 0; i < 30; ++i) {
        const glm::vec3 end = point();
        needles.push_back(triangle(end, point(), end + glm::vec3(0.01F, 0.0F, 0.005F)));
        const std::vector<glm::vec3>& corners = needles.back().positions;
        all.positions.insert(all.positions.end(), corners.begin(), corners.end());
        all.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    }
    for (int i = 0; i < 5; ++i) {
        const glm::vec3 p = point();
        const Mesh dot = triangle(p, p + glm::vec3(1e-4F, 0, 0), p + glm::vec3(0, 1e-4F, 0));
        double nearest = std::numeric_limits<double>::infinity();
        for (const Mesh& needle : needles)
            nearest = std::min(nearest, surface_distance(dot, needle).from_a.max);
        EXPECT_NEAR(surface_distance(dot, all).from_a.max, nearest, 1e-4) << i;
    }
}

/// Returns separate long triangles that cross a cube in all directions.
Mesh crossing_needles(std::uint32_t count) {
    std::mt19937 random(3);
    const auto coordinate = [&] { return static_cast<float>(random() % 100'001) / 100'000.0F; };
    Mesh mesh;
    for (std::uint32_t i = 0; i < count; ++i) {
        for (int end = 0; end < 2; ++end) {
            const float x = coordinate();
            const float y = coordinate();
            mesh.positions.emplace_back(x, y, coordinate());
        }
        mesh.positions.push_back(mesh.positions[3 * i] + glm::vec3(0.001F, -0.002F, 0.0005F));
        mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    }
    return mesh;
}

TEST(SurfaceDistance, CrossingNeedlesAreDividedWithTheSameDistances) {
    constexpr std::size_t part = 50;  // So few are not divided.
    const Mesh all = crossing_needles(1000);
    for (const glm::vec3& p : {glm::vec3(0.3F, 0.6F, 0.4F), glm::vec3(1.2F, 0.1F, 0.9F)}) {
        const Mesh dot = triangle(p, p + glm::vec3(1e-4F, 0, 0), p + glm::vec3(0, 1e-4F, 0));
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t first = 0; first < all.triangles.size(); first += part) {
            Mesh some;
            some.positions = all.positions;
            some.triangles.assign(
                all.triangles.begin() + static_cast<std::ptrdiff_t>(first),
                all.triangles.begin() + static_cast<std::ptrdiff_t>(first + part));
            nearest = std::min(nearest, surface_distance(dot, some).from_a.max);
        }
        // The farthest point of the dot may be another one for another needle.
        EXPECT_NEAR(surface_distance(dot, all).from_a.max, nearest, 2e-4);
    }
}

TEST(SurfaceDistance, TheTimeForCrossingNeedlesIsLimited) {
    const Mesh needles = crossing_needles(5000);
    Mesh moved = needles;
    for (glm::vec3& p : moved.positions)
        p.x += 1e-4F;
    const std::clock_t begin = std::clock();
    const SurfaceDistance distance = surface_distance(needles, moved);
    const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    for (const DistanceStats& stats : {distance.from_a, distance.from_b}) {
        EXPECT_LE(stats.max, 1.01e-4);
        EXPECT_GT(stats.max, 0.9e-4);
        EXPECT_EQ(stats.omitted, 0U);
    }
    // Processor time: about 0.5 s; 2 s and growing with the square without slabs.
    EXPECT_LT(seconds, 10.0);
}

TEST(SurfaceDistance, NonFiniteTrianglesAndEmptyMeshesAreIgnored) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    Mesh grid = test::grid(2);
    EXPECT_EQ(surface_distance(grid, {}).from_a.max, 0.0);
    const Mesh other = grid;
    grid.positions.emplace_back(nan, 0.0F, 0.0F);
    grid.triangles.emplace_back(0, 1, static_cast<std::uint32_t>(grid.positions.size() - 1));
    grid.normals.clear();
    grid.texcoords.clear();
    grid.tangents.clear();
    grid.material_ranges.clear();
    EXPECT_NEAR(surface_distance(grid, other).from_a.max, 0.0, 1e-6);
}

Mesh coarse_sphere(const Mesh& sphere) {
    DecimateOptions options;
    options.triangles = 300;
    options.fit_positions = true;
    return decimated(sphere, options).mesh;
}

TEST(LargestVertexDistance, IsThatOfTheFullMeasurementOrTheLeastOne) {
    const Mesh sphere = test::sphere(96, 48);
    const Mesh coarse = coarse_sphere(sphere);
    const SurfaceDistance full = surface_distance(sphere, coarse);
    const double largest = std::max(full.from_a.max, full.from_b.max);
    // The full measurement stops at 0.1 % of the distance.
    for (const double part : {0.0, 0.1, 0.5, 0.9})
        EXPECT_NEAR(largest_vertex_distance(sphere, coarse, part * largest), largest,
                    0.002 * largest);
    EXPECT_EQ(largest_vertex_distance(sphere, coarse, 1.01 * largest), 1.01 * largest);
    EXPECT_EQ(largest_vertex_distance(sphere, Mesh{}, 0.25), 0.25);
    EXPECT_THROW(largest_vertex_distance(sphere, coarse, -1.0), InvalidInput);
    EXPECT_THROW(largest_vertex_distance(sphere, coarse, std::numeric_limits<double>::quiet_NaN()),
                 InvalidInput);
}

TEST(LargestVertexDistance, IsTheSameForAnyOrderOfTriangles) {
    const Mesh sphere = test::sphere(96, 48);
    const Mesh coarse = coarse_sphere(sphere);
    const SurfaceDistance full = surface_distance(sphere, coarse);
    const double least = 0.5 * std::max(full.from_a.max, full.from_b.max);
    const double largest = largest_vertex_distance(sphere, coarse, least);
    for (const std::uint32_t seed : {1U, 2U, 3U}) {
        Mesh other = coarse;
        std::shuffle(other.triangles.begin(), other.triangles.end(), std::mt19937(seed));
        EXPECT_EQ(largest_vertex_distance(sphere, other, least), largest);
        Mesh dense = sphere;
        std::shuffle(dense.triangles.begin(), dense.triangles.end(), std::mt19937(seed));
        EXPECT_EQ(largest_vertex_distance(dense, coarse, least), largest);
    }
}

TEST(SampledDistance, AShiftedPlaneHasTheDistanceOfTheShift) {
    const Mesh grid = test::grid(4);
    Mesh shifted = grid;
    for (glm::vec3& p : shifted.positions)
        p.z += 0.25F;
    const SurfaceDistance distance = sampled_distance(grid, shifted, 1000, 10);
    for (const DistanceStats& stats : {distance.from_a, distance.from_b}) {
        EXPECT_NEAR(stats.mean, 0.25, 1e-12);
        EXPECT_NEAR(stats.rms, 0.25, 1e-12);
        EXPECT_NEAR(stats.max, 0.25, 1e-12);
        EXPECT_NEAR(stats.max_degrees, 0.0, 1e-6);
        EXPECT_NEAR(stats.area, 1.0, 1e-6);
    }
    EXPECT_EQ(distance.from_a.samples, 1000U);
    EXPECT_EQ(distance.from_b.samples, 10U);
}

TEST(SampledDistance, AgreesWithTheFullMeasurementOfADecimatedSphere) {
    const Mesh sphere = make_sphere(96, 48);
    DecimateOptions options;
    options.triangles = 600;
    const Mesh small = decimated(sphere, options).mesh;
    const SurfaceDistance full = surface_distance(sphere, small);
    const SurfaceDistance sampled = sampled_distance(sphere, small, 5000, 5000);
    for (const auto side : {&SurfaceDistance::from_a, &SurfaceDistance::from_b}) {
        const DistanceStats& all = full.*side;
        const DistanceStats& some = sampled.*side;
        // The deviation of a mean of 5000 samples is 1 % if single ones deviate by 70 %.
        EXPECT_NEAR(some.mean, all.mean, 0.03 * all.mean);
        EXPECT_NEAR(some.rms, all.rms, 0.03 * all.rms);
        EXPECT_NEAR(some.mean_degrees, all.mean_degrees, 0.03 * all.mean_degrees);
        EXPECT_LE(some.max, all.max);
        EXPECT_GT(some.max, 0.8 * all.max);
        EXPECT_EQ(some.area, all.area);
    }
}

TEST(SampledDistance, TheStatedPartOfTheAreaIsExceededNoMoreOftenThanStated) {
    // The distance of the unit square from a tilted plane is proportional to x, so the part of the
    // area that is farther than a distance is known.
    const Mesh square = test::grid(1);
    constexpr float slope = 0.01F;
    const Mesh plane = triangle({-9, -9, -9 * slope}, {20, -9, 20 * slope}, {-9, 20, -9 * slope});
    const double largest = surface_distance(square, plane).from_a.max;
    ASSERT_NEAR(largest, slope, 1e-5);
    constexpr std::uint32_t trials = 1000;
    for (const std::size_t samples : {20U, 59U}) {
        std::vector<double> farther;
        for (std::uint32_t seed = 0; seed < trials; ++seed)
            farther.push_back(1.0 - sampled_distance(square, plane, samples, 0, seed).from_a.max /
                                        largest);
        for (const double confidence : {0.5, 0.95}) {
            const double stated = max_farther_part(samples, confidence);
            const auto exceeded = static_cast<double>(std::count_if(
                farther.begin(), farther.end(), [&](double part) { return part > stated; }));
            // Three standard deviations of the number of 1000 trials.
            const double expected = (1.0 - confidence) * trials;
            const double deviation = 3.0 * std::sqrt(expected * confidence);
            EXPECT_LE(exceeded, expected + deviation) << confidence << ", " << samples;
            EXPECT_GE(exceeded, 0.5 * expected) << "the statement is too weak";
        }
    }
}

TEST(SampledDistance, MaxFartherPartIsThatOfTheOrderStatistic) {
    EXPECT_EQ(max_farther_part(0, 0.95), 1.0);
    EXPECT_NEAR(max_farther_part(1, 0.95), 0.95, 1e-15);
    EXPECT_NEAR(max_farther_part(2, 0.75), 0.5, 1e-15);
    EXPECT_NEAR(max_farther_part(3000, 0.95), 0.000998, 1e-6);
    for (const double confidence : {0.0, 1.0, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_THROW(max_farther_part(100, confidence), InvalidInput) << confidence;
}

TEST(SampledDistance, IsTheSameForAnyNumberOfThreads) {
    const Mesh sphere = make_sphere(96, 48);
    const Mesh coarse = make_sphere(24, 12);
    const auto measured = [&](unsigned threads) {
        set_thread_limit(threads);
        const SurfaceDistance distance = sampled_distance(sphere, coarse, 3000, 2000);
        set_thread_limit(0);
        std::vector<double> values;
        for (const DistanceStats& stats : {distance.from_a, distance.from_b})
            values.insert(values.end(), {stats.mean, stats.rms, stats.max, stats.mean_degrees,
                                         stats.max_degrees, stats.area});
        return values;
    };
    const std::vector<double> one = measured(1);
    EXPECT_EQ(one, measured(2));
    EXPECT_EQ(one, measured(5));
}

TEST(SampledDistance, FewerSamplesAreExaminedOfCrossingNeedles) {
    const Mesh needles = crossing_needles(5000);
    Mesh moved = needles;
    for (glm::vec3& p : moved.positions)
        p.x += 1e-4F;
    for (const DistanceStats& stats : {sampled_distance(needles, moved, 1000, 1000).from_a,
                                       sampled_distance(needles, moved, 1000, 1000).from_b}) {
        EXPECT_LT(stats.samples, 1000U);
        EXPECT_GT(stats.samples, 0U);
        EXPECT_LE(stats.max, 1.01e-4);
        EXPECT_GT(stats.mean, 0.1e-4);
    }
}

TEST(SampledDistance, SurfacesWithoutAreaOrTrianglesHaveNoSamples) {
    const Mesh grid = test::grid(2);
    const Mesh line = triangle({0, 0, 0}, {1, 0, 0}, {2, 0, 0});
    EXPECT_EQ(sampled_distance(grid, {}, 100, 100).from_a.samples, 0U);
    const SurfaceDistance distance = sampled_distance(line, grid, 100, 100);
    EXPECT_EQ(distance.from_a.samples, 0U);
    EXPECT_EQ(distance.from_b.samples, 100U);
    EXPECT_EQ(sampled_distance(grid, grid, 0, 1).from_a.samples, 0U);
}

}  // namespace
}  // namespace relief
