// SPDX-License-Identifier: Apache-2.0
/// \file
/// Computes the curvature of meshes at their vertices.
/// Tests: tests/mesh/geometry/curvature_test.cpp.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/report.h"

namespace RELIEF_API relief {

/// Computes the mean curvature at every vertex: the mean of the two principal curvatures, positive
/// for convex surfaces. A sphere of radius r has 1/r, a cylinder 1/(2r).
///
/// \param positions  in any unit; vertices at equal positions count as one
/// \param triangles  vertex indices; counter-clockwise seen from outside
/// \param report  counts triangles without area, which are ignored; vertices on open, non-manifold
///         or inconsistently wound edges, which get the mean of their regular neighbors, or 0 if
///         there is none; and vertices whose triangles give no finite value, which get 0
/// \return in one over the unit of the positions; 0 for vertices without a triangle
/// \throws InvalidInput if a triangle names a vertex that does not exist
///
/// The value is half of the cotangent Laplacian of the positions, divided by the mixed area of the
/// vertex, along the angle-weighted normal [Meyer et al. 2003]. At a hard edge it is proportional
/// to the dihedral angle divided by the width of the adjacent triangles, so it grows with finer
/// triangulation. Computed in double precision; the same bits for any order of triangles and
/// vertices and number of threads. A million triangles take about 0.1 s on two threads.
std::vector<float> mean_curvatures(std::span<const glm::vec3> positions,
                                   std::span<const glm::uvec3> triangles,
                                   Report& report = IgnoredReport());

}  // namespace relief
