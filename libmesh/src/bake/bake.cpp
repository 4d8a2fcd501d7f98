// SPDX-License-Identifier: Apache-2.0
// Strips of the map from the top: who owns each sample, what its ray meets, what its texel becomes.
// Tests: tests/mesh/bake/bake_test.cpp, baker_test.cpp, bake_sphere_test.cpp.
#include "relief/mesh/bake.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>

#include "bake/baked_layers.h"
#include "bake/band_bake.h"
#include "bake/border_fill.h"
#include "bake/dilation.h"
#include "parallel.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

/// Rows of a strip: its texels take 64 MB at most, or it is as narrow as can be.
constexpr std::size_t strip_bytes = 60'000'000;
constexpr int least_rows = 64;  // A tile of dither, and of coverage.

constexpr int most_padding = 1024;
constexpr int most_occlusion_rays = 65536;

int side_of(int samples) {
    for (const int side : {1, 2, 4, 8, 16, 32}) {
        if (side * side == samples) return side;
    }
    throw InvalidInput(fmt::format("{} samples are not 1, 4, 16, 64, 256 or 1024", samples));
}

void check_distance(const std::optional<double>& distance, const char* what) {
    if (distance && !(*distance >= 0.0 && std::isfinite(*distance)))
        throw InvalidInput(fmt::format("{} of {} is negative or not finite", what, *distance));
}

void check_occlusion(const BakeLayers& layers) {
    if (!layers.occlusion) return;
    check_distance(layers.occlusion->distance, "a distance of occlusion");
    if (const int rays = layers.occlusion->rays; rays < 1 || rays > most_occlusion_rays) {
        throw InvalidInput(
            fmt::format("{} rays of occlusion are not within 1 to {}", rays, most_occlusion_rays));
    }
}

void check_surfaces(const BakeOptions& options) {
    check_distance(options.offset, "an offset");
    check_distance(options.max_distance, "a largest distance");
    if (!(options.hardness >= 0.0 && options.hardness <= 1.0))
        throw InvalidInput(fmt::format("a hardness of {} is not within 0 to 1", options.hardness));
}

void check_triangle_numbers(std::span<const std::uint32_t> numbers, std::size_t count) {
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        if (numbers[i] >= count)
            throw InvalidInput(fmt::format("there is no triangle {} in the low mesh", numbers[i]));
        if (i > 0 && numbers[i] <= numbers[i - 1])
            throw InvalidInput("the triangles of a map are not in ascending order");
    }
}

void check_rows(const BakeRowRange& rows, const BakeMapOptions& map) {
    const bool ends_well = rows.last == map.height || rows.last % TexelCover::band_rows == 0;
    if (rows.first < 0 || rows.first % TexelCover::band_rows != 0 || rows.last <= rows.first ||
        rows.last > map.height || !ends_well) {
        throw InvalidInput(fmt::format("rows {} to {} are no multiples of {} within a map of {}",
                                       rows.first, rows.last, TexelCover::band_rows, map.height));
    }
    if (map.padding > 0) throw InvalidInput("some rows of a map have no padding");
}

void check_border(const BakeMapOptions& map) {
    if (!map.border_folder) return;
    if (map.padding > 0 || map.rows)
        throw InvalidInput("a map that is filled to its border has no padding, and all rows");
    if (std::max(map.width, map.height) > BorderFill::largest_side) {
        throw InvalidInput(fmt::format("a map of {} x {} texels is too large to be filled: {}",
                                       map.width, map.height, BorderFill::largest_side));
    }
}

void check_map(const BakeMapOptions& map, const Mesh& low) {
    const int side = side_of(map.samples);
    // Coverage has a limit of its own, which is of samples.
    for (const int texels : {map.width, map.height}) {
        if (texels < 1 || texels > TexelCover::largest_side / side) {
            throw InvalidInput(
                fmt::format("a map of {} x {} texels of {} samples is not within 1 to {}",
                            map.width, map.height, map.samples, TexelCover::largest_side / side));
        }
    }
    if (map.padding < 0 || map.padding > most_padding) {
        throw InvalidInput(
            fmt::format("a padding of {} texels is not within 0 to {}", map.padding, most_padding));
    }
    check_border(map);
    if (map.sample_angle && !(*map.sample_angle >= 0.0 && *map.sample_angle <= std::numbers::pi))
        throw InvalidInput(fmt::format("an angle of {} is not within 0 to pi", *map.sample_angle));
    if (map.rows) check_rows(*map.rows, map);
    if (map.triangles) check_triangle_numbers(*map.triangles, low.triangles.size());
}

void check_layers(const BakeLayers& wanted, const BakeLayers& ready) {
    if ((wanted.normals && !ready.normals) || (wanted.curvature && !ready.curvature) ||
        (wanted.colors && !ready.colors))
        throw InvalidInput("a map wants a layer that its baker was not made for");
    check_occlusion(wanted);
}

CoverageOptions coverage_options(const BakeMapOptions& map, int side) {
    CoverageOptions coverage;
    coverage.width = map.width * side;
    coverage.height = map.height * side;
    coverage.samples_across = side;
    coverage.tile = map.placement.tile;
    coverage.repeat = map.placement.repeat;
    coverage.only = map.triangles;
    return coverage;
}

/// A strip of the map in memory: the layers that are wanted.
struct Strip {
    std::array<std::vector<float>, baked_layers.size()> layers;
    std::vector<TexelState> states;

    Strip(const BakeLayers& wanted, std::size_t width, std::size_t rows) : states(width * rows) {
        for (std::size_t i = 0; i < layers.size(); ++i) {
            if (baked_layers[i].is_wanted(wanted))
                layers[i].resize(baked_layers[i].channels * width * rows);
        }
    }

    /// Some of its rows, counted within it.
    BakedRows rows(int width, int first_row, int begin, int count) {
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
};

int rows_of_strip(const BakeLayers& wanted, int width, int height) {
    std::size_t texel_bytes = sizeof(TexelState);
    for (const BakedLayer& layer : baked_layers) {
        if (layer.is_wanted(wanted)) texel_bytes += sizeof(float) * layer.channels;
    }
    const auto fitting =
        static_cast<int>(strip_bytes / texel_bytes / static_cast<std::size_t>(width));
    const int rows = std::max(fitting / least_rows, 1) * least_rows;
    return std::min(rows, height);
}

/// Bakes rows [first, last), and says what there was.
void bake_strip(const BakeWork& work, const TexelCover& cover, Strip& strip, int first, int last,
                BakeResult& result, BakeCounts& counts, int& rows_done, Report& report) {
    const int side = work.side;
    std::mutex mutex;
    std::map<int, Report> reports;  // By row, so that their order is no matter of threads.
    const auto take = [&](int first_sample_row, std::span<const CoveredTexel> owners) {
        const int row = first_sample_row / side;
        const int count = static_cast<int>(owners.size() / static_cast<std::size_t>(side * side) /
                                           static_cast<std::size_t>(work.options.width));
        Report found;
        const BakeCounts more = bake_rows(
            work, row, owners, strip.rows(work.options.width, row, row - first, count), found);
        const std::lock_guard lock(mutex);
        counts += more;
        rows_done += count;
        if (work.options.progress) work.options.progress({rows_done, counts.rays});
        reports.emplace(row, std::move(found));
    };
    result.coverage += cover.cover(first * side, last * side, take, report);
    for (const auto& [row, found] : reports)
        report.merge(found);
}

}  // namespace

struct Baker::Implementation {
    template <typename High>
    Implementation(std::span<High> high, const Mesh& mesh, const BakeOptions& given, Report& report)
        : options(given), low(mesh, options, report), parts(high, low, options, report) {}

    BakeOptions options;
    LowSurface low;
    BakeParts parts;
};

Baker::Baker(std::span<const Mesh> high, const Mesh& low, const BakeOptions& options,
             Report& report) {
    check_surfaces(options);
    implementation_ = std::make_unique<Implementation>(high, low, options, report);
}

Baker::Baker(std::span<const BakePart> parts, const Mesh& low, const BakeOptions& options,
             Report& report) {
    check_surfaces(options);
    implementation_ = std::make_unique<Implementation>(parts, low, options, report);
}

Baker::~Baker() = default;
Baker::Baker(Baker&&) noexcept = default;
Baker& Baker::operator=(Baker&&) noexcept = default;

const Mesh& Baker::low() const {
    return implementation_->low.mesh();
}

const BakeOptions& Baker::options() const {
    return implementation_->options;
}

BakeDistances Baker::distances() const {
    return implementation_->parts.largest_distances();
}

BakeFit Baker::fit() const {
    return implementation_->parts.fit();
}

LayerBounds Baker::bounds(const BakeLayers& layers) const {
    LayerBounds bounds = implementation_->parts.bounds(layers);
    if (layers.heights) {
        const BakeDistances reach = distances();
        bounds.height =
            std::max({reach.offset, reach.max_distance, implementation_->low.cage_reach()});
    }
    return bounds;
}

BakeResult Baker::bake(const BakeMapOptions& map,
                       const std::function<void(const BakedRows& rows)>& take,
                       Report& report) const {
    check_map(map, low());
    check_layers(map.layers, implementation_->options.layers);
    BakeOptions options = implementation_->options;
    static_cast<BakeMapOptions&>(options) = map;
    const int side = side_of(map.samples);
    const BakeRowRange range = map.rows.value_or(BakeRowRange{0, map.height});
    Report said_before;
    const TexelCover cover(low().texcoords, low().triangles, coverage_options(map, side),
                           range.first == 0 ? report : said_before);
    BakeResult result;
    result.distances = distances();
    const BakeWork work{implementation_->parts, implementation_->low, options, side};
    const int rows = rows_of_strip(options.layers, map.width, range.last - range.first);
    Strip strip(options.layers, static_cast<std::size_t>(map.width),
                static_cast<std::size_t>(rows));
    std::optional<BorderFill> border;
    if (map.border_folder) border.emplace(map.width, map.height, *map.border_folder, take);
    Dilation dilation(map.width, map.height, map.padding,
                      [&](const BakedRows& done) { border ? border->push(done) : take(done); });
    BakeCounts counts;
    int rows_done = 0;
    for (int first = range.first; first < range.last; first += rows) {
        const int last = std::min(first + rows, range.last);
        bake_strip(work, cover, strip, first, last, result, counts, rows_done, report);
        dilation.push(strip.rows(map.width, first, 0, last - first));
    }
    result.samples = counts.samples;
    result.rays = counts.rays;
    result.occlusion_rays = counts.occlusion_rays;
    result.texels_baked = counts.baked;
    result.texels_missed = counts.missed;
    result.first_missed = counts.first_missed;
    result.missed_from_behind = counts.missed_from_behind;
    result.clipped_outside = counts.clipped_outside.summary();
    result.clipped_inside = counts.clipped_inside.summary();
    result.measuring_rays = counts.measuring_rays;
    if (counts.baked > 0) {
        result.least_height = counts.least_height;
        result.greatest_height = counts.greatest_height;
    }
    return result;
}

BakeResult bake_normals(std::span<const Mesh> high, const Mesh& low, const BakeOptions& options,
                        const std::function<void(const BakedRows& rows)>& take, Report& report) {
    // What is wrong with the map is said before the meshes are made ready, which takes a while.
    check_map(options, low);
    return Baker(high, low, options, report).bake(options, take, report);
}

}  // namespace relief
