// SPDX-License-Identifier: Apache-2.0
// Pictures compared as codes. FLIP: [Andersson et al. 2020], by image_compare.h.
// Tests: tests/accuracy/picture_error_test.cpp.
#include "drawn/picture_error.h"

#include "relief/mesh/error.h"
#include "relief/shade/image_compare.h"

namespace relief {
namespace {

/// The root of the mean square, the mean and so on of what is no angle, but as many numbers.
ErrorFigures figures_of_map(const Image& map) {
    const std::span<const float> errors = map.as<float>();
    return figures_of(angle_distribution({errors.begin(), errors.end()}));
}

}  // namespace

PictureError picture_error(const Image& truth, const Image& picture) {
    const Image shown = to_srgb(truth, 8);
    FlipDifference flip = flip_difference(shown, picture);
    PictureError error{figures_of_map(flip.map), std::move(flip.map)};
    error.figures.psnr = compare(shown, picture).psnr;
    return error;
}

Image averaged(const Image& linear, int side) {
    if (side < 1 || linear.width % side != 0 || linear.height % side != 0)
        throw InvalidInput("a picture can be averaged only by squares that fit into it");
    Image mean = make_image(linear.width / side, linear.height / side, linear.channels, 32,
                            linear.color_space);
    const std::span<const float> from = linear.as<float>();
    const std::span<float> to = mean.as<float>();
    const auto channels = static_cast<std::size_t>(linear.channels);
    const auto index = [channels](int width, int x, int y) {
        return channels * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                           static_cast<std::size_t>(x));
    };
    for (int y = 0; y < mean.height; ++y) {
        for (int x = 0; x < mean.width; ++x) {
            for (std::size_t channel = 0; channel < channels; ++channel) {
                double sum = 0.0;
                for (int i = 0; i < side * side; ++i) {
                    sum += static_cast<double>(
                        from[index(linear.width, x * side + i % side, y * side + i / side) +
                             channel]);
                }
                to[index(mean.width, x, y) + channel] = static_cast<float>(sum / (side * side));
            }
        }
    }
    return mean;
}

Image without_alpha(const Image& image) {
    Image result{image.width, image.height, 3, image.color_space, {}};
    std::visit(
        [&](const auto& samples) {
            std::decay_t<decltype(samples)> kept;
            kept.reserve(result.sample_count());
            const auto channels = static_cast<std::size_t>(image.channels);
            for (std::size_t i = 0; i < samples.size(); i += channels)
                kept.insert(kept.end(), samples.begin() + static_cast<std::ptrdiff_t>(i),
                            samples.begin() + static_cast<std::ptrdiff_t>(i + 3));
            result.samples = std::move(kept);
        },
        image.samples);
    return result;
}

}  // namespace relief
