// SPDX-License-Identifier: Apache-2.0
/// \file
/// The modes of BC6H and the stored numbers of a block, for the search for encodings and for their
/// storage. Source: [Khronos Data Format], section BPTC.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "image/bptc_lines.h"
#include "relief/mesh/block_compression.h"

namespace relief::detail {

struct Bc6hMode {
    unsigned subsets;
    int bits;  ///< Of the first endpoint.
    /// The bits of each channel of the other endpoints: of differences to the first one, or of the
    /// endpoints themselves.
    std::array<int, 3> other_bits;
    bool has_differences;
};

/// The modes 1 to 14 of the format.
inline constexpr std::array<Bc6hMode, 14> bc6h_modes = {{{2, 10, {5, 5, 5}, true},
                                                         {2, 7, {6, 6, 6}, true},
                                                         {2, 11, {5, 4, 4}, true},
                                                         {2, 11, {4, 5, 4}, true},
                                                         {2, 11, {4, 4, 5}, true},
                                                         {2, 9, {5, 5, 5}, true},
                                                         {2, 8, {6, 5, 5}, true},
                                                         {2, 8, {5, 6, 5}, true},
                                                         {2, 8, {5, 5, 6}, true},
                                                         {2, 6, {6, 6, 6}, false},
                                                         {1, 10, {10, 10, 10}, false},
                                                         {1, 11, {9, 9, 9}, true},
                                                         {1, 12, {8, 8, 8}, true},
                                                         {1, 16, {4, 4, 4}, true}}};

/// Number of modes with two subsets, which are the first ones, and of their partitions.
inline constexpr std::size_t bc6h_two_subset_modes = 10;
inline constexpr std::size_t bc6h_partitions = 32;

/// Values between endpoints are computed in codes of 16 bits. Here they are divided by 256, so that
/// products of them stay in the range of floats.
inline constexpr float bc6h_unit = 256.0F;

/// The exact colors of blocks, in codes divided by bc6h_unit.
struct Bc6hColors {
    BptcTexels channel[3];
    BptcTexels weight;      ///< Of squared errors, above 0 and at most 1.
    std::size_t count = 0;  ///< Of the blocks that exist.
    bool is_signed = false;
};

/// The stored numbers of a block. Modes with one subset use the first two endpoints.
struct Bc6hEncoding {
    float error = 1e30F;
    std::size_t mode = 10;  ///< Index in bc6h_modes.
    unsigned partition = 0;
    std::array<std::array<std::int32_t, 3>, 4> ends{};  ///< Not as differences.
    std::array<std::uint8_t, bptc_texels> index{};
};

using Bc6hEncodings = std::array<Bc6hEncoding, bptc_lanes>;

/// Chooses the best encoding that the quality searches for, of each block. Indices of anchors have
/// no highest bit, and differences fit into their bits.
void choose_bc6h_encodings(const Bc6hColors& colors, BlockQuality quality,
                           Bc6hEncodings& encodings);

}  // namespace relief::detail
