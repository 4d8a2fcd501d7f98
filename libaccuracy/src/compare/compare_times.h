// SPDX-License-Identifier: Apache-2.0
/// \file
/// The part of compare_reports() that judges times. Tests: tests/accuracy/compare_times_test.cpp,
/// compare_reports_test.cpp.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "relief/accuracy/compare_reports.h"

namespace relief {

/// The rounds of one method in both runs.
struct TimedPair {
    std::string experiment;
    std::string method;
    bool on_all_threads = false;
    std::vector<double> before;
    std::vector<double> after;
};

/// Computes the change that these methods share. All are timed on one thread, or all on all
/// threads. \param max_ratio  as for compare_reports()
CommonChange common_change(const std::vector<TimedPair>& pairs, bool same_machine,
                           const std::optional<double>& max_ratio);

/// Judges each of them against what they have in common.
std::vector<TimeChange> judged_times(const std::vector<TimedPair>& pairs,
                                     const CommonChange& common, bool same_machine,
                                     const std::optional<double>& max_ratio);

}  // namespace relief
