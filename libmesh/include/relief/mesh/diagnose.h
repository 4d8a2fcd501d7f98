// SPDX-License-Identifier: Apache-2.0
/// \file
/// The health of a mesh: what is wrong with it, or worth knowing, before anything is computed.
///
/// The words are those of docs/hard-cases.md, which says what each comes to in every step.
/// Tests: tests/mesh/geometry/health/diagnose_test.cpp, tests/hard_cases/hard_cases_test.cpp.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace relief {

/// Trouble makes a step fall back, or its result depend on more than the surface; a remark is what
/// sound models have too.
enum class Severity { trouble, remark };

/// What can be found in a mesh. Vertices at equal positions count as one for all that is about
/// triangles, edges and fans, so that texture seams are no borders.
enum class MeshCondition {
    // Triangles. A triangle has one of the first four at most.
    triangle_not_finite,  ///< Has a corner whose position is not finite.
    triangle_collapsed,   ///< Two corners at the same place.
    triangle_collinear,   ///< Narrower than 1e-12 of its longest edge.
    triangle_needle,      ///< Narrower than 1e-4 of its longest edge.
    triangle_repeated,    ///< Same corners, same way round as an earlier one; all but the first.
    triangle_backed,      ///< Same corners as another, the other way round: a two-sided sheet.
    // Edges between finite triangles that are not collapsed, repeated or backed. Counted by edge,
    // named by the first triangle on it.
    edge_non_manifold,  ///< Of three triangles or more.
    edge_flipped,       ///< Its two triangles run along it in the same direction.
    edge_folded,        ///< Its two triangles lie on each other, within a degree.
    edge_boundary,      ///< Of one triangle.
    // Vertices.
    vertex_not_finite,
    vertex_isolated,   ///< No triangle has a corner at its place.
    vertex_voiceless,  ///< Only degenerate triangles have (the first three of the list).
    vertex_bow_tie,    ///< Several fans of triangles touch there. Counted by position.
    /// Another position differs by 4 units in the last place of its largest coordinate, or less.
    /// Counted by position.
    vertex_near_duplicate,
    // Normals, where there are any.
    normal_not_finite,
    normal_zero,
    normal_not_unit,  ///< Length off by more than 8-bit storage leaves (0.007).
    normal_opposed,   ///< Points to the back of every triangle of its vertex.
    normal_divided,   ///< Points to the back of some, or lies in one.
    // Tangents, where there are any.
    tangent_not_finite,
    tangent_not_unit,      ///< Zero, or off as for normals.
    tangent_unhanded,      ///< w is neither 1 nor -1.
    tangent_along_normal,  ///< Within 2.5 degrees of the normal or its opposite: no frame.
    tangent_leaning,       ///< Not perpendicular to the normal: more than 1.2 degrees off.
    // Texture coordinates, where there are any; only triangles that have an area in space.
    texture_not_finite,   ///< A vertex.
    texture_degenerate,   ///< The triangle has no area in the image.
    texture_mirrored,     ///< The image is on the triangle the wrong way round.
    texture_overlapping,  ///< Shares texels with another triangle.
    // The whole.
    mesh_far_away,     ///< Floats so far out are coarser than 1/65536 of the mesh's size.
    texture_far_away,  ///< The same of texture coordinates, and of the box around them.
};

/// A condition in words.
struct MeshConditionInfo {
    MeshCondition condition;
    std::string_view word;     ///< Finding::kind: "needle triangle".
    std::string_view element;  ///< Finding::element.
    Severity severity;
    std::string_view meaning;  ///< Finding::outcome: "has an area, but ...".
};

/// All conditions, in the order of the enumeration.
std::span<const MeshConditionInfo> mesh_conditions();

/// The words for one of them.
const MeshConditionInfo& condition_info(MeshCondition condition);

/// A condition that a mesh has.
struct FoundCondition {
    MeshCondition condition;
    std::size_t count = 0;
    /// The smallest indices, ascending, at most DiagnoseOptions::listed.
    std::vector<std::size_t> first;

    friend bool operator==(const FoundCondition&, const FoundCondition&) = default;
};

struct Diagnosis {
    std::vector<FoundCondition> found;  ///< In the order of the enumeration.
    float size = 0.0F;     ///< The longest side of the box around all finite positions.
    float spacing = 0.0F;  ///< Between neighbouring floats at the largest coordinate.
    /// Texels along each side of the raster on which overlaps were looked for; 0: not looked.
    int overlap_raster = 0;

    [[nodiscard]] std::size_t count(MeshCondition condition) const;
    [[nodiscard]] bool has_trouble() const;

    friend bool operator==(const Diagnosis&, const Diagnosis&) = default;
};

/// What to look for; what is left out costs nothing.
struct DiagnoseOptions {
    bool edges = true;            ///< Repeated and backed triangles, edges, bow-ties.
    bool near_duplicates = true;  ///< vertex_near_duplicate
    bool texture_overlap = true;  ///< texture_overlapping
    std::size_t listed = 8;       ///< How many elements of a condition are named.
};

/// Everything that MeshCondition lists, counted. Changes nothing, judges every value.
///
/// \throws InvalidInput if the mesh is not valid (mesh.h)
///
/// Time is linear but for sorting around each vertex, whatever the shape: a million triangles take
/// a third of a second on one core, and one to two where all stand around one vertex or edge, or
/// cover the whole image each (bench/README.md). Counts are the same for any order of triangles and
/// any number of threads.
///
/// Texture coordinates are compared as they are: what tiling or UDIM tiles set apart, is apart.
/// Overlap is what a texel would notice: two triangles overlap when the centre of a texel lies
/// inside both, by a thousandth of a texel or more, on a raster laid over the box of all texture
/// coordinates, of two texels by two for each triangle (1024 to 4096 along each side; fewer where
/// long triangles would make it slow). Overlaps that hold no such centre are not seen.
///
/// Near duplicates are looked for among the first 64 positions of a cell of 256 units in the last
/// place; more in one cell are found only if they are near to one of these.
Diagnosis diagnose(const Mesh& mesh, const DiagnoseOptions& options = {});

/// A condition as a finding of a report, in the words of the table.
Finding to_finding(const FoundCondition& found);

/// All conditions as findings, or those of one severity.
Report to_report(const Diagnosis& diagnosis, std::optional<Severity> severity = std::nullopt);

}  // namespace relief
