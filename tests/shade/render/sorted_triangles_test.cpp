// SPDX-License-Identifier: Apache-2.0
// Painter's order, by hand.
#include "render/gpu_mesh.h"

#include <gtest/gtest.h>

#include <limits>

namespace relief {
namespace {

/// Small triangles at these depths along z.
Mesh stack(const std::vector<float>& depths) {
    Mesh mesh;
    for (const float z : depths) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), {{0, 0, z}, {1, 0, z}, {0, 1, z}});
        mesh.triangles.emplace_back(first, first + 1, first + 2);
    }
    return mesh;
}

std::vector<std::uint32_t> order(SortedTriangles& triangles, const glm::vec3& farther) {
    std::vector<std::uint32_t> result;
    for (const glm::uvec3& triangle : triangles.sort(farther))
        result.push_back(triangle.x / 3);
    return result;
}

using Order = std::vector<std::uint32_t>;

TEST(SortedTriangles, StandFarthestFirst) {
    const Mesh mesh = stack({0, 3, -2, 1});
    SortedTriangles triangles(mesh, {0, 4, std::nullopt});
    EXPECT_EQ(order(triangles, {0, 0, 1}), (Order{1, 3, 0, 2}));
    EXPECT_EQ(order(triangles, {0, 0, -5}), (Order{2, 0, 3, 1}));
    EXPECT_EQ(triangles.center().z, 0.5F);
}

TEST(SortedTriangles, KeepTheMeshsOrderWhereTheyAreEquallyFar) {
    const Mesh mesh = stack({1, 0, 1, 0});
    SortedTriangles triangles(mesh, {0, 4, std::nullopt});
    EXPECT_EQ(order(triangles, {0, 0, 1}), (Order{0, 2, 1, 3}));
    EXPECT_EQ(order(triangles, {1, 0, 0}), (Order{0, 1, 2, 3}));
}

TEST(SortedTriangles, OfARangeAreItsOwn) {
    const Mesh mesh = stack({0, 3, -2, 1});
    SortedTriangles triangles(mesh, {1, 2, std::nullopt});
    EXPECT_EQ(order(triangles, {0, 0, 1}), (Order{1, 2}));
}

TEST(SortedTriangles, WithoutAPlaceComeLast) {
    const Mesh mesh = stack(
        {0, std::numeric_limits<float>::quiet_NaN(), 2, std::numeric_limits<float>::infinity()});
    SortedTriangles triangles(mesh, {0, 4, std::nullopt});
    EXPECT_EQ(order(triangles, {0, 0, 1}), (Order{2, 0, 1, 3}));
    EXPECT_EQ(triangles.center().x, glm::vec3(1.0F / 3.0F).x * 0.5F);  // Two of four count.
}

}  // namespace
}  // namespace relief
