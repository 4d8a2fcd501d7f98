// SPDX-License-Identifier: Apache-2.0
/// \file
/// What each triangle says about the tangents at its corners: the direction in which u grows, in
/// the plane of the corner's normal, longer the more it counts for.
///
/// Object space. Votes are integers with an exponent, so that sums of them are exact and no order
/// of adding can show. Tests: tests/mesh/geometry/tangents/tangent_votes_test.cpp.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "geometry/corners.h"
#include "geometry/tangents/texture_gradient.h"

namespace relief {

/// How much a triangle counts for at a corner.
enum class TangentWeight {
    angle,    ///< The angle of the corner as the normal sees it [Mikkelsen 2008].
    area,     ///< Its area.
    stretch,  ///< How far it stretches a unit of u, as the normal sees it [Lengyel 2001].
};

// What is left of a vector in the plane of the normal when it is less than this part of the vector
// is rounding of the normal's floats, not a direction.
constexpr double out_of_plane = 1e-6;

// The square of the cosine from which u and v count as skewed: 42 degrees from the right angle.
constexpr double skewed_cosine_squared = 0.448;

// Bits of a vote's largest number.
constexpr int vote_bits = 30;

/// One triangle's vote at one corner: (x, y, z) * 2^exponent. The largest of the three numbers has
/// 30 bits, which leaves 2e-9 radians.
struct CornerVote {
    std::int32_t x = 0;
    std::int32_t y = 0;
    std::int32_t z = 0;
    std::int16_t exponent = 0;
    std::int8_t side = 0;  ///< +1 where the texture is upright, -1 where mirrored; 0: no vote.
    /// Bit 0: u and v are more than 42 degrees away from being perpendicular, seen along the
    /// normal. Bit 1: the normal sees the triangle's back. Votes of one side that are all seen
    /// alike, and not skewed, cannot have opposite v where their u are near each other.
    std::uint8_t seen = 0;
};

// Votes are kept where the tangents will be.
static_assert(sizeof(CornerVote) == sizeof(glm::vec4));

/// The direction that a vector has in the plane of the normal (unit, or zero for all of space);
/// zero where it has none.
glm::dvec3 direction_in_plane(const glm::dvec3& vector, const glm::dvec3& normal);

/// \return no vote where `vector` is zero or not finite
CornerVote vote_of(const glm::dvec3& vector, std::int8_t side, std::uint8_t seen);

/// What tangents are made from. Equally long by vertex; values of any kind.
struct TangentInput {
    std::span<const glm::vec3> positions;
    std::span<const glm::vec3> normals;  ///< Any length; without a direction: tangents are free.
    std::span<const glm::vec2> texcoords;
    std::span<const glm::uvec3> triangles;
};

/// The votes of one triangle, whatever its numbers are: what cast_votes() does with triangles that
/// are not ordinary. Others have the same from both within 3e-7 of a vote's length: here, gradients
/// are unit vectors of floats first.
struct TriangleVotesAndKind {
    Gradient kind = Gradient::none;
    std::array<CornerVote, 3> votes;
};
TriangleVotesAndKind careful_votes(const TangentInput& input, TangentWeight weight,
                                   const glm::uvec3& triangle);

constexpr std::uint8_t seen_skewed = 1;
constexpr std::uint8_t seen_from_behind = 2;

inline CornerVote vote_at(std::span<const glm::vec4> votes, Corner corner) {
    return std::bit_cast<CornerVote>(votes[corner]);
}

/// A sum of votes, exact up to what falls below the least bit of the largest.
struct VoteSum {
    std::int64_t x = 0;
    std::int64_t y = 0;
    std::int64_t z = 0;
    std::int64_t longest = 0;  ///< Of the votes' largest numbers, without their signs.

    /// The votes cancel to less than `fraction` of what they are.
    [[nodiscard]] bool cancels(double fraction) const {
        return !(glm::length(vector()) > fraction * static_cast<double>(longest));
    }
    [[nodiscard]] glm::dvec3 vector() const { return {double(x), double(y), double(z)}; }

    VoteSum& operator+=(const VoteSum& other) {
        x += other.x;
        y += other.y;
        z += other.z;
        longest += other.longest;
        return *this;
    }
    VoteSum& operator-=(const VoteSum& other) {
        x -= other.x;
        y -= other.y;
        z -= other.z;
        longest -= other.longest;
        return *this;
    }
    friend bool operator==(const VoteSum&, const VoteSum&) = default;
};

/// Brings votes to one exponent, so that they can be added: as many bits as 64 have room for.
class VoteScale {
  public:
    /// \param count  how many votes will be added at most
    VoteScale(int highest_exponent, std::size_t count)
        : highest_(highest_exponent),
          room_(std::max(31 - static_cast<int>(std::bit_width(count)), 0)) {}

    [[nodiscard]] VoteSum scaled(const CornerVote& vote) const {
        const int below = std::min(highest_ - vote.exponent, 63);
        const auto at = [&](std::int32_t number) {
            return static_cast<std::int64_t>(number) * (std::int64_t(1) << room_) >> below;
        };
        const VoteSum sum{at(vote.x), at(vote.y), at(vote.z), 0};
        return {sum.x, sum.y, sum.z, std::max({std::abs(sum.x), std::abs(sum.y), std::abs(sum.z)})};
    }

  private:
    int highest_;
    int room_;
};

}  // namespace relief
