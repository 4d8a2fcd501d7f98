// SPDX-License-Identifier: Apache-2.0
/// \file
/// A report as files in a folder: report.html, accuracy.json, accuracy.csv, accuracy-curves.csv and
/// pictures/. Each is written beside and renamed, the JSON last. Tests:
/// tests/tools/accuracy_run_test.cpp.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "accuracy_report.h"

namespace relief::tools {

/// \return the files that a reader opens first
std::vector<std::filesystem::path> write_report(const std::filesystem::path& folder,
                                                const AccuracyReport& report);

/// One of them. \throws FileError
void write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace relief::tools
