// SPDX-License-Identifier: Apache-2.0
// GGX and points to sample it with; see ggx.h. Nothing here divides by zero for alpha above 0 and
// cosines above 0. Tests: tests/shade/environment/ggx_test.cpp.
#include "environment/ggx.h"

#include <cmath>
#include <cstdint>
#include <numbers>

namespace relief {

double ggx_distribution(double n_h, double alpha) {
    const double squared = alpha * alpha;
    // 1 + n.h^2 (alpha^2 - 1), as a sum of what is positive.
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
    // tan^2 of the angle to the normal, from the share of facets within it.
    const double tan_squared = alpha * alpha * point.x / (1.0 - point.x);
    const double cosine = 1.0 / std::sqrt(1.0 + tan_squared);
    const double sine = std::sqrt(tan_squared) * cosine;
    const double turn = 2.0 * std::numbers::pi * point.y;
    return {sine * std::cos(turn), sine * std::sin(turn), cosine};
}

}  // namespace relief
