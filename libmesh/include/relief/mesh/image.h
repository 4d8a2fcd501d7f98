// SPDX-License-Identifier: Apache-2.0
/// \file
/// Defines images in memory and conversions of their sample type and color space.
/// Tests: tests/mesh/image/image_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

namespace relief {

/// The meaning of samples.
enum class ColorSpace {
    data,    ///< Not a color: normals, heights, masks. Never converted.
    linear,  ///< Proportional to light intensity.
    srgb,    ///< Colors in IEC 61966-2-1 coding; alpha, if present, is linear.
};

/// Rows of interleaved samples; row 0 is the top row, as stored in files.
///
/// 8- and 16-bit samples stand for value / 255 and value / 65535. Half floats of files become
/// float. Colors are not premultiplied by alpha.
struct Image {
    using Samples =
        std::variant<std::vector<std::uint8_t>, std::vector<std::uint16_t>, std::vector<float>>;

    int width = 0;
    int height = 0;
    int channels = 0;  ///< 1 gray, 2 gray + alpha, 3 RGB, 4 RGB + alpha.
    ColorSpace color_space = ColorSpace::data;
    Samples samples;  ///< width * height * channels values.

    [[nodiscard]] bool empty() const { return width == 0 || height == 0; }
    [[nodiscard]] std::size_t sample_count() const {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
               static_cast<std::size_t>(channels);
    }
    /// Bits per sample: 8, 16 or 32.
    [[nodiscard]] int bits() const;

    /// The samples as values of type T. Not available for temporaries, whose samples would be
    /// destroyed.
    /// \throws std::bad_variant_access if the samples have another type
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

/// Creates an image of zeros. \throws InvalidInput if a size is not positive or bits is not 8, 16
/// or 32
Image make_image(int width, int height, int channels, int bits, ColorSpace color_space);

/// Converts samples to float: 8- and 16-bit samples are divided by their maximum. Nothing else
/// changes.
Image to_float(const Image& image);

/// Converts to linear float: sRGB colors are decoded, alpha is not; linear and data images as
/// to_float().
Image to_linear(const Image& image);

/// Encodes linear float as sRGB of 8 or 16 bits. Values are clamped to [0,1], as on a display, and
/// NaN becomes 0. \throws InvalidInput for data images and other numbers of bits
Image to_srgb(const Image& linear, int bits);

/// The sRGB transfer function and its inverse: the formulas of the standard for all values from 0,
/// also above 1, with odd symmetry for negative values. Source: [IEC 61966-2-1].
float srgb_from_linear(float linear);
float linear_from_srgb(float coded);

/// The continuation of an image beyond its border.
enum class Wrap {
    repeat,  ///< The image repeats.
    /// The surface continues as its point reflection at the border texel: a plane stays a plane,
    /// and derivatives across the border are one-sided.
    clamp,
    mirror,  ///< The image is mirrored, and its outermost texels appear twice, as in OpenGL.
};

/// The wrap modes of both axes.
struct Wraps {
    Wrap x = Wrap::repeat;
    Wrap y = Wrap::repeat;

    constexpr Wraps() = default;
    constexpr Wraps(Wrap both) : x(both), y(both) {}
    constexpr Wraps(Wrap along_x, Wrap along_y) : x(along_x), y(along_y) {}
    bool operator==(const Wraps&) const = default;
};

}  // namespace relief
