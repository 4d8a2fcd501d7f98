// SPDX-License-Identifier: Apache-2.0
/// \file
/// Angles added up as they come, in constant memory: what AngleSummary says of them. In degrees.
/// Tests: tests/mesh/bake/bake_check_test.cpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "relief/mesh/bake_check.h"

namespace relief {

class AngleSum {
  public:
    /// \param degrees  a number; 0 to 180
    void add(double degrees) {
        ++count_;
        sum_ += degrees;
        squares_ += degrees * degrees;
        max_ = std::max(max_, degrees);
        if (bins_.empty()) bins_.resize(bin_count, 0);
        ++bins_[bin_of(degrees)];
    }

    /// What another saw after this. The last bits depend on the order in which sums are added.
    void add(const AngleSum& other) {
        count_ += other.count_;
        sum_ += other.sum_;
        squares_ += other.squares_;
        max_ = std::max(max_, other.max_);
        if (bins_.empty()) bins_.resize(bin_count, 0);
        for (std::size_t i = 0; i < other.bins_.size(); ++i)
            bins_[i] += other.bins_[i];
    }

    [[nodiscard]] AngleSummary summary() const {
        if (count_ == 0) return {};
        const auto count = static_cast<double>(count_);
        return {count_, std::sqrt(squares_ / count), sum_ / count, percentile_99(), max_};
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
        const std::size_t wanted = count_ - count_ / 100;
        std::size_t seen = 0;
        for (std::size_t i = 0; i < bins_.size(); ++i) {
            seen += bins_[i];
            if (seen >= wanted) return std::min(upper_end(i), max_);
        }
        return max_;
    }

    std::size_t count_ = 0;
    double sum_ = 0.0, squares_ = 0.0, max_ = 0.0;
    std::vector<std::size_t> bins_;
};

}  // namespace relief
