// SPDX-License-Identifier: Apache-2.0
/// \file
/// Milliseconds by the wall clock: OpenGL's timer queries are wrong on llvmpipe.
#pragma once

#include <chrono>

namespace relief {

class Stopwatch {
  public:
    /// Since the last lap, or since it was made.
    double lap() {
        const auto now = std::chrono::steady_clock::now();
        const double elapsed = std::chrono::duration<double, std::milli>(now - last_).count();
        last_ = now;
        return elapsed;
    }

  private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace relief
