// SPDX-License-Identifier: Apache-2.0
// The directional albedo of GGX: against integrals by brute force, and its known ends.
#include "environment/ggx.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "relief/mesh/error.h"
#include "relief/mesh/threads.h"

namespace relief {
namespace {

/// The integral of D V n.l, split by (1 - v.h)^5, over facets drawn by D n.h instead of those the
/// eye sees: 4 V n.l v.h / n.h each. Steps go evenly with the root of the rest of the facets.
glm::dvec2 brute_force(double n_v, double roughness, int steps) {
    const double alpha = roughness * roughness;
    const glm::dvec3 view(std::sqrt(1.0 - n_v * n_v), 0.0, n_v);
    glm::dvec2 sum(0.0);
    for (int i = 0; i < steps; ++i) {
        const double root = (i + 0.5) / steps;
        for (int j = 0; j < steps; ++j) {
            const glm::dvec3 half = ggx_facet({1.0 - root * root, 0.5 * (j + 0.5) / steps}, alpha);
            const double v_h = glm::dot(view, half);
            const double n_l = 2.0 * v_h * half.z - n_v;
            if (v_h <= 0.0 || n_l <= 0.0) continue;
            const double fresnel = std::pow(1.0 - v_h, 5.0);
            sum += 2.0 * root * 4.0 * ggx_visibility(n_l, n_v, alpha) * n_l * v_h / half.z *
                   glm::dvec2(1.0 - fresnel, fresnel);
        }
    }
    return sum / static_cast<double>(steps * steps);
}

/// The integral of D V n.l over directions of light in even steps of n.l and turn: no facets drawn,
/// no mapping, for surfaces rough enough.
double albedo_over_light(double n_v, double roughness, int steps) {
    const double alpha = roughness * roughness;
    const glm::dvec3 view(std::sqrt(1.0 - n_v * n_v), 0.0, n_v);
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
        const double n_l = (i + 0.5) / steps;
        const double across = std::sqrt(1.0 - n_l * n_l);
        for (int j = 0; j < steps; ++j) {
            const double turn = std::numbers::pi * (j + 0.5) / steps;
            const glm::dvec3 light(across * std::cos(turn), across * std::sin(turn), n_l);
            const glm::dvec3 half = glm::normalize(light + view);
            sum += ggx_distribution(half.z, alpha) * ggx_visibility(n_l, n_v, alpha) * n_l;
        }
    }
    return sum * 2.0 * std::numbers::pi / (static_cast<double>(steps) * steps);
}

TEST(EnvironmentBrdf, IsTheIntegralOverFacets) {
    double worst = 0.0;
    for (const double roughness : {1.0 / 64, 0.05, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0}) {
        for (const double n_v : {1.0 / 64, 0.05, 0.1, 0.25, 0.5, 0.75, 0.9, 1.0}) {
            // 500 x 500 steps are within 3e-4 of four times as many.
            const glm::dvec2 off =
                environment_brdf(n_v, roughness) - brute_force(n_v, roughness, 500);
            worst = std::max({worst, std::abs(off.x), std::abs(off.y)});
        }
    }
    RecordProperty("worst", std::to_string(worst));
    EXPECT_LT(worst, 1e-3);
}

TEST(EnvironmentBrdf, IsTheIntegralOverDirectionsOfLight) {
    for (const double roughness : {0.4, 0.7, 1.0}) {
        for (const double n_v : {0.1, 0.5, 1.0}) {
            const glm::dvec2 split = environment_brdf(n_v, roughness);
            EXPECT_NEAR(split.x + split.y, albedo_over_light(n_v, roughness, 400), 1.5e-3)
                << roughness << ' ' << n_v;
        }
    }
}

TEST(EnvironmentBrdf, OfAMirrorIsFresnelsFactor) {
    for (const double n_v : {0.02, 0.3, 0.9, 1.0}) {
        const double fresnel = std::pow(1.0 - n_v, 5.0);
        const glm::dvec2 split = environment_brdf(n_v, 0.0);
        EXPECT_NEAR(split.x, 1.0 - fresnel, 1e-9);
        EXPECT_NEAR(split.y, fresnel, 1e-9);
    }
}

TEST(EnvironmentBrdf, NeverGivesMoreLightThanThereIsAndLosesMoreWhereItIsRougher) {
    for (int i = 1; i <= 32; ++i) {
        const double n_v = i / 32.0;
        double before = 1.0 + 1e-12;
        for (int j = 0; j <= 32; ++j) {
            const glm::dvec2 split = environment_brdf(n_v, j / 32.0);
            EXPECT_GE(split.x, 0.0);
            EXPECT_GE(split.y, 0.0);
            EXPECT_LE(split.x + split.y, 1.0 + 1e-12);
            // Seen from the side, the rest of the light is seen best at middling roughness.
            if (n_v > 0.5) {
                EXPECT_LT(split.x + split.y, before + 2e-3) << n_v << ' ' << j;
                before = split.x + split.y;
            }
        }
    }
}

TEST(EnvironmentBrdf, TheTableHoldsItFromEndToEndForAnyNumberOfThreads) {
    const Image table = environment_brdf_table(8);
    ASSERT_EQ(table.width, 8);
    ASSERT_EQ(table.height, 8);
    ASSERT_EQ(table.channels, 2);
    EXPECT_EQ(table.color_space, ColorSpace::data);
    const glm::dvec2 value = environment_brdf(2.0 / 7 * 2.0 / 7, 6.0 / 7);
    const std::size_t texel = 2 * (8 * 6 + 2);
    EXPECT_EQ(table.as<float>()[texel], static_cast<float>(value.x));
    EXPECT_EQ(table.as<float>()[texel + 1], static_cast<float>(value.y));
    const std::size_t last = 2 * 63;
    EXPECT_EQ(table.as<float>()[last], static_cast<float>(environment_brdf(1.0, 1.0).x));
    EXPECT_EQ(table.as<float>()[2 * 7], 1.0F) << "a mirror, head on";
    for (const float part : table.as<float>())
        EXPECT_TRUE(part >= 0.0F && part <= 1.0F);
    set_thread_limit(1);
    const Image again = environment_brdf_table(8);
    set_thread_limit(0);
    EXPECT_EQ(table.samples, again.samples);
    EXPECT_THROW(environment_brdf_table(1), InvalidInput);
}

TEST(EnvironmentBrdf, ATableOf64IsCloseBetweenItsTexels) {
    constexpr int size = 64;
    const Image table = environment_brdf_table(size);
    const auto samples = table.as<float>();
    const auto at = [&](std::size_t column, std::size_t row) {
        const std::size_t texel = 2 * (size * row + column);
        return glm::dvec2(samples[texel], samples[texel + 1]);
    };
    double worst = 0.0;
    for (double roughness = 0.045; roughness < 1.0; roughness += 0.019) {
        for (double n_v = 0.005; n_v < 1.0; n_v += 0.017) {
            const glm::dvec2 place =
                glm::min(glm::dvec2(std::sqrt(n_v), roughness) * (size - 1.0), size - 1.001);
            const auto x = static_cast<std::size_t>(place.x);
            const auto y = static_cast<std::size_t>(place.y);
            const glm::dvec2 part = glm::fract(place);
            const glm::dvec2 looked_up =
                glm::mix(glm::mix(at(x, y), at(x + 1, y), part.x),
                         glm::mix(at(x, y + 1), at(x + 1, y + 1), part.x), part.y);
            const glm::dvec2 off = glm::abs(looked_up - environment_brdf(n_v, roughness));
            worst = std::max({worst, off.x, off.y});
        }
    }
    RecordProperty("worst", std::to_string(worst));
    EXPECT_LT(worst, 3e-3);
}

}  // namespace
}  // namespace relief
