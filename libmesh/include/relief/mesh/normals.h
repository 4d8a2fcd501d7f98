// SPDX-License-Identifier: Apache-2.0
/// \file
/// Computes normals of vertices, corners and triangles from positions, and infers hard edges from
/// normals. fitted_normals.h has reference normals.
///
/// docs/normals.md has the error and time of each weighting.
/// Tests: tests/mesh/geometry/normals_test.cpp, corner_normals_test.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/buffers.h"
#include "relief/mesh/enum_names.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace RELIEF_API relief {

/// The weight of a triangle's normal at a corner with the edges e1 and e2 and the angle a.
enum class NormalWeight {
    uniform,  ///< 1. [Gouraud 1971]
    area,     ///< Its area. Robust for meshes that fold over themselves.
    angle,  ///< a. Independent of the triangulation of planar polygons. [Thürmer and Wüthrich 1998]
    sine,  ///< sin(a).
    max,   ///< sin(a) / (|e1| |e2|). Exact on spheres, most accurate on smooth meshes. [Max 1999]
    angle_edges,  ///< a |e1| |e2|.
    area_angle,   ///< a times its area.
};

template <>
inline constexpr auto enum_names<NormalWeight> =
    std::to_array<EnumName<NormalWeight>>({{"uniform", NormalWeight::uniform},
                                           {"area", NormalWeight::area},
                                           {"angle", NormalWeight::angle},
                                           {"sine", NormalWeight::sine},
                                           {"max", NormalWeight::max},
                                           {"angle-edges", NormalWeight::angle_edges},
                                           {"area-angle", NormalWeight::area_angle}});

struct NormalOptions {
    NormalWeight weight = NormalWeight::angle;
    /// The precision of the weighted normals. float64: the result is the normal that exact
    /// arithmetic on the float positions would give. float32: edges and weights are computed in
    /// float, except for triangles whose height is less than 1e-5 of their edges. Sums are rounded
    /// to the same bits in any order.
    Arithmetic arithmetic = Arithmetic::float64;
    /// Vertices within this distance, also transitively, share their normal, so that texture seams
    /// are invisible. 0: vertices at equal positions (+0 equals -0). If absent, no vertices share
    /// normals.
    std::optional<double> weld_tolerance = 0.0;
};

/// Computes the unit normal of every vertex: the weighted mean over its triangles.
///
/// \param positions  object space, any unit of length
/// \param triangles  vertex indices, counter-clockwise seen from outside
/// \param report  counts every fallback below
/// \return one unit vector per position. If the weighted sum is zero (isolated vertex, only
///         degenerate triangles, normals that cancel, non-finite position), the result is (0,0,1)
/// \throws InvalidInput if a triangle names a vertex that does not exist, or the tolerance is
///         negative or not finite
///
/// Triangles whose height is less than 1e-12 of their longest edge are degenerate. Normals cancel
/// if their weighted sum is less than 1e-9 of the sum of their magnitudes. The same input gives the
/// same bits: the result is rounded from the exact sum, independent of the order of triangles, the
/// number of threads, the compiler and the processor. Components are multiples of 2^-28 before they
/// are rounded to float. Scaling the mesh by factors from 1e-30 to 1e30 does not change the
/// normals.
std::vector<glm::vec3> vertex_normals(StridedSpan<const glm::vec3> positions,
                                      TriangleSpan triangles, const NormalOptions& options,
                                      Report& report = IgnoredReport());

/// Writes the normals into the caller's memory, for example into an interleaved vertex buffer.
///
/// \param normals  one per position; must not overlap the inputs
/// \param execution  threads, progress and cancellation; the normals do not depend on it
/// \throws InvalidInput also if there are not as many normals as positions; Cancelled, and then the
///         normals are undefined
void vertex_normals(StridedSpan<const glm::vec3> positions, TriangleSpan triangles,
                    const NormalOptions& options, StridedSpan<glm::vec3> normals,
                    Report& report = IgnoredReport(), const ExecutionOptions& execution = {});

/// The same with a weighting and default options.
std::vector<glm::vec3> vertex_normals(StridedSpan<const glm::vec3> positions,
                                      TriangleSpan triangles, NormalWeight weight,
                                      Report& report = IgnoredReport());

/// Normals with automatic weighting.
struct ChosenNormals {
    std::vector<glm::vec3> normals;
    /// Number of vertices that were weighted by area; all others were weighted by
    /// NormalWeight::max.
    std::size_t by_area = 0;
};

/// Computes the unit normal of every vertex by NormalWeight::max, or by area where the mesh folds
/// over itself.
///
/// NormalWeight::max is the most accurate weighting on smooth meshes, but it emphasizes small
/// triangles, which are often the inverted ones in folds. A vertex is weighted by area if, seen
/// along its normal by NormalWeight::max, one of its triangles is back-facing or edge-on.
/// \param options  its weight is ignored
/// \return as vertex_normals()
/// \throws as vertex_normals()
ChosenNormals chosen_normals(StridedSpan<const glm::vec3> positions, TriangleSpan triangles,
                             const NormalOptions& options, Report& report = IgnoredReport());

/// The edges across which a surface is not smooth. By default there are none. The groups are not
/// copied: they must be valid until the call with these edges returns.
///
/// An edge is smooth if the angle between the normals of its two triangles, in space, is within the
/// crease angle; angles do not add up around a vertex. At an edge of three or more triangles, any
/// two within the limit are joined, also through others at the edge. The normals of neighbors with
/// inconsistent winding are opposite, so their edge is hard.
struct HardEdges {
    /// In radians, 0 to pi: edges whose triangle normals differ by a larger angle are hard. A
    /// tolerance of 1e-5 makes edges exactly at the limit smooth, independent of rounding.
    std::optional<double> crease_angle;
    /// One group for each triangle, or empty. Edges between triangles of different groups are hard,
    /// and so are all edges of triangles of group 0 (OBJ's "s off").
    std::span<const std::uint32_t> smoothing_groups;
};

/// Normals of corners, and the number of vertices that automatic weighting weighted by area.
struct CornerNormals {
    std::vector<glm::vec3> normals;  ///< Three per triangle, unit.
    std::size_t by_area = 0;  ///< As in ChosenNormals; a vertex counts once for each of its fans.
};

/// Computes the unit normal of every corner: the weighted mean over the triangles around its
/// position that are connected by smooth edges (a smooth fan). Triangles that are connected only by
/// the position, as at a bow-tie vertex, are separate.
///
/// \param weight  if absent, automatic as in chosen_normals(); the weight in `options` is ignored
/// \return (0,0,1) for fans without a direction, which are counted by vertex
/// \throws InvalidInput as vertex_normals(); if the angle is not within 0 to pi; if there are
///         groups, but not one for each triangle
///
/// With exact welding, triangles at the same positions with opposite windings are the two sides of
/// a wall, which are counted and never averaged: at their edges, triangles in opposite directions
/// are joined, the flattest pair first, if the angle is within the limit.
///
/// Triangles without area join no others and contribute nothing. If the corners of one are at three
/// positions on a line, the triangles along its longest side and along its other sides share an
/// edge; if two corners are at one position, the triangles at both sides share one already. So
/// collapsed triangles change no other normal. Their own corners take the first one by value of the
/// other triangles at their vertex, else position. If all triangles occur twice, nothing changes.
/// Vertices whose corners differ must be split: see frames.h. The same input gives the same bits,
/// as for vertex_normals(), and so does any order of vertices and any first corner of triangles.
CornerNormals corner_normals(StridedSpan<const glm::vec3> positions, TriangleSpan triangles,
                             std::optional<NormalWeight> weight, const NormalOptions& options,
                             const HardEdges& hard_edges, Report& report = IgnoredReport());

/// Computes the unit normal of every triangle by the right-hand rule.
///
/// \return one unit vector per triangle; (0,0,1) for a triangle without area or with a non-finite
///         corner
/// \throws InvalidInput if a triangle names a vertex that does not exist
std::vector<glm::vec3> triangle_normals(StridedSpan<const glm::vec3> positions,
                                        TriangleSpan triangles, Report& report = IgnoredReport());

/// The hard edges that the normals of a mesh imply.
struct InferredCreases {
    std::size_t edges = 0;  ///< Number of edges between two triangles with area.
    /// Number of these edges with different normals of the two triangles at one of its ends.
    std::size_t hard = 0;
    /// The crease angle in radians, as HardEdges::crease_angle, with the fewest misclassified
    /// edges, halfway between the angles of the two closest edges; pi if no edge is hard.
    double crease_angle = std::numbers::pi;
    std::size_t misclassified = 0;  ///< Number of edges that this angle misclassifies.
};

/// Infers the hard edges of a mesh.
///
/// \param mesh  with normals; vertices at equal positions count as one, and normals that differ by
///         less than half a degree as equal
/// \throws InvalidInput if the mesh is not valid or has no normals
InferredCreases inferred_creases(const Mesh& mesh);

}  // namespace relief
