// SPDX-License-Identifier: Apache-2.0
// Rows of a rectangle, copied. Tests: tests/mesh/image/image_part_test.cpp.
#include "relief/mesh/image_part.h"

#include <fmt/format.h>

#include <algorithm>

#include "relief/mesh/error.h"

namespace relief {

Image part_of(const Image& image, const ImagePart& part) {
    const bool is_within = part.x >= 0 && part.y >= 0 && part.width > 0 && part.height > 0 &&
                           part.width <= image.width - part.x &&
                           part.height <= image.height - part.y;
    if (!is_within) {
        throw InvalidInput(fmt::format("{} x {} texels at ({}, {}) are no part of {} x {}",
                                       part.width, part.height, part.x, part.y, image.width,
                                       image.height));
    }
    Image result =
        make_image(part.width, part.height, image.channels, image.bits(), image.color_space);
    std::visit(
        [&]<typename Sample>(std::vector<Sample>& samples) {
            const std::span<const Sample> all = image.as<Sample>();
            const auto channels = static_cast<std::size_t>(image.channels);
            const std::size_t row = static_cast<std::size_t>(part.width) * channels;
            for (int y = 0; y < part.height; ++y) {
                const std::size_t texel =
                    static_cast<std::size_t>(part.y + y) * static_cast<std::size_t>(image.width) +
                    static_cast<std::size_t>(part.x);
                std::copy_n(all.begin() + static_cast<std::ptrdiff_t>(texel * channels), row,
                            samples.begin() +
                                static_cast<std::ptrdiff_t>(static_cast<std::size_t>(y) * row));
            }
        },
        result.samples);
    return result;
}

}  // namespace relief
