// SPDX-License-Identifier: Apache-2.0
/// \file
/// Normals of vertices, of corners and of triangles, from positions alone.
///
/// What each weighting costs and how far from the truth it is: docs/normals.md.
/// Tests: tests/mesh/geometry/normals/normals_test.cpp, corner_normals_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "relief/mesh/arithmetic.h"
#include "relief/mesh/report.h"

namespace relief {

/// What one triangle's vote counts for at a corner with edges e1 and e2 and angle a.
enum class NormalWeight {
    uniform,  ///< One vote each. [Gouraud 1971]
    area,     ///< Its area. Holds on meshes that fold over themselves.
    angle,    ///< a. Does not depend on how a flat polygon is split. [Thürmer and Wüthrich 1998]
    sine,     ///< sin(a).
    max,      ///< sin(a) / (|e1| |e2|). Exact on spheres, best on smooth meshes. [Max 1999]
    angle_edges,  ///< a |e1| |e2|.
    area_angle,   ///< a times its area.
};

struct NormalOptions {
    NormalWeight weight = NormalWeight::angle;
    /// What votes are computed in. float64: the result is the normal that exact arithmetic on the
    /// float positions would give. float32: edges and weights in float; triangles narrower than
    /// 1e-5 of their edges in double all the same. Sums are rounded to the same bits in any order.
    Arithmetic arithmetic = Arithmetic::float64;
    /// Vertices no further apart than this, also by way of others, share their normal, so that
    /// texture seams do not show. 0: those at equal positions (+0 equals -0). Absent: none do.
    std::optional<double> weld_tolerance = 0.0;
};

/// Unit normal of every vertex, averaged over the triangles around it.
///
/// \param positions  object space, any unit of length
/// \param triangles  vertex indices, counter-clockwise seen from outside
/// \param report     counts every fallback below
/// \return one unit vector per position. Where no triangle has an opinion (isolated vertex, only
///         degenerate triangles, opinions that cancel, non-finite position) it is (0,0,1).
/// \throws InvalidInput if a triangle names a vertex that does not exist, or the tolerance is
///         negative or not finite
///
/// Triangles narrower than 1e-12 of their longest edge are degenerate; opinions cancel where their
/// sum is less than 1e-9 of their sizes. Same input, same bits: the result is rounded from the sum
/// as exact arithmetic would have it, so that neither the order of triangles, nor threads, nor the
/// compiler, nor the processor can show; components are multiples of 2^-28, then rounded to float.
/// Any scale from 1e-30 to 1e30 gives the same normals.
std::vector<glm::vec3> vertex_normals(std::span<const glm::vec3> positions,
                                      std::span<const glm::uvec3> triangles,
                                      const NormalOptions& options, Report& report);

/// The same with a weighting and else the usual.
std::vector<glm::vec3> vertex_normals(std::span<const glm::vec3> positions,
                                      std::span<const glm::uvec3> triangles, NormalWeight weight,
                                      Report& report);

/// Normals by the weighting that suits each vertex.
struct ChosenNormals {
    std::vector<glm::vec3> normals;
    std::size_t by_area = 0;  ///< Vertices weighted by area; all others by max.
};

/// Unit normal of every vertex, by Max's weights where the mesh is a surface, by area where it
/// folds over itself.
///
/// Max's weights are the most accurate on smooth meshes, but count small triangles most, and where
/// triangles are folded over it is often the small ones. A vertex whose normal by Max's weights has
/// some triangle around it seen from behind or edge-on is weighted by area.
/// \param options  the weight in it is not used
/// \return and \throws as vertex_normals()
ChosenNormals chosen_normals(std::span<const glm::vec3> positions,
                             std::span<const glm::uvec3> triangles, const NormalOptions& options,
                             Report& report);

/// Which edges a surface is not smooth across. Without either of the two, none.
struct HardEdges {
    /// Radians, 0 to pi: edges whose triangles' normals differ by more are hard. One at the limit
    /// is smooth: 1e-5 more is allowed, so that rounding does not decide.
    std::optional<double> crease_angle;
    /// One for each triangle, or empty. Edges between triangles of different groups are hard, and
    /// so are all edges of triangles of group 0 (OBJ's "s off").
    std::span<const std::uint32_t> smoothing_groups;
};

/// Normals of corners, and how many vertices were weighted by area where the choice was automatic.
struct CornerNormals {
    std::vector<glm::vec3> normals;  ///< Three to a triangle, unit.
    std::size_t by_area = 0;  ///< See ChosenNormals; a vertex counts once for each of its fans.
};

/// Unit normal of every corner, averaged over the triangles that smooth edges join around the
/// position (a smooth fan); those that only touch there are apart, as at a bow-tie.
///
/// \param weight  absent: chosen as in chosen_normals(); the one in `options` is not used
/// \return (0,0,1) where a fan has no direction; counted by its vertices
/// \throws InvalidInput as vertex_normals(); if the angle is not within 0 to pi; if there are
///         groups, but not one for each triangle
///
/// Vertices whose corners differ must be split: split.h. Same input, same bits, as
/// vertex_normals().
CornerNormals corner_normals(std::span<const glm::vec3> positions,
                             std::span<const glm::uvec3> triangles,
                             std::optional<NormalWeight> weight, const NormalOptions& options,
                             const HardEdges& hard_edges, Report& report);

/// Unit normal of every triangle, by the right-hand rule over its corners.
///
/// \return one unit vector per triangle; (0,0,1) for a triangle without area or with a non-finite
///         corner
/// \throws InvalidInput if a triangle names a vertex that does not exist
std::vector<glm::vec3> triangle_normals(std::span<const glm::vec3> positions,
                                        std::span<const glm::uvec3> triangles, Report& report);

}  // namespace relief
