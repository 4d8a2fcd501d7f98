// SPDX-License-Identifier: Apache-2.0
// Checks of a baked map: maps with known errors, the error of each stage, and trials of other
// settings.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>

#include "mesh/bake/bake_support.h"
#include "relief/mesh/bake_check.h"
#include "relief/mesh/error_stats.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "support/message_of.h"

namespace relief {
namespace {

using test::bake;
using test::sized;
using test::waves;

const double degree = std::numbers::pi / 180.0;

Image image_of(const std::vector<float>& normals, const BakeOptions& options) {
    Image image = make_image(options.width, options.height, 3, 32, ColorSpace::data);
    std::copy(normals.begin(), normals.end(), image.as<float>().begin());
    return image;
}

Image baked_map(const Mesh& high, const Mesh& low, const BakeOptions& options, int bits) {
    Report report;
    return encode_normal_map(image_of(bake({high}, low, options).normals, options), {.bits = bits},
                             report);
}

BakeCheck checked(const Mesh& high, const Mesh& low, const BakeOptions& options, const Image& map,
                  std::vector<float>* errors = nullptr) {
    Report report;
    const Baker baker(std::span(&high, 1), low, options, report);
    BakeCheckOptions check;
    check.map = options;
    return check_bake(
        baker, map, check,
        [&](int, std::span<const float> degrees) {
            if (errors != nullptr) errors->insert(errors->end(), degrees.begin(), degrees.end());
        },
        report);
}

StageError stage(const BakeCheck& check, BakeStage stage) {
    return check.stages.at(static_cast<std::size_t>(stage));
}

double all_shares(const BakeCheck& check) {
    return std::accumulate(check.stages.begin(), check.stages.end(), 0.0,
                           [](double sum, const StageError& one) { return sum + one.share; });
}

/// A square above that of make_quad(), with these normals.
Mesh tilted_square(const glm::vec3& normal, float height = 0.0F) {
    Mesh mesh = make_quad();
    for (glm::vec3& position : mesh.positions)
        position.z = height;
    mesh.normals.assign(mesh.positions.size(), glm::normalize(normal));
    return mesh;
}

TEST(BakeCheck, NormalsTurnedByOneDegreeAreOneDegreeOff) {
    const BakeOptions options = sized(64, 96);
    Image map = make_image(64, 96, 3, 32, ColorSpace::data);
    for (std::size_t i = 0; i < 64 * 96; ++i) {
        const double around = 0.1 * static_cast<double>(i);
        const glm::dvec3 n(std::sin(degree) * std::cos(around), std::sin(degree) * std::sin(around),
                           std::cos(degree));
        for (int axis = 0; axis < 3; ++axis)
            map.as<float>()[3 * i + static_cast<std::size_t>(axis)] =
                static_cast<float>((n[axis] + 1.0) / 2.0);
    }
    std::vector<float> errors;
    const BakeCheck check = checked(make_quad(), make_quad(), options, map, &errors);
    EXPECT_EQ(check.error.count, 64U * 96U);
    EXPECT_NEAR(check.error.rms, 1.0, 2e-6);
    EXPECT_NEAR(check.error.mean, 1.0, 2e-6);
    EXPECT_NEAR(check.error.max, 1.0, 2e-5);
    EXPECT_NEAR(check.error.p99, 1.0, 0.02);
    EXPECT_NEAR(check.center.rms, 1.0, 2e-6);
    EXPECT_EQ(check.rebaked.max, 0.0);
    EXPECT_NEAR(stage(check, BakeStage::other).rms, 1.0, 2e-6);
    EXPECT_NEAR(stage(check, BakeStage::other).share, 1.0, 1e-9);
    EXPECT_EQ(check.discontinuous, 0U);
    ASSERT_EQ(errors.size(), 64U * 96U);
    EXPECT_NEAR(errors[1234], 1.0F, 1e-5F);
    // Vectors in all directions follow no convention.
    EXPECT_TRUE(check.convention.was_searched);
    EXPECT_FALSE(check.convention.is_explained);
}

TEST(BakeCheck, AMeshOntoItselfIsFlatWithinQuantisation) {
    for (const Mesh& mesh : {make_sphere(), make_torus(), make_cube(), make_cylinder()}) {
        for (const int bits : {8, 16}) {
            const BakeOptions options = sized(96, 64);
            const BakeCheck check =
                checked(mesh, mesh, options, baked_map(mesh, mesh, options, bits));
            EXPECT_EQ(check.missed, 0U);
            // No code is zero: flat has an error of half a code in x and in y. The rest is the
            // rounding error of float.
            const double half_a_code = std::atan(std::sqrt(2.0) / (bits == 8 ? 255.0 : 65535.0));
            EXPECT_NEAR(check.error.max, half_a_code / degree, 0.002) << bits;
            EXPECT_FALSE(check.convention.was_searched);
        }
    }
}

TEST(BakeCheck, QuantisationAloneIsWhatRoundingToCodesDoes) {
    const Mesh high = tilted_square({0.6F, 0.0F, 0.8F}, 0.1F);
    const BakeOptions options = sized(32, 32);
    const Image map = baked_map(high, make_quad(), options, 8);
    const BakeCheck check = checked(high, make_quad(), options, map);
    // 127.5 * (0.6, 0, 0.8) is (76.5, 0, 102): 76.5 above 127.5 is a code, and the others lie
    // between two.
    const auto code = [&](std::size_t axis) { return map.as<std::uint8_t>()[axis] - 127.5; };
    EXPECT_EQ(code(0), 76.5);
    EXPECT_EQ(code(1), 0.5);
    EXPECT_EQ(std::abs(code(2) - 102.0), 0.5);
    const double rounded = degrees_between({code(0), code(1), code(2)}, {0.6, 0.0, 0.8});
    EXPECT_NEAR(check.error.rms, rounded, 1e-5);
    EXPECT_NEAR(check.center.rms, rounded, 1e-5);
    EXPECT_NEAR(stage(check, BakeStage::quantization).rms, rounded, 1e-5);
    EXPECT_NEAR(stage(check, BakeStage::quantization).share, 1.0, 1e-3);
    EXPECT_NEAR(stage(check, BakeStage::other).rms, 0.0, 1e-9);
    EXPECT_NEAR(all_shares(check), 1.0, 1e-9);
}

TEST(BakeCheck, SamplingAloneIsWhatOneSampleMissesOfTheMean) {
    // A texel has a width of one sixteenth. The waves are three times shorter, so one sample cannot
    // resolve them.
    const Mesh high = waves(512, 100.0);
    BakeOptions options = sized(32, 32);
    const auto errors_of = [&](int samples) {
        options.samples = samples;
        return checked(high, make_quad(), options, baked_map(high, make_quad(), options, 32));
    };
    const BakeCheck one = errors_of(1);
    EXPECT_EQ(one.reference_samples, 16);
    EXPECT_GT(one.error.rms, 5.0);
    EXPECT_LT(one.center.max, 1e-4);
    EXPECT_NEAR(stage(one, BakeStage::sampling).rms, one.error.rms, 1e-4);
    EXPECT_NEAR(stage(one, BakeStage::sampling).share, 1.0, 1e-4);
    const BakeCheck sixteen = errors_of(16);
    EXPECT_EQ(sixteen.reference_samples, 256);
    EXPECT_LT(sixteen.error.rms, 1.5);
    EXPECT_GT(sixteen.center.rms, 5.0);
}

TEST(BakeCheck, BasisIsWhatASkewedFrameMakesOfRounding) {
    const Mesh high = tilted_square({0.6F, 0.0F, 0.8F}, 0.1F);
    Mesh low = make_quad();
    // The tangent leaves the plane by 60 degrees, which changes the angle between x and z.
    low.tangents.assign(low.positions.size(), {0.5F, 0.0F, 0.866025F, 1.0F});
    const BakeOptions options = sized(32, 32);
    const BakeCheck check = checked(high, low, options, baked_map(high, low, options, 8));
    EXPECT_GT(stage(check, BakeStage::quantization).rms, 0.01);
    EXPECT_GT(check.error.rms, 0.01);
    EXPECT_NEAR(all_shares(check), 1.0, 1e-9);
    const double whole =
        std::hypot(stage(check, BakeStage::quantization).rms, stage(check, BakeStage::basis).rms);
    EXPECT_GE(whole, check.error.rms - 1e-5);
    low.tangents.assign(low.positions.size(), {1.0F, 0.0F, 0.0F, 1.0F});
    const BakeCheck right = checked(high, low, options, baked_map(high, low, options, 8));
    EXPECT_LT(stage(right, BakeStage::basis).rms, 1e-3);
}

TEST(BakeCheck, ProjectionIsWhereTheSurfaceJumpsWithinATexel) {
    // Two squares at different heights, tilted to opposite sides, that meet within the same texels.
    Mesh high = tilted_square({0.6F, 0.0F, 0.8F}, 0.3F);
    Mesh other = tilted_square({-0.6F, 0.0F, 0.8F}, 0.0F);
    for (std::size_t i = 0; i < other.positions.size(); ++i) {
        high.positions[i].x = (high.positions[i].x - 1.0F) / 2.0F + 0.02F;
        other.positions[i].x = (other.positions[i].x + 1.0F) / 2.0F + 0.02F;
    }
    const auto vertices = static_cast<std::uint32_t>(high.positions.size());
    for (std::size_t i = 0; i < other.positions.size(); ++i) {
        high.positions.push_back(other.positions[i]);
        high.normals.push_back(other.normals[i]);
        high.texcoords.push_back(other.texcoords[i]);
    }
    for (const glm::uvec3& triangle : other.triangles)
        high.triangles.push_back(triangle + vertices);
    const BakeOptions options = sized(16, 8);
    const BakeCheck check =
        checked(high, make_quad(), options, baked_map(high, make_quad(), options, 32));
    EXPECT_EQ(check.discontinuous, 8U);  // The column from 0 to 0.125.
    EXPECT_GT(stage(check, BakeStage::projection).rms, 5.0);
    EXPECT_NEAR(stage(check, BakeStage::projection).share, 1.0, 1e-6);
    ASSERT_EQ(check.worst.size(), 8U);
    EXPECT_EQ(check.worst[0].x, 8);
    EXPECT_TRUE(check.worst[0].is_discontinuous);
}

TEST(BakeCheck, WhatRaysMissHasNoTruthAndIsCounted) {
    Mesh high = tilted_square({0.0F, 0.0F, 1.0F});
    for (glm::vec3& position : high.positions)
        position.x = (position.x - 1.0F) / 2.0F;
    const BakeOptions options = sized(32, 32);
    std::vector<float> errors;
    const BakeCheck check =
        checked(high, make_quad(), options, baked_map(high, make_quad(), options, 16), &errors);
    EXPECT_EQ(check.missed, 512U);
    EXPECT_EQ(check.error.count, 512U);
    EXPECT_TRUE(std::isnan(errors[16]));
    // A flat texel of 16 bits has an error of half a code in x and y.
    EXPECT_NEAR(errors[15], 0.00124F, 1e-5F);
}

TEST(BakeCheck, TheWorstTexelsAreNamed) {
    const BakeOptions options = sized(64, 200);
    Image map = baked_map(make_quad(), make_quad(), options, 16);
    const auto tilt = [&](int x, int y, double degrees) {
        const auto first = 3 * static_cast<std::size_t>(y * 64 + x);
        map.as<std::uint16_t>()[first] =
            static_cast<std::uint16_t>(32768 + std::lround(32767 * std::sin(degrees * degree)));
        map.as<std::uint16_t>()[first + 2] =
            static_cast<std::uint16_t>(32768 + std::lround(32767 * std::cos(degrees * degree)));
    };
    tilt(5, 190, 20.0);
    tilt(63, 3, 10.0);
    const BakeCheck check = checked(make_quad(), make_quad(), options, map);
    ASSERT_EQ(check.worst.size(), 8U);
    EXPECT_EQ(check.worst[0].x, 5);
    EXPECT_EQ(check.worst[0].y, 190);
    EXPECT_NEAR(check.worst[0].degrees, 20.0, 0.002);
    EXPECT_EQ(check.worst[1].x, 63);
    EXPECT_NEAR(check.worst[1].degrees, 10.0, 0.002);
    EXPECT_NEAR(check.error.rms, std::sqrt(500.0 / (64 * 200)), 1e-3);
    // Flat texels have an error of half a 16-bit code in x and y. Percentiles are read from bins.
    EXPECT_LT(check.error.p99, 0.0015);
}

TEST(BakeCheck, IsTheSameForAnyNumberOfThreads) {
    const Mesh high = make_torus(0.43F, 200, 100);
    const Mesh low = make_torus();
    const BakeOptions options = sized(100, 130);
    const Image map = baked_map(high, low, options, 8);
    const BakeCheck usual = checked(high, low, options, map);
    set_thread_limit(1);
    const BakeCheck alone = checked(high, low, options, map);
    set_thread_limit(0);
    EXPECT_EQ(usual.error.rms, alone.error.rms);
    EXPECT_EQ(usual.error.p99, alone.error.p99);
    for (std::size_t i = 0; i < bake_stage_count; ++i)
        EXPECT_EQ(usual.stages[i].share, alone.stages[i].share);
}

TEST(BakeCheck, OfObjectSpaceNeedsNoFrames) {
    const Mesh high = make_torus(0.43F, 200, 100);
    BakeOptions options = sized(64, 64);
    options.space = VectorSpace::object;
    // A quarter turn about z.
    options.output_from_mesh = glm::dmat3(0, 1, 0, -1, 0, 0, 0, 0, 1);
    const Image map = baked_map(high, make_torus(), options, 16);
    const BakeCheck check = checked(high, make_torus(), options, map);
    EXPECT_EQ(check.error.count, 4096U);
    EXPECT_LT(check.center.max, 0.003);
}

TEST(BakeCheck, RefusesWhatIsNoMapOfThatSize) {
    const BakeOptions options = sized(16, 16);
    EXPECT_EQ(test::message_of<InvalidInput>([&] {
                  checked(make_quad(), make_quad(), options,
                          make_image(8, 16, 3, 8, ColorSpace::data));
              }),
              "the map is of 8 x 16 texels, not 16 x 16");
    EXPECT_EQ(test::message_of<InvalidInput>([&] {
                  checked(make_quad(), make_quad(), options,
                          make_image(16, 16, 2, 8, ColorSpace::data));
              }),
              "an image of 2 channels holds no normals");
}

struct Trials {
    Mesh high = waves(256, 20.0);
    BakeOptions options = sized(64, 192);
    Report report;
    Baker baker{std::span(&high, 1), make_quad(), options, report};
    std::vector<NormalMapFormat> formats = {{.bits = 8}, {.bits = 16}};

    BakeCheck check_of(int samples, const NormalMapFormat& format) {
        BakeMapOptions map = options;
        map.samples = samples;
        Image normals = make_image(64, 192, 3, 32, ColorSpace::data);
        std::size_t at = 0;
        baker.bake(
            map,
            [&](const BakedRows& rows) {
                for (const float value : rows.normals)
                    normals.as<float>()[at++] = value;
            },
            report);
        BakeCheckOptions check;
        check.map = map;
        check.reference_samples = 64;
        return check_bake(baker, encode_normal_map(normals, format, report), check, {}, report);
    }
};

/// The bakes that several tests measure.
Trials& shared_trials() {
    static Trials trials;
    return trials;
}

/// All texels with 256 samples as the reference, the default.
const BakeBenchmark& whole_map() {
    static const BakeBenchmark trials(shared_trials().baker, shared_trials().options, 64 * 192);
    return trials;
}

TEST(BakeBenchmark, SayOfAWholeMapWhatACheckSays) {
    Trials& all = shared_trials();
    const BakeBenchmark trials(all.baker, all.options, 64 * 192, 64);
    EXPECT_TRUE(trials.is_whole());
    EXPECT_EQ(trials.texels(), 64U * 192U);
    EXPECT_EQ(trials.reference_samples(), 64);
    for (const int samples : {1, 4}) {
        const BakeMeasurement trial = trials.measure({samples}, all.formats);
        EXPECT_GE(trial.rays, static_cast<std::size_t>(samples) * 64U * 192U);
        for (std::size_t i = 0; i < 2; ++i) {
            const BakeCheck check = all.check_of(samples, all.formats[i]);
            EXPECT_NEAR(trial.errors[i].rms, check.error.rms, 1e-9);
            EXPECT_EQ(trial.errors[i].max, check.error.max);
            const auto codes = static_cast<std::size_t>(BakeStage::quantization);
            EXPECT_NEAR(trial.quantization[i].rms, check.stages.at(codes).rms, 1e-6);
        }
    }
}

TEST(BakeBenchmark, MoreSamplesAndBitsAreTruer) {
    const Trials& all = shared_trials();
    const BakeBenchmark& trials = whole_map();
    EXPECT_EQ(trials.reference_samples(), 256);
    const BakeMeasurement one = trials.measure({1}, all.formats);
    const BakeMeasurement four = trials.measure({4}, all.formats);
    EXPECT_LT(four.errors[1].rms, one.errors[1].rms / 2.0);
    EXPECT_LT(four.errors[1].rms, four.errors[0].rms);
    EXPECT_LT(four.quantization[1].rms, 0.001);
    EXPECT_GT(four.quantization[0].rms, 0.05);
    // A map with one sample at the center is exact there.
    EXPECT_LT(one.center[1].max, 0.002);
}

TEST(BakeBenchmark, ErrorMapsHoldTheErrorsOfEachTexel) {
    const Trials& all = shared_trials();
    const BakeBenchmark part(all.baker, all.options, 1);
    for (const BakeBenchmark* trials : {&whole_map(), &part}) {
        const BakeMeasurement trial = trials->measure({4}, all.formats);
        const Image map = trials->error_map({4}, all.formats[0]);
        EXPECT_EQ(map.width, 64);
        EXPECT_EQ(static_cast<std::size_t>(map.height), trials->texels() / 64);
        const std::span<const float> texel_errors = map.as<float>();
        const ErrorStats all_errors = error_stats({texel_errors.begin(), texel_errors.end()});
        EXPECT_EQ(all_errors.count, trial.errors[0].count);
        EXPECT_NEAR(all_errors.rms, trial.errors[0].rms, 1e-6);
        EXPECT_NEAR(all_errors.max, trial.errors[0].max, 1e-6);
    }
}

TEST(BakeBenchmark, OfAPartAreNearlyThoseOfTheWhole) {
    const Trials& all = shared_trials();
    const BakeBenchmark part(all.baker, all.options, 1);
    EXPECT_FALSE(part.is_whole());
    EXPECT_EQ(part.texels(), 64U * 64U);
    EXPECT_NEAR(part.measure({1}, all.formats).errors[1].rms,
                whole_map().measure({1}, all.formats).errors[1].rms, 0.01);
}

TEST(BakeBenchmark, SeparateSamplingFromRoundingUpTo256Samples) {
    Trials& all = shared_trials();
    const BakeBenchmark trials(all.baker, all.options, 64, 1024);
    EXPECT_EQ(trials.reference_samples(), 1024);
    const BakeMeasurement few = trials.measure({16}, all.formats);
    const BakeMeasurement many = trials.measure({256}, all.formats);
    // A map is not compared with its own samples. Four times as many samples per side are better.
    EXPECT_GT(many.sampling.rms, 0.0);
    EXPECT_LT(many.sampling.rms, 0.5 * few.sampling.rms);
    // Rounding and sampling are independent, and their sum is the error.
    EXPECT_NEAR(many.errors[0].rms, std::hypot(many.sampling.rms, many.quantization[0].rms),
                0.05 * many.errors[0].rms);
    // Larger maps have no memory for this number of samples, even if their charts are small.
    BakeMapOptions large = all.options;
    large.width = 2112;
    large.height = 64;
    Mesh low = make_quad();
    for (glm::vec2& texcoord : low.texcoords)
        texcoord *= 0.1F;
    const Baker baker(std::span(&all.high, 1), low, all.options, all.report);
    EXPECT_EQ(BakeBenchmark(baker, large, 64, 1024).reference_samples(), 256);
}

}  // namespace
}  // namespace relief
