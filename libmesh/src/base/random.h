// SPDX-License-Identifier: Apache-2.0
/// \file
/// A pseudorandom number generator with the same results on every machine.
/// Tests: tests/accuracy/ground_truth_test.cpp.
#pragma once

#include <cstdint>

namespace relief {

/// SplitMix64 [Steele et al. 2014].
class Random {
  public:
    explicit Random(std::uint32_t seed) : state_(seed) {}

    /// Returns a uniformly distributed number in [low, high).
    double between(double low, double high) {
        state_ += 0x9e3779b97f4a7c15ULL;
        std::uint64_t bits = state_;
        bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9ULL;
        bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebULL;
        bits ^= bits >> 31;
        return low + (high - low) * (static_cast<double>(bits >> 11) * 0x1p-53);
    }

    /// Returns a nearly Gaussian number with mean 0 and standard deviation 1, in [-6, 6]. It is a
    /// sum of 12 uniform numbers, because the last bits of logarithms depend on the machine.
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
