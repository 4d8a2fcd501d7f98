// SPDX-License-Identifier: Apache-2.0
// Reading whole image files. TIFF, EXR and large PNG files are read by rows from the file, all
// others from memory: bytes -> container checks -> a decoder -> Image. The usual PNG and JPEG files
// have a direct way; all else goes through the image module. Damaged, truncated, empty or oversized
// files are a FileError. Tests: tests/mesh/io/image/image_file_test.cpp.
#include "relief/mesh/image_file.h"

#include <fmt/format.h>

#include <memory>
#include <new>
#include <optional>
#include <utility>

#include "file_bytes.h"
#include "io/image/image_file_container.h"
#include "io/image/image_file_direct.h"
#include "io/image/module_source.h"
#include "io/image/streamed_rows.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

ColorSpace color_space_of(ImageUse use, int bits) {
    if (use == ImageUse::data) return ColorSpace::data;
    return bits == 32 ? ColorSpace::linear : ColorSpace::srgb;
}

/// A whole file; refuses what no acceptable image can be, before memory is taken.
std::string read_bytes(const std::filesystem::path& file) {
    constexpr std::uintmax_t largest = max_image_samples * sizeof(float);
    std::error_code unknown;
    const std::uintmax_t size = std::filesystem::file_size(file, unknown);
    if (!unknown && size > largest) {
        throw FileError(
            file, fmt::format("has {} bytes; relief reads images of up to {}", size, largest));
    }
    return read_file(file);
}

Image read_encoded(std::span<const std::byte> bytes, const std::filesystem::path& name) {
    ImageContainer container = examine_image(bytes, name);
    if (std::optional<Image> image = read_directly(container)) return std::move(*image);
    return read_all(*module_rows(std::move(container), bytes, name), name);
}

ImageInfo info_of(std::span<const std::byte> bytes, const std::filesystem::path& name) {
    ImageContainer container = examine_image(bytes, name);
    if (std::optional<ImageInfo> info = read_info_directly(container)) return std::move(*info);
    return module_rows(std::move(container), bytes, name)->info();
}

/// Below this size a PNG is faster read and inflated at once.
constexpr std::uintmax_t large_png = std::uintmax_t{1} << 20;

Image read_from_file(const std::filesystem::path& file) {
    std::error_code unknown;
    const std::uintmax_t size = std::filesystem::file_size(file, unknown);
    const bool is_small_png = !unknown && size < large_png && lower_extension(file) == ".png";
    if (!is_small_png) {
        if (const auto rows = open_streamed_rows(file)) return read_all(*rows, file);
    }
    const std::string contents = read_bytes(file);
    return read_encoded(std::as_bytes(std::span(contents)), file);
}

/// Labels what `read` gives by its use.
template <typename Read>
Image read_for(ImageUse use, const std::filesystem::path& name, Read read) {
    try {
        Image image = read();
        image.color_space = color_space_of(use, image.bits());
        return image;
    } catch (const std::bad_alloc&) {
        throw FileError(name, "does not fit into memory");
    }
}

}  // namespace

Image read_image(const std::filesystem::path& file, ImageUse use) {
    return read_for(use, file, [&] { return read_from_file(file); });
}

Image read_image(std::span<const std::byte> bytes, const std::string& name, ImageUse use) {
    return read_for(use, name, [&] { return read_encoded(bytes, name); });
}

ImageInfo read_image_info(const std::filesystem::path& file) {
    if (const auto rows = open_streamed_rows(file)) return rows->info();
    const std::string contents = read_bytes(file);
    return info_of(std::as_bytes(std::span(contents)), file);
}

ImageInfo read_image_info(std::span<const std::byte> bytes, const std::string& name) {
    return info_of(bytes, name);
}

}  // namespace relief
