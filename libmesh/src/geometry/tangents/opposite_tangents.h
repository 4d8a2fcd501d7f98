// SPDX-License-Identifier: Apache-2.0
/// \file
/// Sums of tangents around one vertex in which exactly opposite texture directions do not meet.
///
/// MikkTSpace's default angular threshold of 180 degrees parts only triangles whose u directions,
/// or whose v directions, point exactly against each other in the plane of the normal. It decides
/// where a texture folds back on itself, as on a wall seen along its normals. Time is that of
/// sorting. Tests: tests/mesh/geometry/tangents/opposite_tangents_test.cpp.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "geometry/tangents/tangent_votes.h"

namespace relief {

/// One triangle's share in a sum, and its texture directions in the plane of the normal, as float
/// has them: unit, or zero.
struct SidedTerm {
    VoteSum term;
    glm::vec3 along_u;
    glm::vec3 along_v;
};

/// The direction that a unit vector has in the plane of a unit normal, in float; zero where it has
/// none.
glm::vec3 float_direction_in_plane(const glm::vec3& vector, const glm::vec3& normal);

/// For every member, the sum over all members that oppose it neither in u nor in v. It does not
/// depend on the order of members.
///
/// Two directions are opposite when their cosine, in float, is not above -1: the reference
/// implementation's question, in its arithmetic, because rounding decides it. It is asked for
/// every pair, which is quadratic; so among more than 64 members directions are counted in 2^15
/// steps of a turn instead, and opposite steps are opposite.
///
/// \param normal  unit, or zero: then there are no steps, and large groups have no opposites
std::vector<VoteSum> sums_without_opposites(std::span<const SidedTerm> members,
                                            const glm::dvec3& normal);

}  // namespace relief
