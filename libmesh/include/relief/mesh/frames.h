// SPDX-License-Identifier: Apache-2.0
/// \file
/// The one call that gives a mesh its normals and tangents. Tests:
/// tests/mesh/geometry/frames_test.cpp.
#pragma once

#include <cstdint>
#include <vector>

#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace relief {

/// Where a mesh's normals come from.
enum class NormalMode {
    keep,   ///< The mesh's own; where it has none, `if_missing` decides.
    flat,   ///< One per triangle; vertices are split where triangles meet.
    area,   ///< Averaged over the triangles around a vertex by area.
    angle,  ///< Averaged over the triangles around a vertex by corner angle.
};

enum class TangentMode {
    keep,        ///< The mesh's own, or none; computed anew (mikktspace) where normals are.
    none,        ///< Removed.
    mikktspace,  ///< Computed, see tangents.h.
};

struct FrameOptions {
    NormalMode normals = NormalMode::keep;
    NormalMode if_missing = NormalMode::angle;  ///< Any but keep. glTF asks for flat.
    TangentMode tangents = TangentMode::keep;
};

/// A mesh with frames, and where each of its vertices came from.
struct FramedMesh {
    Mesh mesh;
    /// For every vertex of `mesh`, the vertex of the input that it copies; the input's own vertices
    /// come first, in order. What else was stored by vertex is carried along by it (split.h).
    std::vector<std::uint32_t> source_vertex;
};

/// Normals, then tangents, then splits vertices where corners differ.
///
/// \return every attribute carried along; results as normals.h and tangents.h promise. Kept normals
///         are passed through bit for bit; those not finite, or further from unit length than
///         8-bit storage leaves them (0.007), are counted in the report. Vertices without a
///         triangle keep their place, with frames by the fallbacks named there. Tangents whose
///         normals change are removed, and counted, where there are no texture coordinates.
/// \throws InvalidInput if the mesh is not valid (mesh.h), if `tangents` is mikktspace and there
///         are no texture coordinates, or if `if_missing` is keep
FramedMesh with_frames(Mesh mesh, const FrameOptions& options, Report& report);

}  // namespace relief
