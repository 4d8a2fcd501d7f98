// SPDX-License-Identifier: Apache-2.0
/// \file
/// Statistics of measurements: errors, such as angles between directions in degrees, and wall-clock
/// times.
/// Tests: tests/mesh/geometry/error_statistics_test.cpp.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/enum_names.h"

namespace RELIEF_API relief {

/// Returns the angle between two directions of any length, in degrees, 0 to 180. It is computed by
/// atan2 in double precision, which is accurate for small angles, unlike the arc cosine. NaN if one
/// direction is zero or not finite.
double degrees_between(const glm::dvec3& a, const glm::dvec3& b);

/// Statistics of errors, such as angles in degrees; all are zero if there is no error.
struct ErrorStats {
    /// Upper limits of the histogram bins, for angles in degrees; each bin holds the errors above
    /// the previous limit, and the last one also larger errors.
    static constexpr std::array bounds = {0.01, 0.1, 1.0, 5.0, 45.0, 90.0, 180.0};

    std::size_t count = 0;  ///< Number of defined errors.
    /// Number of undefined errors: NaN, such as the angle to a direction that is zero or not
    /// finite. The other statistics ignore them.
    std::size_t undefined = 0;
    double rms = 0.0;  ///< Root mean square.
    double mean = 0.0;
    double median = 0.0;  ///< The smallest error that half of all errors do not exceed.
    double p90 = 0.0;     ///< The same for 90% of all errors.
    double p99 = 0.0;     ///< The same for 99% of all errors.
    double max = 0.0;
    std::array<std::size_t, bounds.size()> histogram{};
    std::optional<double> psnr{};  ///< Only for images, in decibels: 20 log10(peak / rms).

    /// Returns the index of the histogram bin of an error.
    static std::size_t bin_of(double error);

    friend bool operator==(const ErrorStats&, const ErrorStats&) = default;
};

/// The statistic of an error that a limit applies to.
enum class ErrorKind { mean, rms, p99, max };

template <>
inline constexpr auto enum_names<ErrorKind> =
    std::to_array<EnumName<ErrorKind>>({{"mean", ErrorKind::mean},
                                        {"rms", ErrorKind::rms},
                                        {"p99", ErrorKind::p99},
                                        {"max", ErrorKind::max}});

/// The statistic of limits for angles, unless another one is requested: the error that 99 % of all
/// places do not exceed. A mean hides rare errors, and a maximum is often that of a single place.
inline constexpr ErrorKind default_error_kind = ErrorKind::p99;

/// Returns the member that holds a statistic.
constexpr double ErrorStats::*figure_of(ErrorKind kind) {
    switch (kind) {
        case ErrorKind::mean:
            return &ErrorStats::mean;
        case ErrorKind::p99:
            return &ErrorStats::p99;
        case ErrorKind::max:
            return &ErrorStats::max;
        case ErrorKind::rms:
            break;
    }
    return &ErrorStats::rms;
}

/// Returns the name of a statistic in sentences: "mean", "RMS", "99 %" or "maximum".
constexpr const char* statistic_name(ErrorKind kind) {
    switch (kind) {
        case ErrorKind::mean:
            return "mean";
        case ErrorKind::p99:
            return "99 %";
        case ErrorKind::max:
            return "maximum";
        case ErrorKind::rms:
            break;
    }
    return "RMS";
}

/// Computes the statistics of errors.
///
/// \param errors  in any order; the order affects only the last bits of rms and mean. NaNs are
///         counted as undefined and otherwise ignored
ErrorStats error_stats(std::vector<float> errors);

/// Computes the statistics of the angles between corresponding directions, in degrees.
///
/// \param reference  the exact directions, of any length
/// \param counts  1 for each direction to include, 0 for the others; or empty to include all
/// \return percentiles are too large by at most 1/64. NaN for rms, mean and max if an angle is
///         undefined, so that the error is not hidden in a mean
/// \throws InvalidInput if the spans differ in length
ErrorStats direction_error(std::span<const glm::vec3> directions,
                           std::span<const glm::dvec3> reference,
                           std::span<const unsigned char> counts = {});

// Wall-clock times are measured by interleaved repetitions with warm-up, so that all methods share
// the drift of the machine. They are summarized by median and percentiles.

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

/// Interpolates linearly in an ordered list.
///
/// \param sorted  in increasing order; not empty
/// \param fraction  0: the first value, 0.5: the median, 1: the last value
double quantile(std::span<const double> sorted, double fraction);

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
