// SPDX-License-Identifier: Apache-2.0
/// \file
/// The stored numbers of a block of BC7, for the search for encodings and for their storage.
/// Source: [Khronos Data Format], section BPTC.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "image/bptc_lines.h"
#include "relief/mesh/block_compression.h"

namespace relief::detail {

/// The exact colors of blocks, from 0 to 255.
struct Bc7Colors {
    BptcTexels channel[4];
    std::size_t count = 0;  ///< Of the blocks that exist.
};

/// The stored numbers of a block. Modes with one subset use the first two endpoints.
struct Bc7Encoding {
    float error = 1e30F;
    unsigned mode = 6;  ///< 1, 3, 5, 6 or 7.
    unsigned partition = 0;
    unsigned rotation = 0;
    std::array<std::array<std::uint8_t, 4>, 4> ends{};  ///< Without parity.
    std::array<std::uint8_t, 4> parity{};
    std::array<std::uint8_t, bptc_texels> index{};
    std::array<std::uint8_t, bptc_texels> second_index{};  ///< Of mode 5.
};

using Bc7Encodings = std::array<Bc7Encoding, bptc_lanes>;

/// Chooses the best encoding that the quality searches for, of each block.
void choose_bc7_encodings(const Bc7Colors& colors, BlockQuality quality, Bc7Encodings& encodings);

}  // namespace relief::detail
