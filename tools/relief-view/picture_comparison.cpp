// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/compare_options_test.cpp, tests/tools/picture_reference_test.cpp.
#include "picture_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "relief/mesh/error.h"

namespace relief::tools {
namespace {

/// The same picture with an alpha channel that is full everywhere.
Image with_alpha(const Image& image) {
    Image covered = make_image(image.width, image.height, 4, image.bits(), image.color_space);
    std::visit(
        [&](const auto& samples) {
            using Samples = std::decay_t<decltype(samples)>;
            using Sample = typename Samples::value_type;
            auto& to = std::get<Samples>(covered.samples);
            const auto full = std::is_integral_v<Sample> ? std::numeric_limits<Sample>::max()
                                                         : static_cast<Sample>(1);
            for (std::size_t i = 0; i < to.size(); ++i)
                to[i] = i % 4 == 3 ? full : samples[i / 4 * 3 + i % 4];
        },
        image.samples);
    return covered;
}

double peak_of(const Image& image) {
    return image.bits() == 8 ? 255.0 : (image.bits() == 16 ? 65535.0 : 1.0);
}

/// Where the right side begins, in columns.
int first_right_column(const Image& image, float split) {
    return static_cast<int>(std::lround(split * static_cast<float>(image.width)));
}

}  // namespace

PictureComparison compare_pictures(const Image& reference, const Image& picture) {
    PictureComparison result;
    result.peak = peak_of(reference);
    const bool one_has_alpha = picture.channels + reference.channels == 7;
    result.difference =
        compare(one_has_alpha && reference.channels == 3 ? with_alpha(reference) : reference,
                one_has_alpha && picture.channels == 3 ? with_alpha(picture) : picture);
    result.flip = flip_difference(reference, picture);
    return result;
}

std::string with_peak(double value, double peak) {
    return peak == 1.0 ? fmt::format("{:.4g}", value) : fmt::format("{:.4g} of {}", value, peak);
}

std::string in_words(const PictureComparison& comparison) {
    const ImageDifference& difference = comparison.difference;
    if (difference.differing_pixels == 0) return "no difference";
    return fmt::format("largest {}, mean {:.3g}, PSNR {:.1f} dB, FLIP {:.3g} (largest {:.3g}), {}",
                       with_peak(difference.max, comparison.peak), difference.mean, difference.psnr,
                       comparison.flip.mean, comparison.flip.max,
                       difference.differing_pixels == 1
                           ? "1 pixel differs"
                           : fmt::format("{} pixels differ", difference.differing_pixels));
}

nlohmann::ordered_json numbers_json(const PictureComparison& comparison) {
    const ImageDifference& difference = comparison.difference;
    return {{"max", difference.max},
            {"mean", difference.mean},
            {"rms", difference.rms},
            {"psnr", difference.psnr},
            {"differing_pixels", difference.differing_pixels},
            {"flip_mean", comparison.flip.mean},
            {"flip_max", comparison.flip.max}};
}

Image largest_differences(const Image& a, const Image& b) {
    (void)compare(a, b);  // Refuses what is not alike.
    Image result = make_image(a.width, a.height, 1, 32, ColorSpace::data);
    auto& largest = std::get<std::vector<float>>(result.samples);
    const auto channels = static_cast<std::size_t>(a.channels);
    const double peak = peak_of(a);
    std::visit(
        [&](const auto& from) {
            const auto& other = std::get<std::decay_t<decltype(from)>>(b.samples);
            for (std::size_t i = 0; i < from.size(); ++i) {
                const double apart =
                    std::abs(static_cast<double>(from[i]) - static_cast<double>(other[i])) / peak;
                float& pixel = largest[i / channels];
                pixel = std::max(pixel, static_cast<float>(apart));
            }
        },
        a.samples);
    return result;
}

Image split_picture(const Image& left, const Image& right, float split) {
    Image result = left;
    const int first = first_right_column(left, split);
    std::visit(
        [&](auto& to) {
            const auto& from = std::get<std::decay_t<decltype(to)>>(right.samples);
            const auto row = static_cast<std::ptrdiff_t>(left.width) * left.channels;
            const auto begin = static_cast<std::ptrdiff_t>(first) * left.channels;
            for (std::ptrdiff_t y = 0; y < left.height; ++y) {
                std::copy(from.begin() + y * row + begin, from.begin() + (y + 1) * row,
                          to.begin() + y * row + begin);
            }
        },
        result.samples);
    return result;
}

}  // namespace relief::tools
