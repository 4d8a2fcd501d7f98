// SPDX-License-Identifier: Apache-2.0
// What is drawn by OpenGL and held against a truth.
#include "drawn/drawn_methods.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "drawn/lit_scene.h"
#include "drawn/many_samples.h"
#include "drawn/one_processor.h"
#include "experiment_checks.h"
#include "relief/mesh/shapes.h"
#include "shading/shading_plan.h"
#include "support/gl_environment.h"

namespace relief {
namespace {

constexpr int drawn_size = 64;
const RunOptions untimed_drawing = test::quick_untimed();

Scene ball() {
    return lit_scene(make_sphere(), glossy_plastic());
}

TEST(DrawnMethods, FindALampThatIsTurnedRound) {
    const Drawing drawing;
    if (!drawing.is_there()) GTEST_SKIP() << "no OpenGL";
    Scene broken = ball();
    broken.directional_lights.front().direction_world *= -1.0F;
    const std::vector<DrawnMethod> methods = {{"right", {}, ball()}, {"broken", {}, broken}};
    Experiment experiment;
    const std::vector<DrawnPicture> pictures = measure_drawn(
        drawing, methods, many_samples(ball(), drawn_size, 1), untimed_drawing, experiment);
    ASSERT_EQ(experiment.measurements.size(), 2U);
    EXPECT_LT(experiment.measurements[0].error.rms, 0.01);
    EXPECT_GT(experiment.measurements[0].error.psnr.value(), 45.0);
    EXPECT_GT(experiment.measurements[1].error.rms, 0.2);
    EXPECT_FALSE(experiment.measurements[0].cost.all_threads);
    EXPECT_EQ(pictures[0].picture.channels, 3);
    EXPECT_EQ(pictures[0].errors.width, drawn_size);
    EXPECT_NE(experiment.measurements[0].note.find(drawing.context().renderer_name()),
              std::string::npos);
}

TEST(DrawnMethods, AverageWhatTheyDrawMoreOf) {
    const Drawing drawing;
    if (!drawing.is_there()) GTEST_SKIP() << "no OpenGL";
    const std::vector<DrawnMethod> methods = {
        {"1", {}, ball()}, {"2 x 2", {}, ball(), 1, 2}, {"4 x 4", {}, ball(), 1, 4}};
    Experiment experiment;
    measure_drawn(drawing, methods, many_samples(ball(), drawn_size, 8), untimed_drawing,
                  experiment);
    for (const std::size_t i : {1U, 2U}) {
        EXPECT_GT(experiment.measurements[i].error.psnr.value(),
                  experiment.measurements[i - 1].error.psnr.value() + 3.0);
    }
}

TEST(DrawnMethods, AreTimedInTurnsInSeconds) {
    const Drawing drawing;
    if (!drawing.is_there()) GTEST_SKIP() << "no OpenGL";
    const std::vector<DrawnMethod> methods = {{"one", {}, ball()}, {"other", {}, ball()}};
    Experiment experiment;
    RunOptions options;
    options.repeats = {.counted = 3, .warm_up = 1};
    measure_drawn(drawing, methods, many_samples(ball(), drawn_size, 1), options, experiment);
    for (const Measurement& one : experiment.measurements) {
        ASSERT_TRUE(one.cost.all_threads);
        EXPECT_EQ(one.cost.all_threads->rounds.size(), 3U);
        EXPECT_GT(one.cost.all_threads->spread().median, 0.0);
        EXPECT_LT(one.cost.all_threads->spread().median, 10.0);
        // A software driver's threads can be kept on one processor, where the system lets them.
        const OneProcessor kept;
        ASSERT_EQ(one.cost.one_thread.has_value(),
                  kept.is_kept() && drawing.context().is_software());
        if (!one.cost.one_thread) continue;
        EXPECT_EQ(one.cost.one_thread->rounds.size(), 3U);
    }
}

TEST(DrawnMethods, SayTheirTimesOnlyWhereAllWereTimed) {
    Measurement stored;
    stored.cost.one_thread = Timing{{1.0e-3, 1.2e-3, 5.0e-3}};
    Measurement derived;
    derived.cost.all_threads = Timing{{3.4e-3}};
    EXPECT_EQ(frame_times({{"stored", stored}, {"derived", derived}}),
              " Median frame times: 1.2 ms (stored), 3.4 ms (derived).");
    EXPECT_EQ(frame_times({{"stored", stored}, {"derived", Measurement{}}}), "");
}

TEST(DrawnMethods, SayInWordsThatThereIsNoOpenGL) {
    const test::ScopedVariable osmesa("RELIEF_OSMESA_LIBRARY", "libnone.so");
    const Drawing drawing(Backend::osmesa);
    ASSERT_FALSE(drawing.is_there());
    const Experiment experiment = edge_experiment(drawing, untimed_drawing);
    EXPECT_TRUE(experiment.measurements.empty());
    EXPECT_EQ(experiment.id, "shading/edges");
    EXPECT_NE(experiment.finding.find("needs OpenGL"), std::string::npos) << experiment.finding;
    EXPECT_NE(experiment.finding.find("libnone.so"), std::string::npos) << experiment.finding;
}

}  // namespace
}  // namespace relief
