// SPDX-License-Identifier: Apache-2.0
// Which vertices count as one.
#include "geometry/weld.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "support/no_numbers.h"
#include "support/shapes.h"

namespace relief {
namespace {

using test::infinite;
using test::not_a_number;
using testing::ElementsAre;

TEST(Weld, TheSmallestIndexOfAPositionStandsForAll) {
    const std::vector<glm::vec3> positions = {
        {1, 2, 3}, {3, 2, 1}, {1, 2, 3}, {3, 2, 1}, {0, 0, 0}};
    EXPECT_THAT(weld_positions(positions), ElementsAre(0, 1, 0, 1, 4));
}

TEST(Weld, MinusZeroIsZeroAndInfinitiesEqualThemselves) {
    const std::vector<glm::vec3> positions = {
        {0, -0.0F, 1}, {-0.0F, 0, 1}, {infinite, 0, 0}, {infinite, -0.0F, 0}, {-infinite, 0, 0}};
    EXPECT_THAT(weld_positions(positions), ElementsAre(0, 0, 2, 2, 4));
}

TEST(Weld, ANaNEqualsNothingNotEvenItself) {
    const std::vector<glm::vec3> positions(4, glm::vec3(0, not_a_number, 0));
    EXPECT_THAT(weld_positions(positions), ElementsAre(0, 1, 2, 3));
}

TEST(Weld, ByBitsANaNEqualsItselfAndMinusZeroIsNotZero) {
    const std::vector<glm::vec2> values = {
        {0.0F, not_a_number}, {-0.0F, not_a_number}, {0.0F, not_a_number}, {-0.0F, not_a_number}};
    EXPECT_EQ(weld_bits<glm::vec2>(values), (std::vector<std::uint32_t>{0, 1, 0, 1}));
    const std::vector<std::array<float, 7>> rows = {{0, 0, 0, 0, 0, 0, 1}, {}, {}};
    EXPECT_EQ((weld_bits<std::array<float, 7>>(rows)), (std::vector<std::uint32_t>{0, 1, 1}));
}

TEST(Weld, OneUnitInTheLastPlaceKeepsPositionsApart) {
    const std::vector<glm::vec3> positions = {{1, 0, 0}, {std::nextafter(1.0F, 2.0F), 0, 0}};
    EXPECT_THAT(weld_positions(positions), ElementsAre(0, 1));
}

TEST(Weld, VerticesAreOneOnlyIfNormalAndTextureCoordinateAgreeToo) {
    const std::vector<glm::vec3> positions(4, glm::vec3(1, 1, 1));
    const std::vector<glm::vec3> normals = {{0, 0, 1}, {0, 0, 1}, {0, 1, 0}, {0, -0.0F, 1}};
    const std::vector<glm::vec2> texcoords = {{0, 0}, {1, 0}, {0, 0}, {-0.0F, 0}};
    EXPECT_THAT(weld_vertices(positions, normals, texcoords), ElementsAre(0, 1, 2, 0));
}

TEST(Weld, TheSphereClosesAtItsSeamAndPoles) {
    const int slices = 16;
    const int stacks = 8;
    const Mesh sphere = test::sphere(slices, stacks);
    const std::vector<std::uint32_t> classes = weld_positions(sphere.positions);
    std::size_t different = 0;
    for (std::size_t i = 0; i < classes.size(); ++i)
        different += classes[i] == i ? 1 : 0;
    EXPECT_EQ(different, static_cast<std::size_t>(slices * (stacks - 1) + 2));
}

}  // namespace
}  // namespace relief
