// SPDX-License-Identifier: Apache-2.0
/// \file
/// zlib streams read whole, and checksums. libdeflate's only home: it inflates 2 to 4 times as fast
/// as zlib. Tests: tests/mesh/io/png/png_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace relief {

/// Fills `to` exactly. \return false where the stream is damaged, cut short or of another size
bool inflate(std::span<const std::byte> stream, std::span<std::byte> to);

/// The CRC-32 of PNG [ISO/IEC 15948], annex D.
std::uint32_t crc32(std::span<const std::byte> bytes);

/// That of more bytes, behind those that had this one.
std::uint32_t crc32_of_more(std::uint32_t before, std::span<const std::byte> bytes);

/// How a zlib stream begins: deflate, with a window of 32 KiB.
inline constexpr std::string_view zlib_header{"\x78\x9C"};

/// The checksum at its end, Adler-32 [RFC 1950], of some bytes.
std::uint32_t adler32(std::span<const std::byte> bytes);

/// The checksum of bytes and of others behind them, of which there are `second_size`.
std::uint32_t adler32_of_both(std::uint32_t first, std::uint32_t second, std::size_t second_size);

}  // namespace relief
