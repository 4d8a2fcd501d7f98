// SPDX-License-Identifier: Apache-2.0
// Reflectances of glass and of a metal by angle, and Schlick's error by index. Numbers alone: no
// picture. Tests: tests/accuracy/fresnel_experiment_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "measured_methods.h"
#include "shading/fresnel_methods.h"
#include "shading/shading_plan.h"

namespace relief {
namespace {

struct Boundary {
    const char* name;
    std::complex<double> index;
};
/// Metals in green light.
const std::array boundaries = {Boundary{"water, 1.33", 1.33},
                               Boundary{"glass, 1.5", 1.5},
                               Boundary{"diamond, 2.42", 2.42},
                               Boundary{"silicon, 4.1", 4.1},
                               Boundary{"gold, 0.43 + 2.46i", {0.43, 2.46}},
                               Boundary{"aluminium, 0.96 + 6.69i", {0.96, 6.69}},
                               Boundary{"iron, 2.95 + 2.93i", {2.95, 2.93}}};

/// The root mean square of Schlick's error, and its largest.
ErrorFigures schlick_error(std::complex<double> index, std::span<const float> cosines) {
    const std::vector<FormulaMethod> methods = fresnel_methods(index, cosines);
    return formula_error(methods.at(1), true_reflectances(index, cosines));
}

/// Schlick's error at each angle, boundary by boundary.
Chart chart_by_incidence() {
    Chart chart{.id = "angle",
                .title = "Schlick's error by angle",
                .x_label = "angle of incidence, degrees",
                .y_label = "reflectance",
                .is_x_log = false};
    const std::vector<float> cosines = cosines_of_angles(91);
    for (const Boundary& boundary : boundaries) {
        std::vector<float> found(cosines.size());
        fresnel_methods(boundary.index, cosines).at(1).compute(found);
        const std::vector<double> truth = true_reflectances(boundary.index, cosines);
        Curve curve{.method = boundary.name};
        for (std::size_t i = 0; i < found.size(); ++i) {
            curve.points.push_back(
                {static_cast<double>(i), std::abs(static_cast<double>(found[i]) - truth[i])});
        }
        chart.curves.push_back(std::move(curve));
    }
    return chart;
}

Chart index_chart(std::span<const float> cosines) {
    Chart chart{.id = "index",
                .title = "Error by index of refraction",
                .x_label = "index of refraction",
                .y_label = "reflectance",
                .is_x_log = false};
    for (const FormulaMethod& method : fresnel_methods(1.5, cosines))
        chart.curves.push_back({.method = method.name});
    for (const double index : {1.1, 1.2, 1.33, 1.4, 1.5, 1.6, 1.8, 2.0, 2.42, 3.0, 3.5, 4.0}) {
        const std::vector<FormulaMethod> methods = fresnel_methods(index, cosines);
        const std::vector<double> truth = true_reflectances(index, cosines);
        for (std::size_t i = 0; i < methods.size(); ++i)
            chart.curves[i].points.push_back(
                {index, curve_error(formula_error(methods[i], truth))});
    }
    return chart;
}

Experiment described(const Boundary& boundary, std::size_t angles) {
    return {.question = "What does Schlick's fit give away, and what does Fresnel's formula cost?",
            .truth =
                "Fresnel's formulas for unpolarised light in double; tests hold them to "
                "normal incidence, Brewster's angle and grazing incidence in closed form",
            .input = fmt::format("{}: {} angles from 0 to 90 degrees", boundary.name, angles),
            .error_unit = "reflectance",
            .item = "angle",
            .items = static_cast<double>(angles)};
}

std::string figures(const Experiment& experiment, const char* method) {
    const ErrorFigures& error = method_in(experiment, method).error;
    return fmt::format("{:.2g} (RMS; at most {:.2g})", error.rms, error.max);
}

Experiment measured(const Boundary& boundary, const RunOptions& options) {
    const std::vector<float> cosines = cosines_of_angles(4096);
    Experiment experiment = described(boundary, cosines.size());
    measure_formulas(fresnel_methods(boundary.index, cosines),
                     true_reflectances(boundary.index, cosines), options, experiment);
    return experiment;
}

}  // namespace

Experiment glass_experiment(const RunOptions& options) {
    Experiment experiment = measured(boundaries[1], options);
    experiment.id = "shading/fresnel-glass";
    const std::vector<float> cosines = cosines_of_angles(901);
    experiment.charts = {chart_by_incidence(), index_chart(cosines)};
    experiment.finding = fmt::format(
        "For glass, Schlick's fit is {} off, the reflectance of normal incidence taken everywhere "
        "{}. The fit is made for indices around 1.5: at 2.42 it is off by up to {:.2g}, at 3.5 by "
        "up to {:.2g}.",
        figures(experiment, "Schlick"), figures(experiment, "constant"),
        schlick_error(2.42, cosines).max, schlick_error(3.5, cosines).max);
    return experiment;
}

Experiment metal_experiment(const RunOptions& options) {
    Experiment experiment = measured(boundaries[6], options);
    experiment.id = "shading/fresnel-metal";
    experiment.finding = fmt::format(
        "For iron, Schlick's fit is {} off: metals dim towards grazing angles before they "
        "brighten, which it cannot show. One more number, by which it is right at 82 degrees, "
        "leaves {}.",
        figures(experiment, "Schlick"), figures(experiment, "Schlick, right at 82 degrees"));
    return experiment;
}

}  // namespace relief
