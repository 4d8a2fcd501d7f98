// SPDX-License-Identifier: Apache-2.0
/// \file
/// Things that are timed in turns, so that a machine's drift hits all alike.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "relief/mesh/timing.h"

namespace relief::bench {

struct Contender {
    std::string name;
    std::function<void()> run;
    std::vector<double> nanoseconds{};
    double bytes = 0.0;  ///< Moved at least for each element, where that is told.
};

/// Runs all in turn, so many rounds after `warm_up`, and keeps what each took.
inline void measure(std::vector<Contender>& all, std::size_t rounds, std::size_t warm_up = 2) {
    interleave(all.size(), {rounds, warm_up}, [&](std::size_t i, bool counted) {
        const double taken = seconds_of(all[i].run);
        if (counted) all[i].nanoseconds.push_back(1e9 * taken);
    });
}

}  // namespace relief::bench
