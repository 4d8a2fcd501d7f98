// SPDX-License-Identifier: Apache-2.0
/// \file
/// --report FILE and --strict, alike for every command that may have to fall back.
/// Tests: tests/tools/relief_mesh_test.cpp, relief_bake_test.cpp.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/command.h"
#include "common/findings.h"

namespace relief::tools {

struct ReportOptions {
    std::optional<std::filesystem::path> file;
    bool strict = false;
};

/// \param strict  what --strict does, where a command has rules of its own; empty: the usual text
void add_report_options(CLI::App& app, ReportOptions& options, const std::string& strict = "");

/// \throws UsageError if the report would overwrite one of the files that the command works on;
///         FileError if its folder does not exist, so that this is known before the work is done
void check(const ReportOptions& options, const std::vector<std::filesystem::path>& files);

/// Warns on stderr where --strict was given and `input` was not faultless. \return whether so
bool found_fault(const CLI::App& app, const ReportOptions& options,
                 const std::filesystem::path& input, const Findings& findings);

/// Writes the report, if one is wanted, and judges the findings. \return done, or fell_back with a
/// warning on stderr where --strict was given and `input` was not faultless
ExitCode finish(const CLI::App& app, const ReportOptions& options,
                const std::filesystem::path& input, const Findings& findings,
                const nlohmann::ordered_json& report);

}  // namespace relief::tools
