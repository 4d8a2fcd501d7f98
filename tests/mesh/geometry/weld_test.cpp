// SPDX-License-Identifier: Apache-2.0
// Vertices that count as one: equal positions, and positions within a distance.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "geometry/weld.h"
#include "relief/mesh/execution.h"
#include "support/hard_meshes.h"
#include "support/shapes.h"

namespace relief {
using namespace relief::detail;

namespace {

using test::infinite;
using test::not_a_number;
using testing::ElementsAre;

TEST(Weld, UsesTheSmallestIndexOfAPosition) {
    const std::vector<glm::vec3> positions = {
        {1, 2, 3}, {3, 2, 1}, {1, 2, 3}, {3, 2, 1}, {0, 0, 0}};
    EXPECT_THAT(weld_positions(positions), ElementsAre(0, 1, 0, 1, 4));
}

TEST(Weld, MinusZeroIsZeroAndInfinitiesEqualThemselves) {
    const std::vector<glm::vec3> positions = {
        {0, -0.0F, 1}, {-0.0F, 0, 1}, {infinite, 0, 0}, {infinite, -0.0F, 0}, {-infinite, 0, 0}};
    EXPECT_THAT(weld_positions(positions), ElementsAre(0, 0, 2, 2, 4));
}

TEST(Weld, NaNDiffersFromItself) {
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

TEST(Weld, PositionsOneUlpApartDiffer) {
    const std::vector<glm::vec3> positions = {{1, 0, 0}, {std::nextafter(1.0F, 2.0F), 0, 0}};
    EXPECT_THAT(weld_positions(positions), ElementsAre(0, 1));
}

TEST(Weld, VerticesAreOneOnlyIfNormalAndTextureCoordinateAgreeToo) {
    const std::vector<glm::vec3> positions(4, glm::vec3(1, 1, 1));
    const std::vector<glm::vec3> normals = {{0, 0, 1}, {0, 0, 1}, {0, 1, 0}, {0, -0.0F, 1}};
    const std::vector<glm::vec2> texcoords = {{0, 0}, {1, 0}, {0, 0}, {-0.0F, 0}};
    EXPECT_THAT(weld_vertices(positions, normals, texcoords), ElementsAre(0, 1, 2, 0));
}

TEST(Weld, LargeArraysGiveTheSameClassesForAnyNumberOfThreads) {
    // Long enough for several threads. Every 97th vertex equals one that comes 60,000 earlier or
    // later, so that threads see only one of the two.
    constexpr std::uint32_t count = 140'000;
    std::vector<glm::vec3> positions;
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < count; ++i) {
        expected.push_back(i % 97 == 0 && i >= 60'000 ? i - 60'000 : i);
        // Vertices of the first part may be equal to even earlier ones.
        expected[i] = expected[expected[i]];
        const std::uint32_t which = expected[i];
        positions.emplace_back(which % 300, which / 300, 0.125F * static_cast<float>(which % 7));
    }
    for (const unsigned threads : {1U, 2U, 3U}) {
        const ExecutionScope scope({.threads = threads});
        EXPECT_EQ(weld_positions(positions), expected) << threads << " threads";
    }
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

/// Compares every pair until nothing changes.
std::vector<std::uint32_t> by_all_pairs(const std::vector<glm::vec3>& positions, double tolerance) {
    std::vector<std::uint32_t> smallest(positions.size());
    for (std::size_t i = 0; i < smallest.size(); ++i)
        smallest[i] = static_cast<std::uint32_t>(i);
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t i = 0; i < positions.size(); ++i) {
            for (std::size_t j = 0; j < positions.size(); ++j) {
                const bool near =
                    glm::distance(glm::dvec3(positions[i]), glm::dvec3(positions[j])) <= tolerance;
                if (!near || smallest[j] >= smallest[i]) continue;
                smallest[i] = smallest[j];
                changed = true;
            }
        }
    }
    return smallest;
}

TEST(WeldNear, AgreesWithComparingEveryPair) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> number(-1.0F, 1.0F);
    std::vector<glm::vec3> positions;
    for (int i = 0; i < 300; ++i)
        positions.emplace_back(number(random), number(random), number(random));
    for (const double tolerance : {0.01, 0.05, 0.1, 0.15, 0.2, 3.0}) {
        const auto joined = weld_near_positions(positions, tolerance);
        EXPECT_EQ(joined, by_all_pairs(positions, tolerance)) << tolerance;
    }
}

TEST(WeldNear, ExactlyTheToleranceIsNear) {
    const std::vector<glm::vec3> positions = {{0, 0, 0}, {0.25F, 0, 0}, {0.75F, 0, 0}};
    EXPECT_THAT(weld_near_positions(positions, 0.25), ElementsAre(0, 0, 2));
    EXPECT_THAT(weld_near_positions(positions, 0.5), ElementsAre(0, 0, 0));
}

TEST(WeldNear, AChainIsAllOne) {
    std::vector<glm::vec3> positions;
    for (int i = 0; i < 100; ++i)
        positions.emplace_back(static_cast<float>(i * 37 % 100), 0.0F, 0.0F);
    EXPECT_THAT(weld_near_positions(positions, 1.0), testing::Each(0U));
    EXPECT_EQ(weld_near_positions(positions, 0.99)[99], 99U);
}

TEST(WeldNear, NonFinitePositionsStaySeparate) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    const std::vector<glm::vec3> positions = {{nan, 0, 0},      {nan, 0, 0}, {infinity, 0, 0},
                                              {infinity, 0, 0}, {0, 0, 0},   {-0.0F, 0, 0}};
    EXPECT_THAT(weld_near_positions(positions, 1.0), ElementsAre(0, 1, 2, 3, 4, 4));
}

TEST(WeldNear, HugeCoordinatesAndTinyTolerancesDoNotOverflow) {
    const std::vector<glm::vec3> positions = {
        {3e38F, -3e38F, 3e38F}, {3e38F, -3e38F, 3e38F}, {1e-38F, 0, 0}, {2e-38F, 0, 0}};
    EXPECT_THAT(weld_near_positions(positions, 1e-30), ElementsAre(0, 0, 2, 2));
    EXPECT_THAT(weld_near_positions(positions, 1e-39), ElementsAre(0, 0, 2, 3));
}

TEST(Groups, AreThoseOfTwoAndMore) {
    const std::vector<std::uint32_t> representatives = {0, 1, 0, 3, 1, 1, 6};
    const Groups groups = groups_of(representatives);
    ASSERT_EQ(groups.count(), 2U);
    EXPECT_THAT(groups.at(0), ElementsAre(0, 2));
    EXPECT_THAT(groups.at(1), ElementsAre(1, 4, 5));
    EXPECT_EQ(groups_of(std::vector<std::uint32_t>{0, 1, 2}).count(), 0U);
}

}  // namespace
}  // namespace relief
