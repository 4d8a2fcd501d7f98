// SPDX-License-Identifier: Apache-2.0
/// \file
/// Computes the normals and tangents of a mesh, and splits vertices where corners differ.
/// Tests: tests/mesh/geometry/mesh_test.cpp, tests/mesh/geometry/frames_test.cpp.
#pragma once

#include <cassert>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/enum_names.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "relief/mesh/tangents.h"

namespace RELIEF_API relief {

// Converts values at triangle corners to values at vertices, with the minimum number of additional
// vertices.

/// The source of every new vertex, and the triangles over the new vertices.
///
/// The first entries are the old vertices in their order, including isolated ones; the copies
/// follow. Any data by vertex can be carried along with `source_vertex`.
struct VertexSplit {
    std::vector<std::uint32_t> source_vertex;
    std::vector<glm::uvec3> triangles;
};

/// Splits vertices until all corners that share a vertex also share a value, with as few copies as
/// possible.
///
/// \param corner_values  three per triangle, in corner order. They are compared as numbers: -0
///         equals +0; NaNs are equal if their bits are
/// \return the smallest value of a vertex stays with it, the others go to copies in ascending
///         order, so that the vertices do not depend on the order of triangles
/// \throws InvalidInput if a triangle names a vertex that does not exist, or the lengths differ
VertexSplit split_where_corners_differ(std::size_t vertex_count,
                                       std::span<const glm::uvec3> triangles,
                                       std::span<const glm::vec4> corner_values);
VertexSplit split_where_corners_differ(std::size_t vertex_count,
                                       std::span<const glm::uvec3> triangles,
                                       std::span<const glm::vec3> corner_values);

/// Returns a vertex attribute after a split; an absent (empty) one stays absent.
template <typename T>
std::vector<T> carried(std::span<const T> values, const VertexSplit& split) {
    std::vector<T> result;
    if (values.empty()) return result;
    result.reserve(split.source_vertex.size());
    for (const std::uint32_t vertex : split.source_vertex) {
        assert(vertex < values.size());
        result.push_back(values[vertex]);
    }
    return result;
}

/// Returns a mesh after a split, with all vertex attributes, new triangles and the same ranges.
/// `split` may select any vertices.
Mesh carried(const Mesh& mesh, const VertexSplit& split);

/// The source of normals.
enum class NormalMode {
    keep,       ///< The mesh's normals; without normals, `if_missing` decides.
    flat,       ///< Face normals; vertices are split between triangles.
    automatic,  ///< Averaged, with a weighting that is selected for each vertex: chosen_normals().
    /// Averaged over the triangles around a vertex with a NormalWeight; the same for the names
    /// below.
    uniform,
    area,
    angle,
    sine,
    max,
    angle_edges,
    area_angle,
};

template <>
inline constexpr auto enum_names<NormalMode> =
    std::to_array<EnumName<NormalMode>>({{"keep", NormalMode::keep},
                                         {"flat", NormalMode::flat},
                                         {"auto", NormalMode::automatic},
                                         {"uniform", NormalMode::uniform},
                                         {"area", NormalMode::area},
                                         {"angle", NormalMode::angle},
                                         {"sine", NormalMode::sine},
                                         {"max", NormalMode::max},
                                         {"angle-edges", NormalMode::angle_edges},
                                         {"area-angle", NormalMode::area_angle}});

struct FrameOptions {
    NormalMode normals = NormalMode::keep;
    NormalMode if_missing = NormalMode::angle;  ///< Any mode except keep. glTF requires flat.
    TangentMethod tangents = TangentMethod::keep;

    // Options of averaged normals:
    /// Vertices within this distance share their normal (normals.h).
    double weld_tolerance = 0.0;
    /// In radians, 0 to pi: edges with a larger angle are hard, and vertices are split along them.
    /// If absent, no edge is hard because of its angle.
    std::optional<double> crease_angle = std::nullopt;
    /// Edges between the mesh's smoothing groups are hard too, unless all groups are 0, which many
    /// programs write for "undefined".
    bool smoothing_groups = true;

    // Options of kept normals:
    /// Replaces normals that are zero or not finite by averaged ones (`if_missing`, or angle if
    /// that is flat), and normalizes others. Each change is counted.
    bool repair = false;
};

/// A mesh with frames, and the source of each of its vertices.
struct FramedMesh {
    Mesh mesh;
    /// For every vertex of `mesh`, the vertex of the input that it copies. The input's vertices
    /// come first, in order. Use it to carry other vertex data along.
    std::vector<std::uint32_t> source_vertex;
    /// Number of vertices that NormalMode::automatic weighted by area (see ChosenNormals).
    std::size_t normals_by_area = 0;
    /// True if averaged normals respected the mesh's smoothing groups.
    bool within_smoothing_groups = false;
};

/// Computes normals, then tangents, and splits vertices whose corners differ.
///
/// \return a mesh with all attributes; normals and tangents are as documented in normals.h and
///         tangents.h. Kept normals do not change by a bit. Normals that are not finite, or whose
///         length differs from 1 by more than the error of 8-bit storage (0.007), are counted in
///         the report and changed only if `repair` is set. Vertices without a triangle keep their
///         position and get the fallback frames. If normals change and there are no texture
///         coordinates, tangents are removed and counted
/// \throws InvalidInput if the mesh is not valid (mesh.h), if tangents must be computed without
///         texture coordinates or by TangentMethod::triangle, if `if_missing` is keep, or if an
///         option is outside of the range in normals.h
FramedMesh with_frames(Mesh mesh, const FrameOptions& options, Report& report);

}  // namespace relief
