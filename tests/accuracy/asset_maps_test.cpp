// SPDX-License-Identifier: Apache-2.0
// Experiments on height maps, normal maps and bakes with a known ground truth.
#include "relief/accuracy/asset.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "experiment_checks.h"
#include "experiment_driver.h"
#include "experiment_parts.h"
#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"
#include "storage_experiments.h"
#include "support/shapes.h"

namespace relief {
using namespace relief::accuracy;
using namespace relief::accuracy::detail;

namespace {

using test::found;
using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;
using testing::StartsWith;

const AssetOptions untimed_map = test::untimed_asset("map.png");

BumpField waves(FieldCoding coding) {
    return make_bump_field({.shortest = 16.0, .coding = coding}, 96, 96);
}

/// The experiment of one method on a field, without times.
BumpExperiment measured_by(const BumpMethod& method, const BumpField& field) {
    BumpExperimentOptions how;
    how.bump = field.options;
    how.repeats = {0, 0};
    return measure_bump(sample_of(field.heights), std::span(&method, 1), how);
}

TEST(AssetHeights, AreThoseOfTheBumpExperiment) {
    const BumpField field = waves(FieldCoding::float32);
    const AssetExperiment own = measure_asset_heights(field.heights, field.options, untimed_map);
    EXPECT_THAT(own.experiment.measurements, SizeIs(60));  // Kernels x arithmetics x depths.
    const BumpExperiment same =
        measured_by({Kernel::sobel3, 2, Arithmetic::float32, 8, false}, field);
    EXPECT_EQ(found(own, "sobel3, float32, 8 bit").error, same.measurements[0].error);
    // Smooth waves in floats: the kernel of the highest order, in double, is the reference.
    EXPECT_THAT(own.recommendation.description, HasSubstr("central7, float64, 32 bit: "));
    EXPECT_THAT(own.command(), HasSubstr("relief-bake bump map.png OUT.exr --strength "));
    EXPECT_THAT(own.command(), HasSubstr(" --kernel central7 --precision float64 --wrap repeat"));
    EXPECT_THAT(own.experiment.ground_truth, HasSubstr("the exact normals are unknown"));
    EXPECT_EQ(own.experiment.reference_error, same.reference.error.rms);
    const ExpectedError expected = found(own, "sobel3, float32, 8 bit").expected.value();
    EXPECT_EQ(expected.map, same.reference.error.rms);
    EXPECT_EQ(expected.added, found(own, "sobel3, float32, 8 bit").error.rms);
}

/// Waves in 8 bits with noise: the map itself has an error of several degrees.
BumpField noisy_waves() {
    return make_bump_field({.shortest = 16.0, .coding = FieldCoding::bits8, .noise = 0.1}, 128,
                           128);
}

TEST(AssetHeights, AreHeldToABoundWithTheErrorOfTheMapItself) {
    const BumpField field = noisy_waves();
    AssetOptions options = untimed_map;
    options.request.max_error = 0.5;
    const AssetExperiment own = measure_asset_heights(field.heights, field.options, options);
    const double map_error = own.experiment.reference_error.value();
    ASSERT_GT(map_error, 0.5) << "the field must be noisy enough for this test";
    // Methods are within half a degree of the reference, but the reference has a larger error.
    const auto& all = own.experiment.measurements;
    EXPECT_TRUE(std::any_of(all.begin(), all.end(),
                            [](const Measurement& one) { return one.error.rms < 0.5; }));
    EXPECT_EQ(own.recommendation.method, std::nullopt);
    EXPECT_THAT(own.recommendation.description,
                HasSubstr("no method is within 0.5 degrees (99 %): the smallest error "));
    EXPECT_THAT(own.recommendation.description, HasSubstr(" (the map itself "));
}

TEST(AssetHeights, HaveTheRangeOfTheBumpExperiment) {
    const BumpField field = noisy_waves();
    const AssetExperiment own = measure_asset_heights(field.heights, field.options, untimed_map);
    const BumpReference reference = measured_by({}, field).reference;
    ASSERT_GT(reference.upper_error.rms, 1.5 * reference.error.rms) << "noise hides detail";
    EXPECT_EQ(own.experiment.reference_error_upper, reference.upper_error.rms);
    EXPECT_THAT(own.recommendation.description,
                HasSubstr(fmt::format("(the map itself {:.3g} to {:.3g}, this method adds ",
                                      reference.error.rms, reference.upper_error.rms)));
}

TEST(AssetHeights, WithFewBitsAreAlsoSmoothed) {
    const BumpField field = waves(FieldCoding::bits8);
    const AssetExperiment own = measure_asset_heights(field.heights, field.options, untimed_map);
    EXPECT_THAT(own.experiment.measurements, SizeIs(70));
    EXPECT_GE(found(own, "scharr3, float32, 16 bit, steps smoothed").error.count, 96U * 96U);
}

TEST(AssetHeights, AreTriedInTheBitsAskedForAlone) {
    const BumpField field = waves(FieldCoding::bits8);
    AssetOptions options = untimed_map;
    options.map_bits = {16};
    options.smooths_steps = false;
    const AssetExperiment own = measure_asset_heights(field.heights, field.options, options);
    EXPECT_THAT(own.experiment.measurements, SizeIs(20));  // Ten kernels in two arithmetics.
    for (const Measurement& one : own.experiment.measurements)
        EXPECT_THAT(one.method, ::testing::EndsWith(", 16 bit"));
}

TEST(AssetHeights, LargeMapsAreMeasuredOnParts) {
    const BumpField field = waves(FieldCoding::float32);
    const AssetExperiment own =
        measure_asset_heights(field.heights, field.options, untimed_map, 48 * 48);
    EXPECT_EQ(own.experiment.input, "2304 texels in nine parts of 96 x 96");
}

Image normals_of(const BumpField& field) {
    Report report;
    return normals_from_height(field.heights, field.options, report);
}

TEST(AssetMaps, WithLossyCompressionHaveAnUnknownError) {
    AssetOptions options = untimed_map;
    options.lossy_compression = "JPEG";
    const BumpField field = waves(FieldCoding::bits8);
    const AssetExperiment heights = measure_asset_heights(field.heights, field.options, options);
    const AssetExperiment normals =
        measure_asset_normals(normals_of(waves(FieldCoding::float32)), {.bits = 8}, options);
    for (const AssetExperiment& own : {heights, normals}) {
        EXPECT_FALSE(own.experiment.reference_error);
        EXPECT_FALSE(own.experiment.measurements.front().expected);
        EXPECT_THAT(own.experiment.ground_truth,
                    HasSubstr("The file has lost an unknown amount by JPEG compression"));
        EXPECT_THAT(own.recommendation.description,
                    HasSubstr(", and the unknown loss of the file's JPEG compression"));
    }
}

TEST(AssetNormalMaps, AreComparedWithTheFile) {
    const Image map = encode_normal_map(normals_of(waves(FieldCoding::float32)), {.bits = 8});
    const Image normals = decode_normal_map(map, Green::up, FlatCode::half);
    const AssetExperiment own = measure_asset_normals(normals, {.bits = 8}, untimed_map);
    EXPECT_LE(found(own, "xyz float").error.max, 1e-4);
    // Vectors are normalized before they are encoded again, so not all codes stay.
    EXPECT_GT(found(own, "xyz 8 bit").error.rms, 0.0);
    EXPECT_LT(found(own, "xyz 8 bit").error.rms, 0.1);
    EXPECT_GT(found(own, "xy 8 bit").error.rms, found(own, "xyz 8 bit").error.rms);
    // Keeping the file costs nothing: no method that writes more bytes is recommended.
    EXPECT_EQ(found(own, "as it is").error.max, 0.0);
    EXPECT_EQ(found(own, "as it is").error.count, 96U * 96U);
    EXPECT_EQ(found(own, "as it is").cost.stored_bytes, 3.0);
    EXPECT_EQ(own.command(), "relief-bake convert map.png OUT.png");
    EXPECT_THAT(own.experiment.ground_truth, HasSubstr("in 8 bits"));
    // Rounding to codes of 2 / 255: errors of up to half a code, evenly distributed on two axes.
    const double rounding = 180.0 / std::numbers::pi / 127.5 / std::sqrt(6.0);
    EXPECT_NEAR(own.experiment.reference_error.value(), rounding, 1e-12);
    EXPECT_THAT(own.recommendation.description,
                HasSubstr("as it is: 0.183 degrees RMS expected (the rounding of the file itself "
                          "0.183, this method adds 0) at 3 bytes"));
}

TEST(AssetNormalMaps, UnsuitableCodesHaveTheExpectedError) {
    // Normals that point 10 degrees below the surface. Without the sign of z they point above it.
    constexpr double below = 10.0;
    std::vector<glm::dvec3> directions;
    for (int i = 0; i < 32 * 32; ++i) {
        const double around = 0.37 * i;
        directions.emplace_back(std::cos(glm::radians(below)) * std::cos(around),
                                std::cos(glm::radians(below)) * std::sin(around),
                                -std::sin(glm::radians(below)));
    }
    const AssetExperiment own =
        measure_asset_normals(image_of_normals(directions, 32), {.bits = 32}, untimed_map);
    // x and y in 16 bits have an error of 2^-16, which leaves 0.01 degrees in the computed z so
    // near to the horizon.
    const ErrorStats lost = found(own, "xy 16 bit").error;
    EXPECT_NEAR(lost.rms, 2.0 * below, 0.01);
    EXPECT_NEAR(lost.mean, 2.0 * below, 0.01);
    EXPECT_NEAR(lost.max, 2.0 * below, 0.02);
    for (const char* whole : {"xyz 16 bit", "octahedral 2 x 16 bit", "xyz float"})
        EXPECT_LT(found(own, whole).error.max, 0.01) << whole;
    EXPECT_THAT(own.recommendation.description, Not(HasSubstr("xy 16 bit")));
}

/// Waves over the unit square, several per texel of a map of 32 x 32.
Mesh waves() {
    Mesh mesh = test::grid(160);
    mesh.normals.clear();
    for (glm::vec3& position : mesh.positions)
        position.z = 0.004F * std::sin(90.0F * position.x);
    return mesh;
}

AssetExperiment measured(const Mesh& high, bool is_timed) {
    Report report;
    const Mesh low = test::grid(1);
    const Baker baker(std::span(&high, 1), low, {}, report);
    AssetOptions options = test::untimed_asset("high.obj low.obj");
    options.run.is_timed = is_timed;
    options.run.repeats = {2, 0};
    return measure_asset_bake(baker, 32, options);
}

TEST(AssetBake, GetsTruerWithSamplesAndBits) {
    const AssetExperiment own = measured(waves(), false);
    EXPECT_THAT(own.experiment.measurements, SizeIs(28));
    const double one = found(own, "1 sample, 16 bit").error.rms;
    const double four = found(own, "4 samples, 16 bit").error.rms;
    const double many = found(own, "64 samples, 16 bit").error.rms;
    EXPECT_GT(one, four);
    EXPECT_GT(four, many);
    EXPECT_LT(many, found(own, "64 samples, 8 bit").error.rms);
    EXPECT_EQ(found(own, "1 sample, 16 bit").error.count, 32U * 32U);
    EXPECT_THAT(own.experiment.ground_truth, HasSubstr("mean of 256 samples"));
    EXPECT_THAT(own.command(), StartsWith("relief-bake mesh high.obj low.obj OUT."));
    EXPECT_THAT(own.command(), HasSubstr(" --size 32 --samples 64"));
}

TEST(AssetBake, FlatSurfaceIsExactWithOneSample) {
    const AssetExperiment own = measured(test::grid(4), true);
    EXPECT_LE(found(own, "1 sample, 16 bit").error.max, 0.0013);
    // Zero is halfway between two codes, so both axes have an error of half a code.
    EXPECT_NEAR(found(own, "1 sample, 8 bit").error.max, glm::degrees(std::sqrt(2.0) / 255.0),
                1e-4);
    EXPECT_THAT(found(own, "1 sample, 8 bit").cost.all_threads.value().rounds, SizeIs(2));
    EXPECT_FALSE(found(own, "1 sample, 8 bit").cost.one_thread);
    EXPECT_TRUE(own.recommendation.method.has_value());
}

}  // namespace
}  // namespace relief
