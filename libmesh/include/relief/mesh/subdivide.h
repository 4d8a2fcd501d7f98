// SPDX-License-Identifier: Apache-2.0
/// \file
/// A finer, smoother surface from a coarse one.
/// Tests: tests/mesh/geometry/topology/subdivide_test.cpp.
#pragma once

#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace relief {

/// Loop's subdivision: each level cuts every triangle into four and smooths all positions.
///
/// \param mesh    valid (mesh.h); vertices at equal positions are one
/// \param levels  at least 1; triangles grow fourfold with each, and must stay below 2^32 / 3
/// \param frames  of the result. Normals of the input are not looked at, as the surface is smooth
///                everywhere: NormalMode::keep means angle where the input has normals, none where
///                it has not. Tangents that the input had are computed anew unless the mode is none
/// \param report  counts collapsed triangles, which are left out; triangles with a non-finite
///                corner, which stay as they are; non-manifold edges
/// \return the input's vertices first, in their order, then those at the middles of edges.
///         Triangles follow each other as those they were cut from do, material ranges and
///         smoothing groups with them
/// \throws InvalidInput if the mesh is not valid, or `levels` is out of range
///
/// Texture coordinates and colours at a new vertex are the mean of the edge's ends, on each side of
/// a seam by itself: the texture map stays, triangle by triangle, the very map that it was, and
/// seams are neither torn nor smeared, while positions cross them smoothly. Boundaries become cubic
/// splines of their own vertices. Surfaces that meet at a non-manifold edge or vertex are smoothed
/// each by itself and joined at the mean of what they ask for.
/// The same input gives the same bits.
///
/// Source: [Loop 1987]; OpenMesh's subdivider.
Mesh subdivided(const Mesh& mesh, int levels, const FrameOptions& frames, Report& report);

}  // namespace relief
