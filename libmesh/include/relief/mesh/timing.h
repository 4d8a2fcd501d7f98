// SPDX-License-Identifier: Apache-2.0
/// \file
/// Repeated measurements: run in turns so that a machine's drift hits all alike, the first ones
/// dropped, told by median and spread. The one home of clocks, repeats and medians.
/// Tests: tests/mesh/accuracy/timing_test.cpp.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace relief {

/// How often something is measured.
struct Repeats {
    std::size_t counted = 9;
    std::size_t warm_up = 2;  ///< Before those, and forgotten: caches fill, drivers compile.
};

/// Where measurements lie: half of them below the median, a tenth below p10 and above p90.
struct Spread {
    double median = 0;
    double p10 = 0;
    double p90 = 0;
    std::size_t count = 0;
};

/// \param values  finite, in any order and unit
/// \return between two measurements, linearly interpolated; of none, all zeros
Spread spread_of(std::vector<double> values);

/// The wall-clock time that something takes.
double seconds_of(const std::function<void()>& work);

/// Does several things in turn, A B C A B C ..., and then counts rounds.
///
/// \param work  does thing `thing` once; `counted` is false while warming up. Exceptions pass.
void interleave(std::size_t things, const Repeats& repeats,
                const std::function<void(std::size_t thing, bool counted)>& work);

/// The middle of what one thing takes longer than another, round by round: drift, which both share,
/// goes out. \throws InvalidInput if the two are not equally many
double median_difference(const std::vector<double>& longer, const std::vector<double>& shorter);

}  // namespace relief
