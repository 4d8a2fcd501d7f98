// SPDX-License-Identifier: Apache-2.0
/// \file
/// Runs the same job on several files. An error in one file does not stop the others.
/// Tests: tests/tools/batch_test.cpp, process_batch_test.cpp.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/command.h"
#include "common/file_jobs.h"
#include "common/findings.h"
#include "common/options.h"

namespace relief::tools {

/// The result of a file.
struct FileOutcome {
    std::string line;  ///< The line for stdout, without newline.
    Findings findings;
    nlohmann::ordered_json json;  ///< The entry in the report, besides "input" and "output".
};

struct Batch {
    std::vector<Job> jobs;
    /// Runs job `index`. Several threads call it.
    std::function<FileOutcome(std::size_t index)> work;
    /// Runs the jobs one after another, because two could write the same file.
    bool one_by_one = false;
    nlohmann::ordered_json head;  ///< The head of the report: tool, version, options.
};

/// Runs all jobs in parallel, one per thread. Prints the line or the error of each job in the given
/// order, and then writes the report: the head, the number of failed jobs, and "files".
///
/// \return failed if a job failed; else fell_back if --strict was given and there are findings
ExitCode run_batch(const CLI::App& app, const Batch& batch, const ReportOptions& report,
                   const GeneralOptions& general);

}  // namespace relief::tools
