// SPDX-License-Identifier: Apache-2.0
#include "geometry/edge_pairs.h"

#include <gtest/gtest.h>

#include <vector>

namespace relief::detail {
namespace {

using Pairs = std::vector<EdgePairs::Pair>;

/// A triangle at an edge along z that leaves it in a direction of the x-y plane.
TriangleAtEdge at(Corner corner, bool ascends, double x, double y, std::uint32_t stack) {
    return {corner, ascends, glm::dvec3(x, y, 0.0), stack};
}

Pairs joined(const std::vector<TriangleAtEdge>& triangles) {
    EdgePairs pairs;
    const auto found = pairs.join(triangles);
    return {found.begin(), found.end()};
}

TEST(EdgePairs, JoinsTheFlattestPairFirst) {
    // The second pair is what is left, although its triangles are at a right angle.
    EXPECT_EQ(joined({at(0, true, -1, 0, 0), at(1, false, 0, 1, 1), at(2, false, 1, 0, 2),
                      at(3, true, 1, 0, 3)}),
              (Pairs{{0, 2}, {3, 1}}));
}

TEST(EdgePairs, JoinsOppositeDirectionsOnly) {
    EXPECT_EQ(joined({at(0, true, -1, 0, 0), at(1, true, 1, 0, 1)}), Pairs{});
    EXPECT_EQ(joined({at(0, true, -1, 0, 0), at(1, true, 1, 0, 1), at(2, false, 0, 1, 2)}).size(),
              1U);
}

TEST(EdgePairs, DoesNotJoinTheSidesOfOneTriangle) {
    EXPECT_EQ(joined({at(0, true, -1, 0, 7), at(1, false, -1, 0, 7)}), Pairs{});
    // Two doubled triangles in a plane become two sheets.
    EXPECT_EQ(joined({at(0, true, -1, 0, 7), at(1, false, -1, 0, 7), at(2, false, 1, 0, 8),
                      at(3, true, 1, 0, 8)}),
              (Pairs{{0, 2}, {3, 1}}));
}

TEST(EdgePairs, JoinsManyTriangles) {
    std::vector<TriangleAtEdge> triangles;
    for (Corner i = 0; i < 100; ++i)
        triangles.push_back(at(i, i % 2 == 0, i % 2 == 0 ? -1.0 : 1.0, 0.0, i));
    EXPECT_EQ(joined(triangles), (Pairs{{0, 1}}));
}

}  // namespace
}  // namespace relief::detail
