// SPDX-License-Identifier: Apache-2.0
// Solves position = origin + u * along_u + v * along_v over each triangle, for directions only.
// Tests: tests/mesh/geometry/tangents_test.cpp.
#include "geometry/texture_gradient.h"

#include <cmath>

#include "geometry/direction.h"
#include "parallel.h"

namespace relief {
namespace {

/// a - b rounded to float, as the reference implementation does, where that does not overflow. It
/// matters: where two corners are much nearer to each other than to the first, their difference is
/// all that decides the gradient, and it must be the same difference.
double float_difference(float a, float b) {
    const float difference = a - b;
    return std::isfinite(difference) ? difference : static_cast<double>(a) - b;
}

glm::dvec3 edge(const glm::vec3& from, const glm::vec3& to) {
    return {float_difference(to.x, from.x), float_difference(to.y, from.y),
            float_difference(to.z, from.z)};
}

/// An edge in the upright image, v up: the stored v grows downwards.
glm::dvec2 edge(const glm::vec2& from, const glm::vec2& to) {
    return {float_difference(to.x, from.x), float_difference(from.y, to.y)};
}

/// Products of differences are exact in double, and so is whether they cancel. (The reference
/// multiplies in float and takes what is below the smallest normal float for zero.)
Gradient gradient_of(const glm::vec3 (&p)[3], const glm::vec2 (&t)[3], glm::vec3& along_u) {
    for (int i = 0; i < 3; ++i) {
        if (!is_finite(p[i]) || !is_finite(t[i])) return Gradient::non_finite;
    }
    if (p[0] == p[1] || p[1] == p[2] || p[2] == p[0]) return Gradient::coinciding;

    const glm::dvec2 a = edge(t[0], t[1]);
    const glm::dvec2 b = edge(t[0], t[2]);
    const double area = a.x * b.y - a.y * b.x;
    if (area == 0.0) return Gradient::none;
    const glm::dvec3 along = edge(p[0], p[1]);
    const glm::dvec3 across = edge(p[0], p[2]);
    const glm::dvec3 u = b.y * along - a.y * across;  // [Mikkelsen 2008] eq. 18
    const glm::dvec3 v = a.x * across - b.x * along;  // [Mikkelsen 2008] eq. 19
    if (u == glm::dvec3(0.0) || v == glm::dvec3(0.0)) return Gradient::none;
    along_u = glm::vec3(direction_or_zero(area > 0.0 ? u : -u));
    return area > 0.0 ? Gradient::upright : Gradient::mirrored;
}

}  // namespace

TriangleGradients triangle_gradients(std::span<const glm::vec3> positions,
                                     std::span<const glm::vec2> texcoords,
                                     std::span<const glm::uvec3> triangles) {
    TriangleGradients gradients{std::vector<Gradient>(triangles.size()),
                                std::vector<glm::vec3>(triangles.size(), glm::vec3(0.0F))};
    parallel_for(triangles.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::uvec3& v = triangles[i];
            const glm::vec3 p[] = {positions[v.x], positions[v.y], positions[v.z]};
            const glm::vec2 t[] = {texcoords[v.x], texcoords[v.y], texcoords[v.z]};
            gradients.kinds[i] = gradient_of(p, t, gradients.along_u[i]);
        }
    });
    return gradients;
}

}  // namespace relief
