// SPDX-License-Identifier: Apache-2.0
// Distributions of angles, against numbers worked out by hand.
#include "relief/mesh/angle_distribution.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace relief {
namespace {

using testing::ElementsAre;

TEST(AngleDistribution, OfNothingIsAllZeros) {
    EXPECT_EQ(angle_distribution({}), AngleDistribution());
}

TEST(AngleDistribution, SumsUpWhatItIsGiven) {
    const AngleDistribution result = angle_distribution({4.0F, 0.0F, 3.0F, 0.0F});
    EXPECT_EQ(result.count, 4U);
    EXPECT_EQ(result.undefined, 0U);
    EXPECT_DOUBLE_EQ(result.rms, 2.5);
    EXPECT_DOUBLE_EQ(result.mean, 1.75);
    EXPECT_EQ(result.median, 0.0) << "half do not exceed 0";
    EXPECT_EQ(result.p99, 4.0);
    EXPECT_EQ(result.max, 4.0);
}

TEST(AngleDistribution, PercentilesAreRanks) {
    std::vector<float> degrees;
    for (int i = 200; i > 0; --i)
        degrees.push_back(static_cast<float>(i) / 2.0F);
    const AngleDistribution result = angle_distribution(degrees);
    EXPECT_EQ(result.median, 50.0);
    EXPECT_EQ(result.p90, 90.0);
    EXPECT_EQ(result.p99, 99.0);
    EXPECT_EQ(result.max, 100.0);
}

TEST(AngleDistribution, BinsHoldTheirUpperEnd) {
    const AngleDistribution result = angle_distribution(
        {0.0F, 0.005F, 0.05F, 1.0F, 1.001F, 5.0F, 45.0F, 60.0F, 90.0F, 90.5F, 180.0F, 180.00002F});
    EXPECT_THAT(result.histogram, ElementsAre(2, 1, 1, 2, 1, 2, 3));
}

TEST(AngleDistribution, WhatIsNoAngleIsCountedApart) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const AngleDistribution result = angle_distribution({nan, 2.0F, nan});
    EXPECT_EQ(result.count, 1U);
    EXPECT_EQ(result.undefined, 2U);
    EXPECT_EQ(result.mean, 2.0);
}

}  // namespace
}  // namespace relief
