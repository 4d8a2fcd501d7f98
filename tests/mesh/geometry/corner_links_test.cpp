// SPDX-License-Identifier: Apache-2.0
// Neighbours across edges, in the plain case and where an edge has more than two triangles.
#include "geometry/corner_links.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace relief {
namespace {

using testing::ElementsAre;
constexpr Gradient up = Gradient::upright;
constexpr Gradient down = Gradient::mirrored;
constexpr Gradient none = Gradient::none;

CornerLinks links_of(const std::vector<glm::uvec3>& triangles, const std::vector<Gradient>& kinds,
                     std::size_t vertex_count = 10) {
    return link_corners(triangles, CornersByVertex(vertex_count, triangles), kinds);
}

/// The neighbour of triangle `t` across its edge `i` (from corner i to the next), or -1.
int neighbour(const CornerLinks& links, std::uint32_t t, std::uint32_t i) {
    const Corner corner = links.across[3 * t + i];
    return corner == no_corner ? -1 : static_cast<int>(triangle_of(corner));
}

TEST(CornerLinks, TwoTrianglesOfAQuadMeetAtTheDiagonal) {
    const std::vector<glm::uvec3> triangles = {{0, 1, 2}, {0, 2, 3}};
    const CornerLinks links = links_of(triangles, {up, up});
    // Triangle 0 leaves vertex 2 towards 0; triangle 1 stands at vertex 2 with its corner 1.
    EXPECT_THAT(links.across, ElementsAre(no_corner, no_corner, 4, 0, no_corner, no_corner));
    EXPECT_EQ(links.across_previous(4), 2U);
    EXPECT_EQ(links.across_previous(0), 3U);
    EXPECT_EQ(links.across_previous(1), no_corner);
}

TEST(CornerLinks, TrianglesThatRunAlongAnEdgeTheSameWayAreNoNeighbours) {
    const CornerLinks links = links_of({{0, 1, 2}, {0, 1, 3}}, {up, up});
    for (const Corner corner : links.across)
        EXPECT_EQ(corner, no_corner);
}

TEST(CornerLinks, AtACrowdedEdgeTrianglesOfOneHandednessPairFirst) {
    // Edge 0-1: two leave vertex 0 (up, down), two arrive (down, up).
    const std::vector<glm::uvec3> triangles = {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}, {1, 0, 5}};
    const CornerLinks links = links_of(triangles, {up, down, down, up});
    EXPECT_EQ(neighbour(links, 0, 0), 3);
    EXPECT_EQ(neighbour(links, 1, 0), 2);
    EXPECT_EQ(neighbour(links, 2, 0), 1);
    EXPECT_EQ(neighbour(links, 3, 0), 0);
}

TEST(CornerLinks, AmongEqualsTheSmallerThirdVerticesPairWhateverTheOrder) {
    const std::vector<glm::uvec3> triangles = {{0, 1, 3}, {0, 1, 2}, {1, 0, 5}, {1, 0, 4}};
    const CornerLinks links = links_of(triangles, {up, up, up, up});
    EXPECT_EQ(neighbour(links, 1, 0), 3);
    EXPECT_EQ(neighbour(links, 0, 0), 2);
}

TEST(CornerLinks, ATriangleWithoutGradientTakesWhatIsLeft) {
    const std::vector<glm::uvec3> triangles = {{0, 1, 2}, {1, 0, 3}, {1, 0, 4}, {0, 1, 5}};
    const CornerLinks links = links_of(triangles, {up, up, none, down});
    EXPECT_EQ(neighbour(links, 0, 0), 1);
    EXPECT_EQ(neighbour(links, 2, 0), 3);
}

TEST(CornerLinks, TheThirdTriangleOnAnEdgeIsLeftAlone) {
    const CornerLinks links = links_of({{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}, {up, up, up});
    EXPECT_EQ(neighbour(links, 0, 0), 1);
    EXPECT_EQ(neighbour(links, 2, 0), -1);
}

TEST(CornerLinks, ARepeatedTriangleIsKnownByItsTwinInAnyRotation) {
    const std::vector<glm::uvec3> triangles = {
        {1, 2, 0}, {0, 1, 2}, {2, 0, 1}, {1, 0, 3}, {2, 1, 0}};
    const CornerLinks links = links_of(triangles, {up, up, up, up, down});
    // The one that starts at its smallest vertex counts, wherever it stands.
    EXPECT_THAT(links.twin, ElementsAre(1, 1, 1, 3, 4));
    EXPECT_EQ(neighbour(links, 1, 0), 3);
    EXPECT_EQ(neighbour(links, 3, 0), 1);
    EXPECT_EQ(neighbour(links, 0, 2), -1);
}

}  // namespace
}  // namespace relief
