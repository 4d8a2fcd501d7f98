// SPDX-License-Identifier: Apache-2.0
/// \file
/// How much a mesh bends at its vertices. Tests: tests/mesh/geometry/curvature_test.cpp.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "relief/mesh/report.h"

namespace relief {

/// The mean curvature at every vertex: the mean of the two principal curvatures, positive where the
/// surface bulges outwards. A sphere of radius r has 1/r, a cylinder 1/(2r).
///
/// \param positions  in any unit; those that are equal are one vertex here, whatever else is split
/// \param triangles  vertex indices; counter-clockwise seen from outside
/// \param report     counts triangles without an area, which have no say; vertices on open,
///                   non-manifold or wrongly wound edges, which get the mean of those around them
///                   that are not, or 0 where there is none; and vertices whose triangles give no
///                   finite number, which get 0
/// \return one over the unit of the positions; 0 for vertices without a triangle
/// \throws InvalidInput if a triangle names a vertex that does not exist
///
/// Half of the cotangent Laplacian of the positions over the mixed area of a vertex, along the
/// normal averaged by angles [Meyer et al. 2003]. At a hard edge that is the angle it turns by over
/// the width of the triangles there: finer triangles make a crease sharper, as it is. In double;
/// the same bits for any order of triangles and number of threads. About 0.1 s for a million
/// triangles on two threads.
std::vector<float> mean_curvatures(std::span<const glm::vec3> positions,
                                   std::span<const glm::uvec3> triangles, Report& report);

}  // namespace relief
