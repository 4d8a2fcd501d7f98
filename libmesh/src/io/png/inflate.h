// SPDX-License-Identifier: Apache-2.0
/// \file
/// Decompression of zlib streams, at once (libdeflate) or in parts (ISA-L), and their checksums.
///
/// libdeflate works only on whole blocks of memory. ISA-L is nearly as fast and twice as fast as
/// zlib. Sources: [RFC 1950], [RFC 1951].
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string_view>

namespace relief {

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
