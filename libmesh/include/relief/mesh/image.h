// SPDX-License-Identifier: Apache-2.0
/// \file
/// Pictures and data maps in memory. Tests: tests/mesh/image/image_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

namespace relief {

/// What the numbers of an image mean.
enum class ColorSpace {
    data,    ///< Not a colour: normals, heights, masks. Never converted.
    linear,  ///< Proportional to light.
    srgb,    ///< IEC 61966-2-1 coded colour; alpha, where there is one, is linear.
};

/// Rows of interleaved samples; row 0 is the top row, as stored in files.
///
/// 8- and 16-bit samples stand for value / 255 and value / 65535. Half-float files are held as
/// float. Alpha is never multiplied into the colours.
struct Image {
    using Samples =
        std::variant<std::vector<std::uint8_t>, std::vector<std::uint16_t>, std::vector<float>>;

    int width = 0;
    int height = 0;
    int channels = 0;  ///< 1 grey, 2 grey + alpha, 3 RGB, 4 RGB + alpha.
    ColorSpace color_space = ColorSpace::data;
    Samples samples;  ///< width * height * channels of them.

    [[nodiscard]] bool empty() const { return width == 0 || height == 0; }
    [[nodiscard]] std::size_t sample_count() const {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
               static_cast<std::size_t>(channels);
    }
    /// 8, 16 or 32.
    [[nodiscard]] int bits() const;

    /// The samples, if they are of this type; not of a temporary, whose samples would be gone.
    /// \throws std::bad_variant_access otherwise
    template <typename T>
    [[nodiscard]] std::span<const T> as() const& {
        return std::get<std::vector<T>>(samples);
    }
    template <typename T>
    [[nodiscard]] std::span<T> as() & {
        return std::get<std::vector<T>>(samples);
    }
    template <typename T>
    std::span<const T> as() const&& = delete;
};

/// An image of zeros. \throws InvalidInput if a size is not positive or bits is not 8, 16 or 32
Image make_image(int width, int height, int channels, int bits, ColorSpace color_space);

/// The same image in float: 8- and 16-bit samples divided by their maximum, nothing else changed.
Image to_float(const Image& image);

/// Linear-light float: sRGB colours decoded (alpha untouched); linear and data images as to_float.
Image to_linear(const Image& image);

/// Linear float to sRGB-coded samples of 8 or 16 bits; values are clamped to [0,1], which is what a
/// display does with them, and NaN becomes 0. \throws InvalidInput for data images and other depths
Image to_srgb(const Image& linear, int bits);

/// The sRGB transfer function and its inverse: the formulas of the standard on [0,1] and on above
/// 1, continued oddly below 0. Source: [IEC 61966-2-1].
float srgb_from_linear(float linear);
float linear_from_srgb(float coded);

}  // namespace relief
