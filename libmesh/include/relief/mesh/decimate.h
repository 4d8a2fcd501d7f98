// SPDX-License-Identifier: Apache-2.0
/// \file
/// Decimates meshes: reduces the number of triangles and preserves the surface and its texture
/// mapping.
/// Tests: tests/mesh/topology/decimate_test.cpp.
#pragma once

#include <cstddef>
#include <optional>

#include "relief/export.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace RELIEF_API relief {

/// The limits of a decimation; at least one must be given, and the first one that is reached ends
/// it.
struct DecimateOptions {
    std::optional<std::size_t> triangles;  ///< Target number of triangles, at least 1.
    /// The maximum distance of the input's vertices from the result, in object space, at least 0.
    /// Points between vertices are not measured.
    std::optional<double> max_error;
    /// The frames of the result. With NormalMode::keep, the remaining vertices keep their normals,
    /// and hard edges are preserved like seams. Other modes ignore the normals of the input. If the
    /// input has tangents, they are recomputed unless the mode is none.
    FrameOptions frames;
};

/// Removes vertices by edge collapses in order of increasing error until a limit is reached.
///
/// \param mesh  valid (mesh.h); vertices at equal positions count as one
/// \param report  counts omitted elements (collapsed triangles, isolated vertices), elements that
///         are not simplified (non-manifold edges and their ends, triangles with a non-finite
///         corner), and a target number of triangles that could not be reached
/// \return a subset of the vertices with all attributes, in their order, and the remaining
///         triangles in the original order, with their material ranges and smoothing groups.
///         `source_vertex` holds the input's index of each vertex. If `frames` does not keep
///         normals, vertices may be split in addition
/// \throws InvalidInput if the mesh is not valid, no limit is given or one is out of range, or as
///         with_frames() does
///
/// Boundaries, texture seams, and borders between colors and materials are feature lines: they are
/// simplified along themselves and never torn or crossed, and their junctions are kept. Closed
/// meshes stay closed, no triangle is inverted in space or in the texture, and separate components
/// neither merge nor vanish. The target number of triangles is met to within one unless that would
/// violate these rules. The same input gives the same bits; the order of triangles affects the
/// result, because it breaks ties.
///
/// Source: [Garland and Heckbert 1997], [Hoppe 1999]; OpenMesh's decimater.
FramedMesh decimated(const Mesh& mesh, const DecimateOptions& options, Report& report);

}  // namespace relief
