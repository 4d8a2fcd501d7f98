// SPDX-License-Identifier: Apache-2.0
/// \file
/// The heights of a HeightField with the maxima of their patches, and the intersection of a ray
/// with one patch.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "image/bilinear_heights.h"

namespace relief::detail {

/// The depth along a ray that goes down: start + s - bend s^2 after the way s.
struct BentDepth {
    double start = 0.0;
    double bend = 0.0;

    [[nodiscard]] double at(double way) const { return start + (1.0 - bend * way) * way; }
    [[nodiscard]] double rate(double way) const { return 1.0 - 2.0 * bend * way; }
    /// Returns the way to a depth that is not above the start; infinite if it is never reached.
    [[nodiscard]] double way_to(double depth) const {
        const double gain = depth - start;
        const double square = 1.0 - 4.0 * bend * gain;
        if (square < 0.0) return std::numeric_limits<double>::infinity();
        return 2.0 * gain / (1.0 + std::sqrt(square));
    }
    /// Returns the way to the surface of white, if the bend is positive.
    [[nodiscard]] double way_out() const {
        return (1.0 + std::sqrt(1.0 + 4.0 * bend * start)) / (2.0 * bend);
    }
    /// Returns the largest depth between two ways.
    [[nodiscard]] double deepest(double from, double to) const {
        return at(bend > 0.0 ? std::clamp(0.5 / bend, from, to) : to);
    }
};

/// The maxima of square groups of patches. A patch has the number of its upper left texel.
struct MaximumLevel {
    int width = 0;
    int height = 0;
    std::vector<float> maxima;

    [[nodiscard]] float at(int column, int row) const {
        return maxima[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(column)];
    }
};

struct HeightFieldData {
    BilinearHeights heights;
    /// Level 0 has the maximum of each patch. A node of level n covers 2^n x 2^n patches; each
    /// level has the size of the map divided by 2^n, rounded down but at least 1, as mip levels
    /// have. The last nodes of a row or column also cover the patches that remain.
    std::vector<MaximumLevel> levels;
};

/// Returns the levels for HeightFieldData, down to one node.
std::vector<MaximumLevel> maximum_levels(const BilinearHeights& heights);

/// Returns a coordinate in texels from the center of the first one, less whole periods of the map.
inline double near_map(double texcoord, int count, Wrap wrap) {
    const double texels = texcoord * count - 0.5;
    if (wrap == Wrap::clamp) {
        // No ray is long enough to come from there to the map.
        constexpr double far_away = 0x1p40;
        return std::clamp(texels, -far_away, far_away);
    }
    const double period = wrap == Wrap::mirror ? 2.0 * count : count;
    return texels - period * std::floor(texels / period);
}

/// Returns where a ray is first not above a patch: the smallest t from 0 on, or infinity.
///
/// \param within  the beginning of the ray in the patch, from 0 to 1
/// \param direction  texels per t: right, down, and into the depth
/// \param start_depth  the depth at t = 0
/// \param bend  the depth of a bent ray at t is less by bend t^2
///
/// With the heights A, B (right), C (below) and E of the corners, K = A - B - C + E and the point
/// (a, b), the height is A + (B - A) a + (C - A) b + K a b. The ray is above the surface by
/// q2 t^2 + q1 t + q0, where q2 = -D K dx dy + bend, q0 = D (1 - h(a, b)) - s and
/// q1 = -dz - D ((B - A + K b) dx + (C - A + K a) dy).
inline double patch_hit(const BilinearPatch& patch, const glm::dvec2& within,
                        const glm::dvec3& direction, double start_depth, double black_depth,
                        double bend = 0.0) {
    constexpr double never = std::numeric_limits<double>::infinity();
    const double above = black_depth * (1.0 - patch.at(within.x, within.y)) - start_depth;
    if (above <= 0.0) return 0.0;
    const glm::dvec2 slope = patch.slope(within.x, within.y);
    const double square = bend - black_depth * patch.twist() * direction.x * direction.y;
    const double linear =
        -direction.z - black_depth * (slope.x * direction.x + slope.y * direction.y);
    const double discriminant = linear * linear - 4.0 * square * above;
    if (discriminant < 0.0) return never;
    // The smaller of the positive roots, without the difference of nearly equal numbers.
    if (linear < 0.0) return 2.0 * above / (std::sqrt(discriminant) - linear);
    if (square < 0.0) return -(linear + std::sqrt(discriminant)) / (2.0 * square);
    return never;
}

}  // namespace relief::detail
