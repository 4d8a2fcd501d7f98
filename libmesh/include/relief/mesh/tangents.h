// SPDX-License-Identifier: Apache-2.0
/// \file
/// Tangent frames from texture coordinates. Tests: tests/mesh/geometry/tangents/tangents_test.cpp.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "relief/mesh/report.h"

namespace relief {

/// A tangent frame for every triangle corner, as MikkTSpace defines it.
///
/// \param positions  object space, any unit of length
/// \param normals    object space, one per position; need not be unit
/// \param texcoords  one per position, upper left origin, v down (see mesh.h)
/// \param triangles  vertex indices, counter-clockwise seen from outside
/// \param report     counts every fallback below
/// \return three per triangle, in corner order: xyz unit and perpendicular to the corner's normal,
///         w exactly +1 or -1, one w for all corners of a triangle;
///         bitangent = w * cross(normal, xyz). Where the texture has no gradient (equal or
///         collinear coordinates, a triangle without area) the frame is that of the neighbours.
///         Where two corners of a triangle coincide or a value is not finite, it is one that other
///         triangles have at the vertex. Where there is none, it is the x axis (the y axis if the
///         normal is near x) turned into the plane of the normal, w = -1, which is what the
///         reference implementation has there. A normal without direction (zero, not finite) binds
///         nothing: the tangent follows the texture alone. Where u runs along the normal, the
///         corner takes what others have at its vertex. Where averaged tangents cancel, each
///         corner keeps its own triangle's.
/// \throws InvalidInput if array lengths differ or a triangle names a vertex that does not exist
///
/// Same input, same bits, for any order of triangles, number of threads, compiler and instruction
/// set. Vertices equal in position, normal and texture coordinate count as one, and identical
/// triangles count once. Near-linear time on every shape; at most half as much memory again as
/// input and result take.
///
/// Corners of one vertex may differ (mirrored texture, hard texture seams): use split.h to turn the
/// corners into vertices again. Feeding the result to the index list as it is would be wrong.
///
/// On sound meshes this agrees with the reference implementation at every corner at which that
/// agrees with itself whatever the order of triangles. It departs where the promises above forbid
/// to follow: mixed w within a degenerate triangle, tangents along their normals; and at edges of
/// three triangles and more, and around the last bucket that its sorting of edges leaves out, where
/// its answer depends on that order and a fixed rule stands here (corner_links.cpp).
///
/// Source: [Mikkelsen 2008]; deviations from the reference implementation are marked in the code.
std::vector<glm::vec4> mikktspace_tangents(std::span<const glm::vec3> positions,
                                           std::span<const glm::vec3> normals,
                                           std::span<const glm::vec2> texcoords,
                                           std::span<const glm::uvec3> triangles, Report& report);

/// The same frames, but that each triangle counts for its area instead of the angle of its corner:
/// thin bevels, whose corners have angles like any other's, then leave large faces undisturbed.
///
/// Not MikkTSpace: a map baked for one of the two shows seams with the other.
std::vector<glm::vec4> area_weighted_tangents(std::span<const glm::vec3> positions,
                                              std::span<const glm::vec3> normals,
                                              std::span<const glm::vec2> texcoords,
                                              std::span<const glm::uvec3> triangles,
                                              Report& report);

/// The same, but that at a vertex all triangles of one handedness are averaged, neighbours or not,
/// each as far as it stretches the texture along u: the sum of the gradients of position along u,
/// made perpendicular to the normal and unit. Where the plain method has one tangent for a vertex
/// of triangles of both handednesses, this has one for each.
///
/// Source: [Lengyel 2001].
std::vector<glm::vec4> lengyel_tangents(std::span<const glm::vec3> positions,
                                        std::span<const glm::vec3> normals,
                                        std::span<const glm::vec2> texcoords,
                                        std::span<const glm::uvec3> triangles, Report& report);

}  // namespace relief
