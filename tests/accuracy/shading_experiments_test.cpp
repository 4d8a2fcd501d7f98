// SPDX-License-Identifier: Apache-2.0
// What the experiments on pictures find, in the order in which it is known to lie.
#include <gtest/gtest.h>

#include "experiment_checks.h"
#include "measured_methods.h"
#include "shading/shading_plan.h"

namespace relief {
namespace {

const RunOptions untimed = test::quick_untimed();

class DrawnExperiment : public ::testing::Test {
  protected:
    void SetUp() override {
        if (!drawing_.is_there()) GTEST_SKIP() << "no OpenGL";
    }
    [[nodiscard]] const Drawing& drawing() const { return drawing_; }

    static double rms(const Experiment& experiment, const std::string& method) {
        return method_in(experiment, method).error.rms;
    }

  private:
    Drawing drawing_;
};

TEST_F(DrawnExperiment, OnInterpolationRanksPhongGouraudFlat) {
    const Experiment experiment = interpolation_experiment(drawing(), untimed);
    ASSERT_EQ(experiment.measurements.size(), 15U);
    EXPECT_LT(rms(experiment, "Phong, 2304 triangles"), rms(experiment, "Gouraud, 2304 triangles"));
    EXPECT_LT(rms(experiment, "Gouraud, 2304 triangles"), rms(experiment, "flat, 2304 triangles"));
    // Finer meshes are better by each of them.
    for (const Curve& curve : experiment.charts.front().curves) {
        EXPECT_LT(curve.points.back().error, 0.3 * curve.points.front().error) << curve.method;
        EXPECT_LT(curve.order.value(), -0.3) << curve.method;
    }
    EXPECT_LT(rms(experiment, "Phong, 36864 triangles"), 0.02);
    EXPECT_EQ(experiment.pictures.size(), 3U);
    EXPECT_NE(experiment.finding.find("not timed"), std::string::npos) << experiment.finding;
}

TEST_F(DrawnExperiment, OnHighlightsFindsTheFactorBetweenExponents) {
    const Experiment experiment = highlight_experiment(drawing(), untimed);
    EXPECT_LT(rms(experiment, "GGX"), 0.01);
    EXPECT_LT(rms(experiment, "Blinn-Phong"), rms(experiment, "Blinn-Phong, Phong's exponent"));
    EXPECT_LT(rms(experiment, "Phong, a quarter of Blinn's exponent"),
              rms(experiment, "Phong, Blinn's exponent"));
}

TEST_F(DrawnExperiment, OnEdgesRanksSamples) {
    const Experiment experiment = edge_experiment(drawing(), untimed);
    EXPECT_LT(rms(experiment, "MSAA, 4 samples"), 0.6 * rms(experiment, "1 sample"));
    EXPECT_LT(rms(experiment, "4 x 4 pixels"), 0.6 * rms(experiment, "2 x 2 pixels"));
}

}  // namespace
}  // namespace relief
