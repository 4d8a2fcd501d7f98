// SPDX-License-Identifier: Apache-2.0
// A normal between those of a triangle's corners is shorter than 1, the more so the further these
// are apart: what that does to light, and what making it unit again costs [Phong 1975]. Numbers
// alone: no picture. Tests: tests/accuracy/unit_normal_experiment_test.cpp.
#include <fmt/format.h>

#include "shading/shading_plan.h"
#include "shading/unit_normal_methods.h"

namespace relief {
namespace {

Chart chart_by_turn() {
    Chart chart{.id = "angle",
                .title = "Error by the angle between neighbouring normals",
                .x_label = "degrees between the normals of a triangle's corners",
                .y_label = "radiance"};
    const NormalSamples first(1.0, 32);
    for (const FormulaMethod& method : unit_normal_methods(first))
        chart.curves.push_back({.method = method.name});
    for (const double degrees : {1.0, 2.0, 4.0, 8.0, 15.0, 30.0, 60.0, 90.0}) {
        const NormalSamples samples(degrees, 32);
        const std::vector<FormulaMethod> methods = unit_normal_methods(samples);
        const std::vector<double> truth = samples.true_radiances();
        for (std::size_t i = 0; i < methods.size(); ++i)
            chart.curves[i].points.push_back({degrees, formula_error(methods[i], truth).rms});
    }
    // A chord's length lacks the square of its angle, and Newton's step the square of that: where
    // angles are small, and float's rounding smaller still.
    chart.curves[0].expected_order = 2.0;
    chart.curves[1].expected_order = 4.0;
    for (std::size_t i = 0; i < 2; ++i) {
        std::vector<CurvePoint> small = chart.curves[i].points;
        std::erase_if(small, [](const CurvePoint& p) { return p.x < 2.0 || p.x > 8.0; });
        chart.curves[i].order = fitted_order(small);
    }
    return chart;
}

}  // namespace

Experiment unit_normal_experiment(const RunOptions& options) {
    constexpr double degrees = 30.0;
    const NormalSamples samples(degrees, 96);
    Experiment experiment{
        .id = "shading/unit-normal",
        .question = "Does the interpolated normal have to be made unit?",
        .truth =
            "the same light in double, from the normal made unit; tests hold it to a formula in "
            "angles, and the length in the triangle's middle to its closed form",
        .input = fmt::format("{} places on a triangle whose corners' normals are {} degrees apart; "
                             "diffuse light and a highlight of shininess 40, lamp of irradiance 1",
                             samples.count(), degrees),
        .error_unit = "radiance",
        .item = "place",
        .items = static_cast<double>(samples.count())};
    measure_formulas(unit_normal_methods(samples), samples.true_radiances(), options, experiment);
    experiment.charts = {chart_by_turn()};
    experiment.finding = fmt::format(
        "Where corners' normals are {} degrees apart, the interpolated normal without "
        "normalization gives light with an RMS error of {:.2g} (at most {:.2g}), where the "
        "brightest light is {:.2g}; one Newton step reduces the RMS error to {:.2g}, a square root "
        "to {:.1g}.",
        degrees, experiment.measurements[0].error.rms, experiment.measurements[0].error.max,
        samples.brightest(), experiment.measurements[1].error.rms,
        experiment.measurements[2].error.rms);
    return experiment;
}

}  // namespace relief
