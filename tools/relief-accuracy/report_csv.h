// SPDX-License-Identifier: Apache-2.0
/// \file
/// A report as tables for spreadsheets: comma-separated, quoted where needed (RFC 4180), the dot as
/// decimal point, numbers in full, an empty cell for what has none.
/// Tests: tests/tools/accuracy_report_test.cpp.
#pragma once

#include <string>

#include "accuracy_report.h"

namespace relief::tools {

/// A row for each measurement: experiment, subject, method, choices ("a=b; c=d"), error_unit,
/// count, undefined, rms, mean, p99, max, psnr, item, items, one_thread_seconds with its _p10,
/// _p90 and _rounds, the same for all_threads, peak_bytes, stored_bytes, efficient (1 or 0).
std::string measurements_csv(const AccuracyReport& report);

/// A row for each point of a curve: experiment, chart, method, x_label, x, error_unit, error.
std::string curves_csv(const AccuracyReport& report);

}  // namespace relief::tools
