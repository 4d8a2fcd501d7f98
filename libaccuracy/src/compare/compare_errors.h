// SPDX-License-Identifier: Apache-2.0
/// \file
/// The part of compare_reports() that looks at errors. Tests:
/// tests/accuracy/compare_reports_test.cpp.
#pragma once

#include <string>
#include <vector>

#include "relief/accuracy/compare_reports.h"

namespace relief {

/// What differs between the errors of two measurements of one method; its figures may be none.
ErrorChange change_of(const Experiment& experiment, const Measurement& before,
                      const Measurement& after);

/// The same for the curves that both experiments have, point by point; only those that differ.
std::vector<ErrorChange> curve_changes(const Experiment& before, const Experiment& after);

/// What curves of an experiment have no partner in another run of it: "EXPERIMENT, chart ID:
/// METHOD", and " at X" where it is a single point.
std::vector<std::string> curves_missing_from(const Experiment& other, const Experiment& experiment);

}  // namespace relief
