// SPDX-License-Identifier: Apache-2.0
// Corner numbers, and which corners stand at a vertex.
#include "geometry/corners.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace relief {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

const std::vector<glm::uvec3> skewed_quad = {{0, 1, 2}, {0, 2, 4}};

TEST(Corners, GoAroundTheirTriangle) {
    EXPECT_EQ(triangle_of(5), 1U);
    EXPECT_EQ(next_in_triangle(3), 4U);
    EXPECT_EQ(next_in_triangle(5), 3U);
    EXPECT_EQ(previous_in_triangle(3), 5U);
    EXPECT_EQ(previous_in_triangle(5), 4U);
    EXPECT_EQ(vertex_of(5, skewed_quad), 4U);
}

TEST(Corners, AreListedByVertexInAscendingOrder) {
    const CornersByVertex corners(5, skewed_quad);
    EXPECT_EQ(corners.vertex_count(), 5U);
    EXPECT_THAT(corners.at(0), ElementsAre(0, 3));
    EXPECT_THAT(corners.at(1), ElementsAre(1));
    EXPECT_THAT(corners.at(2), ElementsAre(2, 4));
    EXPECT_THAT(corners.at(3), IsEmpty());
    EXPECT_THAT(corners.at(4), ElementsAre(5));
}

TEST(Corners, OfTrianglesThatDoNotCountAreLeftOut) {
    const CornersByVertex corners(5, skewed_quad,
                                  [](std::size_t triangle) { return triangle == 1; });
    EXPECT_THAT(corners.at(0), ElementsAre(3));
    EXPECT_THAT(corners.at(1), IsEmpty());
}

}  // namespace
}  // namespace relief
