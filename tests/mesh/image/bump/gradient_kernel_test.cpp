// SPDX-License-Identifier: Apache-2.0
// Kernels as data: unit gain, and the closed forms against the table in the header and against
// sums over an impulse response.
#include "relief/mesh/gradient_kernel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>
#include <numbers>

#include "relief/mesh/error.h"

namespace relief {
namespace {

using std::numbers::pi;

struct Known {
    Kernel kernel;
    int order;
    int radius;
    double noise;       ///< By hand, from the weights.
    double anisotropy;  ///< Degrees at a wavelength of 8 texels.
};

const Known table[] = {
    {Kernel::forward, 1, 1, std::sqrt(2.0), 0.37},
    {Kernel::central3, 2, 1, std::sqrt(0.5), 1.54},
    {Kernel::prewitt3, 2, 1, std::sqrt(6.0) / 6.0, 1.56},
    {Kernel::sobel3, 2, 1, std::sqrt(12.0) / 8.0, 0.75},
    {Kernel::scharr3, 2, 1, std::sqrt(236.0) / 32.0, 0.16},
    {Kernel::sobel5, 2, 2, std::sqrt(10.0 * 70.0) / 128.0, 0.75},
    {Kernel::scharr5, 2, 2, 0.2825, 0.003},
    {Kernel::central5, 4, 2, std::sqrt(130.0) / 12.0, 0.17},
    {Kernel::central7, 6, 3, std::sqrt(2.0 * (2025.0 + 81.0 + 1.0)) / 60.0, 0.02},
};

TEST(GradientKernel, EachHasTheOrderNoiseAndAnisotropyOfTheTable) {
    for (const Known& known : table) {
        const GradientKernel kernel = gradient_kernel(known.kernel);
        EXPECT_EQ(kernel.order, known.order);
        EXPECT_EQ(kernel.radius, known.radius);
        EXPECT_NEAR(noise_gain(kernel), known.noise, 5e-5);
        // To half of the last digit that the header shows.
        const double half_digit = known.kernel == Kernel::scharr5 ? 0.0005 : 0.005;
        EXPECT_NEAR(anisotropy(kernel, 8.0) * 180.0 / pi, known.anisotropy, half_digit);
    }
}

TEST(GradientKernel, EveryKernelHasUnitGainOnAPlane) {
    for (int kernel = 0; kernel <= static_cast<int>(Kernel::gaussian); ++kernel) {
        for (const int radius : {1, 2, 5, 64}) {
            const GradientKernel found = gradient_kernel(static_cast<Kernel>(kernel), radius);
            EXPECT_NEAR(slope_response(found, {0.0, 0.0}), 1.0, 1e-14);
        }
    }
}

TEST(GradientKernel, ResponseToAWaveHasTheKnownForms) {
    const double w = 2.0 * pi / 8.0;
    EXPECT_NEAR(slope_response(gradient_kernel(Kernel::central3), {w, 0.3}), std::sin(w) / w,
                1e-15);
    EXPECT_NEAR(slope_response(gradient_kernel(Kernel::sobel3), {w, w}),
                std::sin(w) / w * std::pow(std::cos(w / 2.0), 2.0), 1e-15);
    EXPECT_NEAR(slope_response(gradient_kernel(Kernel::central5), {w, 0.0}),
                (8.0 * std::sin(w) - std::sin(2.0 * w)) / (6.0 * w), 1e-15);
    // Half a texel farther on, forward is a central difference of half the width.
    EXPECT_NEAR(slope_response(gradient_kernel(Kernel::forward), {w, 0.0}),
                std::sin(w / 2.0) / (w / 2.0), 1e-15);
}

/// The gradients that forward differences find in plane waves of 8 texels in many directions and
/// phases: the largest angles to the true gradient, in degrees.
struct ForwardErrors {
    double half_texel_on = 0.0;  ///< Each difference reaches from half a texel before the place on.
    double at_texel = 0.0;       ///< Each difference reaches from the place on.
};

ForwardErrors measured_forward_errors() {
    ForwardErrors largest;
    for (int i = 0; i <= 720; ++i) {
        const double direction = pi / 2.0 * i / 720.0;
        const glm::dvec2 w = 2.0 * pi / 8.0 * glm::dvec2(std::cos(direction), std::sin(direction));
        for (int k = 0; k < 97; ++k) {
            const double phase = 2.0 * pi * k / 97.0;
            const auto error_from = [&](double start) {
                const auto height = [&](double x, double y) {
                    return std::sin(w.x * x + w.y * y + phase);
                };
                const glm::dvec2 found(height(start + 1.0, 0.0) - height(start, 0.0),
                                       height(0.0, start + 1.0) - height(0.0, start));
                const glm::dvec2 ground_truth = std::cos(phase) * w;
                return std::abs(std::atan2(found.x * ground_truth.y - found.y * ground_truth.x,
                                           found.x * ground_truth.x + found.y * ground_truth.y)) *
                       180.0 / pi;
            };
            largest.half_texel_on = std::max(largest.half_texel_on, error_from(-0.5));
            largest.at_texel = std::max(largest.at_texel, error_from(0.0));
        }
    }
    return largest;
}

TEST(GradientKernel, TheDirectionErrorOfForwardIsCountedHalfATexelFartherOn) {
    const GradientKernel forward = gradient_kernel(Kernel::forward);
    const ForwardErrors measured = measured_forward_errors();
    EXPECT_NEAR(measured.half_texel_on, anisotropy(forward, 8.0) * 180.0 / pi, 1e-9);
    EXPECT_NEAR(anisotropy(forward, 8.0) * 180.0 / pi, 0.3725, 5e-5);
    EXPECT_NEAR(anisotropy(forward, 16.0) * 180.0 / pi, 0.0923, 5e-5);
    EXPECT_GT(measured.at_texel, 90.0);
}

TEST(GradientKernel, TheErrorOfTheResponseFallsWithTheOrder) {
    for (const Known& known : table) {
        if (known.kernel == Kernel::forward) continue;  // Its first-order error is its place.
        const GradientKernel kernel = gradient_kernel(known.kernel);
        const auto error = [&](double length) {
            return 1.0 - slope_response(kernel, {2.0 * pi / length, 0.0});
        };
        EXPECT_NEAR(std::log2(error(32.0) / error(64.0)), known.order, 0.05);
    }
}

TEST(GradientKernel, TheGaussianOneIsTheLeastSquaresPlane) {
    // Radius 1: weights exp(-2) beside the middle. Slope of h(1) = 1: g / (2 g).
    const GradientKernel one = gradient_kernel(Kernel::gaussian, 1);
    const double g = std::exp(-2.0);
    EXPECT_DOUBLE_EQ(one.differences[0].weight, g);
    EXPECT_DOUBLE_EQ(one.divisor, 2.0 * g * (1.0 + 2.0 * g));
    // The residual of the weighted fit is orthogonal to x: the kernel sees nothing of a parabola
    // in x, and of x^3 its weighted mean ratio sum g x^4 / sum g x^2.
    const GradientKernel four = gradient_kernel(Kernel::gaussian, 4);
    double cubes = 0.0;
    double x4 = 0.0;
    double x2 = 0.0;
    for (int x = -4; x <= 4; ++x) {
        const double weight = std::exp(-x * x / 8.0);
        x4 += weight * std::pow(x, 4);
        x2 += weight * x * x;
    }
    double sum = 1.0;
    for (std::size_t i = 1; i < four.smoothing.size(); ++i)
        sum += 2.0 * four.smoothing[i];
    for (const auto& [before, after, weight] : four.differences)
        cubes += weight * (std::pow(after, 3) - std::pow(before, 3));
    EXPECT_NEAR(cubes * sum / four.divisor, x4 / x2, 1e-12);
    EXPECT_THROW(gradient_kernel(Kernel::gaussian, 0), InvalidInput);
    EXPECT_THROW(gradient_kernel(Kernel::gaussian, 65), InvalidInput);
    EXPECT_NO_THROW(gradient_kernel(Kernel::sobel3, 0));
}

}  // namespace
}  // namespace relief
