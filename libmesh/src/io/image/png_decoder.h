// SPDX-License-Identifier: Apache-2.0
/// \file
/// The direct way for plain PNG files, without the 0.2 s that loading the image module takes.
///
/// Plain is whatever is not interlaced, has no single transparent colour, and is intact. All else,
/// damage too, is left to the module, so that it has one judge. Samples come out as read_image
/// promises: rows from the top, 1, 2 and 4 bits widened to 8, palettes as RGB or RGBA.
/// Tests: tests/mesh/io/image/png_test.cpp.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "relief/mesh/image.h"

namespace relief {

/// A plain PNG, its header read and its chunks found whole; the data still packed.
struct PlainPng {
    int width = 0;
    int height = 0;
    int stored_bits = 0;                ///< Of a stored sample or palette index: 1, 2, 4, 8 or 16.
    int stored_channels = 0;            ///< 1 where a palette is.
    std::vector<std::uint8_t> palette;  ///< Texels of `channels` bytes; empty where there is none.
    int channels = 0;                   ///< Of the image as it is read.
    std::vector<std::byte> packed;      ///< The zlib stream of all IDAT chunks.

    [[nodiscard]] int bits() const { return stored_bits == 16 ? 16 : 8; }
};

/// What a PNG says of itself, or nothing where it is not plain.
/// \param stripped  IHDR, PLTE, tRNS, IDAT and IEND chunks only (image_file_container.h)
std::optional<PlainPng> open_plain_png(std::span<const std::byte> stripped);

/// Its samples, or nothing where the data are damaged.
std::optional<Image::Samples> decode(const PlainPng& png);

}  // namespace relief
