// SPDX-License-Identifier: Apache-2.0
// Which triangles rays meet, and where: watertight, all of them, at every scale.
#include "reference/visibility.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/shapes.h"

namespace relief::reference {
namespace {

/// A mesh somewhere in view space.
struct Placed {
    std::vector<glm::dvec3> positions;
    std::vector<glm::uvec3> triangles;

    [[nodiscard]] ViewMesh view() const { return {positions, triangles}; }
};

Placed placed(const Mesh& mesh, const glm::dvec3& at, double scale = 1.0) {
    Placed result;
    for (const glm::vec3& position : mesh.positions)
        result.positions.push_back((glm::dvec3(position) + at) * scale);
    result.triangles = mesh.triangles;
    return result;
}

/// A grid of 4 x 4 cells whose vertices, edges and diagonals lie on rays of simple numbers.
Placed wall() {
    return placed(test::grid(4), {-0.5, -0.5, -1.0});
}

TEST(Visibility, MeetsSharedEdgesAndVerticesOnceInside) {
    const Placed mesh = wall();
    const Visibility visibility({mesh.view()}, 0.1, 10.0);
    for (int y = -30; y <= 30; ++y) {
        for (int x = -30; x <= 30; ++x) {
            const auto hits = visibility.hits(x / 64.0, y / 64.0);
            // Where six triangles meet, two of them that share no edge may both count.
            const bool at_vertex = x % 16 == 0 && y % 16 == 0;
            EXPECT_GE(hits.size(), 1U) << x << ", " << y;
            EXPECT_LE(hits.size(), at_vertex ? 3U : 1U) << x << ", " << y;
        }
    }
    EXPECT_TRUE(visibility.hits(0.51, 0.0).empty());
}

TEST(Visibility, KnowsWhereATriangleIsMet) {
    Placed mesh;
    mesh.positions = {{-1, -1, -2}, {3, -1, -4}, {-1, 3, -2}};
    mesh.triangles = {{0, 1, 2}};
    const Visibility visibility({mesh.view()}, 0.1, 10.0);
    // The point (0.5, 0, -2.75) is a quarter, three eighths of the way: weights 3/8, 3/8, 1/4.
    const auto hits = visibility.hits(0.5 / 2.75, 0.0);
    ASSERT_EQ(hits.size(), 1U);
    EXPECT_NEAR(hits[0].barycentric.x, 0.375, 1e-14);
    EXPECT_NEAR(hits[0].barycentric.y, 0.375, 1e-14);
    EXPECT_NEAR(hits[0].barycentric.z, 0.25, 1e-14);
    EXPECT_NEAR(hits[0].depth, 2.75, 1e-14);
    EXPECT_TRUE(hits[0].counter_clockwise);
}

TEST(Visibility, FindsEveryHitNearestFirst) {
    const Placed back = placed(test::grid(1), {-0.5, -0.5, -3.0});
    const Placed front = placed(test::grid(1), {-0.5, -0.5, -2.0});
    const Placed ball = placed(test::sphere(24, 12), {0.0, 0.0, -5.0});
    const Visibility visibility({back.view(), front.view(), ball.view()}, 0.1, 10.0);
    const auto hits = visibility.hits(0.01, 0.02);
    ASSERT_EQ(hits.size(), 4U);
    EXPECT_EQ(hits[0].instance, 1U);
    EXPECT_EQ(hits[1].instance, 0U);
    EXPECT_EQ(hits[2].instance, 2U);
    EXPECT_TRUE(hits[2].counter_clockwise);
    EXPECT_EQ(hits[3].instance, 2U);
    EXPECT_FALSE(hits[3].counter_clockwise) << "the far side, from within";
}

TEST(Visibility, EndsAtTheCamerasNearAndFar) {
    const Placed mesh = wall();  // At depth 1.
    EXPECT_EQ(Visibility({mesh.view()}, 1.0, 10.0).hits(0.01, 0.02).size(), 1U);
    EXPECT_EQ(Visibility({mesh.view()}, 1.0000001, 10.0).hits(0.01, 0.02).size(), 0U);
    EXPECT_EQ(Visibility({mesh.view()}, 0.1, 1.0).hits(0.01, 0.02).size(), 1U);
    EXPECT_EQ(Visibility({mesh.view()}, 0.1, 0.9999999).hits(0.01, 0.02).size(), 0U);
}

TEST(Visibility, DoesNotDependOnScale) {
    for (const double scale : {1e-30, 1e-12, 1e12, 1e30}) {
        SCOPED_TRACE(scale);
        const Placed ball = placed(test::sphere(24, 12), {0.0, 0.0, -5.0}, scale);
        const Visibility visibility({ball.view()}, 0.1 * scale, 10.0 * scale);
        const auto hits = visibility.hits(0.03, -0.05);
        ASSERT_EQ(hits.size(), 2U);
        // The sphere itself is met at 4.0279; its facets lie up to a hundredth within.
        EXPECT_NEAR(hits[0].depth / scale, 4.0279, 0.02);
    }
}

TEST(Visibility, HasNoHolesInAFineMesh) {
    // 131,072 triangles: edges pass everywhere, and Embree's floats and exact ones differ.
    const Placed ball = placed(test::sphere(256, 256), {0.0, 0.0, -3.0});
    const Visibility visibility({ball.view()}, 0.1, 10.0);
    std::size_t odd = 0;
    for (int y = 0; y < 200; ++y) {
        for (int x = 0; x < 200; ++x) {
            const auto hits = visibility.hits((x - 99.5) / 400.0, (y - 99.5) / 400.0);
            if (hits.size() != 2U) ++odd;
        }
    }
    EXPECT_EQ(odd, 0U) << "every ray goes in once and comes out once";
}

TEST(Visibility, MeetsNothingWithoutAreaOrPlace) {
    Placed mesh;
    mesh.positions = {{-1, -1, -2}, {1, 1, -2}, {0, 0, -2}, {1, 0, -2}};
    mesh.positions.emplace_back(std::numeric_limits<double>::quiet_NaN(), 0, -2);
    mesh.positions.emplace_back(std::numeric_limits<double>::infinity(), 0, -2);
    mesh.triangles = {{0, 1, 2}, {0, 0, 0}, {0, 1, 4}, {0, 1, 5}};
    EXPECT_TRUE(Visibility({mesh.view()}, 0.1, 10.0).hits(0.01, 0.01).empty());
    EXPECT_TRUE(Visibility({}, 0.1, 10.0).hits(0.0, 0.0).empty());
}

}  // namespace
}  // namespace relief::reference
