// SPDX-License-Identifier: Apache-2.0
// What is run becomes a measurement; what has no time keeps none.
#include "measured_methods.h"

#include <gtest/gtest.h>

#include <cmath>

namespace relief {
namespace {

MeasuredMethod method_of(const std::string& name, double rms, std::function<void()> work) {
    MeasuredMethod method;
    method.name = name;
    method.choices = {{"kind", name}};
    method.error.rms = rms;
    method.work = std::move(work);
    method.stored_bytes = 4.0;
    return method;
}

TEST(MeasureMethods, GivesEachItsOwnCostAndNoneToThoseWithoutWork) {
    RunOptions options;
    options.repeats = {3, 0};
    std::size_t first = 0;
    std::size_t last = 0;
    const std::vector<MeasuredMethod> methods = {method_of("first", 1.0, [&] { ++first; }),
                                                 method_of("none", 0.5, {}),
                                                 method_of("last", 2.0, [&] { ++last; })};
    Experiment experiment;
    measure_methods(methods, options, {.one_thread = true, .all_threads = false, .memory = false},
                    experiment);
    ASSERT_EQ(experiment.measurements.size(), 3U);
    EXPECT_GT(first, 0U);
    EXPECT_GT(last, 0U);
    EXPECT_EQ(experiment.measurements[0].cost.one_thread.value().rounds.size(), 3U);
    EXPECT_FALSE(experiment.measurements[1].cost.one_thread);
    EXPECT_TRUE(experiment.measurements[2].cost.one_thread);
    EXPECT_EQ(experiment.measurements[1].cost.stored_bytes, 4.0);
    EXPECT_TRUE(std::isnan(median_seconds(experiment.measurements[1])));
    EXPECT_FALSE(experiment.measurements[1].is_efficient);  // Its time is not known.
    EXPECT_TRUE(experiment.measurements[0].is_efficient);
    EXPECT_EQ(value_of(experiment.measurements[2], "kind"), "last");
    EXPECT_EQ(value_of(experiment.measurements[2], "colour"), "");
}

TEST(MeasureMethods, RunsNothingWhereNothingIsTimed) {
    RunOptions options;
    options.is_timed = false;
    const std::vector<MeasuredMethod> methods = {method_of("one", 1.0, [] { FAIL(); })};
    Experiment experiment;
    measure_methods(methods, options, {}, experiment);
    EXPECT_FALSE(experiment.measurements[0].cost.one_thread);
    EXPECT_FALSE(experiment.measurements[0].is_efficient);
}

TEST(Truest, HasTheLeastErrorOfThoseThatAreDefined) {
    Experiment experiment;
    EXPECT_EQ(truest(experiment), nullptr);
    for (const double rms : {3.0, 1.0, 2.0}) {
        experiment.measurements.emplace_back();
        experiment.measurements.back().error.rms = rms;
    }
    EXPECT_EQ(truest(experiment), &experiment.measurements[1]);
    experiment.measurements[1].error.undefined = 1;
    EXPECT_EQ(truest(experiment), &experiment.measurements[2]);
}

TEST(FittedCurve, HasTheSlopeOfItsPoints) {
    const Curve curve = fitted_curve("m", {{1.0, 8.0}, {2.0, 2.0}, {4.0, 0.5}}, -2.0);
    EXPECT_NEAR(curve.order.value(), -2.0, 1e-12);
    EXPECT_EQ(curve.expected_order, -2.0);
    EXPECT_EQ(curve.points.size(), 3U);
}

}  // namespace
}  // namespace relief
