// SPDX-License-Identifier: Apache-2.0
/// \file
/// The total order of floats and of vectors of them, for results that do not depend on the
/// numbering of vertices.
#pragma once

#include <bit>
#include <cstdint>
#include <glm/glm.hpp>

namespace relief::detail {

/// Returns the rank in the total order of floats: -0 equals +0, NaNs are ordered by their bits.
inline std::uint32_t ordinal(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value + 0.0F);
    return (bits & 0x80000000U) != 0 ? ~bits : bits | 0x80000000U;
}

/// Compares vectors lexicographically: below 0 if `a` comes first, 0 if they are equal.
template <glm::length_t size>
int compare_values(const glm::vec<size, float>& a, const glm::vec<size, float>& b) {
    for (glm::length_t i = 0; i < size; ++i) {
        if (ordinal(a[i]) != ordinal(b[i])) return ordinal(a[i]) < ordinal(b[i]) ? -1 : 1;
    }
    return 0;
}

}  // namespace relief::detail
