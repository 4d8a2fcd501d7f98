// SPDX-License-Identifier: Apache-2.0
// Tests: tests/accuracy/fresnel_experiment_test.cpp, unit_normal_experiment_test.cpp.
#include "shading/formula_methods.h"

#include <cmath>

#include "measured_methods.h"

namespace relief {

ErrorFigures formula_error(const FormulaMethod& method, std::span<const double> truth) {
    std::vector<float> results(truth.size());
    method.compute(results);
    for (std::size_t i = 0; i < truth.size(); ++i)
        results[i] = static_cast<float>(std::abs(static_cast<double>(results[i]) - truth[i]));
    return figures_of(angle_distribution(std::move(results)));
}

void measure_formulas(std::span<const FormulaMethod> methods, std::span<const double> truth,
                      const RunOptions& options, Experiment& experiment) {
    std::vector<float> results(truth.size());
    std::vector<MeasuredMethod> measured;
    for (const FormulaMethod& method : methods) {
        measured.push_back({method.name, method.choices, formula_error(method, truth),
                            [&method, &results] { method.compute(results); }});
    }
    measure_methods(measured, options, {.all_threads = false, .memory = false}, experiment);
}

}  // namespace relief
