// SPDX-License-Identifier: Apache-2.0
/// \file
/// The convex hull of points, and the smallest box around it.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace relief::detail {

/// The corners of the convex hull, counter-clockwise.
std::vector<glm::dvec2> convex_hull(std::vector<glm::dvec2> points);

double area_of_hull(std::span<const glm::dvec2> hull);

/// The rectangle of least area that contains a hull: one of its sides is a side of the hull.
struct SmallestBox {
    glm::dvec2 axis{1.0, 0.0};  ///< The direction of a side, unit.
    double area = 0.0;
};

/// \return the axis (1, 0) and the area 0 if all points are equal
SmallestBox smallest_box(std::span<const glm::dvec2> hull);

}  // namespace relief::detail
