// SPDX-License-Identifier: Apache-2.0
// Solves position = origin + u * along_u + v * along_v over one triangle, for any float values.
// tangent_contributions.cpp does the same for many ordinary triangles at once.
#include "geometry/texture_gradient.h"

#include <algorithm>
#include <cmath>

#include "geometry/direction.h"
#include "parallel.h"

namespace relief {
namespace {

/// Returns the texture coordinate with v upwards. Only differences matter.
glm::vec2 upright(const glm::vec2& texcoord) {
    return {texcoord.x, -texcoord.y};
}

/// Returns b - a in float, like the reference implementation, or in double if float overflows.
double float_difference(float a, float b) {
    const float difference = b - a;
    return std::isfinite(difference) ? difference : static_cast<double>(b) - a;
}

/// Two edges of a triangle from its first corner, in float, scaled by a power of two so that the
/// largest component is 1 or slightly more. No significant digit changes, and no later product
/// overflows or underflows.
template <std::size_t N>
struct Edges {
    std::array<float, N> first;
    std::array<float, N> second;
    int exponent = 0;  ///< The scale is 2^-exponent.

    explicit Edges(const glm::vec<static_cast<int>(N), float> (&corners)[3]) {
        std::array<double, N> to_second;
        std::array<double, N> to_third;
        double largest = 0.0;
        for (std::size_t i = 0; i < N; ++i) {
            const int k = static_cast<int>(i);
            to_second[i] = float_difference(corners[0][k], corners[1][k]);
            to_third[i] = float_difference(corners[0][k], corners[2][k]);
            largest = std::max({largest, std::abs(to_second[i]), std::abs(to_third[i])});
        }
        if (largest != 0.0) exponent = std::ilogb(largest);
        for (std::size_t i = 0; i < N; ++i) {
            first[i] = static_cast<float>(std::ldexp(to_second[i], -exponent));
            second[i] = static_cast<float>(std::ldexp(to_third[i], -exponent));
        }
    }
};

/// Normalizes with the operations of the reference implementation, within the range of float.
glm::vec3 float_direction(const std::array<float, 3>& axis, float sign) {
    constexpr float least = 1e-18F;  // Its square is a normal number.
    const glm::vec3 vector(axis[0], axis[1], axis[2]);
    const float length = glm::length(vector);
    return length > least ? sign / length * vector
                          : glm::vec3(double(sign) * direction_or_zero(glm::dvec3(vector)));
}

TriangleGradient gradient_of(const glm::vec3 (&p)[3], const glm::vec2 (&t)[3]) {
    for (int i = 0; i < 3; ++i) {
        if (!is_finite(p[i]) || !is_finite(t[i])) return {.kind = Gradient::non_finite};
    }
    if (p[0] == p[1] || p[1] == p[2] || p[2] == p[0]) return {.kind = Gradient::coinciding};

    const Edges<3> d(p);
    const Edges<2> s(t);
    const TextureAxes axes = texture_axes(d.first, d.second, s.first, s.second);
    constexpr std::array nowhere = {0.0F, 0.0F, 0.0F};
    if (axes.area == 0.0F || axes.u == nowhere || axes.v == nowhere) return {};
    const float sign = axes.area > 0.0F ? 1.0F : -1.0F;
    const double length = glm::length(glm::dvec3(axes.u[0], axes.u[1], axes.u[2]));
    return {.kind = axes.area > 0.0F ? Gradient::upright : Gradient::mirrored,
            .along_u = float_direction(axes.u, sign),
            .along_v = float_direction(axes.v, sign),
            .stretch = std::ldexp(length / std::abs(static_cast<double>(axes.area)),
                                  d.exponent - s.exponent)};
}

}  // namespace

TriangleGradient triangle_gradient(StridedSpan<const glm::vec3> positions,
                                   StridedSpan<const glm::vec2> texcoords,
                                   const glm::uvec3& triangle) {
    const glm::vec3 p[] = {positions[triangle.x], positions[triangle.y], positions[triangle.z]};
    const glm::vec2 t[] = {upright(texcoords[triangle.x]), upright(texcoords[triangle.y]),
                           upright(texcoords[triangle.z])};
    return gradient_of(p, t);
}

std::vector<Gradient> gradient_kinds(StridedSpan<const glm::vec3> positions,
                                     StridedSpan<const glm::vec2> texcoords,
                                     TriangleSpan triangles) {
    std::vector<Gradient> kinds(triangles.size());
    parallel_for(triangles.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            kinds[i] = triangle_gradient(positions, texcoords, triangles[i]).kind;
    });
    return kinds;
}

}  // namespace relief
