// SPDX-License-Identifier: Apache-2.0
/// \file
/// Pairing triangles whose corners are all but the same: what equal numbers leave over.
/// Tests: tests/mesh/geometry/compare/compare_test.cpp.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "relief/mesh/compare.h"

namespace relief {

/// A triangle of b for one of a, whose first corner is the `turn`th of b's.
struct NearPair {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    int turn = 0;
    bool is_ambiguous = false;  ///< b's triangle was within a tolerance of several.
};

/// Nearest first, each triangle once; those with a non-finite corner match nothing.
///
/// \param left_a, left_b  the triangles to pair
std::vector<NearPair> pair_near(const Mesh& a, const Mesh& b, std::span<const std::uint32_t> left_a,
                                std::span<const std::uint32_t> left_b, const MatchOptions& options);

}  // namespace relief
