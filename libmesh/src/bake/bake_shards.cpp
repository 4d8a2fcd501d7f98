// SPDX-License-Identifier: Apache-2.0
// Divides maps into shards, and makes maps from the rows and the findings of shards.
// Tests: tests/mesh/bake/bake_shards_test.cpp.
#include "relief/mesh/bake_shards.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bake/layers.h"
#include "bake/map_rows.h"
#include "progress_stage.h"

namespace relief {
using namespace relief::detail;

namespace {

constexpr std::size_t max_first_missed = 8;
constexpr int bins_per_octave = 8;  // Of ray lengths.

/// Keeps the first missed texels, by row and column.
void keep_first(std::vector<MissedTexel>& missed) {
    std::sort(missed.begin(), missed.end(), [](const MissedTexel& a, const MissedTexel& b) {
        return a.y != b.y ? a.y < b.y : a.x < b.x;
    });
    if (missed.size() > max_first_missed) missed.resize(max_first_missed);
}

}  // namespace

std::span<const RowLayer> row_layers() {
    static constexpr auto layers = [] {
        std::array<RowLayer, baked_layers.size()> all{};
        std::copy(baked_layers.begin(), baked_layers.end(), all.begin());
        return all;
    }();
    return layers;
}

BakeCounts& BakeCounts::operator+=(const BakeCounts& other) {
    samples += other.samples;
    rays += other.rays;
    occlusion_rays += other.occlusion_rays;
    thickness_rays += other.thickness_rays;
    open_thickness_rays += other.open_thickness_rays;
    baked += other.baked;
    missed += other.missed;
    min_height = std::min(min_height, other.min_height);
    max_height = std::max(max_height, other.max_height);
    first_missed.insert(first_missed.end(), other.first_missed.begin(), other.first_missed.end());
    keep_first(first_missed);
    missed_from_behind += other.missed_from_behind;
    measuring_rays += other.measuring_rays;
    clipped_outside += other.clipped_outside;
    clipped_inside += other.clipped_inside;
    return *this;
}

void RayLengths::add(double length) {
    ++count;
    shortest = std::min(shortest, length);
    longest = std::max(longest, length);
    int exponent = 0;
    const double mantissa = std::frexp(length, &exponent);  // 0.5 to 1
    const int part = static_cast<int>((mantissa - 0.5) * 2.0 * bins_per_octave);
    ++bins[bins_per_octave * exponent + part];
}

RayLengths& RayLengths::operator+=(const RayLengths& other) {
    count += other.count;
    shortest = std::min(shortest, other.shortest);
    longest = std::max(longest, other.longest);
    for (const auto& [bin, more] : other.bins)
        bins[bin] += more;
    return *this;
}

ClippedRays RayLengths::summary() const {
    if (count == 0) return {};
    ClippedRays clipped{count, shortest, longest, longest};
    std::size_t so_far = 0;
    for (const auto& [bin, lengths] : bins) {
        so_far += lengths;
        if (2 * so_far < count) continue;
        const int exponent =
            (bin - (bin % bins_per_octave + bins_per_octave) % bins_per_octave) / bins_per_octave;
        const int part = bin - bins_per_octave * exponent;
        const double upper = std::ldexp(0.5 + 0.5 * (part + 1) / bins_per_octave, exponent);
        clipped.half = std::min(upper, longest);
        break;
    }
    return clipped;
}

// Memory, padding and results of rows.

namespace {

/// The memory of a strip, unless the minimum number of rows needs more.
constexpr std::size_t strip_bytes = 60'000'000;
constexpr int strip_row_step = 64;  // The rows of a dither tile and of a coverage band.

constexpr int max_padding = 1024;

}  // namespace

Strip::Strip(const BakeLayers& requested, std::size_t width, std::size_t rows)
    : states(width * rows) {
    for (std::size_t i = 0; i < layers.size(); ++i) {
        if (baked_layers[i].is_requested(requested))
            layers[i].resize(baked_layers[i].channels * width * rows);
    }
}

int Strip::row_count(const BakeLayers& requested, int width, int height) {
    std::size_t texel_bytes = sizeof(TexelState);
    for (const BakedLayer& layer : baked_layers) {
        if (layer.is_requested(requested)) texel_bytes += sizeof(float) * layer.channels;
    }
    const auto max_rows =
        static_cast<int>(strip_bytes / texel_bytes / static_cast<std::size_t>(width));
    const int rows = std::max(max_rows / strip_row_step, 1) * strip_row_step;
    return std::min(rows, height);
}

BakedRows Strip::rows(int width, int first_row, int begin, int count) {
    const auto first = static_cast<std::size_t>(begin) * static_cast<std::size_t>(width);
    const auto texels = static_cast<std::size_t>(count) * static_cast<std::size_t>(width);
    BakedRows result;
    result.first_row = first_row;
    result.row_count = count;
    result.states = std::span(states).subspan(first, texels);
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const std::size_t channels = baked_layers[i].channels;
        if (layers[i].empty()) continue;
        result.*baked_layers[i].values =
            std::span(layers[i]).subspan(channels * first, channels * texels);
    }
    return result;
}

PaddedRows::PaddedRows(const BakeMapOptions& map, const std::function<void(const BakedRows&)>& take)
    : dilation_(map.width, map.height, map.padding, [this, take](const BakedRows& done) {
          border_ ? border_->push(done) : take(done);
      }) {
    if (map.border_folder) border_.emplace(map.width, map.height, *map.border_folder, take);
}

void detail::check_padding(const BakeMapOptions& map) {
    if (map.padding < 0 || map.padding > max_padding) {
        throw InvalidInput(fmt::format("the padding is {} texels, but must be within [0, {}]",
                                       map.padding, max_padding));
    }
    if (!map.border_folder) return;
    if (map.padding > 0 || map.rows)
        throw InvalidInput("filling a map to its border needs all rows and a padding of 0");
    if (std::max(map.width, map.height) > BorderFill::max_side) {
        throw InvalidInput(fmt::format("a map of {} x {} texels is too large to be filled: {}",
                                       map.width, map.height, BorderFill::max_side));
    }
}

BakeResult detail::completed(const BakeShard& shard, const BakeDistances& distances, bool is_whole,
                             Report& report) {
    report.merge(shard.triangles);
    report.merge(shard.texels);
    report.merge(shard.rays);
    const BakeCounts& counts = shard.counts;
    BakeResult result;
    result.coverage = shard.coverage;
    result.distances = distances;
    result.samples = counts.samples;
    result.rays = counts.rays;
    result.occlusion_rays = counts.occlusion_rays;
    result.thickness_rays = counts.thickness_rays;
    result.open_thickness_rays = counts.open_thickness_rays;
    result.texels_baked = counts.baked;
    result.texels_missed = counts.missed;
    result.first_missed = counts.first_missed;
    result.missed_from_behind = counts.missed_from_behind;
    result.clipped_outside = counts.clipped_outside.summary();
    result.clipped_inside = counts.clipped_inside.summary();
    result.measuring_rays = counts.measuring_rays;
    if (is_whole && counts.baked + counts.missed == 0)
        report.add("map without a covered texel", "map", 0, "is empty");
    if (counts.baked > 0) {
        result.min_height = counts.min_height;
        result.max_height = counts.max_height;
    }
    return result;
}

// Shards.

namespace {

constexpr int group_rows = 4;                // Rows that one shard bakes.
constexpr int measured_columns = 1024;       // Of the reduced maps.
constexpr std::uint64_t covered_cost = 256;  // In units of a texel that is not covered.

/// Returns the costs of the groups of rows of a map, from the coverage of a reduced map.
std::vector<std::uint64_t> row_costs(const Mesh& low, const BakeMapOptions& map) {
    if (map.width < 1 || map.height < 1 || map.width > TexelRasterizer::largest_side ||
        map.height > TexelRasterizer::largest_side) {
        throw InvalidInput(fmt::format("a map of {} x {} texels cannot be divided: 1 to {}",
                                       map.width, map.height, TexelRasterizer::largest_side));
    }
    CoverageOptions coverage;
    coverage.width = std::min(map.width, measured_columns);
    coverage.height = (map.height + group_rows - 1) / group_rows;
    coverage.tile = map.placement.tile;
    coverage.repeat = map.placement.repeat;
    coverage.only = map.triangles;
    const auto columns = static_cast<std::size_t>(coverage.width);
    std::vector<std::uint64_t> costs(static_cast<std::size_t>(coverage.height), columns);
    const auto take = [&](int first_row, std::span<const CoveredTexel> texels) {
        for (std::size_t i = 0; i < texels.size(); ++i) {
            if (texels[i].is_covered())
                costs[static_cast<std::size_t>(first_row) + i / columns] += covered_cost;
        }
    };
    cover_texels(low.texcoords, low.triangles, coverage, take);
    return costs;
}

/// Returns the sum of what shards of adjacent rows found.
BakeShard sum_of(const BakeMapOptions& map, std::span<const BakeShard> shards) {
    BakeShard sum;
    for (const BakeShard& shard : shards) {
        if (shard.rows.first != sum.rows.last || shard.rows.last <= shard.rows.first ||
            shard.rows.last > map.height) {
            throw InvalidInput(fmt::format("rows {} to {} of a shard do not follow row {} of {}",
                                           shard.rows.first, shard.rows.last, sum.rows.last,
                                           map.height));
        }
        sum.rows.last = shard.rows.last;
        sum.coverage += shard.coverage;
        sum.counts += shard.counts;
        sum.triangles.merge(shard.triangles);
        sum.texels.merge(shard.texels);
        sum.rays.merge(shard.rays);
    }
    if (sum.rows.last != map.height) {
        throw InvalidInput(fmt::format("rows {} to {} are in no shard", sum.rows.last, map.height));
    }
    return sum;
}

/// Clears rows: no texel is covered.
void clear(const BakedRows& rows) {
    std::ranges::fill(rows.states, TexelState::empty);
    for (const BakedLayer& layer : baked_layers)
        std::ranges::fill(rows.*layer.values, 0.0F);
    std::ranges::fill(rows.occlusion, 1.0F);
    std::ranges::fill(rows.ids, -1.0F);
    for (const std::span<float> directions : {rows.normals, rows.bent_normals}) {
        for (std::size_t i = 2; i < directions.size(); i += 3)
            directions[i] = 1.0F;
    }
}

}  // namespace

std::vector<ShardRows> rows_of_shard(const Mesh& low, std::span<const BakeMapOptions> maps,
                                     std::size_t shard, std::size_t count) {
    constexpr std::size_t max_shards = 100'000;  // The products below do not overflow.
    if (count < 1 || count > max_shards || shard >= count) {
        throw InvalidInput(
            fmt::format("shard {} of {} must be below 1 to {}", shard, count, max_shards));
    }
    std::vector<std::vector<std::uint64_t>> costs;
    std::uint64_t all = 0;
    for (const BakeMapOptions& map : maps) {
        costs.push_back(row_costs(low, map));
        for (const std::uint64_t cost : costs.back())
            all += cost;
    }
    std::vector<ShardRows> result;
    std::uint64_t before = 0;
    for (std::size_t map = 0; map < maps.size(); ++map) {
        ShardRows rows{map, {}};
        for (std::size_t group = 0; group < costs[map].size(); ++group) {
            // The middle of the group decides.
            const std::uint64_t cost = costs[map][group];
            if ((2 * before + cost) * count / (2 * all) == shard) {
                const int first = group_rows * static_cast<int>(group);
                if (rows.rows.last == 0) rows.rows.first = first;
                rows.rows.last = std::min(first + group_rows, maps[map].height);
            }
            before += cost;
        }
        if (rows.rows.last > 0) result.push_back(rows);
    }
    return result;
}

BakeResult merge_shards(const BakeMapOptions& map, const BakeDistances& distances,
                        std::span<const BakeShard> shards,
                        const std::function<void(const BakedRows& rows)>& read,
                        const std::function<void(const BakedRows& rows)>& take, Report& report,
                        const ExecutionOptions& execution) {
    const ExecutionScope scope(execution);
    if (map.width < 1 || map.width > TexelRasterizer::largest_side || map.height < 1 ||
        map.height > TexelRasterizer::largest_side) {
        throw InvalidInput(fmt::format("the map has {} x {} texels, but must have 1 to {}",
                                       map.width, map.height, TexelRasterizer::largest_side));
    }
    check_padding(map);
    const BakeShard sum = sum_of(map, shards);
    PaddedRows padded(map, take);
    const int strip_rows = Strip::row_count(map.layers, map.width, map.height);
    Strip strip(map.layers, static_cast<std::size_t>(map.width),
                static_cast<std::size_t>(strip_rows));
    ProgressStage stage("merging", static_cast<std::size_t>(map.height));
    for (int first = 0; first < map.height; first += strip_rows) {
        const int count = std::min(strip_rows, map.height - first);
        const BakedRows rows = strip.rows(map.width, first, 0, count);
        clear(rows);
        read(rows);
        padded.push(rows);
        stage.advance(static_cast<std::size_t>(count));
    }
    return completed(sum, distances, true, report);
}

}  // namespace relief
