// SPDX-License-Identifier: Apache-2.0
/// \file
/// Computes tangent frames from texture coordinates: MikkTSpace and two other weightings.
/// Tests: tests/mesh/geometry/tangents_test.cpp.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "relief/mesh/report.h"

namespace relief {

/// Computes a tangent frame for every triangle corner, as MikkTSpace defines it.
///
/// \param positions  object space, any unit of length
/// \param normals  object space, one per position; any length
/// \param texcoords  one per position, upper left origin, v down (see mesh.h)
/// \param triangles  vertex indices, counter-clockwise seen from outside
/// \param report  counts every fallback below
/// \return three per triangle, in corner order: xyz is unit and perpendicular to the corner's
///         normal, w is exactly +1 or -1 and equal for all corners of a triangle; bitangent = w *
///         cross(normal, xyz). If the texture has no gradient (equal or collinear coordinates, a
///         triangle without area), the frame is that of adjacent triangles. If two corners of a
///         triangle coincide, or a value is not finite, it is that of another triangle at the
///         vertex. Without one, the tangent is the x axis (the y axis if the normal is near x),
///         projected into the plane of the normal, with w = -1, as in the reference implementation.
///         With a normal without direction (zero, not finite), the tangent depends on the texture
///         alone. If u runs along the normal, the corner gets the frame of other corners at its
///         vertex. If averaged tangents cancel, each corner keeps the tangent of its own triangle
/// \throws InvalidInput if array lengths differ or a triangle names a vertex that does not exist
///
/// The same input gives the same bits for any order of triangles, number of threads, compiler and
/// instruction set. Vertices with equal position, normal and texture coordinate count as one, and
/// identical triangles count once. The time is nearly linear for every shape; the memory is at most
/// half that of input and result.
///
/// The corners of one vertex may differ (mirrored texture, hard texture seams): use split.h to
/// convert corners to vertices. Do not use the result with the original index list.
///
/// On valid meshes the result equals that of the reference implementation at every corner where the
/// latter does not depend on the order of triangles. It differs where the guarantees above require
/// it: different w within a degenerate triangle, and tangents parallel to their normals. It also
/// differs where the reference implementation depends on the order of triangles, and a fixed rule
/// is used instead (tangent_signs.cpp): at edges of three or more triangles, and around the last
/// bucket that its sorting of edges omits.
///
/// Source: [Mikkelsen 2008]; deviations from the reference implementation are marked in the code.
std::vector<glm::vec4> mikktspace_tangents(std::span<const glm::vec3> positions,
                                           std::span<const glm::vec3> normals,
                                           std::span<const glm::vec2> texcoords,
                                           std::span<const glm::uvec3> triangles, Report& report);

/// Computes the same frames with weights by the area of a triangle instead of its angle at the
/// corner: thin bevels, whose corners have angles like any other, then do not affect large adjacent
/// faces.
///
/// This is not MikkTSpace: a map that was baked for one of the two shows seams with the other.
std::vector<glm::vec4> area_weighted_tangents(std::span<const glm::vec3> positions,
                                              std::span<const glm::vec3> normals,
                                              std::span<const glm::vec2> texcoords,
                                              std::span<const glm::uvec3> triangles,
                                              Report& report);

/// Computes the same, but averages all triangles of the same handedness at a vertex, adjacent or
/// not, weighted by the stretch of the texture along u: the sum of the gradients of position along
/// u, made perpendicular to the normal and normalized. The original method has one tangent for a
/// vertex with triangles of both handednesses; this one has one for each.
///
/// Source: [Lengyel 2001].
std::vector<glm::vec4> lengyel_tangents(std::span<const glm::vec3> positions,
                                        std::span<const glm::vec3> normals,
                                        std::span<const glm::vec2> texcoords,
                                        std::span<const glm::uvec3> triangles, Report& report);

}  // namespace relief
