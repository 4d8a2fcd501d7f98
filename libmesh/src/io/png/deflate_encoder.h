// SPDX-License-Identifier: Apache-2.0
/// \file
/// An encoder of deflate streams [RFC 1951] whose output does not depend on the machine, and whose
/// parts can be encoded in parallel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "relief/mesh/image_file.h"

namespace relief {

/// Computes the code lengths of a shortest prefix code of limited length; 0 for symbols that do not
/// occur.
///
/// \param counts  frequency of each symbol; at most 288 symbols, with a sum below 2^32
/// \param max_length    the maximum length of a code; longer codes are shortened at the expense of
/// as few
///         others as possible
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

}  // namespace relief
