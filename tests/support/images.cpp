// SPDX-License-Identifier: Apache-2.0
#include "support/images.h"

namespace relief::test {

Image heights_of(int width, int height, const std::function<double(int, int)>& at) {
    Image image = make_image(width, height, 1, 32, ColorSpace::data);
    for (int row = 0; row < height; ++row) {
        for (int column = 0; column < width; ++column)
            image.as<float>()[static_cast<std::size_t>(row * width + column)] =
                static_cast<float>(at(column, row));
    }
    return image;
}

Image rough(int width, int height, std::uint32_t seed) {
    return heights_of(width, height, [&](int, int) {
        seed = seed * 1664525U + 1013904223U;
        return static_cast<double>(seed >> 8) / 16777216.0;
    });
}

}  // namespace relief::test
