// SPDX-License-Identifier: Apache-2.0
/// \file
/// Numbers of foreign materials as a scene allows them: the nearest allowed; NaN counts as 0.
/// Tests: tests/shade/scene/phong_test.cpp.
#pragma once

#include <algorithm>
#include <glm/glm.hpp>

namespace relief {

/// Within [0, limit]. NaN compares false.
inline float usable(float value, float limit) {
    return value > 0.0F ? std::min(value, limit) : 0.0F;
}

inline glm::vec3 usable(const glm::vec3& color, float limit) {
    return {usable(color.r, limit), usable(color.g, limit), usable(color.b, limit)};
}

}  // namespace relief
