// SPDX-License-Identifier: Apache-2.0
/// \file
/// What two reports differ in, in words and as JSON, and what of it is beyond bounds.
/// Tests: tests/tools/accuracy_compare_test.cpp.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "accuracy_report.h"
#include "relief/accuracy/compare_reports.h"

namespace relief::tools {

/// Two reports and what was found.
struct ComparedReports {
    AccuracyReport before;
    AccuracyReport after;
    bool same_machine = true;
    ReportComparison found;
};

/// What of the machines, and of how many threads they were asked for, differs, in words; empty if
/// nothing.
std::string difference_of(const AccuracyReport& before, const AccuracyReport& after);

/// Whether times count as measured: see may_compare_times() of machines.
bool may_compare_times(const AccuracyReport& before, const AccuracyReport& after);

/// What is still allowed, in percent; absent: anything.
struct ComparisonBounds {
    std::optional<double> max_slower;
    std::optional<double> max_error_growth;
    std::optional<double> max_memory_growth;
};

/// Prints on stdout, longest changes first.
void print_text(const ComparedReports& compared);

nlohmann::ordered_json json_of(const ComparedReports& compared, const ComparisonBounds& bounds);

/// What is beyond, one line each, that name method, value and bound; the worst first.
std::vector<std::string> beyond(const ComparedReports& compared, const ComparisonBounds& bounds);

}  // namespace relief::tools
