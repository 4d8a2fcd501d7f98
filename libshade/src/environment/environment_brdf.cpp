// SPDX-License-Identifier: Apache-2.0
// Directional albedo of GGX, by the mean over facets that the eye sees [Heitz 2018]: then the only
// weight is the share of light that is not shadowed, which is at most 1, and an even grid of points
// converges fast. See environment_brdf.h. Tests:
// tests/shade/environment/environment_brdf_test.cpp.
#include "environment/environment_brdf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "parallel.h"
#include "relief/mesh/error.h"

namespace relief {

namespace {

/// Points of the half disc of visible facets, from its rim to its middle and round it.
constexpr int radial_points = 32;
constexpr int turn_points = 6;

/// Smith's Lambda: masked facets for each visible one.
double masked(double cosine, double alpha) {
    const double tan_squared = (1.0 - cosine * cosine) / (cosine * cosine);
    return 0.5 * (std::sqrt(1.0 + alpha * alpha * tan_squared) - 1.0);
}

/// A facet normal that is seen from `view` (in the xz plane), for a point of a half disc: radius
/// and turn from -pi/2 to pi/2; the other half is its mirror image.
glm::dvec3 seen_facet(const glm::dvec3& view, double alpha, double radius, double turn) {
    // The surface stretched so that it becomes a hemisphere; y is one of the axes across the view.
    const glm::dvec3 stretched = glm::normalize(glm::dvec3(alpha * view.x, 0.0, view.z));
    const glm::dvec3 up(-stretched.z, 0.0, stretched.x);
    const double across = radius * std::cos(turn);
    const double visible = 0.5 * (1.0 + stretched.z);
    const double along =
        (1.0 - visible) * std::sqrt(1.0 - across * across) + visible * radius * std::sin(turn);
    const double towards = std::sqrt(std::max(0.0, 1.0 - across * across - along * along));
    const glm::dvec3 facet = glm::dvec3(0.0, across, 0.0) + along * up + towards * stretched;
    return glm::normalize(glm::dvec3(alpha * facet.x, alpha * facet.y, std::max(0.0, facet.z)));
}

double power_5(double x) {
    return x * x * x * x * x;
}

}  // namespace

glm::dvec2 environment_brdf(double n_v, double roughness) {
    const glm::dvec3 view(std::sqrt(1.0 - n_v * n_v), 0.0, n_v);
    const double alpha = roughness * roughness;
    const double masked_view = masked(n_v, alpha);
    glm::dvec2 sum(0.0);
    for (int i = 0; i < radial_points; ++i) {
        // At the rim, facets change with the root of the distance to it: even steps of the root.
        const double root = (i + 0.5) / radial_points;
        const double radius = std::sqrt(1.0 - root * root);
        for (int j = 0; j < turn_points; ++j) {
            const double turn = std::numbers::pi * ((j + 0.5) / turn_points - 0.5);
            const glm::dvec3 half = seen_facet(view, alpha, radius, turn);
            const double v_h = glm::dot(view, half);
            const double n_l = 2.0 * v_h * half.z - view.z;
            if (n_l <= 0.0) continue;
            const double seen_of_lit =
                (1.0 + masked_view) / (1.0 + masked_view + masked(std::min(n_l, 1.0), alpha));
            const double fresnel = power_5(1.0 - std::min(v_h, 1.0));
            sum += 2.0 * root * seen_of_lit * glm::dvec2(1.0 - fresnel, fresnel);
        }
    }
    return sum / static_cast<double>(radial_points * turn_points);
}

Image environment_brdf_table(int size) {
    if (size < 1) throw InvalidInput(fmt::format("a table of {} values a side is asked for", size));
    Image table = make_image(size, size, 2, 32, ColorSpace::data);
    const auto samples = table.as<float>();
    parallel_for(static_cast<std::size_t>(size), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y) {
            for (std::size_t x = 0; x < static_cast<std::size_t>(size); ++x) {
                const glm::dvec2 share =
                    (glm::dvec2(static_cast<double>(x), static_cast<double>(y)) + 0.5) /
                    static_cast<double>(size);
                const glm::dvec2 albedo = environment_brdf(share.x, share.y);
                const std::size_t texel = y * static_cast<std::size_t>(size) + x;
                samples[2 * texel] = static_cast<float>(albedo.x);
                samples[2 * texel + 1] = static_cast<float>(albedo.y);
            }
        }
    });
    return table;
}

}  // namespace relief
