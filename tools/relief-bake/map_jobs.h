// SPDX-License-Identifier: Apache-2.0
/// \file
/// Work on one map or many, as every command of relief-bake does it that makes a map of each.
/// Tests: tests/tools/relief_bake_test.cpp, convert_test.cpp.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "common/batch.h"
#include "common/file_jobs.h"
#include "common/findings.h"
#include "common/options.h"

namespace relief::tools {

/// What all such commands have on their command lines.
struct MapFiles {
    FileWords words;
    ReportOptions report;
    GeneralOptions general;
};

/// What a command does with each map.
struct MapWork {
    nlohmann::ordered_json head;  ///< What begins the report: tool, version.
    /// Throws UsageError where the command line alone shows that this cannot be.
    std::function<void(const Job& job)> check;
    /// Does it; prints a summary if asked to.
    std::function<FileOutcome(const Job& job, Stages& stages, bool prints_summary)> work;
};

/// \param inputs   what the inputs are: "normal map", "normal maps" with an s
/// \param details  what else there is to say of them, whole sentences
/// \param output   what each becomes
void add_map_files(CLI::App& app, MapFiles& files, const std::string& inputs,
                   const std::string& details, const std::string& output = "normal map");

/// -o, which is best told beside the other options about output.
void add_map_folder(CLI::App& app, MapFiles& files);

/// \param file  of a kind that the command reads and does not make: "height map"
/// \throws UsageError if the job's output would be written over it
void refuse_to_replace(const std::filesystem::path& file, const std::string& kind, const Job& job);

/// Does one map with a summary, or many with a line for each.
/// \throws UsageError, FileError before anything is read where something is wrong by then
ExitCode run_map_jobs(const CLI::App& app, const MapFiles& files, const MapWork& work);

}  // namespace relief::tools
