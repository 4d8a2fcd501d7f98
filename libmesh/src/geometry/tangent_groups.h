// SPDX-License-Identifier: Apache-2.0
/// \file
/// The tangents that neighbouring triangles agree on at the vertices they share.
///
/// Object space, unit vectors. Source: [Mikkelsen 2008]. Nothing here depends on the order of
/// triangles, and nothing recurses. Tests: tests/mesh/geometry/tangents_test.cpp.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "geometry/corner_links.h"
#include "geometry/corners.h"
#include "geometry/texture_gradient.h"

namespace relief {

/// What the averaging works on; everything is indexed by welded vertices.
struct TangentInput {
    std::span<const glm::vec3> positions;
    std::span<const glm::vec3> normals;  ///< Any length; without a direction: tangents are free.
    std::span<const glm::uvec3> triangles;
    const CornersByVertex& corners;
    const CornerLinks& links;
    const TriangleGradients& gradients;
};

/// The w of every triangle. One without a gradient takes that of most triangles with one that end
/// the runs of such triangles around its vertices, since their groups could claim it; failing
/// these, of most neighbours that have found theirs first; +1 if they balance, 0 where there are
/// none at all. (The reference implementation takes that of the first group to come in the list.)
std::vector<std::int8_t> triangle_signs(const TangentInput& input);

/// How a corner came by its tangent.
enum class CornerState : std::uint8_t {
    open,       ///< It has none: its triangle or its group has nothing to say.
    agreed,     ///< The average over its group.
    cancelled,  ///< The tangents of its group cancel: it has its own triangle's, or none.
};

struct CornerTangents {
    std::vector<glm::vec4> values;  ///< w is 0 where there is none.
    std::vector<CornerState> states;
};

/// The tangents of all corners whose triangles take part, and can.
CornerTangents grouped_tangents(const TangentInput& input, std::span<const std::int8_t> signs);

}  // namespace relief
