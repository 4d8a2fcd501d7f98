// SPDX-License-Identifier: Apache-2.0
// Trials of a map against checks of it made.
#include "relief/mesh/bake_trials.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mesh/bake/bake_support.h"
#include "relief/mesh/angle_distribution.h"
#include "relief/mesh/shapes.h"

namespace relief {
namespace {

using test::bake;
using test::sized;
using test::waves;

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

TEST(BakeBenchmark, SayOfAWholeMapWhatACheckSays) {
    Trials all;
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
    Trials all;
    const BakeBenchmark trials(all.baker, all.options, 64 * 192);
    EXPECT_EQ(trials.reference_samples(), 256);
    const BakeMeasurement one = trials.measure({1}, all.formats);
    const BakeMeasurement four = trials.measure({4}, all.formats);
    EXPECT_LT(four.errors[1].rms, one.errors[1].rms / 2.0);
    EXPECT_LT(four.errors[1].rms, four.errors[0].rms);
    EXPECT_LT(four.quantization[1].rms, 0.001);
    EXPECT_GT(four.quantization[0].rms, 0.05);
    // What is sampled at the centre alone is exact there.
    EXPECT_LT(one.centre[1].max, 0.002);
}

TEST(BakeBenchmark, ErrorMapsHoldTheErrorsOfEachTexel) {
    Trials all;
    for (const std::size_t texels : {std::size_t{64 * 192}, std::size_t{1}}) {
        const BakeBenchmark trials(all.baker, all.options, texels);
        const BakeMeasurement trial = trials.measure({4}, all.formats);
        const Image map = trials.error_map({4}, all.formats[0]);
        EXPECT_EQ(map.width, 64);
        EXPECT_EQ(static_cast<std::size_t>(map.height), trials.texels() / 64);
        const std::span<const float> texel_errors = map.as<float>();
        const AngleDistribution all_errors =
            angle_distribution({texel_errors.begin(), texel_errors.end()});
        EXPECT_EQ(all_errors.count, trial.errors[0].count);
        EXPECT_NEAR(all_errors.rms, trial.errors[0].rms, 1e-6);
        EXPECT_NEAR(all_errors.max, trial.errors[0].max, 1e-6);
    }
}

TEST(BakeBenchmark, OfAPartAreNearlyThoseOfTheWhole) {
    Trials all;
    const BakeBenchmark part(all.baker, all.options, 1);
    EXPECT_FALSE(part.is_whole());
    EXPECT_EQ(part.texels(), 64U * 64U);
    const BakeBenchmark whole(all.baker, all.options, 64 * 192);
    EXPECT_NEAR(part.measure({1}, all.formats).errors[1].rms,
                whole.measure({1}, all.formats).errors[1].rms, 0.01);
}

TEST(BakeBenchmark, SeparateSamplingFromRoundingUpTo256Samples) {
    Trials all;
    const BakeBenchmark trials(all.baker, all.options, 64, 1024);
    EXPECT_EQ(trials.reference_samples(), 1024);
    const BakeMeasurement few = trials.measure({16}, all.formats);
    const BakeMeasurement many = trials.measure({256}, all.formats);
    // Samples are no comparison with themselves, and four times finer along a side is better.
    EXPECT_GT(many.sampling.rms, 0.0);
    EXPECT_LT(many.sampling.rms, 0.5 * few.sampling.rms);
    // Rounding and sampling are independent: together they make the error.
    EXPECT_NEAR(many.errors[0].rms, std::hypot(many.sampling.rms, many.quantization[0].rms),
                0.05 * many.errors[0].rms);
    // Larger maps have no room for so many samples.
    BakeMapOptions large = all.options;
    large.width = 2112;
    large.height = 64;
    EXPECT_EQ(BakeBenchmark(all.baker, large, 64, 1024).reference_samples(), 256);
}

}  // namespace
}  // namespace relief
