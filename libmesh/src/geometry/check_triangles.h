// SPDX-License-Identifier: Apache-2.0
/// \file
/// The one check that triangles name vertices that exist. Linear; done before anything is computed.
/// Tests: tests/mesh/geometry/mesh_test.cpp.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <optional>
#include <span>

namespace relief {

/// The first corner, counted 3 to a triangle, that names a vertex that is not there.
std::optional<std::size_t> corner_beyond(std::span<const glm::uvec3> triangles,
                                         std::size_t vertex_count);

/// \throws InvalidInput if corners are too many for 32-bit numbers, or naming the first offence:
/// "triangle 7 names vertex 12, but there are only 8"
void check_triangles(std::span<const glm::uvec3> triangles, std::size_t vertex_count);

}  // namespace relief
