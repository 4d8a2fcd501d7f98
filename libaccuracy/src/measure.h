// SPDX-License-Identifier: Apache-2.0
/// \file
/// Clocks, thread limits and the peak memory of works. The driver (experiment_driver.h) uses them
/// for all experiments.
/// Tests: tests/accuracy/measure_test.cpp.
#pragma once

#include <sched.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

namespace relief {

/// Returns how often a work must be repeated so that a round is at least 4 milliseconds long.
/// Shorter rounds are mostly noise: this is a time slice of the scheduler.
std::size_t repeats_per_round(const std::function<void()>& work);

/// Measures the processor time of the process, which excludes the time of other programs; a wall
/// clock includes it. At least a nanosecond.
double processor_seconds_of(const std::function<void()>& work);

/// Returns the peak memory of `work` in bytes in addition to the memory before; nothing if the
/// system does not report it.
std::optional<std::uint64_t> peak_bytes_of(const std::function<void()>& work);

/// Keeps all threads of this process on one processor during its lifetime. A software OpenGL driver
/// starts its threads only once, so this is the only way to time it on one thread. The destructor
/// restores the affinity that the calling thread had.
class SingleProcessor {
  public:
    SingleProcessor();
    ~SingleProcessor();
    SingleProcessor(const SingleProcessor&) = delete;
    SingleProcessor& operator=(const SingleProcessor&) = delete;

    /// Returns whether the system allowed it; if not, nothing has changed.
    [[nodiscard]] bool is_active() const { return is_active_; }

  private:
    ::cpu_set_t before_;
    bool is_active_ = false;
};

}  // namespace relief
