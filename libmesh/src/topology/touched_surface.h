// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which of some balls touch the surface of a mesh before its edges collapse.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "topology/edge_collapse.h"

namespace relief::detail {

struct Ball {
    glm::dvec3 center{0.0};  ///< In the unit of CollapseInput::point().
    double radius = 0.0;
};

/// Returns for each ball whether its distance from a triangle is at most its radius. The time is
/// proportional to the number of triangles, and to that of the balls near the box of each.
/// \param input  with the triangles of its topology
std::vector<bool> touch_surface(std::span<const Ball> balls, const CollapseInput& input);

}  // namespace relief::detail
