// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which vertices are near enough to count as one. Exact welding is weld.h.
/// Tests: tests/mesh/geometry/weld_near_test.cpp.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace relief {

/// For every vertex, the smallest index of one that it is joined with.
///
/// Vertices are joined if they are no further apart than `tolerance`, or joined with the same one:
/// so a chain of near ones is all one, whatever order they come in. Those that are not finite
/// are alone. Distances are taken in double.
///
/// Time: near-linear where few vertices lie within a tolerance of each other, as a tolerance for
/// seams should have it; quadratic in those that crowd at just that distance.
/// \param tolerance  finite and above 0
std::vector<std::uint32_t> weld_near_positions(std::span<const glm::vec3> positions,
                                               double tolerance);

}  // namespace relief
