// SPDX-License-Identifier: Apache-2.0
// Frontiers and fitted orders by hand.
#include "relief/accuracy/experiment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace relief {
namespace {

Measurement measured(double rms, double seconds) {
    Measurement measurement;
    measurement.error.rms = rms;
    measurement.cost.one_thread = Timing{{seconds, seconds, seconds}};
    return measurement;
}

TEST(MarkEfficient, GoesByTheMedianOnOneThread) {
    Experiment experiment;
    experiment.measurements = {measured(1.0, 2.0), measured(2.0, 1.0), measured(2.0, 3.0)};
    experiment.measurements[1].cost.one_thread = Timing{{1.0, 9.0, 1.0}};
    experiment.measurements[2].cost.all_threads = Timing{{0.1}};  // Does not count.
    mark_efficient(experiment);
    EXPECT_TRUE(experiment.measurements[0].is_efficient);
    EXPECT_TRUE(experiment.measurements[1].is_efficient);
    EXPECT_FALSE(experiment.measurements[2].is_efficient);
}

TEST(MarkEfficient, LeavesOutWhatIsUndefinedOrWasNotTimed) {
    Experiment experiment;
    experiment.measurements = {measured(0.0, 0.5), measured(1.0, 1.0), measured(0.5, 1.0)};
    experiment.measurements[0].error.undefined = 1;
    experiment.measurements[2].cost = {};
    mark_efficient(experiment);
    EXPECT_FALSE(experiment.measurements[0].is_efficient);
    EXPECT_TRUE(experiment.measurements[1].is_efficient);
    EXPECT_FALSE(experiment.measurements[2].is_efficient);
}

TEST(FittedOrder, IsThePowerOfAPowerLaw) {
    std::vector<CurvePoint> points;
    for (const double x : {8.0, 16.0, 32.0, 64.0})
        points.push_back({x, 3.0 * std::pow(x, -4.0)});
    EXPECT_NEAR(fitted_order(points).value(), -4.0, 1e-12);
    points.push_back({128.0, 0.0});  // No logarithm.
    points.push_back({256.0, std::numeric_limits<double>::quiet_NaN()});
    EXPECT_NEAR(fitted_order(points).value(), -4.0, 1e-12);
}

TEST(FittedOrder, NeedsTwoPlaces) {
    EXPECT_FALSE(fitted_order({}));
    EXPECT_FALSE(fitted_order({{8.0, 1.0}}));
    EXPECT_FALSE(fitted_order({{8.0, 1.0}, {8.0, 2.0}}));
}

}  // namespace
}  // namespace relief
