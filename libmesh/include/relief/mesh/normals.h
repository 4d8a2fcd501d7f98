// SPDX-License-Identifier: Apache-2.0
/// \file
/// Normals of vertices and of triangles, from positions alone.
/// Tests: tests/mesh/geometry/normals_test.cpp.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "relief/mesh/report.h"

namespace relief {

/// What one triangle's vote counts for at each of its corners.
enum class NormalWeight {
    area,   ///< Triangle area: cheap, but depends on how a polygon was split.
    angle,  ///< Corner angle: the same for every split of a flat polygon.
};

/// Unit normal of every vertex, averaged over the triangles around it.
///
/// \param positions  object space, any unit of length
/// \param triangles  vertex indices, counter-clockwise seen from outside
/// \param report     counts every fallback below
/// \return one unit vector per position. Vertices with equal positions (+0 equals -0) share theirs,
///         so that a texture seam does not show. Where no triangle has an opinion (isolated vertex,
///         only degenerate triangles, opinions that cancel, non-finite position) it is (0,0,1).
/// \throws InvalidInput if a triangle names a vertex that does not exist
///
/// Triangles narrower than 1e-12 of their longest edge are degenerate; opinions cancel where their
/// sum is less than 1e-9 of their sizes. Same input, same bits: each vertex sums its triangles in
/// an order fixed by their values, not by where they stand in the list, and the corner that a
/// triangle begins with does not matter. Any scale from 1e-30 to 1e30 gives the same normals.
///
/// Source: [Thürmer and Wüthrich 1998] (angle weights), [Gouraud 1971] (averaging).
std::vector<glm::vec3> vertex_normals(std::span<const glm::vec3> positions,
                                      std::span<const glm::uvec3> triangles, NormalWeight weight,
                                      Report& report);

/// Unit normal of every triangle, by the right-hand rule over its corners.
///
/// \return one unit vector per triangle; (0,0,1) for a triangle without area or with a non-finite
///         corner
/// \throws InvalidInput if a triangle names a vertex that does not exist
std::vector<glm::vec3> triangle_normals(std::span<const glm::vec3> positions,
                                        std::span<const glm::uvec3> triangles, Report& report);

}  // namespace relief
