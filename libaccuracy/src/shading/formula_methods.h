// SPDX-License-Identifier: Apache-2.0
/// \file
/// Ways to compute one formula in float, for the same many inputs: how far each is from the truth,
/// and what it takes. Tests: tests/accuracy/fresnel_experiment_test.cpp,
/// unit_normal_experiment_test.cpp.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "relief/accuracy/experiment.h"

namespace relief {

/// One way; writes a result for each input, which it knows.
struct FormulaMethod {
    std::string name;
    std::vector<std::pair<std::string, std::string>> choices;
    std::function<void(std::span<float> results)> compute;
};

/// Absolute differences. NaN counts as undefined.
ErrorFigures formula_error(const FormulaMethod& method, std::span<const double> truth);

/// Adds a measurement for each to the experiment; times are of one thread, all inputs together.
void measure_formulas(std::span<const FormulaMethod> methods, std::span<const double> truth,
                      const RunOptions& options, Experiment& experiment);

}  // namespace relief
