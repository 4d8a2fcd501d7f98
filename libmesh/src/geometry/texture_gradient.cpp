// SPDX-License-Identifier: Apache-2.0
// Solves position = origin + u * along_u + v * along_v over each triangle, for directions only.
// Tests: tests/mesh/geometry/tangents_test.cpp.
#include "geometry/texture_gradient.h"

#include <algorithm>
#include <cmath>

#include "geometry/direction.h"
#include "parallel.h"

namespace relief {
namespace {

/// A texture coordinate with v up; only differences count, so its origin may be anywhere.
glm::vec2 upright(const glm::vec2& texcoord) {
    return {texcoord.x, -texcoord.y};
}

/// b - a in float, as the reference implementation has it, or in double where that overflows.
double float_difference(float a, float b) {
    const float difference = b - a;
    return std::isfinite(difference) ? difference : static_cast<double>(b) - a;
}

/// Two edges of a triangle from its first corner, in float, multiplied by a power of two that
/// brings them near to 1 where they are far from it: no digit changes, and no later product can
/// overflow or vanish.
template <int N>
struct Edges {
    glm::vec<N, float> first;
    glm::vec<N, float> second;

    explicit Edges(const glm::vec<N, float> (&corners)[3]) {
        glm::vec<N, double> to_second;
        glm::vec<N, double> to_third;
        double largest = 0.0;
        for (int i = 0; i < N; ++i) {
            to_second[i] = float_difference(corners[0][i], corners[1][i]);
            to_third[i] = float_difference(corners[0][i], corners[2][i]);
            largest = std::max({largest, std::abs(to_second[i]), std::abs(to_third[i])});
        }
        const bool is_near_one = largest > 0x1p-15 && largest < 0x1p15;
        const double factor =
            is_near_one || largest == 0.0 ? 1.0 : std::ldexp(1.0, -std::ilogb(largest));
        first = glm::vec<N, float>(to_second * factor);
        second = glm::vec<N, float>(to_third * factor);
    }
};

/// In float, with the operations of the reference implementation in their order. Where float
/// decides anything here, it has to decide the same: on slivers its rounding is the result. The
/// sign of the area is nevertheless exact, since rounding keeps the order of the two products; it
/// is 0 where they round to the same.
Gradient gradient_of(const glm::vec3 (&p)[3], const glm::vec2 (&t)[3], glm::vec3& along_u,
                     glm::vec3& along_v) {
    for (int i = 0; i < 3; ++i) {
        if (!is_finite(p[i]) || !is_finite(t[i])) return Gradient::non_finite;
    }
    if (p[0] == p[1] || p[1] == p[2] || p[2] == p[0]) return Gradient::coinciding;

    const Edges<3> d(p);
    const Edges<2> s(t);
    const float area = s.first.x * s.second.y - s.first.y * s.second.x;
    if (area == 0.0F) return Gradient::none;
    const glm::vec3 u = s.second.y * d.first - s.first.y * d.second;   // [Mikkelsen 2008] eq. 18
    const glm::vec3 v = -s.second.x * d.first + s.first.x * d.second;  // [Mikkelsen 2008] eq. 19
    if (u == glm::vec3(0.0F) || v == glm::vec3(0.0F)) return Gradient::none;
    const float sign = area > 0.0F ? 1.0F : -1.0F;
    along_u = sign / glm::length(u) * u;
    along_v = sign / glm::length(v) * v;
    return area > 0.0F ? Gradient::upright : Gradient::mirrored;
}

}  // namespace

TriangleGradients triangle_gradients(std::span<const glm::vec3> positions,
                                     std::span<const glm::vec2> texcoords,
                                     std::span<const glm::uvec3> triangles) {
    TriangleGradients gradients{std::vector<Gradient>(triangles.size()),
                                std::vector<glm::vec3>(triangles.size(), glm::vec3(0.0F)),
                                std::vector<glm::vec3>(triangles.size(), glm::vec3(0.0F))};
    parallel_for(triangles.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::uvec3& v = triangles[i];
            const glm::vec3 p[] = {positions[v.x], positions[v.y], positions[v.z]};
            const glm::vec2 t[] = {upright(texcoords[v.x]), upright(texcoords[v.y]),
                                   upright(texcoords[v.z])};
            gradients.kinds[i] = gradient_of(p, t, gradients.along_u[i], gradients.along_v[i]);
        }
    });
    return gradients;
}

}  // namespace relief
