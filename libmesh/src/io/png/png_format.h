// SPDX-License-Identifier: Apache-2.0
/// \file
/// Building blocks of PNG files: chunks (length, type, data, checksum; numbers are big-endian);
/// filters, which predict bytes from their neighbors so that the rest deflates well; checksums; and
/// decompression of zlib streams, at once (libdeflate) or in parts (ISA-L).
///
/// libdeflate works only on whole blocks of memory. ISA-L is nearly as fast and twice as fast as
/// zlib. Sources: [ISO/IEC 15948], [RFC 1950], [RFC 1951].
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
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

/// Inflates a zlib stream; the result must fill `to` exactly. \return false if the stream is
/// damaged, truncated or of another size
bool inflate(std::span<const std::byte> stream, std::span<std::byte> to);

/// Returns the CRC-32 of PNG ([ISO/IEC 15948], annex D).
std::uint32_t crc32(std::span<const std::byte> bytes);

/// Continues a CRC-32 with the following bytes.
std::uint32_t crc32_of_more(std::uint32_t before, std::span<const std::byte> bytes);

/// The header of a zlib stream: deflate with a window of 32 KiB.
inline constexpr std::string_view zlib_header{"\x78\x9C"};

/// The checksum at the end of a zlib stream: Adler-32 [RFC 1950].
std::uint32_t adler32(std::span<const std::byte> bytes);

/// Returns the Adler-32 of two consecutive ranges, from those of each; `second_size` is the size of
/// the second range.
std::uint32_t adler32_of_both(std::uint32_t first, std::uint32_t second, std::size_t second_size);

/// Inflates a zlib stream in parts, so that neither the stream nor its contents are in memory as a
/// whole.
class InflateStream {
  public:
    /// Returns the next bytes of the stream, which stay valid until the next call; empty at its
    /// end.
    using Feed = std::function<std::span<const std::byte>()>;

    explicit InflateStream(Feed feed);
    ~InflateStream();
    InflateStream(const InflateStream&) = delete;
    InflateStream& operator=(const InflateStream&) = delete;

    /// Fills `to` with the next bytes.
    /// \return false if the stream is damaged or too short
    bool fill(std::span<std::byte> to);

    /// Returns true if all bytes were read and the checksum is correct. Call it once, at the end.
    bool is_complete();

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace relief
