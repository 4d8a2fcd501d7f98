// SPDX-License-Identifier: Apache-2.0
// Own experiments on a pair of meshes: more samples and bits are truer, and a flat pair is exact.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "experiment_checks.h"
#include "relief/accuracy/own.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/error.h"
#include "support/shapes.h"

namespace relief {
namespace {

using test::found;
using testing::HasSubstr;
using testing::SizeIs;
using testing::StartsWith;

OwnOptions quick(bool is_timed) {
    OwnOptions options;
    options.run.is_timed = is_timed;
    options.run.repeats = {2, 0};
    options.file = "high.obj and low.obj";
    options.arguments = "high.obj low.obj";
    return options;
}

/// Waves over the unit square, several to a texel of a map of 32.
Mesh waves() {
    Mesh mesh = test::grid(160);
    mesh.normals.clear();
    for (glm::vec3& position : mesh.positions)
        position.z = 0.004F * std::sin(90.0F * position.x);
    return mesh;
}

OwnExperiment measured(const Mesh& high, bool is_timed) {
    Report report;
    const Mesh low = test::grid(1);
    const Baker baker(std::span(&high, 1), low, {}, report);
    return measure_own_bake(baker, 32, quick(is_timed));
}

TEST(OwnBake, GetsTruerWithSamplesAndBits) {
    const OwnExperiment own = measured(waves(), false);
    EXPECT_THAT(own.experiment.measurements, SizeIs(28));
    const double one = found(own, "1 sample, 16 bit").error.rms;
    const double four = found(own, "4 samples, 16 bit").error.rms;
    const double many = found(own, "64 samples, 16 bit").error.rms;
    EXPECT_GT(one, four);
    EXPECT_GT(four, many);
    EXPECT_LT(many, found(own, "64 samples, 8 bit").error.rms);
    EXPECT_EQ(found(own, "1 sample, 16 bit").error.count, 32U * 32U);
    EXPECT_THAT(own.experiment.truth, HasSubstr("mean of 256 samples"));
    EXPECT_THAT(own.command(), StartsWith("relief-bake mesh high.obj low.obj OUT."));
    EXPECT_THAT(own.command(), HasSubstr(" --size 32 --samples 64"));
}

TEST(OwnBake, OfAFlatSurfaceIsExactWithOneSample) {
    const OwnExperiment own = measured(test::grid(4), true);
    EXPECT_LE(found(own, "1 sample, 8 bit").error.max, 1e-4);
    EXPECT_THAT(found(own, "1 sample, 8 bit").cost.all_threads.value().rounds, SizeIs(2));
    EXPECT_FALSE(found(own, "1 sample, 8 bit").cost.one_thread);
    EXPECT_TRUE(own.recommendation.method.has_value());
}

}  // namespace
}  // namespace relief
