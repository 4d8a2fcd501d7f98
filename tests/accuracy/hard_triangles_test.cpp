// SPDX-License-Identifier: Apache-2.0
// Triangles that are no part of a surface, and what they do to the normals around them.
#include "stability/hard_triangles.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "experiment_checks.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/shapes.h"
#include "stability/stability_plan.h"

namespace relief {
namespace {

Mesh sound_torus() {
    return make_torus(0.4F, 24, 12);
}

TEST(HardTriangles, LieBesideTheMeshAsItWas) {
    const Mesh sound = sound_torus();
    for (const HardTriangleWords& one : hard_triangle_words) {
        SCOPED_TRACE(one.id);
        const Mesh hard = with_hard_triangles(sound, one.kind, 10);
        ASSERT_EQ(hard.triangles.size(), sound.triangles.size() + 10);
        for (std::size_t t = 0; t < sound.triangles.size(); ++t)
            EXPECT_EQ(hard.triangles[t], sound.triangles[t]);
        for (std::size_t v = 0; v < sound.positions.size(); ++v)
            EXPECT_EQ(hard.positions[v], sound.positions[v]);
        EXPECT_NO_THROW(validate(hard));
    }
    EXPECT_EQ(with_hard_triangles(sound, HardTriangle::back, 100000).triangles.size(),
              2 * sound.triangles.size());
}

TEST(HardTriangles, AreWhatTheirNamesSay) {
    const Mesh sound = sound_torus();
    const auto last = [&](HardTriangle kind) {
        const Mesh hard = with_hard_triangles(sound, kind, 3);
        const glm::uvec3& t = hard.triangles.back();
        return std::array{hard.positions[t.x], hard.positions[t.y], hard.positions[t.z]};
    };
    EXPECT_EQ(last(HardTriangle::collapsed)[1], last(HardTriangle::collapsed)[2]);
    EXPECT_EQ(last(HardTriangle::coinciding)[1], last(HardTriangle::coinciding)[2]);
    EXPECT_TRUE(std::isnan(last(HardTriangle::nowhere)[2].x));
    const auto [a, b, middle] = last(HardTriangle::needle);
    // Rounding of the middle: half a unit of the last of 24 bits, of coordinates below 2.
    EXPECT_LT(glm::length(glm::cross(b - a, middle - a)) / glm::length(b - a), 2e-7F);
    EXPECT_GT(glm::length(middle - a), 0.4F * glm::length(b - a));
}

TEST(NormalsBesideHardTriangles, HoldByReliefAndBreakByPlainCode) {
    const Experiment experiment = normals_beside_hard_triangles(test::quick_untimed());
    ASSERT_EQ(experiment.charts.size(), hard_triangle_words.size());
    for (const Chart& chart : experiment.charts) {
        for (const Curve& curve : chart.curves) {
            SCOPED_TRACE(chart.id + ", " + curve.method);
            ASSERT_EQ(curve.points.size(), 4U);
            const bool is_plain = curve.method.starts_with("plain");
            // What has no area or no place has no vote at all: the same errors for any number.
            const bool has_no_vote =
                chart.id == "collapsed" || chart.id == "coinciding" || chart.id == "nowhere";
            if (!is_plain && has_no_vote) {
                for (const CurvePoint& point : curve.points)
                    EXPECT_EQ(point.error, curve.points.front().error);
                EXPECT_FALSE(curve.breaks_at);
            }
            // One corner that is no number leaves plain code's neighbours without a normal.
            if (is_plain && chart.id == "nowhere") {
                EXPECT_EQ(curve.breaks_at.value_or(0.0), 1.0);
            }
        }
    }
    // A collapsed triangle has no angles, and arc cosines of 0 / 0 are none either.
    EXPECT_EQ(test::curve_of(experiment.charts[0], "plain angle, float32").breaks_at.value_or(0.0),
              1.0);
    EXPECT_FALSE(test::curve_of(experiment.charts[0], "plain area, float32").breaks_at);
}

}  // namespace
}  // namespace relief
