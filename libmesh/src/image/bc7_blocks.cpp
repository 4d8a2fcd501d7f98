// SPDX-License-Identifier: Apache-2.0
// BC7: stores the encodings that bc7_search.cpp chooses, and decodes all modes.
//
// A block has up to three subsets of texels. The colors of a subset lie on a line between two
// endpoints, and an index of 2 to 4 bits per texel selects one. In modes 4 and 5 one channel has
// its own index. Source: [Khronos Data Format], section BPTC.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "image/bc7_format.h"
#include "image/bptc_bits.h"
#include "image/texel_loops.h"
#include "parallel.h"
#include "relief/mesh/block_compression.h"

namespace relief {
using namespace relief::detail;

namespace {

struct Bc7Mode {
    unsigned subsets, partition_bits, rotation_bits, selection_bits, color_bits, alpha_bits;
    unsigned endpoint_parity, subset_parity;  ///< Bits of parity per endpoint, or per subset.
    unsigned index_bits, second_index_bits;
};

constexpr Bc7Mode bc7_modes[8] = {{3, 4, 0, 0, 4, 0, 1, 0, 3, 0}, {2, 6, 0, 0, 6, 0, 0, 1, 3, 0},
                                  {3, 6, 0, 0, 5, 0, 0, 0, 2, 0}, {2, 6, 0, 0, 7, 0, 1, 0, 2, 0},
                                  {1, 0, 2, 1, 5, 6, 0, 0, 2, 3}, {1, 0, 2, 0, 7, 8, 0, 0, 2, 2},
                                  {1, 0, 0, 0, 7, 7, 1, 0, 4, 0}, {2, 6, 0, 0, 5, 5, 1, 0, 2, 0}};

/// Three subsets: bits 2 t and 2 t + 1 are the subset of texel t.
constexpr std::uint32_t partitions_3[64] = {
    0xAA685050, 0x6A5A5040, 0x5A5A4200, 0x5450A0A8, 0xA5A50000, 0xA0A05050, 0x5555A0A0, 0x5A5A5050,
    0xAA550000, 0xAA555500, 0xAAAA5500, 0x90909090, 0x94949494, 0xA4A4A4A4, 0xA9A59450, 0x2A0A4250,
    0xA5945040, 0x0A425054, 0xA5A5A500, 0x55A0A0A0, 0xA8A85454, 0x6A6A4040, 0xA4A45000, 0x1A1A0500,
    0x0050A4A4, 0xAAA59090, 0x14696914, 0x69691400, 0xA08585A0, 0xAA821414, 0x50A4A450, 0x6A5A0200,
    0xA9A58000, 0x5090A0A8, 0xA8A09050, 0x24242424, 0x00AA5500, 0x24924924, 0x24499224, 0x50A50A50,
    0x500AA550, 0xAAAA4444, 0x66660000, 0xA5A0A5A0, 0x50A050A0, 0x69286928, 0x44AAAA44, 0x66666600,
    0xAA444444, 0x54A854A8, 0x95809580, 0x96969600, 0xA85454A8, 0x80959580, 0xAA141414, 0x96960000,
    0xAAAA1414, 0xA05050A0, 0xA0A5A5A0, 0x96000000, 0x40804080, 0xA9A8A9A8, 0xAAAAAA44, 0x2A4A5254};

/// The same as bptc_anchors_2 of the second and third of three subsets.
constexpr std::uint8_t second_anchors_3[64] = {
    3,  3,  15, 15, 8, 3,  15, 15, 8,  8,  6, 6,  6, 5,  3, 3,  3,  3,  8,  15, 3,  3,
    6,  10, 5,  8,  8, 6,  8,  5,  15, 15, 8, 15, 3, 5,  6, 10, 8,  15, 15, 3,  15, 5,
    15, 15, 15, 15, 3, 15, 5,  5,  5,  8,  5, 10, 5, 10, 8, 13, 15, 12, 3,  3};
constexpr std::uint8_t third_anchors_3[64] = {
    15, 8, 8, 3,  15, 15, 3,  8,  15, 15, 15, 15, 15, 15, 15, 8,  15, 8,  15, 3,  15, 8,
    15, 8, 3, 15, 6,  10, 15, 15, 10, 8,  15, 3,  15, 10, 10, 8,  9,  10, 6,  15, 8,  15,
    3,  6, 6, 8,  15, 3,  15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 3,  15, 15, 8};

// Decoding.

unsigned subset_of(unsigned subsets, unsigned partition, unsigned texel) {
    if (subsets == 1) return 0;
    if (subsets == 2) return bptc_partitions_2[partition] >> texel & 1U;
    return partitions_3[partition] >> (2 * texel) & 3U;
}

bool is_anchor(unsigned subsets, unsigned partition, unsigned texel) {
    if (texel == 0) return true;
    if (subsets == 2) return texel == bptc_anchors_2[partition];
    return subsets == 3 &&
           (texel == second_anchors_3[partition] || texel == third_anchors_3[partition]);
}

/// Widens a number to 8 bits by repeating its highest bits.
unsigned widened(unsigned value, unsigned bits) {
    if (bits == 0) return 255;
    const unsigned high = value << (8 - bits);
    return high | high >> bits;
}

unsigned color_between(unsigned first, unsigned second, unsigned weight) {
    return ((64 - weight) * first + weight * second + 32) >> 6;
}

using BlockColor = std::array<std::uint8_t, 4>;
using BlockColors = std::array<BlockColor, bptc_texels>;

BlockColors decode_bc7_block(const std::byte* block) {
    BlockColors colors{};
    BptcBitReader bits(block);
    unsigned number = 0;
    while (number < 8 && bits.read(1) == 0)
        ++number;
    if (number == 8) return colors;
    const Bc7Mode& mode = bc7_modes[number];
    const unsigned partition = bits.read(mode.partition_bits);
    const unsigned rotation = bits.read(mode.rotation_bits);
    const unsigned selection = bits.read(mode.selection_bits);
    const unsigned ends = 2 * mode.subsets;
    unsigned endpoints[6][4];
    for (unsigned channel = 0; channel < 4; ++channel) {
        for (unsigned end = 0; end < ends; ++end)
            endpoints[end][channel] = bits.read(channel < 3 ? mode.color_bits : mode.alpha_bits);
    }
    const bool has_parity = mode.endpoint_parity + mode.subset_parity > 0;
    unsigned parity = 0;
    for (unsigned end = 0; end < ends && has_parity; ++end) {
        if (mode.endpoint_parity == 1 || end % 2 == 0) parity = bits.read(1);
        for (unsigned channel = 0; channel < 4; ++channel)
            endpoints[end][channel] = endpoints[end][channel] << 1 | parity;
    }
    for (unsigned end = 0; end < ends; ++end) {
        for (unsigned channel = 0; channel < 4; ++channel) {
            const unsigned stored = channel < 3 ? mode.color_bits : mode.alpha_bits;
            const unsigned all = stored > 0 && has_parity ? stored + 1 : stored;
            endpoints[end][channel] = widened(endpoints[end][channel], all);
        }
    }
    std::array<unsigned, bptc_texels> first{};
    std::array<unsigned, bptc_texels> second{};
    for (unsigned t = 0; t < bptc_texels; ++t)
        first[t] = bits.read(mode.index_bits - (is_anchor(mode.subsets, partition, t) ? 1 : 0));
    if (mode.second_index_bits > 0) {
        for (unsigned t = 0; t < bptc_texels; ++t)
            second[t] = bits.read(mode.second_index_bits - (t == 0 ? 1 : 0));
    }
    for (unsigned t = 0; t < bptc_texels; ++t) {
        const unsigned end = 2 * subset_of(mode.subsets, partition, t);
        const unsigned first_weight = bptc_weight(first[t], mode.index_bits);
        unsigned color_weight = first_weight;
        unsigned alpha_weight = first_weight;
        if (mode.second_index_bits > 0) {
            const unsigned second_weight = bptc_weight(second[t], mode.second_index_bits);
            (selection == 1 ? color_weight : alpha_weight) = second_weight;
        }
        BlockColor& color = colors[t];
        for (unsigned channel = 0; channel < 4; ++channel) {
            color[channel] = static_cast<std::uint8_t>(
                color_between(endpoints[end][channel], endpoints[end + 1][channel],
                              channel < 3 ? color_weight : alpha_weight));
        }
        if (rotation > 0) std::swap(color[3], color[rotation - 1]);
    }
    return colors;
}

// Storing.

/// Swaps the endpoints of a subset, if the index of its anchor has its highest bit.
void make_anchor_low(Bc7Encoding& encoding, std::size_t subset, std::size_t anchor, unsigned bits,
                     unsigned index_bits) {
    const auto last = static_cast<std::uint8_t>((1U << index_bits) - 1U);
    if (encoding.index[anchor] <= last / 2) return;
    const std::size_t end = 2 * subset;
    if (encoding.mode == 5) {
        // The last channel has its own index.
        for (std::size_t c = 0; c < 3; ++c)
            std::swap(encoding.ends[end][c], encoding.ends[end + 1][c]);
    } else {
        std::swap(encoding.ends[end], encoding.ends[end + 1]);
        std::swap(encoding.parity[end], encoding.parity[end + 1]);
    }
    for (std::size_t t = 0; t < bptc_texels; ++t) {
        if ((bits >> t & 1U) == subset)
            encoding.index[t] = static_cast<std::uint8_t>(last - encoding.index[t]);
    }
}

void store_encoding(Bc7Encoding encoding, std::byte* block) {
    const Bc7Mode& mode = bc7_modes[encoding.mode];
    const unsigned bits = mode.subsets == 2 ? bptc_partitions_2[encoding.partition] : 0;
    make_anchor_low(encoding, 0, 0, bits, mode.index_bits);
    if (mode.subsets == 2)
        make_anchor_low(encoding, 1, bptc_anchors_2[encoding.partition], bits, mode.index_bits);
    if (mode.second_index_bits > 0 && encoding.second_index[0] > 1) {
        std::swap(encoding.ends[0][3], encoding.ends[1][3]);
        for (std::uint8_t& index : encoding.second_index)
            index = static_cast<std::uint8_t>(3 - index);
    }
    BptcBitWriter writer;
    writer.write(1U << encoding.mode, encoding.mode + 1);
    writer.write(encoding.partition, mode.partition_bits);
    writer.write(encoding.rotation, mode.rotation_bits);
    const std::size_t ends = 2 * std::size_t{mode.subsets};
    for (std::size_t c = 0; c < 4; ++c) {
        const unsigned count = c < 3 ? mode.color_bits : mode.alpha_bits;
        for (std::size_t end = 0; end < ends && count > 0; ++end)
            writer.write(encoding.ends[end][c], count);
    }
    for (std::size_t end = 0; end < ends; ++end) {
        const bool is_stored = end % 2 == 0 && mode.subset_parity > 0;
        if (mode.endpoint_parity > 0 || is_stored) writer.write(encoding.parity[end], 1);
    }
    for (unsigned t = 0; t < bptc_texels; ++t) {
        const bool anchor = is_anchor(mode.subsets, encoding.partition, t);
        writer.write(encoding.index[t], mode.index_bits - (anchor ? 1U : 0U));
    }
    for (std::size_t t = 0; t < bptc_texels && mode.second_index_bits > 0; ++t)
        writer.write(encoding.second_index[t], t == 0 ? 1 : 2);
    writer.store(block);
}

/// For each code of 8 bits, two codes of 7 bits such that the weight 21 gives it exactly.
struct ExactCodes {
    std::array<std::array<std::uint8_t, 2>, 256> pair{};

    constexpr ExactCodes() {
        for (unsigned first = 0; first < 128; ++first) {
            for (unsigned second = 0; second < 128; ++second) {
                const unsigned a = first << 1U | first >> 6U;
                const unsigned b = second << 1U | second >> 6U;
                const unsigned code = (43 * a + 21 * b + 32) >> 6U;
                pair[code] = {static_cast<std::uint8_t>(first), static_cast<std::uint8_t>(second)};
            }
        }
    }
};
constexpr ExactCodes exact_codes;

/// Replaces the encoding for a block whose texels all have the same color, rounded to 8 bits.
void use_single_color(const Bc7Colors& colors, std::size_t lane, Bc7Encoding& encoding) {
    for (std::size_t c = 0; c < 4; ++c) {
        for (std::size_t t = 1; t < bptc_texels; ++t) {
            if (colors.channel[c][t][lane] != colors.channel[c][0][lane]) return;
        }
    }
    encoding = Bc7Encoding{};
    encoding.mode = 5;
    for (std::size_t c = 0; c < 4; ++c) {
        const auto code = static_cast<std::size_t>(colors.channel[c][0][lane] + 0.5F);
        const bool is_color = c < 3;
        const auto same = static_cast<std::uint8_t>(code);
        encoding.ends[0][c] = is_color ? exact_codes.pair[code][0] : same;
        encoding.ends[1][c] = is_color ? exact_codes.pair[code][1] : same;
    }
    encoding.index.fill(1);
}

float clamped_code(float value) {
    return value > 0.0F ? (value < 255.0F ? value : 255.0F) : 0.0F;
}

/// Returns a sample in codes of 8 bits, clamped; 0 if it is not finite.
template <typename Sample>
float exact_code(Sample sample, bool& is_finite) {
    if constexpr (std::is_same_v<Sample, float>) {
        is_finite = std::isfinite(sample);
        return is_finite ? clamped_code(255.0F * sample) : 0.0F;
    } else {
        is_finite = true;
        return static_cast<float>(sample) * (255.0F / static_cast<float>(largest_sample<Sample>));
    }
}

/// Loads a block into a lane.
template <typename Sample>
void load_block(const ImageView& image, std::size_t row, std::size_t column, std::size_t lane,
                Bc7Colors& colors, Report& report) {
    for (std::size_t t = 0; t < bptc_texels; ++t) {
        const int place_x = static_cast<int>(4 * column + t % 4);
        const int place_y = static_cast<int>(4 * row + t / 4);
        const int x = std::min(place_x, image.width - 1);
        const int y = std::min(place_y, image.height - 1);
        const Sample* const sample =
            image.row<Sample>(y) + static_cast<std::ptrdiff_t>(x) * image.channels;
        colors.channel[3][t][lane] = 255.0F;
        bool all_finite = true;
        for (int c = 0; c < image.channels; ++c) {
            bool is_finite = true;
            colors.channel[static_cast<std::size_t>(c)][t][lane] = exact_code(sample[c], is_finite);
            all_finite = all_finite && is_finite;
        }
        if (!all_finite && x == place_x && y == place_y) {
            report.add("sample that is not finite", "texel",
                       static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                           static_cast<std::size_t>(x),
                       "stored as 0");
        }
    }
}

template <typename Sample>
void encode_bc7_rows(const ImageView& image, BlockQuality quality, std::size_t begin,
                     std::size_t end, std::vector<std::byte>& blocks, Report& report) {
    const std::size_t columns = (static_cast<std::size_t>(image.width) + 3) / 4;
    Bc7Colors colors{};
    for (std::size_t row = begin; row < end; ++row) {
        for (std::size_t first = 0; first < columns; first += bptc_lanes) {
            colors.count = std::min(bptc_lanes, columns - first);
            for (std::size_t lane = 0; lane < colors.count; ++lane)
                load_block<Sample>(image, row, first + lane, lane, colors, report);
            Bc7Encodings encodings;
            choose_bc7_encodings(colors, quality, encodings);
            for (std::size_t lane = 0; lane < colors.count; ++lane) {
                use_single_color(colors, lane, encodings[lane]);
                store_encoding(encodings[lane],
                               &blocks[(row * columns + first + lane) * bptc_block_size]);
            }
        }
    }
}

}  // namespace

std::vector<std::byte> encode_bc7(const ImageView& image, BlockQuality quality, Report& report) {
    if (image.channels != 3 && image.channels != 4)
        throw InvalidInput(fmt::format("bc7 has 3 or 4 channels, not {}", image.channels));
    std::vector<std::byte> blocks(block_data_size(BlockFormat::bc7, image.width, image.height));
    const std::size_t rows = (static_cast<std::size_t>(image.height) + 3) / 4;
    const std::size_t grain = texels_per_piece / 16 / static_cast<std::size_t>(image.width) + 1;
    parallel_for_reporting(
        rows, grain, report, [&](std::size_t begin, std::size_t end, Report& found) {
            with_sample_type(image, [&]<typename Sample>(Sample) {
                encode_bc7_rows<Sample>(image, quality, begin, end, blocks, found);
            });
        });
    return blocks;
}

Image decode_bc7(std::span<const std::byte> blocks, int width, int height) {
    const std::size_t size = block_data_size(BlockFormat::bc7, width, height);
    if (blocks.size() != size) {
        throw InvalidInput(fmt::format("{} x {} texels of bc7 have {} bytes, not {}", width, height,
                                       size, blocks.size()));
    }
    Image image = make_image(width, height, 4, 8, ColorSpace::data);
    const std::span<std::uint8_t> samples = image.as<std::uint8_t>();
    const auto columns = static_cast<std::size_t>(width);
    const auto rows = static_cast<std::size_t>(height);
    const std::size_t block_columns = (columns + 3) / 4;
    const std::size_t grain = texels_per_piece / 4 / columns + 1;
    parallel_for((rows + 3) / 4, grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin * block_columns; i < end * block_columns; ++i) {
            const std::size_t first_x = i % block_columns * 4;
            const std::size_t first_y = i / block_columns * 4;
            const BlockColors colors = decode_bc7_block(&blocks[i * bptc_block_size]);
            for (std::size_t t = 0; t < bptc_texels; ++t) {
                const std::size_t x = first_x + t % 4;
                const std::size_t y = first_y + t / 4;
                if (x >= columns || y >= rows) continue;
                std::copy(colors[t].begin(), colors[t].end(), &samples[(y * columns + x) * 4]);
            }
        }
    });
    return image;
}

}  // namespace relief
