// SPDX-License-Identifier: Apache-2.0
/// \file
/// Numbers drawn at random for ground truths, the same on every machine.
/// Tests: tests/mesh/accuracy/analytic_surfaces_test.cpp.
#pragma once

#include <cstdint>

namespace relief {

/// [Steele et al. 2014]: each call gives the next number.
class Random {
  public:
    explicit Random(std::uint32_t seed) : state_(seed) {}

    double between(double low, double high) {
        state_ += 0x9e3779b97f4a7c15ULL;
        std::uint64_t bits = state_;
        bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9ULL;
        bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebULL;
        bits ^= bits >> 31;
        return low + (high - low) * (static_cast<double>(bits >> 11) * 0x1p-53);
    }

    /// Of mean 0 and deviation 1, nearly Gaussian, within +-6: a sum of 12, without logarithms,
    /// which are not the same to the last bit everywhere.
    double normal() {
        double sum = -6.0;
        for (int i = 0; i < 12; ++i)
            sum += between(0.0, 1.0);
        return sum;
    }

  private:
    std::uint64_t state_;
};

}  // namespace relief
