// SPDX-License-Identifier: Apache-2.0
/// \file
/// The command line of relief-view: all options, and the conditions that combine them. Tests:
/// tests/tools/relief_view_test.cpp.
#pragma once

#include <filesystem>
#include <vector>

#include "view_options.h"

namespace relief::tools {

void add_view_options(CLI::App& app, ViewOptions& options);

/// Completes the options after parsing, and rejects contradictions. \throws UsageError
void settle(ViewOptions& options);

/// Checks that no file is written twice, and that none replaces a file that is read.
/// \param others  files that the scene reads, besides those of the command line
/// \throws UsageError
void check_written_files(const ViewOptions& options, std::vector<std::filesystem::path> others);

}  // namespace relief::tools
