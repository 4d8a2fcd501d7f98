// SPDX-License-Identifier: Apache-2.0
/// \file
/// Interleaved timing, so that slow changes of the machine affect all contenders alike; and a loop
/// that measures memory bandwidth.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "relief/mesh/statistics.h"

namespace relief::bench {

struct Contender {
    std::string name;
    std::function<void()> run;
    std::vector<double> nanoseconds{};
    double bytes = 0.0;  ///< Minimum memory traffic per element; 0: unknown.
};

/// Runs all contenders interleaved, and stores their times after `warm_up` rounds.
inline void measure(std::vector<Contender>& all, std::size_t rounds, std::size_t warm_up = 2) {
    interleave(all.size(), {rounds, warm_up}, [&](std::size_t i, bool counted) {
        const double taken = seconds_of(all[i].run);
        if (counted) all[i].nanoseconds.push_back(1e9 * taken);
    });
}

/// McCalpin's triad: a = b + s * c over three arrays larger than any cache. Loops with known memory
/// traffic are compared with it.
class Triad {
  public:
    void run() {
        for (std::size_t i = 0; i < size; ++i)
            a_[i] = b_[i] + 3.0F * c_[i];
        keep_ = a_[size / 2];
    }
    static constexpr std::size_t size = 16'000'000;
    static constexpr double bytes = 3.0 * sizeof(float) * size;

  private:
    std::vector<float> a_ = std::vector<float>(size, 0.0F);
    std::vector<float> b_ = std::vector<float>(size, 1.0F);
    std::vector<float> c_ = std::vector<float>(size, 2.0F);
    volatile float keep_ = 0.0F;
};

}  // namespace relief::bench
