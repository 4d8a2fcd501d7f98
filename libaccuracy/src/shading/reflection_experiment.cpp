// SPDX-License-Identifier: Apache-2.0
// Surroundings in closed form, stored as cube maps of several sizes, in a mirror. Tests:
// tests/accuracy/surroundings_experiments_test.cpp.
#include <fmt/format.h>

#include <cmath>

#include "shading/shading_plan.h"
#include "shading/surroundings.h"

namespace relief {
namespace {

std::string name_of(int side) {
    return fmt::format("{0} x {0} texels", side);
}

/// Half floats of four channels, six faces, and a third more for smaller levels.
double bytes_of(int side) {
    return 6.0 * 8.0 * side * side * 4.0 / 3.0;
}

}  // namespace

Experiment reflection_experiment(const Drawing& drawing, const RunOptions& options) {
    const int size = options.is_quick ? 160 : 320;
    const int rays = 4;
    const int largest = options.is_quick ? 256 : 1024;
    Experiment experiment{
        .id = "shading/cube-map-size",
        .question = "How large must a cube map be for a mirror?",
        .truth = fmt::format("the formula of the surroundings in the directions that a ball in "
                             "closed form mirrors, mean of {} rays a pixel; a test draws the same "
                             "with the reference shader",
                             rays * rays),
        .input = fmt::format("mirroring ball, surroundings with details of 3 degrees, {0} x {0} "
                             "pixels, about 0.7 degrees of the surroundings in each",
                             size),
        .error_unit = "FLIP",
        .item = "pixel",
        .items = static_cast<double>(size) * size};
    if (!drawing.is_possible_for(experiment)) return experiment;
    std::vector<DrawnMethod> all;
    for (int side = 16; side <= largest; side *= 2) {
        all.push_back({name_of(side),
                       {{"size", fmt::format("{}", side)}},
                       mirror_ball(cube_map_of(waves_and_lamps, side), 0.0),
                       1,
                       1,
                       bytes_of(side)});
    }
    const Image truth = true_mirror(waves_and_lamps, size, rays);
    const std::vector<DrawnPicture> pictures =
        measure_drawn(drawing, all, truth, options, experiment);
    Curve curve{.method = "cube map"};
    for (std::size_t i = 0; i < all.size(); ++i)
        curve.points.push_back({16.0 * std::exp2(i), experiment.measurements[i].error.rms});
    curve.order = fitted_order(curve.points);
    experiment.charts = {{.id = "size",
                          .title = "Error by size",
                          .x_label = "texels along a face",
                          .y_label = "FLIP",
                          .curves = {std::move(curve)}}};
    for (const std::size_t i : {1U, 3U}) {
        experiment.pictures.push_back(
            pair_of("The surroundings in a mirror", all[i].name, pictures[i].picture, truth));
        experiment.heat_maps.push_back({"Where it is seen", all[i].name, pictures[i].errors, 0.5});
    }
    const auto& found = experiment.measurements;
    experiment.finding = fmt::format(
        "The mirror is FLIP {:.3f} (RMS) off with {} a face, {:.3f} with {} and {:.3f} with {}, "
        "which take {:.2g}, {:.2g} and {:.2g} MB.",
        found[1].error.rms, all[1].name, found[3].error.rms, all[3].name, found.back().error.rms,
        all.back().name, all[1].stored_bytes * 1e-6, all[3].stored_bytes * 1e-6,
        all.back().stored_bytes * 1e-6);
    experiment.finding += frame_times(
        {{all[1].name, found[1]}, {all[3].name, found[3]}, {all.back().name, found.back()}});
    return experiment;
}

}  // namespace relief
