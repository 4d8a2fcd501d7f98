// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which of several methods are worth their time: the efficient frontier of error against time.
/// The one home of that rule. Tests: tests/mesh/accuracy/frontier_test.cpp.
#pragma once

#include <span>
#include <vector>

namespace relief {

/// What a method errs and takes; less is better in both, in whatever units. NaN: not known.
struct Price {
    double error = 0.0;
    double time = 0.0;
};

/// \return for each, whether no other is better in one and at least as good in the other. Equal
/// ones
///         stand or fall together; one with a NaN is never efficient, and makes no other less so
std::vector<bool> efficient(std::span<const Price> prices);

}  // namespace relief
