// SPDX-License-Identifier: Apache-2.0
/// \file
/// Disjoint sets of numbers that can be joined, in nearly constant time per operation.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace relief {

/// The representative of each set is its smallest element.
class DisjointSets {
  public:
    explicit DisjointSets(std::size_t count = 0) { reset(count); }

    /// Starts with `count` sets of one element.
    void reset(std::size_t count) {
        parents_.resize(count);
        std::iota(parents_.begin(), parents_.end(), 0U);
    }

    std::uint32_t find(std::uint32_t element) {
        while (parents_[element] != element) {
            parents_[element] = parents_[parents_[element]];
            element = parents_[element];
        }
        return element;
    }

    void join(std::uint32_t a, std::uint32_t b) {
        a = find(a);
        b = find(b);
        parents_[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<std::uint32_t> parents_;
};

}  // namespace relief
