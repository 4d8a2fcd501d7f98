// SPDX-License-Identifier: Apache-2.0
// Edge functions in 128-bit whole numbers, from coordinates of at most 2^60: no product or sum
// rounds. Each is 0 on its edge and grows inwards; a point is inside where all three are positive,
// or 0 on an edge that owns its points (the top-left rule of GPU rasterisers). Along a row each
// edge leaves an interval of columns, found by one division. Distances alone are in double, in an
// order that depends on nothing but the triangle. Tests: tests/mesh/bake/texel_coverage_test.cpp.
#include "bake/texel_triangle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace relief {
namespace {

constexpr int bits_of_unit_square = 28;
constexpr double farthest_texel = 0x1p33;  // Texels.

Wide floor_of(Wide numerator, Wide positive) {
    const Wide quotient = numerator / positive;
    return numerator % positive < 0 ? quotient - 1 : quotient;
}
Wide ceiling_of(Wide numerator, Wide positive) {
    return -floor_of(-numerator, positive);
}

using Point = std::array<std::int64_t, 2>;

glm::dvec2 as_double(const Point& point, double unit) {
    return {static_cast<double>(point[0]) / unit, static_cast<double>(point[1]) / unit};
}

/// How far along a segment the point nearest to `p` is, 0 to 1.
double along_segment(const glm::dvec2& p, const glm::dvec2& from, const glm::dvec2& to) {
    const glm::dvec2 edge = to - from;
    return std::clamp(glm::dot(p - from, edge) / glm::dot(edge, edge), 0.0, 1.0);
}

}  // namespace

TexelScale::TexelScale(int largest_side) : bits(bits_of_unit_square) {
    while (bits > 0 &&
           (std::int64_t{largest_side} << bits) > (std::int64_t{1} << bits_of_unit_square))
        --bits;
}

std::int64_t TexelScale::fixed(double texels) const {
    // Not std::round: its ties depend on the sign, and with it on the tile.
    return static_cast<std::int64_t>(std::floor(std::ldexp(texels, bits) + 0.5));
}

TexelTriangle::Trouble TexelTriangle::make(const std::array<glm::dvec2, 3>& texels,
                                           const TexelScale& scale, TexelTriangle& triangle) {
    std::array<Point, 3> corners{};
    for (std::size_t i = 0; i < 3; ++i) {
        if (!std::isfinite(texels[i].x) || !std::isfinite(texels[i].y)) return Trouble::not_finite;
        if (std::max(std::abs(texels[i].x), std::abs(texels[i].y)) > farthest_texel)
            return Trouble::too_far;
        corners[i] = {scale.fixed(texels[i].x), scale.fixed(texels[i].y)};
    }
    const auto doubled_area = [](const std::array<Point, 3>& c) {
        return Wide{c[1][0] - c[0][0]} * (c[2][1] - c[0][1]) -
               Wide{c[1][1] - c[0][1]} * (c[2][0] - c[0][0]);
    };
    Wide area = doubled_area(corners);
    if (area == 0) return Trouble::no_area;
    triangle.scale_ = scale;
    // Counter-clockwise triangles seen from outside are so on an unmirrored image, too: with y
    // down, that is a negative area.
    triangle.is_mirrored_ = area > 0;
    if (area < 0) {
        std::swap(corners[1], corners[2]);
        area = -area;
    }
    triangle.corners_ = corners;
    triangle.sorted_ = corners;
    std::sort(triangle.sorted_.begin(), triangle.sorted_.end());
    triangle.doubled_area_ = static_cast<double>(area);
    for (std::size_t i = 0; i < 3; ++i) {
        const Point& from = corners[(i + 1) % 3];
        const Point& to = corners[(i + 2) % 3];
        Edge& edge = triangle.edges_[i];
        edge.a = from[1] - to[1];
        edge.b = to[0] - from[0];
        edge.c = -(Wide{edge.a} * from[0] + Wide{edge.b} * from[1]);
        // Left edges (inside to the right), and level ones with the inside below.
        edge.owns_its_points = edge.a > 0 || (edge.a == 0 && edge.b > 0);
    }
    return Trouble::none;
}

Columns TexelTriangle::rows() const {
    const auto [low, high] = std::minmax({corners_[0][1], corners_[1][1], corners_[2][1]});
    return {low >> scale_.bits, (high >> scale_.bits) + 1};
}

Columns TexelTriangle::columns_where(std::int64_t row, bool whole_square) const {
    const std::int64_t one = scale_.one();
    const std::int64_t half = one / 2;
    const std::int64_t y = row * one + half;
    Wide begin = std::numeric_limits<std::int64_t>::min();
    Wide end = std::numeric_limits<std::int64_t>::max();
    if (whole_square) {
        const auto [low, high] = std::minmax({corners_[0][0], corners_[1][0], corners_[2][0]});
        const auto [top, bottom] = std::minmax({corners_[0][1], corners_[1][1], corners_[2][1]});
        if (bottom <= row * one || top >= (row + 1) * one) return {};
        begin = floor_of(low, one);
        end = ceiling_of(high, one);
    }
    for (const Edge& edge : edges_) {
        // Of column i the centre is at x = i * one + half. Positive is inside.
        Wide at_first = Wide{edge.a} * half + Wide{edge.b} * y + edge.c;
        bool or_zero = edge.owns_its_points;
        if (whole_square) {
            // At the corner of the square that is furthest inside; a mere touch is none.
            at_first += (Wide{std::abs(edge.a)} + std::abs(edge.b)) * half;
            or_zero = false;
        }
        const Wide least = or_zero ? 0 : 1;
        const Wide step = Wide{edge.a} * one;
        if (step > 0)
            begin = std::max(begin, ceiling_of(least - at_first, step));
        else if (step < 0)
            end = std::min(end, floor_of(at_first - least, -step) + 1);
        else if (at_first < least)
            return {};
    }
    if (begin >= end) return {};
    return {static_cast<std::int64_t>(begin), static_cast<std::int64_t>(end)};
}

Columns TexelTriangle::inside(std::int64_t row) const {
    return columns_where(row, false);
}

Columns TexelTriangle::touched(std::int64_t row) const {
    return columns_where(row, true);
}

glm::dvec3 TexelTriangle::in_given_order(const glm::dvec3& weights) const {
    return is_mirrored_ ? weights : glm::dvec3(weights.x, weights.z, weights.y);
}

glm::dvec3 TexelTriangle::weights(std::int64_t column, std::int64_t row) const {
    const std::int64_t half = scale_.one() / 2;
    const std::int64_t x = column * scale_.one() + half;
    const std::int64_t y = row * scale_.one() + half;
    glm::dvec3 weights;
    for (std::size_t i = 0; i < 3; ++i) {
        const Edge& edge = edges_[i];
        weights[static_cast<int>(i)] =
            static_cast<double>(Wide{edge.a} * x + Wide{edge.b} * y + edge.c) / doubled_area_;
    }
    return in_given_order(weights);
}

glm::dvec3 TexelTriangle::nearest(std::int64_t column, std::int64_t row,
                                  double& squared_distance) const {
    const auto unit = static_cast<double>(scale_.one());
    // From corners in sorted order, so that the distance does not depend on which comes first.
    const glm::dvec2 p(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
    squared_distance = std::numeric_limits<double>::infinity();
    std::array<double, 3> best{};
    for (const auto& [from, to] : {std::pair<std::size_t, std::size_t>{0, 1}, {0, 2}, {1, 2}}) {
        const glm::dvec2 a = as_double(sorted_[from], unit);
        const glm::dvec2 b = as_double(sorted_[to], unit);
        const double along = along_segment(p, a, b);
        const glm::dvec2 rest = a + along * (b - a) - p;
        if (glm::dot(rest, rest) >= squared_distance) continue;
        squared_distance = glm::dot(rest, rest);
        best = {};
        best[from] = 1.0 - along;
        best[to] = along;
    }
    glm::dvec3 weights(0.0);
    for (std::size_t i = 0; i < 3; ++i) {
        const auto place = std::find(corners_.begin(), corners_.end(), sorted_[i]);
        weights[static_cast<int>(place - corners_.begin())] = best[i];
    }
    return in_given_order(weights);
}

}  // namespace relief
