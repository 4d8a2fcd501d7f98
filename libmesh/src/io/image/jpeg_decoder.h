// SPDX-License-Identifier: Apache-2.0
/// \file
/// The direct way for plain JPEG files, without the 0.2 s that loading the image module takes.
/// libjpeg-turbo's only home; OpenImageIO decodes by the same library, to the same samples.
/// Tests: tests/mesh/io/image/jpeg_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace relief {

/// What a JPEG says of itself.
struct PlainJpeg {
    int width = 0;
    int height = 0;
    int channels = 0;  ///< 1 grey, 3 RGB.
};

/// Nothing where it is not plain: grey or coloured, of 8 bits, not CMYK.
/// \param stripped  without Exif and the like (image_file_container.h)
std::optional<PlainJpeg> open_plain_jpeg(std::span<const std::byte> stripped);

/// Its samples, or nothing where the decoder finds anything to complain of.
std::optional<std::vector<std::uint8_t>> decode(const PlainJpeg& jpeg,
                                                std::span<const std::byte> stripped);

}  // namespace relief
