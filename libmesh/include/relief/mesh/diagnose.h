// SPDX-License-Identifier: Apache-2.0
/// \file
/// Diagnoses a mesh: finds degenerate, non-manifold, non-finite and otherwise unusual elements
/// before anything is computed.
///
/// docs/hard-cases.md uses the same terms and documents the effect of each condition on every step.
/// Tests: tests/mesh/topology/diagnose_test.cpp, tests/hard_cases/hard_cases_test.cpp.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace RELIEF_API relief {

/// The severity of a condition. A problem causes a fallback, or makes a result depend on more than
/// the surface. A note also applies to valid models.
enum class Severity { problem, note };

/// The conditions of a mesh. For triangles, edges and fans, vertices at equal positions count as
/// one, so that texture seams are not boundaries.
enum class MeshCondition {
    // Triangles. A triangle has at most one of the first four conditions.
    triangle_not_finite,  ///< A corner has a non-finite position.
    triangle_collapsed,   ///< Two corners have the same position.
    triangle_collinear,   ///< Its height is less than 1e-12 of its longest edge.
    triangle_needle,      ///< Its height is less than 1e-4 of its longest edge.
    /// It has the corners and winding of an earlier triangle; all but the first are counted.
    triangle_repeated,
    /// It has the corners of another triangle with opposite winding: a two-sided sheet.
    triangle_two_sided,
    // Edges between finite triangles that are not collapsed, repeated or backed. Each edge is
    // counted once and listed by its first triangle.
    edge_non_manifold,  ///< It has three or more triangles.
    /// Its two triangles have opposite winding: both contain it in the same direction.
    edge_flipped,
    edge_folded,    ///< Its two triangles lie on each other, within one degree.
    edge_boundary,  ///< It has one triangle.
    // Vertices.
    vertex_not_finite,
    vertex_isolated,        ///< No triangle has a corner at its position.
    vertex_degenerate_fan,  ///< All its triangles have one of the first three conditions.
    vertex_bow_tie,  ///< Several fans of triangles meet only at this position. Counted by position.
    /// Another position differs from it by at most 4 units in the last place of its largest
    /// coordinate. Counted by position.
    vertex_near_duplicate,
    // Normals, if the mesh has them.
    normal_not_finite,
    normal_zero,
    /// Its length differs from 1 by more than the error of 8-bit storage (0.007).
    normal_not_unit,
    normal_opposed,  ///< It points to the back of every triangle of its vertex.
    /// It points to the back of some triangle of its vertex, or lies in its plane.
    normal_inconsistent,
    // Tangents, if the mesh has them.
    tangent_not_finite,
    tangent_not_unit,      ///< It is zero, or its length differs from 1 as for normals.
    tangent_invalid_sign,  ///< Its w is neither 1 nor -1.
    /// It is within 2.5 degrees of the normal or its opposite, so there is no tangent frame.
    tangent_along_normal,
    /// It deviates by more than 1.2 degrees from the perpendicular to the normal.
    tangent_not_perpendicular,
    // Texture coordinates, if the mesh has them. Only triangles with an area in space are
    // considered.
    texture_not_finite,   ///< Counted by vertex.
    texture_degenerate,   ///< The triangle has no area in the image.
    texture_mirrored,     ///< The image is mirrored on the triangle.
    texture_overlapping,  ///< The triangle shares texels with another one.
    // The whole mesh.
    /// The spacing of floats at its largest coordinate exceeds 1/65536 of the mesh's size.
    mesh_far_away,
    texture_far_away,  ///< The same for texture coordinates and the size of their bounding box.
};

/// The texts for a condition.
struct MeshConditionInfo {
    MeshCondition condition;
    std::string_view word;     ///< Finding::kind: "needle triangle".
    std::string_view element;  ///< Finding::element.
    Severity severity;
    std::string_view meaning;  ///< Finding::outcome: "is so narrow that ...".
};

/// All conditions, in the order of the enumeration.
std::span<const MeshConditionInfo> mesh_conditions();

/// The texts for one condition.
const MeshConditionInfo& condition_info(MeshCondition condition);

/// A condition that occurs in a mesh.
struct MeshConditionCount {
    MeshCondition condition;
    std::size_t count = 0;
    /// The smallest indices, ascending, at most DiagnoseOptions::listed.
    std::vector<std::size_t> first;

    friend bool operator==(const MeshConditionCount&, const MeshConditionCount&) = default;
};

struct Diagnosis {
    std::vector<MeshConditionCount> conditions;  ///< In the order of the enumeration.
    float size = 0.0F;     ///< The longest side of the bounding box of all finite positions.
    float spacing = 0.0F;  ///< The spacing of floats at the largest coordinate.
    /// Texels along each side of the raster for the overlap test; 0 if it was not done.
    int overlap_raster = 0;

    [[nodiscard]] std::size_t count(MeshCondition condition) const;
    [[nodiscard]] bool has_problem() const;

    friend bool operator==(const Diagnosis&, const Diagnosis&) = default;
};

/// The conditions to test; omitted ones cost no time.
struct DiagnoseOptions {
    bool edges = true;            ///< Repeated and backed triangles, edges, and bow-tie vertices.
    bool near_duplicates = true;  ///< vertex_near_duplicate
    bool texture_overlap = true;  ///< texture_overlapping
    std::size_t listed = 8;       ///< Maximum number of listed elements per condition.
};

/// Tests a mesh for all conditions. The mesh may have any values and is not changed.
///
/// \throws InvalidInput if the mesh is not valid (mesh.h)
///
/// The time is linear for any shape, except for sorting around each vertex. A million triangles
/// take a third of a second on one core, and one to two seconds if all share one vertex or edge, or
/// if each covers the whole image (bench/README.md). Counts do not depend on the order of triangles
/// and the number of threads.
///
/// Texture coordinates are compared without wrapping, so charts in different tiles do not overlap.
/// Two triangles overlap if the center of a texel lies inside both, at least a thousandth of a
/// texel from their edges. The raster covers the bounding box of all texture coordinates with about
/// 2 x 2 texels per triangle (1024 to 4096 along each side; fewer if long triangles would make it
/// slow). Smaller overlaps are not found.
///
/// Near duplicates are searched for among the first 64 positions of a cell of 256 units in the last
/// place; other positions in the cell are found only if they are close to one of these.
Diagnosis diagnose(const Mesh& mesh, const DiagnoseOptions& options = {});

/// Converts a condition to a finding of a report.
Finding to_finding(const MeshConditionCount& count);

/// Converts all conditions, or those of one severity, to findings.
Report to_report(const Diagnosis& diagnosis, std::optional<Severity> severity = std::nullopt);

}  // namespace relief
