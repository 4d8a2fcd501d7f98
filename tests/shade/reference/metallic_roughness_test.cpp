// SPDX-License-Identifier: Apache-2.0
// GGX once more, in angles and long double: [Walter et al. 2007], equation 33, with masking and
// shadowing by Lambda [Heitz 2014], equations 72 and 99, where the shader has cosines and V; and
// what the distribution integrates to. On the facing square, in the middle pixel: the eye in +z.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "support/shapes.h"
#include "traced.h"

namespace relief {
namespace {

using LongReal = long double;
using LongVector = glm::vec<3, LongReal>;
constexpr LongReal long_pi = std::numbers::pi_v<LongReal>;

LongReal angle_between(const LongVector& a, const LongVector& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// Unit; `lean` degrees off +z, towards where `around` degrees from +x to +y are.
glm::vec3 leaning(double lean, double around) {
    const double a = glm::radians(lean);
    const double b = glm::radians(around);
    return glm::vec3(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a));
}

/// D by the angle between facet and normal.
LongReal facets_at(LongReal angle, LongReal alpha) {
    const LongReal tangent = std::tan(angle);
    const LongReal cosine = std::cos(angle);
    const LongReal sum = alpha * alpha + tangent * tangent;
    return alpha * alpha / (long_pi * cosine * cosine * cosine * cosine * sum * sum);
}

/// Lambda: masked facets for each that is seen.
LongReal masked_at(LongReal angle, LongReal alpha) {
    const LongReal slope = alpha * std::tan(angle);
    return (std::sqrt(1 + slope * slope) - 1) / 2;
}

/// G: what neither the eye nor the lamp misses.
LongReal seen_and_lit(LongReal of_eye, LongReal of_lamp, LongReal alpha) {
    return 1 / (1 + masked_at(of_eye, alpha) + masked_at(of_lamp, alpha));
}

/// What a lamp of irradiance 1 makes of a channel, by angles alone.
LongReal radiance_of(const MetallicRoughness& model, int channel, const glm::vec3& normal,
                     const glm::vec3& light) {
    const LongVector n = glm::normalize(LongVector(normal));
    const LongVector l = glm::normalize(LongVector(light));
    const LongVector v(0, 0, 1);
    const LongVector half = glm::normalize(l + v);
    const LongReal alpha = static_cast<LongReal>(model.roughness) * model.roughness;
    const LongReal base = model.base_color[channel];
    const LongReal metallic = model.metallic;
    const LongReal f0 = 0.04L * (1 - metallic) + base * metallic;
    const LongReal of_lamp = angle_between(n, l);
    const LongReal of_eye = angle_between(n, v);
    const LongReal mirrored =
        f0 + (1 - f0) * std::pow(1 - std::cos(angle_between(half, v)), LongReal(5));
    // D G / (4 cos cos) of light that comes in by the cosine: that of the lamp cancels.
    const LongReal highlight = facets_at(angle_between(half, n), alpha) *
                               seen_and_lit(of_eye, of_lamp, alpha) / (4 * std::cos(of_eye));
    const LongReal scattered = (1 - mirrored) * base * (1 - metallic) * std::cos(of_lamp);
    return scattered + long_pi * mirrored * highlight;
}

double brightest_channel(const glm::dvec3& color) {
    return std::max({color.r, color.g, color.b});
}

TEST(MetallicRoughness, IsTheClosedFormInAnglesAtManyOfThem) {
    Scene scene = test::scene_of(test::facing_square(), {});
    std::size_t compared = 0;
    double brightest = 0.0;
    for (const float roughness : {0.2F, 0.4F, 0.6F, 1.0F}) {
        for (const float metallic : {1.0F, 0.25F}) {
            const MetallicRoughness model{{0.3F, 0.6F, 0.95F}, metallic, roughness, {}};
            scene.materials[0].metallic_roughness = model;
            for (const double lean : {0.0, 35.0, 70.0, 85.0}) {
                const glm::vec3 normal = leaning(lean, 20.0);
                scene.meshes[0].edit().normals.assign(4, normal);
                // Round about the normal's side and beyond, up to a lamp that is behind the square.
                for (const glm::vec3& light : {leaning(30.0, 20.0), leaning(2.0 * lean, 20.0),
                                               leaning(60.0, 110.0), leaning(100.0, 10.0)}) {
                    if (glm::dot(normal, light) < 0.01F) continue;
                    scene.directional_lights = {{-light, glm::vec3(1.0F)}};
                    const glm::dvec3 found = test::radiance_at(scene, 3, 1, 1);
                    for (int channel = 0; channel < 3; ++channel) {
                        const auto expected =
                            static_cast<double>(radiance_of(model, channel, normal, light));
                        EXPECT_NEAR(found[channel], expected,
                                    test::storage_rounding * std::max(expected, 1.0))
                            << roughness << " " << metallic << " " << lean;
                    }
                    brightest = std::max(brightest, brightest_channel(found));
                    ++compared;
                }
            }
        }
    }
    EXPECT_GE(compared, 80U);
    EXPECT_GT(brightest, 100.0) << "a smooth metal's highlight is among them";
}

/// Lamps so placed and so bright that, seen straight on, each facet's light counts as much as the
/// area that it covers, seen from above: together, D cos integrated. Facets that lean by more than
/// 45 degrees mirror nothing from above the square.
std::vector<DirectionalLight> lamps_that_count_facets(LongReal alpha) {
    constexpr int steps = 2000;
    const LongReal step = long_pi / 4 / steps;
    std::vector<DirectionalLight> lamps;
    for (int i = 0; i < steps; ++i) {
        const LongReal facet = (static_cast<LongReal>(i) + 0.5L) * step;
        const LongReal of_lamp = 2 * facet;
        const LongReal area = 2 * long_pi * std::sin(facet) * std::cos(facet) * step;
        const LongReal visibility = seen_and_lit(0, of_lamp, alpha) / 4;  // V times both cosines.
        const glm::vec3 light =
            leaning(static_cast<double>(of_lamp * 180 / long_pi), 137.5 * static_cast<double>(i));
        lamps.push_back({-light, glm::vec3(static_cast<float>(area / (long_pi * visibility)))});
    }
    return lamps;
}

TEST(MetallicRoughness, HasAsManyFacetsAsCoverTheSurface) {
    Scene scene = test::scene_of(test::facing_square(), {});
    for (const float roughness : {0.2F, 0.3F, 0.4F, 0.5F, 0.6F, 1.0F}) {
        // All light is mirrored.
        scene.materials[0].metallic_roughness = {glm::vec3(1.0F), 1.0F, roughness, {}};
        const LongReal alpha = static_cast<LongReal>(roughness) * roughness;
        scene.directional_lights = lamps_that_count_facets(alpha);
        // Of facets up to an angle, tan^2 / (alpha^2 + tan^2) of the area; at 45 degrees tan is 1.
        const auto expected = static_cast<double>(1 / (1 + alpha * alpha));
        // The midpoint rule's error: a 50th of the sharpest peak's width, squared, by 24; and lamps
        // are rounded to float.
        EXPECT_NEAR(test::radiance_at(scene, 3, 1, 1).r, expected, 1e-5) << roughness;
    }
}

}  // namespace
}  // namespace relief
