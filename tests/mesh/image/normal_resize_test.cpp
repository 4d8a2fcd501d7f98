// SPDX-License-Identifier: Apache-2.0
// Resized normal maps and their mip levels, against the exact normals of the same surface at the
// other resolution.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "relief/mesh/execution.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/report.h"
#include "support/images.h"
#include "support/invariants.h"
#include "support/labels.h"

namespace relief {
using namespace relief::accuracy;

namespace {

using test::message_of;
using test::normals_image;
using test::resized_waves;
using test::samples_of;
using testing::Each;
using testing::ElementsAre;
using testing::FloatNear;
using testing::Pointwise;

constexpr ResizeFilter all_filters[] = {ResizeFilter::box, ResizeFilter::triangle,
                                        ResizeFilter::cubic, ResizeFilter::lanczos};
constexpr ResizeDomain both_domains[] = {ResizeDomain::slopes, ResizeDomain::vectors};

/// A row of normals with slopes along x.
Image normals_of_slopes(const std::vector<double>& slopes) {
    Image image = make_image(static_cast<int>(slopes.size()), 1, 2, 32, ColorSpace::data);
    for (std::size_t i = 0; i < slopes.size(); ++i)
        image.as<float>()[2 * i] = static_cast<float>(slopes[i]);
    Report report;
    return normals_from_slopes(image, report);
}

std::vector<float> slopes_of(const Image& normals) {
    Report report;
    const Image slopes = slopes_from_normals(normals, report);
    std::vector<float> result;
    for (std::size_t i = 0; i < slopes.sample_count(); i += 2)
        result.push_back(slopes.as<float>()[i]);
    return result;
}

Image resized(const Image& normals, int width, int height, const ResizeOptions& options) {
    Report report;
    Image result = resize_normals(normals, width, height, options, report);
    EXPECT_TRUE(report.empty());
    return result;
}

TEST(ResizeNormals, AConstantMapStaysAsItIs) {
    const Image normals = normals_of_slopes(std::vector<double>(7, 0.75));
    for (const ResizeFilter filter : all_filters) {
        for (const ResizeDomain domain : both_domains) {
            for (const Wrap wrap : {Wrap::repeat, Wrap::clamp, Wrap::mirror}) {
                for (const int width : {1, 3, 7, 20}) {
                    const Image result =
                        resized(normals, width, 2, {filter, domain, wrap, {1.0, 1.0}});
                    EXPECT_THAT(slopes_of(result), testing::Each(FloatNear(0.75F, 1e-5F)));
                }
            }
        }
    }
}

TEST(ResizeNormals, SlopesHaveTheMeanThatTheFilteredSurfaceHas) {
    const Image normals = normals_of_slopes({0.0, 1.0, 3.0, -1.0});
    const ResizeOptions box{ResizeFilter::box, ResizeDomain::slopes, Wrap::repeat, {1.0, 1.0}};
    EXPECT_THAT(slopes_of(resized(normals, 2, 1, box)), Pointwise(FloatNear(1e-6F), {0.5F, 1.0F}));
    EXPECT_THAT(slopes_of(resized(normals, 1, 1, box)), Pointwise(FloatNear(1e-6F), {0.75F}));
    // 3 texels for 4: each covers a whole one and a third.
    EXPECT_THAT(slopes_of(resized(normals, 3, 1, box)),
                Pointwise(FloatNear(1e-6F), {0.25F, 2.0F, 0.0F}));
    EXPECT_THAT(slopes_of(resized(normals, 8, 1, box)),
                Pointwise(FloatNear(1e-6F), {0.0F, 0.0F, 1.0F, 1.0F, 3.0F, 3.0F, -1.0F, -1.0F}));
    ResizeOptions triangle = box;
    triangle.filter = ResizeFilter::triangle;
    EXPECT_THAT(
        slopes_of(resized(normals, 8, 1, triangle)),
        Pointwise(FloatNear(1e-6F), {-0.25F, 0.25F, 0.75F, 1.5F, 2.5F, 2.0F, 0.0F, -0.75F}));
    triangle.wrap = Wrap::clamp;
    EXPECT_THAT(slopes_of(resized(normals, 8, 1, triangle)),
                Pointwise(FloatNear(1e-6F), {0.0F, 0.25F, 0.75F, 1.5F, 2.5F, 2.0F, 0.0F, -1.0F}));
}

TEST(ResizeNormals, VectorsHaveTheDirectionOfTheirSum) {
    ResizeOptions options{ResizeFilter::box, ResizeDomain::vectors, Wrap::repeat, {1.0, 1.0}};
    const Image result = resized(normals_of_slopes({0.0, -0.75}), 1, 1, options);
    EXPECT_LT(degrees_between({result.as<float>()[0], result.as<float>()[1], result.as<float>()[2]},
                              {0.6, 0.0, 1.8}),
              1e-5);
}

TEST(ResizeNormals, AtItsOwnSizeAMapStaysToTheBit) {
    const Image normals = normals_image(20, 30, tiling_waves(20, 30, 4, 5, 1.0, 9));
    for (const ResizeFilter filter : all_filters)
        EXPECT_EQ(resized(normals, 20, 30, {filter, {}, {}, {1.0, 1.0}}).samples, normals.samples);
}

/// Returns the RMS error in degrees of 96 x 96 texels of waves with a length of at least
/// `shortest`, resized to the width `side`.
double error_at(int side, double shortest, ResizeFilter filter, ResizeDomain domain) {
    const std::vector<HeightWave> waves = tiling_waves(96, 96, 12, shortest, 0.7, 5);
    const Image normals = normals_image(96, 96, waves);
    return normal_error(resized(normals, side, side, {filter, domain, Wrap::repeat, {1.0, 1.0}}),
                        wave_heights(side, side, resized_waves(waves, 96.0 / side)))
        .rms;
}

TEST_LABELS(not_sanitized);
TEST(ResizeNormals, IsTrueToTheSameSurfaceAtTheOtherResolution) {
    // Measured, in degrees: box, triangle, cubic, lanczos.
    const std::map<int, std::array<double, 4>> by_slopes = {{24, {0.722, 1.557, 0.197, 0.129}},
                                                            {64, {1.183, 1.226, 0.244, 0.098}},
                                                            {144, {4.031, 0.559, 0.055, 0.127}},
                                                            {192, {3.064, 0.574, 0.064, 0.163}}};
    for (const auto& [side, errors] : by_slopes) {
        const double shortest = side < 96 ? 4.0 * 96 / side : 6.0;
        for (std::size_t i = 0; i < errors.size(); ++i) {
            const double error = error_at(side, shortest, all_filters[i], ResizeDomain::slopes);
            EXPECT_NEAR(error, errors[i], 0.001);
            const double vectors = error_at(side, shortest, all_filters[i], ResizeDomain::vectors);
            EXPECT_LT(error, vectors * 1.07);
        }
        EXPECT_NEAR(error_at(side, shortest, ResizeFilter::best, ResizeDomain::slopes),
                    *std::min_element(errors.begin(), errors.end()), 0.001);
    }
}

/// Returns the RMS error of a map of 96 x 96 that shrinks until it cannot hold most of its waves.
/// The reference contains only the others.
double error_of_loss(int side, ResizeDomain domain) {
    const double shortest_held = 2.0 * 96 / side;
    const auto held = tiling_waves(96, 96, 12, 1.3 * shortest_held, 1.0, 5);
    std::vector<HeightWave> all = held;
    for (const HeightWave& wave : tiling_waves(96, 96, 200, 3.0, 1.0, 6)) {
        const double length = 2.0 * std::numbers::pi / glm::length(wave.frequency);
        if (all.size() < 40 && length < shortest_held / 1.3) all.push_back(wave);
    }
    Report report;
    ResizeOptions options;
    options.domain = domain;
    const Image result = resize_normals(normals_image(96, 96, all), side, side, options, report);
    return normal_error(result, wave_heights(side, side, resized_waves(held, 96.0 / side))).rms;
}

TEST(ResizeNormals, SlopesKeepDepthAndVectorsLoseIt) {
    EXPECT_NEAR(error_of_loss(24, ResizeDomain::slopes), 0.853, 0.01);
    EXPECT_NEAR(error_of_loss(24, ResizeDomain::vectors), 2.112, 0.01);
}

TEST(ResizeNormals, NormalsThatCancelAreFlatAndCounted) {
    Image normals = make_image(4, 1, 3, 32, ColorSpace::data);
    normals.samples = std::vector<float>{1, 0, 0, -1, 0, 0, 0, 0, 1, 0, 0, 1};
    Report report;
    const Image result = resize_normals(
        normals, 2, 1, {ResizeFilter::box, ResizeDomain::vectors, Wrap::repeat, {1.0, 1.0}},
        report);
    EXPECT_THAT(samples_of<float>(result), ElementsAre(0, 0, 1, 0, 0, 1));
    EXPECT_EQ(report.count("normals that cancel"), 1U);
    // The slopes of such steep normals are not averaged.
    Report steep;
    const Image by_slopes = resize_normals(
        normals, 2, 1, {ResizeFilter::box, ResizeDomain::slopes, Wrap::repeat, {1.0, 1.0}}, steep);
    EXPECT_EQ(by_slopes.samples, result.samples);
    EXPECT_EQ(steep.count("normal too steep to average slopes"), 2U);
    EXPECT_EQ(steep.count("normals that cancel"), 1U);
}

TEST(ResizeNormals, SteepTexelsAreAveragedAsVectors) {
    std::vector<double> slopes(32, 0.0);
    slopes[16] = 1000.0;
    const Image normals = normals_of_slopes(slopes);
    for (const ResizeDomain domain : both_domains) {
        Report report;
        const Image result = resize_normals(
            normals, 16, 1, {ResizeFilter::lanczos, domain, Wrap::repeat, {1.0, 1.0}}, report);
        // Its weights at a quarter and five quarters from the center: 0.4461 and -0.0664 of 1.
        const std::vector<float> found = slopes_of(result);
        EXPECT_NEAR(*std::max_element(found.begin(), found.end()), 0.4461 / 0.5539, 1e-3);
        EXPECT_NEAR(*std::min_element(found.begin(), found.end()), -0.0664 / 1.0664, 1e-3);
        EXPECT_EQ(report.count("normal too steep to average slopes"),
                  domain == ResizeDomain::slopes ? 1U : 0U);
    }
    slopes[16] = 15.0;
    EXPECT_GT(slopes_of(resized(normals_of_slopes(slopes), 16, 1, {}))[8], 6.0F);
}

TEST(ResizeNormals, TheSameBitsForAnyNumberOfThreads) {
    const Image normals = normals_image(211, 173, tiling_waves(211, 173, 6, 9, 1.0, 3));
    for (const ResizeDomain domain : both_domains) {
        const ResizeOptions options{ResizeFilter::lanczos, domain, Wrap::mirror, {1.0, 1.0}};
        set_thread_limit(1);
        const Image one = resized(normals, 300, 97, options);
        set_thread_limit(0);
        EXPECT_EQ(resized(normals, 300, 97, options).samples, one.samples);
    }
}

TEST(ResizeNormals, RefusesSizesThatAreNone) {
    const Image normals = normals_of_slopes({0.0});
    Report report;
    EXPECT_EQ(message_of<InvalidInput>([&] { resize_normals(normals, 0, 4, {}, report); }),
              "the size is 0 x 4 texels, but must be at least 1 x 1");
    ResizeOptions none;
    none.repeat.y = 0.0;
    EXPECT_EQ(message_of<InvalidInput>([&] { resize_normals(normals, 4, 4, none, report); }),
              "the number of repeats is 0, but must be above 0 and at most 1e4");
}

TEST(FittedDetail, IsOnePeriodIfTheBaseHasAnIntegerNumber) {
    const std::vector<HeightWave> waves = tiling_waves(64, 64, 5, 8, 0.7, 5);
    const Image detail = normals_image(64, 64, waves);
    Report report;
    ResizeOptions options;
    options.repeat = {2.0, 4.0};
    const Image same = fitted_detail(detail, 128, 256, options, report);
    EXPECT_EQ(same.samples, detail.samples);
    const Image period = fitted_detail(detail, 256, 512, options, report);
    EXPECT_EQ(period.width, 128);
    EXPECT_EQ(period.height, 128);
    EXPECT_LT(normal_error(period, wave_heights(128, 128, resized_waves(waves, 0.5))).rms, 0.2);
}

TEST(FittedDetail, OtherwiseCoversTheBase) {
    const std::vector<HeightWave> waves = tiling_waves(64, 64, 5, 8, 0.7, 5);
    const Image detail = normals_image(64, 64, waves);
    Report report;
    ResizeOptions options;
    options.repeat = {2.5, 2.5};
    // 160 texels of the detail on 128: it is periodic beyond its border.
    const Image fitted = fitted_detail(detail, 128, 128, options, report);
    EXPECT_EQ(fitted.width, 128);
    EXPECT_LT(normal_error(fitted, wave_heights(128, 128, resized_waves(waves, 1.25))).rms, 0.7);
    options.repeat = {3.0, 2.0};
    const Image mixed = fitted_detail(detail, 128, 128, options, report);
    EXPECT_EQ(mixed.width, 128);
    EXPECT_EQ(mixed.height, 64);
}

/// A checkerboard of normals with this slope to the left and to the right.
Image checker(int side, float slope) {
    Image slopes = make_image(side, side, 2, 32, ColorSpace::data);
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x)
            slopes.as<float>()[static_cast<std::size_t>(y * side + x) * 2] =
                (x + y) % 2 == 0 ? slope : -slope;
    }
    Report report;
    return normals_from_slopes(slopes, report);
}

TEST(NormalMips, CheckerHasTheLengthOfItsMean) {
    std::vector<Image> levels = normal_mip_levels(checker(8, 1.0F));
    ASSERT_EQ(levels.size(), 3U);
    for (Image& level : levels) {
        Report report;
        const Image lengths = split_lengths(level, report);
        EXPECT_THAT(lengths.as<float>(), Each(FloatNear(std::sqrt(0.5F), 1e-6F)));
        for (std::size_t i = 0; i < level.sample_count(); ++i)
            EXPECT_EQ(level.as<float>()[i], i % 3 == 2 ? 1.0F : 0.0F);
        EXPECT_TRUE(report.empty());
        // Slopes of +-1 along x have a variance of 1, and along y of 0. Roughness 0.5 has alpha
        // 0.25.
        const Image roughness = roughness_from_lengths(lengths, 0.5);
        EXPECT_THAT(roughness.as<float>(), Each(1.0F));
    }
    std::vector<Image> gentle = normal_mip_levels(checker(4, 0.2F));
    Report report;
    const Image lengths = split_lengths(gentle[0], report);
    EXPECT_THAT(samples_of<float>(roughness_from_lengths(lengths, 0.5)),
                Each(FloatNear(std::pow(0.0625F + 0.04F, 0.25F), 1e-6F)));
}

TEST(NormalMips, AMeanIsThatOfTheMapItselfAtEveryLevel) {
    // The mean of unit vectors level by level would give another direction.
    Image normals = make_image(4, 1, 3, 32, ColorSpace::data);
    normals.samples = std::vector<float>{1, 0, 0, -1, 0, 0, 0, 0, 1, 0.6F, 0, 0.8F};
    const std::vector<Image> levels = normal_mip_levels(normals);
    ASSERT_EQ(levels.size(), 2U);
    EXPECT_THAT(samples_of<float>(levels[1]),
                ElementsAre(FloatNear(0.15F, 1e-7F), 0, FloatNear(0.45F, 1e-7F)));
}

TEST(NormalMips, NormalsThatCancelAreFlatWithLengthZeroAndCounted) {
    Image means = make_image(2, 1, 3, 32, ColorSpace::data);
    means.samples = std::vector<float>{1e-8F, 0, 0, 0, 0.5F, 0};
    Report report;
    const Image lengths = split_lengths(means, report);
    EXPECT_THAT(samples_of<float>(means), ElementsAre(0, 0, 1, 0, 1, 0));
    EXPECT_THAT(samples_of<float>(lengths), ElementsAre(FloatNear(0, 1e-7F), 0.5F));
    EXPECT_EQ(report.count("normals that cancel"), 1U);
    EXPECT_EQ(samples_of<float>(roughness_from_lengths(lengths, 0.1))[0], 1.0F);
}

TEST(NormalMips, VarianceOfTheLength) {
    EXPECT_EQ(slope_variance_of_length(1.0), 0.0);
    EXPECT_EQ(slope_variance_of_length(1.5), 0.0);
    EXPECT_NEAR(slope_variance_of_length(0.8), 0.28125, 1e-12);
    EXPECT_TRUE(std::isfinite(slope_variance_of_length(0.0)));
    EXPECT_NEAR(toksvig_factor(0.8, 100.0), 0.8 / 20.8, 1e-12);
    EXPECT_EQ(toksvig_factor(1.0, 1e6), 1.0);
    EXPECT_EQ(toksvig_factor(0.0, 10.0), 0.0);
    EXPECT_EQ(roughness_with_variance(0.4, 0.0), 0.4);
    EXPECT_NEAR(roughness_with_variance(0.0, 0.02), std::sqrt(0.2), 1e-12);
    EXPECT_EQ(roughness_with_variance(0.5, 10.0), 1.0);
}

/// Returns the mean length of unit normals whose slopes have a normal distribution with this
/// deviation along each axis: the integral of exp(-t) / sqrt(1 + 2 deviation^2 t).
double length_of_gaussian(double deviation) {
    double sum = 0.0;
    constexpr int steps = 40000;
    for (int i = 0; i < steps; ++i) {
        const double t = (i + 0.5) * 40.0 / steps;
        sum += std::exp(-t) / std::sqrt(1.0 + 2.0 * deviation * deviation * t) * 40.0 / steps;
    }
    return sum;
}

TEST(NormalMips, LengthYieldsTheVarianceOfGaussianSlopes) {
    // Toksvig's measure, (1 - r) / r, gives smaller shares: 0.995, 0.932, 0.746, 0.525.
    for (const auto& [deviation, share] : {std::pair{0.05, 0.9963}, std::pair{0.2, 0.9499},
                                           std::pair{0.5, 0.8161}, std::pair{1.0, 0.6630}}) {
        const double length = length_of_gaussian(deviation);
        const double variance = deviation * deviation;
        EXPECT_NEAR(slope_variance_of_length(length) / variance, share, 1e-4);
        EXPECT_LT((1.0 - length) / length, slope_variance_of_length(length));
    }
}

TEST(NormalMips, RefusesInvalidImages) {
    const Image codes = make_image(2, 2, 3, 8, ColorSpace::data);
    EXPECT_EQ(test::message_of<InvalidInput>([&] { normal_mip_levels(codes); }),
              "normals have 3 float channels, not 3 of 8 bits");
    const Image lengths = make_image(2, 2, 1, 32, ColorSpace::data);
    EXPECT_EQ(test::message_of<InvalidInput>([&] { roughness_from_lengths(lengths, 1.5); }),
              "the roughness is 1.5, but must be within [0, 1]");
}

}  // namespace
}  // namespace relief
