// SPDX-License-Identifier: Apache-2.0
/// \file
/// The direct way for plain PNG files, without the 0.2 s that loading the image module takes.
///
/// Plain is whatever is not interlaced, has no single transparent colour, and is intact. All else,
/// damage too, is left to the module, so that it has one judge. Samples come out as read_image
/// promises: rows from the top, 1, 2 and 4 bits widened to 8, palettes as RGB or RGBA.
/// Tests: tests/mesh/io/png/png_test.cpp.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "relief/mesh/image.h"

namespace relief {

/// What the header and the palette of a plain PNG say.
struct PlainPng {
    int width = 0;
    int height = 0;
    int stored_bits = 0;                ///< Of a stored sample or palette index: 1, 2, 4, 8 or 16.
    int stored_channels = 0;            ///< 1 where a palette is.
    std::vector<std::uint8_t> palette;  ///< Texels of `channels` bytes; empty where there is none.
    int channels = 0;                   ///< Of the image as it is read.
    std::vector<std::byte> packed;      ///< The zlib stream of all IDAT chunks, where it is held.

    [[nodiscard]] int bits() const { return stored_bits == 16 ? 16 : 8; }
    /// Of a row in the stream, without the byte that names the filter.
    [[nodiscard]] std::size_t stored_row_size() const;
    /// Of a row of samples.
    [[nodiscard]] std::size_t row_size() const;
    /// From a stored sample to the same of the texel on the left, in bytes.
    [[nodiscard]] std::size_t step() const;
};

/// Some chunks' data, which is empty where there are none.
struct PngChunks {
    std::span<const std::byte> header;
    std::span<const std::byte> palette;
    std::span<const std::byte> transparency;
};

/// What these say, or nothing where that is not plain. `packed` is left empty.
std::optional<PlainPng> plain_png(const PngChunks& chunks);

/// What a PNG says of itself, or nothing where it is not plain, or of more than max_image_samples.
/// \param stripped  IHDR, PLTE, tRNS, IDAT and IEND chunks only (image_file_container.h)
std::optional<PlainPng> open_plain_png(std::span<const std::byte> stripped);

/// Its samples, or nothing where the data are damaged.
std::optional<Image::Samples> decode(const PlainPng& png);

/// One row as it stands in the stream, unfiltered, as samples in the machine's byte order.
/// \return false where an index is beyond the palette
bool unpack_row(const PlainPng& png, std::span<const std::uint8_t> stored, std::byte* samples);

}  // namespace relief
