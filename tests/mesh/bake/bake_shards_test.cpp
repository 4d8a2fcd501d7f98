// SPDX-License-Identifier: Apache-2.0
// Bakes maps in shards and merges them.
#include "relief/mesh/bake_shards.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <numbers>

#include "mesh/bake/bake_support.h"
#include "support/shapes.h"

namespace relief {
namespace {

using test::append;
using test::BakedImage;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// The bytes of all layers and states.
std::vector<std::vector<float>> layers_of(const BakedImage& image) {
    std::vector<float> states;
    for (const TexelState state : image.states)
        states.push_back(static_cast<float>(state));
    return {image.normals, image.heights,   image.occlusion, image.curvature, image.positions,
            image.colors,  image.opacity,   image.surface,   image.emission,  image.bent_normals,
            image.ids,     image.thickness, states};
}

std::string text_of(const BakedImage& image) {
    const BakeResult& r = image.result;
    std::string text = fmt::format(
        "{} {} {} {} {}; {} {}; {} {} {} {} {} {}; {} {}; {} {} {}", r.coverage.inside,
        r.coverage.touched, r.coverage.empty, r.coverage.shared, r.coverage.mirrored,
        r.texels_baked, r.texels_missed, r.samples, r.rays, r.occlusion_rays, r.thickness_rays,
        r.open_thickness_rays, r.measuring_rays, r.min_height, r.max_height, r.missed_from_behind,
        r.distances.offset, r.distances.max_distance);
    for (const ClippedRays& rays : {r.clipped_outside, r.clipped_inside})
        text += fmt::format("; {} {} {} {}", rays.texels, rays.shortest, rays.half, rays.longest);
    for (const MissedTexel& texel : r.first_missed)
        text += fmt::format("; {} {} {}", texel.x, texel.y, texel.position.x);
    for (const Finding& finding : image.report.findings())
        text += fmt::format("\n{} {} {}", to_string(finding), finding.count,
                            fmt::join(finding.first, ","));
    return text;
}

/// A sphere without its upper half, so that half of the texels of a whole one are missed.
Mesh bowl() {
    Mesh mesh = make_sphere(24, 12);
    std::erase_if(mesh.triangles, [&](const glm::uvec3& corners) {
        return mesh.positions[corners.x].y + mesh.positions[corners.y].y > 0.0F;
    });
    return mesh;
}

BakeOptions every_layer(int width, int height) {
    BakeOptions options = test::sized(width, height);
    BakeLayers& layers = options.map.layers;
    layers.occlusion = OcclusionOptions{.rays = 8, .distance = {}};
    layers.bent_normals = layers.occlusion;
    layers.thickness = ThicknessOptions{.rays = 8, .distance = {}};
    layers.curvature = layers.positions = layers.colors = layers.opacity = layers.surface =
        layers.emission = layers.ids = true;
    options.map.padding = 3;
    options.map.measures_missed = true;
    return options;
}

/// Bakes all shards, the last one first, and merges them.
BakedImage merged(const Baker& baker, const BakeMapOptions& map, std::size_t count) {
    std::map<int, BakedImage> images;  // By first row.
    std::map<int, BakeShard> by_row;
    for (std::size_t shard = count; shard-- > 0;) {
        for (const ShardRows& rows : rows_of_shard(baker.low(), {&map, 1}, shard, count)) {
            BakedImage& image = images[rows.rows.first];
            by_row[rows.rows.first] = baker.bake_shard(
                map, rows.rows, [&](const BakedRows& done) { append(image, done); });
        }
    }
    std::vector<BakeShard> shards;
    for (const auto& [row, shard] : by_row)
        shards.push_back(shard);
    BakedImage result;
    const auto read = [&](const BakedRows& rows) {
        for (const auto& [first, image] : images) {
            const auto width = static_cast<std::size_t>(map.width);
            const auto last = first + static_cast<int>(image.states.size() / width);
            for (int row = std::max(first, rows.first_row);
                 row < std::min(last, rows.first_row + rows.row_count); ++row) {
                const std::size_t from = static_cast<std::size_t>(row - first) * width;
                const std::size_t to = static_cast<std::size_t>(row - rows.first_row) * width;
                for (std::size_t i = 0; i < width; ++i) {
                    rows.states[to + i] = image.states[from + i];
                    if (image.states[from + i] != TexelState::baked) continue;
                    const auto copy = [&](const std::vector<float>& source, std::span<float> target,
                                          std::size_t channels) {
                        std::copy_n(&source[channels * (from + i)], channels,
                                    &target[channels * (to + i)]);
                    };
                    copy(image.normals, rows.normals, 3);
                    copy(image.heights, rows.heights, 1);
                    copy(image.occlusion, rows.occlusion, 1);
                    copy(image.curvature, rows.curvature, 1);
                    copy(image.positions, rows.positions, 3);
                    copy(image.colors, rows.colors, 3);
                    copy(image.opacity, rows.opacity, 1);
                    copy(image.surface, rows.surface, 3);
                    copy(image.emission, rows.emission, 3);
                    copy(image.bent_normals, rows.bent_normals, 3);
                    copy(image.thickness, rows.thickness, 1);
                    copy(image.ids, rows.ids, 1);
                }
            }
        }
    };
    result.result = merge_shards(
        map, baker.distances(), shards, read, [&](const BakedRows& rows) { append(result, rows); },
        result.report);
    return result;
}

TEST(BakeShards, MergeToTheBytesAndFindingsOfTheWholeMap) {
    const std::vector<Mesh> high = {bowl()};
    Mesh low = make_sphere(12, 6);
    low.triangles.push_back(low.triangles[50]);  // Texels of several triangles.
    for (const int samples : {1, 4, 16}) {
        BakeOptions options = every_layer(60, 198);
        options.map.samples = samples;
        if (samples == 16) options.map.sample_angle = 2.0 * std::numbers::pi / 180.0;
        const Baker baker(high, low, options);
        BakedImage whole;
        whole.result = baker.bake(
            options.map, [&](const BakedRows& rows) { append(whole, rows); }, whole.report);
        EXPECT_GT(whole.result.texels_missed, 1000U);
        EXPECT_GT(whole.result.texels_baked, 1000U);
        EXPECT_GT(whole.count(TexelState::padded), 100U);
        EXPECT_GT(whole.report.findings().size(), 1U);
        for (const std::size_t count : {1U, 3U, 16U, 70U}) {
            const BakedImage image = merged(baker, options.map, count);
            EXPECT_TRUE(layers_of(image) == layers_of(whole)) << samples << ", " << count;
            EXPECT_EQ(text_of(image), text_of(whole)) << samples << ", " << count;
        }
    }
}

TEST(BakeShards, HaveAboutTheSameNumberOfCoveredTexels) {
    // The lower half of the map is covered in its left half only, the upper half not at all.
    Mesh low = make_quad();
    for (glm::vec2& texcoord : low.texcoords)
        texcoord = {0.5F * texcoord.x, 0.5F + 0.5F * texcoord.y};
    BakeMapOptions map;
    map.width = 512;
    map.height = 1024;
    const std::array maps = {map, map};
    std::array<std::vector<int>, 2> owners = {std::vector<int>(1024), std::vector<int>(1024)};
    for (std::size_t shard = 0; shard < 8; ++shard) {
        int covered = 0;
        for (const ShardRows& rows : rows_of_shard(low, maps, shard, 8)) {
            for (int row = rows.rows.first; row < rows.rows.last; ++row) {
                ++owners.at(rows.map).at(static_cast<std::size_t>(row));
                covered += row >= 512 ? 256 : 0;
            }
        }
        EXPECT_NEAR(covered, 512 * 256 / 4, 1024) << shard;  // A group of rows.
    }
    for (const auto& counts : owners)
        EXPECT_EQ(std::ranges::count(counts, 1), 1024);
    EXPECT_TRUE(rows_of_shard(low, {&map, 1}, 9, 1000).empty());
}

TEST(BakeShards, RefuseRowsThatAreMissingOrOccurTwice) {
    BakeMapOptions map;
    map.width = map.height = 64;
    const auto merge = [&](const std::vector<BakeShard>& shards) {
        const auto ignore = [](const BakedRows&) {};
        return [&map, shards, ignore] { merge_shards(map, {}, shards, ignore, ignore); };
    };
    EXPECT_NO_THROW(merge({{.rows = {0, 20}}, {.rows = {20, 64}}})());
    const auto refusal = [](const char* text) {
        return ThrowsMessage<InvalidInput>(HasSubstr(text));
    };
    EXPECT_THAT(merge({{.rows = {0, 20}}}), refusal("rows 20 to 64 are in no shard"));
    EXPECT_THAT(merge({{.rows = {0, 20}}, {.rows = {24, 64}}}),
                refusal("rows 24 to 64 of a shard do not follow row 20 of 64"));
    EXPECT_THAT(merge({{.rows = {0, 64}}, {.rows = {0, 64}}}), refusal("do not follow row 64"));
    EXPECT_THAT(merge({{.rows = {0, 68}}}), refusal("rows 0 to 68"));
    EXPECT_THAT(merge({}), refusal("rows 0 to 64 are in no shard"));
    const Mesh low = make_quad();
    const Baker baker(std::vector<Mesh>{make_quad(2)}, low, test::sized(64, 64));
    for (const BakeRowRange rows : {BakeRowRange{2, 8}, BakeRowRange{0, 6}, BakeRowRange{8, 8},
                                    BakeRowRange{-4, 4}, BakeRowRange{0, 68}}) {
        EXPECT_THROW(
            static_cast<void>(baker.bake_shard(baker.options().map, rows, [](const BakedRows&) {})),
            InvalidInput);
    }
    EXPECT_THROW(rows_of_shard(low, {&map, 1}, 2, 2), InvalidInput);
    EXPECT_THROW(rows_of_shard(low, {&map, 1}, 0, 0), InvalidInput);
}

}  // namespace
}  // namespace relief
