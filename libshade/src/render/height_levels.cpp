// SPDX-License-Identifier: Apache-2.0
// The levels of a relief's heights: level 0 is the map, level n the maxima of 2^n x 2^n patches. A
// level has the size of the map divided by 2^n, rounded down, as OpenGL requires; its last row and
// column cover the patches that remain. A patch lies between four texels. That of the last column
// counts the first one, too, so that the maxima hold for every way in which the map continues.
// Tests: tests/shade/render/depth_mapping_test.cpp.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <variant>
#include <vector>

#include "relief/mesh/height_march.h"
#include "render/textures.h"

namespace relief::shade::detail {

namespace {

/// Returns the first channel with the same number of bits.
Image red_channel(const Image& image) {
    Image red = make_image(image.width, image.height, 1, image.bits(), ColorSpace::data);
    const auto channels = static_cast<std::size_t>(image.channels);
    std::visit(
        [&]<typename Sample>(const std::vector<Sample>& samples) {
            auto& values = std::get<std::vector<Sample>>(red.samples);
            for (std::size_t i = 0; i < values.size(); ++i)
                values[i] = samples[i * channels];
        },
        image.samples);
    return red;
}

/// Returns the red channel; holes of float images are filled, and their heights clamped to [0,1].
Image heights_of(const Image& image, const Wraps& wrap) {
    Image heights = red_channel(image);
    if (auto* const floats = std::get_if<std::vector<float>>(&heights.samples)) {
        const HeightField field(heights, wrap);
        const glm::dvec2 size(image.width, image.height);
        for (std::size_t i = 0; i < floats->size(); ++i) {
            const auto width = static_cast<std::size_t>(image.width);
            const std::size_t x = i % width;
            const std::size_t y = i / width;
            const glm::dvec2 texel(x, y);
            (*floats)[i] = static_cast<float>(field.height((texel + 0.5) / size));
        }
    }
    return heights;
}

/// Returns a level of which each texel is the maximum of those of a larger one from twice its place
/// on: two along each axis, or as many as there are in the last column and row.
template <typename Sample>
std::vector<Sample> halved(const std::vector<Sample>& larger, int width, int height, int new_width,
                           int new_height) {
    std::vector<Sample> maxima;
    maxima.reserve(static_cast<std::size_t>(new_width) * static_cast<std::size_t>(new_height));
    for (int y = 0; y < new_height; ++y) {
        const int last_row = y + 1 == new_height ? height : 2 * y + 2;
        for (int x = 0; x < new_width; ++x) {
            const int last_column = x + 1 == new_width ? width : 2 * x + 2;
            Sample highest{};
            for (int row = 2 * y; row < last_row; ++row) {
                for (int column = 2 * x; column < last_column; ++column)
                    highest = std::max(
                        highest,
                        larger[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                               static_cast<std::size_t>(column)]);
            }
            maxima.push_back(highest);
        }
    }
    return maxima;
}

/// Returns the maxima of the four texels around each patch.
template <typename Sample>
std::vector<Sample> patch_maxima(const std::vector<Sample>& heights, int width, int height) {
    std::vector<Sample> maxima;
    maxima.reserve(heights.size());
    const auto at = [&](int x, int y) {
        return heights[static_cast<std::size_t>(y == height ? 0 : y) *
                           static_cast<std::size_t>(width) +
                       static_cast<std::size_t>(x == width ? 0 : x)];
    };
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x)
            maxima.push_back(std::max({at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)}));
    }
    return maxima;
}

}  // namespace

std::vector<Image> height_levels(const Image& image, Wrap wrap_u, Wrap wrap_v) {
    Image map = heights_of(image, {wrap_u, wrap_v});
    std::vector<Image> levels(1);
    std::visit(
        [&]<typename Sample>(const std::vector<Sample>& heights) {
            int width = image.width;
            int height = image.height;
            std::vector<Sample> maxima = patch_maxima(heights, width, height);
            while (width > 1 || height > 1) {
                const int new_width = std::max(width / 2, 1);
                const int new_height = std::max(height / 2, 1);
                maxima = halved(maxima, width, height, new_width, new_height);
                width = new_width;
                height = new_height;
                Image level = make_image(width, height, 1, image.bits(), ColorSpace::data);
                level.samples = maxima;
                levels.push_back(std::move(level));
            }
        },
        map.samples);
    levels.front() = std::move(map);
    return levels;
}

}  // namespace relief::shade::detail
