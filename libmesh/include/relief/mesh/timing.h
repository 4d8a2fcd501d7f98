// SPDX-License-Identifier: Apache-2.0
/// \file
/// Repeated measurements: run in turns so that a machine's drift hits all alike, the first ones
/// dropped, told by median and spread. The one home of measured time, repeats and medians: clocks
/// are asked elsewhere only for when to wait, to stop or to draw the next frame.
/// Tests: tests/mesh/accuracy/timing_test.cpp.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <utility>
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

/// Seconds by the wall clock.
class Stopwatch {
  public:
    /// Since it was made, or since the last lap.
    [[nodiscard]] double seconds() const {
        return std::chrono::duration<double>(Clock::now() - begin_).count();
    }
    /// The same, and begins another lap: nothing between two laps is lost.
    double lap() {
        const Clock::time_point now = Clock::now();
        const std::chrono::duration<double> taken = now - std::exchange(begin_, now);
        return taken.count();
    }

  private:
    using Clock = std::chrono::steady_clock;

    Clock::time_point begin_ = Clock::now();
};

/// The wall-clock time that something takes, in seconds.
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
