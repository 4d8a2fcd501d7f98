// SPDX-License-Identifier: Apache-2.0
// Comparisons of two runs: of equal runs no change is reported, and changes are found. Times are
// written down or drawn at random from fixed seeds, never measured.
#include "relief/accuracy/experiment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace relief {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::vector<std::string> methods_that_are(const ReportComparison& result, TimeVerdict verdict) {
    std::vector<std::string> names;
    for (const TimeChange& change : result.times) {
        if (change.verdict == verdict) names.push_back(change.experiment + ": " + change.method);
    }
    return names;
}

/// Nine methods of one experiment, timed on one thread; method i has the rounds i.
std::vector<Experiment> timed(const std::vector<std::vector<double>>& rounds) {
    Experiment experiment;
    experiment.id = "subject/one";
    for (std::size_t i = 0; i < rounds.size(); ++i) {
        Measurement one;
        one.method = "method " + std::to_string(i);
        one.cost.one_thread = Timing{rounds[i]};
        experiment.measurements.push_back(one);
    }
    return {experiment};
}

/// Methods of 2 s in the old run, and of so many times that in the new one. Fastest rounds alone
/// count; the median rounds are 1 % slower.
ReportComparison compared_by_ratios(const std::vector<double>& ratios, bool same_machine = true,
                                    const std::optional<double>& max_ratio = {}) {
    std::vector<std::vector<double>> before, after;
    for (const double ratio : ratios) {
        before.push_back({2.02, 2.0, 50.0});
        after.push_back({70.0, 2.02 * ratio, 2.0 * ratio});
    }
    return compare_reports(timed(before), timed(after), same_machine, max_ratio);
}

constexpr double rounding = 1e-12;

TEST(CompareReports, TheCommonRatioIsTheMedianOfAllRatios) {
    const CommonChange common =
        compared_by_ratios({1.5, 1.2, 1.18, 1.21, 3.0, 1.19, 1.22, 1.1, 1.25}).one_thread;
    EXPECT_EQ(common.methods, 9U);
    EXPECT_TRUE(common.is_judged);
    // In order: 1.1 1.18 1.19 1.2 1.21 1.22 1.25 1.5 3.
    EXPECT_NEAR(common.ratio, 1.21, rounding);
    EXPECT_NEAR(common.lower_quartile, 1.19, rounding);
    EXPECT_NEAR(common.upper_quartile, 1.25, rounding);
    EXPECT_NEAR(common.resolution, 1.0 + 12.0 * (1.25 / 1.19 - 1.0), rounding);
    EXPECT_EQ(common.verdict, TimeVerdict::unchanged);
}

TEST(CompareReports, QuartilesOfAnEvenNumberLieBetweenRatios) {
    const CommonChange common =
        compared_by_ratios({1.0, 1.01, 1.02, 1.03, 1.04, 1.05, 1.06, 1.07}).one_thread;
    EXPECT_NEAR(common.ratio, 1.035, rounding);
    EXPECT_NEAR(common.lower_quartile, 1.0175, rounding);
    EXPECT_NEAR(common.upper_quartile, 1.0525, rounding);
}

TEST(CompareReports, AMethodIsJudgedByTwelveInterquartileRanges) {
    // The quartiles of the nine ratios are 0.99 and 1.01, the median is 1.
    const auto judged = [](double ratio) {
        const ReportComparison result =
            compared_by_ratios({0.98, 0.99, 0.99, 1.0, 1.0, 1.0, 1.01, 1.01, ratio});
        EXPECT_NEAR(result.one_thread.resolution, 1.0 + 12.0 * (1.01 / 0.99 - 1.0), rounding);
        EXPECT_NEAR(result.times.back().resolution, 1.01 * result.one_thread.resolution, rounding);
        return result.times.back();
    };
    EXPECT_EQ(judged(1.25).verdict, TimeVerdict::unchanged);
    EXPECT_EQ(judged(1.26).verdict, TimeVerdict::slower);
    EXPECT_NEAR(judged(1.26).counted, 1.26, rounding);
    EXPECT_NEAR(judged(1.26).before, 2.0, rounding);
    EXPECT_NEAR(judged(1.26).after, 2.52, rounding);
}

TEST(CompareReports, ChangesOfLessThanATenthAreNotReported) {
    EXPECT_EQ(compared_by_ratios({1, 1, 1, 1, 1, 1, 1, 1, 1.099}).times.back().verdict,
              TimeVerdict::unchanged);
    EXPECT_EQ(compared_by_ratios({1, 1, 1, 1, 1, 1, 1, 1, 1.101}).times.back().verdict,
              TimeVerdict::slower);
    EXPECT_EQ(compared_by_ratios({1, 1, 1, 1, 1, 1, 1, 1, 1.0 / 1.099}).times.back().verdict,
              TimeVerdict::unchanged);
    EXPECT_EQ(compared_by_ratios({1, 1, 1, 1, 1, 1, 1, 1, 1.0 / 1.101}).times.back().verdict,
              TimeVerdict::faster);
}

TEST(CompareReports, AChangeOfAllMethodsIsReportedOnce) {
    const std::vector<double> all(9, 1.3);
    const ReportComparison result = compared_by_ratios(all);
    EXPECT_EQ(result.one_thread.verdict, TimeVerdict::slower);
    EXPECT_NEAR(result.one_thread.ratio, 1.3, rounding);
    EXPECT_THAT(methods_that_are(result, TimeVerdict::slower), IsEmpty());
    EXPECT_EQ(result.all_threads.methods, 0U);
    EXPECT_EQ(compared_by_ratios(all, false).one_thread.verdict, TimeVerdict::unchanged)
        << "another machine";
}

TEST(CompareReports, AMethodThatGainedLessThanTheOthersIsNotSlower) {
    const std::vector<double> ratios = {0.7, 0.7, 0.7, 0.7, 0.7, 0.7, 0.7, 0.7, 0.9};
    const ReportComparison same = compared_by_ratios(ratios);
    EXPECT_THAT(methods_that_are(same, TimeVerdict::slower), IsEmpty());
    // Another machine explains that all others are faster.
    const ReportComparison other = compared_by_ratios(ratios, false);
    EXPECT_THAT(methods_that_are(other, TimeVerdict::slower), ElementsAre("subject/one: method 8"));
    EXPECT_NEAR(other.times[8].counted, 0.9 / 0.7, rounding);
}

TEST(CompareReports, BoundBelowTheResolutionIsUndecidable) {
    // The resolution is 1.242 of all methods, and 1.255 of each.
    const std::vector<double> ratios = {0.98, 0.99, 0.99, 1.0, 1.0, 1.0, 1.01, 1.01, 2.0};
    const ReportComparison narrow = compared_by_ratios(ratios, true, 1.1);
    EXPECT_THAT(methods_that_are(narrow, TimeVerdict::cannot_tell), SizeIs(8));
    EXPECT_THAT(methods_that_are(narrow, TimeVerdict::slower),
                ElementsAre("subject/one: method 8"));
    EXPECT_EQ(narrow.one_thread.verdict, TimeVerdict::cannot_tell);
    const ReportComparison wide = compared_by_ratios(ratios, true, 1.26);
    EXPECT_THAT(methods_that_are(wide, TimeVerdict::cannot_tell), IsEmpty());
    EXPECT_EQ(wide.one_thread.verdict, TimeVerdict::unchanged);
}

TEST(CompareReports, NeedsEightMethodsToJudgeTimes) {
    const std::vector<double> ratios = {1, 1, 1, 1, 1, 1, 5.0};
    const ReportComparison result = compared_by_ratios(ratios);
    EXPECT_FALSE(result.one_thread.is_judged);
    EXPECT_EQ(result.times.back().verdict, TimeVerdict::unchanged);
    EXPECT_THAT(methods_that_are(compared_by_ratios(ratios, true, 100.0), TimeVerdict::cannot_tell),
                SizeIs(7));
}

TEST(CompareReports, AMethodWhoseRoundsScatterIsNotWithinABound) {
    // One method has a median round of 3.5 times its fastest, so a ratio of 2 may be chance.
    const std::vector<double> steady(9, 1.0);
    const std::vector<double> before = {1.0, 5.0, 2.0, 9.0, 3.5, 8.0, 4.0, 1.5, 3.0};
    std::vector<double> after = before;
    for (double& seconds : after)
        seconds *= 2.0;
    std::vector<std::vector<double>> all(9, steady);
    all[4] = before;
    const std::vector<Experiment> old_run = timed(all);
    all[4] = after;
    const std::vector<Experiment> new_run = timed(all);
    const ReportComparison result = compare_reports(old_run, new_run, true, 1.1);
    EXPECT_THAT(methods_that_are(result, TimeVerdict::slower), IsEmpty());
    EXPECT_THAT(methods_that_are(result, TimeVerdict::cannot_tell),
                ElementsAre("subject/one: method 4"));
    EXPECT_NEAR(result.times[4].ratio, 2.0, rounding);
    EXPECT_NEAR(result.times[4].resolution, 3.5, rounding);
    // Without a bound there is nothing to prove, and a wide bound is kept.
    for (const std::optional<double>& bound : {std::optional<double>(), std::optional(4.0)}) {
        EXPECT_THAT(methods_that_are(compare_reports(old_run, new_run, true, bound),
                                     TimeVerdict::cannot_tell),
                    IsEmpty());
    }
}

/// How the times of a run on a busy machine are drawn.
struct Simulation {
    double noise = 0.05;         ///< Of each round, as a deviation of its logarithm.
    double between_runs = 0.01;  ///< Of a method from run to run, in all its rounds.
    double drift = 0.1;          ///< Of the machine from pass to pass.
    double interrupted = 0.25;   ///< Part of the rounds that take 1.5 to 3 times as long.
};

/// 40 methods of 10 rounds in 3 passes.
std::vector<Experiment> simulated(std::mt19937_64& random, const Simulation& simulation) {
    constexpr std::size_t passes = 3, rounds = 10, methods = 40;
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    std::array<double, passes> speed{};
    for (double& one : speed)
        one = std::abs(simulation.drift * normal(random));  // Other programs only add time.
    std::vector<std::vector<double>> all(methods);
    for (std::size_t method = 0; method < methods; ++method) {
        const double run = simulation.between_runs * normal(random);
        for (std::size_t i = 0; i < rounds; ++i) {
            const double noise = std::abs(simulation.noise * normal(random));
            const bool is_interrupted = uniform(random) < simulation.interrupted;
            all[method].push_back(1e-3 * std::exp(run + speed.at(i * passes / rounds) + noise) *
                                  (is_interrupted ? 1.5 + 1.5 * uniform(random) : 1.0));
        }
    }
    return timed(all);
}

TEST(CompareReports, EqualRunsOnABusyMachineHaveNoChange) {
    std::mt19937_64 random(7);
    for (int trial = 0; trial < 200; ++trial) {
        const ReportComparison result =
            compare_reports(simulated(random, {}), simulated(random, {}), true, 1.1);
        EXPECT_THAT(methods_that_are(result, TimeVerdict::slower), IsEmpty());
        EXPECT_THAT(methods_that_are(result, TimeVerdict::faster), IsEmpty());
        EXPECT_NE(result.one_thread.verdict, TimeVerdict::slower);
        EXPECT_NE(result.one_thread.verdict, TimeVerdict::faster);
        // These times do not prove that the bound of a tenth is kept.
        EXPECT_FALSE(methods_that_are(result, TimeVerdict::cannot_tell).empty());
    }
}

TEST(CompareReports, DoubledTimeOnABusyMachineIsDetectedOrUndecidable) {
    std::mt19937_64 random(8);
    int found = 0;
    for (int trial = 0; trial < 200; ++trial) {
        const std::vector<Experiment> before = simulated(random, {});
        std::vector<Experiment> after = simulated(random, {});
        for (double& seconds : after[0].measurements[17].cost.one_thread->rounds)
            seconds *= 2.0;
        const ReportComparison result = compare_reports(before, after, true, 1.1);
        const TimeVerdict verdict = result.times[17].verdict;
        found += verdict == TimeVerdict::slower ? 1 : 0;
        EXPECT_TRUE(verdict == TimeVerdict::slower || verdict == TimeVerdict::cannot_tell);
        EXPECT_LE(methods_that_are(result, TimeVerdict::slower).size(), 1U);
    }
    EXPECT_GE(found, 170) << "in the others, the rounds of the method scatter by 1.5 and more";
}

Experiment one_measurement(const ErrorStats& error) {
    Experiment experiment;
    experiment.id = "bump/waves";
    experiment.error_unit = "degrees";
    Measurement one;
    one.method = "sobel3";
    one.error = error;
    experiment.measurements.push_back(one);
    return experiment;
}

TEST(CompareReports, ErrorsCountBeyondRounding) {
    const ErrorStats before{.count = 100, .rms = 0.1, .mean = 0.05, .p99 = 0.2, .max = 0.3};
    ErrorStats rounded = before;
    rounded.rms *= 1.0 + 1e-8;
    EXPECT_TRUE(compare_reports({one_measurement(before)}, {one_measurement(rounded)}, true)
                    .errors.empty());
    ErrorStats worse = before;
    worse.rms = 0.10001;
    worse.max = 0.33;
    const ReportComparison result =
        compare_reports({one_measurement(before)}, {one_measurement(worse)}, true);
    ASSERT_THAT(result.errors, SizeIs(1));
    EXPECT_EQ(result.errors[0].method, "sobel3");
    EXPECT_EQ(result.errors[0].chart, "");
    ASSERT_THAT(result.errors[0].figures, SizeIs(2));
    EXPECT_EQ(result.errors[0].figures[0].figure, "rms");
    EXPECT_EQ(result.errors[0].worst().figure, "max");
    EXPECT_NEAR(result.errors[0].worst().growth(), 0.1, 1e-12);
}

TEST(CompareReports, ResultsThatBecameUnusableAreEndlessGrowth) {
    ErrorStats before{.count = 100};
    ErrorStats after = before;
    after.undefined = 1;
    after.count = 99;
    const ReportComparison result =
        compare_reports({one_measurement(before)}, {one_measurement(after)}, true);
    ASSERT_THAT(result.errors, SizeIs(1));
    EXPECT_EQ(result.errors[0].worst().figure, "undefined");
    EXPECT_TRUE(std::isinf(result.errors[0].worst().growth()));
    EXPECT_EQ((FigureChange{"rms", nan, 0.1}.growth()), -1.0);
    EXPECT_EQ((FigureChange{"rms", 0.2, 0.1}.growth()), -0.5);
    EXPECT_TRUE(std::isinf(FigureChange{"at 1e-12", 0.1, nan}.growth()));
}

TEST(CompareReports, CurvesAreComparedPointByPoint) {
    Experiment before = one_measurement({});
    before.charts.push_back({"scale", "", "", "", true, {}, {{"naive", {}, {}, {}, {}}}});
    before.charts[0].curves[0].points = {{1e-12, nan}, {1e-6, 0.5}, {1.0, 0.1}};
    Experiment after = before;
    after.charts[0].curves[0].points = {{1e-6, nan}, {1.0, 0.1}, {10.0, 0.1}};
    const ReportComparison result = compare_reports({before}, {after}, true);
    ASSERT_THAT(result.errors, SizeIs(1));
    EXPECT_EQ(result.errors[0].chart, "scale");
    ASSERT_THAT(result.errors[0].figures, SizeIs(1));
    EXPECT_EQ(result.errors[0].figures[0].figure, "at 1e-06");
    EXPECT_TRUE(std::isinf(result.errors[0].worst().growth()));
}

TEST(CompareReports, PointsOfACurveMatchByIndex) {
    Experiment before = one_measurement({});
    before.charts.push_back({"angle", "", "", "", false, {}, {{"fit", {}, {}, {}, {}}}});
    before.charts[0].curves[0].points = {{-1.0, 0.5}, {0.0, 0.1}, {1e-30, 0.2}, {1.0, 0.3}};
    EXPECT_THAT(compare_reports({before}, {before}, true).errors, IsEmpty());
    Experiment after = before;
    after.charts[0].curves[0].points[1].error = 0.4;
    const ReportComparison result = compare_reports({before}, {after}, true);
    ASSERT_THAT(result.errors, SizeIs(1));
    ASSERT_THAT(result.errors[0].figures, SizeIs(1));
    EXPECT_EQ(result.errors[0].figures[0].figure, "at 0");
}

TEST(CompareReports, CurvesAndPointsWithoutAPartnerAreListed) {
    Experiment before = one_measurement({});
    before.charts.push_back({"scale", "", "", "", true, {}, {{"naive", {}, {}, {}, {}}}});
    before.charts[0].curves[0].points = {{1.0, 0.1}, {10.0, 0.2}};
    before.charts.push_back({"offset", "", "", "", true, {}, {{"naive", {}, {}, {}, {}}}});
    Experiment after = before;
    after.charts.pop_back();
    after.charts[0].curves[0].points = {{1.0, 0.1}, {100.0, 0.3}};
    const ReportComparison result = compare_reports({before}, {after}, true);
    EXPECT_THAT(result.gone, ElementsAre("bump/waves, chart scale: naive at 10",
                                         "bump/waves, chart offset: naive"));
    EXPECT_THAT(result.added, ElementsAre("bump/waves, chart scale: naive at 100"));
    EXPECT_THAT(result.errors, IsEmpty());
}

TEST(CompareReports, ListsUnmatchedMethods) {
    Experiment before = one_measurement({});
    Experiment after = before;
    after.measurements[0].method = "scharr3";
    Experiment other = before;
    other.id = "bump/noise";
    Experiment resized = other;
    resized.input = "another size";
    const ReportComparison result = compare_reports({before, other}, {after, resized}, true);
    EXPECT_THAT(result.gone, ElementsAre("bump/waves: sobel3"));
    EXPECT_THAT(result.added, ElementsAre("bump/waves: scharr3"));
    EXPECT_THAT(result.other_input, ElementsAre("bump/noise"));
    EXPECT_EQ(result.methods, 0U);
}

}  // namespace
}  // namespace relief
