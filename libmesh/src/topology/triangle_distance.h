// SPDX-License-Identifier: Apache-2.0
/// \file
/// The point of a triangle that is nearest to another one, and its distance.
#pragma once

#include <algorithm>
#include <array>
#include <glm/glm.hpp>
#include <limits>

namespace relief::detail {

/// The corners of a triangle.
using Corners = std::array<glm::dvec3, 3>;

struct NearestPoint {
    glm::dvec3 point;
    double squared_distance;
};

/// Returns the point of a triangle that is nearest to p, by the region of the triangle's plane in
/// which p lies. A triangle without area counts as its edges.
inline NearestPoint nearest_point(const glm::dvec3& p, const Corners& corners) {
    const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    const double squared_normal = glm::dot(normal, normal);
    bool is_above = squared_normal > 0.0;
    NearestPoint nearest{corners[0], std::numeric_limits<double>::infinity()};
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3 edge = corners[(i + 1) % 3] - corners[i];
        const glm::dvec3 offset = p - corners[i];
        if (glm::dot(glm::cross(normal, edge), offset) < 0.0) is_above = false;
        const double length = glm::dot(edge, edge);
        const double along =
            length > 0.0 ? std::clamp(glm::dot(edge, offset) / length, 0.0, 1.0) : 0.0;
        const glm::dvec3 away = offset - along * edge;
        const double distance = glm::dot(away, away);
        if (distance < nearest.squared_distance) nearest = {corners[i] + along * edge, distance};
    }
    if (!is_above) return nearest;
    const double height = glm::dot(normal, p - corners[0]);
    return {p - normal * (height / squared_normal),
            std::min(nearest.squared_distance, height * height / squared_normal)};
}

/// Returns the squared distance of a point from a triangle.
inline double squared_distance(const glm::dvec3& p, const Corners& corners) {
    return nearest_point(p, corners).squared_distance;
}

}  // namespace relief::detail
