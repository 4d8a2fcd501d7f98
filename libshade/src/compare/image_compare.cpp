// SPDX-License-Identifier: Apache-2.0
// Differences between two pictures, in units of the images' own range; sums in double, in the order
// of the samples. Not-a-number against a number is an infinite difference. See image_compare.h.
// Tests: tests/shade/compare/image_compare_test.cpp.
#include "relief/shade/image_compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "relief/mesh/error.h"

namespace relief {

namespace {

/// The distance of two samples; NaN on both sides is none, and so are equal infinities.
double distance(double a, double b) {
    if (a == b || (std::isnan(a) && std::isnan(b))) return 0.0;
    if (std::isnan(a) || std::isnan(b)) return std::numeric_limits<double>::infinity();
    return std::abs(a - b);
}

template <typename T>
ImageDifference difference(const std::vector<T>& a, const std::vector<T>& b, std::size_t channels) {
    constexpr double peak = std::is_integral_v<T> ? std::numeric_limits<T>::max() : 1.0;
    ImageDifference result;
    double sum = 0.0;
    double sum_of_squares = 0.0;
    for (std::size_t pixel = 0; pixel < a.size(); pixel += channels) {
        bool differs = false;
        for (std::size_t i = pixel; i < pixel + channels; ++i) {
            const double apart = distance(a[i], b[i]);
            differs = differs || apart > 0.0;
            result.max = std::max(result.max, apart);
            sum += apart;
            sum_of_squares += apart * apart;
        }
        if (differs) ++result.differing_pixels;
    }
    if (!a.empty()) {
        result.mean = sum / static_cast<double>(a.size());
        result.rms = std::sqrt(sum_of_squares / static_cast<double>(a.size()));
        result.psnr = 20.0 * std::log10(peak / result.rms);
    }
    return result;
}

}  // namespace

ImageDifference compare(const Image& a, const Image& b) {
    if (a.width != b.width || a.height != b.height || a.channels != b.channels ||
        a.bits() != b.bits()) {
        throw InvalidInput(fmt::format(
            "images cannot be compared: {} x {} pixels, {} channels of {} bits against {} x {} "
            "pixels, {} channels of {} bits",
            a.width, a.height, a.channels, a.bits(), b.width, b.height, b.channels, b.bits()));
    }
    return std::visit(
        [&]<typename T>(const std::vector<T>& samples) {
            return difference(samples, std::get<std::vector<T>>(b.samples),
                              static_cast<std::size_t>(a.channels));
        },
        a.samples);
}

}  // namespace relief
