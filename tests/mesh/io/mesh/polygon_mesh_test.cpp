// SPDX-License-Identifier: Apache-2.0
// Triangulation of polygons: quads like MikkTSpace, ears, and fans of bad polygons.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>

#include "io/mesh/polygon_mesh.h"

namespace relief {
namespace {

using testing::ElementsAre;

using Points = std::vector<glm::vec3>;

std::vector<glm::uvec3> cut(const Points& positions, const std::vector<glm::vec2>& texcoords = {}) {
    std::vector<glm::uvec3> triangles;
    EXPECT_TRUE(triangulate_polygon(positions, texcoords, triangles));
    return triangles;
}

/// Twice the signed area in the xy plane.
double area(const Points& p, const glm::uvec3& t) {
    const glm::dvec3 cross = glm::cross(glm::dvec3(p[t.y]) - glm::dvec3(p[t.x]),
                                        glm::dvec3(p[t.z]) - glm::dvec3(p[t.x]));
    return cross.z;
}

double polygon_area(const Points& p) {
    double sum = 0.0;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const glm::dvec3 a(p[i]);
        const glm::dvec3 b(p[(i + 1) % p.size()]);
        sum += a.x * b.y - a.y * b.x;
    }
    return sum;
}

const Points unit_square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

TEST(PolygonTriangulation, ASquareIsCutFromFirstToThirdCorner) {
    EXPECT_THAT(cut(unit_square), ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3)));
}

TEST(PolygonTriangulation, AQuadIsCutAlongItsShorterDiagonal) {
    EXPECT_THAT(cut({{0, 0, 0}, {1, 0, 0}, {3, 1, 0}, {0, 1, 0}}),
                ElementsAre(glm::uvec3(0, 1, 3), glm::uvec3(1, 2, 3)));
}

TEST(PolygonTriangulation, TheTextureDecidesBeforeTheSpace) {
    // Longer from first to third in space, shorter in the texture.
    const std::vector<glm::vec2> texcoords = {{0, 0}, {2, 0}, {1, 1}, {-1, 1}};
    EXPECT_THAT(cut({{0, 0, 0}, {1, 0, 0}, {3, 1, 0}, {0, 1, 0}}, texcoords),
                ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3)));
    // Equal in the texture: space decides.
    EXPECT_THAT(cut({{0, 0, 0}, {1, 0, 0}, {3, 1, 0}, {0, 1, 0}}, {{0, 0}, {1, 0}, {1, 1}, {0, 1}}),
                ElementsAre(glm::uvec3(0, 1, 3), glm::uvec3(1, 2, 3)));
}

TEST(PolygonTriangulation, AConcaveQuadIsCutAtItsReflexCornerWhateverItsDiagonals) {
    // Reflex at each corner in turn, with a texture that asks for the other diagonal.
    const Points arrow = {{0, 0, 0}, {4, -1, 0}, {1, 0, 0}, {4, 1, 0}};
    for (std::size_t turn = 0; turn < 4; ++turn) {
        Points turned;
        for (std::size_t i = 0; i < 4; ++i)
            turned.push_back(arrow[(i + turn) % 4]);
        for (const glm::vec2& stretch : {glm::vec2(9, 1), glm::vec2(1, 9)}) {
            std::vector<glm::vec2> texcoords;
            for (const glm::vec2& corner : {glm::vec2(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
                texcoords.push_back({corner.x * stretch.x + corner.y, corner.y * stretch.y});
            }
            for (const glm::uvec3& triangle : cut(turned, texcoords)) {
                EXPECT_GT(area(turned, triangle), 0.0) << "turned by " << turn;
            }
        }
    }
}

TEST(PolygonTriangulation, AConvexPolygonBecomesAFanAroundItsFirstCorner) {
    EXPECT_THAT(cut({{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {2, 2, 0}, {0, 2, 0}}),
                ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3), glm::uvec3(0, 3, 4)));
}

/// A star with as many concave as convex corners, in a tilted plane of any scale.
Points star(std::size_t corners, float scale) {
    Points points;
    for (std::size_t i = 0; i < corners; ++i) {
        const double angle =
            2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(corners);
        const double radius = i % 2 == 0 ? 1.0 : 0.4;
        points.push_back(scale * glm::vec3(radius * std::cos(angle), radius * std::sin(angle), 0));
    }
    return points;
}

TEST(PolygonTriangulation, AConcavePolygonIsCoveredExactlyOnceAtAnyScale) {
    for (const float scale : {1e-30F, 1.0F, 1e18F}) {
        const Points points = star(10, scale);
        double sum = 0.0;
        const std::vector<glm::uvec3> triangles = cut(points);
        EXPECT_EQ(triangles.size(), 8U);
        for (const glm::uvec3& triangle : triangles) {
            EXPECT_GT(area(points, triangle), 0.0);
            sum += area(points, triangle);
        }
        // Sums of ten products of floats in double.
        EXPECT_NEAR(sum / polygon_area(points), 1.0, 1e-12) << scale;
    }
}

TEST(PolygonTriangulation, CornersOnAStraightEdgeAreKept) {
    const Points points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 1, 0}};
    double sum = 0.0;
    for (const glm::uvec3& triangle : cut(points)) {
        EXPECT_GT(area(points, triangle), 0.0);
        sum += area(points, triangle);
    }
    EXPECT_EQ(sum, 8.0);
}

TEST(PolygonTriangulation, AHoleReachedThroughABridgeIsLeftOpen) {
    // A square with a square hole, joined by the doubled edge between corners 3 and 4 of the list.
    const Points points = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0},
                           {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}};
    double sum = 0.0;
    for (const glm::uvec3& triangle : cut(points)) {
        EXPECT_GE(area(points, triangle), 0.0);
        sum += area(points, triangle);
    }
    EXPECT_EQ(sum, 2.0 * (16.0 - 4.0));
}

TEST(PolygonTriangulation, WithoutAPlaneItIsAFanAndSaysSo) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<Points> polygons = {
        Points(6, glm::vec3(1.0F)),
        {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}},
        {{0, 0, 0}, {1, 0, 0}, {2, nan, 0}, {1, 1, 0}, {0, 1, 0}},
        {{0, 0, 0},
         {1, 0, 0},
         {1, std::numeric_limits<float>::infinity(), 0},
         {1, 1, 0},
         {0, 1, 0}},
    };
    for (const Points& points : polygons) {
        std::vector<glm::uvec3> triangles;
        EXPECT_FALSE(triangulate_polygon(points, {}, triangles));
        ASSERT_EQ(triangles.size(), points.size() - 2);
        for (std::uint32_t i = 0; i < triangles.size(); ++i) {
            EXPECT_EQ(triangles[i], glm::uvec3(0, i + 1, i + 2));
        }
    }
}

TEST(PolygonTriangulation, QuadsWithNaNAreStillTwoTriangles) {
    Points points = unit_square;
    points[2].x = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THAT(cut(points), ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3)));
}

TEST(PolygonTriangulation, TenThousandCornersTakeLessThanASecond) {
    const auto begin = std::chrono::steady_clock::now();
    const Points points = star(10'000, 1.0F);
    double sum = 0.0;
    for (const glm::uvec3& triangle : cut(points))
        sum += area(points, triangle);
    EXPECT_NEAR(sum / polygon_area(points), 1.0, 1e-9);
    // It takes some ten milliseconds; an algorithm of third order would take minutes.
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
}

}  // namespace

}  // namespace relief
