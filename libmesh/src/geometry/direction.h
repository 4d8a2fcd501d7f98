// SPDX-License-Identifier: Apache-2.0
/// \file
/// Directions in double precision, safe for every length that a float can have.
///
/// Differences of floats, their products and the products of those stay within the range of double
/// (1e-45 to 1e38 to the fourth power), so that nothing here has to rescale.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <vector>

#include "portable_math.h"

namespace relief::detail {

/// Normalizes `vector`. Returns zero if it has no direction (zero or not finite).
inline glm::dvec3 direction_or_zero(const glm::dvec3& vector) {
    const double length = glm::length(vector);
    return length > 0.0 && std::isfinite(length) ? vector / length : glm::dvec3(0.0);
}

/// Projects `vector` onto the plane with this unit normal. Returns `vector` if the normal is zero.
inline glm::dvec3 in_plane(const glm::dvec3& vector, const glm::dvec3& normal) {
    return vector - normal * glm::dot(normal, vector);
}

/// Returns the angle between two vectors of any length, 0 to pi. Uses atan2, which is accurate
/// where acos is not.
inline double angle_between(const glm::dvec3& a, const glm::dvec3& b) {
    return portable::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// Rounds to float. -0 becomes +0, so that equal directions have equal bits.
inline glm::vec3 rounded(const glm::dvec3& vector) {
    return glm::vec3(vector) + 0.0F;
}

/// Returns a unit vector perpendicular to a normal of any length by a fixed rule: the x axis, or
/// the y axis if the normal is near the x axis, projected onto the plane of the normal.
inline glm::vec3 perpendicular_to(const glm::vec3& normal) {
    constexpr double near_axis = 0.9;
    const glm::dvec3 unit = direction_or_zero(glm::dvec3(normal));
    const glm::dvec3 axis =
        std::abs(unit.x) < near_axis ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
    return rounded(direction_or_zero(in_plane(axis, unit)));
}

/// Order in which terms are added: by value.
inline bool comes_before(const glm::dvec3& a, const glm::dvec3& b) {
    if (a.x != b.x) return a.x < b.x;
    if (a.y != b.y) return a.y < b.y;
    return a.z < b.z;
}

/// The largest deviation from unit length by 8-bit storage, the coarsest in use: half a step of
/// 1/127 in each of three components.
inline constexpr double unit_tolerance = 0.007;

/// The largest cosine between a normal and its tangent that counts as rounding. 8-bit storage
/// causes up to 0.014; larger values are intentional.
inline constexpr double leaning_tolerance = 0.02;

}  // namespace relief::detail
