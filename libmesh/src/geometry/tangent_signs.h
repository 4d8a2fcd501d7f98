// SPDX-License-Identifier: Apache-2.0
/// \file
/// The handedness of every triangle's tangents, also of those whose texture does not tell.
/// Tests: tests/mesh/geometry/tangents_test.cpp.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "geometry/corners.h"
#include "geometry/texture_gradient.h"

namespace relief {

/// The w of every triangle. One without a gradient takes that of most triangles with one that end
/// the runs of such triangles around its vertices, since their groups could claim it; failing
/// these, of most neighbours that have found theirs first; +1 if they balance, 0 where there are
/// none at all. (The reference implementation takes that of the first group to come in the list.)
///
/// \param triangles  over welded vertices
/// \param corners    of the triangles that take part
/// \return the same for any order of triangles; linear time but for sorting the edges of vertices
///         of triangles without a gradient
std::vector<std::int8_t> triangle_signs(std::span<const glm::uvec3> triangles,
                                        const CornersByVertex& corners,
                                        std::span<const Gradient> kinds);

}  // namespace relief
