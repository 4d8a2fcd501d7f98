// SPDX-License-Identifier: Apache-2.0
// The order of each kernel: how the error of its normals falls as waves get longer, by a line
// fitted to both logarithms; inside, and at a clamped border.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "relief/mesh/analytic_heights.h"
#include "relief/mesh/bump.h"

namespace relief {
namespace {

constexpr int coarse_side = 96;
constexpr int border_margin = 8;  ///< As far as no kernel here reaches.

struct WaveError {
    double inside = 0.0;
    double border = 0.0;  ///< Of the outermost texels alone.
};

/// An oblique wave of slope 1, clamped, so that both its axes have something to err about.
WaveError error_on(Kernel kernel, double wavelength) {
    const double steepness = 2.0 * std::numbers::pi / wavelength;
    const HeightWave wave{1.0 / steepness, steepness * glm::dvec2(std::cos(0.6), std::sin(0.6)),
                          0.7};
    const AnalyticHeights field = wave_heights(coarse_side, coarse_side, std::span(&wave, 1));
    BumpOptions options;
    options.kernel = kernel;
    options.wrap = Wrap::clamp;
    options.strength = 1.0;
    options.arithmetic = Arithmetic::float64;
    Report report;
    const Image normals = normals_from_height(field.heights, options, report);
    const DirectionError all = normal_error(normals, field, 0);
    const DirectionError but_border = normal_error(normals, field, 1);
    const auto squares = [](const DirectionError& error) {
        return error.rms * error.rms * static_cast<double>(error.count);
    };
    const auto of_border = static_cast<double>(all.count - but_border.count);
    return {normal_error(normals, field, border_margin).rms,
            std::sqrt((squares(all) - squares(but_border)) / of_border)};
}

/// The negative slope of the line that fits log error against log wavelength best.
double fitted_order(const std::vector<double>& wavelengths, const std::vector<double>& errors) {
    double x = 0.0;
    double y = 0.0;
    for (std::size_t i = 0; i < errors.size(); ++i) {
        x += std::log(wavelengths[i]) / static_cast<double>(errors.size());
        y += std::log(errors[i]) / static_cast<double>(errors.size());
    }
    double products = 0.0;
    double squares = 0.0;
    for (std::size_t i = 0; i < errors.size(); ++i) {
        products += (std::log(wavelengths[i]) - x) * (std::log(errors[i]) - y);
        squares += (std::log(wavelengths[i]) - x) * (std::log(wavelengths[i]) - x);
    }
    return -products / squares;
}

TEST(BumpConvergence, EveryKernelHasItsOrderInsideAndFirstOrderAtAClampedBorder) {
    for (const Kernel kernel :
         {Kernel::forward, Kernel::central3, Kernel::prewitt3, Kernel::sobel3, Kernel::scharr3,
          Kernel::sobel5, Kernel::scharr5, Kernel::central5, Kernel::central7, Kernel::gaussian}) {
        const int order = gradient_kernel(kernel).order;
        // Short of where the rounding of heights to float shows: errors of order 6 fall fast.
        const std::vector<double> wavelengths =
            order == 6   ? std::vector{9.0, 11.0, 13.0, 16.0, 19.0}
            : order == 4 ? std::vector{11.0, 14.0, 18.0, 23.0, 29.0}
                         : std::vector{20.0, 25.0, 31.0, 39.0, 48.0};
        std::vector<double> inside;
        std::vector<double> border;
        for (const double wavelength : wavelengths) {
            const WaveError error = error_on(kernel, wavelength);
            inside.push_back(error.inside);
            border.push_back(error.border);
        }
        EXPECT_NEAR(fitted_order(wavelengths, inside), order, 0.15 * order)
            << static_cast<int>(kernel);
        // What lies beyond is a reflection, whose curvature is not that of the wave.
        EXPECT_NEAR(fitted_order(wavelengths, border), 1.0, 0.35) << static_cast<int>(kernel);
    }
}

}  // namespace
}  // namespace relief
