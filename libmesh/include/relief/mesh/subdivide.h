// SPDX-License-Identifier: Apache-2.0
/// \file
/// Subdivides meshes into finer, smoother surfaces.
/// Tests: tests/mesh/topology/subdivide_test.cpp.
#pragma once

#include "relief/export.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace RELIEF_API relief {

/// Applies Loop subdivision: each level splits every triangle into four and smooths all positions.
///
/// \param mesh  valid (mesh.h); vertices at equal positions count as one
/// \param levels  at least 1; each multiplies the number of triangles by four, which must stay
///         below 2^32 / 3
/// \param frames  of the result. The normals of the input are ignored, because the surface is
///         smooth everywhere: NormalMode::keep means angle if the input has normals, and none
///         otherwise. If the input has tangents, they are recomputed unless the mode is none
/// \param report  counts collapsed triangles, which are omitted; triangles with a non-finite
///         corner, which do not change; and non-manifold edges
/// \return the input's vertices in their order, then the new vertices at edge midpoints. Triangles
///         keep the order of their source triangles, with material ranges and smoothing groups
/// \throws InvalidInput if the mesh is not valid, or `levels` is out of range
///
/// Texture coordinates and colors of a new vertex are the mean of those at the ends of its edge,
/// separately for each side of a seam. So each triangle keeps its texture mapping, and seams
/// neither tear nor blur, while positions are smooth across them. Boundaries become cubic splines
/// of their own vertices. Surfaces that meet at a non-manifold edge or vertex are smoothed
/// separately and joined at the mean of their results. The same input gives the same bits.
///
/// Source: [Loop 1987]; OpenMesh's subdivider.
Mesh subdivided(const Mesh& mesh, int levels, const FrameOptions& frames, Report& report);

}  // namespace relief
