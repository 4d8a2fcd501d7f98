// SPDX-License-Identifier: Apache-2.0
/// \file
/// From methods that can be run to measurements: errors that are known already, times and memory
/// taken in turns, the efficient ones marked.
/// Tests: tests/accuracy/measured_methods_test.cpp.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "relief/accuracy/experiment.h"
#include "relief/accuracy/measure.h"

namespace relief {

/// A method on the experiment's input.
struct MeasuredMethod {
    std::string name;
    std::vector<std::pair<std::string, std::string>> choices;
    ErrorFigures error;
    std::function<void()> work{};  ///< What is timed; none: the method has no time of its own.
    double stored_bytes = 0.0;
    std::string note{};
};

/// Puts the measurements into the experiment and marks what is efficient.
void measure_methods(std::span<const MeasuredMethod> methods, const RunOptions& options,
                     const CostChoice& choice, Experiment& experiment);

/// The measurement of least RMS error among those with defined results; nullptr if there is none.
const Measurement* truest(const Experiment& experiment);

/// A method's measurement. \throws std::out_of_range without one of that name
const Measurement& method_in(const Experiment& experiment, const std::string& name);

/// The median seconds on one thread, on all where that is all there is; NaN where none was timed.
double median_seconds(const Measurement& measurement);

/// The value of a choice: value_of(measurement, "arithmetic"). Empty where there is no such one.
std::string value_of(const Measurement& measurement, const std::string& choice);

/// A curve with the slope fitted through its points.
Curve fitted_curve(std::string method, std::vector<CurvePoint> points,
                   std::optional<double> expected_order);

}  // namespace relief
