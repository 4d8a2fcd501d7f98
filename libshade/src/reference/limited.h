// SPDX-License-Identifier: Apache-2.0
/// \file
/// Radiance without what no picture can hold. Tests: tests/shade/reference/picture_test.cpp.
#pragma once

#include <algorithm>
#include <glm/glm.hpp>

namespace relief::reference {

/// The largest radiance in a linear picture.
inline constexpr double largest_radiance = 3e38;

/// NaN and negative values become 0, those beyond the limit the limit.
inline glm::dvec3 limited(const glm::dvec3& radiance, double limit) {
    glm::dvec3 result(0.0);
    for (int i = 0; i < 3; ++i) {
        if (radiance[i] > 0.0) result[i] = std::min(radiance[i], limit);
    }
    return result;
}

}  // namespace relief::reference
