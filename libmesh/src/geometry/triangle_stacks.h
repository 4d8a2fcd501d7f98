// SPDX-License-Identifier: Apache-2.0
/// \file
/// Stacks: triangles at the same three positions. A stack has one triangle several times, or the
/// two sides of a wall that was modeled as two triangles of opposite winding, which is doubled.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/buffers.h"

namespace RELIEF_API relief {
namespace detail {

/// \param classes  for each vertex, the smallest vertex with its position (weld.h); empty: each
///         vertex has a position of its own
/// \return for each triangle, the smallest triangle at its positions; empty if no two triangles are
///         at the same positions
std::vector<std::uint32_t> triangle_stacks(TriangleSpan triangles,
                                           std::span<const std::uint32_t> classes = {});

/// Returns whether two triangles of a stack, given by their positions, have opposite windings. If
/// two of the positions are the same, there is no winding, and the result is false.
inline bool are_opposite(const glm::uvec3& a, const glm::uvec3& b) {
    if (a.x == a.y || a.y == a.z || a.z == a.x) return false;
    if (a.x == b.x) return a.y != b.y;
    return a.x == b.y ? a.y != b.z : a.y != b.x;
}

}  // namespace detail
}  // namespace relief
