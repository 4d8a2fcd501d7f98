// SPDX-License-Identifier: Apache-2.0
// Rank sums against counting by hand and published values; intervals; false discoveries.
#include "relief/accuracy/two_samples.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

namespace relief {
namespace {

using testing::ElementsAre;
using Sample = std::vector<double>;

TEST(MannWhitney, CountsTheWaysToOrder) {
    // Of 20 ways to choose 3 of 6, these and their mirror image.
    EXPECT_DOUBLE_EQ(mann_whitney_p({1, 2, 3}, {4, 5, 6}), 2.0 / 20.0);
    EXPECT_DOUBLE_EQ(mann_whitney_p({5, 4}, {1, 3, 2}), 2.0 / 10.0);
    // Pairs of 1 to 4 sum to 3 4 5 5 6 7: this one to 4, and 3, 6 and 7 are as far from 5.
    EXPECT_DOUBLE_EQ(mann_whitney_p({1, 3}, {2, 4}), 4.0 / 6.0);
    EXPECT_DOUBLE_EQ(mann_whitney_p({1, 4}, {2, 3}), 1.0);
    EXPECT_DOUBLE_EQ(mann_whitney_p({}, {1}), 1.0);
}

TEST(MannWhitney, TenRoundsCanFindOneChangeAmong4600) {
    // All ten of one above all ten of the other: 2 of the 184756 ways to choose ten of twenty.
    EXPECT_DOUBLE_EQ(least_mann_whitney_p(10, 10), 2.0 / 184756.0);
    const auto finds_it_among = [](std::size_t times) -> bool {
        std::vector<double> p(times, 1.0);
        p[0] = least_mann_whitney_p(10, 10);
        return discoveries(p, 0.05)[0];
    };
    EXPECT_TRUE(finds_it_among(4600));
    EXPECT_FALSE(finds_it_among(4700));
}

TEST(MannWhitney, TiesShareTheirRanks) {
    EXPECT_DOUBLE_EQ(mann_whitney_p({7, 7}, {7, 7}), 1.0);
    // Ranks 1.5 1.5 3.5 3.5: of 6 pairs one sums to 3, four to 5, one to 7.
    EXPECT_DOUBLE_EQ(mann_whitney_p({1, 1}, {2, 2}), 2.0 / 6.0);
}

TEST(MannWhitney, GivesAPublishedValue) {
    // Hollander and Wolfe, Nonparametric Statistical Methods 1973, page 69: one-sided 0.1272, 382
    // of the 3003 ways.
    const Sample at_term = {0.80, 0.83, 1.89, 1.04, 1.45, 1.38, 1.91, 1.64, 0.73, 1.46};
    const Sample early = {1.15, 0.88, 0.90, 0.74, 1.21};
    EXPECT_DOUBLE_EQ(mann_whitney_p(at_term, early), 764.0 / 3003.0);
    EXPECT_DOUBLE_EQ(mann_whitney_p(at_term, early), mann_whitney_p(early, at_term));
}

TEST(MannWhitney, ApproximatesLargeSamples) {
    Sample a;
    Sample b;
    for (int i = 0; i < 31; ++i) {
        a.push_back(i);
        b.push_back(i + 5.5);
    }
    constexpr double exact = 0.02838104613025459;  // By counting in whole numbers.
    EXPECT_NEAR(mann_whitney_p(a, b), exact, 0.05 * exact);
    EXPECT_DOUBLE_EQ(mann_whitney_p(Sample(40, 1.0), Sample(40, 1.0)), 1.0);
}

TEST(MannWhitney, KnowsTheLeastThatItCanFind) {
    EXPECT_DOUBLE_EQ(least_mann_whitney_p(3, 3), 2.0 / 20.0);
    EXPECT_DOUBLE_EQ(least_mann_whitney_p(9, 9), 2.0 / 48620.0);
    EXPECT_DOUBLE_EQ(least_mann_whitney_p(1, 1), 1.0);
    EXPECT_DOUBLE_EQ(least_mann_whitney_p(0, 9), 1.0);
}

TEST(MedianRatio, HoldsTheTruthAboutAsOftenAsItSays) {
    std::mt19937_64 random(7);
    std::normal_distribution<double> noise(1.0, 0.05);
    int held = 0;
    for (int trial = 0; trial < 200; ++trial) {
        Sample a;
        Sample b;
        for (int i = 0; i < 9; ++i) {
            a.push_back(noise(random));
            b.push_back(1.2 * noise(random));
        }
        const Interval ratio = median_ratio(a, b);
        EXPECT_LE(ratio.low, ratio.value);
        EXPECT_GE(ratio.high, ratio.value);
        held += ratio.low <= 1.2 && 1.2 <= ratio.high ? 1 : 0;
    }
    // Medians take few values, so that it is rather too wide than too narrow.
    EXPECT_GE(held, 186);
    EXPECT_LT(held, 200) << "an interval that is always right is too wide to be of use";
}

TEST(MedianRatio, OfOneValueEachIsCertain) {
    const Interval ratio = median_ratio({2.0}, {3.0});
    EXPECT_DOUBLE_EQ(ratio.value, 1.5);
    EXPECT_DOUBLE_EQ(ratio.low, 1.5);
    EXPECT_DOUBLE_EQ(ratio.high, 1.5);
}

TEST(Discoveries, AreThoseUpToTheLastThatKeepsTheRate) {
    // Limits 0.0125 0.025 0.0375 0.05 for the smallest, the second, ...
    EXPECT_THAT(discoveries({0.9, 0.02, 0.01, 0.8}, 0.05), ElementsAre(false, true, true, false));
    EXPECT_THAT(discoveries({0.03, 0.9}, 0.05), ElementsAre(false, false));
    // The first is beyond its own limit, 0.025, but the second is within its 0.05.
    EXPECT_THAT(discoveries({0.04, 0.05}, 0.05), ElementsAre(true, true));
    EXPECT_THAT(discoveries({}, 0.05), ElementsAre());
}

}  // namespace
}  // namespace relief
