// SPDX-License-Identifier: Apache-2.0
/// \file
/// Computes the normals and tangents of a mesh, and splits vertices where corners differ.
/// Tests: tests/mesh/geometry/frames_test.cpp.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace relief {

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

enum class TangentMode {
    keep,        ///< The mesh's tangents, or none; recomputed (mikktspace) if normals change.
    none,        ///< Tangents are removed.
    mikktspace,  ///< Computed, see tangents.h.
    area_weighted,
    lengyel,
};

/// Returns true if this mode computes tangents, which requires texture coordinates.
constexpr bool computes_tangents(TangentMode mode) {
    return mode != TangentMode::keep && mode != TangentMode::none;
}

struct FrameOptions {
    NormalMode normals = NormalMode::keep;
    NormalMode if_missing = NormalMode::angle;  ///< Any mode except keep. glTF requires flat.
    TangentMode tangents = TangentMode::keep;

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
    /// come first, in order. Use it to carry other vertex data along (split.h).
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
///         texture coordinates, if `if_missing` is keep, or if an option is outside of the range in
///         normals.h
FramedMesh with_frames(Mesh mesh, const FrameOptions& options, Report& report);

}  // namespace relief
