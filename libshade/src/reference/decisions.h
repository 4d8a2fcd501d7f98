// SPDX-License-Identifier: Apache-2.0
/// \file
/// A record of everything discrete that went into a pixel: which texel, which side of a lamp. Two
/// rays with different records may differ by a jump, so that rounding may decide what is seen.
/// Tests: tests/shade/reference/edges_test.cpp.
#pragma once

#include <cstdint>

namespace relief::reference {

/// A running hash of decisions, in the order in which they were taken.
class Decisions {
  public:
    void add(std::int64_t decision) {
        constexpr std::uint64_t fnv_prime = 0x100000001B3ULL;
        hash_ = (hash_ ^ static_cast<std::uint64_t>(decision)) * fnv_prime;
        hash_ ^= hash_ >> 29;
    }

    friend bool operator==(const Decisions&, const Decisions&) = default;

  private:
    std::uint64_t hash_ = 0xCBF29CE484222325ULL;
};

}  // namespace relief::reference
