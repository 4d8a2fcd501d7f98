// SPDX-License-Identifier: Apache-2.0
// The errors of kernels against their responses in closed form, and the results of the experiments.
#include "experiment_parts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "relief/accuracy/ground_truth.h"

namespace relief::test {
using namespace relief::accuracy;
using namespace relief::accuracy::detail;

namespace {

constexpr int side = 64 + 2 * wave_margin;

const NamedKernel& kernel_named(const std::string& name) {
    for (const NamedKernel& kernel : named_kernels()) {
        if (kernel.name == name) return kernel;
    }
    throw std::runtime_error("no kernel " + name);
}

double wave_rms(const std::string& kernel, double wavelength, int bits) {
    // Large enough for a whole wave, so that codes of few bits use their whole range.
    const WaveMap wave = oblique_wave(256 + 2 * wave_margin, wavelength, bits);
    return wave_errors(wave, kernel_named(kernel), Arithmetic::float64).rms;
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
        const WaveMap wave = oblique_wave(side, wavelength, 32);
        for (const NamedKernel& kernel : named_kernels()) {
            if (kernel.kernel == Kernel::forward) continue;  // It is shifted by half a texel.
            const double expected =
                expected_rms(gradient_kernel(kernel.kernel, kernel.radius), wavelength);
            // Heights are rounded to float: 2^-24 of up to 16 texels, a millionth in a slope.
            EXPECT_NEAR(wave_errors(wave, kernel, Arithmetic::float64).rms, expected,
                        1e-6 * expected + 1e-4)
                << kernel.name << " " << wavelength;
        }
    }
}

struct PublishedCodes {
    const char* kernel;
    double in_8_bits;
    double in_16_bits;
};

TEST(WaveErrors, MatchPublishedErrorsOfFewCodes) {
    // The error of codes depends on their phase, so the last digits differ.
    constexpr double codes_fall_otherwise = 0.05;
    for (const PublishedCodes& row : {PublishedCodes{"forward", 8.11, 0.345},
                                      {"central3", 4.30, 0.016},
                                      {"sobel3", 1.98, 0.0087},
                                      {"scharr3", 2.40, 0.0099},
                                      {"central5", 5.86, 0.022},
                                      {"central7", 6.73, 0.025},
                                      {"sobel5", 0.96, 0.0077}}) {
        EXPECT_NEAR(wave_rms(row.kernel, 256.0, 8), row.in_8_bits,
                    codes_fall_otherwise * row.in_8_bits)
            << row.kernel;
        EXPECT_NEAR(wave_rms(row.kernel, 256.0, 16), row.in_16_bits,
                    codes_fall_otherwise * row.in_16_bits)
            << row.kernel;
    }
}

TEST(SurfaceAt, IsTheSameSurfaceInFinerTexels) {
    const WaveMap coarse = surface_at(64);
    const WaveMap fine = surface_at(128);
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

}  // namespace
}  // namespace relief::test
