// SPDX-License-Identifier: Apache-2.0
// The experiments on bump maps: their numbers are those of docs/bump.md, their orders those of the
// kernels.
#include "bump/bump_experiments.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiment_checks.h"

namespace relief::test {
namespace {

using testing::HasSubstr;

/// Run once for all tests of a process.
const std::vector<Experiment>& quick_experiments() {
    static const std::vector<Experiment> all = bump_experiments(quick_untimed());
    return all;
}

const Experiment& quick(const std::string& title) {
    return titled(quick_experiments(), title);
}

TEST(BumpExperiments, AreWhole) {
    expect_whole(quick_experiments(), Subject::bump);
}

TEST(BumpExperiments, HaveTheErrorsOfThePage) {
    const Experiment detailed = quick("Bump: detailed, 8 bit");
    EXPECT_EQ(detailed.id, "bump/detailed-8");
    EXPECT_EQ(detailed.measurements.size(), 52U);  // 13 kernels, 2 arithmetics, steps or none.
    EXPECT_NEAR(measurement_of(detailed, "sobel3, float64").error.rms, 1.3, 0.05);
    EXPECT_NEAR(measurement_of(detailed, "central7, float64").error.rms, 2.3, 0.05);
    EXPECT_NEAR(measurement_of(detailed, "scharr3, float64, steps smoothed away").error.rms, 1.4,
                0.05);
    EXPECT_THAT(detailed.finding, HasSubstr("is closest, 1.3 degrees RMS. float32 changes"));
    EXPECT_THAT(detailed.finding, HasSubstr("On this map --kernel auto takes sobel3."));
    const Experiment noisy = quick("Bump: noise 0.03, float");
    EXPECT_EQ(noisy.measurements.size(), 26U);
    EXPECT_THAT(noisy.finding, HasSubstr(", where sobel3 is 0.99 off. "));
    EXPECT_NEAR(measurement_of(noisy, "gaussian 4, float64").error.rms, 0.32, 0.005);
    EXPECT_NEAR(measurement_of(noisy, "central3, float32").error.rms, 1.6, 0.05);
}

TEST(BumpExperiments, ErrorsFallAtTheOrderOfTheKernel) {
    std::size_t checked = 0;
    const Chart waves = quick("Bump: a wave in float").charts.front();
    const Chart resolutions = quick("Bump: a large map").charts.front();
    for (const Chart& chart : {waves, resolutions}) {
        EXPECT_EQ(chart.curves.size(), 13U);
        for (const Curve& curve : chart.curves) {
            if (!curve.order) continue;  // Too few points that truncation rules.
            EXPECT_NEAR(*curve.order, curve.expected_order.value(), 0.35)
                << chart.id << " " << curve.method;
            ++checked;
        }
    }
    EXPECT_GE(checked, 22U);
    EXPECT_NEAR(curve_of(waves, "central5").order.value(), -4.0, 0.1);
    EXPECT_NEAR(curve_of(waves, "central7").order.value(), -6.0, 0.2);
}

TEST(BumpExperiments, CodesOfEightBitsMakeLongWavesWorseForSmallKernels) {
    const Chart chart = quick("Bump: a wave in 8 bit").charts.front();
    const Curve& small = curve_of(chart, "central3");
    const Curve& wide = curve_of(chart, "gaussian 8");
    EXPECT_FALSE(small.expected_order);
    EXPECT_EQ(small.points.back().x, 256.0);
    EXPECT_LT(small.points[2].error, wide.points[2].error);  // Waves of 8 texels.
    EXPECT_GT(small.points.back().error, 4.0 * wide.points.back().error);
}

TEST(BumpExperiments, HeatMapsShowWhereKernelsErr) {
    const Experiment mixed = quick("Bump: mixed, 8 bit");
    ASSERT_EQ(mixed.heat_maps.size(), 2U);
    const auto mean_of_columns = [](const HeatMap& map, int begin, int end) {
        double sum = 0.0;
        for (int y = 0; y < map.errors.height; ++y) {
            for (int x = begin; x < end; ++x) {
                const auto texel = static_cast<std::size_t>(y * map.errors.width + x);
                sum += static_cast<double>(map.errors.as<float>()[texel]);
            }
        }
        return sum / (map.errors.height * (end - begin));
    };
    const HeatMap& small = mixed.heat_maps[0];
    const HeatMap& wide = mixed.heat_maps[1];
    EXPECT_EQ(small.errors.width, 256);
    // The wide kernel is lost on the short waves in the middle, and better on the long ones.
    EXPECT_GT(mean_of_columns(wide, 112, 144), 1.5 * mean_of_columns(small, 112, 144));
    EXPECT_LT(mean_of_columns(wide, 0, 16), 0.5 * mean_of_columns(small, 0, 16));
}

}  // namespace
}  // namespace relief::test
