// SPDX-License-Identifier: Apache-2.0
/// \file
/// A report as JSON, and back. docs/accuracy-schema.md describes it.
/// Tests: tests/tools/accuracy_report_test.cpp.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "accuracy_report.h"

namespace relief::tools {

/// \param has_files  whether its pictures are written, and are to be named
nlohmann::ordered_json json_of(const AccuracyReport& report, bool has_files);

/// Reads a report; of its pictures only the titles, without a sample.
///
/// \throws FileError naming the place, as "/experiments/0/id: is missing", if the file is no report
///         of relief-accuracy, is of another version, or lacks what such a report has. What this
///         version does not know is left aside.
AccuracyReport read_report(const std::filesystem::path& file);

}  // namespace relief::tools
