// SPDX-License-Identifier: Apache-2.0
/// \file
/// Formats times for reports.
/// Tests: tests/tools/accuracy_report_test.cpp.
#pragma once

#include <string>

#include "relief/export.h"

namespace RELIEF_API relief {

/// Formats a time: "840 ns", "4.13 µs", "12.3 ms", "1.50 s".
std::string format_seconds(double seconds);

}  // namespace relief
