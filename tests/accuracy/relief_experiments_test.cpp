// SPDX-License-Identifier: Apache-2.0
// The results of the experiments on relief mapping with the inputs of a full run.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "experiment_checks.h"
#include "relief/mesh/image.h"
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

/// The plane of a triangle leaves an error on curved surfaces, which falls at steep views.
TEST(ReliefExperiments, ShowWhatCurvatureCosts) {
    for (const std::string surface : {"cylinder", "torus"}) {
        const auto error_of = [&](const std::string& band, const std::string& method) {
            return measurement_of(run_one("relief/" + surface + "-" + band), method).error.rms;
        };
        const double steep = error_of("0-30", "maximum mipmaps");
        EXPECT_GT(steep, 0.01);
        EXPECT_LT(steep, 0.3);
        EXPECT_LT(steep, 0.25 * error_of("0-30", "normal map"));
        EXPECT_GT(error_of("45-70", "maximum mipmaps"), 3.0 * steep);
    }
}

/// A method that knows the curvature is nearer to the displaced mesh. Rays that pass an edge of a
/// brick on the other side make up most of the RMS error, so that the mean falls by more.
TEST(ReliefExperiments, ShowWhatCurvedRaysGain) {
    for (const std::string surface : {"cylinder", "torus"}) {
        const Experiment experiment = run_one("relief/" + surface + "-45-70");
        const ErrorStats plane = measurement_of(experiment, "maximum mipmaps").error;
        const ErrorStats curved = measurement_of(experiment, "maximum mipmaps curved").error;
        EXPECT_LT(curved.mean, 0.7 * plane.mean) << surface;
        EXPECT_LT(curved.rms, 0.85 * plane.rms) << surface;
        EXPECT_NE(experiment.finding.find("'maximum mipmaps curved' has"), std::string::npos);
    }
}

TEST(ReliefExperiments, MeasureAHeightMapOfTheUser) {
    Image heights = make_image(16, 16, 1, 8, ColorSpace::data);
    for (std::size_t i = 0; i < 256; ++i)
        heights.as<std::uint8_t>()[i] = static_cast<std::uint8_t>(i * 37 % 256);
    AssetOptions options = untimed_asset("rough.png");
    options.run.is_quick = true;
    options.request.max_error = 1e-9;  // In degrees: it does not count.
    const AssetExperiment own = measure_asset_relief(heights, Wrap::repeat, 2.0, {20, 40}, options);
    EXPECT_EQ(own.experiment.id, "own/rough.png/relief");
    EXPECT_NE(own.experiment.input.find("16 x 16 texels, 2 deep"), std::string::npos);
    EXPECT_EQ(found(own, "maximum mipmaps").error.max, 0.0);
    EXPECT_GT(found(own, "parallax").error.rms, 0.1);
    EXPECT_EQ(own.command(),
              "relief-view MODEL --height-map rough.png --height-depth 2 --height-method "
              "maximum_mipmaps");
}

}  // namespace
}  // namespace relief::test
