// SPDX-License-Identifier: Apache-2.0
// Comparison of two meshes corner by corner: the match is independent of order, splits and
// rotation, and angles are known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <numbers>
#include <random>

#include "relief/mesh/compare.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "support/labels.h"
#include "support/shapes.h"

namespace relief {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// The rounding of float directions rotated by a known angle.
constexpr double angle_tolerance = 1e-4;

/// The same triangles with separate vertices, in another order and with other first corners.
Mesh shuffled_mesh(const Mesh& mesh, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<std::size_t> order(mesh.triangles.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        order[i] = i;
    std::shuffle(order.begin(), order.end(), random);
    Mesh result;
    for (const std::size_t t : order) {
        const auto first = static_cast<std::uint32_t>(result.positions.size());
        const auto turn = static_cast<int>(random() % 3);
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t v = mesh.triangles[t][(k + turn) % 3];
            result.positions.push_back(mesh.positions[v]);
            if (!mesh.normals.empty()) result.normals.push_back(mesh.normals[v]);
            if (!mesh.texcoords.empty()) result.texcoords.push_back(mesh.texcoords[v]);
            if (!mesh.tangents.empty()) result.tangents.push_back(mesh.tangents[v]);
        }
        result.triangles.emplace_back(first, first + 1, first + 2);
    }
    return result;
}

/// Returns the vector rotated about the y axis.
glm::vec3 about_y(const glm::vec3& v, double degrees) {
    const double angle = degrees * std::numbers::pi / 180.0;
    return {v.x * std::cos(angle) + v.z * std::sin(angle), v.y,
            v.z * std::cos(angle) - v.x * std::sin(angle)};
}

FrameComparison comparison(const Mesh& a, const Mesh& b, const MatchOptions& options = {}) {
    const CornerMatch match = match_corners(a, b, options);
    return compared(corner_differences(a, b, match), match, 0, a.triangles.size());
}

TEST(Compare, AnInvalidMeshIsRefused) {
    const Mesh torus = make_torus();
    Mesh wrong = torus;
    wrong.triangles[7].y = 100'000'000;
    EXPECT_THROW(match_corners(torus, wrong), InvalidInput);
    EXPECT_THROW(match_corners(wrong, torus), InvalidInput);
}

TEST(Compare, AMeshWithItself) {
    const Mesh torus = test::with_tangents(make_torus());
    const CornerMatch match = match_corners(torus, torus);
    EXPECT_EQ(match.exact, torus.triangles.size());
    EXPECT_EQ(match.near + match.ambiguous, 0U);
    EXPECT_THAT(match.only_a, IsEmpty());
    EXPECT_THAT(match.only_b, IsEmpty());
    for (std::uint32_t corner = 0; corner < match.corners.size(); ++corner)
        ASSERT_EQ(match.corners[corner], corner);
    const FrameComparison result = comparison(torus, torus);
    EXPECT_EQ(result.corners, 3 * torus.triangles.size());
    EXPECT_EQ(result.normals.max, 0.0);
    EXPECT_EQ(result.tangents.max, 0.0);
    EXPECT_EQ(result.tangents.count, result.corners);
    EXPECT_EQ(result.sign_differences, 0U);
    EXPECT_THAT(result.worst_normals, IsEmpty());
}

TEST(Compare, IgnoresOrderSplitsAndRotationOfCorners) {
    const Mesh torus = test::with_tangents(make_torus());
    for (const unsigned seed : {1U, 2U}) {
        const Mesh other = shuffled_mesh(torus, seed);
        const CornerMatch match = match_corners(torus, other);
        EXPECT_EQ(match.exact, torus.triangles.size());
        for (std::size_t corner = 0; corner < match.corners.size(); ++corner) {
            const std::uint32_t v = torus.triangles[corner / 3][static_cast<int>(corner % 3)];
            const std::uint32_t partner = match.corners[corner];
            const std::uint32_t w = other.triangles[partner / 3][static_cast<int>(partner % 3)];
            ASSERT_EQ(torus.positions[v], other.positions[w]);
            ASSERT_EQ(torus.texcoords[v], other.texcoords[w]);
        }
        EXPECT_EQ(comparison(torus, other).tangents.max, 0.0);
    }
}

TEST(Compare, AnglesAndSignsAreThoseMade) {
    const Mesh quad = test::with_tangents(make_quad(2));
    Mesh other = quad;
    for (std::size_t v = 0; v < other.normals.size(); ++v) {
        other.normals[v] = about_y(other.normals[v], 3.0);
        other.tangents[v] = glm::vec4(about_y(glm::vec3(other.tangents[v]), 60.0), -1.0F);
    }
    const FrameComparison result = comparison(quad, shuffled_mesh(other, 3));
    EXPECT_EQ(result.corners, 24U);
    EXPECT_NEAR(result.normals.rms, 3.0, angle_tolerance);
    EXPECT_NEAR(result.normals.median, 3.0, angle_tolerance);
    EXPECT_THAT(result.normals.histogram, ElementsAre(0, 0, 0, 24, 0, 0, 0));
    EXPECT_NEAR(result.tangents.max, 60.0, angle_tolerance);
    EXPECT_THAT(result.tangents.histogram, ElementsAre(0, 0, 0, 0, 0, 24, 0));
    EXPECT_EQ(result.sign_differences, 24U);
}

TEST(Compare, TheWorstCornersAreNamed) {
    const Mesh quad = make_quad(2);
    Mesh other = quad;
    const std::uint32_t vertex = other.triangles[3].y;
    other.normals[vertex] = about_y(other.normals[vertex], 20.0);
    const CornerMatch match = match_corners(quad, other);
    const FrameComparison result = compared(corner_differences(quad, other, match), match, 3, 1, 2);
    ASSERT_EQ(result.worst_normals.size(), 1U) << "corners that do not differ are not among them";
    EXPECT_EQ(result.worst_normals[0].corner_a, 10U);
    EXPECT_EQ(result.worst_normals[0].corner_b, 10U);
    EXPECT_NEAR(result.worst_normals[0].degrees, 20.0, angle_tolerance);
    EXPECT_EQ(result.corners, 3U);
}

TEST(Compare, DirectionsThatAreNoneAreUndefined) {
    const Mesh quad = make_quad();
    Mesh other = quad;
    other.normals[0] = glm::vec3(0.0F);
    other.normals[1] = glm::vec3(std::numeric_limits<float>::quiet_NaN());
    const FrameComparison result = comparison(quad, other);
    EXPECT_GT(result.normals.undefined, 0U);
    EXPECT_EQ(result.normals.undefined + result.normals.count, 6U);
    EXPECT_EQ(result.normals.max, 0.0);
    ASSERT_FALSE(result.worst_normals.empty());
    EXPECT_TRUE(std::isnan(result.worst_normals[0].degrees));
}

TEST(Compare, OtherTrianglesHaveNoPartner) {
    const Mesh quad = make_quad(2);
    Mesh other = quad;
    std::swap(other.triangles[0].x, other.triangles[0].y);  // Reverses the triangle.
    other.triangles.erase(other.triangles.begin() + 4);
    other.material_ranges.clear();
    const CornerMatch match = match_corners(quad, other);
    EXPECT_THAT(match.only_a, ElementsAre(0, 4));
    EXPECT_THAT(match.only_b, ElementsAre(0));
    EXPECT_EQ(match.exact, 6U);
    EXPECT_EQ(match.corners[0], no_corner_matched);
    EXPECT_EQ(match.corners[15], 12U) << "those behind the missing one move up";
}

TEST(Compare, TextureCoordinatesDistinguishCoincidentTriangles) {
    Mesh twice = make_quad();
    const Mesh once = twice;
    for (std::size_t v = 0; v < 4; ++v) {
        twice.positions.push_back(once.positions[v]);
        twice.normals.push_back(-once.normals[v]);
        twice.texcoords.push_back(once.texcoords[v] + 1.0F);
    }
    for (const glm::uvec3& triangle : once.triangles)
        twice.triangles.push_back(triangle + 4U);
    twice.material_ranges.clear();
    const Mesh other = shuffled_mesh(twice, 5);
    const CornerMatch match = match_corners(twice, other);
    EXPECT_EQ(match.exact, 4U);
    EXPECT_EQ(match.ambiguous, 0U);
    EXPECT_EQ(comparison(twice, other).normals.max, 0.0);

    MatchOptions by_position;
    by_position.by_texcoord = false;
    const CornerMatch ambiguous = match_corners(twice, other, by_position);
    EXPECT_EQ(ambiguous.exact, 4U);
    EXPECT_EQ(ambiguous.ambiguous, 4U);
    EXPECT_FALSE(ambiguous.by_texcoord);
    // Both sides are sorted by value, so equal ones still match.
    EXPECT_EQ(comparison(twice, other, by_position).normals.max, 0.0);
}

TEST(Compare, RangesOfTheSameNumberGoTogether) {
    Mesh twice = make_quad();
    const std::size_t count = twice.triangles.size();
    const Mesh once = twice;
    for (std::size_t v = 0; v < 4; ++v) {
        twice.positions.push_back(once.positions[v]);
        twice.normals.push_back(about_y(once.normals[v], -30.0));
        twice.texcoords.push_back(once.texcoords[v]);
    }
    for (const glm::uvec3& triangle : once.triangles)
        twice.triangles.push_back(triangle + 4U);
    twice.material_ranges = {{0, 2, 0U}, {2, 2, 1U}};
    Mesh other = twice;
    for (std::size_t v = 0; v < 4; ++v)
        other.normals[v] = about_y(once.normals[v], -60.0);  // It sorts before that of the second
                                                             // copy.
    const CornerMatch match = match_corners(twice, other);
    EXPECT_EQ(match.ambiguous, 0U);
    for (std::uint32_t corner = 0; corner < 6 * count; ++corner)
        EXPECT_EQ(match.corners[corner], corner);
}

TEST(Compare, NearCornersMatchWithinTheTolerances) {
    const Mesh torus = make_torus();
    Mesh moved = shuffled_mesh(torus, 7);
    std::mt19937 random(8);
    std::uniform_real_distribution<float> by(-1.0F, 1.0F);
    for (std::size_t v = 0; v < moved.positions.size(); ++v) {
        moved.positions[v] += 1e-5F * glm::vec3(by(random), by(random), by(random));
        moved.texcoords[v] += 1e-6F * glm::vec2(by(random), by(random));
    }
    EXPECT_EQ(match_corners(torus, moved).exact + match_corners(torus, moved).near, 0U);
    MatchOptions options;
    options.position_tolerance = 2e-5;
    options.texcoord_tolerance = 2e-6;
    const CornerMatch match = match_corners(torus, moved, options);
    EXPECT_EQ(match.near, torus.triangles.size());
    EXPECT_EQ(match.ambiguous, 0U);
    EXPECT_EQ(comparison(torus, moved, options).normals.max, 0.0);
    options.texcoord_tolerance = 1e-9;
    EXPECT_LT(match_corners(torus, moved, options).near, 10U);
    options.by_texcoord = false;
    EXPECT_EQ(match_corners(torus, moved, options).near, torus.triangles.size());
    options.position_tolerance = 1e-7;
    EXPECT_LT(match_corners(torus, moved, options).near, 10U);
}

/// The tolerance is far larger than triangles, so every triangle is a candidate for every other.
TEST(Compare, WideTolerancesFindTheNearestToo) {
    const Mesh torus = make_torus();
    Mesh moved = shuffled_mesh(torus, 7);
    std::mt19937 random(8);
    std::uniform_real_distribution<float> by(-1e-4F, 1e-4F);
    for (glm::vec3& position : moved.positions)
        position += glm::vec3(by(random), by(random), by(random));
    MatchOptions options;
    options.by_texcoord = false;
    for (const double tolerance : {0.05, 0.5, 5.0, 1000.0}) {
        SCOPED_TRACE(tolerance);
        options.position_tolerance = tolerance;
        EXPECT_EQ(match_corners(torus, moved, options).near, torus.triangles.size());
        EXPECT_EQ(comparison(torus, moved, options).normals.max, 0.0);
    }
}

/// NaN must not break the order by which triangles with the same corners match.
TEST(Compare, RepeatedTrianglesWithUndefinedNormalsMeetTheirEquals) {
    Mesh repeated;
    for (std::uint32_t i = 0; i < 200; ++i) {
        repeated.positions.insert(repeated.positions.end(), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
        const float x =
            i % 3 == 0 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(i * 37 % 200);
        repeated.normals.insert(repeated.normals.end(), 3, glm::vec3(x, 0.0F, 100.0F));
        repeated.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    }
    const FrameComparison result = comparison(repeated, shuffled_mesh(repeated, 4));
    EXPECT_EQ(result.normals.undefined, 3U * 67U);
    EXPECT_EQ(result.normals.max, 0.0);
}

TEST(Compare, TheNearestIsTaken) {
    Mesh a = make_quad();
    a.texcoords.clear();
    a.material_ranges.clear();
    Mesh b = a;
    // The mesh b has another copy of everything, at a larger distance, before the near one.
    for (glm::vec3& position : b.positions)
        position.z += 0.02F;
    for (const glm::vec3& position : a.positions) {
        b.positions.push_back(position + glm::vec3(0.0F, 0.0F, 0.01F));
        b.normals.emplace_back(1.0F, 0.0F, 0.0F);
    }
    for (std::size_t t = 0; t < 2; ++t)
        b.triangles.push_back(b.triangles[t] + 4U);
    MatchOptions options;
    options.position_tolerance = 0.05;
    const CornerMatch match = match_corners(a, b, options);
    EXPECT_EQ(match.near, 2U);
    EXPECT_THAT(match.only_b, ElementsAre(0, 1));
    EXPECT_EQ(match.corners[0], 6U);
}

TEST(Compare, NonFiniteTrianglesHaveNoMatch) {
    Mesh quad = make_quad();
    quad.positions[0].x = std::numeric_limits<float>::quiet_NaN();
    MatchOptions options;
    options.position_tolerance = 1.0;
    options.texcoord_tolerance = 1.0;
    const CornerMatch match = match_corners(quad, quad, options);
    EXPECT_EQ(match.only_a, match.only_b);
    EXPECT_EQ(match.only_a.size() + match.exact + match.near, 2U);
    EXPECT_FALSE(match.only_a.empty());
}

TEST(Compare, CollapsedTrianglesMatchOnceEach) {
    Mesh points;
    points.positions = {{0, 0, 0}, {1, 0, 0}};
    points.triangles = {{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, {1, 0, 0}};
    const CornerMatch match = match_corners(points, shuffled_mesh(points, 9));
    EXPECT_EQ(match.exact, 4U);
    EXPECT_EQ(match.ambiguous, 3U) << "three are the same triangle, begun elsewhere";
}

TEST(Compare, EmptyMeshes) {
    const CornerMatch match = match_corners({}, make_quad());
    EXPECT_EQ(match.only_b.size(), 2U);
    EXPECT_EQ(comparison({}, {}).corners, 0U);
    EXPECT_EQ(comparison({}, {}), FrameComparison());
}

/// Returns the least processor time, in clock ticks, of matching meshes that have so many triangles
/// at one position.
std::clock_t clocks_of_crowd(std::size_t triangles) {
    Mesh crowd;
    crowd.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    Mesh other = crowd;
    other.positions[1].x = 1.0001F;
    crowd.triangles.assign(triangles, {0, 1, 2});
    other.triangles.assign(triangles, {0, 1, 2});
    MatchOptions options;
    options.position_tolerance = 0.01;
    std::clock_t least = std::numeric_limits<std::clock_t>::max();
    for (int i = 0; i < 3; ++i) {
        const std::clock_t start = std::clock();
        EXPECT_EQ(match_corners(crowd, crowd, options).exact, triangles);
        EXPECT_GT(match_corners(crowd, other, options).near, 0U);
        least = std::min(least, std::clock() - start);
    }
    return least;
}

TEST_LABELS(not_sanitized);
TEST(Compare, CrowdsDoNotTakeQuadraticTime) {
    const std::clock_t few = clocks_of_crowd(2000);
    // 8 times as many take 8 times as long if the time is linear, and 64 times if it is quadratic.
    EXPECT_LT(clocks_of_crowd(16000), 24 * few);
}

}  // namespace
}  // namespace relief
