// SPDX-License-Identifier: Apache-2.0
/// \file
/// Directions are compared by the angle between them, never by components.
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

namespace relief::test {

/// Degrees between two directions of any length; by atan2, exact near 0 where acos is not.
inline double degrees_between(glm::dvec3 a, glm::dvec3 b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * 180.0 / std::numbers::pi;
}

}  // namespace relief::test
