// SPDX-License-Identifier: Apache-2.0
/// \file
/// The common steps of all experiments: measure a list of methods, look up measurements, and run
/// the experiments of a subject in order.
#pragma once

#include <functional>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "relief/accuracy/experiment.h"
#include "relief/accuracy/measure.h"

namespace relief {

/// A method with its error, which is already known, and the work to time.
struct MeasuredMethod {
    std::string name;
    std::vector<std::pair<std::string, std::string>> choices;
    ErrorStats error;
    std::function<void()> work{};  ///< Empty: the method has no time of its own.
    double stored_bytes = 0.0;
    std::string note{};
};

/// Times the methods in interleaved rounds, adds their measurements to the experiment, and marks
/// the efficient ones.
void measure_methods(std::span<const MeasuredMethod> methods, const RunOptions& options,
                     const CostChoice& choice, Experiment& experiment);

/// The measurement with the least RMS error among those without undefined results, or nullptr.
const Measurement* most_accurate(const Experiment& experiment);

/// The measurement of a method. \throws std::out_of_range if there is none
const Measurement& method_in(const Experiment& experiment, const std::string& name);

/// The value of a choice such as "arithmetic", or an empty text.
std::string value_of(const Measurement& measurement, const std::string& choice);

/// "float32 changes no RMS error by more than 0.01 degrees and takes 0.70 times as long (median of
/// the kernels)." Compares the measurements in both arithmetics whose other choices are equal.
///
/// \param other_choices  names of the choices that must be equal
/// \param plural         what these choices select: "kernels"
std::string arithmetic_finding(const Experiment& experiment,
                               std::initializer_list<const char*> other_choices,
                               const char* plural);

/// A curve with the order fitted to its points.
Curve fitted_curve(std::string method, std::vector<CurvePoint> points,
                   std::optional<double> expected_order);

/// An experiment that can be run.
struct PlannedExperiment {
    std::string title;
    std::function<Experiment()> run;  ///< Returns everything except the title.
};

/// Runs experiments in order, and calls options.tell() before each. Exceptions pass through.
std::vector<Experiment> run_planned(std::span<const PlannedExperiment> plan,
                                    const RunOptions& options);

}  // namespace relief
