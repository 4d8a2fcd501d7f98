// SPDX-License-Identifier: Apache-2.0
// Which triangles share texels: by hand, against a search through all pairs, and in crowds.
#include "topology/texture_overlap.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "hard_meshes.h"
#include "support/shapes.h"

namespace relief {
namespace {

using testing::Each;
using testing::ElementsAre;

std::vector<std::uint8_t> overlapping(const std::vector<glm::vec2>& texcoords,
                                      const std::vector<glm::uvec3>& triangles) {
    return texture_overlap(texcoords, triangles).overlapping;
}

TEST(TextureOverlap, NeighboursDoNotAndFoldedOnesDo) {
    const std::vector<glm::vec2> square = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    EXPECT_THAT(overlapping(square, {{0, 1, 2}, {0, 2, 3}}), ElementsAre(0, 0));
    EXPECT_THAT(overlapping(square, {{0, 1, 2}, {0, 1, 3}}), ElementsAre(1, 1));
    EXPECT_THAT(overlapping(square, {{0, 1, 2}, {0, 2, 1}}), ElementsAre(1, 1));
}

TEST(TextureOverlap, EveryOneThatSharesATexelIsFoundAndNoOther) {
    // 0 lies over 1; 2 stands apart; 3 covers all of them; 4 has no area; 5 is no number.
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<glm::vec2> texcoords = {{0, 0},  {1, 0},    {0, 1},    {0.2F, 0.2F},
                                              {1, 1},  {3, 0},    {4, 0},    {3, 1},
                                              {-9, 0}, {0, 30.F}, {90.F, 0}, {nan, 0}};
    const std::vector<glm::uvec3> apart = {{0, 1, 2}, {3, 1, 4}, {5, 6, 7}, {0, 1, 1}, {0, 1, 11}};
    EXPECT_THAT(overlapping(texcoords, apart), ElementsAre(1, 1, 0, 0, 0));
    std::vector<glm::uvec3> covered = apart;
    covered.push_back({8, 10, 9});
    EXPECT_THAT(overlapping(texcoords, covered), ElementsAre(1, 1, 1, 0, 0, 1));
}

TEST(TextureOverlap, TexcoordsOffByRoundingAreNoOverlap) {
    // Two squares side by side that meet where texels of 1/1024 have their centres. The second
    // begins half a thousandth of a texel early, then twenty thousandths.
    constexpr float seam = 512.5F / 1024.0F;
    std::vector<glm::vec2> texcoords = {
        {0, 0}, {seam, 0}, {seam, 1}, {0, 1}, {seam - 5e-7F, 0}, {1, 0}, {1, 1}, {seam - 5e-7F, 1}};
    const std::vector<glm::uvec3> triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
    ASSERT_EQ(texture_overlap(texcoords, triangles).raster, 1024);
    EXPECT_THAT(overlapping(texcoords, triangles), Each(0));
    texcoords[1].x += 1e-5F;
    texcoords[2].x += 1e-5F;
    texcoords[4].x = texcoords[7].x = seam - 1e-5F;
    EXPECT_THAT(overlapping(texcoords, triangles), ElementsAre(1, 0, 0, 1)) << "along the seam";
}

/// Whether the centre of any texel is inside both, by the definition.
bool share_a_texel(const std::vector<glm::vec2>& t, const glm::uvec3& a, const glm::uvec3& b,
                   int side) {
    const auto is_inside = [&](const glm::uvec3& triangle, const glm::dvec2& p) {
        glm::dvec2 c[3];
        for (int i = 0; i < 3; ++i)
            c[i] = glm::dvec2(t[triangle[i]]) * static_cast<double>(side);
        const glm::dvec2 u = c[1] - c[0];
        const glm::dvec2 v = c[2] - c[0];
        if (u.x * v.y - u.y * v.x < 0.0) std::swap(c[1], c[2]);
        for (int i = 0; i < 3; ++i) {
            const glm::dvec2 edge = c[(i + 1) % 3] - c[i];
            const glm::dvec2 to = p - c[i];
            if (edge.x * to.y - edge.y * to.x < 1e-3 * glm::length(edge)) return false;
        }
        return true;
    };
    const glm::vec2 low = glm::min(t[a.x], glm::min(t[a.y], t[a.z])) * static_cast<float>(side);
    const glm::vec2 high = glm::max(t[a.x], glm::max(t[a.y], t[a.z])) * static_cast<float>(side);
    const glm::ivec2 begin(low);
    const glm::ivec2 end = glm::min(glm::ivec2(high) + 1, side);
    for (int row = begin.y; row < end.y; ++row) {
        for (int column = begin.x; column < end.x; ++column) {
            const glm::dvec2 centre(column + 0.5, row + 0.5);
            if (is_inside(a, centre) && is_inside(b, centre)) return true;
        }
    }
    return false;
}

TEST(TextureOverlap, MatchesASearchThroughAllPairs) {
    std::mt19937 generator(7);
    std::uniform_real_distribution<float> anywhere(0.1F, 0.9F);
    std::uniform_real_distribution<float> near(-0.1F, 0.1F);
    std::vector<glm::vec2> texcoords = {{0, 0}, {1, 1}, {0, 0.001F}, {1, 0.999F}};
    std::vector<glm::uvec3> triangles = {{0, 1, 2}, {0, 1, 3}};  // They span the unit square.
    for (std::uint32_t i = 0; i < 30; ++i) {
        const glm::vec2 centre(anywhere(generator), anywhere(generator));
        for (int k = 0; k < 3; ++k)
            texcoords.push_back(centre + glm::vec2(near(generator), near(generator)));
        triangles.push_back(glm::uvec3(0, 1, 2) + 3 * i + 4U);
    }
    const TextureOverlap found = texture_overlap(texcoords, triangles);
    ASSERT_EQ(found.raster, 1024);
    std::vector<std::uint8_t> expected(triangles.size(), 0);
    for (std::size_t a = 0; a < triangles.size(); ++a) {
        for (std::size_t b = a + 1; b < triangles.size(); ++b) {
            if (share_a_texel(texcoords, triangles[a], triangles[b], 1024))
                expected[a] = expected[b] = 1;
        }
    }
    EXPECT_EQ(found.overlapping, expected);
    const auto some = std::count(expected.begin(), expected.end(), 1);
    EXPECT_GT(some, 5);
    EXPECT_LT(some, 30) << "the test must see both";
}

TEST(TextureOverlap, ShapesWithOneImageAllOverHaveNone) {
    for (const Mesh& mesh : {test::grid(100), test::sphere(64, 32)})
        EXPECT_THAT(overlapping(mesh.texcoords, mesh.triangles), Each(0));
    const Mesh cube = test::cube();
    EXPECT_THAT(overlapping(cube.texcoords, cube.triangles), Each(1)) << "the image on every face";
}

TEST(TextureOverlap, CrowdsAreLookedAtMoreCoarsely) {
    constexpr std::uint32_t count = 300'000;
    std::vector<glm::vec2> texcoords = {{0, 0}};
    std::vector<glm::uvec3> fan;
    for (std::uint32_t i = 0; i <= count; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / (count + 1);
        texcoords.emplace_back(std::cos(angle), std::sin(angle));
        if (i < count) fan.emplace_back(0, i + 1, i + 2);
    }
    const TextureOverlap none = texture_overlap(texcoords, fan);
    EXPECT_THAT(none.overlapping, Each(0));
    EXPECT_LT(none.raster, 200);
    EXPECT_GT(none.raster, 30);
    const TextureOverlap all = texture_overlap(
        texcoords, std::vector<glm::uvec3>(count, glm::uvec3(1, 1 + count / 3, 1 + count / 2)));
    EXPECT_THAT(all.overlapping, Each(1));
}

TEST(TextureOverlap, TheOrderOfTrianglesDoesNotMatter) {
    Mesh mesh = test::grid(40);
    for (std::size_t i = 0; i < mesh.texcoords.size(); i += 7)
        mesh.texcoords[i] += glm::vec2(0.06F, 0.03F);
    const std::vector<std::size_t> order = test::shuffled(mesh.triangles.size());
    const Mesh reordered = test::with_triangle_order(mesh, order);
    const auto before = overlapping(mesh.texcoords, mesh.triangles);
    const auto after = overlapping(reordered.texcoords, reordered.triangles);
    ASSERT_GT(std::count(before.begin(), before.end(), 1), 100);
    for (std::size_t i = 0; i < order.size(); ++i)
        ASSERT_EQ(after[i], before[order[i]]) << i;
}

}  // namespace
}  // namespace relief
