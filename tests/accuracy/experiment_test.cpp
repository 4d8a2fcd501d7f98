// SPDX-License-Identifier: Apache-2.0
// Pareto frontiers and fitted orders, computed by hand; and comparisons of two runs: of equal runs
// no change is reported, and changes are found. Times are written down or drawn at random from
// fixed seeds, never measured.
#include "relief/accuracy/experiment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "portable_math.h"

namespace relief::test {
using namespace relief::accuracy;

namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

std::vector<bool> of(std::vector<MethodCost> prices) {
    return pareto_optimal(prices);
}

TEST(Frontier, ExcludesUnknownResults) {
    EXPECT_THAT(of({{nan, 0.0}, {0.0, nan}, {1.0, 1.0}}), ElementsAre(false, false, true));
    EXPECT_THAT(of({{infinity, 0.5}, {1.0, 1.0}}), ElementsAre(true, true));
}

TEST(Frontier, IsThatOfTheDefinitionOnRandomPrices) {
    relief::detail::Random random(3);
    for (int round = 0; round < 200; ++round) {
        std::vector<MethodCost> prices(12);
        for (MethodCost& price : prices)  // Few values give ties.
            price = {std::floor(random.between(0, 6)), std::floor(random.between(0, 6))};
        const std::vector<bool> found = pareto_optimal(prices);
        for (std::size_t i = 0; i < prices.size(); ++i) {
            const bool is_beaten =
                std::any_of(prices.begin(), prices.end(), [&](const MethodCost& other) {
                    return other.error <= prices[i].error && other.time <= prices[i].time &&
                           (other.error < prices[i].error || other.time < prices[i].time);
                });
            EXPECT_NE(found[i], is_beaten);
        }
    }
}

/// The error and the rounds of a method that takes `seconds`, in rounds that scatter by 5 %.
/// All methods of a busy round take three times as long.
MethodCost scattered(relief::detail::Random& random, double error, double seconds) {
    MethodCost cost{error, seconds};
    for (int round = 0; round < 10; ++round)
        cost.rounds.push_back(seconds * random.between(0.95, 1.05) * (round == 4 ? 3.0 : 1.0));
    return cost;
}

TEST(Frontier, TiesMeasuredTimesThatDifferByChance) {
    relief::detail::Random random(5);
    for (int run = 0; run < 200; ++run) {
        std::vector<MethodCost> costs;
        for (const auto& [error, seconds] :
             {std::pair(1.0, 1.0), std::pair(1.0, 1.0), std::pair(1.1, 0.97), std::pair(2.0, 0.7),
              std::pair(2.0, 0.7), std::pair(3.0, 0.7)})
            costs.push_back(scattered(random, error, seconds));
        EXPECT_THAT(pareto_optimal(costs), ElementsAre(true, true, false, true, true, false));
    }
}

Measurement measured(double rms, double seconds) {
    Measurement measurement;
    measurement.error.count = 1;
    measurement.error.rms = rms;
    measurement.cost.one_thread = Timing{std::vector<double>(10, seconds)};
    return measurement;
}

TEST(MarkEfficient, UsesTheTimesOnOneThread) {
    Experiment experiment;
    experiment.measurements = {measured(1.0, 2.0), measured(2.0, 1.0), measured(2.0, 3.0)};
    experiment.measurements[1].cost.one_thread->rounds[4] = 9.0;
    experiment.measurements[2].cost.all_threads = Timing{{0.1}};  // The time on one thread counts.
    mark_pareto_optimal(experiment);
    EXPECT_TRUE(experiment.measurements[0].is_pareto_optimal);
    EXPECT_TRUE(experiment.measurements[1].is_pareto_optimal);
    EXPECT_FALSE(experiment.measurements[2].is_pareto_optimal);
}

TEST(MarkEfficient, ExcludesUndefinedAndUntimedMethods) {
    Experiment experiment;
    experiment.measurements = {measured(0.0, 0.5), measured(1.0, 1.0), measured(0.5, 1.0)};
    experiment.measurements[0].error.undefined = 1;
    experiment.measurements[2].cost = {};
    mark_pareto_optimal(experiment);
    EXPECT_FALSE(experiment.measurements[0].is_pareto_optimal);
    EXPECT_TRUE(experiment.measurements[1].is_pareto_optimal);
    EXPECT_FALSE(experiment.measurements[2].is_pareto_optimal);
}

TEST(FittedOrder, IsThePowerOfAPowerLaw) {
    std::vector<CurvePoint> points;
    for (const double x : {8.0, 16.0, 32.0, 64.0})
        points.push_back({x, 3.0 * std::pow(x, -4.0)});
    EXPECT_NEAR(fitted_order(points).value(), -4.0, 1e-12);
    points.push_back({128.0, 0.0});  // It has no logarithm.
    points.push_back({256.0, nan});
    EXPECT_NEAR(fitted_order(points).value(), -4.0, 1e-12);
}

TEST(FittedOrder, NeedsTwoPoints) {
    EXPECT_FALSE(fitted_order({}));
    EXPECT_FALSE(fitted_order({{8.0, 1.0}}));
    EXPECT_FALSE(fitted_order({{8.0, 1.0}, {8.0, 2.0}}));
}

TEST(NanIfEmpty, DistinguishesNoErrorFromZero) {
    const ErrorStats none = nan_if_empty(error_stats({}));
    EXPECT_EQ(none.count, 0U);
    for (const double figure : {none.rms, none.mean, none.p99, none.max})
        EXPECT_TRUE(std::isnan(figure));
    const ErrorStats undefined = nan_if_empty(error_stats({NAN, NAN}));
    EXPECT_EQ(undefined.undefined, 2U);
    EXPECT_TRUE(std::isnan(undefined.rms));
    EXPECT_EQ(nan_if_empty(error_stats({0.0F})).rms, 0.0);
    Experiment experiment;
    for (const ErrorStats& error : {none, error_stats({0.5F})}) {
        experiment.measurements.emplace_back().error = error;
        experiment.measurements.back().cost.one_thread = Timing{{1.0}};
    }
    experiment.measurements[0].cost.one_thread = Timing{{0.1}};
    mark_pareto_optimal(experiment);
    EXPECT_FALSE(experiment.measurements[0].is_pareto_optimal) << "nothing was measured";
    EXPECT_TRUE(experiment.measurements[1].is_pareto_optimal);
}

TEST(CurveError, IsNaNIfOneResultIsUndefined) {
    EXPECT_EQ(curve_error(error_stats({3.0F, 4.0F, 0.0F, 0.0F})), 2.5);
    EXPECT_TRUE(std::isnan(curve_error(error_stats({3.0F, NAN}))));
    EXPECT_TRUE(std::isnan(curve_error(error_stats({}))));
}

/// Methods of 2 s in the old run, and of so many times that in the new one. Fastest rounds alone
/// count.
std::vector<TimeRatio> times_of(const std::vector<double>& ratios) {
    Experiment before, after;
    for (const double ratio : ratios) {
        const std::string name = "method " + std::to_string(before.measurements.size());
        before.measurements.push_back({.method = name});
        before.measurements.back().cost.one_thread = Timing{{2.02, 2.0, 50.0}};
        after.measurements.push_back({.method = name});
        after.measurements.back().cost.one_thread = Timing{{70.0, 2.02 * ratio, 2.0 * ratio}};
    }
    return compare_reports({before}, {after}).times;
}

TEST(MedianInterval, HasTheRanksOfTheBinomialDistribution) {
    // The largest rank r with P(fewer than r of n values are below the median) <= 2.5 %.
    const std::vector<std::pair<int, int>> rank_of_count = {{1, 1},  {5, 1},   {6, 1},   {8, 1},
                                                            {9, 2},  {10, 2},  {12, 3},  {15, 4},
                                                            {20, 6}, {50, 18}, {100, 40}};
    for (const auto& [count, rank] : rank_of_count) {
        std::vector<double> values;
        for (int i = count; i > 0; --i)
            values.push_back(i);
        const RatioInterval interval = median_interval(values);
        EXPECT_EQ(interval.low, rank) << count;
        EXPECT_EQ(interval.high, count + 1 - rank) << count;
        EXPECT_EQ(interval.median, 0.5 * (count + 1)) << count;
    }
}

TEST(CompareReports, TimesAreMedianRatiosOfFastestRounds) {
    const std::vector<TimeRatio> times =
        times_of({1.5, 1.2, 1.18, 1.21, 3.0, 1.19, 1.22, 1.1, 1.25});
    ASSERT_THAT(times, SizeIs(1));
    EXPECT_FALSE(times[0].subject);
    EXPECT_FALSE(times[0].on_all_threads);
    EXPECT_EQ(times[0].methods, 9U);
    // In order: 1.1 1.18 1.19 1.2 1.21 1.22 1.25 1.5 3.
    EXPECT_NEAR(times[0].ratio.low, 1.18, 1e-12);
    EXPECT_NEAR(times[0].ratio.median, 1.21, 1e-12);
    EXPECT_NEAR(times[0].ratio.high, 1.5, 1e-12);
    EXPECT_TRUE(times[0].is_slower());
    EXPECT_TRUE(times[0].is_slower(1.17));
    EXPECT_FALSE(times[0].is_slower(1.19));
    EXPECT_FALSE(times[0].is_faster());
    EXPECT_THAT(times_of({1.0, 1.0, 1.0, 1.0, 9.0}), IsEmpty()) << "fewer than 6 methods";
}

TEST(CompareReports, TimesWithin15PercentAreTied) {
    for (const double ratio : {1.149, 1.0 / 1.149}) {
        const TimeRatio tied = times_of(std::vector<double>(9, ratio)).at(0);
        EXPECT_FALSE(tied.is_slower(1.01) || tied.is_faster());
    }
    EXPECT_TRUE(times_of(std::vector<double>(9, 1.151)).at(0).is_slower());
    EXPECT_TRUE(times_of(std::vector<double>(9, 1.0 / 1.151)).at(0).is_faster());
}

TEST(CompareReports, SubjectsHaveTheirOwnTimes) {
    const auto run = [](double bake_seconds) {
        std::vector<Experiment> all(2);
        all[0].id = "bump";
        all[0].subject = Subject::bump;
        all[1].id = "bake";
        all[1].subject = Subject::bake;
        for (int i = 0; i < 12; ++i) {
            Measurement one;
            one.method = std::to_string(i);
            one.cost.all_threads = Timing{{i < 6 ? bake_seconds : 1.0}};
            all[i < 6 ? 1 : 0].measurements.push_back(one);
        }
        return all;
    };
    const std::vector<TimeRatio> times = compare_reports(run(1.0), run(2.0)).times;
    ASSERT_THAT(times, SizeIs(3));
    EXPECT_EQ(times[0].methods, 12U);
    EXPECT_FALSE(times[0].is_slower());
    EXPECT_EQ(times[1].subject, Subject::bump);
    EXPECT_EQ(times[1].ratio.high, 1.0);
    EXPECT_EQ(times[2].subject, Subject::bake);
    EXPECT_EQ(times[2].ratio.low, 2.0);
    EXPECT_TRUE(times[2].on_all_threads);
}

/// 40 methods of 10 rounds in 3 passes on a busy machine: each round scatters by 5 %, each method
/// by 1 % from run to run, each pass by 10 %, and a quarter of the rounds are interrupted.
Experiment simulated(std::mt19937_64& random, double slowdown) {
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    std::array<double, 3> pass{};
    for (double& one : pass)
        one = std::abs(0.1 * normal(random));  // Other programs only add time.
    Experiment run;
    for (std::size_t method = 0; method < 40; ++method) {
        const double between_runs = 0.01 * normal(random);
        Timing timing;
        for (std::size_t i = 0; i < 10; ++i) {
            const double noise = std::abs(0.05 * normal(random));
            const bool is_interrupted = uniform(random) < 0.25;
            timing.rounds.push_back(slowdown *
                                    std::exp(between_runs + pass.at(i * 3 / 10) + noise) *
                                    (is_interrupted ? 1.5 + 1.5 * uniform(random) : 1.0));
        }
        run.measurements.push_back({.method = std::to_string(method)});
        run.measurements.back().cost.one_thread = timing;
    }
    return run;
}

TEST(CompareReports, ASlowdownOnABusyMachineIsDetectedWithoutFalseAlarm) {
    std::mt19937_64 random(7);
    int false_alarms = 0, detected = 0;
    for (int trial = 0; trial < 200; ++trial) {
        const Experiment before = simulated(random, 1.0);
        const TimeRatio same = compare_reports({before}, {simulated(random, 1.0)}).times.at(0);
        false_alarms += same.is_slower() || same.is_faster() ? 1 : 0;
        const TimeRatio slow = compare_reports({before}, {simulated(random, 1.3)}).times.at(0);
        detected += slow.is_slower() ? 1 : 0;
    }
    EXPECT_EQ(false_alarms, 0);
    EXPECT_GE(detected, 180);
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

void add_curve(Experiment& experiment, const std::string& chart, const std::string& method,
               const std::vector<CurvePoint>& points) {
    experiment.charts.push_back({.id = chart, .curves = {{.method = method, .points = points}}});
}

TEST(CompareReports, ErrorsCountBeyondRounding) {
    const ErrorStats before{.count = 100, .rms = 0.1, .mean = 0.05, .p99 = 0.2, .max = 0.3};
    ErrorStats rounded = before;
    rounded.rms *= 1.0 + 1e-8;
    EXPECT_TRUE(
        compare_reports({one_measurement(before)}, {one_measurement(rounded)}).errors.empty());
    ErrorStats worse = before;
    worse.rms = 0.10001;
    worse.max = 0.33;
    const ReportComparison result =
        compare_reports({one_measurement(before)}, {one_measurement(worse)});
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
        compare_reports({one_measurement(before)}, {one_measurement(after)});
    ASSERT_THAT(result.errors, SizeIs(1));
    EXPECT_EQ(result.errors[0].worst().figure, "undefined");
    EXPECT_TRUE(std::isinf(result.errors[0].worst().growth()));
    EXPECT_EQ((FigureChange{"rms", nan, 0.1}.growth()), -1.0);
    EXPECT_EQ((FigureChange{"rms", 0.2, 0.1}.growth()), -0.5);
    EXPECT_TRUE(std::isinf(FigureChange{"at 1e-12", 0.1, nan}.growth()));
}

TEST(CompareReports, CurvesAreComparedPointByPoint) {
    Experiment before = one_measurement({});
    add_curve(before, "scale", "naive", {{1e-12, nan}, {1e-6, 0.5}, {1.0, 0.1}});
    Experiment after = before;
    after.charts[0].curves[0].points = {{1e-6, nan}, {1.0, 0.1}, {10.0, 0.1}};
    const ReportComparison result = compare_reports({before}, {after});
    ASSERT_THAT(result.errors, SizeIs(1));
    EXPECT_EQ(result.errors[0].chart, "scale");
    ASSERT_THAT(result.errors[0].figures, SizeIs(1));
    EXPECT_EQ(result.errors[0].figures[0].figure, "at 1e-06");
    EXPECT_TRUE(std::isinf(result.errors[0].worst().growth()));
}

TEST(CompareReports, PointsOfACurveMatchByIndex) {
    Experiment before = one_measurement({});
    add_curve(before, "angle", "fit", {{-1.0, 0.5}, {0.0, 0.1}, {1e-30, 0.2}, {1.0, 0.3}});
    EXPECT_THAT(compare_reports({before}, {before}).errors, IsEmpty());
    Experiment after = before;
    after.charts[0].curves[0].points[1].error = 0.4;
    const ReportComparison result = compare_reports({before}, {after});
    ASSERT_THAT(result.errors, SizeIs(1));
    ASSERT_THAT(result.errors[0].figures, SizeIs(1));
    EXPECT_EQ(result.errors[0].figures[0].figure, "at 0");
}

TEST(CompareReports, CurvesAndPointsWithoutAPartnerAreListed) {
    Experiment before = one_measurement({});
    add_curve(before, "scale", "naive", {{1.0, 0.1}, {10.0, 0.2}});
    add_curve(before, "offset", "naive", {});
    Experiment after = before;
    after.charts.pop_back();
    after.charts[0].curves[0].points = {{1.0, 0.1}, {100.0, 0.3}};
    const ReportComparison result = compare_reports({before}, {after});
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
    const ReportComparison result = compare_reports({before, other}, {after, resized});
    EXPECT_THAT(result.gone, ElementsAre("bump/waves: sobel3"));
    EXPECT_THAT(result.added, ElementsAre("bump/waves: scharr3"));
    EXPECT_THAT(result.other_input, ElementsAre("bump/noise"));
    EXPECT_EQ(result.methods, 0U);
}

}  // namespace
}  // namespace relief::test
