// SPDX-License-Identifier: Apache-2.0
/// \file
/// Angles added up as they come, in constant memory, in double, in degrees: the one place where
/// their mean, root of the mean square and greatest are formed, and AngleSummary for those who
/// cannot keep all of them. Of none, all zeros. Tests:
/// tests/mesh/geometry/error_statistics_test.cpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "relief/mesh/error_stats.h"

namespace relief {

/// What takes no more than sums.
class AngleMoments {
  public:
    /// \param degrees  NaN makes rms() and mean() NaN, and is no greatest: whoever may meet one
    ///                 says what becomes of it
    void add(double degrees) {
        ++count_;
        sum_ += degrees;
        squares_ += degrees * degrees;
        max_ = std::max(max_, degrees);
    }

    /// What another saw after this. The last bits depend on the order in which sums are added.
    void add(const AngleMoments& other) {
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

  private:
    std::size_t count_ = 0;
    double sum_ = 0.0, squares_ = 0.0, max_ = 0.0;
};

/// Those, and the 99th percentile, to within a bin.
class AngleSum {
  public:
    /// \param degrees  a number; 0 to 180
    void add(double degrees) {
        moments_.add(degrees);
        if (bins_.empty()) bins_.resize(bin_count, 0);
        ++bins_[bin_of(degrees)];
    }

    /// What another saw after this.
    void add(const AngleSum& other) {
        moments_.add(other.moments_);
        if (bins_.empty()) bins_.resize(bin_count, 0);
        for (std::size_t i = 0; i < other.bins_.size(); ++i)
            bins_[i] += other.bins_[i];
    }

    [[nodiscard]] AngleSummary summary() const {
        if (moments_.count() == 0) return {};
        return {moments_.count(), moments_.rms(), moments_.mean(), percentile_99(), moments_.max()};
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
    [[nodiscard]] double percentile_99() const {
        const std::size_t wanted = moments_.count() - moments_.count() / 100;
        std::size_t seen = 0;
        for (std::size_t i = 0; i < bins_.size(); ++i) {
            seen += bins_[i];
            if (seen >= wanted) return std::min(upper_end(i), moments_.max());
        }
        return moments_.max();
    }

    AngleMoments moments_;
    std::vector<std::size_t> bins_;
};

}  // namespace relief
