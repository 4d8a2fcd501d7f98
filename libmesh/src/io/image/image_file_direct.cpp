// SPDX-License-Identifier: Apache-2.0
// Decodes plain JPEG files with libjpeg-turbo, and chooses between this decoder and that of PNG.
// This is the only file that uses libjpeg-turbo; OpenImageIO decodes with the same library, to the
// same samples.
#include "io/image/image_file_direct.h"

#include <turbojpeg.h>

#include <memory>
#include <new>
#include <string_view>
#include <utility>

#include "io/png/png_decoder.h"
#include "relief/mesh/image_file.h"

namespace relief {
namespace {

struct Destroy {
    void operator()(void* decoder) const { tjDestroy(decoder); }
};
using Decoder = std::unique_ptr<void, Destroy>;

Decoder make_decoder() {
    Decoder decoder(tjInitDecompress());
    if (!decoder) throw std::bad_alloc();
    return decoder;
}

const unsigned char* data_of(std::span<const std::byte> bytes) {
    return reinterpret_cast<const unsigned char*>(bytes.data());
}

}  // namespace

std::optional<PlainJpeg> open_plain_jpeg(std::span<const std::byte> stripped) {
    const Decoder decoder = make_decoder();
    PlainJpeg jpeg;
    int subsampling = 0;
    int colors = 0;
    if (tjDecompressHeader3(decoder.get(), data_of(stripped), stripped.size(), &jpeg.width,
                            &jpeg.height, &subsampling, &colors) != 0) {
        return std::nullopt;
    }
    if (colors != TJCS_GRAY && colors != TJCS_RGB && colors != TJCS_YCbCr) return std::nullopt;
    jpeg.channels = colors == TJCS_GRAY ? 1 : 3;
    const std::size_t max_rows = max_image_samples / static_cast<std::size_t>(jpeg.channels) /
                                 static_cast<std::size_t>(jpeg.width);
    if (static_cast<std::size_t>(jpeg.height) > max_rows) return std::nullopt;
    return jpeg;
}

std::optional<std::vector<std::uint8_t>> decode(const PlainJpeg& jpeg,
                                                std::span<const std::byte> stripped) {
    const Decoder decoder = make_decoder();
    std::vector<std::uint8_t> samples(static_cast<std::size_t>(jpeg.width) *
                                      static_cast<std::size_t>(jpeg.height) *
                                      static_cast<std::size_t>(jpeg.channels));
    const int format = jpeg.channels == 1 ? TJPF_GRAY : TJPF_RGB;
    if (tjDecompress2(decoder.get(), data_of(stripped), stripped.size(), samples.data(), jpeg.width,
                      0, jpeg.height, format, TJFLAG_STOPONWARNING) != 0) {
        return std::nullopt;
    }
    return samples;
}

namespace {

/// \param samples  the decoder's result
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
