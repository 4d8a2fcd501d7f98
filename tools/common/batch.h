// SPDX-License-Identifier: Apache-2.0
/// \file
/// The same work on many files in one call: one that fails does not stop the others.
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
#include "common/options.h"
#include "common/report_options.h"

namespace relief::tools {

/// What is said of one file that was done.
struct FileOutcome {
    std::string line;  ///< For stdout, without the end of the line.
    Findings findings;
    nlohmann::ordered_json json;  ///< For the report, beside "input" and "output".
};

struct Batch {
    std::vector<Job> jobs;
    /// Does the one at `index`. Called from several threads.
    std::function<FileOutcome(std::size_t index)> work;
    /// Whether two could get in each other's way: then they are done one after another.
    bool one_by_one = false;
    nlohmann::ordered_json head;  ///< What begins the report: tool, version, options.
};

/// Does all jobs, several at once, as many as there are threads. As each is done, in the order
/// given, its line goes to stdout, or the error that it threw to stderr; then the report is
/// written: the head, the number of those that "failed", and "files".
///
/// \return failed if any failed; else fell_back if --strict was given and anything was found
ExitCode run_batch(const CLI::App& app, const Batch& batch, const ReportOptions& report,
                   const GeneralOptions& general);

}  // namespace relief::tools
