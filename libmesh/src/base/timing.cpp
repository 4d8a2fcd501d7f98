// SPDX-License-Identifier: Apache-2.0
// Seconds; order statistics of repeated measurements, in whatever unit they come, and the order in
// which they are taken. Series of different lengths throw InvalidInput.
// Tests: tests/mesh/geometry/error_statistics_test.cpp.
#include "relief/mesh/timing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "relief/mesh/report.h"

namespace relief {

namespace {

/// \param sorted  not empty  \param share  0 to 1
double quantile(const std::vector<double>& sorted, double share) {
    const double place = share * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(std::floor(place));
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return std::lerp(sorted[below], sorted[above], place - static_cast<double>(below));
}

}  // namespace

TimeStatistics time_statistics(std::vector<double> values) {
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    return {quantile(values, 0.5), quantile(values, 0.1), quantile(values, 0.9), values.size()};
}

double seconds_of(const std::function<void()>& work) {
    const Stopwatch stopwatch;
    work();
    return stopwatch.seconds();
}

void interleave(std::size_t things, const Repeats& repeats,
                const std::function<void(std::size_t thing, bool counted)>& work) {
    for (std::size_t round = 0; round < repeats.warm_up + repeats.counted; ++round) {
        for (std::size_t thing = 0; thing < things; ++thing)
            work(thing, round >= repeats.warm_up);
    }
}

double median_difference(const std::vector<double>& longer, const std::vector<double>& shorter) {
    if (longer.size() != shorter.size()) {
        throw InvalidInput(fmt::format("{} measurements cannot be compared with {} round by round",
                                       longer.size(), shorter.size()));
    }
    std::vector<double> differences(longer.size());
    std::transform(longer.begin(), longer.end(), shorter.begin(), differences.begin(),
                   std::minus<>());
    return time_statistics(std::move(differences)).median;
}

}  // namespace relief
