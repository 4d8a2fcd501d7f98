// SPDX-License-Identifier: Apache-2.0
/// \file
/// Prefix codes of limited length, as deflate wants them. Sources: [Huffman 1952], [RFC 1951].
/// Tests: tests/mesh/io/png/deflate_encoder_test.cpp.
#pragma once

#include <cstdint>
#include <span>

namespace relief {

/// How many bits each symbol takes in a shortest prefix code: 0 where it does not occur.
///
/// \param counts  how often each symbol occurs; at most 288 of them, whose sum is below 2^32
/// \param most    the longest that a code may be; codes that would be longer are shortened at the
///                cost of the fewest others
///
/// At least two symbols get a code, used or not, because some decoders refuse codes with gaps.
void huffman_lengths(std::span<const std::uint32_t> counts, int most,
                     std::span<std::uint8_t> lengths);

/// The codes of these lengths, their first bit lowest, as deflate sends them.
void huffman_codes(std::span<const std::uint8_t> lengths, std::span<std::uint16_t> codes);

}  // namespace relief
