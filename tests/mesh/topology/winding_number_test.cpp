// SPDX-License-Identifier: Apache-2.0
// Generalized winding numbers, and remeshing with them: holes, overlaps, cavities, and the same
// bytes for any order.
#include "topology/winding_number.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include "relief/mesh/mesh.h"
#include "relief/mesh/remesh.h"
#include "relief/mesh/report.h"
#include "relief/mesh/topology.h"
#include "support/manifold.h"
#include "support/shapes.h"

namespace relief {
namespace {

using detail::exact_winding_number;
using detail::WindingTree;
using detail::WoundTriangle;
using test::manifold_faults;

std::vector<WoundTriangle> wound_triangles(const Mesh& mesh) {
    std::vector<WoundTriangle> triangles;
    for (const glm::uvec3& t : mesh.triangles)
        triangles.push_back({glm::dvec3(mesh.positions[t.x]), glm::dvec3(mesh.positions[t.y]),
                             glm::dvec3(mesh.positions[t.z])});
    return triangles;
}

/// Only positions and triangles.
Mesh shape_of(const Mesh& mesh) {
    Mesh shape;
    shape.positions = mesh.positions;
    shape.triangles = mesh.triangles;
    return shape;
}

/// The unit sphere without the triangles above a height.
Mesh cut_sphere(float height) {
    Mesh sphere = shape_of(make_sphere(96, 48));
    std::erase_if(sphere.triangles, [&](const glm::uvec3& t) {
        return std::max({sphere.positions[t.x].y, sphere.positions[t.y].y,
                         sphere.positions[t.z].y}) > height;
    });
    return sphere;
}

void append_shape(Mesh& mesh, const Mesh& other, float scale, const glm::vec3& offset) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const glm::vec3& p : other.positions)
        mesh.positions.push_back(scale * p + offset);
    for (const glm::uvec3& t : other.triangles)
        mesh.triangles.push_back(t + first);
}

double solid_volume(const Mesh& mesh) {
    double volume = 0.0;
    for (const WoundTriangle& t : wound_triangles(mesh))
        volume += glm::dot(t[0], glm::cross(t[1], t[2])) / 6.0;
    return volume;
}

double signed_random(std::mt19937& random) {
    return static_cast<double>(random()) * 0x1p-31 - 1.0;
}

TEST(WindingNumber, CountsTheClosedSurfacesAroundAPoint) {
    Mesh two = shape_of(make_cube());
    append_shape(two, shape_of(make_cube()), 0.5F, {1.0F, 0.0F, 0.0F});
    const std::vector<WoundTriangle> triangles = wound_triangles(two);
    EXPECT_NEAR(exact_winding_number(triangles, {-0.7, 0.2, 0.1}), 1.0, 1e-12);
    EXPECT_NEAR(exact_winding_number(triangles, {0.8, 0.1, 0.2}), 2.0, 1e-12);
    EXPECT_NEAR(exact_winding_number(triangles, {1.2, 0.1, 0.2}), 1.0, 1e-12);
    EXPECT_NEAR(exact_winding_number(triangles, {1.7, 0.1, 0.2}), 0.0, 1e-12);
}

// A point on the axis of a cap sees it at the solid angle 2 pi (1 - cos).
TEST(WindingNumber, OfAnOpenSurfaceIsItsSolidAngle) {
    const Mesh half = cut_sphere(1e-4F);
    const double at_center = exact_winding_number(wound_triangles(half), glm::dvec3(0.0));
    EXPECT_NEAR(at_center, 0.5, 1e-4);
    const double height = -0.5;
    const double below = exact_winding_number(wound_triangles(half), {0.0, height, 0.0});
    const double hole = 0.5 * (1.0 - 0.5 / std::sqrt(1.0 + height * height));
    EXPECT_NEAR(below, 1.0 - hole, 1e-3);
}

TEST(WindingTree, IsNearTheExactSum) {
    const Mesh closed = shape_of(make_sphere(96, 48));
    const Mesh open = cut_sphere(0.3F);
    std::mt19937 random(1);
    for (const Mesh* mesh : {&closed, &open}) {
        const std::vector<WoundTriangle> triangles = wound_triangles(*mesh);
        const WindingTree tree(triangles);
        double largest = 0.0, largest_coarse = 0.0;
        for (int i = 0; i < 2000; ++i) {
            const glm::dvec3 point = 1.5 * glm::dvec3(signed_random(random), signed_random(random),
                                                      signed_random(random));
            const double exact = exact_winding_number(triangles, point);
            largest = std::max(largest, std::abs(tree.winding_number(point) - exact));
            const double coarse = tree.winding_number(point, WindingTree::coarse);
            largest_coarse = std::max(largest_coarse, std::abs(coarse - exact));
        }
        EXPECT_LT(largest, 0.005);
        EXPECT_LT(largest_coarse, 0.05);
        EXPECT_GT(largest, 1e-6);  // Far triangles are taken together.
    }
}

TEST(WindingTree, HasTheSameBitsForAnyOrder) {
    std::vector<WoundTriangle> triangles = wound_triangles(cut_sphere(0.3F));
    const WindingTree tree(triangles);
    std::mt19937 random(2);
    std::shuffle(triangles.begin(), triangles.end(), random);
    for (WoundTriangle& t : triangles)
        std::rotate(t.begin(), t.begin() + static_cast<std::ptrdiff_t>(random() % 3), t.end());
    const WindingTree other(triangles);
    for (int i = 0; i < 500; ++i) {
        const glm::dvec3 point(signed_random(random), signed_random(random), signed_random(random));
        EXPECT_EQ(tree.winding_number(point), other.winding_number(point));
    }
}

// The flood enters through the hole, and finds nothing enclosed.
TEST(RemeshByWinding, ClosesALargeHole) {
    const Mesh half = cut_sphere(1e-4F);
    EXPECT_THROW(remeshed(half, {.resolution = 48}), InvalidInput);
    const Mesh result = remeshed(half, {.resolution = 48, .sign = RemeshSign::winding});
    EXPECT_TRUE(manifold_faults(result).is_watertight());
    EXPECT_NEAR(solid_volume(result), 2.0 / 3.0 * std::numbers::pi, 0.02);
    // The hole is closed by a plane: that of its border.
    float highest = -1.0F;
    for (const glm::vec3& p : result.positions)
        highest = std::max(highest, p.y);
    EXPECT_NEAR(highest, 0.0F, 0.5F * 2.0F / 48.0F);
}

TEST(RemeshByWinding, IsThatOfTheFloodForClosedSurfaces) {
    for (const Mesh& mesh : {shape_of(make_cube()), shape_of(make_sphere(64, 32))}) {
        const Mesh flood = remeshed(mesh, {.resolution = 32});
        const Mesh winding = remeshed(mesh, {.resolution = 32, .sign = RemeshSign::winding});
        EXPECT_EQ(flood.triangles, winding.triangles);
        EXPECT_EQ(flood.positions, winding.positions);
    }
}

TEST(RemeshByWinding, UnitesOverlappingPartsAndKeepsCavities) {
    Mesh two = shape_of(make_cube());
    append_shape(two, shape_of(make_cube()), 0.5F, {1.0F, 0.13F, 0.07F});
    const Mesh united = remeshed(two, {.resolution = 40, .sign = RemeshSign::winding});
    EXPECT_TRUE(manifold_faults(united).is_watertight());
    EXPECT_NEAR(solid_volume(united), 8.5, 0.01);
    // The walls of the cavity face into it.
    Mesh hollow = shape_of(make_cube());
    Mesh inner = shape_of(make_cube());
    for (glm::uvec3& t : inner.triangles)
        std::swap(t.y, t.z);
    append_shape(hollow, inner, 0.5F, glm::vec3(0.0F));
    const Mesh kept = remeshed(hollow, {.resolution = 40, .sign = RemeshSign::winding});
    EXPECT_NEAR(solid_volume(kept), 7.0, 0.01);
    EXPECT_NEAR(solid_volume(remeshed(hollow, {.resolution = 40})), 8.0, 0.01);
}

TEST(RemeshByWinding, OfASurfaceThatFacesInwardsIsTheSame) {
    Mesh half = cut_sphere(0.3F);
    const Mesh result = remeshed(half, {.resolution = 24, .sign = RemeshSign::winding});
    for (glm::uvec3& t : half.triangles)
        std::swap(t.y, t.z);
    const Mesh reversed = remeshed(half, {.resolution = 24, .sign = RemeshSign::winding});
    EXPECT_EQ(result.triangles.size(), reversed.triangles.size());
    // Other triangles are taken together.
    EXPECT_NEAR(solid_volume(result), solid_volume(reversed), 1e-4);
}

TEST(RemeshByWinding, HasTheSameBytesForAnyOrderAndNumberOfThreads) {
    Mesh mesh = cut_sphere(0.3F);
    RemeshOptions options{.resolution = 32, .sign = RemeshSign::winding};
    options.execution.threads = 1;
    const Mesh result = remeshed(mesh, options);
    EXPECT_TRUE(manifold_faults(result).is_watertight());
    std::mt19937 random(3);
    std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
    options.execution.threads = 3;
    const Mesh other = remeshed(mesh, options);
    EXPECT_EQ(result.positions, other.positions);
    EXPECT_EQ(result.triangles, other.triangles);
}

TEST(RemeshByWinding, SoupsBecomeWatertightManifolds) {
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
        std::mt19937 random(seed);
        Mesh soup;
        for (std::uint32_t i = 0; i < 10 + 5 * seed; ++i) {
            const glm::vec3 center(signed_random(random), signed_random(random),
                                   signed_random(random));
            for (int k = 0; k < 3; ++k)
                soup.positions.push_back(center + glm::vec3(signed_random(random),
                                                            signed_random(random),
                                                            signed_random(random)));
            soup.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
        }
        for (const bool shell : {false, true}) {
            try {
                const Mesh solid =
                    remeshed(soup, {.resolution = 20, .shell = shell, .sign = RemeshSign::winding});
                EXPECT_TRUE(manifold_faults(solid).is_watertight()) << seed << shell;
            } catch (const InvalidInput&) {
                EXPECT_FALSE(shell) << seed;  // Nothing has a winding number of a half.
            }
        }
    }
}

}  // namespace
}  // namespace relief
