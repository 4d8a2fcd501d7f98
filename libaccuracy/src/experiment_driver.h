// SPDX-License-Identifier: Apache-2.0
/// \file
/// The common steps of all experiments: measure a list of methods, look up measurements, and run
/// the experiments of a subject in order.
#pragma once

#include <functional>
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

/// "float32 changes no RMS error by more than 0.01 degrees and takes 0.70 times as long (median of
/// the kernels)."
///
/// \param experiment  its measurements are pairs of the same method in float64 and in float32
/// \param plural  the kind of the methods: "kernels"
std::string arithmetic_finding(const Experiment& experiment, const char* plural);

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
