// SPDX-License-Identifier: Apache-2.0
// Own experiments on a pair of meshes: more samples and bits are truer, and a flat pair is exact.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

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
    EXPECT_LE(found(own, "1 sample, 16 bit").error.max, 0.0013);
    // Zero lies halfway between two codes: half a code off on both axes.
    EXPECT_NEAR(found(own, "1 sample, 8 bit").error.max, glm::degrees(std::sqrt(2.0) / 255.0),
                1e-4);
    EXPECT_THAT(found(own, "1 sample, 8 bit").cost.all_threads.value().rounds, SizeIs(2));
    EXPECT_FALSE(found(own, "1 sample, 8 bit").cost.one_thread);
    EXPECT_TRUE(own.recommendation.method.has_value());
}

constexpr int striped_texels = 32;

/// The unit square, flat, whose normals lean right by so many degrees in the middle of each column
/// of texels and left beside that, half and half; the stripes are a 64th of a texel off its
/// quarters, so that no sample lies on a border.
Mesh striped(double degrees) {
    constexpr double texel = 1.0 / striped_texels;
    const double lean = glm::radians(degrees);
    Mesh mesh;
    const auto add_stripe = [&](double begin, double end, double side) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const glm::dvec2& corner :
             {glm::dvec2(begin, 0.0), {end, 0.0}, {end, 1.0}, {begin, 1.0}}) {
            mesh.positions.emplace_back(corner.x, corner.y, 0.0);
            mesh.normals.emplace_back(side * std::sin(lean), 0.0, std::cos(lean));
        }
        mesh.triangles.emplace_back(first, first + 1, first + 2);
        mesh.triangles.emplace_back(first, first + 2, first + 3);
    };
    for (int column = 0; column < striped_texels; ++column) {
        constexpr double aside = 1.0 / 64.0;
        add_stripe(column * texel, (column + 0.25 - aside) * texel, -1.0);
        add_stripe((column + 0.25 - aside) * texel, (column + 0.75 - aside) * texel, 1.0);
        add_stripe((column + 0.75 - aside) * texel, (column + 1.0) * texel, -1.0);
    }
    return mesh;
}

TEST(OwnBake, OfSamplesThatAreADegreeOffIsADegreeOff) {
    // One sample, in the middle, sees the normals that lean right; the mean of 256 sees both, and
    // so does that of 4, two on either side of a stripe: straight up.
    for (const double degrees : {1.0, 5.0}) {
        const OwnExperiment own = measured(striped(degrees), false);
        // 16 bits tell apart 2^-15: 0.0017 degrees.
        constexpr double code = 0.0017;
        const ErrorFigures& one = found(own, "1 sample, 16 bit").error;
        EXPECT_NEAR(one.rms, degrees, code);
        EXPECT_NEAR(one.mean, degrees, code);
        EXPECT_NEAR(one.p99, degrees, code + degrees / 64.0) << "binned";
        EXPECT_NEAR(one.max, degrees, code);
        EXPECT_EQ(one.count, static_cast<std::size_t>(striped_texels) * striped_texels);
        for (const char* both : {"4 samples, 16 bit", "64 samples, 16 bit"})
            EXPECT_LE(found(own, both).error.max, code) << both;
    }
}

}  // namespace
}  // namespace relief
