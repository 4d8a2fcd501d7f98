// SPDX-License-Identifier: Apache-2.0
// Rays of view over curved surfaces, with the same steps as shaders/height_curve.glsl.
//
// With the turn B of the normal, a point at the depth d below the point u of the surface is at
// (1 - d B) u on the tangent plane, to the first order. A ray is there at x = k s and at the depth
// s on the plane. On spheres and cylinders,
//     d = s - x B y / 2 with y = (1 - (s + d) B / 2)^-1 x,
// and u is twice the angle whose tangent is B y / 2, divided by B.
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "portable_math.h"
#include "relief/mesh/height_march.h"

namespace relief {
using namespace relief::detail;

namespace {

/// The least radius of curvature, by the depth of black.
constexpr double least_radius = 2.0;

/// A point of a ray as the surface has it.
struct CurvedPoint {
    glm::dvec2 texels{0.0};  ///< From the beginning.
    double depth = 0.0;
};

/// Returns the point of a ray at a depth on the tangent plane.
CurvedPoint point_at(const glm::dvec2& k, const HeightCurvature& curvature, double s) {
    constexpr int iterations = 3;  // Each is 4 to 20 times as near.
    const glm::dvec2 x = k * s;
    const glm::dvec2 covector = curvature.metric * x;
    glm::dvec2 y = x;
    glm::dvec2 turned(0.0);
    CurvedPoint point;
    point.depth = s;
    for (int i = 0; i < iterations; ++i) {
        y = glm::inverse(glm::dmat2(1.0) - 0.5 * (s + point.depth) * curvature.turn) * x;
        turned = curvature.turn * y;
        point.depth = s - 0.5 * glm::dot(covector, turned);
    }
    // The arc tangent, as a fraction of polynomials.
    const double along = glm::dot(curvature.metric * y, turned);
    const double squared = glm::dot(curvature.metric * turned, turned);
    point.texels = y - turned * (along / (12.0 + squared));
    return point;
}

/// Returns where a ray reaches black or is deepest, whichever is first, on the tangent plane. That
/// is exact on the circle that curves as the surface does along the ray: with its curvature c and
/// the slant k, (1 - c s)^2 + c^2 k^2 s^2 = (1 - c d)^2.
double last_depth(const glm::dvec2& k, const HeightCurvature& curvature, double black_depth) {
    const glm::dvec2 covector = curvature.metric * k;
    const double slope = glm::dot(covector, curvature.turn * k);
    const double along = slope / glm::dot(covector, k);
    const double gain = black_depth * (2.0 - along * black_depth);
    const double square = 1.0 - (along + slope) * gain;
    return square < 0.0 ? 1.0 / (along + slope) : gain / (1.0 + std::sqrt(square));
}

bool is_finite_curvature(const HeightCurvature& curvature) {
    const glm::dmat2& turn = curvature.turn;
    const glm::dmat2& metric = curvature.metric;
    return std::isfinite(glm::dot(turn[0], turn[0]) + glm::dot(turn[1], turn[1]) +
                         glm::dot(metric[0], metric[0]) + glm::dot(metric[1], metric[1]));
}

}  // namespace

HeightCurvature height_curvature(const glm::dvec3& normal, const glm::dvec3& along_x,
                                 const glm::dvec3& along_y, const glm::dvec3& normal_x,
                                 const glm::dvec3& normal_y) {
    const double length = std::sqrt(glm::dot(normal, normal));
    const glm::dvec3 unit = normal / length;
    const glm::dvec3 across = glm::cross(along_x, along_y);
    const double area = glm::dot(unit, across);
    const double texel_squared = std::sqrt(glm::dot(across, across));
    const double scale = std::sqrt(texel_squared) / (length * area);
    // The part along the normal changes its length, and has no coordinates on the plane.
    const auto turn = [&](const glm::dvec3& gained) {
        return scale * glm::dvec2(glm::dot(unit, glm::cross(gained, along_y)),
                                  glm::dot(unit, glm::cross(along_x, gained)));
    };
    const glm::dvec3 x = along_x - glm::dot(along_x, unit) * unit;
    const glm::dvec3 y = along_y - glm::dot(along_y, unit) * unit;
    HeightCurvature curvature;
    curvature.turn = glm::dmat2(turn(normal_x), turn(normal_y));
    curvature.metric =
        glm::dmat2(glm::dot(x, x), glm::dot(x, y), glm::dot(x, y), glm::dot(y, y)) / texel_squared;
    return is_finite_curvature(curvature) ? curvature : HeightCurvature{};
}

CurvedHeightRay curved_ray(const HeightRay& ray, const HeightCurvature& curvature) {
    const glm::dvec2 k = glm::dvec2(ray.direction) / ray.direction.z;
    const double black_depth = ray.black_depth;
    CurvedHeightRay curved;
    curved.ray = ray;
    curved.ray.start_depth = curved.ray.bend = 0.0;
    const glm::dmat2& turn = curvature.turn;
    const double squared = glm::dot(turn[0], turn[0]) + glm::dot(turn[1], turn[1]);
    if (!(squared > 0.0) || !is_finite_curvature(curvature) || !is_finite(k)) return curved;
    HeightCurvature bounded = curvature;
    bounded.turn *= std::min(1.0, 1.0 / (least_radius * black_depth * std::sqrt(squared)));

    const double s = last_depth(k, bounded, black_depth);
    const CurvedPoint middle = point_at(k, bounded, 0.5 * s);
    const CurvedPoint end = point_at(k, bounded, s);
    // Over the share t of the way along the line, the depth is a t - b t^2.
    const glm::dvec2 covector = bounded.metric * middle.texels;
    const double middle_squared = glm::dot(covector, middle.texels);
    const double share = middle_squared / glm::dot(covector, end.texels);
    const double weight = share * (1.0 - share);
    constexpr double min_weight = 0.1;
    if (!(end.depth > 0.0) || !(middle_squared > 1e-20) || !(weight > min_weight)) return curved;
    const double b = (middle.depth - share * end.depth) / weight;
    const double a = std::max(end.depth + b, 1e-3 * end.depth);
    const double aside = s * (0.5 - share) / weight;
    curved.ray.direction = glm::dvec3(middle.texels / (share * a), 1.0);
    curved.ray.bend = b / (a * a);
    curved.plane = {(s + aside) / a, -aside / (a * a)};
    return curved;
}

}  // namespace relief
