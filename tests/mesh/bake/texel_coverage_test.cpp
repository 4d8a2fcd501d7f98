// SPDX-License-Identifier: Apache-2.0
// The triangle that owns each texel: shared edges without gap or overlap, overlapping charts,
// charts smaller than a texel, and tiles of texture space.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "relief/mesh/execution.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "relief/mesh/texel_coverage.h"
#include "support/invariants.h"

namespace relief {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

struct CoverageMap {
    std::vector<CoveredTexel> texels;
    Coverage coverage;
    Report report;
    int width = 0;

    [[nodiscard]] const CoveredTexel& at(int column, int row) const {
        return texels[static_cast<std::size_t>(row * width + column)];
    }
};

CoverageMap covered(const std::vector<glm::vec2>& texcoords,
                    const std::vector<glm::uvec3>& triangles, CoverageOptions options) {
    CoverageMap map;
    map.width = options.width;
    map.texels.resize(static_cast<std::size_t>(options.width) *
                      static_cast<std::size_t>(options.height));
    map.coverage = cover_texels(
        texcoords, triangles, options,
        [&](int first_row, std::span<const CoveredTexel> texels) {
            std::copy(texels.begin(), texels.end(),
                      map.texels.begin() + static_cast<std::ptrdiff_t>(first_row) * options.width);
        },
        map.report);
    return map;
}

CoverageOptions size(int width, int height, bool touched = false) {
    CoverageOptions options;
    options.width = width;
    options.height = height;
    options.touched = touched;
    return options;
}

TEST(TexelCoverage, GivesEachTexelOfASquareToOneTriangle) {
    // The diagonal passes through every texel center on it.
    const std::vector<glm::vec2> corners = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    const CoverageMap map = covered(corners, {{0, 2, 1}, {0, 3, 2}}, size(8, 8));
    EXPECT_EQ(map.coverage.inside, 64U);
    EXPECT_EQ(map.coverage.shared, 0U);
    EXPECT_TRUE(map.report.empty());
    for (int row = 0; row < 8; ++row) {
        for (int column = 0; column < 8; ++column) {
            const CoveredTexel& texel = map.at(column, row);
            // A center on the diagonal belongs to the right side, as its left edge.
            EXPECT_EQ(texel.triangle, column >= row ? 0U : 1U) << column << "," << row;
            const glm::uvec3 triangle =
                texel.triangle == 0 ? glm::uvec3(0, 2, 1) : glm::uvec3(0, 3, 2);
            const glm::vec3 w = texel.weights();
            const glm::vec2 place =
                w.x * corners[triangle.x] + w.y * corners[triangle.y] + w.z * corners[triangle.z];
            EXPECT_NEAR(place.x * 8, static_cast<float>(column) + 0.5F, 1e-5F);
            EXPECT_NEAR(place.y * 8, static_cast<float>(row) + 0.5F, 1e-5F);
        }
    }
}

/// Random triangles that fill the square, with vertices on and off texel centers.
void random_tiling(std::uint32_t seed, int cells, std::vector<glm::vec2>& texcoords,
                   std::vector<glm::uvec3>& triangles) {
    std::mt19937 random(seed);
    const auto unit = [&] { return static_cast<float>(random()) / 4294967296.0F; };
    const auto side = static_cast<unsigned>(cells + 1);
    for (unsigned row = 0; row < side; ++row) {
        for (unsigned column = 0; column < side; ++column) {
            const bool is_border = row == 0 || column == 0 || row + 1 == side || column + 1 == side;
            const float step = 1.0F / static_cast<float>(cells);
            const float wander = is_border || random() % 4 == 0 ? 0.0F : 0.24F * step;
            texcoords.emplace_back(static_cast<float>(column) * step + wander * (2 * unit() - 1),
                                   static_cast<float>(row) * step + wander * (2 * unit() - 1));
            if (row == 0 || column == 0) continue;
            const unsigned d = row * side + column, c = d - 1, b = d - side, a = b - 1;
            if (random() % 2 == 0) {
                triangles.insert(triangles.end(), {{a, c, d}, {a, d, b}});
            } else {
                triangles.insert(triangles.end(), {{a, c, b}, {b, c, d}});
            }
        }
    }
}

TEST(TexelCoverage, LeavesNoGapAndNoOverlapBetweenNeighbors) {
    for (std::uint32_t seed = 0; seed < 30; ++seed) {
        std::vector<glm::vec2> texcoords;
        std::vector<glm::uvec3> triangles;
        random_tiling(seed, 4 + static_cast<int>(seed), texcoords, triangles);
        // Widths of 96 and 100 put vertices on centers, edges and corners of texels, and elsewhere.
        for (const auto& [width, height] : {std::pair{96, 96}, {100, 37}, {16, 200}}) {
            const CoverageMap map = covered(texcoords, triangles, size(width, height));
            EXPECT_EQ(map.coverage.inside, static_cast<std::size_t>(width * height)) << seed;
            EXPECT_EQ(map.coverage.shared, 0U) << seed;
        }
    }
}

TEST(TexelCoverage, DoesNotDependOnOrderOrThreads) {
    std::vector<glm::vec2> texcoords;
    std::vector<glm::uvec3> triangles;
    random_tiling(1, 20, texcoords, triangles);
    // The test adds overlapping triangles: a smaller, mirrored copy.
    const auto count = static_cast<unsigned>(texcoords.size());
    for (unsigned i = 0; i < count; ++i)
        texcoords.push_back(glm::vec2(0.9F - 0.8F * texcoords[i].x, 0.7F * texcoords[i].y));
    const std::size_t plain = triangles.size();
    for (std::size_t i = 0; i < plain; ++i)
        triangles.push_back(triangles[i] + count);
    set_thread_limit(1);
    const CoverageMap map = covered(texcoords, triangles, size(300, 200, true));
    set_thread_limit(0);
    EXPECT_GT(map.coverage.shared, 30000U);
    std::vector<unsigned> order(triangles.size());
    for (unsigned i = 0; i < order.size(); ++i)
        order[i] = i;
    std::shuffle(order.begin(), order.end(), std::mt19937(5));
    std::vector<glm::uvec3> shuffled;
    for (const unsigned i : order) {
        const glm::uvec3 t = triangles[i];
        shuffled.push_back(i % 3 == 0   ? t
                           : i % 3 == 1 ? glm::uvec3(t.y, t.z, t.x)
                                        : glm::uvec3(t.z, t.x, t.y));
    }
    const CoverageMap other = covered(texcoords, shuffled, size(300, 200, true));
    EXPECT_EQ(other.coverage.shared, map.coverage.shared);
    std::size_t mirrored = 0;
    for (std::size_t i = 0; i < map.texels.size(); ++i) {
        ASSERT_EQ(order[other.texels[i].triangle], map.texels[i].triangle) << i;
        ASSERT_EQ(other.texels[i].is_inside, map.texels[i].is_inside);
        mirrored += map.texels[i].triangle >= plain ? 1 : 0;
    }
    EXPECT_EQ(mirrored, 0U);  // Triangles that are not mirrored come first.
}

TEST(TexelCoverage, GivesSmallChartsATexelEach) {
    // Three triangles of a tenth of a texel: off center, on a corner of four texels, and in a
    // covered texel.
    const std::vector<glm::vec2> texcoords = {{2.1F, 2.1F},   {2.2F, 2.1F},   {2.1F, 2.2F},
                                              {4.95F, 4.95F}, {5.05F, 4.95F}, {5.0F, 5.05F},
                                              {0, 0},         {0, 2},         {2, 0}};
    std::vector<glm::vec2> scaled;
    for (const glm::vec2& texcoord : texcoords)
        scaled.push_back(texcoord / 8.0F);
    const std::vector<glm::uvec3> triangles = {{0, 2, 1}, {3, 5, 4}, {6, 7, 8}};
    EXPECT_EQ(covered(scaled, triangles, size(8, 8)).coverage.inside, 1U);
    const CoverageMap map = covered(scaled, triangles, size(8, 8, true));
    EXPECT_EQ(map.at(2, 2).triangle, 0U);
    EXPECT_FALSE(map.at(2, 2).is_inside);
    // The nearest point is the middle of the opposite edge, with the weights of its two corners.
    EXPECT_NEAR(map.at(2, 2).weights().x, 0.0F, 1e-6F);
    EXPECT_NEAR(map.at(2, 2).second, 0.5F, 1e-4F);
    for (const auto& [column, row] : {std::pair{4, 4}, {5, 4}, {4, 5}, {5, 5}})
        EXPECT_EQ(map.at(column, row).triangle, 1U) << column << "," << row;
    // The centers of (1, 0) and (0, 1) lie on the slanted edge, which does not own them. Half of
    // their square is covered.
    EXPECT_EQ(map.at(0, 0).triangle, 2U);
    EXPECT_TRUE(map.at(0, 0).is_inside);
    EXPECT_EQ(map.at(1, 0).triangle, 2U);
    EXPECT_FALSE(map.at(1, 0).is_inside);
    // (1, 1) is met only in a corner, which has no area.
    EXPECT_FALSE(map.at(1, 1).is_covered());
    EXPECT_EQ(map.coverage.inside, 1U);
    EXPECT_EQ(map.coverage.touched, 1U + 4U + 2U);
    EXPECT_EQ(map.coverage.empty, 64U - 8U);
}

TEST(TexelCoverage, ChoosesTheSquareOrMovesEverythingThere) {
    // A quad on tile (1, 2), and one across the border of tiles 0 and 1.
    const std::vector<glm::vec2> texcoords = {
        {1, 2}, {2, 2}, {2, 3}, {1, 3}, {0.75F, 0.F}, {1.25F, 0.F}, {1.25F, 1.F}, {0.75F, 1.F}};
    const std::vector<glm::uvec3> triangles = {{0, 2, 1}, {0, 3, 2}, {4, 6, 5}, {4, 7, 6}};
    CoverageOptions options = size(8, 8);
    EXPECT_EQ(covered(texcoords, triangles, options).coverage.inside, 16U);
    options.tile = {1, 2};
    EXPECT_EQ(covered(texcoords, triangles, options).coverage.inside, 64U);
    options.tile = {1, 0};
    EXPECT_EQ(covered(texcoords, triangles, options).coverage.inside, 16U);
    options.repeat = true;
    const CoverageMap map = covered(texcoords, triangles, options);
    EXPECT_EQ(map.coverage.inside, 64U);
    EXPECT_EQ(map.coverage.shared, 32U);
    EXPECT_EQ(map.report.count("texel of several triangles"), 32U);
    EXPECT_TRUE(map.at(0, 0).is_covered() && map.at(7, 7).is_covered());
}

TEST(TexelCoverage, DistinguishesMirroredTrianglesFromOtherOverlaps) {
    // The left half of the map, its mirrored copy, and a square inside the first.
    const std::vector<glm::vec2> texcoords = {{0, 0},    {0.5F, 0},  {0.5F, 1},  {0, 1},
                                              {0.5F, 0}, {0, 0},     {0, 1},     {0.5F, 1},
                                              {0, 0},    {0.25F, 0}, {0.25F, 1}, {0, 1}};
    const std::vector<glm::uvec3> both = {{0, 2, 1}, {0, 3, 2}, {4, 6, 5}, {4, 7, 6}};
    std::vector<glm::uvec3> three = both;
    three.insert(three.begin(), {{8, 10, 9}, {8, 11, 10}});
    for (const int samples : {1, 2, 32}) {
        CoverageOptions options = size(8 * samples, 8 * samples);
        options.samples_across = samples;
        const auto all = static_cast<std::size_t>(samples * samples);
        const CoverageMap mirrored = covered(texcoords, both, options);
        EXPECT_EQ(mirrored.coverage.shared, 32U * all);
        EXPECT_EQ(mirrored.coverage.mirrored, 32U * all);
        EXPECT_EQ(mirrored.report.count("texel of mirrored triangles"), 32U);
        EXPECT_EQ(mirrored.report.count("texel of several triangles"), 0U);
        const CoverageMap several = covered(texcoords, three, options);
        EXPECT_EQ(several.coverage.shared, 32U * all);
        EXPECT_EQ(several.report.count("texel of mirrored triangles"), 16U);
        EXPECT_EQ(several.report.count("texel of several triangles"), 16U);
    }
}

TEST(TexelCoverage, CountsTrianglesWithoutTexels) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<glm::vec2> texcoords = {{0, 0},   {0.5F, 0.5F}, {1, 1},
                                              {nan, 0}, {1e30F, 0},   {0, 1}};
    const CoverageMap map =
        covered(texcoords, {{0, 1, 2}, {0, 3, 2}, {0, 4, 2}, {0, 0, 5}}, size(8, 8, true));
    EXPECT_EQ(map.report.count("triangle without area in the image"), 2U);
    EXPECT_EQ(map.report.count("texture not finite"), 1U);
    EXPECT_EQ(map.report.count("texture too far away"), 1U);
    EXPECT_EQ(map.coverage.empty, 64U);
}

TEST(TexelCoverage, ReachesTheLargestMapsInBands) {
    const Mesh sphere = make_sphere(64, 32);
    std::size_t most = 0, rows = 0;
    Report report;
    set_thread_limit(1);
    const Coverage coverage = cover_texels(
        sphere.texcoords, sphere.triangles, size(512, 65536),
        [&](int, std::span<const CoveredTexel> texels) {
            most = std::max(most, texels.size());
            rows += texels.size() / 512;
        },
        report);
    set_thread_limit(0);
    EXPECT_EQ(rows, 65536U);
    EXPECT_EQ(most, 64U * 512U);
    EXPECT_EQ(coverage.shared, 0U);
    EXPECT_EQ(coverage.inside + coverage.empty, std::size_t{512} * 65536U);
    EXPECT_EQ(coverage.empty, 0U);
}

TEST(TexelCoverage, RefusesInvalidSizes) {
    Report report;
    const auto message = [&](const CoverageOptions& options, const glm::uvec3& triangle) {
        const std::vector<glm::vec2> texcoords(3);
        const std::vector<glm::uvec3> triangles = {triangle};
        return test::message_of<InvalidInput>([&] {
            cover_texels(
                texcoords, triangles, options, [](int, auto) {}, report);
        });
    };
    EXPECT_EQ(message(size(0, 8), {0, 1, 2}),
              "the map has 0 x 8 texels, but must have 1 to 65536 along each side");
    EXPECT_EQ(message(size(8, 8), {0, 1, 3}), "triangle 0 names vertex 3, but there are only 3");
}

/// Builds one triangle for every three coordinates.
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
    EXPECT_EQ(udim_of(udim_tiles.max - glm::ivec2(1, -udim_tiles.min.y)), 9999);
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

TEST(MapTiles, TrianglesThatEndOnABorderStayInTheirTile) {
    EXPECT_THAT(numbers(sorted({{0, 0}, {1, 0}, {1, 1}})), ElementsAre(1001));
    EXPECT_THAT(numbers(sorted({{0, 0}, {1.000005F, 0}, {1, 1.000005F}})), ElementsAre(1001));
    EXPECT_THAT(numbers(sorted({{0, 0}, {1.0001F, 0}, {1, 1}})), ElementsAre(1001, 1002));
    EXPECT_THAT(numbers(sorted({{1, 0}, {2, 0}, {1, 1}})), ElementsAre(1002));
}

TEST(MapTiles, TriangleAcrossACornerEntersOnlyItsTiles) {
    // Its box has four tiles. Its long side passes the corner of the fourth one on the near side.
    EXPECT_THAT(numbers(sorted({{0.5F, 0.9F}, {0.5F, -0.2F}, {2, 0.9F}})),
                ElementsAre(1001, 1002, 1011));
    EXPECT_THAT(numbers(sorted({{0.5F, 0.9F}, {0.5F, -1}, {2, -1}})),
                ElementsAre(1001, 1002, 1011, 1012));
    // Shapes without area: a point, and a line along the diagonal.
    EXPECT_THAT(numbers(sorted({{3.5F, 0.5F}, {3.5F, 0.5F}, {3.5F, 0.5F}})), ElementsAre(1004));
    EXPECT_THAT(numbers(sorted({{0.1F, 0.9F}, {1.9F, -0.9F}, {1, 0}})), ElementsAre(1001, 1012));
}

TEST(MapTiles, RefusesTilesWithoutUdimNumber) {
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
