// SPDX-License-Identifier: Apache-2.0
/// \file
/// The part of compare_reports() that judges times. Tests: tests/accuracy/compare_reports_test.cpp.
#pragma once

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

/// What these, all on one thread or all on all, have in common.
CommonChange common_change(const std::vector<TimedPair>& pairs);

/// Judges each against what they have in common; `pairs` of both kinds.
std::vector<TimeChange> judged_times(const std::vector<TimedPair>& pairs,
                                     const CommonChange& one_thread,
                                     const CommonChange& all_threads, bool same_machine);

}  // namespace relief
