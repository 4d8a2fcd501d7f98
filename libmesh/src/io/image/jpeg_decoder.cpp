// SPDX-License-Identifier: Apache-2.0
// Plain JPEG files by libjpeg-turbo, with the accurate transform and the smooth upsampling that are
// libjpeg's defaults. Whatever is odd or damaged gives nothing, and the image module is asked
// instead. Source: [ITU-T T.81]. Tests: tests/mesh/io/image/jpeg_test.cpp.
#include "io/image/jpeg_decoder.h"

#include <turbojpeg.h>

#include <memory>
#include <new>

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
    const std::size_t most_rows = max_image_samples / static_cast<std::size_t>(jpeg.channels) /
                                  static_cast<std::size_t>(jpeg.width);
    if (static_cast<std::size_t>(jpeg.height) > most_rows) return std::nullopt;
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

}  // namespace relief
