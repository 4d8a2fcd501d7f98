// SPDX-License-Identifier: Apache-2.0
/// \file
/// Decoders of common PNG and JPEG files that do not need the image module, which takes 0.2 s to
/// load.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "io/image/image_file_container.h"
#include "relief/mesh/image_file.h"

namespace relief {

/// Decodes common PNG and JPEG files; nullopt for other kinds and damaged files, which are left to
/// the module. The caller sets the color space.
std::optional<Image> read_directly(const ImageContainer& container);

/// The header and text of common files; nullopt for other kinds.
std::optional<ImageInfo> read_info_directly(const ImageContainer& container);

/// The header of a JPEG.
struct PlainJpeg {
    int width = 0;
    int height = 0;
    int channels = 0;  ///< 1 for gray, 3 for RGB.
};

/// nullopt if the JPEG is not plain: gray or color, 8 bits, not CMYK.
/// \param stripped  the file without Exif and the like (image_file_container.h)
std::optional<PlainJpeg> open_plain_jpeg(std::span<const std::byte> stripped);

/// The samples; nullopt if the decoder reports any problem.
std::optional<std::vector<std::uint8_t>> decode(const PlainJpeg& jpeg,
                                                std::span<const std::byte> stripped);

}  // namespace relief
