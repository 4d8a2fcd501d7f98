// SPDX-License-Identifier: Apache-2.0
// Directional albedo of GGX, by the mean over facets that the eye sees [Heitz 2018]: then the only
// weight is the share of light that is not shadowed, which is at most 1, and an even grid of points
// converges fast. See environment_brdf.h. Tests:
// tests/shade/environment/environment_brdf_test.cpp.
#include "environment/environment_brdf.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
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

/// A point of the half disc of visible facets; the other half is its mirror image.
struct DiscPoint {
    double across;     ///< Along the axis that is perpendicular to the view and the normal.
    double along;      ///< Along the other one.
    double half_edge;  ///< Of the disc at `across`.
    double weight;     ///< The share of the disc that it stands for.
};

const std::array<DiscPoint, radial_points * turn_points>& disc_points() {
    static const auto points = [] {
        std::array<DiscPoint, radial_points * turn_points> all{};
        for (int i = 0; i < radial_points; ++i) {
            // At the rim, facets change with the root of the distance to it: even steps of the
            // root.
            const double root = (i + 0.5) / radial_points;
            const double radius = std::sqrt(1.0 - root * root);
            for (int j = 0; j < turn_points; ++j) {
                const double turn = std::numbers::pi * ((j + 0.5) / turn_points - 0.5);
                const double across = radius * std::cos(turn);
                all.at(static_cast<std::size_t>(i * turn_points + j)) = {
                    across, radius * std::sin(turn), std::sqrt(1.0 - across * across),
                    2.0 * root / (radial_points * turn_points)};
            }
        }
        return all;
    }();
    return points;
}

/// Facet normals that are seen from a direction in the xz plane.
class SeenFacets {
  public:
    SeenFacets(const glm::dvec3& view, double alpha)
        : alpha_(alpha),
          // The surface stretched so that its facets become a hemisphere.
          stretched_(glm::normalize(glm::dvec3(alpha * view.x, 0.0, view.z))),
          visible_(0.5 * (1.0 + stretched_.z)) {}

    [[nodiscard]] glm::dvec3 at(const DiscPoint& point) const {
        const double along = (1.0 - visible_) * point.half_edge + visible_ * point.along;
        const double towards =
            std::sqrt(std::max(0.0, point.half_edge * point.half_edge - along * along));
        const glm::dvec3 facet(towards * stretched_.x - along * stretched_.z, point.across,
                               towards * stretched_.z + along * stretched_.x);
        return glm::normalize(
            glm::dvec3(alpha_ * facet.x, alpha_ * facet.y, std::max(0.0, facet.z)));
    }

  private:
    double alpha_;
    glm::dvec3 stretched_;
    double visible_;  ///< Share of the disc on this side of the horizon, at its middle.
};

double power_5(double x) {
    return x * x * x * x * x;
}

}  // namespace

glm::dvec2 environment_brdf(double n_v, double roughness) {
    const glm::dvec3 view(std::sqrt(1.0 - n_v * n_v), 0.0, n_v);
    const double alpha = roughness * roughness;
    const double masked_view = masked(n_v, alpha);
    const SeenFacets facets(view, alpha);
    glm::dvec2 sum(0.0);
    for (const DiscPoint& point : disc_points()) {
        const glm::dvec3 half = facets.at(point);
        const double v_h = glm::dot(view, half);
        const double n_l = 2.0 * v_h * half.z - view.z;
        if (n_l <= 0.0) continue;
        const double lit_of_seen =
            (1.0 + masked_view) / (1.0 + masked_view + masked(std::min(n_l, 1.0), alpha));
        const double fresnel = power_5(1.0 - std::min(v_h, 1.0));
        sum += point.weight * lit_of_seen * glm::dvec2(1.0 - fresnel, fresnel);
    }
    return sum;
}

Image environment_brdf_table(int size) {
    if (size < 2) throw InvalidInput(fmt::format("a table of {} values a side is asked for", size));
    // Seen from exactly aside, nothing is defined; from almost there, it is the limit.
    constexpr double grazing = 1e-6;
    const auto count = static_cast<std::size_t>(size);
    Image table = make_image(size, size, 2, 32, ColorSpace::data);
    const auto samples = table.as<float>();
    parallel_for(count, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y) {
            for (std::size_t x = 0; x < count; ++x) {
                const double root = static_cast<double>(x) / (size - 1);
                const double roughness = static_cast<double>(y) / (size - 1);
                const glm::dvec2 albedo =
                    environment_brdf(std::max(root * root, grazing), roughness);
                samples[2 * (y * count + x)] = static_cast<float>(albedo.x);
                samples[2 * (y * count + x) + 1] = static_cast<float>(albedo.y);
            }
        }
    });
    return table;
}

}  // namespace relief
