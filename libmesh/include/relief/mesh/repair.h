// SPDX-License-Identifier: Apache-2.0
/// \file
/// Repairs the connectivity of a mesh. Part of the library relief::topology.
/// Tests: tests/mesh/topology/repair_test.cpp, tests/hard_cases/repair_changes_test.cpp.
#pragma once

#include <array>

#include "relief/export.h"
#include "relief/mesh/enum_names.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace RELIEF_API relief {

/// The outcome for two triangles with the same corners and opposite winding, the sides of a doubled
/// wall.
enum class TwoSided {
    keep,      ///< Both stay, as triangles of two sheets.
    together,  ///< Both stay at the same positions, so that they are decimated as one (topology.h).
    single,    ///< One stays.
    remove     ///< Both are removed, as for a wall inside of a solid.
};

template <>
inline constexpr auto enum_names<TwoSided> = std::array{
    EnumName<TwoSided>{"keep", TwoSided::keep}, EnumName<TwoSided>{"together", TwoSided::together},
    EnumName<TwoSided>{"single", TwoSided::single}, EnumName<TwoSided>{"remove", TwoSided::remove}};

/// The steps of a repair, in their order.
struct RepairOptions {
    bool remove_non_finite = true;  ///< Triangles with a non-finite corner.
    /// Vertices that are equal in their position and all other attributes become one.
    bool merge_vertices = true;
    /// Positions with at most this distance, and chains of such positions, become the smallest of
    /// them, compared by x, y and z. In object space, at least 0. 0: only equal positions are one.
    double weld_tolerance = 0.0;
    bool remove_collapsed = true;   ///< Triangles with two corners at one position.
    bool remove_duplicates = true;  ///< Triangles with the corners and the winding of another one.
    TwoSided two_sided = TwoSided::keep;
    /// Neighbors get the same winding, closed parts are oriented outwards.
    bool orient = true;
    bool separate = true;  ///< Non-manifold edges and vertices are separated.
    /// Parts (triangles that are joined across edges) whose bounding box has a diagonal shorter
    /// than this length are removed; the largest one stays. In object space. 0: none.
    double drop_parts = 0.0;
};

/// Repairs the connectivity of a mesh: welds, removes, orients and separates triangles.
///
/// \param mesh  valid (mesh.h); vertices at equal positions count as one
/// \param report  counts every change, by the triangles and vertices of the input
/// \param deformation  how the vertices move: vertices that differ in it are not merged
/// \return the remaining triangles in their order, with material ranges and smoothing groups, and
///         the vertices that they use, with all attributes; copies follow the others.
///         `source_vertex` holds the input's vertices. With all steps, no edge has more than two
///         triangles, two triangles at an edge have the same winding, and the triangles at a
///         position are one fan, apart from triangles that are kept although they collapsed or are
///         not finite, and from the backs of sheets that stay together. Nothing may remain
/// \throws InvalidInput if the mesh is not valid, if a length is negative or not finite, or if
///         sheets stay `together` without `orient`
///
/// Three or more triangles at an edge: pairs in opposite directions are joined, the flattest first;
/// pairs in the same direction follow if `orient` is set. The others are cut, and so are edges at
/// which a part cannot be oriented (a Moebius strip is cut across once). The first fan of triangles
/// at a position stays; fan k moves by k * 2^-20 of the size of the mesh (rounded up to a power of
/// two), or by k * 16 times the spacing of floats if that is more: into its own triangles, or along
/// its normal if the fan is closed. So separated vertices have different positions, in every file
/// format. Sides that stay together are one triangle for all these steps: the back follows its
/// front, and no side is reversed.
///
/// Closed parts are oriented outwards by their signed volume, unless they are inside of an odd
/// number of other closed parts: then they may be the walls of a cavity, and keep the winding of
/// most of their area, as open parts do. The normal of a vertex whose triangle is reversed is
/// negated if it points to the back. Collinear triangles stay, because they close cracks between
/// their neighbors. The same input gives the same bits for any order of triangles and vertices, and
/// a second repair changes nothing, unless `weld_tolerance` exceeds the distance of separated
/// vertices.
///
/// Source: cutting non-manifold edges and vertices as in [Gueziec et al. 2001].
FramedMesh repaired(const Mesh& mesh, const RepairOptions& options = {},
                    Report& report = IgnoredReport(), const Deformation& deformation = {});

}  // namespace relief
