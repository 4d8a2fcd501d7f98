// SPDX-License-Identifier: Apache-2.0
/// \file
/// Whether two samples of times differ beyond chance, and by how much. Nothing is assumed of how
/// times are distributed: they have long tails. Tests: tests/accuracy/two_samples_test.cpp.
#pragma once

#include <cstddef>
#include <vector>

namespace relief {

/// The probability that two samples of one distribution are ordered at least as unevenly as these:
/// the two-sided rank sum test [Mann and Whitney 1947].
///
/// \param a, b  finite; equal values share their ranks
/// \return 0 to 1; 1 where one is empty. Exact, by counting, for up to 60 values in all; for more
/// by
///         the normal approximation, with corrections for ties and for continuity
double mann_whitney_p(const std::vector<double>& a, const std::vector<double>& b);

/// The least p that samples of these sizes can have: where all of one lie above all of the other.
double least_mann_whitney_p(std::size_t a, std::size_t b);

/// A number and the range that it lies in with 95 % confidence.
struct Interval {
    double value = 1.0;
    double low = 1.0;
    double high = 1.0;
};

/// How many times the median of `b` is that of `a`, with the percentile interval of 1000 resamples
/// [Efron 1979], which are the same on every machine.
///
/// \param a, b  positive; not empty
Interval median_ratio(const std::vector<double>& a, const std::vector<double>& b);

/// Which of many tests found something, where at most a share `rate` of what is found may be
/// chance: the step-up rule of [Benjamini and Hochberg 1995]. Where there is nothing to find at
/// all, anything is found with probability `rate` at the most.
std::vector<bool> discoveries(const std::vector<double>& p, double rate);

}  // namespace relief
