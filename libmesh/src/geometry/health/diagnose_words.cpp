// SPDX-License-Identifier: Apache-2.0
// The words for what can be found in a mesh: the one table that reports, relief-mesh check and
// docs/hard-cases.md take them from. Tests: tests/mesh/geometry/health/diagnose_test.cpp.
#include <array>
#include <cstddef>

#include "relief/mesh/diagnose.h"

namespace relief {
namespace {

using enum Severity;

constexpr std::array all_mesh_conditions = {
    MeshConditionInfo{MeshCondition::triangle_not_finite, "triangle with a non-finite corner",
                      "triangle", trouble, "has no area, no normal and no place"},
    MeshConditionInfo{MeshCondition::triangle_collapsed, "collapsed triangle", "triangle", trouble,
                      "has two corners at the same place, so no area and no normal"},
    MeshConditionInfo{MeshCondition::triangle_collinear, "collinear triangle", "triangle", trouble,
                      "has its corners on a line, so no area and no normal"},
    MeshConditionInfo{MeshCondition::triangle_needle, "needle triangle", "triangle", remark,
                      "is so narrow that rounding of its corners turns its normal"},
    MeshConditionInfo{MeshCondition::triangle_repeated, "repeated triangle", "triangle", trouble,
                      "lies exactly on an earlier one and counts twice"},
    MeshConditionInfo{MeshCondition::triangle_backed, "double-sided triangle", "triangle", remark,
                      "lies exactly on the back of another: smoothed together, they cancel"},
    MeshConditionInfo{MeshCondition::edge_non_manifold, "non-manifold edge", "edge of triangle",
                      trouble, "has three triangles or more, so no inside and outside"},
    MeshConditionInfo{MeshCondition::edge_flipped, "flipped neighbours", "edge of triangle",
                      trouble, "one of the two triangles on the edge is inside out"},
    MeshConditionInfo{MeshCondition::edge_folded, "folded edge", "edge of triangle", remark,
                      "the two triangles on the edge lie on each other, back to back"},
    MeshConditionInfo{MeshCondition::edge_boundary, "boundary edge", "edge of triangle", remark,
                      "has one triangle: the surface is open there"},
    MeshConditionInfo{MeshCondition::vertex_not_finite, "non-finite position", "vertex", trouble,
                      "is nowhere"},
    MeshConditionInfo{MeshCondition::vertex_isolated, "isolated vertex", "vertex", trouble,
                      "belongs to no triangle, so nothing gives it a normal"},
    MeshConditionInfo{MeshCondition::vertex_voiceless, "vertex with only degenerate triangles",
                      "vertex", trouble, "has no triangle that could give it a normal"},
    MeshConditionInfo{MeshCondition::vertex_bow_tie, "bow-tie vertex", "vertex", remark,
                      "is where several surfaces touch in a point: smoothed together there"},
    MeshConditionInfo{MeshCondition::vertex_near_duplicate, "near-duplicate vertex", "vertex",
                      remark, "is all but equal to another: not smoothed together, a crack"},
    MeshConditionInfo{MeshCondition::normal_not_finite, "non-finite normal", "vertex", trouble,
                      "is no direction"},
    MeshConditionInfo{MeshCondition::normal_zero, "zero normal", "vertex", trouble,
                      "is no direction"},
    MeshConditionInfo{MeshCondition::normal_not_unit, "normal not of unit length", "vertex",
                      trouble, "shades too bright or too dark"},
    MeshConditionInfo{MeshCondition::normal_opposed, "normal against its triangles", "vertex",
                      trouble, "points to the back of all of them"},
    MeshConditionInfo{MeshCondition::normal_divided, "normal against one of its triangles",
                      "vertex", remark, "does not face as every triangle around does"},
    MeshConditionInfo{MeshCondition::tangent_not_finite, "non-finite tangent", "vertex", trouble,
                      "is no direction"},
    MeshConditionInfo{MeshCondition::tangent_not_unit, "tangent not of unit length", "vertex",
                      trouble, "bends what a normal map says"},
    MeshConditionInfo{MeshCondition::tangent_unhanded, "tangent without handedness", "vertex",
                      trouble, "has a w that is neither 1 nor -1, so no bitangent"},
    MeshConditionInfo{MeshCondition::tangent_along_normal, "tangent along its normal", "vertex",
                      trouble, "spans no tangent plane with it"},
    MeshConditionInfo{MeshCondition::tangent_leaning, "tangent not perpendicular to its normal",
                      "vertex", remark, "bends what a normal map says by as much"},
    MeshConditionInfo{MeshCondition::texture_not_finite, "non-finite texture coordinate", "vertex",
                      trouble, "is nowhere in the image"},
    MeshConditionInfo{MeshCondition::texture_degenerate, "triangle without texture gradient",
                      "triangle", trouble, "has no area in the image, so no tangents"},
    MeshConditionInfo{MeshCondition::texture_mirrored, "mirrored texture", "triangle", remark,
                      "shows the image the wrong way round"},
    MeshConditionInfo{MeshCondition::texture_overlapping, "overlapping texture", "triangle", remark,
                      "shares texels with another: nothing can be baked there"},
    MeshConditionInfo{MeshCondition::mesh_far_away, "far from the origin", "mesh", remark,
                      "floats are so coarse out there that details are rounded away"},
    MeshConditionInfo{MeshCondition::texture_far_away, "texture far from its origin", "mesh",
                      remark, "floats are so coarse out there that the image is torn"},
};

/// Whether the row of each condition is where the condition looks for it.
constexpr bool are_in_order() {
    for (std::size_t i = 0; i < all_mesh_conditions.size(); ++i) {
        if (all_mesh_conditions[i].condition != static_cast<MeshCondition>(i)) return false;
    }
    return all_mesh_conditions.back().condition == MeshCondition::texture_far_away;
}
static_assert(are_in_order());

}  // namespace

std::span<const MeshConditionInfo> mesh_conditions() {
    return all_mesh_conditions;
}

const MeshConditionInfo& condition_info(MeshCondition condition) {
    return all_mesh_conditions[static_cast<std::size_t>(condition)];
}

}  // namespace relief
