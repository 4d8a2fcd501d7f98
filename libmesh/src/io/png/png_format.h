// SPDX-License-Identifier: Apache-2.0
/// \file
/// Building blocks of PNG files: chunks (length, type, data, checksum; numbers are big-endian) and
/// filters, which predict bytes from their neighbors so that the rest deflates well. Source:
/// [ISO/IEC 15948].
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "io/png/deflate_encoder.h"

namespace relief {

void append_big16(std::string& to, std::uint32_t value);
void append_big32(std::string& to, std::uint32_t value);

/// \param data  must be smaller than 2 GiB
void append_chunk(std::string& file, std::string_view type, std::string_view data);

/// Filter types: 0 none, 1 left, 2 above, 3 their mean, 4 Paeth's prediction.
inline constexpr std::uint8_t paeth_filter = 4;
inline constexpr std::uint8_t filter_count = 5;

/// Reverses the filter of a row, in place.
///
/// \param filter  the filter type from the byte before the row
/// \param step    bytes between the same samples of neighboring texels: 1 to 8
/// \param above   the unfiltered row above, of the same size; zeros above the first row
/// \return false if there is no such filter type
bool undo_filter(std::uint8_t filter, std::size_t step, std::span<std::uint8_t> row,
                 std::span<const std::uint8_t> above);

/// Writes the row minus its prediction by a filter (0 to 4) to `filtered`; parameters as above.
void apply_filter(std::uint8_t filter, std::size_t step, std::span<const std::uint8_t> row,
                  std::span<const std::uint8_t> above, std::span<std::uint8_t> filtered);

struct FilterChoice {
    std::uint8_t filter = 0;
    Repetitions repetitions = Repetitions::sought;
};

/// Chooses the filter that makes rows smallest, by trying all of them.
///
/// The usual rule, the least sum of magnitudes, fails for repetitive rows: for normals of stepped
/// heights, unfiltered bytes deflate to half the size of any filtered ones.
/// \param rows  consecutive rows in PNG's byte order, beginning with the row above the first one
/// \param size  bytes in a row
/// \param step  bytes between the same samples of neighboring texels
FilterChoice choose_filter(std::span<const std::uint8_t> rows, std::size_t size, std::size_t step,
                           WriteEffort effort);

}  // namespace relief
