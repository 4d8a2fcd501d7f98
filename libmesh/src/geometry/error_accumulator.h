// SPDX-License-Identifier: Apache-2.0
/// \file
/// Accumulates errors in constant memory, in double. All statistics of errors are computed here.
/// Tests: tests/mesh/geometry/error_statistics_test.cpp.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "relief/mesh/statistics.h"

namespace relief::detail {

/// Accumulates the root mean square, the mean and the maximum.
class ErrorMoments {
  public:
    /// \param error  NaN makes rms() and mean() NaN and does not change max()
    void add(double error) {
        ++count_;
        sum_ += error;
        squares_ += error * error;
        max_ = std::max(max_, error);
    }

    /// Adds the errors of another accumulator. The last bits depend on the order of addition.
    void add(const ErrorMoments& other) {
        count_ += other.count_;
        sum_ += other.sum_;
        squares_ += other.squares_;
        max_ = std::max(max_, other.max_);
    }

    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] double rms() const {
        return count_ > 0 ? std::sqrt(squares_ / static_cast<double>(count_)) : 0.0;
    }
    [[nodiscard]] double mean() const {
        return count_ > 0 ? sum_ / static_cast<double>(count_) : 0.0;
    }
    [[nodiscard]] double max() const { return max_; }

    /// Returns the statistics without percentiles and histogram; all zeros without errors.
    [[nodiscard]] ErrorStats stats() const {
        ErrorStats stats;
        stats.count = count_;
        stats.rms = rms();
        stats.mean = mean();
        stats.max = max_;
        return stats;
    }

  private:
    std::size_t count_ = 0;
    double sum_ = 0.0, squares_ = 0.0, max_ = 0.0;
};

/// Accumulates angles in degrees for all statistics. Percentiles are exact to 1/64.
class ErrorAccumulator {
  public:
    /// \param degrees  0 to 180; NaN counts as undefined
    void add(double degrees) {
        if (std::isnan(degrees)) {
            ++undefined_;
            return;
        }
        moments_.add(degrees);
        if (bins_.empty()) bins_.resize(bin_count, 0);
        ++bins_[bin_of(degrees)];
        ++histogram_[ErrorStats::bin_of(degrees)];
    }

    /// Adds the angles of another accumulator.
    void add(const ErrorAccumulator& other) {
        moments_.add(other.moments_);
        undefined_ += other.undefined_;
        for (std::size_t i = 0; i < histogram_.size(); ++i)
            histogram_[i] += other.histogram_[i];
        if (other.bins_.empty()) return;
        if (bins_.empty()) bins_.resize(bin_count, 0);
        for (std::size_t i = 0; i < other.bins_.size(); ++i)
            bins_[i] += other.bins_[i];
    }

    /// Returns the statistics; all zeros without angles.
    [[nodiscard]] ErrorStats stats() const {
        ErrorStats stats = moments_.stats();
        stats.undefined = undefined_;
        if (stats.count == 0) return stats;
        stats.median = percentile(50);
        stats.p90 = percentile(90);
        stats.p99 = percentile(99);
        stats.histogram = histogram_;
        return stats;
    }

  private:
    static constexpr int steps = 64;    // To a factor of two: 1/64 to 1/128 apart.
    static constexpr int lowest = -24;  // 2^-24 degrees and below are alike.
    static constexpr int highest = 8;
    static constexpr std::size_t bin_count = (highest - lowest) * steps + 1;

    static std::size_t bin_of(double degrees) {
        int exponent = 0;
        const double mantissa = std::frexp(degrees, &exponent);  // 0.5 to 1
        if (degrees <= 0.0 || exponent <= lowest) return 0;
        const int step = std::min(static_cast<int>((mantissa - 0.5) * 2.0 * steps), steps - 1);
        const int bin = (std::min(exponent, highest) - 1 - lowest) * steps + step + 1;
        return static_cast<std::size_t>(bin);
    }
    static double upper_end(std::size_t bin) {
        if (bin == 0) return std::ldexp(1.0, lowest);
        const auto index = static_cast<int>(bin) - 1;
        const double mantissa = 0.5 + (index % steps + 1) / (2.0 * steps);
        return std::ldexp(mantissa, index / steps + lowest + 1);
    }
    /// Returns the smallest angle, to within a bin, that `percent` of 100 angles do not exceed.
    [[nodiscard]] double percentile(std::size_t percent) const {
        const std::size_t wanted = moments_.count() - moments_.count() * (100 - percent) / 100;
        std::size_t seen = 0;
        for (std::size_t i = 0; i < bins_.size(); ++i) {
            seen += bins_[i];
            if (seen >= wanted) return std::min(upper_end(i), moments_.max());
        }
        return moments_.max();
    }

    ErrorMoments moments_;
    std::size_t undefined_ = 0;
    std::array<std::size_t, ErrorStats::bounds.size()> histogram_{};
    std::vector<std::size_t> bins_;
};

}  // namespace relief::detail
