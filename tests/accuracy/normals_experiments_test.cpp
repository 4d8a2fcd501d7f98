// SPDX-License-Identifier: Apache-2.0
// The experiments on normals: their numbers are those of docs/normals.md, their orders those of
// theory.
#include "normals/normals_experiments.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "experiment_checks.h"

namespace relief::test {
namespace {

using testing::HasSubstr;

/// Run once for all tests of a process.
const std::vector<Experiment>& quick_experiments() {
    static const std::vector<Experiment> all = normals_experiments(quick_untimed());
    return all;
}

const Experiment& quick(const std::string& title) {
    return titled(quick_experiments(), title);
}

TEST(NormalsExperiments, AreWhole) {
    expect_whole(quick_experiments(), Subject::normals);
}

TEST(NormalsExperiments, HaveTheErrorsOfThePage) {
    const Experiment torus = quick("Normals: torus, jittered");
    EXPECT_EQ(torus.id, "normals/torus-jittered");
    EXPECT_EQ(torus.measurements.size(), 16U);
    EXPECT_NEAR(measurement_of(torus, "max, float64").error.rms, 0.453, 5e-4);
    EXPECT_NEAR(measurement_of(torus, "max, float64").error.max, 2.027, 5e-4);
    EXPECT_NEAR(measurement_of(torus, "area, float64").error.rms, 1.279, 5e-4);
    EXPECT_EQ(torus.items, 2.0 * 64 * 64);
    EXPECT_THAT(torus.finding, HasSubstr("max is closest, 0.453 degrees RMS; area is farthest"));
    const Experiment folded = quick("Normals: cubic, folded");
    EXPECT_NEAR(measurement_of(folded, "auto, float64").error.rms, 0.654, 5e-4);
    EXPECT_NEAR(measurement_of(folded, "max, float64").error.max, 180.0, 5e-2);
}

TEST(NormalsExperiments, FloatVotesMoveNothingThatMatters) {
    for (const Experiment& experiment : quick_experiments()) {
        if (experiment.id == "normals/fans") continue;
        for (const char* weighting : {"uniform", "area", "max"}) {
            const double in_double =
                measurement_of(experiment, weighting + std::string(", float64")).error.rms;
            const double in_float =
                measurement_of(experiment, weighting + std::string(", float32")).error.rms;
            EXPECT_NEAR(in_float, in_double, 1e-3) << experiment.id << " " << weighting;
        }
    }
}

TEST(NormalsExperiments, ErrorsFallAtTheOrderOfTheory) {
    std::size_t checked = 0;
    for (const Experiment& experiment : quick_experiments()) {
        for (const Chart& chart : experiment.charts) {
            for (const Curve& curve : chart.curves) {
                if (!curve.expected_order) continue;
                // Coarse cells, whose errors are not yet ruled by the first term, are in the fit.
                EXPECT_NEAR(curve.order.value(), *curve.expected_order, 0.35)
                    << experiment.id << " " << curve.method;
                ++checked;
            }
        }
    }
    EXPECT_GE(checked, 28U);
}

}  // namespace
}  // namespace relief::test
