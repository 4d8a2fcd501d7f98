// SPDX-License-Identifier: Apache-2.0
// Results of the experiments on tangents: the figures of docs/tangents.md, and the expected orders.
#include "rendered_methods.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiment_checks.h"

namespace relief::test {
using namespace relief::accuracy;

namespace {

using testing::HasSubstr;

/// The experiments, run once per process.
const std::vector<Experiment>& quick_experiments() {
    static const std::vector<Experiment> all = run_quick(Subject::tangents);
    return all;
}

const Experiment& quick(const std::string& title) {
    return titled(quick_experiments(), title);
}

TEST(TangentsExperiments, AreComplete) {
    expect_whole(quick_experiments(), Subject::tangents);
}

TEST(TangentsExperiments, HaveTheErrorsOfThePage) {
    const Experiment torus = quick("Tangents: torus, jittered");
    EXPECT_NEAR(measurement_of(torus, "surface's own").error.rms, 0.045, 5e-4);
    EXPECT_NEAR(measurement_of(torus, "mikktspace").error.rms, 0.100, 5e-4);
    EXPECT_NEAR(measurement_of(torus, "area-weighted").error.max, 1.066, 5e-4);
    EXPECT_NEAR(measurement_of(torus, "screen-space").error.rms, 0.561, 5e-4);
    EXPECT_EQ(measurement_of(torus, "screen-space").cost.stored_bytes, 12.0);
    EXPECT_THAT(torus.finding,
                HasSubstr("Of the stored frames, mikktspace has the smallest error, 0.1 "
                          "degrees"));
    const Experiment plate = quick("Tangents: plate with thin bevels and a sheared image on them");
    EXPECT_NEAR(measurement_of(plate, "mikktspace").error.rms, 5.353, 5e-4);
    EXPECT_NEAR(measurement_of(plate, "area-weighted").error.rms, 0.114, 5e-4);
    EXPECT_THAT(plate.finding, HasSubstr("area-weighted has the smallest error"));
}

/// The slope between two neighboring points on logarithmic axes.
double slope_at(const Curve& curve, std::size_t i) {
    return fitted_order({curve.points[i], curve.points[i + 1]}).value();
}

TEST(TangentsExperiments, ErrorsFallAtTheOrderOfTheory) {
    const Chart regular = quick("Tangents: torus, regular").charts[0];
    for (const Curve& curve : regular.curves)
        EXPECT_NEAR(curve.order.value(), curve.expected_order.value(), 0.15) << curve.method;
    EXPECT_EQ(curve_of(regular, "mikktspace").expected_order, -2.0);
    EXPECT_EQ(curve_of(regular, "screen-space").expected_order, -1.0);

    const Chart jittered = quick("Tangents: torus, jittered").charts[0];
    for (const Curve& curve : jittered.curves) {
        SCOPED_TRACE(curve.method);
        EXPECT_EQ(curve.expected_order, -1.0);
        EXPECT_LE(curve.order.value(), -0.9);
        // The second-order error of the interpolation fades.
        EXPECT_GT(slope_at(curve, 1), slope_at(curve, 0) - 0.05);
        EXPECT_NEAR(slope_at(curve, 1), -1.0, 0.4);
    }
}

TEST(TangentsExperiments, WiderBevelsLeaveAreaWeightsMoreToErr) {
    const Chart chart =
        quick("Tangents: plate with thin bevels and a sheared image on them").charts.front();
    const Curve& by_area = curve_of(chart, "area-weighted");
    EXPECT_LT(by_area.points.front().error, 0.1);
    EXPECT_GT(by_area.points.back().error, 1.0);
    // Angles do not depend on the width of a bevel.
    const Curve& by_angle = curve_of(chart, "mikktspace");
    EXPECT_NEAR(by_angle.points[0].error, by_angle.points[1].error, 0.1);
}

TEST(TangentsExperiments, MapsComeBackFromTheirOwnBasisAlone) {
    const Experiment mismatch = quick("Tangents: bases that differ");
    ASSERT_EQ(mismatch.measurements.size(), 25U);
    for (const Measurement& one : mismatch.measurements) {
        if (one.choices[0].second == one.choices[1].second)
            EXPECT_LE(one.error.max, 1e-5) << one.method;
        else
            EXPECT_GE(one.error.rms, 1e-2) << one.method;
    }
}

TEST(RenderedFrames, OnFewTrianglesDerivedOnesAreFartherOff) {
    if (!accuracy::detail::GlDevice().is_available()) GTEST_SKIP() << "no OpenGL";
    const Experiment experiment = run_one("tangents/drawn");
    const auto rms = [&](const char* method) {
        return measurement_of(experiment, method).error.rms;
    };
    // Frames that jump between facets have a small visible error, which vanishes on many triangles.
    EXPECT_GT(rms("derived, 576 triangles"), 1.005 * rms("stored, 576 triangles"));
    EXPECT_LT(rms("derived, 576 triangles"), 1.1 * rms("stored, 576 triangles"));
    EXPECT_NEAR(rms("derived, 147456 triangles"), rms("stored, 147456 triangles"),
                0.005 * rms("stored, 147456 triangles"));
    EXPECT_LT(rms("stored, 147456 triangles"), 0.5 * rms("stored, 576 triangles"));
    // An image without the normal map has a large error.
    EXPECT_GT(rms("no normal map, 9216 triangles"), 5.0 * rms("stored, 9216 triangles"));
    EXPECT_EQ(measurement_of(experiment, "stored, 576 triangles").cost.stored_bytes, 28.0);
    EXPECT_EQ(measurement_of(experiment, "derived, 576 triangles").cost.stored_bytes, 12.0);
    EXPECT_EQ(experiment.pictures.size(), 3U);
}

TEST(RenderedFrames, TakeTimeOfAllThreads) {
    if (!accuracy::detail::GlDevice().is_available()) GTEST_SKIP() << "no OpenGL";
    RunOptions options = quick_untimed();
    options.is_timed = true;
    options.repeats = {3, 0};
    for (const Measurement& one : run_one("tangents/drawn", options).measurements) {
        SCOPED_TRACE(one.method);
        ASSERT_TRUE(one.cost.all_threads);
        EXPECT_EQ(one.cost.all_threads->rounds.size(), 3U);
        EXPECT_GT(one.cost.all_threads->spread().median, 1e-5);
    }
}

}  // namespace
}  // namespace relief::test
