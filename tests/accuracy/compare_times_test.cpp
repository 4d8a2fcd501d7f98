// SPDX-License-Identifier: Apache-2.0
// What times have in common: the median, the scatter and the drift of made-up rounds, so that all
// three are known.
#include "compare/compare_times.h"

#include <gtest/gtest.h>

#include <algorithm>
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

CommonChange common_of(const std::vector<TimedPair>& pairs) {
    return common_change(pairs, true, {});
}

TEST(CommonChange, ScattersByTheMedianOfAllDistancesAsADeviation) {
    // The median is 0.2; distances from it, in order: 0 0.01 0.01 0.02 0.03 0.05 0.05 0.07 0.9.
    const std::vector<double> logarithms = {0.15, 0.2, 0.18, 0.21, 1.1, 0.19, 0.23, 0.13, 0.25};
    const CommonChange common = common_of(pairs_of_logarithms(logarithms));
    EXPECT_EQ(common.methods, 9U);
    EXPECT_TRUE(common.is_judged);
    EXPECT_NEAR(common.ratio.value, std::exp(0.2), logarithm_rounding);
    // Of a normal distribution half of all lie within 0.67449 deviations: 1.4826 is 1 by that.
    EXPECT_NEAR(common.scatter, 0.03 * 1.4826, logarithm_rounding);
}

TEST(CommonChange, OfAnEvenNumberTakesTheMeanOfBothMiddles) {
    // The median is 0.005; distances 0.005 0.005 0.015 0.025 | 0.035 0.045 0.055 0.065.
    const std::vector<double> logarithms = {0.0, 0.01, 0.02, -0.02, 0.04, -0.04, 0.06, -0.06};
    const CommonChange common = common_of(pairs_of_logarithms(logarithms));
    EXPECT_TRUE(common.is_judged);
    EXPECT_NEAR(common.ratio.value, std::exp(0.005), logarithm_rounding);
    EXPECT_NEAR(common.scatter, 0.03 * 1.4826, logarithm_rounding);
}

/// Nine methods of equal rounds whose parts, three rounds each, take so many times as long.
std::vector<TimedPair> pairs_by_parts(const std::vector<double>& before,
                                      const std::vector<double>& after) {
    TimedPair pair;
    pair.experiment = "experiment";
    for (std::size_t round = 0; round < 9; ++round) {
        pair.before.push_back(before[round / 3]);
        pair.after.push_back(after[round / 3]);
    }
    return std::vector<TimedPair>(9, pair);
}

TEST(CommonChange, DriftsByHowMuchThePartsOfTheRunsDiffer) {
    const double up = std::exp(0.03);
    const auto restless_by = [&](double ratio) {
        return pairs_by_parts({1.0, 1.0, 1.0}, {ratio / up, ratio, ratio * up});
    };
    const CommonChange steady = common_of(pairs_by_parts({1.0, 1.0, 1.0}, {1.2, 1.2, 1.2}));
    EXPECT_NEAR(steady.drift, 0.0, logarithm_rounding);
    EXPECT_EQ(steady.verdict, TimeVerdict::slower);
    EXPECT_EQ(steady.resolution, 1.03);
    // Levels -0.03, 0 and 0.03 in one run: their variance is 0.0009, that of both runs together
    // half of it. The median of three has 0.4487 of the variance of one, a ratio of two twice that.
    const CommonChange restless = common_of(restless_by(1.2));
    EXPECT_NEAR(restless.ratio.value, 1.2, logarithm_rounding);
    EXPECT_NEAR(restless.drift, std::sqrt(0.00045 * 2.0 * 0.4487), logarithm_rounding);
    EXPECT_NEAR(restless.ratio.low, 1.2 * std::exp(-8.610 * restless.drift), logarithm_rounding);
    EXPECT_NEAR(restless.ratio.high, 1.2 * std::exp(8.610 * restless.drift), logarithm_rounding);
    EXPECT_EQ(restless.verdict, TimeVerdict::slower);
    EXPECT_EQ(common_of(restless_by(1.08)).verdict, TimeVerdict::unchanged);
    EXPECT_EQ(common_change(restless_by(1.08), true, 1.05).verdict, TimeVerdict::cannot_tell);
    EXPECT_EQ(common_change(restless_by(1.08), true, 1.2).verdict, TimeVerdict::unchanged);
    EXPECT_EQ(common_change(pairs_by_parts({1.0, 1.0, 1.0}, {2.0, 2.0, 2.0}), false, 1.05).verdict,
              TimeVerdict::unchanged)
        << "another machine";
}

TEST(CommonChange, OfFewerThanEightIsNotJudged) {
    const std::vector<double> logarithms = {0.3, 0.1, 0.2, 0.0, -0.1, -0.2, -0.3};
    const CommonChange common = common_of(pairs_of_logarithms(logarithms));
    EXPECT_EQ(common.methods, 7U);
    EXPECT_FALSE(common.is_judged);
    EXPECT_NEAR(common.scatter, 0.2 * 1.4826, logarithm_rounding);
    EXPECT_EQ(common_of({}).methods, 0U);
}

TEST(JudgedTimes, CountARatioBeyondWhatTheOthersScatterAlone) {
    // Six of the nine at a distance of 0.03 from the median; the last is to be judged.
    const auto judged = [](double logarithm) {
        std::vector<TimedPair> pairs;
        for (const double other : {0.0, 0.03, -0.03, 0.03, -0.03, 0.03, -0.03, 0.0, logarithm}) {
            TimedPair pair = pair_of_ratio("experiment", 1.0);
            pair.before.assign(15, 1.0);
            pair.after.assign(15, std::exp(other));
            pairs.push_back(pair);
        }
        const CommonChange common = common_of(pairs);
        EXPECT_NEAR(common.scatter, 0.03 * 1.4826, logarithm_rounding);
        return judged_times(pairs, common, true, {}).back();
    };
    // sqrt(2 ln(9 / 0.05)) = 3.2227 deviations of 0.044478 are 0.14334.
    EXPECT_NEAR(std::log(judged(0.0).resolution), 0.14334, 1e-4);
    EXPECT_EQ(judged(0.138).verdict, TimeVerdict::unchanged);
    EXPECT_EQ(judged(0.148).verdict, TimeVerdict::slower);
    EXPECT_EQ(judged(-0.138).verdict, TimeVerdict::unchanged);
    EXPECT_EQ(judged(-0.148).verdict, TimeVerdict::faster);
}

TEST(JudgedTimes, CountARatioBeyondTheTailsOfTheOthers) {
    std::vector<TimedPair> pairs;
    for (const double one :
         {0.0, 0.01, -0.01, 0.01, -0.01, 0.01, -0.01, 0.2, -0.2, 0.2, -0.2, 0.6, -0.6}) {
        TimedPair pair = pair_of_ratio("experiment", 1.0);
        pair.before.assign(9, 1.0);
        pair.after.assign(9, std::exp(one));
        pairs.push_back(pair);
    }
    const CommonChange common = common_of(pairs);
    // The median distance of 13 is 0.01, and only two are farther than 0.2; as for a normal
    // distribution with that median, they would reach 0.05 only.
    const double decay = (0.2 - 0.01) / std::log(0.5 * 13.0 / 2.0);
    EXPECT_NEAR(common.reach, 0.01 + decay * std::log(0.5 * 13.0 / 0.05), 1e-12);
    for (const TimeChange& change : judged_times(pairs, common, true, {}))
        EXPECT_EQ(change.verdict, TimeVerdict::unchanged) << change.ratio.value;
}

TEST(JudgedTimes, NeedRoundsThatDoNotOverlap) {
    TimedPair restless{"experiment", "restless", false, {}, std::vector<double>(9, 1.0)};
    for (int i = -4; i <= 4; ++i)
        restless.before.push_back(std::exp(0.1 * i));
    const TimedPair steady{"experiment", "steady", false, std::vector<double>(9, 1.0),
                           std::vector<double>(9, 1.0)};
    std::vector<TimedPair> pairs(8, steady);
    pairs.push_back(restless);
    const std::vector<TimeChange> changes = judged_times(pairs, common_of(pairs), true, {});
    EXPECT_EQ(changes.front().resolution, 1.03) << "less is of no interest";
    // A tenth of nine values lies 0.8 of the way from the least to the next.
    const double p10 = 0.2 * std::exp(-0.4) + 0.8 * std::exp(-0.3);
    const double p90 = 0.8 * std::exp(0.3) + 0.2 * std::exp(0.4);
    // Whether slower or faster: the middle 80 % of its rounds reach so far from their median.
    EXPECT_NEAR(std::log(changes.back().resolution), std::max(std::log(p90), -std::log(p10)),
                1e-12);
}

}  // namespace
}  // namespace relief
