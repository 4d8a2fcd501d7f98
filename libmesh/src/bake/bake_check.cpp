// SPDX-License-Identifier: Apache-2.0
// Strips of the map from the top: truth, bake and map side by side, then sums.
// Tests: tests/mesh/bake/bake_check_test.cpp.
#include "relief/mesh/bake_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bake/bake_check_casts.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

constexpr std::size_t strip_texels = 1'000'000;
constexpr std::size_t known_texels = 16384;  // For the search of a convention, at least if known.

int rows_of_strip(int width) {
    const auto fitting = static_cast<int>(strip_texels / static_cast<std::size_t>(width));
    return std::max(fitting / TexelCover::band_rows, 1) * TexelCover::band_rows;
}

/// Rows of an image of its own kind.
Image part_of(const Image& map, int first, int last) {
    Image part;
    part.width = map.width;
    part.height = last - first;
    part.channels = map.channels;
    part.color_space = ColorSpace::data;
    const std::size_t row =
        static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.channels);
    std::visit(
        [&](const auto& samples) {
            part.samples = std::decay_t<decltype(samples)>(
                samples.begin() +
                    static_cast<std::ptrdiff_t>(row * static_cast<std::size_t>(first)),
                samples.begin() +
                    static_cast<std::ptrdiff_t>(row * static_cast<std::size_t>(last)));
        },
        map.samples);
    return part;
}

void check(const Image& map, const BakeMapOptions& options) {
    if (map.channels < 3)
        throw InvalidInput(fmt::format("an image of {} channels holds no normals", map.channels));
    if (map.width != options.width || map.height != options.height) {
        throw InvalidInput(fmt::format("the map is of {} x {} texels, not {} x {}", map.width,
                                       map.height, options.width, options.height));
    }
}

void summarise(const CheckSums& sums, BakeCheck& check) {
    check.error = sums.error.summary();
    check.centre = sums.centre.summary();
    check.remade = sums.remade.summary();
    check.missed = sums.missed;
    check.frameless = sums.frameless;
    check.torn = sums.torn;
    check.worst = sums.worst;
    double all = 0.0;
    for (const double squares : sums.squares)
        all += squares;
    const auto index = [](BakeStage stage) { return static_cast<std::size_t>(stage); };
    for (std::size_t i = 0; i < bake_stage_count; ++i) {
        check.stages[i].rms = sums.stages[i].summary().rms;
        check.stages[i].share = all > 0.0 ? sums.squares[i] / all : 0.0;
    }
    // Of the codes' part in object space, what tangent space does not have is the basis's.
    StageError& codes = check.stages[index(BakeStage::quantisation)];
    StageError& basis = check.stages[index(BakeStage::basis)];
    const double texels =
        static_cast<double>(sums.stages[index(BakeStage::quantisation)].summary().count);
    const double more = sums.object_squares - sums.tangent_squares;
    if (!(more > 0.0)) return;
    // No mean of angles: what one mean square has more than another.
    basis.rms = std::sqrt(more / texels);
    basis.share = codes.share * more / sums.object_squares;
    codes.share -= basis.share;
}

/// How far apart the texels are that a convention is looked for by.
int step_of(const BakeMapOptions& map) {
    const double texels = static_cast<double>(map.width) * map.height;
    return std::max(static_cast<int>(std::sqrt(texels / known_texels)), 1);
}

ConventionFit convention_of(const Baker& baker, const Image& map, const BakeCheckOptions& options,
                            const std::vector<KnownTexel>& known) {
    ConventionSearch search;
    search.low = &baker.low();
    search.given = options.given;
    search.green = options.format.green;
    search.told.flat = options.format.flat;
    search.object_from_mesh = options.object_from_mesh;
    if (baker.options().space == BakeSpace::object)
        search.told.space = options.is_object ? MapAxes::object : MapAxes::world;
    return find_convention(map, known, search);
}

}  // namespace

BakeCheck check_bake(const Baker& baker, const Image& map, const BakeCheckOptions& options,
                     const std::function<void(int first_row, std::span<const float> degrees)>& take,
                     Report& report) {
    check(map, options.map);
    NormalMapFormat format = options.format;
    format.bits = map.bits();
    BakeCheck result;
    result.reference_samples = reference_of(options.map, options.reference_samples).samples;
    const int step = options.finds_convention ? step_of(options.map) : 0;
    const int rows = rows_of_strip(map.width);
    CheckSums sums;
    for (int first = 0; first < map.height; first += rows) {
        const int last = std::min(first + rows, map.height);
        const Image shown =
            decode_normal_map(part_of(map, first, last), format.green, format.flat, report);
        const BakeCasts casts(baker, options.map, options.reference_samples, first, last, report);
        std::vector<float> degrees(static_cast<std::size_t>(map.width) *
                                   static_cast<std::size_t>(last - first));
        const std::vector<float> remade = coded(casts.made().normals, map.width, format);
        sums.add(check_strip(baker, options.map, casts, casts.made(), remade, shown.as<float>(),
                             first, step, degrees));
        result.rays += casts.rays();
        if (take) take(first, degrees);
    }
    summarise(sums, result);
    if (options.finds_convention)
        result.convention = convention_of(baker, map, options, sums.known);
    return result;
}

}  // namespace relief
