// SPDX-License-Identifier: Apache-2.0
/// \file
/// Measures wall-clock time: interleaved repetitions with warm-up, so that all methods share the
/// drift of the machine, summarized by median and percentiles.
/// Tests: tests/mesh/geometry/error_statistics_test.cpp.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "relief/export.h"

namespace RELIEF_API relief {

/// The number of repetitions of a measurement.
struct Repeats {
    std::size_t counted = 9;
    /// Repetitions before the counted ones, which are ignored: caches fill, and drivers compile.
    std::size_t warm_up = 2;
};

/// The distribution of measurements: median, 10th and 90th percentile.
struct TimeStatistics {
    double median = 0;
    double p10 = 0;
    double p90 = 0;
    std::size_t count = 0;
};

/// Computes the distribution of values.
///
/// \param values  finite, in any order and unit
/// \return percentiles, interpolated linearly; all zeros without values
TimeStatistics time_statistics(std::vector<double> values);

/// Measures elapsed wall-clock time.
class Stopwatch {
  public:
    /// Returns the seconds since construction or the last lap().
    [[nodiscard]] double seconds() const {
        return std::chrono::duration<double>(Clock::now() - begin_).count();
    }
    /// Returns the same and starts a new lap, without a gap between laps.
    double lap() {
        const Clock::time_point now = Clock::now();
        const std::chrono::duration<double> taken = now - std::exchange(begin_, now);
        return taken.count();
    }

  private:
    using Clock = std::chrono::steady_clock;

    Clock::time_point begin_ = Clock::now();
};

/// Returns the wall-clock time of `work` in seconds.
double seconds_of(const std::function<void()>& work);

/// Runs several things interleaved (A B C A B C ...): first the warm-up rounds, then the counted
/// ones.
///
/// \param work  runs thing number `thing` once; `counted` is false during warm-up. Its exceptions
///         are passed on
void interleave(std::size_t things, const Repeats& repeats,
                const std::function<void(std::size_t thing, bool counted)>& work);

/// Returns the median over all rounds of the difference of two series. Drift, which both series
/// share, cancels. \throws InvalidInput if the series differ in length
double median_difference(const std::vector<double>& longer, const std::vector<double>& shorter);

}  // namespace relief
