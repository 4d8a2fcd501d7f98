// SPDX-License-Identifier: Apache-2.0
// Normals of walls that are modeled as two triangles of opposite winding, and the stacks that find
// them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <numbers>
#include <numeric>
#include <optional>
#include <random>
#include <vector>

#include "geometry/triangle_stacks.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace relief {
namespace {

using detail::triangle_stacks;

/// A square of 4 x 4 cells in the x-y plane that faces up.
Mesh plane() {
    Mesh mesh;
    for (int y = 0; y <= 4; ++y) {
        for (int x = 0; x <= 4; ++x)
            mesh.positions.emplace_back(x, y, 0);
    }
    for (std::uint32_t y = 0; y < 4; ++y) {
        for (std::uint32_t x = 0; x < 4; ++x) {
            const std::uint32_t v = 5 * y + x;
            mesh.triangles.emplace_back(v, v + 1, v + 6);
            mesh.triangles.emplace_back(v, v + 6, v + 5);
        }
    }
    return mesh;
}

/// Adds the other side of the triangles that are selected, with the same vertices.
template <typename Select>
Mesh with_backs(Mesh mesh, const Select& select) {
    const std::vector<glm::uvec3> fronts = mesh.triangles;
    for (std::uint32_t t = 0; t < fronts.size(); ++t) {
        if (select(t)) mesh.triangles.emplace_back(fronts[t].y, fronts[t].x, fronts[t].z);
    }
    return mesh;
}

Mesh doubled(const Mesh& mesh) {
    return with_backs(mesh, [](std::uint32_t) { return true; });
}

Mesh box() {
    Mesh mesh;
    for (int i = 0; i < 8; ++i)
        mesh.positions.emplace_back(i & 1, i >> 1 & 1, i >> 2);
    mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

glm::vec3 triangle_normal(const Mesh& mesh, const glm::uvec3& t) {
    const glm::vec3 a = mesh.positions[t.x];
    return glm::normalize(glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a));
}

/// The smallest cosine between the normals at the corners and their triangles.
float min_cosine(const Mesh& mesh) {
    float least = 1.0F;
    for (const glm::uvec3& t : mesh.triangles) {
        for (int i = 0; i < 3; ++i)
            least = std::min(least, glm::dot(mesh.normals[t[i]], triangle_normal(mesh, t)));
    }
    return least;
}

FramedMesh averaged(const Mesh& mesh, Report& report, std::optional<double> crease = std::nullopt) {
    FrameOptions options;
    options.normals = NormalWeight::angle;
    options.crease_angle = crease;
    return with_frames(mesh, options, report);
}

TEST(DoubledTriangles, KeepANormalForEachSideOfAPlane) {
    Report report;
    const FramedMesh framed = averaged(doubled(plane()), report);
    EXPECT_EQ(framed.mesh.positions.size(), 50U);
    EXPECT_FLOAT_EQ(min_cosine(framed.mesh), 1.0F);
    EXPECT_EQ(report.count("double-sided triangle"), 32U);
    EXPECT_EQ(report.count("cancelling normals"), 0U);
}

TEST(DoubledTriangles, KeepANormalForEachSideWithVerticesOfTheirOwn) {
    Mesh mesh = plane();
    const Mesh front = mesh;
    for (const glm::vec3& position : front.positions)
        mesh.positions.push_back(position);
    for (const glm::uvec3& t : front.triangles)
        mesh.triangles.push_back(glm::uvec3(t.y, t.x, t.z) + 25U);
    Report report;
    const FramedMesh framed = averaged(mesh, report);
    EXPECT_EQ(framed.mesh.positions.size(), 50U);
    EXPECT_FLOAT_EQ(min_cosine(framed.mesh), 1.0F);
    EXPECT_EQ(report.count("double-sided triangle"), 32U);
}

TEST(DoubledTriangles, HaveTheNormalsOfTheSingleSurface) {
    Report report;
    const FramedMesh single = averaged(box(), report);
    const FramedMesh both = averaged(doubled(box()), report);
    ASSERT_EQ(both.mesh.positions.size(), 16U);
    for (std::size_t t = 0; t < 12; ++t) {
        for (int i = 0; i < 3; ++i) {
            const glm::vec3 expected = single.mesh.normals[single.mesh.triangles[t][i]];
            EXPECT_EQ(both.mesh.normals[both.mesh.triangles[t][i]], expected);
            // The back begins with the second corner of its front.
            const int at_back = i == 0 ? 1 : i == 1 ? 0 : 2;
            EXPECT_EQ(both.mesh.normals[both.mesh.triangles[t + 12][at_back]], -expected);
        }
    }
}

TEST(DoubledTriangles, ContinueIntoSingleOnes) {
    Report report;
    const Mesh half = with_backs(plane(), [](std::uint32_t t) { return t % 8 < 4; });
    const FramedMesh framed = averaged(half, report);
    EXPECT_FLOAT_EQ(min_cosine(framed.mesh), 1.0F);
    EXPECT_EQ(framed.mesh.positions.size(), 40U);
    EXPECT_EQ(report.count("double-sided triangle"), 16U);
    const FramedMesh one =
        averaged(with_backs(box(), [](std::uint32_t t) { return t == 0; }), report);
    EXPECT_GT(min_cosine(one.mesh), 0.4F);
}

TEST(DoubledTriangles, KeepANormalForEachSideWithCreases) {
    for (const double degrees : {0.0, 40.0, 100.0, 180.0}) {
        Report report;
        const FramedMesh framed =
            averaged(doubled(box()), report, degrees * std::numbers::pi / 180.0);
        EXPECT_GT(min_cosine(framed.mesh), degrees < 90.0 ? 0.999F : 0.4F) << degrees;
        EXPECT_EQ(report.count("cancelling normals"), 0U) << degrees;
    }
}

TEST(DoubledTriangles, DoNotIncludeRepeatedOnes) {
    Mesh mesh = plane();
    const std::vector<glm::uvec3> once = mesh.triangles;
    for (const glm::uvec3& t : once)
        mesh.triangles.emplace_back(t.z, t.x, t.y);
    Report report;
    const FramedMesh framed = averaged(mesh, report);
    EXPECT_EQ(framed.mesh.positions.size(), 25U);
    EXPECT_FLOAT_EQ(min_cosine(framed.mesh), 1.0F);
    EXPECT_EQ(report.count("double-sided triangle"), 0U);
    // Each side twice.
    const FramedMesh both = averaged(doubled(mesh), report);
    EXPECT_EQ(both.mesh.positions.size(), 50U);
    EXPECT_FLOAT_EQ(min_cosine(both.mesh), 1.0F);
}

TEST(DoubledTriangles, DoNotChangeOtherPositions) {
    // Two cones that share their tips are one fan without doubled triangles.
    Mesh mesh;
    mesh.positions = {{0, 0, 0},  {1, 0, 1}, {0, 1, 1}, {1, 0, -3},
                      {0, 1, -3}, {9, 0, 0}, {9, 1, 0}, {9, 0, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 3, 4}, {5, 6, 7}};
    Report report;
    const FramedMesh without = averaged(mesh, report);
    mesh.triangles.emplace_back(6, 5, 7);
    const FramedMesh with = averaged(mesh, report);
    EXPECT_EQ(with.mesh.normals[0], without.mesh.normals[0]);
    EXPECT_EQ(with.mesh.positions.size(), 11U);
}

TEST(DoubledTriangles, HaveTheSameNormalsInAnyOrder) {
    const Mesh mesh = with_backs(doubled(box()), [](std::uint32_t t) { return t % 3 == 0; });
    Mesh joined = mesh;
    // A wall in three directions around an edge of the box.
    joined.positions.emplace_back(2, 2, 0);
    joined.positions.emplace_back(2, 2, 1);
    joined.triangles.emplace_back(3, 7, 8);
    joined.triangles.emplace_back(7, 3, 8);
    joined.triangles.emplace_back(7, 9, 8);
    std::mt19937 random(1);
    for (const std::optional<double> crease : {std::optional<double>(), std::optional(1.0)}) {
        Report report;
        const FramedMesh expected = averaged(joined, report, crease);
        for (int round = 0; round < 20; ++round) {
            std::vector<std::size_t> order(joined.triangles.size());
            std::iota(order.begin(), order.end(), std::size_t(0));
            std::shuffle(order.begin(), order.end(), random);
            Mesh mixed = joined;
            std::vector<int> turn;
            for (std::size_t i = 0; i < order.size(); ++i) {
                const glm::uvec3 t = joined.triangles[order[i]];
                turn.push_back(static_cast<int>(random() % 3));
                for (int k = 0; k < 3; ++k)
                    mixed.triangles[i][k] = t[(k + turn[i]) % 3];
            }
            const FramedMesh result = averaged(mixed, report, crease);
            for (std::size_t i = 0; i < order.size(); ++i) {
                for (int k = 0; k < 3; ++k) {
                    const std::uint32_t vertex =
                        expected.mesh.triangles[order[i]][(k + turn[i]) % 3];
                    ASSERT_EQ(result.mesh.normals[result.mesh.triangles[i][k]],
                              expected.mesh.normals[vertex]);
                }
            }
        }
    }
}

TEST(TriangleStacks, NameTheFirstTriangleAtThePositions) {
    const std::vector<glm::uvec3> triangles = {{0, 1, 2}, {3, 4, 5}, {2, 1, 0}, {0, 0, 1},
                                               {0, 1, 0}, {1, 2, 0}, {6, 7, 8}};
    EXPECT_EQ(triangle_stacks(triangles), (std::vector<std::uint32_t>{0, 1, 0, 3, 3, 0, 6}));
    const std::vector<std::uint32_t> classes = {0, 1, 2, 3, 4, 5, 3, 4, 5};
    EXPECT_EQ(triangle_stacks(triangles, classes),
              (std::vector<std::uint32_t>{0, 1, 0, 3, 3, 0, 1}));
    EXPECT_TRUE(triangle_stacks(plane().triangles).empty());
    EXPECT_FALSE(detail::are_opposite({0, 1, 2}, {1, 2, 0}));
    EXPECT_TRUE(detail::are_opposite({0, 1, 2}, {0, 2, 1}));
    EXPECT_FALSE(detail::are_opposite({0, 0, 1}, {0, 1, 0}));
}

}  // namespace
}  // namespace relief
