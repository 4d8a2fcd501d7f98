// SPDX-License-Identifier: Apache-2.0
// The results of the experiments with rendered images.
#include "shading_experiments.h"

#include <gtest/gtest.h>

#include "experiment_checks.h"
#include "experiment_driver.h"
#include "support/labels.h"

namespace relief {
using namespace relief::accuracy;

namespace {

class RenderedExperiment : public ::testing::Test {
  protected:
    static void SetUpTestSuite() { is_available_ = accuracy::detail::GlDevice().is_available(); }
    void SetUp() override {
        if (!is_available_) GTEST_SKIP() << "no OpenGL";
    }

    static double rms(const Experiment& experiment, const std::string& method) {
        return test::measurement_of(experiment, method).error.rms;
    }

  private:
    inline static bool is_available_ = false;
};

TEST_LABELS(not_sanitized);
TEST_F(RenderedExperiment, OnInterpolationRanksPhongGouraudFlat) {
    const Experiment experiment = test::run_one("shading/interpolation");
    ASSERT_EQ(experiment.measurements.size(), 15U);
    EXPECT_LT(rms(experiment, "Phong, 2304 triangles"), rms(experiment, "Gouraud, 2304 triangles"));
    EXPECT_LT(rms(experiment, "Gouraud, 2304 triangles"), rms(experiment, "flat, 2304 triangles"));
    // Finer meshes are better with each of the methods.
    for (const Curve& curve : experiment.charts.front().curves) {
        EXPECT_LT(curve.points.back().error, 0.3 * curve.points.front().error) << curve.method;
        EXPECT_LT(curve.order.value(), -0.3) << curve.method;
    }
    EXPECT_LT(rms(experiment, "Phong, 36864 triangles"), 0.02);
    EXPECT_EQ(experiment.pictures.size(), 3U);
    // Without times, the finding contains only errors.
    EXPECT_EQ(experiment.finding.find("frame"), std::string::npos) << experiment.finding;
}

TEST_LABELS(not_sanitized);
TEST_F(RenderedExperiment, OnHighlightsFindsTheFactorBetweenExponents) {
    const Experiment experiment = test::run_one("shading/highlights");
    EXPECT_LT(rms(experiment, "GGX"), 0.01);
    EXPECT_LT(rms(experiment, "Blinn-Phong"), rms(experiment, "Blinn-Phong, Phong's exponent"));
    EXPECT_LT(rms(experiment, "Phong, a quarter of Blinn's exponent"),
              rms(experiment, "Phong, Blinn's exponent"));
}

TEST_LABELS(not_sanitized);
TEST_F(RenderedExperiment, OnEnergyFindsThatAllBouncesKeepIt) {
    const Experiment experiment = test::run_one("shading/energy");
    ASSERT_EQ(experiment.measurements.size(), 2U);
    // From the front, a white metal of roughness 1 mirrors 1 - log(2) of even light at once.
    EXPECT_NEAR(test::measurement_of(experiment, "one bounce").error.max, 69.3, 0.5);
    EXPECT_LT(test::measurement_of(experiment, "all bounces").error.max, 0.5);
    ASSERT_EQ(experiment.charts.size(), 2U);
    for (const Chart& chart : experiment.charts) {
        const Curve& one = test::curve_of(chart, "one bounce");
        const Curve& all = test::curve_of(chart, "all bounces");
        for (std::size_t i = 0; i < all.points.size(); ++i)
            EXPECT_LT(all.points[i].error, 0.5) << chart.id << " " << all.points[i].x;
        EXPECT_GT(one.points.back().error, 5.0 * one.points[3].error) << chart.id;
    }
}

TEST_LABELS(not_sanitized);
TEST_F(RenderedExperiment, OnEdgesRanksSamples) {
    const Experiment experiment = test::run_one("shading/edges");
    EXPECT_LT(rms(experiment, "MSAA, 4 samples"), 0.6 * rms(experiment, "1 sample"));
    EXPECT_LT(rms(experiment, "4 x 4 pixels"), 0.6 * rms(experiment, "2 x 2 pixels"));
}

TEST_LABELS(not_sanitized);
TEST_F(RenderedExperiment, OnSmallHighlightsFindsThatWideningThemHelps) {
    const Experiment experiment = test::run_one("shading/specular-antialiasing");
    ASSERT_EQ(experiment.measurements.size(), 6U);
    EXPECT_LT(rms(experiment, "Toksvig"), 0.5 * rms(experiment, "averaged normals"));
    EXPECT_LT(rms(experiment, "Toksvig, 2 x 2 pixels"), rms(experiment, "Toksvig"));
    EXPECT_LT(rms(experiment, "averaged normals, 2 x 2 pixels"),
              0.6 * rms(experiment, "averaged normals"));
    EXPECT_LT(rms(experiment, "averaged normals, 4 x 4 pixels"), 0.5 * rms(experiment, "Toksvig"));
    // Multisampling shades once per pixel and improves only edges, and there are none.
    EXPECT_NEAR(rms(experiment, "averaged normals, MSAA"), rms(experiment, "averaged normals"),
                0.01);
    const Chart& chart = experiment.charts.front();
    const Curve& sharp = test::curve_of(chart, "averaged normals");
    const Curve& widened = test::curve_of(chart, "Toksvig");
    ASSERT_EQ(sharp.points.size(), 6U);
    // At one texel per pixel no normals are averaged, so nothing is widened.
    EXPECT_NEAR(widened.points[1].error, sharp.points[1].error, 1e-3);
    for (std::size_t i = 2; i < sharp.points.size(); ++i)
        EXPECT_LT(widened.points[i].error, sharp.points[i].error) << sharp.points[i].x;
    // With the distance, one error grows and the other does not.
    EXPECT_GT(sharp.points[5].error, 2.0 * sharp.points[2].error);
    EXPECT_LT(widened.points[5].error, 1.3 * widened.points[2].error);
}

TEST_LABELS(slow);
TEST(ShadingExperiments, AreComplete) {
    if (!accuracy::detail::GlDevice().is_available()) GTEST_SKIP() << "no OpenGL";
    const std::vector<Experiment> all = test::run_quick(Subject::shading);
    EXPECT_EQ(all.size(), 10U);
    test::expect_whole(all, Subject::shading);
    for (const Experiment& one : all) {
        SCOPED_TRACE(one.id);
        EXPECT_TRUE(one.id.starts_with("shading/"));
        // Images and heat maps have the size that the experiment states.
        for (const PicturePair& pair : one.pictures) {
            for (const Image& image : {pair.before, pair.after})
                EXPECT_EQ(static_cast<double>(image.width) * image.height, one.items);
        }
        for (const HeatMap& map : one.heat_maps)
            EXPECT_EQ(static_cast<double>(map.errors.width) * map.errors.height, one.items);
    }
}

}  // namespace
}  // namespace relief
