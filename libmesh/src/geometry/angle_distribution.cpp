// SPDX-License-Identifier: Apache-2.0
// Degrees in, their distribution out. Percentiles are values that occur (nearest rank). Linear
// expected time. Tests: tests/mesh/geometry/error_statistics_test.cpp.
#include "relief/mesh/error_stats.h"

#include <algorithm>
#include <cmath>

#include "geometry/angle_sum.h"

namespace relief {
namespace {

/// Returns the smallest value that `percent` of 100 of the values do not exceed. It reorders the
/// values.
double percentile(std::vector<float>& values, std::size_t percent) {
    const std::size_t rank = (values.size() * percent + 99) / 100;
    const auto place =
        values.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(rank, 1) - 1);
    std::nth_element(values.begin(), place, values.end());
    return *place;
}

std::size_t bin_of(double degrees) {
    const auto& bounds = AngleDistribution::bounds;
    const auto bin = std::lower_bound(bounds.begin(), bounds.end() - 1, degrees);
    return static_cast<std::size_t>(bin - bounds.begin());
}

}  // namespace

AngleDistribution angle_distribution(std::vector<float> degrees) {
    AngleDistribution result;
    const std::size_t all = degrees.size();
    std::erase_if(degrees, [](float angle) { return std::isnan(angle); });
    result.count = degrees.size();
    result.undefined = all - degrees.size();
    if (degrees.empty()) return result;
    AngleMoments moments;
    for (const float angle : degrees) {
        const auto value = static_cast<double>(angle);
        moments.add(value);
        ++result.histogram[bin_of(value)];
    }
    result.rms = moments.rms();
    result.mean = moments.mean();
    result.max = moments.max();
    result.median = percentile(degrees, 50);
    result.p90 = percentile(degrees, 90);
    result.p99 = percentile(degrees, 99);
    return result;
}

}  // namespace relief
