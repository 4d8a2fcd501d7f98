// SPDX-License-Identifier: Apache-2.0
// Tests: tests/mesh/bake/bake_check_test.cpp, bake_trials_test.cpp.
#include "bake/bake_check_casts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace relief {
namespace {

constexpr double reference_angle = 0.5;  // Degrees.
constexpr int most_samples = 256;        // Of a reference, unless the map itself has as many.
constexpr int finest_reference = 1024;

BakeMapOptions with_samples(BakeMapOptions map, int samples, std::optional<double> angle) {
    map.samples = samples;
    map.sample_angle = angle;
    return map;
}

}  // namespace

BakeMapOptions reference_of(const BakeMapOptions& map, int samples) {
    const int usual =
        map.samples < most_samples ? std::min(16 * map.samples, most_samples) : finest_reference;
    int wanted = samples > 0 ? samples : usual;
    // Of large maps, as many as coverage has room for.
    const int longest = std::max(map.width, map.height);
    while (wanted > 4 &&
           std::sqrt(wanted) * longest > static_cast<double>(TexelCover::largest_side))
        wanted /= 4;
    return with_samples(map, wanted, reference_angle * std::numbers::pi / 180.0);
}

namespace {

std::vector<CoveredTexel> owners_of(const Baker& baker, const BakeMapOptions& map, int first,
                                    int last) {
    CoverageOptions options;
    options.width = map.width;
    options.height = map.height;
    options.tile = map.placement.tile;
    options.repeat = map.placement.repeat;
    options.only = map.triangles;
    const auto width = static_cast<std::size_t>(map.width);
    std::vector<CoveredTexel> owners(width * static_cast<std::size_t>(last - first));
    Report said_by_the_bake;
    const TexelCover cover(baker.low().texcoords, baker.low().triangles, options, said_by_the_bake);
    cover.cover(
        first, last,
        [&](int row, std::span<const CoveredTexel> texels) {
            std::copy(texels.begin(), texels.end(),
                      owners.begin() + static_cast<std::ptrdiff_t>(
                                           width * static_cast<std::size_t>(row - first)));
        },
        said_by_the_bake);
    return owners;
}

}  // namespace

BakeCasts::BakeCasts(const Baker& baker, const BakeMapOptions& map, int reference_samples,
                     int first, int last, Report& report) {
    Report unsaid;
    centre = cast_rows(baker, with_samples(map, 1, std::nullopt), first, last,
                       map.samples == 1 ? report : unsaid);
    reference = cast_rows(baker, reference_of(map, reference_samples), first, last, unsaid);
    if (map.samples > 1) several = cast_rows(baker, map, first, last, report);
}

CheckSums check_strip(const Baker& baker, const BakeMapOptions& map, const BakeCasts& casts,
                      const CastRows& made, std::span<const float> remade,
                      std::span<const float> shown, int first, int step, std::span<float> degrees) {
    const auto rows = static_cast<int>(degrees.size() / static_cast<std::size_t>(map.width));
    RowsToCheck strip;
    strip.first = first;
    strip.width = map.width;
    strip.height = map.height;
    strip.owners = owners_of(baker, map, first, first + rows);
    strip.reference = &casts.reference;
    strip.centre = &casts.centre;
    strip.made = &made;
    strip.remade = remade;
    strip.map = shown.empty() ? remade : shown;
    return check_rows(baker, strip, step, degrees);
}

}  // namespace relief
