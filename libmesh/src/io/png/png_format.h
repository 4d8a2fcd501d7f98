// SPDX-License-Identifier: Apache-2.0
/// \file
/// Building blocks of PNG files: chunks (length, type, data, checksum; numbers are big-endian);
/// filters, which predict bytes from their neighbors so that the rest deflates well; checksums;
/// deflate streams, whose encoder gives the same bytes on all machines and encodes parts in
/// parallel; and the decoder.
///
/// zlib streams are decompressed at once (libdeflate) or in parts (ISA-L). libdeflate works only on
/// whole blocks of memory. ISA-L is nearly as fast and twice as fast as zlib.
///
/// The decoder reads plain PNG files without loading the image module (0.2 s). A plain PNG is not
/// interlaced, has no single transparent color, and is intact. All others, damaged ones too, are
/// left to the module, so that only it decides about them. Samples are those of read_image(): rows
/// from the top, 1, 2 and 4 bits widened to 8, palettes as RGB or RGBA. Sources: [ISO/IEC 15948],
/// [RFC 1950], [RFC 1951].
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/image/row_codec.h"
#include "relief/mesh/image.h"
#include "relief/mesh/image_file.h"

namespace relief::detail {

// Encoder of deflate streams [RFC 1951]

/// Computes the code lengths of a shortest prefix code of limited length; 0 for symbols that do not
/// occur.
///
/// \param counts  frequency of each symbol; at most 288 symbols, with a sum below 2^32
/// \param max_length    the maximum length of a code; longer codes are shortened at the expense of
///         as few others as possible
///
/// At least two symbols get a code, used or not, because some decoders refuse incomplete codes.
/// Source: [Huffman 1952].
void huffman_lengths(std::span<const std::uint32_t> counts, int max_length,
                     std::span<std::uint8_t> lengths);

/// Computes the codes of these lengths, with the first bit lowest, as deflate stores them.
void huffman_codes(std::span<const std::uint8_t> lengths, std::span<std::uint16_t> codes);

/// Distance to which deflate can refer back.
inline constexpr std::size_t deflate_window = 32768;

/// Tells whether to search for repetitions. In noise there are hardly any.
enum class Repetitions { ignored, sought };

/// Appends a part of a stream to `to`; it ends at a byte boundary.
///
/// \param bytes    the preceding bytes, of which at most a window is used, and the bytes to encode
/// \param begin    index of the first byte to encode
/// \param is_last  tells whether the stream ends with this part
void deflate_piece(std::span<const std::uint8_t> bytes, std::size_t begin, WriteEffort effort,
                   Repetitions repetitions, bool is_last, std::vector<std::uint8_t>& to);

/// Estimates the number of bits from deflate_piece() without encoding. The estimate is the same on
/// all machines.
std::uint64_t estimated_bits(std::span<const std::uint8_t> bytes, Repetitions repetitions);

// Chunks, filters, checksums and decompression

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

// Decoder

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

}  // namespace relief::detail
