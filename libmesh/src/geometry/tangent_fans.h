// SPDX-License-Identifier: Apache-2.0
/// \file
/// The tangents of usual vertices: one fan of triangles, one handedness, and texture directions
/// near each other, so that all corners share the sum of the contributions. tangent_groups.cpp
/// handles all other vertices, and gives the same bits for these.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>

#include "geometry/corners.h"
#include "geometry/direction.h"
#include "geometry/gather.h"
#include "geometry/tangent_contributions.h"
#include "geometry/tangent_signs.h"
#include "portable_math.h"

namespace relief::detail {

/// Plane of a vertex's tangents, or all of space if its normal has no direction.
class TangentPlane {
  public:
    TangentPlane() = default;
    explicit TangentPlane(const glm::vec3& normal) : normal_(normal) {
        const double square = glm::dot(normal_, normal_);
        if (square > 0.0 && std::isfinite(square))
            per_square_ = 1.0 / square;
        else
            normal_ = glm::dvec3(0.0);
    }

    /// Returns the normal: unit length or zero.
    [[nodiscard]] glm::dvec3 normal() const { return std::sqrt(per_square_) * normal_; }

    /// Returns the direction of a sum of tangents in the plane.
    [[nodiscard]] glm::vec3 tangent_along(const glm::dvec3& sum) const {
        const glm::dvec3 projected = sum - (glm::dot(normal_, sum) * per_square_) * normal_;
        const double square = glm::dot(projected, projected);
        return square > 0.0 ? rounded(1.0 / std::sqrt(square) * projected) : glm::vec3(0.0F);
    }

  private:
    glm::dvec3 normal_{0.0};
    double per_square_ = 0.0;
};

/// Averages the usual vertices, one at a time.
class FanAverager {
  public:
    /// \param contributions  three for each of the triangles
    /// \param triangles  with indices of welded vertices
    FanAverager(std::span<const glm::vec4> contributions, const TriangleSpan& triangles)
        : contributions_(contributions),
          triangles_(triangles),
          indices_(triangles.longs() != nullptr ? &triangles.longs()->x : nullptr) {}

    /// Computes the tangent of all corners at a vertex. Returns false if the vertex is not usual.
    ///
    /// \param around  all corners at the vertex, at least one
    [[nodiscard]] bool average(std::span<const Corner> around, const TangentPlane& plane,
                               glm::vec4& tangent) {
        if (around.size() > max_single_fan) return false;
        const auto count = static_cast<std::uint32_t>(around.size());
        // The members of a contribution after the exponent: side and seen.
        const auto kind_of = [](const FourInts& contribution) { return contribution[3] >> 16; };
        const FourInts first = std::bit_cast<FourInts>(contributions_[around[0]]);
        const CornerContribution first_corner = contribution_at(contributions_, around[0]);
        if (first_corner.side == 0 || (first_corner.seen & seen_skewed) != 0) return false;
        int highest = std::numeric_limits<int>::min();
        int lowest = std::numeric_limits<int>::max();
        std::int32_t differences = 0;
        for (std::uint32_t i = 0; i < count; ++i) {
            const Corner corner = around[i];
            const FourInts contribution = std::bit_cast<FourInts>(contributions_[corner]);
            fan_[i] = contribution;
            differences |= kind_of(contribution) ^ kind_of(first);
            const int exponent = static_cast<std::int16_t>(contribution[3] & 0xFFFF);
            highest = std::max(highest, exponent);
            lowest = std::min(lowest, exponent);
            next_[i] = index_of(next_in_triangle(corner));
            previous_[i] = index_of(previous_in_triangle(corner));
        }
        // Completes the last four.
        for (std::uint32_t i = count; i % 4 != 0; ++i)
            fan_[i] = first;
        const ContributionScale scale(highest, count);
        if (differences != 0 || !scale.keeps_all_bits(lowest) || !are_near(count) ||
            !is_single_fan(next_, previous_, count))
            return false;
        FourLongs sum{};
        for (std::uint32_t i = 0; i < count; ++i) {
            const int exponent = static_cast<std::int16_t>(fan_[i][3] & 0xFFFF);
            sum += __builtin_convertvector(fan_[i], FourLongs) << scale.shift_of(exponent);
        }
        const glm::dvec3 vector(static_cast<double>(sum[0]), static_cast<double>(sum[1]),
                                static_cast<double>(sum[2]));
        tangent = glm::vec4(plane.tangent_along(vector), static_cast<float>(first_corner.side));
        return true;
    }

  private:
    // Four integers for sums.
    using FourLongs = Vector<std::int64_t, 32>;

    /// Tests whether all contributions of the fan are within 42 degrees of the first. The last four
    /// are complete.
    [[nodiscard]] bool are_near(std::uint32_t count) const {
        // Squared cosine of 42 degrees. If all u directions are nearer than this to one of them,
        // they are within 84 degrees of each other, and v directions that are not skewed are within
        // 168. In float: its rounding is far less than the margin.
        constexpr float near_cosine_squared = 0.553F;
        const auto x = static_cast<float>(fan_[0][0]);
        const auto y = static_cast<float>(fan_[0][1]);
        const auto z = static_cast<float>(fan_[0][2]);
        const float limit = near_cosine_squared * (x * x + y * y + z * z);
        FourInts far{};
        for (std::uint32_t i = 0; i < count; i += 4) {
            FourInts a = fan_[i], b = fan_[i + 1], c = fan_[i + 2], d = fan_[i + 3];
            transpose(a, b, c, d);
            const FourFloats ax = __builtin_convertvector(a, FourFloats);
            const FourFloats ay = __builtin_convertvector(b, FourFloats);
            const FourFloats az = __builtin_convertvector(c, FourFloats);
            const FourFloats product = x * ax + y * ay + z * az;
            const FourFloats square = ax * ax + ay * ay + az * az;
            far |= product <= 0.0F;
            far |= product * product <= limit * square;
        }
        return (far[0] | far[1] | far[2] | far[3]) == 0;
    }

    /// The vertex of a corner.
    [[nodiscard]] std::uint32_t index_of(Corner corner) const {
        return indices_ != nullptr ? indices_[corner] : vertex_of(corner, triangles_);
    }

    std::span<const glm::vec4> contributions_;
    TriangleSpan triangles_;
    const std::uint32_t* indices_;  ///< Null if they have 16 bits.
    std::array<FourInts, max_single_fan> fan_;
    FanVertices next_{};
    FanVertices previous_{};
};

}  // namespace relief::detail
