// SPDX-License-Identifier: Apache-2.0
// Sweeps computed by hand, and the values up to which methods are known to work.
#include "experiment_parts.h"

#include <gtest/gtest.h>

#include <cmath>

#include "experiment_checks.h"

namespace relief {
using namespace relief::accuracy;
using namespace relief::accuracy::detail;

namespace {

TEST(Sweeps, FindTheFailurePointOfEachMethod) {
    Sweeps sweeps({"good", "growing", "lost"}, 1.0);
    sweeps.add("size", "Larger", "size", 6, 2, [](std::size_t method, double value) {
        if (method == 0) return std::vector<float>{0.25F, 0.25F};
        if (method == 1) return std::vector<float>{static_cast<float>(1e-3 * value)};
        return std::vector<float>{0.0F, value > 50.0 ? NAN : 0.5F};
    });
    EXPECT_EQ(sweeps.measure(0).count, 8U);
    sweeps.measure(1);
    EXPECT_EQ(sweeps.measure(2).undefined, 3U);
    ASSERT_EQ(sweeps.charts().size(), 1U);
    const std::vector<Curve>& curves = sweeps.charts().front().curves;
    ASSERT_EQ(curves[0].points.size(), 4U);
    EXPECT_EQ(curves[0].points[1].x, 100.0);
    EXPECT_NEAR(curves[0].points[3].error, 0.25, 1e-7);
    EXPECT_FALSE(curves[0].breaks_at);
    EXPECT_EQ(curves[1].breaks_at, 1e4) << "0.1 degrees at 100";
    EXPECT_EQ(curves[2].breaks_at, 100.0);
    EXPECT_TRUE(std::isnan(curves[2].points[1].error)) << "half a result is none";
    EXPECT_EQ(sweeps.breaks(),
              "Larger (size): lost fails from 100 on, growing fails from 1e+04 on, all others are "
              "within the limit.");
}

TEST(Sweeps, SayThatAllAreWithinTheLimitOrNone) {
    Sweeps sweeps({"a", "b"}, 1.0);
    sweeps.add("x", "Good", "x", 1, 1, [](std::size_t, double) { return std::vector{0.5F}; });
    sweeps.add("y", "Bad", "y", 1, 1, [](std::size_t, double) { return std::vector{5.0F}; });
    sweeps.measure(0);
    sweeps.measure(1);
    EXPECT_EQ(sweeps.breaks(),
              "Good (x): all are within the limit. Bad (y): a and b fail from 1 on, none is within "
              "the limit everywhere.");
}

bool is_plain(const std::string& method) {
    return method.starts_with("plain");
}

TEST(NormalsByScale, HoldByReliefAndBreakByPlainCode) {
    const Experiment experiment = test::run_one("stability/normals-scale");
    ASSERT_EQ(experiment.charts.size(), 2U);
    for (const Chart& chart : experiment.charts) {
        for (const Curve& curve : chart.curves) {
            SCOPED_TRACE(chart.id + ", " + curve.method);
            EXPECT_EQ(curve.points.size(), 16U);
            EXPECT_EQ(curve.breaks_at.has_value(), is_plain(curve.method));
            if (is_plain(curve.method)) continue;
            // The normals are the same at each scale; powers of ten only round positions.
            for (const CurvePoint& point : curve.points)
                EXPECT_NEAR(point.error, curve.points.front().error, 1e-3);
        }
    }
    for (const Measurement& one : experiment.measurements)
        EXPECT_EQ(one.error.undefined > 0, is_plain(one.method)) << one.method;
}

TEST(NormalsByOffset, BreakWhenPositionsAreRounded) {
    const Experiment experiment = test::run_one("stability/normals-offset");
    const Chart& chart = experiment.charts.front();
    const Curve& exact = test::curve_of(chart, "angle, float64");
    const Curve& plain = test::curve_of(chart, "plain angle, float32");
    ASSERT_EQ(exact.points.size(), 9U);
    // Floats are 2^-24 of the distance apart, so edges of length 0.1 vanish before 1e7.
    ASSERT_TRUE(exact.breaks_at);
    EXPECT_GE(*exact.breaks_at, 1e4);
    EXPECT_LE(*exact.breaks_at, 1e7);
    ASSERT_TRUE(plain.breaks_at);
    EXPECT_LE(*plain.breaks_at, *exact.breaks_at);
}

TEST(NormalsOfNeedles, HoldInDoubleAndBreakInFloat) {
    const Experiment experiment = test::run_one("stability/normals-needles");
    const Chart& chart = experiment.charts.front();
    for (const Curve& curve : chart.curves) {
        SCOPED_TRACE(curve.method);
        ASSERT_EQ(curve.points.size(), 13U);
        EXPECT_LT(curve.points.front().error, 1e-2);
        if (is_plain(curve.method)) {
            ASSERT_TRUE(curve.breaks_at);
            EXPECT_LE(*curve.breaks_at, 1e8);
        } else if (curve.method.ends_with("float64")) {
            // Triangles narrower than 1e-12 have no normal by definition.
            EXPECT_GE(curve.breaks_at.value_or(1e12), 1e12);
        }
    }
}

TEST(TangentsByScale, HoldByReliefAndBreakByPlainCode) {
    const Experiment experiment = test::run_one("stability/tangents-scale");
    ASSERT_EQ(experiment.charts.size(), 4U);
    for (const Chart& chart : experiment.charts) {
        for (const Curve& curve : chart.curves) {
            SCOPED_TRACE(chart.id + ", " + curve.method);
            EXPECT_LT(curve.points.front().error, 0.2);
            if (is_plain(curve.method)) continue;
            EXPECT_FALSE(curve.breaks_at);
        }
    }
    EXPECT_TRUE(test::curve_of(experiment.charts[2], "plain").breaks_at);
}

TEST(TangentsByOffset, BreakWhenCoordinatesAreRounded) {
    const Experiment experiment = test::run_one("stability/tangents-offset");
    ASSERT_EQ(experiment.charts.size(), 2U);
    for (const Chart& chart : experiment.charts) {
        const Curve& curve = test::curve_of(chart, "mikktspace");
        EXPECT_LT(curve.points[1].error, 0.2) << "ten images away";
        ASSERT_TRUE(curve.breaks_at);
        EXPECT_GE(*curve.breaks_at, 1e3);
    }
}

TEST(BumpBySteepness, HoldsByReliefAndBreaksByPlainCode) {
    const Experiment experiment = test::run_one("stability/bump-steepness");
    ASSERT_EQ(experiment.charts.size(), 2U);
    for (const Chart& chart : experiment.charts) {
        for (const Curve& curve : chart.curves) {
            SCOPED_TRACE(chart.id + ", " + curve.method);
            EXPECT_EQ(curve.points.size(), 16U);
            EXPECT_LT(curve.points.front().error, 0.5);
            // The square of a slope of 1e20 exceeds the range of float.
            const bool breaks = is_plain(curve.method) && chart.id == "steeper";
            ASSERT_EQ(curve.breaks_at.has_value(), breaks);
            EXPECT_EQ(curve.breaks_at.value_or(1e20), 1e20);
        }
    }
    // A nearly flat map is flat, and for a nearly upright one only the direction counts.
    const Curve& flatter = test::curve_of(experiment.charts[1], "sobel3, float64");
    EXPECT_LT(flatter.points.back().error, 1e-12);
}

TEST(BumpByOffset, BreaksWhenHeightsAreRounded) {
    const Experiment experiment = test::run_one("stability/bump-offset");
    for (const Curve& curve : experiment.charts.front().curves) {
        SCOPED_TRACE(curve.method);
        // Floats are 2^-24 of the height apart: half a texel at 1e7, 0.06 at 1e6.
        EXPECT_LT(curve.points[4].error, 0.5);
        ASSERT_TRUE(curve.breaks_at);
        EXPECT_GE(*curve.breaks_at, 1e6);
        EXPECT_LE(*curve.breaks_at, 1e7);
    }
}

TEST(StabilityExperiments, AreCompleteExceptForNaiveCode) {
    std::vector<Experiment> all = test::run_quick(Subject::stability);
    for (Experiment& experiment : all) {
        EXPECT_NE(experiment.finding.find("docs/hard-cases.md"), std::string::npos);
        std::erase_if(experiment.measurements,
                      [](const Measurement& one) { return is_plain(one.method); });
    }
    test::expect_whole(all, Subject::stability);
}

}  // namespace
}  // namespace relief
