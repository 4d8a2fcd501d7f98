// SPDX-License-Identifier: Apache-2.0
/// \file
/// The commands of relief-accuracy, and the options that `run` and `own` share: how to run
/// experiments, and the output of the report. Tests: tests/tools/accuracy_run_test.cpp.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "accuracy_report.h"
#include "common/command.h"
#include "common/options.h"
#include "relief/accuracy/experiment.h"

namespace relief::tools {

Command add_run_command(CLI::App& tool);
Command add_own_command(CLI::App& tool);
Command add_report_compare_command(CLI::App& tool);
Command add_page_command(CLI::App& tool);
Command add_fidelity_command(CLI::App& tool);

/// The whole tool, for main() and for tests that run it in their own process.
inline Tool relief_accuracy() {
    return {"relief-accuracy",
            "Measures the error and the time of methods, and compares reports.",
            {add_run_command, add_own_command, add_report_compare_command, add_page_command,
             add_fidelity_command}};
}

// The options of `run` and `own`.

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

accuracy::RunOptions run_options(const ExperimentOptions& options);

/// Returns the options of a command line as typed, except for those of its output: " --quick
/// --repeats 3".
std::string repeated_options(const CLI::App& app);

bool prints_tables(const ExperimentOptions& options);

/// Creates the output folder and sets the number of threads.
void prepare(const ExperimentOptions& options);

/// Completes a report that has its experiments and command, writes it, and prints the end of the
/// output.
/// \param draws  whether OpenGL was used; then the report names it
void finish_report(const ExperimentOptions& options, AccuracyReport report, bool draws,
                   const ProcessorUse& use);

}  // namespace relief::tools
