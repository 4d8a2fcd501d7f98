// SPDX-License-Identifier: Apache-2.0
// Angles between directions by atan2 in double, statistics of errors and of repeated measurements,
// and interleaved rounds. Percentiles of errors are values that occur (nearest rank), in linear
// expected time; those of measurements are interpolated.
// Tests: tests/mesh/geometry/error_statistics_test.cpp.
#include "relief/mesh/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "geometry/error_accumulator.h"
#include "portable_math.h"
#include "relief/mesh/report.h"

namespace relief {
namespace {

/// Percentiles of values, in ascending order: each search begins at the last result, because no
/// value below it is larger. They reorder the values.
class Percentiles {
  public:
    explicit Percentiles(std::vector<float>& values) : values_(values), begin_(values.begin()) {}

    /// Returns the smallest value that `percent` of 100 of the values do not exceed.
    double next(std::size_t percent) {
        const std::size_t rank = (values_.size() * percent + 99) / 100;
        const auto place =
            values_.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(rank, 1) - 1);
        std::nth_element(begin_, place, values_.end());
        begin_ = place;
        return *place;
    }

  private:
    std::vector<float>& values_;
    std::vector<float>::iterator begin_;
};

}  // namespace

double degrees_between(const glm::dvec3& a, const glm::dvec3& b) {
    const double sine = glm::length(glm::cross(a, b));
    const double cosine = glm::dot(a, b);
    if (!std::isfinite(sine) || !std::isfinite(cosine) || (sine == 0.0 && cosine == 0.0))
        return std::numeric_limits<double>::quiet_NaN();
    return detail::portable::atan2(sine, cosine) * 180.0 / std::numbers::pi;
}

std::size_t ErrorStats::bin_of(double degrees) {
    const auto bin = std::lower_bound(bounds.begin(), bounds.end() - 1, degrees);
    return static_cast<std::size_t>(bin - bounds.begin());
}

ErrorStats error_stats(std::vector<float> errors) {
    const std::size_t all = errors.size();
    std::erase_if(errors, [](float error) { return std::isnan(error); });
    detail::ErrorMoments moments;
    ErrorStats stats;
    for (const float error : errors) {
        const auto value = static_cast<double>(error);
        moments.add(value);
        ++stats.histogram[ErrorStats::bin_of(value)];
    }
    stats.count = errors.size();
    stats.undefined = all - errors.size();
    if (errors.empty()) return stats;
    stats.rms = moments.rms();
    stats.mean = moments.mean();
    stats.max = moments.max();
    Percentiles percentiles(errors);
    stats.median = percentiles.next(50);
    stats.p90 = percentiles.next(90);
    stats.p99 = percentiles.next(99);
    return stats;
}

ErrorStats direction_error(std::span<const glm::vec3> directions,
                           std::span<const glm::dvec3> reference,
                           std::span<const unsigned char> counts) {
    if (directions.size() != reference.size() ||
        (!counts.empty() && counts.size() != directions.size())) {
        throw InvalidInput(fmt::format("{} directions cannot be compared with {}",
                                       directions.size(), reference.size()));
    }
    detail::ErrorAccumulator angles;
    for (std::size_t i = 0; i < directions.size(); ++i) {
        if (!counts.empty() && counts[i] == 0) continue;
        angles.add(degrees_between(glm::dvec3(directions[i]), reference[i]));
    }
    ErrorStats error = angles.stats();
    if (error.undefined > 0)
        error.rms = error.mean = error.max = std::numeric_limits<double>::quiet_NaN();
    return error;
}

double quantile(std::span<const double> sorted, double fraction) {
    const double index = fraction * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(std::floor(index));
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return std::lerp(sorted[below], sorted[above], index - static_cast<double>(below));
}

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
