// SPDX-License-Identifier: Apache-2.0
/// \file
/// Images in memory: samples, color spaces, channels, rectangles, mip levels, dithering and false
/// colors.
/// Tests: tests/mesh/image/image_test.cpp, tests/mesh/image/normal_map_test.cpp.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/enum_names.h"

namespace RELIEF_API relief {

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

/// An image in the caller's memory: 8 or 16-bit integers or floats, row 0 at the top. Functions
/// read and write it in place, without a copy. Images convert implicitly.
///
///     const ImageView heights(frame.pixels, frame.width, frame.height, 1, frame.bytes_per_row);
template <bool is_const>
class BasicImageView {
    using Byte = std::conditional_t<is_const, const std::byte, std::byte>;
    using ImageType = std::conditional_t<is_const, const Image, Image>;
    template <typename Sample>
    using Access = std::conditional_t<is_const, const Sample, Sample>;

  public:
    int width = 0;
    int height = 0;
    int channels = 0;  ///< As in Image.

    BasicImageView() = default;

    /// \param first  the first sample of row 0: std::uint8_t, std::uint16_t or float
    /// \param row_stride  distance between rows in bytes, a multiple of the size of a sample.
    ///         Negative if the bottom row is the first one in memory; 0 if rows are contiguous
    template <typename Sample>
    requires(is_const || !std::is_const_v<Sample>)
        BasicImageView(Sample* first, int columns, int rows, int samples_per_texel = 1,
                       std::ptrdiff_t row_stride = 0)
        : width(columns),
          height(rows),
          channels(samples_per_texel),
          first_(reinterpret_cast<Byte*>(first)),
          row_stride_(row_stride != 0 ? row_stride
                                      : static_cast<std::ptrdiff_t>(sizeof(Sample)) * columns *
                                            samples_per_texel),
          bits_(static_cast<int>(8 * sizeof(Sample))) {
        using Value = std::remove_const_t<Sample>;
        static_assert(std::is_same_v<Value, std::uint8_t> || std::is_same_v<Value, std::uint16_t> ||
                      std::is_same_v<Value, float>);
        assert(row_stride % static_cast<std::ptrdiff_t>(sizeof(Sample)) == 0);
    }

    BasicImageView(ImageType& image)  // NOLINT: implicit, so that an Image can be passed.
        : BasicImageView(std::visit(
              [&image](auto& samples) {
                  return BasicImageView(samples.data(), image.width, image.height, image.channels);
              },
              image.samples)) {}

    [[nodiscard]] bool empty() const { return width == 0 || height == 0; }
    /// Bits per sample: 8, 16 or 32.
    [[nodiscard]] int bits() const { return bits_; }

    /// The samples of a row. \param y  0 to height - 1
    template <typename Sample>
    [[nodiscard]] Access<Sample>* row(int y) const {
        assert(y >= 0 && y < height && bits_ == static_cast<int>(8 * sizeof(Sample)));
        return reinterpret_cast<Access<Sample>*>(first_ + y * row_stride_);
    }
    /// The samples of a texel. \param index  row * width + column
    template <typename Sample>
    [[nodiscard]] Access<Sample>* texel(std::size_t index) const {
        const auto columns = static_cast<std::size_t>(width);
        return row<Sample>(static_cast<int>(index / columns)) +
               (index % columns) * static_cast<std::size_t>(channels);
    }
    /// The samples of all texels if rows are contiguous, else null.
    template <typename Sample>
    [[nodiscard]] Access<Sample>* contiguous() const {
        const bool is_contiguous =
            row_stride_ == static_cast<std::ptrdiff_t>(sizeof(Sample)) * width * channels;
        return is_contiguous ? row<Sample>(0) : nullptr;
    }

  private:
    Byte* first_ = nullptr;
    std::ptrdiff_t row_stride_ = 0;
    int bits_ = 8;
};
using ImageView = BasicImageView<true>;
using MutableImageView = BasicImageView<false>;

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

/// The continuation of an image beyond its border, as a texture or in computations.
enum class Wrap {
    repeat,  ///< The image repeats.
    /// The border texel of a texture repeats. Heights continue as their point reflection at the
    /// border texel: a plane stays a plane, and derivatives across the border are one-sided.
    clamp,
    mirror,  ///< The image is mirrored, and its outermost texels appear twice, as in OpenGL.
};

template <>
inline constexpr auto enum_names<Wrap> = std::to_array<EnumName<Wrap>>({{"repeat", Wrap::repeat},
                                                                        {"clamp", Wrap::clamp},
                                                                        {"mirror", Wrap::mirror}});

/// The wrap modes of both axes.
struct Wraps {
    Wrap x = Wrap::repeat;
    Wrap y = Wrap::repeat;

    constexpr Wraps() = default;
    constexpr Wraps(Wrap both) : x(both), y(both) {}
    constexpr Wraps(Wrap along_x, Wrap along_y) : x(along_x), y(along_y) {}
    bool operator==(const Wraps&) const = default;
};

/// Returns "repeat", or "repeat,clamp" for different axes.
std::string name_of(const Wraps& wraps);

/// Extracts one channel as float; integer samples are divided by their maximum.
/// \throws InvalidInput if there is no such channel
Image channel_of(const Image& image, int channel);

/// Adds a fourth channel to an image of three channels.
///
/// \param alpha  one float channel of the same size. For images of 8 and 16 bits it is clamped to
///         [0,1] (NaN becomes 0) and rounded to the nearest code
/// \throws InvalidInput if the images have other formats or differ in size
Image with_alpha(const Image& image, const Image& alpha);

/// Removes the fourth channel. \throws InvalidInput if the image does not have four channels
void drop_alpha(Image& image);

/// A rectangle of texels; x points right, y down.
struct ImagePart {
    int x = 0;
    int y = 0;
    int width = 0;
    int height = 0;

    friend bool operator==(const ImagePart&, const ImagePart&) = default;
};

/// Extracts a rectangle as an image of the same format.
/// \throws InvalidInput if the rectangle is empty or not inside of the image
Image part_of(const Image& image, const ImagePart& part);
Image part_of(const ImageView& image, const ImagePart& part);

/// Computes the mip levels below the image itself, down to one texel. Each level has half the width
/// and height of the previous one, rounded down, but at least 1.
///
/// \param image  8, 16 or 32 bits, 1 to 4 channels
/// \return images of the same format. A texel is the mean of the area that it covers in the
///         previous level, with weights by covered area for odd sizes. sRGB colors are averaged in
///         linear light; alpha is averaged separately and does not weight colors. Integer samples
///         keep 16 bits between levels and are rounded to their own bits only in the result. An
///         image of one texel has no levels below it
/// \throws InvalidInput if the image is empty
///
/// The result is the same bits for any number of threads. Drivers of GPUs use different filters.
std::vector<Image> mip_levels(const Image& image);

// Dithering: rounds values up or down by a fixed pattern, so that the mean over a few texels is
// more accurate than single codes. The threshold of a texel depends only on its coordinates, so
// results do not depend on the order of computation or the number of threads.

/// The rounding of values between two codes.
enum class Dither {
    none,  ///< To the nearest code: the error is at most half a code, but constant over flat areas.
    ordered,     ///< By a Bayer matrix of 16 x 16: the shortest period, but a visible pattern.
    blue_noise,  ///< By a tile of 64 x 64 without low frequencies: least visible.
};

template <>
inline constexpr auto enum_names<Dither> = std::to_array<EnumName<Dither>>(
    {{"none", Dither::none}, {"ordered", Dither::ordered}, {"blue-noise", Dither::blue_noise}});

/// Returns the threshold of a texel: a value between two codes is rounded up if its fraction
/// exceeds the threshold.
///
/// \param dither  not `none`
/// \param x, y  coordinates in the whole image, not negative
/// \param channel  0 to 2; each channel uses the same tile with another offset. With blue noise,
///         the errors of the channels are almost uncorrelated
/// \return (k + 0.5) / n, where n is 256 or 4096 and each k from 0 to n - 1 occurs once in a tile.
///         It is never 0, so a value that equals a code gets that code: flat texels stay flat,
///         without noise
///
/// The tiles are computed on first use in integer arithmetic, with the same result on every
/// machine. Source: [Bayer 1973], [Ulichney 1993].
float dither_threshold(Dither dither, int x, int y, int channel);

/// Renders values as an 8-bit sRGB image with a color map from black over violet and orange to pale
/// yellow, whose brightness increases with the value.
///
/// \param values  one float channel
/// \param brightest  the value of the brightest color, above 0. Larger values have the same color,
///         values of at most 0 are black, and NaN is pure green
/// \throws InvalidInput if the image is empty or has another format, or brightest is not positive
Image false_color_image(const Image& values, double brightest);

}  // namespace relief
