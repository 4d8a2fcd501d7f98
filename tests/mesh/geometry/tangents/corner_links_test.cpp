// SPDX-License-Identifier: Apache-2.0
// Neighbours across edges, in the plain case and where an edge has more than two triangles.
#include "geometry/tangent_signs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

namespace relief {
namespace {

using testing::ElementsAre;
constexpr Gradient upright = Gradient::upright;
constexpr Gradient mirrored = Gradient::mirrored;
constexpr Gradient no_gradient = Gradient::none;

/// The linker's answers at every vertex, as corners and triangles of the whole mesh.
struct Links {
    std::vector<Corner> across;
    std::vector<Corner> across_previous;
    std::vector<std::uint32_t> twin;
};

Links links_of(const std::vector<glm::uvec3>& triangles, const std::vector<Gradient>& kinds) {
    constexpr std::size_t vertex_count = 10;
    const CornersByVertex corners(vertex_count, triangles);
    const std::vector<Corner> nobody(3 * triangles.size(), no_corner);
    Links links{nobody, nobody, std::vector<std::uint32_t>(triangles.size())};
    CornerLinker linker(triangles, kinds);
    for (std::size_t vertex = 0; vertex < vertex_count; ++vertex) {
        const std::span<const Corner> around = corners.at(vertex);
        linker.link(around);
        const auto corner_at = [&](CornerLinker::Place place) {
            return place == CornerLinker::nowhere ? no_corner : around[place];
        };
        for (CornerLinker::Place i = 0; i < around.size(); ++i) {
            links.across[around[i]] = corner_at(linker.across(i));
            links.across_previous[around[i]] = corner_at(linker.across_previous(i));
            links.twin[triangle_of(around[i])] = triangle_of(corner_at(linker.twin(i)));
        }
    }
    return links;
}

/// The neighbor of triangle `t` across its edge `i` (from corner i to the next), or -1. Both ends
/// of the edge must agree on it.
int neighbor(const Links& links, std::uint32_t t, std::uint32_t i) {
    const Corner corner = links.across[3 * t + i];
    const Corner other_end = links.across_previous[3 * t + (i + 1) % 3];
    const int found = corner == no_corner ? -1 : static_cast<int>(triangle_of(corner));
    EXPECT_EQ(found, other_end == no_corner ? -1 : static_cast<int>(triangle_of(other_end)));
    return found;
}

TEST(CornerLinks, TwoTrianglesOfAQuadMeetAtTheDiagonal) {
    const std::vector<glm::uvec3> triangles = {{0, 1, 2}, {0, 2, 3}};
    const Links links = links_of(triangles, {upright, upright});
    // Triangle 0 leaves vertex 2 towards 0; triangle 1 stands at vertex 2 with its corner 1.
    EXPECT_THAT(links.across, ElementsAre(no_corner, no_corner, 4, 0, no_corner, no_corner));
    EXPECT_THAT(links.across_previous,
                ElementsAre(3, no_corner, no_corner, no_corner, 2, no_corner));
}

TEST(CornerLinks, TrianglesThatRunAlongAnEdgeTheSameWayAreNoNeighbours) {
    const Links links = links_of({{0, 1, 2}, {0, 1, 3}}, {upright, upright});
    for (const Corner corner : links.across)
        EXPECT_EQ(corner, no_corner);
}

TEST(CornerLinks, AtACrowdedEdgeTrianglesOfOneHandednessPairFirst) {
    // Edge 0-1: two leave vertex 0 (up, down), two arrive (down, up).
    const std::vector<glm::uvec3> triangles = {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}, {1, 0, 5}};
    const Links links = links_of(triangles, {upright, mirrored, mirrored, upright});
    EXPECT_EQ(neighbor(links, 0, 0), 3);
    EXPECT_EQ(neighbor(links, 1, 0), 2);
    EXPECT_EQ(neighbor(links, 2, 0), 1);
    EXPECT_EQ(neighbor(links, 3, 0), 0);
}

TEST(CornerLinks, AmongEqualsTheSmallerThirdVerticesPairWhateverTheOrder) {
    const std::vector<glm::uvec3> triangles = {{0, 1, 3}, {0, 1, 2}, {1, 0, 5}, {1, 0, 4}};
    const Links links = links_of(triangles, {upright, upright, upright, upright});
    EXPECT_EQ(neighbor(links, 1, 0), 3);
    EXPECT_EQ(neighbor(links, 0, 0), 2);
}

TEST(CornerLinks, ATriangleWithoutGradientTakesWhatIsLeft) {
    const std::vector<glm::uvec3> triangles = {{0, 1, 2}, {1, 0, 3}, {1, 0, 4}, {0, 1, 5}};
    const Links links = links_of(triangles, {upright, upright, no_gradient, mirrored});
    EXPECT_EQ(neighbor(links, 0, 0), 1);
    EXPECT_EQ(neighbor(links, 2, 0), 3);
}

TEST(CornerLinks, TheThirdTriangleOnAnEdgeIsLeftAlone) {
    const Links links = links_of({{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}, {upright, upright, upright});
    EXPECT_EQ(neighbor(links, 0, 0), 1);
    EXPECT_EQ(neighbor(links, 2, 0), -1);
}

TEST(CornerLinks, ARepeatedTriangleIsKnownByItsTwinInAnyRotation) {
    const std::vector<glm::uvec3> triangles = {
        {1, 2, 0}, {0, 1, 2}, {2, 0, 1}, {1, 0, 3}, {2, 1, 0}};
    const Links links = links_of(triangles, {upright, upright, upright, upright, mirrored});
    // The one that starts at its smallest vertex counts, wherever it stands.
    EXPECT_THAT(links.twin, ElementsAre(1, 1, 1, 3, 4));
    EXPECT_EQ(neighbor(links, 1, 0), 3);
    EXPECT_EQ(neighbor(links, 3, 0), 1);
    EXPECT_EQ(neighbor(links, 0, 2), -1);
}

TEST(CornerLinks, BothEndsOfEveryEdgeAgreeHoweverCrowdedItIs) {
    std::mt19937 random(7);
    for (int round = 0; round < 200; ++round) {
        std::vector<glm::uvec3> triangles;
        std::vector<Gradient> kinds;
        while (triangles.size() < 30) {
            const glm::uvec3 triangle(random() % 6, random() % 6, random() % 6);
            if (triangle.x == triangle.y || triangle.y == triangle.z || triangle.z == triangle.x)
                continue;
            triangles.push_back(triangle);
            // Repeated triangles are of one kind.
            kinds.push_back(std::array{upright, mirrored,
                                       no_gradient}[(triangle.x + triangle.y + triangle.z) % 3]);
        }
        const Links links = links_of(triangles, kinds);
        int neighbors = 0;
        for (std::uint32_t t = 0; t < triangles.size(); ++t) {
            for (std::uint32_t i = 0; i < 3; ++i)
                neighbors += neighbor(links, t, i) >= 0 ? 1 : 0;
        }
        EXPECT_GT(neighbors, 0);
    }
}

/// Places from `links`: the corners at a vertex of triangles around it are a single fan if walking
/// from the first without one before, or from any, reaches all.
bool is_walked_whole(const std::vector<std::uint32_t>& next,
                     const std::vector<std::uint32_t>& previous) {
    std::vector<glm::uvec3> triangles;
    std::vector<Corner> around;
    for (std::size_t i = 0; i < next.size(); ++i) {
        around.push_back(static_cast<Corner>(3 * i));
        triangles.emplace_back(100, next[i], previous[i]);
    }
    const std::vector<Gradient> kinds(next.size(), upright);
    CornerLinker linker(triangles, kinds);
    linker.link(around);
    for (CornerLinker::Place i = 0; i < next.size(); ++i) {
        if (linker.twin(i) != i) return false;
        for (CornerLinker::Place k = 0; k < i; ++k) {
            if (next[i] == next[k] || previous[i] == previous[k]) return false;  // A third one.
        }
    }
    CornerLinker::Place first = 0;
    for (std::size_t steps = 0; steps < next.size(); ++steps) {
        if (linker.across_previous(first) == CornerLinker::nowhere) break;
        first = linker.across_previous(first);
    }
    std::size_t reached = 1;
    for (CornerLinker::Place i = linker.across(first); i != CornerLinker::nowhere && i != first;
         i = linker.across(i))
        ++reached;
    return reached == next.size();
}

TEST(CornerLinks, ASingleFanIsToldFromAllElse) {
    EXPECT_TRUE(is_single_fan(std::array{1U}, std::array{2U}));
    EXPECT_TRUE(is_single_fan(std::array{1U, 2U, 3U}, std::array{3U, 1U, 2U})) << "a ring";
    EXPECT_TRUE(is_single_fan(std::array{2U, 1U}, std::array{3U, 2U})) << "a chain";
    EXPECT_FALSE(is_single_fan(std::array{1U, 3U}, std::array{2U, 4U})) << "two apart";
    EXPECT_FALSE(is_single_fan(std::array{1U, 1U}, std::array{2U, 2U})) << "a triangle twice";
    EXPECT_FALSE(is_single_fan(std::array{1U, 2U, 3U, 4U}, std::array{2U, 1U, 4U, 3U}))
        << "two rings";
    EXPECT_FALSE(is_single_fan(std::array{1U, 1U, 5U}, std::array{2U, 3U, 1U})) << "a third";

    std::mt19937 random(3);
    int fans = 0;
    for (int round = 0; round < 20000; ++round) {
        const std::size_t count = 1 + random() % 5;
        std::vector<std::uint32_t> next, previous;
        for (std::size_t i = 0; i < count; ++i) {
            next.push_back(static_cast<std::uint32_t>(random() % 5));
            previous.push_back(static_cast<std::uint32_t>((next.back() + 1 + random() % 4) % 5));
        }
        const bool expected = is_walked_whole(next, previous);
        ASSERT_EQ(is_single_fan(next, previous), expected) << "round " << round;
        fans += expected ? 1 : 0;
    }
    EXPECT_GT(fans, 500);
    EXPECT_LT(fans, 15000);
}

}  // namespace
}  // namespace relief
