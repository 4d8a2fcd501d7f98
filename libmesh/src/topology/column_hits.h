// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which lines parallel to an axis meet a triangle: tests in the plane across the axis, so that a
/// line through a common edge or corner of triangles meets exactly one of those on each side.
#pragma once

#include <glm/glm.hpp>
#include <utility>

namespace relief::detail {

/// Returns whether a point is left of a line. A point on the line counts as if it were shifted
/// upwards by an infinitesimal length, and to the left by a much smaller one; both directions of
/// the line give opposite results.
inline bool is_left_of(const glm::dvec2& p, glm::dvec2 from, glm::dvec2 to) {
    const bool is_reversed = to.x < from.x || (to.x == from.x && to.y < from.y);
    if (is_reversed) std::swap(from, to);
    const double side = (to.x - from.x) * (p.y - from.y) - (to.y - from.y) * (p.x - from.x);
    return (side >= 0.0) != is_reversed;
}

/// Returns whether a triangle of any winding covers a point.
inline bool covers(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b,
                   const glm::dvec2& c) {
    const bool is_left = is_left_of(p, a, b);
    return is_left == is_left_of(p, b, c) && is_left == is_left_of(p, c, a);
}

}  // namespace relief::detail
