// SPDX-License-Identifier: Apache-2.0
/// \file
/// The one call that gives a mesh its normals and tangents. Tests:
/// tests/mesh/geometry/frames_test.cpp.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace relief {

/// Where a mesh's normals come from.
enum class NormalMode {
    keep,       ///< The mesh's own; where it has none, `if_missing` decides.
    flat,       ///< One per triangle; vertices are split where triangles meet.
    automatic,  ///< Averaged, by the weighting that suits each vertex: chosen_normals().
    uniform,    ///< Averaged over the triangles around a vertex; NormalWeight says how, as below.
    area,
    angle,
    sine,
    max,
    angle_edges,
    area_angle,
};

enum class TangentMode {
    keep,        ///< The mesh's own, or none; computed anew (mikktspace) where normals are.
    none,        ///< Removed.
    mikktspace,  ///< Computed, see tangents.h.
    area_weighted,
    lengyel,
};

/// Whether this mode makes tangents, for which a mesh needs texture coordinates.
constexpr bool computes_tangents(TangentMode mode) {
    return mode != TangentMode::keep && mode != TangentMode::none;
}

struct FrameOptions {
    NormalMode normals = NormalMode::keep;
    NormalMode if_missing = NormalMode::angle;  ///< Any but keep. glTF asks for flat.
    TangentMode tangents = TangentMode::keep;

    // Of averaged normals:
    /// Vertices no further apart share their normal (normals.h).
    double weld_tolerance = 0.0;
    /// Radians, 0 to pi: edges sharper than this are hard, and vertices are split along them.
    /// Absent: none are for their angle.
    std::optional<double> crease_angle = std::nullopt;
    /// Edges between the mesh's smoothing groups are hard too; but where every group is 0, which
    /// many programs write for "not said", none are.
    bool smoothing_groups = true;

    // Of kept normals:
    /// Those that are zero or not finite are replaced by averaged ones (`if_missing`, or angle
    /// where that is flat), others that are not of unit length are scaled; each is counted.
    bool repair = false;
};

/// A mesh with frames, and where each of its vertices came from.
struct FramedMesh {
    Mesh mesh;
    /// For every vertex of `mesh`, the vertex of the input that it copies; the input's own vertices
    /// come first, in order. What else was stored by vertex is carried along by it (split.h).
    std::vector<std::uint32_t> source_vertex;
    /// How many vertices NormalMode::automatic weighted by area (see ChosenNormals).
    std::size_t normals_by_area = 0;
    /// Averaged normals kept to the mesh's smoothing groups.
    bool within_smoothing_groups = false;
};

/// Normals, then tangents, then splits vertices where corners differ.
///
/// \return every attribute carried along; results as normals.h and tangents.h promise. Kept normals
///         are passed through bit for bit; those not finite, or further from unit length than
///         8-bit storage leaves them (0.007), are counted in the report, and only
///         changed if `repair` says so. Vertices without a
///         triangle keep their place, with frames by the fallbacks named there. Tangents whose
///         normals change are removed, and counted, where there are no texture coordinates.
/// \throws InvalidInput if the mesh is not valid (mesh.h), if `tangents` are to be computed and
/// there
///         are no texture coordinates, if `if_missing` is keep,
///         or if an option is not within what normals.h allows
FramedMesh with_frames(Mesh mesh, const FrameOptions& options, Report& report);

}  // namespace relief
