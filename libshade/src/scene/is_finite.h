// SPDX-License-Identifier: Apache-2.0
/// \file
/// Tells whether all numbers of a vector or matrix are neither NaN nor infinite.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace relief {

inline bool is_finite(const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

inline bool is_finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

inline bool is_finite(const glm::mat4& matrix) {
    for (int column = 0; column < 4; ++column) {
        if (!is_finite(glm::vec3(matrix[column])) || !std::isfinite(matrix[column].w)) return false;
    }
    return true;
}

}  // namespace relief
