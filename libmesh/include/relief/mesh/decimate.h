// SPDX-License-Identifier: Apache-2.0
/// \file
/// Fewer triangles for nearly the same surface and the same texture.
/// Tests: tests/mesh/geometry/topology/decimate_test.cpp.
#pragma once

#include <cstddef>
#include <optional>

#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace relief {

/// When to stop, whichever comes first; at least one must be given.
struct DecimateOptions {
    std::optional<std::size_t> triangles;  ///< At this many, at least 1.
    /// Where any vertex of the input would come to lie further from the result than this; object
    /// space, at least 0. It says nothing of points between vertices.
    std::optional<double> max_error;
    /// Frames of the result. With NormalMode::keep the input's normals stay at the vertices that
    /// do, and hard edges are kept as seams are; with any other mode the input's normals are not
    /// looked at. Tangents that the input had are computed anew unless the mode is none.
    FrameOptions frames;
};

/// Takes vertices out, cheapest first, until a limit is reached.
///
/// \param mesh    valid (mesh.h); vertices at equal positions are one
/// \param report  counts what is left out (collapsed triangles, isolated vertices), what is not
///                simplified (non-manifold edges and their ends, triangles with a non-finite
///                corner), and a number of triangles that could not be reached
/// \return a subset of the vertices with all they carry, in their order, and fewer triangles, in
///         the order, material ranges and smoothing groups of those they were; `source_vertex`
///         names the input's vertex for each. With `frames` other than keep, vertices may be split
///         on top of that.
/// \throws InvalidInput if the mesh is not valid, no limit is given or one is out of range, or as
///         with_frames does
///
/// Boundaries, texture seams, borders between colours and materials are lines: they are thinned out
/// along themselves, never torn or crossed, and points where they meet stay. A closed mesh stays
/// closed, no triangle turns over in space or in the texture, and separate pieces neither join nor
/// vanish. Whole numbers of triangles are met to within one, unless that would break any of this.
/// The same input gives the same bits; the order of triangles does matter, as ties go by it.
///
/// Source: [Garland and Heckbert 1997], [Hoppe 1999]; OpenMesh's decimater.
FramedMesh decimated(const Mesh& mesh, const DecimateOptions& options, Report& report);

}  // namespace relief
