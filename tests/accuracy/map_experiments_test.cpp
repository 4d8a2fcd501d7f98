// SPDX-License-Identifier: Apache-2.0
// The errors of kernels against their responses in closed form, and the error metrics of maps and
// images with known errors.
#include "experiment_parts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/report.h"

namespace relief::test {
using namespace relief::accuracy;
using namespace relief::accuracy::detail;

namespace {

constexpr int side = 64 + 2 * wave_margin;

double wave_rms(Kernel kernel, double wavelength, int bits) {
    // Large enough for a whole wave, so that codes of few bits use their whole range.
    const BumpField wave = oblique_wave(256 + 2 * wave_margin, wavelength, bits);
    return wave_errors(wave, {kernel, 2, Arithmetic::float64}).rms;
}

/// The error of a kernel on the wave at each texel, from its response in closed form.
double expected_rms(const GradientKernel& kernel, double wavelength) {
    const double steepness = 2.0 * std::numbers::pi / wavelength;
    const glm::dvec2 along = glm::dvec2(2.0, 1.0) / std::sqrt(5.0);
    const glm::dvec2 frequency = steepness * along;
    const glm::dvec2 gains(slope_response(kernel, frequency),
                           slope_response(kernel, {frequency.y, frequency.x}));
    double squares = 0.0;
    for (int y = wave_margin; y < side - wave_margin; ++y) {
        for (int x = wave_margin; x < side - wave_margin; ++x) {
            const glm::dvec2 slope = along * std::cos(glm::dot(frequency, glm::dvec2(x, y)) + 0.7);
            const glm::dvec2 found = slope * gains;
            squares +=
                std::pow(degrees_between({-slope.x, slope.y, 1.0}, {-found.x, found.y, 1.0}), 2);
        }
    }
    const double texels = (side - 2.0 * wave_margin) * (side - 2.0 * wave_margin);
    return std::sqrt(squares / texels);
}

TEST(WaveErrors, AreThoseOfTheKernelsResponse) {
    for (const double wavelength : {6.0, 32.0, 100.0}) {
        const BumpField wave = oblique_wave(side, wavelength, 32);
        for (const BumpMethod& method : kernel_methods()) {
            if (method.kernel == Kernel::forward) continue;  // It is shifted by half a texel.
            const double expected =
                expected_rms(gradient_kernel(method.kernel, method.gaussian_radius), wavelength);
            // Heights are rounded to float: 2^-24 of up to 16 texels, a millionth in a slope.
            EXPECT_NEAR(wave_errors(wave, method).rms, expected, 1e-6 * expected + 1e-4)
                << name_of(method.kernel, method.gaussian_radius) << " " << wavelength;
        }
    }
}

struct PublishedCodes {
    Kernel kernel;
    double in_8_bits;
    double in_16_bits;
};

TEST(WaveErrors, MatchPublishedErrorsOfFewCodes) {
    // The error of codes depends on their phase, so the last digits differ.
    constexpr double codes_fall_otherwise = 0.05;
    for (const PublishedCodes& row : {PublishedCodes{Kernel::forward, 8.11, 0.345},
                                      {Kernel::central3, 4.30, 0.016},
                                      {Kernel::sobel3, 1.98, 0.0087},
                                      {Kernel::scharr3, 2.40, 0.0099},
                                      {Kernel::central5, 5.86, 0.022},
                                      {Kernel::central7, 6.73, 0.025},
                                      {Kernel::sobel5, 0.96, 0.0077}}) {
        EXPECT_NEAR(wave_rms(row.kernel, 256.0, 8), row.in_8_bits,
                    codes_fall_otherwise * row.in_8_bits)
            << enum_name(row.kernel);
        EXPECT_NEAR(wave_rms(row.kernel, 256.0, 16), row.in_16_bits,
                    codes_fall_otherwise * row.in_16_bits)
            << enum_name(row.kernel);
    }
}

TEST(SurfaceAt, IsTheSameSurfaceInFinerTexels) {
    const BumpField coarse = surface_at(64);
    const BumpField fine = surface_at(128);
    for (std::size_t y = 0; y < 64; ++y) {
        for (std::size_t x = 0; x < 64; ++x) {
            // Texel (0, 0) is at the same position in both maps.
            EXPECT_LE(glm::length(coarse.normals[64 * y + x] - fine.normals[128 * 2 * y + 2 * x]),
                      1e-12);
            EXPECT_FLOAT_EQ(2.0F * coarse.heights.as<float>()[64 * y + x],
                            fine.heights.as<float>()[128 * 2 * y + 2 * x]);
        }
    }
}

/// A map of 4 x 4 texels whose normals lean to the right by an angle in degrees.
Image leaning_map(double degrees) {
    const double angle = degrees * std::numbers::pi / 180.0;
    Image map = make_image(4, 4, 3, 32, ColorSpace::data);
    for (std::size_t i = 0; i < 16; ++i) {
        map.as<float>()[3 * i] = static_cast<float>(std::sin(angle));
        map.as<float>()[3 * i + 2] = static_cast<float>(std::cos(angle));
    }
    return map;
}

const std::vector<glm::dvec3> level(16, glm::dvec3(0.0, 0.0, 1.0));

TEST(MapErrors, AreTheLeanOfEachTexel) {
    Image map = leaning_map(1.0);
    map.as<float>()[0] = map.as<float>()[2];  // 45 degrees in the upper left corner.
    const Image angles = angles_of(map, level);
    EXPECT_EQ(angles.channels, 1);
    EXPECT_NEAR(static_cast<double>(angles.as<float>()[0]), 45.0, 1e-5);
    EXPECT_NEAR(static_cast<double>(angles.as<float>()[5]), 1.0, 1e-5);
    EXPECT_NEAR(map_errors(map, level).max, 45.0, 1e-5);
    EXPECT_NEAR(map_errors(map, level).mean, (45.0 + 15.0) / 16.0, 1e-5);
    EXPECT_NEAR(map_errors(map, level, 1).max, 1.0, 1e-5);
    EXPECT_EQ(map_errors(map, level, 1).count, 4U);
}

TEST(MapErrors, CountZeroVectorsAndRefuseOtherSizes) {
    Image map = leaning_map(1.0);
    map.as<float>()[2] = 0.0F;
    map.as<float>()[0] = 0.0F;
    EXPECT_EQ(map_errors(map, level).undefined, 1U);
    EXPECT_EQ(map_errors(map, level).count, 15U);
    EXPECT_THROW(map_errors(make_image(4, 5, 3, 32, ColorSpace::data), level), InvalidInput);
    EXPECT_THROW(map_errors(make_image(4, 4, 3, 16, ColorSpace::data), level), InvalidInput);
}

Image gray(int code, int size = 32) {
    Image image = make_image(size, size, 3, 8, ColorSpace::srgb);
    for (std::uint8_t& sample : image.as<std::uint8_t>())
        sample = static_cast<std::uint8_t>(code);
    return image;
}

TEST(PictureError, EqualPicturesHaveNone) {
    const Image picture = gray(100);
    const PictureError error = picture_error(to_linear(picture), picture);
    EXPECT_EQ(error.figures.count, 32U * 32U);
    EXPECT_EQ(error.figures.max, 0.0);
    EXPECT_EQ(error.figures.psnr.value(), std::numeric_limits<double>::infinity());
}

TEST(PictureError, IsInDecibelsOfCodes) {
    // Ten codes of 255 everywhere.
    const PictureError error = picture_error(to_linear(gray(100)), gray(110));
    EXPECT_NEAR(error.figures.psnr.value(), 20.0 * std::log10(255.0 / 10.0), 0.01);
    // All pixels are equal, so all statistics are.
    EXPECT_NEAR(error.figures.rms, error.figures.max, 1e-3);
    EXPECT_NEAR(error.figures.mean, error.figures.p99, 1e-3);
    EXPECT_GT(error.figures.mean, 0.02);
}

TEST(PictureError, BlackForWhiteIsNearlyTheMaximum) {
    const PictureError error = picture_error(to_linear(gray(255)), gray(0));
    EXPECT_GT(error.figures.mean, 0.95);
    EXPECT_LE(error.figures.max, 1.0);
    EXPECT_NEAR(error.figures.psnr.value(), 0.0, 1e-4);
}

TEST(PictureError, ComparesDisplayedColors) {
    // The difference is less than half a code everywhere, so the codes are equal.
    Image ground_truth = to_linear(gray(100));
    for (float& sample : ground_truth.as<float>())
        sample = linear_from_srgb(100.4F / 255.0F);
    EXPECT_EQ(picture_error(ground_truth, gray(100)).figures.max, 0.0);
    // One sample in three differs by one code.
    Image picture = gray(100);
    for (std::size_t i = 0; i < picture.sample_count(); i += 3)
        picture.as<std::uint8_t>()[i] = 101;
    const ErrorStats figures = picture_error(ground_truth, picture).figures;
    EXPECT_NEAR(figures.psnr.value(), 20.0 * std::log10(255.0 * std::sqrt(3.0)), 1e-6);
    EXPECT_GT(figures.mean, 0.0);
}

TEST(Averaged, IsTheMeanOfEachSquare) {
    Image image = make_image(4, 2, 1, 32, ColorSpace::linear);
    for (std::size_t i = 0; i < 8; ++i)
        image.as<float>()[i] = static_cast<float>(i * i);
    const Image mean = averaged(image, 2);
    ASSERT_EQ(mean.width, 2);
    ASSERT_EQ(mean.height, 1);
    EXPECT_EQ(mean.as<float>()[0], (0.0F + 1.0F + 16.0F + 25.0F) / 4.0F);
    EXPECT_EQ(mean.as<float>()[1], (4.0F + 9.0F + 36.0F + 49.0F) / 4.0F);
    EXPECT_THROW(averaged(image, 3), InvalidInput);
}

}  // namespace
}  // namespace relief::test
