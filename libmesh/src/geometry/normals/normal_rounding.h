// SPDX-License-Identifier: Apache-2.0
/// \file
/// Sums of votes to unit vectors in float, where there is no doubt how they round.
///
/// A unit vector's components are rounded to multiples of 2^-28, then to float. Rounding is in
/// doubt where the true value may lie on the other side of a border between two multiples: one
/// vertex in 10,000 or fewer on usual meshes. All others get the bits that exact arithmetic would
/// give, so neither order nor rounding of the sums can show. The idea is Ziv's, for elementary
/// functions [Ziv 1991]. Tests: tests/mesh/geometry/normals/normals_test.cpp.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "geometry/normals/normal_sums.h"

namespace relief {

/// Steps of the grid that unit vectors are rounded to, in 1: 1.9e-9 at most is lost, a sixteenth of
/// what float loses next to 1.
constexpr double normal_grid = 268435456.0;

/// A unit vector on the grid, in float; -0 is +0.
glm::vec3 on_grid(double x, double y, double z);

/// Normals at all vertices, and which of them are in doubt or have none, ascending.
std::vector<std::uint32_t> round_normals(const NormalSums& sums, std::span<glm::vec3> normals);

/// Normals of groups of vertices that share theirs: group i is `members` from first[i] up to
/// first[i + 1]. \return groups that are in doubt or have none, ascending
std::vector<std::uint32_t> round_shared_normals(const NormalSums& sums,
                                                std::span<const std::uint32_t> first,
                                                std::span<const std::uint32_t> members,
                                                std::span<glm::vec3> normals);

}  // namespace relief
