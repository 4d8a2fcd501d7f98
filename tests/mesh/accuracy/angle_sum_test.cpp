// SPDX-License-Identifier: Apache-2.0
// Sums of angles by hand, and against the distribution of all of them.
#include "accuracy/angle_sum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace relief {
namespace {

/// Percentiles are the upper ends of bins, 64 or more to a factor of two.
constexpr double bin_width = 1.0 / 64.0;

/// Of all sizes that bins tell apart: 1e-6 to 170 degrees.
std::vector<float> angles_of_all_sizes() {
    std::vector<float> degrees;
    for (int i = 0; i < 1000; ++i)
        degrees.push_back(
            static_cast<float>(std::pow(10.0, -6.0 + 8.23 * ((i * 617) % 1000) / 1000.0)));
    return degrees;
}

TEST(AngleMoments, AreRmsMeanAndGreatest) {
    AngleMoments moments;
    for (const double degrees : {4.0, 0.0, 3.0, 0.0})
        moments.add(degrees);
    EXPECT_EQ(moments.count(), 4U);
    EXPECT_EQ(moments.rms(), 2.5);
    EXPECT_EQ(moments.mean(), 1.75);
    EXPECT_EQ(moments.max(), 4.0);
}

TEST(AngleMoments, OfNothingAreZeros) {
    const AngleMoments nothing;
    EXPECT_EQ(nothing.count(), 0U);
    EXPECT_EQ(nothing.rms(), 0.0);
    EXPECT_EQ(nothing.mean(), 0.0);
    EXPECT_EQ(nothing.max(), 0.0);
}

TEST(AngleMoments, OfPartsAreThoseOfTheWhole) {
    AngleMoments whole, first, second;
    for (int i = 0; i < 90; ++i) {  // Whole degrees add up exactly.
        whole.add(i);
        (i < 17 ? first : second).add(i);
    }
    first.add(second);
    first.add(AngleMoments());
    EXPECT_EQ(first.count(), whole.count());
    EXPECT_EQ(first.rms(), whole.rms());
    EXPECT_EQ(first.mean(), whole.mean());
    EXPECT_EQ(first.max(), whole.max());
}

TEST(AngleMoments, KeepWhatIsNoNumberInTheMeans) {
    AngleMoments moments;
    for (const double degrees : {2.0, std::numeric_limits<double>::quiet_NaN(), 5.0})
        moments.add(degrees);
    EXPECT_TRUE(std::isnan(moments.rms()));
    EXPECT_TRUE(std::isnan(moments.mean()));
    EXPECT_EQ(moments.max(), 5.0);
    EXPECT_EQ(moments.count(), 3U);
}

TEST(AngleSum, IsTheDistributionInShort) {
    const std::vector<float> degrees = angles_of_all_sizes();
    AngleSum sum;
    for (const float angle : degrees)
        sum.add(static_cast<double>(angle));
    const AngleSummary summary = sum.summary();
    const AngleDistribution all = angle_distribution(degrees);
    EXPECT_EQ(summary.count, all.count);
    EXPECT_EQ(summary.rms, all.rms);
    EXPECT_EQ(summary.mean, all.mean);
    EXPECT_EQ(summary.max, all.max);
    EXPECT_GE(summary.p99, all.p99);
    EXPECT_LE(summary.p99, all.p99 * (1.0 + bin_width));
}

TEST(AngleSum, HasAPercentileNoFurtherOffThanABin) {
    for (const float angle : angles_of_all_sizes()) {
        AngleSum sum;
        for (int i = 0; i < 99; ++i)
            sum.add(static_cast<double>(angle));
        sum.add(180.0);
        const double p99 = sum.summary().p99;
        EXPECT_GE(p99, static_cast<double>(angle));
        EXPECT_LE(p99, static_cast<double>(angle) * (1.0 + bin_width));
    }
}

TEST(AngleSum, OfPartsIsThatOfTheWhole) {
    AngleSum whole, first, second;
    for (int i = 0; i < 180; ++i) {  // Whole degrees add up exactly.
        whole.add(i);
        (i % 3 == 0 ? first : second).add(i);
    }
    AngleSum both;
    both.add(first);
    both.add(second);
    EXPECT_EQ(both.summary().count, 180U);
    EXPECT_EQ(both.summary().rms, whole.summary().rms);
    EXPECT_EQ(both.summary().mean, whole.summary().mean);
    EXPECT_EQ(both.summary().p99, whole.summary().p99);
    EXPECT_EQ(both.summary().max, 179.0);
}

TEST(AngleSum, OfNothingIsAllZerosAndOfExactAnglesExact) {
    EXPECT_EQ(AngleSum().summary().count, 0U);
    EXPECT_EQ(AngleSum().summary().p99, 0.0);
    AngleSum exact;
    exact.add(0.0);
    EXPECT_EQ(exact.summary().count, 1U);
    EXPECT_EQ(exact.summary().p99, 0.0) << "never more than the greatest";
    EXPECT_EQ(exact.summary().max, 0.0);
}

}  // namespace
}  // namespace relief
