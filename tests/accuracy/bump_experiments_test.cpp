// SPDX-License-Identifier: Apache-2.0
// The errors of kernels against their responses in closed form, and the results of the experiments.
#include "experiment_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include "experiment_checks.h"
#include "relief/accuracy/asset.h"
#include "relief/mesh/report.h"

namespace relief::test {
using namespace relief::accuracy;
using namespace relief::accuracy::detail;

namespace {

using Real = long double;
constexpr int side = 64 + 2 * wave_margin;

double degrees(double radians) {
    return radians * 180.0 / std::numbers::pi;
}

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

/// The height of a wave in long double, by an independent formula.
Real height_at(Real x, Real y, Real wavelength) {
    const Real steepness = 2 * std::numbers::pi_v<Real> / wavelength;
    return std::sin(steepness * (2 * x + y) / std::sqrt(Real(5)) + Real(0.7)) / steepness;
}

/// The derivative by central differences of three widths, extrapolated twice; the error is O(h^6).
template <typename Function>
Real derivative(const Function& function) {
    const auto central = [&](Real h) { return (function(h) - function(-h)) / (2 * h); };
    const Real h = 0.05L;
    const Real once = (4 * central(h / 2) - central(h)) / 3;
    const Real again = (4 * central(h / 4) - central(h / 2)) / 3;
    return (16 * again - once) / 15;
}

TEST(ObliqueWave, HasTheNormalsOfNumericDerivatives) {
    for (const Real wavelength : {4.0L, 32.0L}) {
        const WaveMap wave = oblique_wave(16, static_cast<double>(wavelength), 32);
        for (std::size_t i = 0; i < wave.normals.size(); ++i) {
            const Real x = static_cast<Real>(i % 16);
            const Real y = static_cast<Real>(i / 16);
            const Real dx = derivative([&](Real h) { return height_at(x + h, y, wavelength); });
            const Real dy = derivative([&](Real h) { return height_at(x, y + h, wavelength); });
            // Rows run downwards, the y of normals upwards.
            const glm::dvec3 expected(static_cast<double>(-dx), static_cast<double>(dy), 1.0);
            EXPECT_LE(degrees_between(wave.normals[i], expected), 1e-6);
            EXPECT_FLOAT_EQ(wave.heights.as<float>()[i],
                            static_cast<float>(height_at(x, y, wavelength)));
        }
    }
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

struct Published {
    const char* kernel;
    double wave_32;
    double wave_8;
};

TEST(WaveErrors, AreThosePublishedForSlopeOneWaves) {
    // Measured by another program on a wave in this direction, to two or three digits.
    for (const Published& row : {Published{"forward", 2.77, 10.9},
                                 {"central3", 0.116, 1.85},
                                 {"sobel3", 0.181, 2.89},
                                 {"scharr3", 0.161, 2.57},
                                 {"central5", 0.0007, 0.175},
                                 {"sobel5", 0.412, 6.42}}) {
        EXPECT_NEAR(wave_rms(row.kernel, 32.0, 32), row.wave_32, 0.01 * row.wave_32 + 5e-5)
            << row.kernel;
        EXPECT_NEAR(wave_rms(row.kernel, 8.0, 32), row.wave_8, 0.01 * row.wave_8) << row.kernel;
    }
    EXPECT_NEAR(wave_rms("central7", 8.0, 32), 0.018, 5e-4);
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

TEST(BumpErrors, MeasureAWrongGainOfOnePercent) {
    constexpr double slope = 0.5;
    constexpr int size = 64;
    BumpField ramp;
    ramp.heights = make_image(size, size, 1, 32, ColorSpace::data);
    for (std::size_t i = 0; i < ramp.heights.sample_count(); ++i)
        ramp.heights.as<float>()[i] = static_cast<float>(slope) * static_cast<float>(i % size);
    ramp.normals.assign(ramp.heights.sample_count(), glm::normalize(glm::dvec3(-slope, 0.0, 1.0)));
    ramp.options.wrap = Wrap::clamp;
    ramp.options.strength = 1.0;
    BumpExperimentOptions untimed;
    untimed.repeats = {0, 0};
    const std::array methods = {BumpMethod{Kernel::sobel3, 2, Arithmetic::float64, 32, false},
                                BumpMethod{Kernel::central7, 2, Arithmetic::float32, 32, false}};
    const BumpExperiment right = measure_bump(ramp, methods, untimed);
    ramp.options.strength = 1.01;
    const BumpExperiment strong = measure_bump(ramp, methods, untimed);
    const double expected = degrees(std::atan(1.01 * slope) - std::atan(slope));
    for (std::size_t i = 0; i < methods.size(); ++i) {
        EXPECT_LE(right.measurements[i].error.max, 1e-4);
        EXPECT_NEAR(strong.measurements[i].error.rms, expected, 1e-4);
        EXPECT_NEAR(strong.measurements[i].error.max, expected, 1e-4);
    }
}

TEST(NamedKernels, AreAllThereAndGoByOneNameEach) {
    std::set<std::string> names;
    std::set<Kernel> kernels;
    for (const NamedKernel& named : named_kernels()) {
        names.insert(named.name);
        kernels.insert(named.kernel);
        EXPECT_EQ(name_of(named.kernel, named.radius), named.name);
    }
    EXPECT_EQ(names.size(), 13U);
    EXPECT_EQ(kernels.size(), 10U);
    EXPECT_EQ(name_of(Kernel::gaussian, 7), "gaussian 7");
    EXPECT_STREQ(field_recipe("domes of 44, 8 bit").name, "domes of 44, 8 bit");
    EXPECT_THROW(field_recipe("no such field"), InvalidInput);
}

/// The height of surface_at() in long double: the waves of the coarsest map, scaled along all axes.
Real enlarged_height_at(Real x, Real y, Real scale) {
    static const std::vector<HeightWave> waves = tiling_waves(64, 64, 8, 8.0, 0.3, 5);
    Real sum = 0;
    for (const HeightWave& wave : waves) {
        const Real along_x = static_cast<Real>(wave.frequency.x) * (x / scale);
        const Real along_y = static_cast<Real>(wave.frequency.y) * (y / scale);
        sum += static_cast<Real>(wave.amplitude) *
               std::sin(along_x + along_y + static_cast<Real>(wave.phase));
    }
    return scale * sum;
}

TEST(SurfaceAt, HasTheNormalsOfNumericDerivatives) {
    for (const int texels : {64, 128, 256}) {
        const WaveMap surface = surface_at(texels);
        const Real scale = static_cast<Real>(texels) / 64;
        double max_slope = 0.0;
        // Compare all texels of the coarsest map, and an irregular selection of those of finer
        // maps.
        for (std::size_t i = 0; i < surface.normals.size(); i += texels == 64 ? 1 : 97) {
            const Real x = static_cast<Real>(i % static_cast<std::size_t>(texels));
            const Real y = static_cast<Real>(i / static_cast<std::size_t>(texels));
            const Real dx = derivative([&](Real h) { return enlarged_height_at(x + h, y, scale); });
            const Real dy = derivative([&](Real h) { return enlarged_height_at(x, y + h, scale); });
            const glm::dvec3 expected(static_cast<double>(-dx), static_cast<double>(dy), 1.0);
            // For the shortest waves (8 texels), the term of h^6 is 1e-13 degrees.
            ASSERT_LE(degrees_between(surface.normals[i], expected), 1e-10) << texels << " " << i;
            ASSERT_FLOAT_EQ(surface.heights.as<float>()[i],
                            static_cast<float>(enlarged_height_at(x, y, scale)));
            max_slope = std::max(max_slope, degrees(std::acos(surface.normals[i].z)));
        }
        EXPECT_GT(max_slope, 20.0) << "slopes of 0.3 (RMS), as in every size";
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
