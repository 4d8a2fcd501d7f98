// SPDX-License-Identifier: Apache-2.0
/// \file
/// Finds the Pareto-optimal methods by error and time.
/// Tests: tests/mesh/accuracy/error_statistics_test.cpp.
#pragma once

#include <span>
#include <vector>

#include "relief/export.h"

namespace RELIEF_API relief {

/// The error and time of a method, in any unit; smaller is better. NaN means unknown.
struct MethodCost {
    double error = 0.0;
    double time = 0.0;
};

/// Finds the Pareto-optimal methods.
///
/// \return for each method, true if no other is better in one value and at least as good in the
///         other. Equal methods have equal results. A method with NaN is never Pareto-optimal and
///         does not affect the others
std::vector<bool> pareto_optimal(std::span<const MethodCost> prices);

}  // namespace relief
