// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the search for encodings of BC7 and their storage share: partitions, and the stored numbers
/// of a block. Source: [Khronos Data Format], section BPTC.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "relief/mesh/block_compression.h"

namespace relief::detail {

/// Partitions into two subsets: bit t is the subset of texel t.
inline constexpr std::uint16_t bc7_partitions_2[64] = {
    0xCCCC, 0x8888, 0xEEEE, 0xECC8, 0xC880, 0xFEEC, 0xFEC8, 0xEC80, 0xC800, 0xFFEC, 0xFE80,
    0xE800, 0xFFE8, 0xFF00, 0xFFF0, 0xF000, 0xF710, 0x008E, 0x7100, 0x08CE, 0x008C, 0x7310,
    0x3100, 0x8CCE, 0x088C, 0x3110, 0x6666, 0x366C, 0x17E8, 0x0FF0, 0x718E, 0x399C, 0xAAAA,
    0xF0F0, 0x5A5A, 0x33CC, 0x3C3C, 0x55AA, 0x9696, 0xA55A, 0x73CE, 0x13C8, 0x324C, 0x3BDC,
    0x6996, 0xC33C, 0x9966, 0x0660, 0x0272, 0x04E4, 0x4E40, 0x2720, 0xC936, 0x936C, 0x39C6,
    0x639C, 0x9336, 0x9CC6, 0x817E, 0xE718, 0xCCF0, 0x0FCC, 0x7744, 0xEE22};

inline constexpr std::size_t bc7_texels = 16;

/// The number of blocks that are encoded at once. It is more than 16, because GCC unrolls loops of
/// up to 16 steps before it could vectorize them.
inline constexpr std::size_t bc7_lanes = 32;

/// One number for each block.
struct alignas(64) Bc7Lanes {
    float value[bc7_lanes];

    float& operator[](std::size_t lane) { return value[lane]; }
    float operator[](std::size_t lane) const { return value[lane]; }
    void fill(float number) {
        for (float& one : value)
            one = number;
    }
};

/// One number for each texel of each block.
struct Bc7Texels {
    Bc7Lanes texel[bc7_texels];

    Bc7Lanes& operator[](std::size_t t) { return texel[t]; }
    const Bc7Lanes& operator[](std::size_t t) const { return texel[t]; }
};

/// The exact colors of blocks, from 0 to 255.
struct Bc7Colors {
    Bc7Texels channel[4];
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
    std::array<std::uint8_t, bc7_texels> index{};
    std::array<std::uint8_t, bc7_texels> second_index{};  ///< Of mode 5.
};

using Bc7Encodings = std::array<Bc7Encoding, bc7_lanes>;

/// Chooses the best encoding that the quality searches for, of each block.
void choose_bc7_encodings(const Bc7Colors& colors, BlockQuality quality, Bc7Encodings& encodings);

}  // namespace relief::detail
