// SPDX-License-Identifier: Apache-2.0
/// \file
/// The distance of a point from a triangle.
#pragma once

#include <algorithm>
#include <array>
#include <glm/glm.hpp>
#include <limits>

namespace relief::detail {

/// The corners of a triangle.
using Corners = std::array<glm::dvec3, 3>;

/// Returns the squared distance from a point to a triangle, by the region of the triangle's plane
/// in which the point lies. A triangle without area counts as its edges.
inline double squared_distance(const glm::dvec3& p, const Corners& corners) {
    const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    const double squared_normal = glm::dot(normal, normal);
    bool is_above = squared_normal > 0.0;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3 edge = corners[(i + 1) % 3] - corners[i];
        const glm::dvec3 offset = p - corners[i];
        if (glm::dot(glm::cross(normal, edge), offset) < 0.0) is_above = false;
        const double length = glm::dot(edge, edge);
        const double along =
            length > 0.0 ? std::clamp(glm::dot(edge, offset) / length, 0.0, 1.0) : 0.0;
        const glm::dvec3 away = offset - along * edge;
        nearest = std::min(nearest, glm::dot(away, away));
    }
    if (!is_above) return nearest;
    const double height = glm::dot(normal, p - corners[0]);
    return std::min(nearest, height * height / squared_normal);
}

}  // namespace relief::detail
