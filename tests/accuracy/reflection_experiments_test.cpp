// SPDX-License-Identifier: Apache-2.0
// The environment formula, the mirror ball in closed form, and the results of the experiments.
#include "shading_experiments.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "experiment_checks.h"
#include "relief/mesh/image.h"
#include "relief/shade/image_compare.h"
#include "rendered_methods.h"
#include "support/labels.h"

namespace relief {
using namespace relief::accuracy;
using namespace relief::accuracy::detail;
using namespace relief::shade;

namespace {

constexpr int cube_side = 24;

double furthest(const Image& a, const Image& b) {
    return compare(a, b).max;
}

glm::dvec3 slope(const glm::dvec3& direction, double strength) {
    return glm::dvec3(0.5 + strength * (0.4 * direction.y + 0.2 * direction.x));
}

/// The factor by which GGX, viewed along the normal, reduces an environment that grows linearly
/// along a direction: the mean of l.r over the directions l that the facets h reflect r to,
/// weighted by l.r. Integrates over the angle of the facets by Simpson's rule.
double left_of_slope(double roughness) {
    const double alpha = roughness * roughness;
    constexpr int steps = 200000;
    double above = 0.0;
    double below = 0.0;
    for (int i = 0; i <= steps; ++i) {
        const double angle = 0.25 * std::numbers::pi * i / steps;
        const double cosine = std::cos(angle);
        const double spread = cosine * cosine * (alpha * alpha - 1.0) + 1.0;
        const double facets = alpha * alpha / (spread * spread) * cosine * std::sin(angle);
        const double mirrored = std::cos(2.0 * angle);
        const double weight = i == 0 || i == steps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
        above += weight * facets * mirrored * mirrored;
        below += weight * facets * mirrored;
    }
    return above / below;
}

TEST_LABELS(not_sanitized);
TEST(TrueMirror, MatchesTheReferenceShader) {
    const Scene ball = mirror_ball(cube_map_of(waves_and_lights, 512), 0.0);
    const Image traced = supersampled_reference(ball, cube_side, 4);
    EXPECT_LT(furthest(traced, exact_mirror(waves_and_lights, cube_side, 4)), 0.006);
    // A mirrored environment is detected.
    const auto turned = [](const glm::dvec3& d) { return waves_and_lights({-d.x, d.y, d.z}); };
    EXPECT_GT(furthest(traced, exact_mirror(turned, cube_side, 4)), 0.1);
}

TEST(RoughMirror, ConstantEnvironmentIsReflectedUnchanged) {
    const auto constant = [](const glm::dvec3&) { return glm::dvec3(0.25, 0.5, 0.75); };
    for (const double roughness : {0.1, 0.5, 1.0}) {
        const Image blurred =
            supersampled_reference(mirror_ball(cube_map_of(constant, 8), roughness), 8, 1);
        EXPECT_LT(furthest(blurred, exact_mirror(constant, 8, 1)), 1e-6) << roughness;
    }
}

TEST(RoughMirror, FlattensGradientsByTheClosedForm) {
    const Environment environment =
        cube_map_of([](const glm::dvec3& d) { return slope(d, 1.0); }, 64);
    for (const double roughness : {0.2, 0.5, 0.9}) {
        const double left = left_of_slope(roughness);
        const Image blurred =
            supersampled_reference(mirror_ball(environment, roughness), cube_side, 1);
        const Image expected =
            exact_mirror([&](const glm::dvec3& d) { return slope(d, left); }, cube_side, 1);
        EXPECT_LT(furthest(blurred, expected), 0.002) << roughness << ", " << left;
        EXPECT_LT(left, 1.0);
    }
    EXPECT_LT(left_of_slope(0.9), 0.8) << "rough enough to tell";
}

}  // namespace
}  // namespace relief
