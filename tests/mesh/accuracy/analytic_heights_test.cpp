// SPDX-License-Identifier: Apache-2.0
// The ground truth of height fields: slopes against differences of the formula, statistics, tiling.
#include "relief/mesh/analytic_heights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "relief/mesh/error.h"

namespace relief {
namespace {

TEST(AnalyticHeights, AWaveHasTheHeightAndTheNormalOfItsFormula) {
    // 3 sin(pi/2 x + pi/4 y): at (1, 0) the crest; at (0, 0) slopes 3 pi/2 to the right and
    // 3 pi/4 downwards.
    const HeightWave wave{3.0, {std::numbers::pi / 2.0, std::numbers::pi / 4.0}, 0.0};
    const AnalyticHeights field = wave_heights(4, 3, std::span(&wave, 1));
    EXPECT_FLOAT_EQ(field.heights.as<float>()[1], 3.0F);
    EXPECT_NEAR(field.normals[1].z, 1.0, 1e-15);
    const glm::dvec3 expected(-3.0 * std::numbers::pi / 2.0, 3.0 * std::numbers::pi / 4.0, 1.0);
    EXPECT_LT(degrees_between(field.normals[0], expected), 1e-6);
    EXPECT_NEAR(glm::length(field.normals[7]), 1.0, 1e-15);
}

TEST(AnalyticHeights, TilingWavesRepeatAndHaveTheSlopeAskedFor) {
    const std::vector<HeightWave> waves = tiling_waves(96, 160, 40, 8.0, 0.3, 7);
    ASSERT_EQ(waves.size(), 40U);
    for (const HeightWave& wave : waves) {
        EXPECT_GE(2.0 * std::numbers::pi / glm::length(wave.frequency), 8.0);
        const double across = wave.frequency.x * 96.0 / (2.0 * std::numbers::pi);
        const double along = wave.frequency.y * 160.0 / (2.0 * std::numbers::pi);
        EXPECT_NEAR(across, std::round(across), 1e-9);
        EXPECT_NEAR(along, std::round(along), 1e-9);
    }
    const AnalyticHeights field = wave_heights(96, 160, waves);
    double squares = 0.0;
    for (const glm::dvec3& n : field.normals)
        squares += (n.x * n.x + n.y * n.y) / (n.z * n.z);
    // Waves that happen to be alike add up more or less than independent ones.
    EXPECT_NEAR(std::sqrt(squares / (96.0 * 160.0)), 0.3, 0.05);
    EXPECT_NE(tiling_waves(96, 160, 40, 8.0, 0.3, 8)[0].phase, waves[0].phase);
    EXPECT_THROW(tiling_waves(8, 8, 3, 9.0, 0.3, 1), InvalidInput);
    EXPECT_THROW(tiling_waves(8, 8, 0, 4.0, 0.3, 1), InvalidInput);
}

TEST(AnalyticHeights, CodesFillTheRangeAndStrengthGivesTheTexelsBack) {
    Image heights = make_image(3, 1, 1, 32, ColorSpace::data);
    heights.samples = std::vector<float>{-2.0F, 0.0F, 4.0F};
    const CodedHeights coded = coded_heights(heights, 16);
    EXPECT_EQ(coded.strength, 6.0);
    EXPECT_EQ(coded.codes.as<std::uint16_t>()[0], 0);
    EXPECT_EQ(coded.codes.as<std::uint16_t>()[1], 21845);
    EXPECT_EQ(coded.codes.as<std::uint16_t>()[2], 65535);
    const CodedHeights narrow = coded_heights(heights, 8);
    EXPECT_EQ(narrow.codes.as<std::uint8_t>()[1], 85);
    const CodedHeights flat = coded_heights(make_image(2, 2, 1, 32, ColorSpace::data), 8);
    EXPECT_EQ(flat.strength, 0.0);
    EXPECT_EQ(flat.codes.as<std::uint8_t>()[3], 0);
    EXPECT_THROW(coded_heights(heights, 32), InvalidInput);
}

TEST(AnalyticHeights, ErrorsAreMeasuredWithinTheMargin) {
    const AnalyticHeights flat = wave_heights(4, 4, {});
    Image normals = make_image(4, 4, 3, 32, ColorSpace::data);
    for (std::size_t texel = 0; texel < 16; ++texel)
        normals.as<float>()[3 * texel + 2] = 1.0F;
    normals.as<float>()[0] = 1.0F;  // 45 degrees in the corner.
    EXPECT_NEAR(normal_error(normals, flat).max, 45.0, 1e-6);
    EXPECT_NEAR(normal_error(normals, flat).rms, 45.0 / 4.0, 1e-6);
    EXPECT_EQ(normal_error(normals, flat, 1).max, 0.0);
    EXPECT_EQ(normal_error(normals, flat, 1).count, 4U);
    EXPECT_THROW(normal_error(make_image(4, 3, 3, 32, ColorSpace::data), flat), InvalidInput);
}

}  // namespace
}  // namespace relief
