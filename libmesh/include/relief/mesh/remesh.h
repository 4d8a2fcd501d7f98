// SPDX-License-Identifier: Apache-2.0
/// \file
/// Replaces any triangles by a closed manifold surface. Part of the library relief::topology.
/// Tests: tests/mesh/topology/remesh_test.cpp.
#pragma once

#include <array>

#include "relief/export.h"
#include "relief/mesh/enum_names.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace RELIEF_API relief {

/// The rule that decides which side of the triangles is solid.
enum class RemeshSign {
    flood,  ///< All that cannot be reached from outside, through gaps of a cell or more, is solid.
    winding,  ///< All with an absolute winding number of at least a half is solid.
};

template <>
inline constexpr auto enum_names<RemeshSign> =
    std::array{EnumName<RemeshSign>{"flood", RemeshSign::flood},
               EnumName<RemeshSign>{"winding", RemeshSign::winding}};

struct RemeshOptions {
    /// The number of cells along the longest side of the bounding box, 8 to 1024.
    int resolution = 128;
    /// Everything within 0.75 cells of a triangle is solid, too: sheets become shells 1.5 cells
    /// thick, and solids grow by 0.75 cells.
    bool shell = false;
    RemeshSign sign = RemeshSign::flood;
    ExecutionOptions execution = {};
};

/// Computes a closed manifold surface around the solid that triangles enclose.
///
/// \param mesh  valid (mesh.h); the winding of its triangles is ignored, except for
///         RemeshSign::winding
/// \param report  counts triangles that are not finite or have no area (their height is below 1e-12
///         of their longest edge), which are ignored, and attributes that are not kept
/// \return positions and triangles, with the material ranges of `mesh`: each triangle has the range
///         of a triangle of `mesh` that it crosses. Each edge has two triangles with opposite
///         directions, and the triangles at each vertex are one fan. No two vertices have one
///         position
/// \throws InvalidInput if the mesh is not valid, the resolution is out of range, no triangle with
///         an area is left, nothing is enclosed, or cells are below 256 times the spacing of floats
///
/// All that cannot be reached from outside through cells without triangles is solid, apart from the
/// cells of the surface itself, where the nearer side along the edges of the grid decides. So gaps
/// narrower than a cell are closed, and parts thinner than a cell may be lost unless `shell` is
/// set: open surfaces enclose nothing. Vertices minimize the squared distances from the planes of
/// the triangles that cross their cell, so sharp edges are kept, and stay inside of their cell. The
/// surface may intersect itself where it is less than a cell thick.
///
/// With RemeshSign::winding, holes of any size are closed where the winding number is a half, and
/// cavities whose walls face into them stay empty. Neighbors must have the same winding
/// (repair.h), or they cancel each other. It takes about ten times as long, and more with large
/// holes.
///
/// The same input gives the same bits for any order of triangles and vertices and any number of
/// threads. Time and memory grow with the square of the resolution.
///
/// Source: [Ju et al. 2002]; winding numbers [Jacobson et al. 2013], [Barill et al. 2018]; several
/// vertices in a cell [Schaefer et al. 2007], one for each component of the surface as in
/// [Nielson 2004]. Deviation: where two cells share two edges of the result, which would not be
/// manifold, these edges get vertices of their own.
Mesh remeshed(const Mesh& mesh, const RemeshOptions& options, Report& report = IgnoredReport());

}  // namespace relief
