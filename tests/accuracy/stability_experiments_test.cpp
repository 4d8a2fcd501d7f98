// SPDX-License-Identifier: Apache-2.0
// Where methods are known to hold, and where they are known to break.
#include "stability/stability_experiments.h"

#include <gtest/gtest.h>

#include "experiment_checks.h"
#include "stability/stability_plan.h"

namespace relief {
namespace {

bool is_plain(const std::string& method) {
    return method.starts_with("plain");
}

TEST(NormalsByScale, HoldByReliefAndBreakByPlainCode) {
    const Experiment experiment = normals_by_scale(test::quick_untimed());
    ASSERT_EQ(experiment.charts.size(), 2U);
    for (const Chart& chart : experiment.charts) {
        for (const Curve& curve : chart.curves) {
            SCOPED_TRACE(chart.id + ", " + curve.method);
            EXPECT_EQ(curve.points.size(), 16U);
            EXPECT_EQ(curve.breaks_at.has_value(), is_plain(curve.method));
            if (is_plain(curve.method)) continue;
            // The same normals at each scale: powers of ten round positions, and nothing else.
            for (const CurvePoint& point : curve.points)
                EXPECT_NEAR(point.error, curve.points.front().error, 1e-3);
        }
    }
    for (const Measurement& one : experiment.measurements)
        EXPECT_EQ(one.error.undefined > 0, is_plain(one.method)) << one.method;
}

TEST(NormalsByOffset, BreakWhenPositionsAreRounded) {
    const Experiment experiment = normals_by_offset(test::quick_untimed());
    const Chart& chart = experiment.charts.front();
    const Curve& exact = test::curve_of(chart, "angle, float64");
    const Curve& plain = test::curve_of(chart, "plain angle, float32");
    ASSERT_EQ(exact.points.size(), 9U);
    // Floats are 2^-24 of the distance apart: edges of 0.1 are lost before 1e7.
    ASSERT_TRUE(exact.breaks_at);
    EXPECT_GE(*exact.breaks_at, 1e4);
    EXPECT_LE(*exact.breaks_at, 1e7);
    ASSERT_TRUE(plain.breaks_at);
    EXPECT_LE(*plain.breaks_at, *exact.breaks_at);
}

TEST(NormalsOfNeedles, HoldInDoubleAndBreakInFloat) {
    const Experiment experiment = normals_of_needles(test::quick_untimed());
    const Chart& chart = experiment.charts.front();
    for (const Curve& curve : chart.curves) {
        SCOPED_TRACE(curve.method);
        ASSERT_EQ(curve.points.size(), 13U);
        EXPECT_LT(curve.points.front().error, 1e-2);
        if (is_plain(curve.method)) {
            ASSERT_TRUE(curve.breaks_at);
            EXPECT_LE(*curve.breaks_at, 1e8);
        } else if (curve.method.ends_with("float64")) {
            // The rule is that what is narrower than 1e-12 has no normal.
            EXPECT_GE(curve.breaks_at.value_or(1e12), 1e12);
        }
    }
}

TEST(TangentsByScale, HoldByReliefAndBreakByPlainCode) {
    const Experiment experiment = tangents_by_scale(test::quick_untimed());
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
    const Experiment experiment = tangents_by_offset(test::quick_untimed());
    ASSERT_EQ(experiment.charts.size(), 2U);
    for (const Chart& chart : experiment.charts) {
        const Curve& curve = test::curve_of(chart, "mikktspace");
        EXPECT_LT(curve.points[1].error, 0.2) << "ten images away";
        ASSERT_TRUE(curve.breaks_at);
        EXPECT_GE(*curve.breaks_at, 1e3);
    }
}

TEST(BumpBySteepness, HoldsByReliefAndBreaksByPlainCode) {
    const Experiment experiment = bump_by_steepness(test::quick_untimed());
    ASSERT_EQ(experiment.charts.size(), 2U);
    for (const Chart& chart : experiment.charts) {
        for (const Curve& curve : chart.curves) {
            SCOPED_TRACE(chart.id + ", " + curve.method);
            EXPECT_EQ(curve.points.size(), 16U);
            EXPECT_LT(curve.points.front().error, 0.5);
            // The square of a slope of 1e20 is no float.
            const bool breaks = is_plain(curve.method) && chart.id == "steeper";
            ASSERT_EQ(curve.breaks_at.has_value(), breaks);
            EXPECT_EQ(curve.breaks_at.value_or(1e20), 1e20);
        }
    }
    // What is next to flat is flat, and what is next to upright errs by its direction alone.
    const Curve& flatter = test::curve_of(experiment.charts[1], "sobel3, float64");
    EXPECT_LT(flatter.points.back().error, 1e-12);
}

TEST(BumpByOffset, BreaksWhenHeightsAreRounded) {
    const Experiment experiment = bump_by_offset(test::quick_untimed());
    for (const Curve& curve : experiment.charts.front().curves) {
        SCOPED_TRACE(curve.method);
        // Floats are 2^-24 of the height apart: half a texel at 1e7, 0.06 at 1e6.
        EXPECT_LT(curve.points[4].error, 0.5);
        ASSERT_TRUE(curve.breaks_at);
        EXPECT_GE(*curve.breaks_at, 1e6);
        EXPECT_LE(*curve.breaks_at, 1e7);
    }
}

TEST(StabilityExperiments, AreWholeButForWhatPlainCodeLoses) {
    std::vector<Experiment> all = stability_experiments(test::quick_untimed());
    for (Experiment& experiment : all) {
        EXPECT_NE(experiment.finding.find("docs/hard-cases.md"), std::string::npos);
        std::erase_if(experiment.measurements,
                      [](const Measurement& one) { return is_plain(one.method); });
    }
    test::expect_whole(all, Subject::stability);
}

}  // namespace
}  // namespace relief
