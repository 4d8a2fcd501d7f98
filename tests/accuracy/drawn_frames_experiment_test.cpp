// SPDX-License-Identifier: Apache-2.0
// Stored frames against derived ones, in pictures.
#include "tangents/drawn_frames_experiment.h"

#include <gtest/gtest.h>

#include "experiment_checks.h"

namespace relief::test {
namespace {

TEST(DrawnFrames, OnFewTrianglesDerivedOnesAreFartherOff) {
    const Drawing drawing;
    if (!drawing.is_there()) GTEST_SKIP() << "no OpenGL";
    const Experiment experiment = drawn_frames_experiment(drawing, quick_untimed());
    const auto rms = [&](const char* method) {
        return measurement_of(experiment, method).error.rms;
    };
    // Frames that jump from facet to facet show a little; on many triangles no longer.
    EXPECT_GT(rms("derived, 576 triangles"), 1.005 * rms("stored, 576 triangles"));
    EXPECT_LT(rms("derived, 576 triangles"), 1.1 * rms("stored, 576 triangles"));
    EXPECT_NEAR(rms("derived, 147456 triangles"), rms("stored, 147456 triangles"),
                0.005 * rms("stored, 147456 triangles"));
    EXPECT_LT(rms("stored, 147456 triangles"), 0.5 * rms("stored, 576 triangles"));
    // A picture without its map is no picture of it.
    EXPECT_GT(rms("no normal map, 9216 triangles"), 5.0 * rms("stored, 9216 triangles"));
    EXPECT_EQ(measurement_of(experiment, "stored, 576 triangles").cost.stored_bytes, 28.0);
    EXPECT_EQ(measurement_of(experiment, "derived, 576 triangles").cost.stored_bytes, 12.0);
    EXPECT_EQ(experiment.pictures.size(), 3U);
}

TEST(DrawnFrames, TakeTimeOfAllThreads) {
    const Drawing drawing;
    if (!drawing.is_there()) GTEST_SKIP() << "no OpenGL";
    RunOptions options = quick_untimed();
    options.is_timed = true;
    options.repeats = {3, 0};
    for (const Measurement& one : drawn_frames_experiment(drawing, options).measurements) {
        SCOPED_TRACE(one.method);
        ASSERT_TRUE(one.cost.all_threads);
        EXPECT_EQ(one.cost.all_threads->rounds.size(), 3U);
        EXPECT_GT(one.cost.all_threads->spread().median, 1e-5);
    }
}

}  // namespace
}  // namespace relief::test
