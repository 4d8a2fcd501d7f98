// SPDX-License-Identifier: Apache-2.0
// GGX, points to sample it with, and its directional albedo. The albedo is the mean over the facets
// that the eye sees [Heitz 2018]: the only weight is then the share of light that is not shadowed,
// which is at most 1, and an even grid of points converges fast. Nothing here divides by zero for
// alpha above 0 and cosines above 0.
#include "environment/ggx.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "parallel.h"
#include "relief/mesh/report.h"

namespace relief {

// The distribution

double ggx_distribution(double n_h, double alpha) {
    const double squared = alpha * alpha;
    // 1 + n.h^2 (alpha^2 - 1), as a sum of positive terms.
    const double spread = (1.0 - n_h) * (1.0 + n_h) + n_h * n_h * squared;
    return squared / (std::numbers::pi * spread * spread);
}

double ggx_visibility(double n_l, double n_v, double alpha) {
    const double squared = alpha * alpha;
    const double towards_l = n_v * std::sqrt(n_l * n_l * (1.0 - squared) + squared);
    const double towards_v = n_l * std::sqrt(n_v * n_v * (1.0 - squared) + squared);
    return 0.5 / (towards_l + towards_v);
}

glm::dvec2 hammersley(unsigned i, unsigned n) {
    std::uint32_t bits = i;
    bits = (bits << 16U) | (bits >> 16U);
    bits = ((bits & 0x00ff00ffU) << 8U) | ((bits & 0xff00ff00U) >> 8U);
    bits = ((bits & 0x0f0f0f0fU) << 4U) | ((bits & 0xf0f0f0f0U) >> 4U);
    bits = ((bits & 0x33333333U) << 2U) | ((bits & 0xccccccccU) >> 2U);
    bits = ((bits & 0x55555555U) << 1U) | ((bits & 0xaaaaaaaaU) >> 1U);
    return {(i + 0.5) / n, bits * 0x1p-32 + 0.5 / n};
}

glm::dvec3 ggx_facet(const glm::dvec2& point, double alpha) {
    // tan^2 of the angle to the normal within which this share of facets lies.
    const double tan_squared = alpha * alpha * point.x / (1.0 - point.x);
    const double cosine = 1.0 / std::sqrt(1.0 + tan_squared);
    const double sine = std::sqrt(tan_squared) * cosine;
    const double angle = 2.0 * std::numbers::pi * point.y;
    return {sine * std::cos(angle), sine * std::sin(angle), cosine};
}

// Directional albedo

namespace {

/// The grid on the half disk of visible facets: points along a radius and points along an arc.
constexpr int radial_points = 32;
constexpr int arc_points = 6;

/// Smith's Lambda: the ratio of masked to visible facets.
double masked(double cosine, double alpha) {
    const double tan_squared = (1.0 - cosine * cosine) / (cosine * cosine);
    return 0.5 * (std::sqrt(1.0 + alpha * alpha * tan_squared) - 1.0);
}

/// A point of the half disk of visible facets; the other half is its mirror image.
struct DiscPoint {
    double across;     ///< Along the axis that is perpendicular to the view and the
                       ///< normal.
    double along;      ///< Along the other axis of the disk.
    double half_edge;  ///< Half the width of the disk at `across`.
    double weight;     ///< The share of the disk that the point represents.
};

const std::array<DiscPoint, radial_points * arc_points>& disc_points() {
    static const auto points = [] {
        std::array<DiscPoint, radial_points * arc_points> all{};
        for (int i = 0; i < radial_points; ++i) {
            // Near the rim, facets change with the square root of the distance to it, so the steps
            // are even in the root.
            const double root = (i + 0.5) / radial_points;
            const double radius = std::sqrt(1.0 - root * root);
            for (int j = 0; j < arc_points; ++j) {
                const double angle = std::numbers::pi * ((j + 0.5) / arc_points - 0.5);
                const double across = radius * std::cos(angle);
                all.at(static_cast<std::size_t>(i * arc_points + j)) = {
                    across, radius * std::sin(angle), std::sqrt(1.0 - across * across),
                    2.0 * root / (radial_points * arc_points)};
            }
        }
        return all;
    }();
    return points;
}

/// Facet normals that are visible from a direction in the xz plane.
class VisibleFacets {
  public:
    VisibleFacets(const glm::dvec3& view, double alpha)
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
    double visible_;  ///< The share of the disk above the horizon, at its center.
};

double power_5(double x) {
    return x * x * x * x * x;
}

}  // namespace

glm::dvec2 environment_brdf(double n_v, double roughness) {
    const glm::dvec3 view(std::sqrt(1.0 - n_v * n_v), 0.0, n_v);
    const double alpha = roughness * roughness;
    const double masked_view = masked(n_v, alpha);
    const VisibleFacets facets(view, alpha);
    glm::dvec2 sum(0.0);
    for (const DiscPoint& point : disc_points()) {
        const glm::dvec3 half = facets.at(point);
        const double v_h = glm::dot(view, half);
        const double n_l = 2.0 * v_h * half.z - view.z;
        if (n_l <= 0.0) continue;
        const double lit_share =
            (1.0 + masked_view) / (1.0 + masked_view + masked(std::min(n_l, 1.0), alpha));
        const double fresnel = power_5(1.0 - std::min(v_h, 1.0));
        sum += point.weight * lit_share * glm::dvec2(1.0 - fresnel, fresnel);
    }
    return sum;
}

Image environment_brdf_table(int size) {
    if (size < 2) throw InvalidInput(fmt::format("a table of {} values a side is asked for", size));
    // At n.v = 0 the albedo is undefined; this angle gives its limit.
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
