// SPDX-License-Identifier: Apache-2.0
// What the formats hold: PNG 8 and 16 bits, JPEG 8, EXR and HDR float, TIFF all three.
// Tests: tests/mesh/io/image/image_file_test.cpp.
#include "io/image/write_checks.h"

#include <fmt/format.h>

#include "file_bytes.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

void check_shape(const ImageShape& shape) {
    if (shape.width < 1 || shape.height < 1) {
        throw InvalidInput(
            fmt::format("an image of {} x {} texels is empty", shape.width, shape.height));
    }
    constexpr int most_named = 8;
    const bool is_named = !shape.channel_names.empty();
    const int most = is_named ? most_named : 4;
    if (shape.channels < 1 || shape.channels > most) {
        throw InvalidInput(
            fmt::format("an image has 1 to {} channels, not {}", most, shape.channels));
    }
    if (is_named && shape.channel_names.size() != static_cast<std::size_t>(shape.channels)) {
        throw InvalidInput(
            fmt::format("{} names for {} channels", shape.channel_names.size(), shape.channels));
    }
    if (shape.bits != 8 && shape.bits != 16 && shape.bits != 32)
        throw InvalidInput(fmt::format("samples have 8, 16 or 32 bits, not {}", shape.bits));
    const auto width = static_cast<std::size_t>(shape.width);
    const auto height = static_cast<std::size_t>(shape.height);
    const std::size_t row = width * static_cast<std::size_t>(shape.channels);
    if (row > max_image_samples || row > max_streamed_samples / height) {
        throw InvalidInput(
            fmt::format("an image of {} x {} x {} samples; relief writes up to {} a "
                        "row, {} in all",
                        width, height, shape.channels, max_image_samples, max_streamed_samples));
    }
}

}  // namespace

const char* format_by_extension(const std::filesystem::path& file) {
    const std::string extension = lower_extension(file);
    if (extension == ".png") return "png";
    if (extension == ".tif" || extension == ".tiff") return "tiff";
    if (extension == ".exr") return "openexr";
    if (extension == ".hdr") return "hdr";
    if (extension == ".jpg" || extension == ".jpeg") return "jpeg";
    throw FileError(file, fmt::format("relief writes no '{}' images; it writes .png, .tif, .exr, "
                                      ".hdr and .jpg",
                                      extension));
}

void check_writable(const std::string& format, const ImageShape& shape,
                    const ImageWriteOptions& options) {
    check_shape(shape);
    const int bits = shape.bits;
    const bool holds_float_only = format == "openexr" || format == "hdr";
    if (holds_float_only && bits != 32)
        throw InvalidInput(fmt::format("EXR and HDR hold float samples, not {} bits", bits));
    if (options.half && format != "openexr")
        throw InvalidInput("half-float samples are written to EXR only");
    if (!shape.channel_names.empty() && format != "openexr" && format != "tiff")
        throw InvalidInput("channels have names of their own in EXR and TIFF only");
    constexpr std::size_t longest_png_row = std::size_t{1} << 30;
    if (format == "png" && static_cast<std::size_t>(shape.width) *
                                   static_cast<std::size_t>(shape.channels * bits / 8) >
                               longest_png_row) {
        throw InvalidInput(fmt::format("a row of {} texels is too long for PNG", shape.width));
    }
    if (format == "png" && bits == 32) throw InvalidInput("PNG holds 8 or 16 bits, not float");
    if (format == "jpeg" && bits != 8)
        throw InvalidInput(fmt::format("JPEG holds 8 bits, not {}", bits));
    if (format == "jpeg" && shape.channels % 2 == 0) throw InvalidInput("JPEG holds no alpha");
    if (format == "hdr" && shape.channels != 3)
        throw InvalidInput(fmt::format("HDR holds 3 channels, not {}", shape.channels));
    if (shape.color_space == ColorSpace::linear && bits != 32)
        throw InvalidInput("linear colour is stored as float; encode it with to_srgb first");
    if (shape.color_space == ColorSpace::srgb && bits == 32)
        throw InvalidInput("sRGB-coded colour is stored in 8 or 16 bits; decode it with to_linear");
}

void check_metadata(const std::map<std::string, std::string>& metadata) {
    constexpr std::size_t longest_png_key = 79;
    for (const auto& [key, value] : metadata) {
        if (key.empty() || key.size() > longest_png_key) {
            throw InvalidInput(fmt::format("the metadata key '{}' has {} letters, not 1 to {}", key,
                                           key.size(), longest_png_key));
        }
    }
}

}  // namespace relief
