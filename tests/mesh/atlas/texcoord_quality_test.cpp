// SPDX-License-Identifier: Apache-2.0
// The measures of given texture coordinates: counts, distances, and exact signs of stored floats.
#include "relief/mesh/texcoord_quality.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "geometry/exact_orientation.h"
#include "hard_cases/mesh_changes.h"
#include "hard_cases/random_meshes.h"
#include "support/hard_meshes.h"
#include "support/invariants.h"
#include "support/sanitized.h"
#include "support/shapes.h"

namespace relief {
namespace {

using test::Dice;
using test::message_of;

constexpr glm::ivec2 map_size{256, 128};

/// Squares of the xy plane, not joined. Each has a rectangle of the map, in texels from the upper
/// left; the side of a square is 1.
struct Rectangle {
    glm::vec2 min, max;
};

Mesh squares(const std::vector<Rectangle>& rectangles) {
    Mesh mesh;
    for (std::uint32_t i = 0; i < rectangles.size(); ++i) {
        const float x = 2.0F * static_cast<float>(i);
        const Rectangle& r = rectangles[i];
        const std::uint32_t first = 4 * i;
        for (const glm::vec2& corner : {glm::vec2(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
            mesh.positions.emplace_back(x + corner.x, corner.y, 0.0F);
            const glm::vec2 texel(r.min.x + corner.x * (r.max.x - r.min.x),
                                  r.max.y + corner.y * (r.min.y - r.max.y));
            mesh.texcoords.push_back(texel / glm::vec2(map_size));
        }
        mesh.triangles.emplace_back(first, first + 1, first + 2);
        mesh.triangles.emplace_back(first, first + 2, first + 3);
    }
    return mesh;
}

// Half of the points are near a line. Coordinates are multiples of 2^-17 below 2^24.
TEST(ExactOrientation, AgreesWithIntegers) {
    Dice dice(3);
    int on_line = 0;
    for (int i = 0; i < 200'000; ++i) {
        const auto number = [&] {
            const std::uint32_t limit = 1U << dice.below(24);
            const auto value =
                static_cast<float>(dice.below(2 * limit)) - static_cast<float>(limit);
            return std::ldexp(value, -static_cast<int>(dice.below(14)));
        };
        const glm::vec2 a(number(), number());
        const glm::vec2 b(number(), number());
        glm::vec2 c(number(), number());
        if (i % 2 == 0) c = a + (b - a) * (static_cast<float>(dice.below(17)) / 8.0F);
        const auto whole = [](float x) { return static_cast<__int128>(std::ldexp(x, 40)); };
        const __int128 area = (whole(b.x) - whole(a.x)) * (whole(c.y) - whole(a.y)) -
                              (whole(b.y) - whole(a.y)) * (whole(c.x) - whole(a.x));
        const int sign = (area > 0) - (area < 0);
        ASSERT_EQ(detail::orientation_sign(a, b, c), sign) << i;
        if (sign == 0) ++on_line;
    }
    EXPECT_GT(on_line, 1000);
}

TEST(ExactOrientation, HasNoRangeOfExponents) {
    const float tiny = std::numeric_limits<float>::denorm_min();
    const float huge = std::numeric_limits<float>::max();
    EXPECT_EQ(detail::orientation_sign({0, 0}, {tiny, 0}, {0, tiny}), 1);
    EXPECT_EQ(detail::orientation_sign({0, 0}, {0, tiny}, {tiny, 0}), -1);
    EXPECT_EQ(detail::orientation_sign({-huge, -huge}, {huge, huge}, {0, tiny}), 1);
    EXPECT_EQ(detail::orientation_sign({-huge, -huge}, {huge, huge}, {tiny, 0}), -1);
    EXPECT_EQ(detail::orientation_sign({-huge, -huge}, {huge, huge}, {tiny, tiny}), 0);
}

TEST(TexcoordQuality, MeasuresSquares) {
    const TexcoordQuality quality =
        measure_texcoords(squares({{{8, 8}, {40, 40}}, {{46, 8}, {78, 40}}}), map_size);
    EXPECT_EQ(quality.stats.charts, 2U);
    EXPECT_EQ(quality.stats.small_charts, 0U);
    EXPECT_NEAR(quality.stats.used, 2.0 * 32 * 32 / (256 * 128), 1e-9);
    EXPECT_NEAR(quality.stats.texels_per_unit, 32.0, 1e-6);
    EXPECT_NEAR(quality.stats.stretch, 1.0, 1e-9);
    EXPECT_NEAR(quality.stats.seam_length, 8.0, 1e-6);
    EXPECT_NEAR(quality.stats.perimeter, 256.0, 1e-4);
    EXPECT_EQ(quality.stats.padding_share, std::nullopt);
    EXPECT_NEAR(quality.min_distance.value(), 6.0, 1e-4);
    EXPECT_EQ(quality.stats.safe_mip_level, 1);
    EXPECT_EQ(quality.tiles, std::vector{1001});
    EXPECT_EQ(quality.overlapping + quality.inverted + quality.flat + quality.outside +
                  quality.mirrored_charts,
              0U);
    EXPECT_EQ(quality.chart, (std::vector<std::optional<std::uint32_t>>{0U, 0U, 1U, 1U}));
}

TEST(TexcoordQuality, CountsFaults) {
    Mesh mesh = squares({{{8, 8}, {40, 40}},  // Overlaps the next one in a corner.
                         {{36, 36}, {60, 60}},
                         {{120, 8}, {88, 40}},    // Mirrored.
                         {{130, 8}, {130, 40}},   // Flat.
                         {{250, 8}, {260, 40}},   // Partly outside.
                         {{140, 60}, {150, 70}},  // Not finite.
                         {{160, 8}, {164, 10}}});
    mesh.texcoords[4 * 5 + 1].x = std::nanf("");
    Report report;
    const TexcoordQuality quality = measure_texcoords(mesh, map_size, report);
    EXPECT_EQ(quality.overlapping, 2U) << "of four triangles";
    EXPECT_EQ(quality.mirrored_charts, 1U);
    EXPECT_EQ(quality.inverted, 0U);
    EXPECT_EQ(quality.flat, 2U);
    EXPECT_EQ(quality.outside, 2U);
    EXPECT_EQ(quality.stats.charts, 7U);
    EXPECT_EQ(quality.stats.small_charts, 3U) << "flat, half of 100 texels, and 8 texels";
    EXPECT_EQ(quality.min_distance, 0.0);
    EXPECT_EQ(report.count("triangle with non-finite texture coordinates"), 1U);
    EXPECT_FALSE(quality.chart[10].has_value());
}

// A fan whose last triangle is folded over the others.
TEST(TexcoordQuality, CountsInvertedTriangles) {
    Mesh mesh = test::mesh_from({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {-1, 4, 0}},
                                {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}});
    mesh.texcoords = {{0.1F, 0.9F}, {0.5F, 0.9F}, {0.5F, 0.5F}, {0.1F, 0.5F}, {0.2F, 0.5F}};
    const TexcoordQuality quality = measure_texcoords(mesh, map_size);
    EXPECT_EQ(quality.stats.charts, 1U);
    EXPECT_EQ(quality.inverted, 1U);
    EXPECT_EQ(quality.overlapping, 2U);
    EXPECT_EQ(quality.mirrored_charts, 0U);
}

// One unit in the last place decides whether two squares overlap.
TEST(TexcoordQuality, DecidesOverlapsExactly) {
    Mesh mesh = squares({{{8, 8}, {40, 40}}, {{40, 8}, {72, 40}}});
    TexcoordQuality quality = measure_texcoords(mesh, map_size);
    EXPECT_EQ(quality.overlapping, 0U);
    EXPECT_EQ(quality.min_distance, 0.0);
    for (const std::size_t v : {4U, 7U})
        mesh.texcoords[v].x = std::nextafter(mesh.texcoords[v].x, 0.0F);
    quality = measure_texcoords(mesh, map_size);
    EXPECT_EQ(quality.overlapping, 4U);
}

TEST(TexcoordQuality, AgreesWithUnwrapping) {
    std::vector<test::NamedMesh> meshes = test::hard_meshes();
    for (std::uint32_t seed = 0; seed < (test::is_sanitized ? 6 : 30); ++seed)
        meshes.push_back({"random " + std::to_string(seed), test::random_mesh(seed)});
    UnwrapOptions options;
    options.size = {512, 512};
    options.padding = 3;
    for (const auto& [name, mesh] : meshes) {
        const Unwrapped unwrapped = unwrap(mesh, options);
        const Mesh textured = with_texcoords(mesh, unwrapped).mesh;
        if (textured.texcoords.empty()) continue;
        const TexcoordQuality quality = measure_texcoords(textured, options.size);
        EXPECT_EQ(quality.overlapping + quality.inverted + quality.flat + quality.outside +
                      quality.mirrored_charts,
                  0U)
            << name;
        EXPECT_EQ(quality.stats.charts, unwrapped.stats.charts) << name;
        EXPECT_NEAR(quality.stats.used, unwrapped.stats.used, 1e-12) << name << ": order of charts";
        EXPECT_NEAR(quality.stats.stretch, unwrapped.stats.stretch, 1e-12) << name;
        EXPECT_EQ(quality.stats.seam_length, unwrapped.stats.seam_length) << name;
        EXPECT_NEAR(quality.stats.perimeter, unwrapped.stats.perimeter, 1e-6) << name;
        EXPECT_GE(quality.min_distance.value_or(64.0), 3.0) << name;
    }
}

TEST(TexcoordQuality, IsTheSameForAnyOrder) {
    const Mesh given = test::with_tangents(make_torus(0.4F, 24, 12));
    const TexcoordQuality expected = measure_texcoords(given, map_size);
    Dice dice(5);
    for (const test::MeshChange& change : test::tested_changes) {
        test::MeshVariant variant(given);
        change.apply(variant, dice);
        const TexcoordQuality quality = measure_texcoords(variant.mesh, map_size);
        EXPECT_EQ(quality.stats.charts, expected.stats.charts) << change.name;
        EXPECT_EQ(quality.overlapping, expected.overlapping) << change.name;
        if (variant.texture_scale == 1.0F) {
            EXPECT_EQ(quality.stats.stretch, expected.stats.stretch) << change.name;
            EXPECT_EQ(quality.stats.used, expected.stats.used) << change.name;
        }
    }
}

// Charts on top of each other must not take quadratic time: 20,000 squares are 8 * 10^8 pairs.
TEST(TexcoordQuality, MeasuresManyChartsInOnePlace) {
    std::vector<Rectangle> rectangles(20'000, {{8, 8}, {40, 40}});
    TexcoordQuality quality = measure_texcoords(squares(rectangles), map_size);
    EXPECT_EQ(quality.shared_charts, 19'999U);
    EXPECT_EQ(quality.overlapping, 0U);
    EXPECT_EQ(quality.min_distance, std::nullopt);
    EXPECT_NEAR(quality.stats.used, 32.0 * 32 / (256 * 128), 1e-9);
    for (std::size_t i = 0; i < rectangles.size(); ++i)
        rectangles[i].max.x += 1e-3F * static_cast<float>(i);
    quality = measure_texcoords(squares(rectangles), map_size);
    EXPECT_EQ(quality.shared_charts, 0U);
    EXPECT_EQ(quality.overlapping, 40'000U);
    EXPECT_EQ(quality.min_distance, 0.0);
}

// Charts share texels if all of their triangles are equal in the map, and overlap otherwise.
TEST(TexcoordQuality, TellsSharedChartsFromOverlaps) {
    const Rectangle square{{8, 8}, {40, 40}};
    const Rectangle mirrored{{40, 8}, {8, 40}};
    Mesh mesh = squares({square, {{100, 8}, {132, 40}}, square});
    TexcoordQuality quality = measure_texcoords(mesh, map_size);
    EXPECT_EQ(quality.shared_charts, 1U);
    EXPECT_EQ(quality.stats.charts, 2U);
    EXPECT_EQ(quality.overlapping, 0U);
    EXPECT_NEAR(quality.min_distance.value(), 60.0, 1e-4);
    EXPECT_NEAR(quality.stats.area, 2.0, 1e-9) << "that of one of them";
    EXPECT_EQ(quality.chart[0], quality.chart[4]);
    EXPECT_NE(quality.chart[0], quality.chart[2]);

    // The other diagonal makes other triangles.
    mesh.triangles[4] = {8, 9, 11};
    mesh.triangles[5] = {9, 10, 11};
    quality = measure_texcoords(mesh, map_size);
    EXPECT_EQ(quality.shared_charts, 0U);
    EXPECT_EQ(quality.overlapping, 4U);

    // One triangle of the third chart is elsewhere.
    mesh = squares({square, square, square});
    mesh.texcoords[11].x += 0.01F;
    quality = measure_texcoords(mesh, map_size);
    EXPECT_EQ(quality.shared_charts, 1U);
    EXPECT_EQ(quality.overlapping, 6U) << "shared charts count together";

    // The diagonal of a mirrored square lies across, unless its corners begin elsewhere.
    mesh = squares({square, mirrored});
    mesh.triangles[2] = {4, 5, 7};
    mesh.triangles[3] = {5, 6, 7};
    quality = measure_texcoords(mesh, map_size);
    EXPECT_EQ(quality.shared_charts, 1U);
    EXPECT_EQ(quality.mirrored_charts, 1U);
    EXPECT_EQ(quality.overlapping, 0U);
}

// Tiles are unit squares in ten columns, with v upwards; texels are those of a tile.
TEST(TexcoordQuality, KnowsTiles) {
    const Mesh mesh = squares({{{8, 8}, {40, 40}},
                               {{224, 40}, {256, 128}},    // Up to the border of the tile,
                               {{256, 40}, {288, 128}},    // from which the next tile begins.
                               {{40, -100}, {72, -50}},    // Above the first one.
                               {{40, 150}, {72, 180}},     // Below: there is no tile.
                               {{-40, 8}, {-8, 40}},       // Left of the first one.
                               {{2570, 8}, {2590, 40}},    // Right of the tenth one.
                               {{500, 50}, {520, 100}}});  // In two tiles.
    const TexcoordQuality quality = measure_texcoords(mesh, map_size);
    EXPECT_EQ(quality.outside, 8U);
    EXPECT_EQ(quality.tiles, (std::vector{1001, 1002, 1011}));
    EXPECT_EQ(quality.overlapping, 0U);
    EXPECT_NE(quality.min_distance, 0.0) << "charts that touch are in different maps";
    const TexcoordQuality first = measure_texcoords(squares({{{0, 0}, {256, 128}}}), map_size);
    EXPECT_EQ(first.outside, 0U);
    EXPECT_EQ(first.tiles, std::vector{1001});
    EXPECT_NEAR(first.stats.used, 1.0, 1e-9);
}

// Two squares that touch on the surface and in the map are one chart of one part, or two charts of
// two parts.
TEST(TexcoordQuality, KeepsPartsApart) {
    Mesh mesh = squares({{{8, 8}, {40, 40}}, {{40, 8}, {72, 40}}});
    for (std::size_t v = 4; v < 8; ++v)
        mesh.positions[v].x -= 1.0F;
    EXPECT_EQ(measure_texcoords(mesh, map_size).stats.charts, 1U);
    Report report;
    const std::vector<std::uint32_t> parts = {0, 4};
    const TexcoordQuality apart = measure_texcoords(mesh, map_size, report, parts);
    EXPECT_EQ(apart.stats.charts, 2U);
    EXPECT_EQ(apart.min_distance, 0.0);
    EXPECT_EQ(apart.stats.safe_mip_level, std::nullopt);
    const std::vector<std::uint32_t> wrong = {0, 9};
    EXPECT_EQ(message_of<InvalidInput>([&] { measure_texcoords(mesh, map_size, report, wrong); }),
              "the first vertices of the parts must ascend from 0");
}

TEST(TexcoordQuality, AgreesWithTilesAndStacks) {
    Mesh mesh;
    const Mesh part = test::random_mesh(7);
    const glm::mat3 rotation(0.36F, 0.48F, -0.8F, -0.8F, 0.6F, 0.0F, 0.48F, 0.64F, 0.6F);
    for (int copy = 0; copy < 4; ++copy) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const glm::vec3& position : part.positions)
            mesh.positions.push_back((copy % 2 == 0 ? position : rotation * position) +
                                     glm::vec3(50.0F * static_cast<float>(copy), 0.0F, 0.0F));
        for (const glm::uvec3& triangle : part.triangles)
            mesh.triangles.push_back(triangle + first);
    }
    for (const bool stacks : {false, true}) {
        for (const int tiles : {1, 12}) {
            UnwrapOptions options;
            options.size = {128, 128};
            options.padding = 3;
            options.stack = stacks;
            options.tiles = tiles;
            const Unwrapped unwrapped = unwrap(mesh, options);
            const TexcoordQuality quality =
                measure_texcoords(with_texcoords(mesh, unwrapped).mesh, options.size);
            EXPECT_EQ(quality.overlapping + quality.inverted + quality.flat + quality.outside +
                          quality.mirrored_charts,
                      0U);
            EXPECT_EQ(quality.shared_charts > 0, stacks);
            EXPECT_EQ(quality.stats.charts, unwrapped.stats.charts);
            EXPECT_NEAR(quality.stats.perimeter, unwrapped.stats.perimeter, 1e-6);
            EXPECT_NEAR(quality.stats.seam_length, unwrapped.stats.seam_length, 1e-4);
            EXPECT_NEAR(quality.stats.used * static_cast<double>(quality.tiles.size()),
                        unwrapped.stats.used * tiles, 1e-9);
            EXPECT_GE(quality.min_distance.value_or(64.0), 3.0);
        }
    }
}

TEST(TexcoordQuality, RefusesWhatItCannotMeasure) {
    Mesh mesh = squares({{{8, 8}, {40, 40}}});
    EXPECT_EQ(message_of<InvalidInput>([&] {
                  measure_texcoords(mesh, {0, 8});
              }),
              "the size of the map is 0, but must be 1 to 65536 texels");
    mesh.texcoords.clear();
    EXPECT_EQ(message_of<InvalidInput>([&] { measure_texcoords(mesh, map_size); }),
              "there are no texture coordinates");
}

}  // namespace
}  // namespace relief
