// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <numbers>

#include "normal_map_errors/error_tables.h"
#include "relief/mesh/analytic_heights.h"
#include "relief/mesh/normal_resize.h"
#include "support/resized_waves.h"

namespace relief::test {
namespace {

constexpr int resize_side = 96;

const std::vector<std::string> filter_names = {"box", "triangle", "cubic", "lanczos", "best"};
constexpr ResizeFilter filters[] = {ResizeFilter::box, ResizeFilter::triangle, ResizeFilter::cubic,
                                    ResizeFilter::lanczos, ResizeFilter::best};

struct Situation {
    int to;
    double rms_slope;      ///< Of the whole map, with the waves that are lost.
    double shortest_held;  ///< Waves in texels of the original that the other size can hold,
    double shortest_lost;  ///< and the shortest of those that it cannot; 0: there are none.
};

std::string row_of(const Situation& at, ResizeDomain domain) {
    std::vector<HeightWave> held =
        tiling_waves(resize_side, resize_side, 12, at.shortest_held, at.rms_slope, 5);
    std::vector<HeightWave> all = held;
    if (at.shortest_lost > 0.0) {
        const double limit = 2.0 * resize_side / at.to / 1.2;
        for (const HeightWave& wave :
             tiling_waves(resize_side, resize_side, 300, at.shortest_lost, at.rms_slope, 6)) {
            const bool is_lost = 2.0 * std::numbers::pi / glm::length(wave.frequency) < limit;
            if (is_lost && all.size() < 48) all.push_back(wave);
        }
    }
    const double factor = at.rms_slope / rms_slope_of(resize_side, resize_side, all);
    held = scaled_waves(held, factor);
    all = scaled_waves(all, factor);
    const Image normals = normals_image(resize_side, resize_side, all);
    const AnalyticHeights ground_truth =
        wave_heights(at.to, at.to, resized_waves(held, static_cast<double>(resize_side) / at.to));
    std::vector<double> ranks;
    std::vector<std::string> cells;
    for (const ResizeFilter filter : filters) {
        ResizeOptions options;
        options.filter = filter;
        options.domain = domain;
        Report report;
        const double error =
            normal_error(resize_normals(normals, at.to, at.to, options, report), ground_truth).rms;
        ranks.push_back(error);
        cells.push_back(in_digits(error));
    }
    return table_row(fmt::format("to {:.0f} %, slope {:g}{}, {}", 100.0 * at.to / resize_side,
                                 at.rms_slope, at.shortest_lost > 0.0 ? ", finer waves lost" : "",
                                 domain == ResizeDomain::slopes ? "slopes" : "vectors"),
                     ranks, cells);
}

}  // namespace

std::string resize_tables() {
    std::string text = "\nRMS error in degrees against the same surface at the other size\n\n" +
                       table_header(filter_names);
    constexpr Situation situations[] = {{48, 0.5, 8.0, 0.0},  {24, 0.5, 12.0, 3.0},
                                        {24, 1.5, 12.0, 3.0}, {64, 0.5, 6.0, 0.0},
                                        {144, 0.5, 6.0, 0.0}, {192, 1.5, 6.0, 0.0}};
    for (const Situation& situation : situations) {
        for (const ResizeDomain domain : {ResizeDomain::slopes, ResizeDomain::vectors})
            text += row_of(situation, domain);
    }
    return text;
}

}  // namespace relief::test
