// SPDX-License-Identifier: Apache-2.0
/// \file
/// Experiments of a subject, run one after another and told as they go.
/// Tests: tests/accuracy/planned_experiment_test.cpp.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "relief/accuracy/experiment.h"

namespace relief {

/// An experiment before it is run.
struct PlannedExperiment {
    std::string title;
    std::function<Experiment()> run;  ///< All of it but the title.
};

/// Runs them in order; before each, options.tell() hears of it. What that throws passes.
std::vector<Experiment> run_planned(std::span<const PlannedExperiment> plan,
                                    const RunOptions& options);

}  // namespace relief
