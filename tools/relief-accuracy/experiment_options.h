// SPDX-License-Identifier: Apache-2.0
/// \file
/// How experiments are run and what becomes of the report: what `run` and `own` have alike.
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

/// --output, --json, --quick, --no-times, --repeats, --threads, --quiet.
void add_experiment_options(CLI::App& app, ExperimentOptions& options);

/// \throws UsageError where options contradict each other, or have no effect
void check(const ExperimentOptions& options);

RunOptions run_options(const ExperimentOptions& options);

/// The options that a command needs to repeat the experiments: " --quick --repeats 3".
std::string effort_words(const ExperimentOptions& options);

/// Whether tables are for people to read.
bool prints_tables(const ExperimentOptions& options);

/// Makes the folder, and limits the threads.
void prepare(const ExperimentOptions& options);

/// Completes a report that has its experiments and command, writes it, and prints what is to be
/// printed at the end.
/// \param draws  something was drawn: the machine's OpenGL is told
void hand_over(const ExperimentOptions& options, AccuracyReport report, bool draws);

}  // namespace relief::tools
