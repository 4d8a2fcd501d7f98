// SPDX-License-Identifier: Apache-2.0
// Rough mirrors: a chain of levels that are blurred beforehand, mixed by roughness, against many
// samples for each pixel [Karis, SIGGRAPH 2013]. Tests:
// tests/accuracy/surroundings_experiments_test.cpp.
#include <fmt/format.h>

#include "drawn/many_samples.h"
#include "relief/accuracy/passes.h"
#include "shading/shading_plan.h"
#include "shading/surroundings.h"

namespace relief {
namespace {

/// Cube maps below 256 texels are blurred into fewer, smaller levels (libshade/src/gl/cube_map.h).
constexpr int large = 256;
constexpr int small_map_side = 128;
/// Of pictures of balls, in pixels.
constexpr int full_ball_size = 192;
constexpr int quick_ball_size = 64;

/// Scenes of one roughness: the truth's, and the methods'.
struct Balls {
    Environment finest = cube_map_of(waves_and_lamps, large);
    Environment coarser = cube_map_of(waves_and_lamps, small_map_side);

    [[nodiscard]] std::vector<DrawnMethod> methods(double roughness) const {
        return {{"not blurred", {{"levels", "none"}}, mirror_ball(finest, 0.0)},
                {"5 levels, 128 texels", {{"levels", "5"}}, mirror_ball(coarser, roughness)},
                {"6 levels, 256 texels", {{"levels", "6"}}, mirror_ball(finest, roughness)}};
    }
};

/// What takes long is the truth, 1024 lookups a pixel for each roughness, and the levels of each
/// method's map: a quick run has smaller pictures here, and fewer of them.
Chart roughness_chart(const Drawing& drawing, const Balls& balls, bool is_quick) {
    const int size = is_quick ? quick_ball_size / 2 : full_ball_size;
    std::vector<double> roughnesses = {0.1, 0.2, 0.3, 0.5, 1.0};
    if (!is_quick) roughnesses = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0};
    Chart chart{.id = "roughness",
                .title = "Error by roughness",
                .x_label = "roughness",
                .y_label = "FLIP",
                .is_x_log = false};
    for (const DrawnMethod& method : balls.methods(roughnesses.front()))
        chart.curves.push_back({.method = method.name});
    for (const double roughness : roughnesses) {
        const Image truth = many_samples(mirror_ball(balls.finest, roughness), size, 1);
        const std::vector<DrawnMethod> methods = balls.methods(roughness);
        for (std::size_t i = 0; i < methods.size(); ++i)
            chart.curves[i].points.push_back({roughness, drawn_error(drawing, methods[i], truth)});
    }
    return chart;
}

}  // namespace

Experiment glossy_experiment(const Drawing& drawing, const RunOptions& options) {
    const int size = options.is_quick ? quick_ball_size : full_ball_size;
    constexpr double shown = 0.3;
    Experiment experiment{
        .id = "shading/glossy-levels",
        .question = "How well do a few blurred levels stand for a rough mirror?",
        .truth =
            "the reference shader in double, mean of 1024 facets of GGX for each pixel; tests "
            "hold it to constant surroundings, and to linear ones, whose blur has a closed "
            "form",
        .input = fmt::format("ball of roughness {0}, {1} x {1} pixels", shown, size),
        .error_unit = "FLIP",
        .item = "pixel",
        .items = static_cast<double>(size) * size};
    if (!drawing.is_possible_for(experiment)) return experiment;
    const Balls balls;
    const std::vector<DrawnMethod> all = balls.methods(shown);
    const Image truth =
        made_once(options, [&] { return many_samples(mirror_ball(balls.finest, shown), size, 1); });
    const std::vector<DrawnPicture> pictures =
        measure_drawn(drawing, all, truth, options, experiment);
    experiment.charts = {
        made_once(options, [&] { return roughness_chart(drawing, balls, options.is_quick); })};
    for (const std::size_t i : {0U, 2U}) {
        experiment.pictures.push_back(
            pair_of("A rough mirror", all[i].name, pictures[i].picture, truth));
    }
    experiment.heat_maps.push_back({"Where it is seen", all[2].name, pictures[2].errors, 0.2});
    const auto& found = experiment.measurements;
    experiment.finding = fmt::format(
        "At roughness {}, 6 levels are FLIP {:.4f} (RMS) off, 5 levels {:.4f}, and a mirror that "
        "is not blurred {:.3f}.",
        shown, found[2].error.rms, found[1].error.rms, found[0].error.rms);
    experiment.finding +=
        frame_times({{"6 levels", found[2]}, {"5 levels", found[1]}, {"not blurred", found[0]}});
    return experiment;
}

}  // namespace relief
