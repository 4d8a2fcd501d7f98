// SPDX-License-Identifier: Apache-2.0
// The results of the experiments on relief mapping with the inputs of a full run.
#include <gtest/gtest.h>

#include <string>

#include "experiment_checks.h"
#include "support/labels.h"

namespace relief::test {
using namespace relief::accuracy;

namespace {

TEST_LABELS(not_sanitized);
TEST(ReliefExperiments, ShowThatMaximumMipmapsAreExact) {
    RunOptions full = quick_untimed();
    full.is_quick = false;
    // The goal is an RMS error of 0.1 texels and 0.05 % misses on bricks, and no misses on waves.
    const Experiment bricks = run_one("relief/bricks-45-70", full);
    EXPECT_EQ(measurement_of(bricks, "maximum mipmaps").error.max, 0.0);
    EXPECT_EQ(measurement_of(bricks, "maximum mipmaps").error.count, 60'000U);
    // The errors of the others are those of an independent prototype: 4.95, 0.65 and 0.20 texels.
    EXPECT_NEAR(measurement_of(bricks, "parallax").error.rms, 4.95, 0.1);
    EXPECT_NEAR(measurement_of(bricks, "parallax occlusion 16").error.rms, 0.65, 0.1);
    EXPECT_NEAR(measurement_of(bricks, "parallax occlusion 128").error.rms, 0.20, 0.05);
    EXPECT_NE(bricks.finding.find("'maximum mipmaps' is exact to rounding for every ray"),
              std::string::npos);
    ASSERT_EQ(bricks.charts.size(), 1U);
    EXPECT_TRUE(run_one("relief/waves-70-85").charts.empty());
}

}  // namespace
}  // namespace relief::test
