// SPDX-License-Identifier: Apache-2.0
// Interpolated normals and what their length does to light.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "experiment_checks.h"
#include "shading/shading_plan.h"
#include "shading/unit_normal_methods.h"

namespace relief {
namespace {

TEST(NormalSamples, AreShortestInTheMiddle) {
    // The mean of three unit vectors that are 40 degrees apart.
    const NormalSamples samples(40.0, 97);
    const double expected = std::sqrt((1.0 + 2.0 * std::cos(glm::radians(40.0))) / 3.0);
    double shortest = 2.0;
    double longest = 0.0;
    for (const glm::vec3& n : samples.interpolated()) {
        shortest = std::min(shortest, glm::length(glm::dvec3(n)));
        longest = std::max(longest, glm::length(glm::dvec3(n)));
    }
    EXPECT_NEAR(shortest, expected, 1e-4);
    EXPECT_NEAR(longest, 1.0, 0.01);
    EXPECT_LE(longest, 1.0);
}

TEST(UnitNormalMethods, ErrByTheSquareAndTheFourthPowerOfTheAngle) {
    const Experiment experiment = unit_normal_experiment(test::quick_untimed());
    const std::vector<Curve>& curves = experiment.charts.front().curves;
    ASSERT_EQ(curves.size(), 4U);
    EXPECT_NEAR(curves[0].order.value(), curves[0].expected_order.value(), 0.15);
    EXPECT_NEAR(curves[1].order.value(), curves[1].expected_order.value(), 0.3);
    EXPECT_GT(experiment.measurements[0].error.max, 0.1);
    EXPECT_LT(experiment.measurements[1].error.rms, 0.15 * experiment.measurements[0].error.rms);
    EXPECT_LT(experiment.measurements[2].error.max, 1e-5);
    EXPECT_LT(experiment.measurements[3].error.max, 1e-7);
}

}  // namespace
}  // namespace relief
