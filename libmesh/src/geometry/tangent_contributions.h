// SPDX-License-Identifier: Apache-2.0
/// \file
/// The contribution of each triangle to the tangents at its corners: the direction of increasing u
/// in the plane of the corner's normal, with a weight.
///
/// Object space. Contributions are integers with an exponent, so their sums are exact and do not
/// depend on the order of addition.
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
#include "geometry/texture_gradient.h"

namespace relief::detail {
/// Weight of a triangle at a corner.
enum class TangentWeight {
    angle,    ///< Angle of the corner in the plane of the normal [Mikkelsen 2008].
    area,     ///< Area of the triangle.
    stretch,  ///< Length of a unit of u in the plane of the normal [Lengyel 2001].
};

// A projection onto the plane of the normal that is shorter than this fraction of the vector is
// rounding of the normal's floats, not a direction.
constexpr double out_of_plane = 1e-6;

// Squared cosine above which u and v count as skewed: 42 degrees from perpendicular.
constexpr double skewed_cosine_squared = 0.448;

// Bits of the largest component of a contribution.
constexpr int contribution_bits = 30;

/// Contribution of one triangle at one corner: (x, y, z) * 2^exponent. The largest component has 30
/// bits, which gives a precision of 2e-9 radians.
struct CornerContribution {
    std::int32_t x = 0;
    std::int32_t y = 0;
    std::int32_t z = 0;
    std::int16_t exponent = 0;
    /// +1 if the texture is upright, -1 if mirrored, 0 if there is no contribution.
    std::int8_t side = 0;
    /// Bit 0: u and v deviate by more than 42 degrees from perpendicular in the plane of the
    /// normal. Bit 1: the triangle faces away from the normal. Contributions of one side with equal
    /// bit 1 and no bit 0 cannot have opposite v if their u are near each other.
    std::uint8_t seen = 0;
};

// Contributions are stored in the memory of the tangents.
static_assert(sizeof(CornerContribution) == sizeof(glm::vec4));

/// Returns the direction of a vector in the plane of the normal (unit, or zero for no projection);
/// zero if undefined.
glm::dvec3 direction_in_plane(const glm::dvec3& vector, const glm::dvec3& normal);

/// \return no contribution if `vector` is zero or not finite
CornerContribution contribution_of(const glm::dvec3& vector, std::int8_t side, std::uint8_t seen);

/// Input of the tangents. Arrays by vertex have equal lengths; all values are allowed.
struct TangentInput {
    StridedSpan<const glm::vec3> positions;
    /// Any length. If undefined, tangents may have any direction.
    StridedSpan<const glm::vec3> normals;
    StridedSpan<const glm::vec2> texcoords;
    TriangleSpan triangles;
};

/// Contributions of one triangle, for any values. compute_contributions() uses this for unusual
/// triangles. For ordinary triangles both agree within 3e-7 of a contribution's length: here,
/// gradients are first rounded to float unit vectors.
struct TriangleContributionsAndKind {
    Gradient kind = Gradient::none;
    std::array<CornerContribution, 3> contributions;
};
TriangleContributionsAndKind contributions_of_any(const TangentInput& input, TangentWeight weight,
                                                  const glm::uvec3& triangle);

constexpr std::uint8_t seen_skewed = 1;
constexpr std::uint8_t seen_from_behind = 2;

inline CornerContribution contribution_at(std::span<const glm::vec4> contributions, Corner corner) {
    return std::bit_cast<CornerContribution>(contributions[corner]);
}

/// Sum of contributions, exact except for bits below the lowest bit of the largest one.
struct TangentSum {
    std::int64_t x = 0;
    std::int64_t y = 0;
    std::int64_t z = 0;
    std::int64_t longest = 0;  ///< Sum of the absolute values of the largest components.

    /// True if the sum is shorter than `fraction` of the sum of lengths.
    [[nodiscard]] bool cancels(double fraction) const {
        return !(glm::length(vector()) > fraction * static_cast<double>(longest));
    }
    [[nodiscard]] glm::dvec3 vector() const { return {double(x), double(y), double(z)}; }

    TangentSum& operator+=(const TangentSum& other) {
        x += other.x;
        y += other.y;
        z += other.z;
        longest += other.longest;
        return *this;
    }
    TangentSum& operator-=(const TangentSum& other) {
        x -= other.x;
        y -= other.y;
        z -= other.z;
        longest -= other.longest;
        return *this;
    }
    friend bool operator==(const TangentSum&, const TangentSum&) = default;
};

/// Scales contributions to one exponent for addition, with as many bits as 64-bit sums allow.
class ContributionScale {
  public:
    /// \param count  maximum number of contributions to add
    ContributionScale(int highest_exponent, std::size_t count)
        : highest_(highest_exponent),
          room_(std::max(31 - static_cast<int>(std::bit_width(count)), 0)) {}

    /// Tests whether contributions with this exponent, the lowest one, are only shifted to the
    /// left.
    [[nodiscard]] bool keeps_all_bits(int lowest_exponent) const {
        return highest_ - lowest_exponent <= room_;
    }
    /// The shift to the left of such contributions.
    [[nodiscard]] int shift_of(int exponent) const { return room_ - (highest_ - exponent); }

    [[nodiscard]] TangentSum scaled(const CornerContribution& contribution) const {
        const int below = std::min(highest_ - contribution.exponent, 63);
        const auto at = [&](std::int32_t number) {
            return static_cast<std::int64_t>(number) * (std::int64_t(1) << room_) >> below;
        };
        const TangentSum sum{at(contribution.x), at(contribution.y), at(contribution.z), 0};
        return {sum.x, sum.y, sum.z, std::max({std::abs(sum.x), std::abs(sum.y), std::abs(sum.z)})};
    }

  private:
    int highest_;
    int room_;
};

/// Texture gradients of all triangles, by kind.
struct TriangleGradients {
    std::vector<Gradient> kinds;
    std::vector<std::uint32_t> without;  ///< Triangles without a gradient; ascending.
};

/// Computes the contributions of all corners, into memory for one vec4 per corner. A triangle
/// without a gradient has none. A direction whose projection onto the plane of the normal is less
/// than 1e-6 of its length is undefined.
///
/// Computes in double precision from float input, with the same bits for every compiler and
/// instruction set.
TriangleGradients compute_contributions(const TangentInput& input, TangentWeight weight,
                                        std::span<glm::vec4> contributions);

/// Computes the same for a few triangles, with weights by angle, on this thread only.
///
/// \param contributions  memory for at least three per triangle
/// \param kinds  memory for at least one per triangle
/// \param without  gets the triangles without a gradient; ascending
void compute_contributions(const TangentInput& input, std::span<glm::vec4> contributions,
                           std::span<Gradient> kinds, std::vector<std::uint32_t>& without);

}  // namespace relief::detail
