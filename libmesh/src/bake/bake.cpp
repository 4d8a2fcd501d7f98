// SPDX-License-Identifier: Apache-2.0
// Strips of the map from the top: who owns each sample, what its ray meets, what its texel becomes.
// Tests: tests/mesh/bake/bake_test.cpp, bake_sphere_test.cpp.
#include "relief/mesh/bake.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>

#include "bake/bake_distances.h"
#include "bake/band_bake.h"
#include "bake/dilation.h"
#include "parallel.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

/// Rows of a strip: its texels take 64 MB at most, or it is as narrow as can be.
constexpr std::size_t strip_texels = 3'000'000;
constexpr int least_rows = 64;  // A tile of dither, and of coverage.

constexpr int most_padding = 1024;

int side_of(int samples) {
    for (const int side : {1, 2, 4, 8}) {
        if (side * side == samples) return side;
    }
    throw InvalidInput(fmt::format("{} samples are not 1, 4, 16 or 64", samples));
}

void check_distance(const std::optional<double>& distance, const char* what) {
    if (distance && !(*distance >= 0.0 && std::isfinite(*distance)))
        throw InvalidInput(fmt::format("{} of {} is negative or not finite", what, *distance));
}

void check(const BakeOptions& options) {
    check_distance(options.offset, "an offset");
    check_distance(options.max_distance, "a largest distance");
    if (!(options.hardness >= 0.0 && options.hardness <= 1.0))
        throw InvalidInput(fmt::format("a hardness of {} is not within 0 to 1", options.hardness));
    if (options.padding < 0 || options.padding > most_padding) {
        throw InvalidInput(fmt::format("a padding of {} texels is not within 0 to {}",
                                       options.padding, most_padding));
    }
    if (options.sample_angle &&
        !(*options.sample_angle >= 0.0 && *options.sample_angle <= std::numbers::pi)) {
        throw InvalidInput(
            fmt::format("an angle of {} is not within 0 to pi", *options.sample_angle));
    }
}

BakeDistances distances_of(std::span<const Mesh> high, const HighSurface& surface, const Mesh& low,
                           const BakeOptions& options) {
    const bool all_known = options.cage != nullptr || (options.offset && options.max_distance);
    BakeDistances distances;
    if (!all_known) distances = distances_between(high, surface.scene(), low);
    distances.offset = options.offset.value_or(distances.offset);
    distances.max_distance = options.max_distance.value_or(distances.max_distance);
    return distances;
}

CoverageOptions coverage_options(const BakeOptions& options, int side) {
    CoverageOptions coverage;
    // Of a map too large for so many samples, coverage says so itself.
    coverage.width = options.width * side;
    coverage.height = options.height * side;
    coverage.tile = options.placement.tile;
    coverage.repeat = options.placement.repeat;
    return coverage;
}

/// A strip of the map in memory.
struct Strip {
    std::vector<float> normals, heights;
    std::vector<TexelState> states;

    Strip(std::size_t width, std::size_t rows)
        : normals(3 * width * rows), heights(width * rows), states(width * rows) {}

    /// Some of its rows, counted within it.
    BakedRows rows(int width, int first_row, int begin, int count) {
        const auto first = static_cast<std::size_t>(begin) * static_cast<std::size_t>(width);
        const auto texels = static_cast<std::size_t>(count) * static_cast<std::size_t>(width);
        return {first_row, count, std::span(normals).subspan(3 * first, 3 * texels),
                std::span(heights).subspan(first, texels),
                std::span(states).subspan(first, texels)};
    }
};

int rows_of_strip(int width, int height) {
    const auto fitting = static_cast<int>(strip_texels / static_cast<std::size_t>(width));
    const int rows = std::max(fitting / least_rows, 1) * least_rows;
    return std::min(rows, height);
}

/// Bakes rows [first, last), and says what there was.
void bake_strip(const BakeWork& work, const TexelCover& cover, Strip& strip, int first, int last,
                BakeResult& result, BakeCounts& counts, Report& report) {
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
        reports.emplace(row, std::move(found));
    };
    result.coverage += cover.cover(first * side, last * side, take, report);
    for (const auto& [row, found] : reports)
        report.merge(found);
}

}  // namespace

BakeResult bake_normals(std::span<const Mesh> high, const Mesh& low, const BakeOptions& options,
                        const std::function<void(const BakedRows& rows)>& take, Report& report) {
    check(options);
    const int side = side_of(options.samples);
    const LowSurface low_surface(low, options, report);
    const TexelCover cover(low_surface.mesh().texcoords, low_surface.mesh().triangles,
                           coverage_options(options, side), report);
    const HighSurface high_surface(high, report);
    BakeResult result;
    result.distances = distances_of(high, high_surface, low, options);
    const BakeWork work{high_surface, low_surface, options, result.distances, side};
    const int rows = rows_of_strip(options.width, options.height);
    Strip strip(static_cast<std::size_t>(options.width), static_cast<std::size_t>(rows));
    Dilation dilation(options.width, options.height, options.padding, take);
    BakeCounts counts;
    for (int first = 0; first < options.height; first += rows) {
        const int last = std::min(first + rows, options.height);
        bake_strip(work, cover, strip, first, last, result, counts, report);
        dilation.push(strip.rows(options.width, first, 0, last - first));
    }
    result.samples = counts.samples;
    result.rays = counts.rays;
    result.texels_baked = counts.baked;
    result.texels_missed = counts.missed;
    if (counts.baked > 0) {
        result.least_height = counts.least_height;
        result.greatest_height = counts.greatest_height;
    }
    return result;
}

}  // namespace relief
