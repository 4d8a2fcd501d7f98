// SPDX-License-Identifier: Apache-2.0
/// \file
/// How a slope is estimated from neighbouring heights: the kernels as data, and what is known of
/// them in closed form. Tests: tests/mesh/image/bump/gradient_kernel_test.cpp.
#pragma once

#include <glm/vec2.hpp>
#include <vector>

namespace relief {

/// All have unit gain on a plane, so that choosing another one never changes the depth. On waves of
/// L texels their error falls as L^-order. Noise is the deviation of the slope for independent
/// errors of deviation 1 in the heights; anisotropy the greatest error of direction at L = 8, in
/// degrees.
enum class Kernel {
    //                                                       order noise anisotropy
    forward,   ///< The next height less this one: it is the      1  1.414    0.37
               ///< slope half a texel farther on.
    central3,  ///< Half the difference of the two neighbours.    2  0.707    1.54
    prewitt3,  ///< Central differences of three lines, 1 1 1.    2  0.408    1.56
    sobel3,    ///< The same, 1 2 1.                              2  0.433    0.75
    scharr3,   ///< The same, 3 10 3: truer directions.           2  0.480    0.16
    sobel5,    ///< Differences 2 1, lines 1 4 6 4 1.             2  0.207    0.75
    scharr5,   ///< Differences and lines fitted for direction.   2  0.283    0.003
    central5,  ///< Differences 8 -1, over 12: for smooth maps.   4  0.950    0.17
    central7,  ///< Differences 45 -9 1, over 60.                 6  1.082    0.02
    /// Slope of the plane that fits the heights around best, weighted by a Gaussian of half the
    /// radius: the derivative of a Gaussian, with unit gain. Order 2.
    gaussian,
};

/// One difference of two heights along the slope's axis.
struct HeightDifference {
    int before;  ///< Offsets in texels.
    int after;
    double weight;  ///< Of height[after] - height[before].
};

/// The slope along one axis is the sum of `differences` along it, each smoothed across it, over
/// `divisor`.
struct GradientKernel {
    std::vector<HeightDifference> differences;
    /// The weight of the line itself, then of both lines 1, 2, ... texels beside it.
    std::vector<double> smoothing;
    double divisor = 1.0;
    int order = 1;
    int radius = 1;  ///< No height farther away than this counts.
};

inline constexpr int largest_kernel_radius = 64;

/// \param gaussian_radius  for Kernel::gaussian, 1 to 64; other kernels have their own
/// \throws InvalidInput if the radius is out of range
///
/// Weights of the 3x3 kernels, of Sobel's 5x5 and of the central differences are whole numbers, so
/// that slopes of whole numbers are exact. Source: [Sobel and Feldman 1968], [Scharr 2000] (whose 5
/// taps have 4 digits), [Fornberg 1988] for the central differences of higher order.
GradientKernel gradient_kernel(Kernel kernel, int gaussian_radius = 2);

/// Standard deviation of a slope where heights have independent errors of deviation 1:
/// sqrt(sum of squares of all weights), in slope per height.
double noise_gain(const GradientKernel& kernel);

/// The slope along x that the kernel finds in a plane wave, divided by the true slope: 1 is exact.
/// The true slope is taken at the center of the kernel: at the texel, or half a texel farther along
/// x for Kernel::forward.
///
/// \param frequency  radians per texel in x and y; x within (-pi, pi), 0 gives the limit
double slope_response(const GradientKernel& kernel, glm::dvec2 frequency);

/// The greatest angle, over all directions of the wave, between the gradient that the kernel finds
/// in a plane wave and the true one. Radians. Each of the two slopes is compared at the center of
/// its own kernel, see slope_response(). At the texel itself the gradient of Kernel::forward can be
/// off by any angle, because its two slopes belong to two different places.
///
/// \param wavelength  texels, above 2
double anisotropy(const GradientKernel& kernel, double wavelength);

}  // namespace relief
