// SPDX-License-Identifier: Apache-2.0
/// \file
/// The decoder of plain PNG files, which avoids loading the image module (0.2 s).
///
/// A plain PNG is not interlaced, has no single transparent color, and is intact. All others,
/// damaged ones too, are left to the module, so that only it decides about them. Samples are those
/// of read_image(): rows from the top, 1, 2 and 4 bits widened to 8, palettes as RGB or RGBA.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "io/image/row_codec.h"
#include "relief/mesh/image.h"

namespace relief {

/// The header and the palette of a plain PNG.
struct PlainPng {
    int width = 0;
    int height = 0;
    int stored_bits = 0;                ///< Of a stored sample or palette index: 1, 2, 4, 8 or 16.
    int stored_channels = 0;            ///< 1 if there is a palette.
    std::vector<std::uint8_t> palette;  ///< Texels of `channels` bytes; empty if there is none.
    int channels = 0;                   ///< Of the decoded image.
    std::vector<std::byte> packed;      ///< The zlib stream of all IDAT chunks, if it is in memory.

    [[nodiscard]] int bits() const { return stored_bits == 16 ? 16 : 8; }
    /// Bytes of a row in the stream, without the filter byte.
    [[nodiscard]] std::size_t stored_row_size() const;
    /// Bytes of a row of samples.
    [[nodiscard]] std::size_t row_size() const;
    /// Bytes between the same stored samples of neighboring texels.
    [[nodiscard]] std::size_t step() const;
};

/// Returns the properties of a PNG; nullopt if it is not plain, or has more than max_image_samples.
/// \param stripped  IHDR, PLTE, tRNS, IDAT and IEND chunks only (image_file_container.h)
std::optional<PlainPng> open_plain_png(std::span<const std::byte> stripped);

/// Returns the samples; nullopt if the data is damaged.
std::optional<Image::Samples> decode(const PlainPng& png);

/// Opens a plain PNG file, whose rows are decoded on demand; null if it is not plain. If damage is
/// found in a row, the image module reads the file from its beginning and decides. \throws
/// FileError if the file is truncated, or if its header announces more than it can hold
std::unique_ptr<RowSource> open_png_rows(const std::filesystem::path& file);

}  // namespace relief
