// SPDX-License-Identifier: Apache-2.0
/// \file
/// Tangents for corners whose own group has none: degenerate, non-finite and cut-off triangles.
///
/// Object space, unit vectors. Linear but for sorting the corners of the vertices concerned.
/// Tests: tests/mesh/geometry/tangents/tangents_test.cpp.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "geometry/corners.h"
#include "geometry/tangents/tangent_groups.h"

namespace relief {

/// Gives a tangent to every corner that has none, so that all corners of a triangle share w.
///
/// A corner takes the tangent that most corners of its welded vertex have (the first by value among
/// equals), among those with its triangle's w where there are any; where there is none at the
/// vertex, it gets the x axis, or if the normal is near that the y axis, turned into the plane of
/// the normal. A triangle that no sign has reached (tangent_signs.h) takes the w that it can find
/// at more of its corners, +1 before -1, and -1 where it finds none, which is what the reference
/// implementation has there. A repeated triangle copies its twin.
///
/// \return the corners that found none at their vertex; ascending
std::vector<Corner> fill_open_corners(const GroupInput& input, const GroupFindings& findings,
                                      std::span<glm::vec4> tangents);

}  // namespace relief
