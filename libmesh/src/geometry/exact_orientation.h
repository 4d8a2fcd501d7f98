// SPDX-License-Identifier: Apache-2.0
/// \file
/// Exact tests of points in the plane whose coordinates are floats.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>
#include <limits>

namespace relief::detail {

/// The sign of a sum of doubles, exactly.
///
/// Source: [Shewchuk 1997], grow-expansion (theorem 10): the terms become a sum of doubles that do
/// not overlap, whose last nonzero one decides.
template <std::size_t count>
int sign_of_sum(const std::array<double, count>& terms) {
    std::array<double, count> expansion{};
    for (std::size_t i = 0; i < count; ++i) {
        double sum = terms[i];
        for (std::size_t j = 0; j < i; ++j) {
            // Two-sum (theorem 7).
            const double a = sum;
            const double b = expansion[j];
            sum = a + b;
            const double b_part = sum - a;
            const double a_part = sum - b_part;
            expansion[j] = (a - a_part) + (b - b_part);
        }
        expansion[i] = sum;
    }
    for (std::size_t i = count; i-- > 0;)
        if (expansion[i] != 0.0) return expansion[i] > 0.0 ? 1 : -1;
    return 0;
}

/// Returns 1 if three finite points are counter-clockwise (y up), -1 if they are clockwise, and 0
/// if they are on a line. The result is exact: products of two floats are exact in double.
inline int orientation_sign(const glm::vec2& a, const glm::vec2& b, const glm::vec2& c) {
    if (a == b || b == c || c == a) return 0;
    const glm::dvec2 p(a);
    const glm::dvec2 q(b);
    const glm::dvec2 r(c);
    const double left = (q.x - p.x) * (r.y - p.y);
    const double right = (q.y - p.y) * (r.x - p.x);
    // [Shewchuk 1997], the bound A of section 4.2.
    constexpr double epsilon = std::numeric_limits<double>::epsilon() / 2.0;
    constexpr double bound = (3.0 + 16.0 * epsilon) * epsilon;
    const double difference = left - right;
    if (std::abs(difference) > bound * (std::abs(left) + std::abs(right)))
        return difference > 0.0 ? 1 : -1;
    return sign_of_sum(
        std::array{q.x * r.y, -(q.x * p.y), -(p.x * r.y), -(q.y * r.x), q.y * p.x, p.y * r.x});
}

}  // namespace relief::detail
