// SPDX-License-Identifier: Apache-2.0
// Which decoder of ours takes an image, if any. Nothing is thrown but std::bad_alloc: what goes
// wrong is left to the image module. Tests: tests/mesh/io/png/png_test.cpp, image/jpeg_test.cpp.
#include "io/image/image_file_direct.h"

#include <string_view>
#include <utility>

#include "io/image/jpeg_decoder.h"
#include "io/png/png_decoder.h"

namespace relief {
namespace {

/// \param samples  nothing, or what a decoder made
template <typename Header, typename Samples>
std::optional<Image> image_of(const Header& header, std::optional<Samples> samples) {
    if (!samples) return std::nullopt;
    return Image{header.width, header.height, header.channels, ColorSpace::data,
                 std::move(*samples)};
}

}  // namespace

std::optional<Image> read_directly(const ImageContainer& container) {
    const std::string_view format = container.format;
    if (format == "png") {
        if (const auto png = open_plain_png(container.stripped))
            return image_of(*png, decode(*png));
    } else if (format == "jpeg") {
        if (const auto jpeg = open_plain_jpeg(container.stripped))
            return image_of(*jpeg, decode(*jpeg, container.stripped));
    }
    return std::nullopt;
}

std::optional<ImageInfo> read_info_directly(const ImageContainer& container) {
    const std::string_view format = container.format;
    if (format == "png") {
        if (const auto png = open_plain_png(container.stripped))
            return ImageInfo{png->width, png->height, png->channels, png->bits(), container.text};
    } else if (format == "jpeg") {
        if (const auto jpeg = open_plain_jpeg(container.stripped))
            return ImageInfo{jpeg->width, jpeg->height, jpeg->channels, 8, {}};
    }
    return std::nullopt;
}

}  // namespace relief
