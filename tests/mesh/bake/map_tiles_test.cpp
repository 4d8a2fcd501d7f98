// SPDX-License-Identifier: Apache-2.0
// Tiles by their numbers: borders, triangles across corners, what no number stands for.
#include "relief/mesh/map_tiles.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "relief/mesh/error.h"
#include "support/message_of.h"

namespace relief {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// One triangle for every three coordinates.
MapTiles sorted(const std::vector<glm::vec2>& texcoords, const TileRange& range = udim_tiles) {
    std::vector<glm::uvec3> triangles;
    for (std::uint32_t i = 0; i + 2 < texcoords.size(); i += 3)
        triangles.emplace_back(i, i + 1, i + 2);
    return tiles_of(texcoords, triangles, std::nullopt, range);
}

std::vector<int> numbers(const MapTiles& tiles) {
    std::vector<int> result;
    for (const MapTile& tile : tiles.tiles)
        result.push_back(udim_of(tile.tile));
    return result;
}

TEST(MapTiles, AreNumberedFromTheLeftAndUpwards) {
    EXPECT_EQ(udim_of({0, 0}), 1001);
    EXPECT_EQ(udim_of({9, 0}), 1010);
    EXPECT_EQ(udim_of({0, -1}), 1011);
    EXPECT_EQ(udim_of(udim_tiles.greatest - glm::ivec2(1, -udim_tiles.least.y)), 9999);
    const MapTiles tiles = sorted({{0.1F, -0.9F},
                                   {0.2F, -0.9F},
                                   {0.1F, -0.8F},
                                   {9.1F, 0.1F},
                                   {9.2F, 0.1F},
                                   {9.1F, 0.2F},
                                   {0.1F, 0.1F},
                                   {0.2F, 0.1F},
                                   {0.1F, 0.2F}});
    EXPECT_THAT(numbers(tiles), ElementsAre(1001, 1010, 1011));
    EXPECT_THAT(tiles.tiles[0].triangles, ElementsAre(2));
    EXPECT_THAT(tiles.tiles[2].triangles, ElementsAre(0));
    EXPECT_THAT(tiles.outside, IsEmpty());
}

TEST(MapTiles, WhatEndsOnABorderDoesNotEnterTheNextOne) {
    EXPECT_THAT(numbers(sorted({{0, 0}, {1, 0}, {1, 1}})), ElementsAre(1001));
    EXPECT_THAT(numbers(sorted({{0, 0}, {1.000005F, 0}, {1, 1.000005F}})), ElementsAre(1001));
    EXPECT_THAT(numbers(sorted({{0, 0}, {1.0001F, 0}, {1, 1}})), ElementsAre(1001, 1002));
    EXPECT_THAT(numbers(sorted({{1, 0}, {2, 0}, {1, 1}})), ElementsAre(1002));
}

TEST(MapTiles, ATriangleAcrossACornerEntersOnlyWhereItIs) {
    // Its box has four tiles; its long side passes the corner of the fourth on this side.
    EXPECT_THAT(numbers(sorted({{0.5F, 0.9F}, {0.5F, -0.2F}, {2, 0.9F}})),
                ElementsAre(1001, 1002, 1011));
    EXPECT_THAT(numbers(sorted({{0.5F, 0.9F}, {0.5F, -1}, {2, -1}})),
                ElementsAre(1001, 1002, 1011, 1012));
    // Without area: a point, and a line along the diagonal.
    EXPECT_THAT(numbers(sorted({{3.5F, 0.5F}, {3.5F, 0.5F}, {3.5F, 0.5F}})), ElementsAre(1004));
    EXPECT_THAT(numbers(sorted({{0.1F, 0.9F}, {1.9F, -0.9F}, {1, 0}})), ElementsAre(1001, 1012));
}

TEST(MapTiles, WhatHasNoNumberIsSaid) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const MapTiles tiles = sorted({{-0.5F, 0.5F},
                                   {-0.1F, 0.5F},
                                   {-0.1F, 0.1F},
                                   {-0.5F, 0.5F},
                                   {0.5F, 0.5F},
                                   {0.5F, 0.1F},
                                   {nan, 0},
                                   {1, 0},
                                   {1, 1},
                                   {0, 1e30F},
                                   {0, 2e30F},
                                   {1, 1e30F}});
    EXPECT_THAT(numbers(tiles), ElementsAre(1001));
    EXPECT_THAT(tiles.outside, ElementsAre(0, 3));
    EXPECT_THAT(tiles.partly_outside, ElementsAre(1));
    EXPECT_THAT(tiles.not_finite, ElementsAre(2));
    EXPECT_THAT(sorted({{1.1F, 0}, {2, 0}, {1.1F, 1}}, TileRange{}).outside, ElementsAre(0));
}

TEST(MapTiles, SomeTrianglesAloneAndTooManyTiles) {
    const std::vector<glm::vec2> texcoords = {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {3, 0}, {2, 1}};
    const std::vector<glm::uvec3> triangles = {{0, 1, 2}, {3, 4, 5}};
    const std::vector<std::uint32_t> second = {1}, none, beyond = {2};
    EXPECT_THAT(numbers(tiles_of(texcoords, triangles, second, udim_tiles)), ElementsAre(1003));
    EXPECT_THAT(numbers(tiles_of(texcoords, triangles, none, udim_tiles)), IsEmpty());
    EXPECT_EQ(
        test::message_of<InvalidInput>([&] { tiles_of(texcoords, triangles, beyond, udim_tiles); }),
        "there is no triangle 2");
    EXPECT_EQ(test::message_of<InvalidInput>([&] {
                  sorted({{0, 0}, {1000, 0}, {0, -1000}});
              }),
              "the texture coordinates enter more than 1000 tiles");
}

}  // namespace
}  // namespace relief
