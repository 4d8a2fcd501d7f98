// SPDX-License-Identifier: Apache-2.0
// What times have in common: the middle and the scatter of ratios that are made up, so that both
// are known.
#include "compare/compare_times.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace relief {
namespace {

/// What logarithms, exponentials and their differences round away of numbers near 1.
constexpr double logarithm_rounding = 1e-12;

/// Three rounds before and after, whose middles are 2 s and `ratio` times that; outliers have no
/// say.
TimedPair pair_of_ratio(const std::string& experiment, double ratio) {
    TimedPair pair;
    pair.experiment = experiment;
    pair.method = "method";
    pair.before = {2.0, 1.9, 50.0};
    pair.after = {0.01, 2.0 * ratio, 3.0 * ratio};
    return pair;
}

/// By the logarithms of their ratios; in three experiments by turns.
std::vector<TimedPair> pairs_of_logarithms(const std::vector<double>& logarithms) {
    std::vector<TimedPair> pairs;
    for (std::size_t i = 0; i < logarithms.size(); ++i)
        pairs.push_back(pair_of_ratio(std::to_string(i % 3), std::exp(logarithms[i])));
    return pairs;
}

TEST(CommonChange, ScattersByTheMiddleOfAllDistancesAsADeviation) {
    // The middle is 0.2; distances from it, in order: 0 0.01 0.01 0.02 0.03 0.05 0.05 0.07 0.9.
    const std::vector<double> logarithms = {0.15, 0.2, 0.18, 0.21, 1.1, 0.19, 0.23, 0.13, 0.25};
    const CommonChange common = common_change(pairs_of_logarithms(logarithms));
    EXPECT_EQ(common.methods, 9U);
    EXPECT_TRUE(common.is_judged);
    EXPECT_NEAR(common.ratio.value, std::exp(0.2), logarithm_rounding);
    // Of a normal distribution half of all lie within 0.67449 deviations: 1.4826 is 1 by that.
    EXPECT_NEAR(common.scatter, 0.03 * 1.4826, logarithm_rounding);
    EXPECT_NEAR(common.smallest, std::exp(3.0 * 0.03 * 1.4826), logarithm_rounding);
    EXPECT_NEAR(common.smallest, 1.142746, 1e-6) << "without the factor, 1.094";
}

TEST(CommonChange, OfAnEvenNumberTakesTheMeanOfBothMiddles) {
    // The middle is 0.005; distances 0.005 0.005 0.015 0.025 | 0.035 0.045 0.055 0.065.
    const std::vector<double> logarithms = {0.0, 0.01, 0.02, -0.02, 0.04, -0.04, 0.06, -0.06};
    const CommonChange common = common_change(pairs_of_logarithms(logarithms));
    EXPECT_TRUE(common.is_judged);
    EXPECT_NEAR(common.ratio.value, std::exp(0.005), logarithm_rounding);
    EXPECT_NEAR(common.scatter, 0.03 * 1.4826, logarithm_rounding);
}

TEST(CommonChange, OfNearlyEqualRatiosIsTheLeastThatIsOfInterest) {
    const std::vector<double> logarithms = {0.0,   0.001, -0.001, 0.002, -0.002,
                                            0.003, 0.0,   -0.003, 0.5};
    const CommonChange common = common_change(pairs_of_logarithms(logarithms));
    EXPECT_NEAR(common.scatter, 0.002 * 1.4826, logarithm_rounding);
    EXPECT_EQ(common.smallest, 1.03) << "three deviations are only 1.009";
}

TEST(CommonChange, OfFewerThanEightIsNotJudged) {
    const std::vector<double> logarithms = {0.3, 0.1, 0.2, 0.0, -0.1, -0.2, -0.3};
    const CommonChange common = common_change(pairs_of_logarithms(logarithms));
    EXPECT_EQ(common.methods, 7U);
    EXPECT_FALSE(common.is_judged);
    EXPECT_NEAR(common.scatter, 0.2 * 1.4826, logarithm_rounding);
    EXPECT_EQ(common.smallest, 1.03);
    EXPECT_EQ(common_change({}).methods, 0U);
    EXPECT_EQ(common_change({}).smallest, 1.03);
}

TEST(JudgedTimes, CountARatioBeyondThreeDeviationsOfTheOthersAlone) {
    // Six of the nine at the middle's distance of 0.03 on either side; the last is to be judged.
    const auto verdict_on = [](double logarithm) {
        std::vector<TimedPair> pairs;
        for (const double other : {0.0, 0.03, -0.03, 0.03, -0.03, 0.03, -0.03, 0.0, logarithm}) {
            TimedPair pair = pair_of_ratio("experiment", 1.0);
            pair.before.clear();
            pair.after.clear();
            // Rounds that agree to a thousandth: how they rank is beyond doubt.
            for (int round = 0; round < 15; ++round) {
                const double noise = 1.0 + 1e-4 * round;
                pair.before.push_back(noise);
                pair.after.push_back(noise * std::exp(other));
            }
            pairs.push_back(pair);
        }
        const CommonChange common = common_change(pairs);
        EXPECT_NEAR(common.scatter, 0.03 * 1.4826, logarithm_rounding);
        return judged_times(pairs, common, {}, true).back().verdict;
    };
    // Three deviations are 0.1334; of distances not made deviations of, they would be 0.09.
    EXPECT_EQ(verdict_on(0.125), TimeVerdict::unchanged);
    EXPECT_EQ(verdict_on(0.14), TimeVerdict::slower);
    EXPECT_EQ(verdict_on(-0.125), TimeVerdict::unchanged);
    EXPECT_EQ(verdict_on(-0.14), TimeVerdict::faster);
}

}  // namespace
}  // namespace relief
