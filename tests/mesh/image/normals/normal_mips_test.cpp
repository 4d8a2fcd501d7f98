// SPDX-License-Identifier: Apache-2.0
// Mip levels keep the mean of the vectors, and its length says how much roughness is lost: by hand,
// and against slopes of known variance.
#include "relief/mesh/normal_mips.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "relief/mesh/error.h"
#include "relief/mesh/normal_map_operations.h"
#include "support/message_of.h"
#include "support/samples.h"

namespace relief {
namespace {

using test::samples_of;
using testing::Each;
using testing::ElementsAre;
using testing::FloatNear;

/// A chequerboard of normals that lean by this slope to the left and to the right.
Image checker(int side, float slope) {
    Image slopes = make_image(side, side, 2, 32, ColorSpace::data);
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x)
            slopes.as<float>()[static_cast<std::size_t>(y * side + x) * 2] =
                (x + y) % 2 == 0 ? slope : -slope;
    }
    Report report;
    return normals_from_slopes(slopes, report);
}

TEST(NormalMips, ACheckerKeepsTheLengthOfItsMean) {
    std::vector<Image> levels = normal_mip_levels(checker(8, 1.0F));
    ASSERT_EQ(levels.size(), 3U);
    for (Image& level : levels) {
        Report report;
        const Image lengths = split_lengths(level, report);
        EXPECT_THAT(lengths.as<float>(), Each(FloatNear(std::sqrt(0.5F), 1e-6F)));
        for (std::size_t i = 0; i < level.sample_count(); ++i)
            EXPECT_EQ(level.as<float>()[i], i % 3 == 2 ? 1.0F : 0.0F);
        EXPECT_TRUE(report.empty());
        // The variance of slopes +-1 along x is 1, along y 0; roughness 0.5 has alpha 0.25.
        const Image roughness = roughness_from_lengths(lengths, 0.5);
        EXPECT_THAT(roughness.as<float>(), Each(1.0F));
    }
    std::vector<Image> gentle = normal_mip_levels(checker(4, 0.2F));
    Report report;
    const Image lengths = split_lengths(gentle[0], report);
    EXPECT_THAT(samples_of<float>(roughness_from_lengths(lengths, 0.5)),
                Each(FloatNear(std::pow(0.0625F + 0.04F, 0.25F), 1e-6F)));
}

TEST(NormalMips, AMeanIsThatOfTheMapItselfAtEveryLevel) {
    // Averaging unit vectors level by level instead would give another direction.
    Image normals = make_image(4, 1, 3, 32, ColorSpace::data);
    normals.samples = std::vector<float>{1, 0, 0, -1, 0, 0, 0, 0, 1, 0.6F, 0, 0.8F};
    const std::vector<Image> levels = normal_mip_levels(normals);
    ASSERT_EQ(levels.size(), 2U);
    EXPECT_THAT(samples_of<float>(levels[1]),
                ElementsAre(FloatNear(0.15F, 1e-7F), 0, FloatNear(0.45F, 1e-7F)));
}

TEST(NormalMips, NormalsThatCancelAreFlatWithLengthZeroAndCounted) {
    Image means = make_image(2, 1, 3, 32, ColorSpace::data);
    means.samples = std::vector<float>{1e-8F, 0, 0, 0, 0.5F, 0};
    Report report;
    const Image lengths = split_lengths(means, report);
    EXPECT_THAT(samples_of<float>(means), ElementsAre(0, 0, 1, 0, 1, 0));
    EXPECT_THAT(samples_of<float>(lengths), ElementsAre(FloatNear(0, 1e-7F), 0.5F));
    EXPECT_EQ(report.count("normals that cancel"), 1U);
    EXPECT_EQ(samples_of<float>(roughness_from_lengths(lengths, 0.1))[0], 1.0F);
}

TEST(NormalMips, VarianceOfTheLength) {
    EXPECT_EQ(slope_variance_of_length(1.0), 0.0);
    EXPECT_EQ(slope_variance_of_length(1.5), 0.0);
    EXPECT_NEAR(slope_variance_of_length(0.8), 0.28125, 1e-12);
    EXPECT_TRUE(std::isfinite(slope_variance_of_length(0.0)));
    EXPECT_NEAR(toksvig_factor(0.8, 100.0), 0.8 / 20.8, 1e-12);
    EXPECT_EQ(toksvig_factor(1.0, 1e6), 1.0);
    EXPECT_EQ(toksvig_factor(0.0, 10.0), 0.0);
    EXPECT_EQ(roughness_with_variance(0.4, 0.0), 0.4);
    EXPECT_NEAR(roughness_with_variance(0.0, 0.02), std::sqrt(0.2), 1e-12);
    EXPECT_EQ(roughness_with_variance(0.5, 10.0), 1.0);
}

/// Mean length of unit normals whose slopes are normally distributed with this deviation along each
/// axis: the integral of exp(-t) / sqrt(1 + 2 deviation^2 t).
double length_of_gaussian(double deviation) {
    double sum = 0.0;
    constexpr int steps = 40000;
    for (int i = 0; i < steps; ++i) {
        const double t = (i + 0.5) * 40.0 / steps;
        sum += std::exp(-t) / std::sqrt(1.0 + 2.0 * deviation * deviation * t) * 40.0 / steps;
    }
    return sum;
}

TEST(NormalMips, OfNormallyDistributedSlopesTheLengthTellsNearlyAllTheVariance) {
    // Toksvig's measure, (1 - r) / r, tells less: 0.995, 0.932, 0.746, 0.525 of it.
    for (const auto& [deviation, share] : {std::pair{0.05, 0.9963}, std::pair{0.2, 0.9499},
                                           std::pair{0.5, 0.8161}, std::pair{1.0, 0.6630}}) {
        const double length = length_of_gaussian(deviation);
        const double variance = deviation * deviation;
        EXPECT_NEAR(slope_variance_of_length(length) / variance, share, 1e-4);
        EXPECT_LT((1.0 - length) / length, slope_variance_of_length(length));
    }
}

TEST(NormalMips, RefusesWhatIsNotWhatItTakes) {
    const Image codes = make_image(2, 2, 3, 8, ColorSpace::data);
    EXPECT_EQ(test::message_of<InvalidInput>([&] { normal_mip_levels(codes); }),
              "normals have 3 float channels, not 3 of 8 bits");
    const Image lengths = make_image(2, 2, 1, 32, ColorSpace::data);
    EXPECT_EQ(test::message_of<InvalidInput>([&] { roughness_from_lengths(lengths, 1.5); }),
              "the roughness 1.5 is not within 0 and 1");
}

}  // namespace
}  // namespace relief
