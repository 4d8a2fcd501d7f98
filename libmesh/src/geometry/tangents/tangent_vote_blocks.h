// SPDX-License-Identifier: Apache-2.0
/// \file
/// The votes (tangent_votes.h) of all triangles of a mesh, many at once.
/// Tests: tests/mesh/geometry/tangents/tangent_votes_test.cpp.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "geometry/tangents/tangent_votes.h"

namespace relief {

/// What triangles have to say about the textures on them.
struct TriangleGradients {
    std::vector<Gradient> kinds;
    std::vector<std::uint32_t> without;  ///< Triangles without a gradient; ascending.
};

/// The votes of all corners, into memory for one vec4 a corner. A triangle without a gradient has
/// no votes; a direction that stands on the normal's plane by less than 1e-6 of its length is none.
///
/// In double from the floats of the input; the same bits with every compiler and instruction set.
TriangleGradients cast_votes(const TangentInput& input, TangentWeight weight,
                             std::span<glm::vec4> votes);

}  // namespace relief
