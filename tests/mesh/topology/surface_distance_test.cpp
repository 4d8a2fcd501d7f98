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

#include "relief/mesh/mesh.h"
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

}  // namespace
}  // namespace relief
