// SPDX-License-Identifier: Apache-2.0
// Votes one by one, safe for every number that a float can be. tangent_vote_blocks.cpp does the
// same for many ordinary triangles at once. Tests:
// tests/mesh/geometry/tangents/tangent_votes_test.cpp.
#include "geometry/tangents/tangent_votes.h"

#include <cmath>
#include <numbers>

#include "geometry/corner_angle.h"
#include "geometry/direction.h"

namespace relief {
namespace {

// A corner without angle or area still has a direction, which counts where there is no other: less
// than any weight that floats can come to.
constexpr double least_weight = 1e-200;

/// The angle of the corner as the normal sees it. An edge along the normal points nowhere in its
/// plane; the reference implementation counts such a corner as a right angle.
double seen_angle(const glm::dvec3& here, const glm::dvec3& next, const glm::dvec3& previous,
                  const glm::dvec3& normal) {
    const glm::dvec3 a = direction_in_plane(next - here, normal);
    const glm::dvec3 b = direction_in_plane(previous - here, normal);
    if (a == glm::dvec3(0.0) || b == glm::dvec3(0.0)) return std::numbers::pi / 2.0;
    return upper_angle(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

}  // namespace

glm::dvec3 direction_in_plane(const glm::dvec3& vector, const glm::dvec3& normal) {
    const glm::dvec3 projected = in_plane(vector, normal);
    return glm::length(projected) > out_of_plane * glm::length(vector)
               ? direction_or_zero(projected)
               : glm::dvec3(0.0);
}

CornerVote vote_of(const glm::dvec3& vector, std::int8_t side, std::uint8_t seen) {
    const double largest = std::max({std::abs(vector.x), std::abs(vector.y), std::abs(vector.z)});
    if (!(largest > 0.0) || !std::isfinite(largest)) return {};
    const int exponent = std::ilogb(largest) - (vote_bits - 1);
    const auto scaled = [&](double number) {
        return static_cast<std::int32_t>(std::ldexp(number, -exponent));
    };
    return {scaled(vector.x),
            scaled(vector.y),
            scaled(vector.z),
            static_cast<std::int16_t>(exponent),
            side,
            seen};
}

TriangleVotesAndKind careful_votes(const TangentInput& input, TangentWeight weight,
                                   const glm::uvec3& triangle) {
    const TriangleGradient gradient = triangle_gradient(input.positions, input.texcoords, triangle);
    TriangleVotesAndKind result{gradient.kind, {}};
    if (!has_gradient(gradient.kind)) return result;
    const std::int8_t side = gradient.kind == Gradient::upright ? 1 : -1;
    for (int k = 0; k < 3; ++k) {
        const glm::dvec3 here(input.positions[triangle[k]]);
        const glm::dvec3 next(input.positions[triangle[(k + 1) % 3]]);
        const glm::dvec3 previous(input.positions[triangle[(k + 2) % 3]]);
        const glm::dvec3 normal = direction_or_zero(glm::dvec3(input.normals[triangle[k]]));
        const glm::dvec3 u(gradient.along_u);
        const glm::dvec3 along_u = direction_in_plane(u, normal);
        const glm::dvec3 along_v = direction_in_plane(glm::dvec3(gradient.along_v), normal);
        double length = 1.0;
        switch (weight) {
            case TangentWeight::angle:
                length = seen_angle(here, next, previous, normal);
                break;
            case TangentWeight::area:
                length = 0.5 * glm::length(glm::cross(next - here, previous - here));
                break;
            case TangentWeight::stretch:
                length = gradient.stretch * glm::length(in_plane(u, normal));
                break;
        }
        const double cosine = glm::dot(along_u, along_v);
        const bool faces = glm::dot(glm::cross(next - here, previous - here), normal) > 0.0;
        const bool skewed =
            !(cosine * cosine < skewed_cosine_squared) || along_v == glm::dvec3(0.0);
        const int seen = (skewed ? seen_skewed : 0) | (faces ? 0 : seen_from_behind);
        result.votes[static_cast<std::size_t>(k)] = vote_of(
            std::max(length, least_weight) * along_u, side, static_cast<std::uint8_t>(seen));
    }
    return result;
}

}  // namespace relief
