// SPDX-License-Identifier: Apache-2.0
/// \file
/// What memory can do, to hold loops against that move a known number of bytes.
#pragma once

#include <cstddef>
#include <vector>

namespace relief::bench {

/// a = b + s * c over three arrays that no cache holds.
class Triad {
  public:
    void run() {
        for (std::size_t i = 0; i < size; ++i)
            a_[i] = b_[i] + 3.0F * c_[i];
        keep_ = a_[size / 2];
    }
    static constexpr std::size_t size = 16'000'000;
    static constexpr double bytes = 3.0 * sizeof(float) * size;

  private:
    std::vector<float> a_ = std::vector<float>(size, 0.0F);
    std::vector<float> b_ = std::vector<float>(size, 1.0F);
    std::vector<float> c_ = std::vector<float>(size, 2.0F);
    volatile float keep_ = 0.0F;
};

}  // namespace relief::bench
