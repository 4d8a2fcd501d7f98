// SPDX-License-Identifier: Apache-2.0
// Weights of gradient kernels, and their properties in closed form. Offsets are in texels,
// frequencies in radians per texel.
#include "relief/mesh/bump.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "portable_math.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

/// Returns a kernel of antisymmetric differences and symmetric smoothing weights, both from the
/// center outwards.
GradientKernel symmetric(int order, const std::vector<double>& differences,
                         std::vector<double> smoothing) {
    GradientKernel kernel;
    kernel.order = order;
    double gain = 0.0;
    for (std::size_t i = 0; i < differences.size(); ++i) {
        const int offset = static_cast<int>(i) + 1;
        kernel.differences.push_back({-offset, offset, differences[i]});
        gain += 2.0 * offset * differences[i];
    }
    double sum = smoothing[0];
    for (std::size_t i = 1; i < smoothing.size(); ++i)
        sum += 2.0 * smoothing[i];
    kernel.divisor = gain * sum;
    kernel.radius = static_cast<int>(std::max(differences.size(), smoothing.size() - 1));
    kernel.smoothing = std::move(smoothing);
    return kernel;
}

/// Returns the kernel of the least-squares slope with Gaussian weights g of standard deviation
/// radius / 2: the b that minimizes sum g(x) g(y) (h - a - b x - c y)^2 is sum g(x) g(y) x h / sum
/// g(x) g(y) x^2, which is separable.
GradientKernel gaussian(int radius) {
    if (radius < 1 || radius > max_kernel_radius) {
        throw InvalidInput(fmt::format("the kernel's radius is {}, but must be within [1, {}]",
                                       radius, max_kernel_radius));
    }
    const double deviation = radius / 2.0;
    std::vector<double> differences;
    std::vector<double> smoothing{1.0};
    for (int x = 1; x <= radius; ++x) {
        const double g = portable::exp(-0.5 * x * x / (deviation * deviation));
        differences.push_back(x * g);
        smoothing.push_back(g);
    }
    return symmetric(2, differences, std::move(smoothing));
}

}  // namespace

GradientKernel gradient_kernel(Kernel kernel, int gaussian_radius) {
    switch (kernel) {
        case Kernel::forward:
            return {{{0, 1, 1.0}}, {1.0}, 1.0, 1, 1};
        case Kernel::central3:
            return symmetric(2, {1.0}, {1.0});
        case Kernel::prewitt3:
            return symmetric(2, {1.0}, {1.0, 1.0});
        case Kernel::sobel3:
            return symmetric(2, {1.0}, {2.0, 1.0});
        case Kernel::scharr3:
            return symmetric(2, {1.0}, {10.0, 3.0});
        case Kernel::sobel5:
            return symmetric(2, {2.0, 1.0}, {6.0, 4.0, 1.0});
        case Kernel::scharr5:
            return symmetric(2, {3327.0, 836.0}, {4704.0, 2415.0, 233.0});
        case Kernel::central5:
            return symmetric(4, {8.0, -1.0}, {1.0});
        case Kernel::central7:
            return symmetric(6, {45.0, -9.0, 1.0}, {1.0});
        case Kernel::gaussian:
            break;
    }
    return gaussian(gaussian_radius);
}

double noise_gain(const GradientKernel& kernel) {
    // Weights at the same offset are added before they are squared.
    std::vector<double> along(static_cast<std::size_t>(2 * kernel.radius + 1), 0.0);
    const auto at = [&](int offset) -> double& {
        return along[static_cast<std::size_t>(kernel.radius + offset)];
    };
    for (const HeightDifference& difference : kernel.differences) {
        at(difference.after) += difference.weight;
        at(difference.before) -= difference.weight;
    }
    double squares_along = 0.0;
    for (const double weight : along)
        squares_along += weight * weight;
    double squares_across = kernel.smoothing[0] * kernel.smoothing[0];
    for (std::size_t i = 1; i < kernel.smoothing.size(); ++i)
        squares_across += 2.0 * kernel.smoothing[i] * kernel.smoothing[i];
    return std::sqrt(squares_along * squares_across) / kernel.divisor;
}

double slope_response(const GradientKernel& kernel, glm::dvec2 frequency) {
    // The difference of the wave exp(i w x) over its slope i w exp(i w x) at the center of the
    // kernel. All differences have the same center, so the ratio is real.
    const HeightDifference& first = kernel.differences.front();
    const double center = 0.5 * (first.before + first.after);
    double along = 0.0;
    for (const auto& [before, after, weight] : kernel.differences) {
        const auto part = [&](int offset) {
            const double from_center = offset - center;
            return frequency.x == 0.0 ? from_center
                                      : portable::sin(frequency.x * from_center) / frequency.x;
        };
        along += weight * (part(after) - part(before));
    }
    double across = kernel.smoothing[0];
    for (std::size_t i = 1; i < kernel.smoothing.size(); ++i)
        across += 2.0 * kernel.smoothing[i] * portable::cos(frequency.y * static_cast<double>(i));
    return along * across / kernel.divisor;
}

double anisotropy(const GradientKernel& kernel, double wavelength) {
    constexpr int directions = 720;
    const double length = 2.0 * std::numbers::pi / wavelength;
    double greatest = 0.0;
    for (int i = 0; i <= directions; ++i) {
        // By symmetry, the first quadrant is sufficient.
        const double angle = std::numbers::pi / 2.0 * i / directions;
        const glm::dvec2 wave(length * portable::cos(angle), length * portable::sin(angle));
        const double x = wave.x * slope_response(kernel, wave);
        const double y = wave.y * slope_response(kernel, {wave.y, wave.x});
        greatest = std::max(
            greatest, std::abs(portable::atan2(x * wave.y - y * wave.x, x * wave.x + y * wave.y)));
    }
    return greatest;
}

}  // namespace relief
