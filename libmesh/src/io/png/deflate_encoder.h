// SPDX-License-Identifier: Apache-2.0
/// \file
/// Deflate in pieces that fit together: each piece is coded by itself, on whichever thread, and all
/// of them in a row are one stream. Source: [RFC 1951]. Tests:
/// tests/mesh/io/png/deflate_encoder_test.cpp.
///
/// libdeflate, which reads fastest, can only end a stream, not a piece of one; zlib can, at a fifth
/// of this speed; ISA-L can, but what it writes depends on the processor.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "io/png/match_finder.h"
#include "relief/mesh/image_file.h"

namespace relief {

/// Whether repetitions are looked for. Where bytes are noise, that finds next to nothing.
enum class Repetitions { ignored, sought };

/// Appends a piece of a stream to `to`, ending at a whole byte.
///
/// \param bytes     what went before, at most a window of which is of use, then what is to be coded
/// \param begin     where that begins
/// \param is_last   whether the stream ends with this piece
void deflate_piece(std::span<const std::uint8_t> bytes, std::size_t begin, WriteEffort effort,
                   Repetitions repetitions, bool is_last, std::vector<std::uint8_t>& to);

/// How many bits deflate_piece() would take, about: the block's codes are not made. The same on
/// every machine.
std::uint64_t estimated_bits(std::span<const std::uint8_t> bytes, Repetitions repetitions);

}  // namespace relief
