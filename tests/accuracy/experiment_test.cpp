// SPDX-License-Identifier: Apache-2.0
// Pareto frontiers and fitted orders, computed by hand.
#include "relief/accuracy/experiment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "portable_math.h"

namespace relief {
using namespace relief::accuracy;

namespace {

using testing::ElementsAre;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

std::vector<bool> of(std::vector<MethodCost> prices) {
    return pareto_optimal(prices);
}

TEST(Frontier, ExcludesUnknownResults) {
    EXPECT_THAT(of({{unknown, 0.0}, {0.0, unknown}, {1.0, 1.0}}), ElementsAre(false, false, true));
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
    points.push_back({256.0, std::numeric_limits<double>::quiet_NaN()});
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
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const ErrorStats undefined = nan_if_empty(error_stats({nan, nan}));
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
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(std::isnan(curve_error(error_stats({3.0F, nan}))));
    EXPECT_TRUE(std::isnan(curve_error(error_stats({}))));
}

}  // namespace
}  // namespace relief
