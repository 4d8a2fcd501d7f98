// SPDX-License-Identifier: Apache-2.0
/// \file
/// The common options of `run` and `own`: how to run experiments, and the output of the report.
/// Tests: tests/tools/accuracy_run_test.cpp, accuracy_own_test.cpp.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "accuracy_report.h"
#include "common/options.h"
#include "relief/accuracy/experiment.h"

namespace relief::tools {

struct ExperimentOptions {
    std::optional<std::filesystem::path> output;
    bool quick = false;
    bool no_times = false;
    std::optional<int> repeats;
    bool json = false;
    GeneralOptions general;
};

/// Adds --output, --json, --quick, --no-times, --repeats, --threads and --quiet.
void add_experiment_options(CLI::App& app, ExperimentOptions& options);

/// \throws UsageError if options contradict each other or have no effect
void check(const ExperimentOptions& options);

RunOptions run_options(const ExperimentOptions& options);

/// Returns the options that repeat the experiments: " --quick --repeats 3".
std::string effort_options(const ExperimentOptions& options);

/// Returns whether tables are printed.
bool prints_tables(const ExperimentOptions& options);

/// Creates the output folder and sets the number of threads.
void prepare(const ExperimentOptions& options);

/// Completes a report that has its experiments and command, writes it, and prints the end of the
/// output.
/// \param draws  whether OpenGL was used; then the report names it
void finish_report(const ExperimentOptions& options, AccuracyReport report, bool draws);

}  // namespace relief::tools
