// SPDX-License-Identifier: Apache-2.0
// BC6H: stores the encodings that bc6h_search.cpp chooses, and decodes all modes.
//
// A block has one or two subsets of texels. The colors of a subset lie on a line between two
// endpoints of 6 to 16 bits, widened to codes of 16 bits, and an index of 3 or 4 bits per texel
// selects one. A code becomes a half float by a factor of 31/64, or of 31/32 with a sign: half
// floats from 0 to 65504, in order, are the integers from 0 to 0x7BFF.
// Source: [Khronos Data Format], section BPTC.
#include "image/bc6h_blocks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string_view>

#include "image/bc6h_format.h"
#include "image/bptc_bits.h"
#include "image/half_float.h"
#include "image/texel_loops.h"
#include "parallel.h"

namespace relief::detail {
namespace {

// The order of the bits.

/// The bits of endpoints between mode and partition, from the lowest: "g2[3:0]" are the bits 0 to 3
/// of green of the third endpoint. The notation is that of the source.
constexpr std::array<std::string_view, 14> layout_texts = {
    "g2[4] b2[4] b3[4] r0[9:0] g0[9:0] b0[9:0] r1[4:0] g3[4] g2[3:0] g1[4:0] b3[0] g3[3:0] b1[4:0] "
    "b3[1] b2[3:0] r2[4:0] b3[2] r3[4:0] b3[3]",
    "g2[5] g3[4] g3[5] r0[6:0] b3[0] b3[1] b2[4] g0[6:0] b2[5] b3[2] g2[4] b0[6:0] b3[3] b3[5] "
    "b3[4] r1[5:0] g2[3:0] g1[5:0] g3[3:0] b1[5:0] b2[3:0] r2[5:0] r3[5:0]",
    "r0[9:0] g0[9:0] b0[9:0] r1[4:0] r0[10] g2[3:0] g1[3:0] g0[10] b3[0] g3[3:0] b1[3:0] b0[10] "
    "b3[1] b2[3:0] r2[4:0] b3[2] r3[4:0] b3[3]",
    "r0[9:0] g0[9:0] b0[9:0] r1[3:0] r0[10] g3[4] g2[3:0] g1[4:0] g0[10] g3[3:0] b1[3:0] b0[10] "
    "b3[1] b2[3:0] r2[3:0] b3[0] b3[2] r3[3:0] g2[4] b3[3]",
    "r0[9:0] g0[9:0] b0[9:0] r1[3:0] r0[10] b2[4] g2[3:0] g1[3:0] g0[10] b3[0] g3[3:0] b1[4:0] "
    "b0[10] b2[3:0] r2[3:0] b3[1] b3[2] r3[3:0] b3[4] b3[3]",
    "r0[8:0] b2[4] g0[8:0] g2[4] b0[8:0] b3[4] r1[4:0] g3[4] g2[3:0] g1[4:0] b3[0] g3[3:0] b1[4:0] "
    "b3[1] b2[3:0] r2[4:0] b3[2] r3[4:0] b3[3]",
    "r0[7:0] g3[4] b2[4] g0[7:0] b3[2] g2[4] b0[7:0] b3[3] b3[4] r1[5:0] g2[3:0] g1[4:0] b3[0] "
    "g3[3:0] b1[4:0] b3[1] b2[3:0] r2[5:0] r3[5:0]",
    "r0[7:0] b3[0] b2[4] g0[7:0] g2[5] g2[4] b0[7:0] g3[5] b3[4] r1[4:0] g3[4] g2[3:0] g1[5:0] "
    "g3[3:0] b1[4:0] b3[1] b2[3:0] r2[4:0] b3[2] r3[4:0] b3[3]",
    "r0[7:0] b3[1] b2[4] g0[7:0] b2[5] g2[4] b0[7:0] b3[5] b3[4] r1[4:0] g3[4] g2[3:0] g1[4:0] "
    "b3[0] g3[3:0] b1[5:0] b2[3:0] r2[4:0] b3[2] r3[4:0] b3[3]",
    "r0[5:0] g3[4] b3[0] b3[1] b2[4] g0[5:0] g2[5] b2[5] b3[2] g2[4] b0[5:0] g3[5] b3[3] b3[5] "
    "b3[4] r1[5:0] g2[3:0] g1[5:0] g3[3:0] b1[5:0] b2[3:0] r2[5:0] r3[5:0]",
    "r0[9:0] g0[9:0] b0[9:0] r1[9:0] g1[9:0] b1[9:0]",
    "r0[9:0] g0[9:0] b0[9:0] r1[8:0] r0[10] g1[8:0] g0[10] b1[8:0] b0[10]",
    "r0[9:0] g0[9:0] b0[9:0] r1[7:0] r0[10:11] g1[7:0] g0[10:11] b1[7:0] b0[10:11]",
    "r0[9:0] g0[9:0] b0[9:0] r1[3:0] r0[10:15] g1[3:0] g0[10:15] b1[3:0] b0[10:15]"};

/// The number that states a mode, and its bits.
struct Selector {
    unsigned number, bits;
};
constexpr std::array<Selector, 14> selectors = {{{0x00, 2},
                                                 {0x01, 2},
                                                 {0x02, 5},
                                                 {0x06, 5},
                                                 {0x0A, 5},
                                                 {0x0E, 5},
                                                 {0x12, 5},
                                                 {0x16, 5},
                                                 {0x1A, 5},
                                                 {0x1E, 5},
                                                 {0x03, 5},
                                                 {0x07, 5},
                                                 {0x0B, 5},
                                                 {0x0F, 5}}};

struct EndBit {
    std::uint8_t end, channel, bit;
};

struct Layout {
    std::array<EndBit, 75> bits{};
    std::size_t count = 0;
};

constexpr unsigned number_at(std::string_view text, std::size_t& at) {
    unsigned number = 0;
    for (; text[at] >= '0' && text[at] <= '9'; ++at)
        number = 10 * number + static_cast<unsigned>(text[at] - '0');
    return number;
}

constexpr Layout layout_of(std::string_view text) {
    Layout layout;
    for (std::size_t at = 0; at < text.size(); at += 2) {  // "] "
        const char channel = text[at];
        const auto end = static_cast<std::uint8_t>(text[at + 1] - '0');
        at += 3;
        const unsigned last = number_at(text, at);
        unsigned bit = last;
        if (text[at] == ':') bit = number_at(text, ++at);
        const auto number = static_cast<std::uint8_t>(channel == 'r' ? 0 : channel == 'g' ? 1 : 2);
        while (true) {
            layout.bits[layout.count++] = {end, number, static_cast<std::uint8_t>(bit)};
            if (bit == last) break;
            bit = bit < last ? bit + 1 : bit - 1;
        }
    }
    return layout;
}

constexpr std::array<Layout, 14> layouts = [] {
    std::array<Layout, 14> result;
    for (std::size_t mode = 0; mode < result.size(); ++mode)
        result[mode] = layout_of(layout_texts[mode]);
    return result;
}();

constexpr bool have_all_bits() {
    for (std::size_t mode = 0; mode < layouts.size(); ++mode) {
        const Bc6hMode& row = bc6h_modes[mode];
        std::size_t bits = selectors[mode].bits + 5 * (row.subsets - 1) + layouts[mode].count;
        bits += 16 * (row.subsets == 1 ? 4 : 3) - row.subsets;
        if (bits != 128) return false;
    }
    return true;
}
static_assert(have_all_bits());

// Decoding.

using BlockHalves = std::array<std::array<std::uint16_t, 3>, bptc_texels>;

/// Returns the number that the lowest bits store in two's complement.
std::int32_t signed_number(std::int32_t value, int bits) {
    const std::int32_t sign = 1 << (bits - 1);
    const std::int32_t stored = value & ((1 << bits) - 1);
    return (stored ^ sign) - sign;
}

/// Widens an endpoint to a code of 16 bits.
std::int32_t widened(std::int32_t end, int bits, bool is_signed) {
    if (!is_signed) {
        if (bits >= 15 || end == 0) return end;
        return end == (1 << bits) - 1 ? 0xFFFF : ((end << 15) + 0x4000) >> (bits - 1);
    }
    if (bits >= 16 || end == 0) return end;
    const std::int32_t size = end < 0 ? -end : end;
    const std::int32_t wide =
        size >= (1 << (bits - 1)) - 1 ? 0x7FFF : ((size << 15) + 0x4000) >> (bits - 1);
    return end < 0 ? -wide : wide;
}

std::uint16_t half_of_code(std::int32_t code, bool is_signed) {
    if (!is_signed) return static_cast<std::uint16_t>((code * 31) >> 6);
    const std::int32_t size = ((code < 0 ? -code : code) * 31) >> 5;
    return static_cast<std::uint16_t>(code < 0 ? size | 0x8000 : size);
}

/// Returns the index in bc6h_modes; 14 for the reserved modes.
std::size_t read_mode(BptcBitReader& bits) {
    unsigned number = bits.read(2);
    if (number > 1) number |= bits.read(3) << 2U;
    const auto* const found =
        std::find_if(selectors.begin(), selectors.end(),
                     [&](const Selector& selector) { return selector.number == number; });
    return static_cast<std::size_t>(found - selectors.begin());
}

/// A block of a reserved mode is black.
BlockHalves decode_block(const std::byte* block, bool is_signed) {
    BlockHalves halves{};
    BptcBitReader bits(block);
    const std::size_t number = read_mode(bits);
    if (number == bc6h_modes.size()) return halves;
    const Bc6hMode& mode = bc6h_modes[number];
    std::array<std::array<std::int32_t, 3>, 4> ends{};
    for (std::size_t i = 0; i < layouts[number].count; ++i) {
        const EndBit& place = layouts[number].bits[i];
        ends[place.end][place.channel] |= static_cast<std::int32_t>(bits.read(1) << place.bit);
    }
    const unsigned partition = mode.subsets == 2 ? bits.read(5) : 0;
    for (std::size_t c = 0; c < 3; ++c) {
        if (is_signed) ends[0][c] = signed_number(ends[0][c], mode.bits);
        for (std::size_t end = 1; end < 2 * std::size_t{mode.subsets}; ++end) {
            std::int32_t& value = ends[end][c];
            if (mode.has_differences) {
                value = ends[0][c] + signed_number(value, mode.other_bits[c]);
                value &= (1 << mode.bits) - 1;
            }
            if (is_signed) value = signed_number(value, mode.bits);
        }
        for (auto& end : ends)
            end[c] = widened(end[c], mode.bits, is_signed);
    }
    const unsigned index_bits = mode.subsets == 1 ? 4 : 3;
    for (unsigned t = 0; t < bptc_texels; ++t) {
        const bool is_anchor = t == 0 || (mode.subsets == 2 && t == bptc_anchors_2[partition]);
        const unsigned index = bits.read(index_bits - (is_anchor ? 1U : 0U));
        const auto weight = static_cast<std::int32_t>(bptc_weight(index, index_bits));
        const std::size_t first =
            mode.subsets == 2 ? 2 * std::size_t{bptc_partitions_2[partition] >> t & 1U} : 0;
        for (std::size_t c = 0; c < 3; ++c) {
            const std::int32_t code =
                (ends[first][c] * (64 - weight) + ends[first + 1][c] * weight + 32) >> 6;
            halves[t][c] = half_of_code(code, is_signed);
        }
    }
    return halves;
}

// Storing.

void store_encoding(const Bc6hEncoding& encoding, std::byte* block) {
    const Bc6hMode& mode = bc6h_modes[encoding.mode];
    BptcBitWriter writer;
    writer.write(selectors[encoding.mode].number, selectors[encoding.mode].bits);
    const Layout& layout = layouts[encoding.mode];
    for (std::size_t i = 0; i < layout.count; ++i) {
        const EndBit& place = layout.bits[i];
        std::int32_t value = encoding.ends[place.end][place.channel];
        if (place.end > 0 && mode.has_differences) value -= encoding.ends[0][place.channel];
        writer.write(static_cast<unsigned>(value) >> place.bit & 1U, 1);
    }
    if (mode.subsets == 2) writer.write(encoding.partition, 5);
    const unsigned index_bits = mode.subsets == 1 ? 4 : 3;
    for (unsigned t = 0; t < bptc_texels; ++t) {
        const bool is_anchor =
            t == 0 || (mode.subsets == 2 && t == bptc_anchors_2[encoding.partition]);
        writer.write(encoding.index[t], index_bits - (is_anchor ? 1U : 0U));
    }
    writer.store(block);
}

/// The limits of a format's values.
struct FormatRange {
    bool is_signed;

    /// Returns the value, limited to the range.
    [[nodiscard]] float limited_value(float value) const {
        const float least = is_signed ? -largest_half : 0.0F;
        return value < least ? least : value > largest_half ? largest_half : value;
    }
};

/// Returns the position of a value of at least 0 among the half floats in order: their bits, with a
/// fraction between two of them.
float half_position(float value) {
    constexpr std::uint32_t least_normal = 113U << 23U;
    const auto bits = std::bit_cast<std::uint32_t>(value);
    if (bits < least_normal) return value * 16777216.0F;
    return static_cast<float>(bits - (112U << 23U)) * (1.0F / 8192.0F);
}

/// Returns the middle of the codes whose decoded half floats are at a position.
float code_of(float value, bool is_signed) {
    const float position = half_position(std::abs(value));
    if (!is_signed) return limited((position + 0.5F) * (64.0F / 31.0F), 0.0F, 65535.0F);
    const float code = limited((position + 0.5F) * (32.0F / 31.0F), 0.0F, 32767.0F);
    return value < 0.0F ? -code : code;
}

/// Returns the distance of half floats near a value.
float half_step(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(std::abs(value));
    const std::uint32_t exponent = std::max(bits >> 23U, 113U);
    return std::bit_cast<float>((exponent - 10U) << 23U);
}

template <typename Sample>
void load_block(const ImageView& image, std::size_t row, std::size_t column, std::size_t lane,
                const FormatRange& range, Bc6hColors& colors, Report& report) {
    constexpr auto scale = static_cast<float>(1.0 / largest_sample<Sample>);
    const bool is_one_value = image.channels == 1;
    float largest_step = 0.0F;
    for (std::size_t t = 0; t < bptc_texels; ++t) {
        const int place_x = static_cast<int>(4 * column + t % 4);
        const int place_y = static_cast<int>(4 * row + t / 4);
        const int x = std::min(place_x, image.width - 1);
        const int y = std::min(place_y, image.height - 1);
        const bool is_repeated = x != place_x || y != place_y;
        const Sample* const sample =
            image.row<Sample>(y) + static_cast<std::ptrdiff_t>(x) * image.channels;
        bool is_finite = true;
        bool is_inside = true;
        for (std::size_t c = 0; c < 3; ++c) {
            float value = static_cast<float>(sample[is_one_value ? 0 : c]) * scale;
            if (!std::isfinite(value)) {
                is_finite = false;
                value = 0.0F;
            }
            const float stored = range.limited_value(value);
            is_inside = is_inside && stored == value;
            colors.channel[c][t][lane] = code_of(stored, range.is_signed) / bc6h_unit;
            if (c == 0) colors.weight[t][lane] = half_step(stored);
        }
        largest_step = std::max(largest_step, colors.weight[t][lane]);
        if (is_repeated || (is_finite && is_inside)) continue;
        const std::size_t texel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
            static_cast<std::size_t>(x);
        if (!is_finite) report.add("sample that is not finite", "texel", texel, "stored as 0");
        if (!is_inside) {
            report.add("texel beyond half's range", "texel", texel,
                       range.is_signed ? "stored as +-65504" : "stored as 0 or 65504");
        }
    }
    // Errors of colors count relative to their size, as the steps of half floats do. Those of one
    // value are absolute.
    for (std::size_t t = 0; t < bptc_texels; ++t) {
        const float part = colors.weight[t][lane] / largest_step;
        colors.weight[t][lane] = is_one_value ? std::max(part * part, 1e-6F) : 1.0F;
    }
}

template <typename Sample>
void encode_rows(const ImageView& image, const FormatRange& range, BlockQuality quality,
                 std::size_t begin, std::size_t end, std::vector<std::byte>& blocks,
                 Report& report) {
    const std::size_t columns = (static_cast<std::size_t>(image.width) + 3) / 4;
    Bc6hColors colors{};
    colors.is_signed = range.is_signed;
    for (std::size_t row = begin; row < end; ++row) {
        for (std::size_t first = 0; first < columns; first += bptc_lanes) {
            colors.count = std::min(bptc_lanes, columns - first);
            for (std::size_t lane = 0; lane < colors.count; ++lane)
                load_block<Sample>(image, row, first + lane, lane, range, colors, report);
            Bc6hEncodings encodings;
            choose_bc6h_encodings(colors, quality, encodings);
            for (std::size_t lane = 0; lane < colors.count; ++lane) {
                store_encoding(encodings[lane],
                               &blocks[(row * columns + first + lane) * bptc_block_size]);
            }
        }
    }
}

}  // namespace

std::vector<std::byte> encode_bc6h(const ImageView& image, BlockFormat format, BlockQuality quality,
                                   Report& report) {
    if (image.channels != 1 && image.channels != 3) {
        throw InvalidInput(
            fmt::format("{} has 1 or 3 channels, not {}", enum_name(format), image.channels));
    }
    const FormatRange range{format == BlockFormat::bc6h_sfloat};
    std::vector<std::byte> blocks(block_data_size(format, image.width, image.height));
    const std::size_t rows = (static_cast<std::size_t>(image.height) + 3) / 4;
    const std::size_t grain = texels_per_piece / 16 / static_cast<std::size_t>(image.width) + 1;
    parallel_for_reporting(
        rows, grain, report, [&](std::size_t begin, std::size_t end, Report& found) {
            with_sample_type(image, [&]<typename Sample>(Sample) {
                encode_rows<Sample>(image, range, quality, begin, end, blocks, found);
            });
        });
    return blocks;
}

Image decode_bc6h(std::span<const std::byte> blocks, BlockFormat format, int width, int height) {
    Image image = make_image(width, height, 3, 32, ColorSpace::data);
    const std::span<float> samples = image.as<float>();
    const auto columns = static_cast<std::size_t>(width);
    const auto rows = static_cast<std::size_t>(height);
    const std::size_t block_columns = (columns + 3) / 4;
    const std::size_t grain = texels_per_piece / 4 / columns + 1;
    const bool has_sign = format == BlockFormat::bc6h_sfloat;
    parallel_for((rows + 3) / 4, grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin * block_columns; i < end * block_columns; ++i) {
            const std::size_t first_x = i % block_columns * 4;
            const std::size_t first_y = i / block_columns * 4;
            const BlockHalves halves = decode_block(&blocks[i * bptc_block_size], has_sign);
            for (std::size_t t = 0; t < bptc_texels; ++t) {
                const std::size_t x = first_x + t % 4;
                const std::size_t y = first_y + t / 4;
                if (x >= columns || y >= rows) continue;
                for (std::size_t c = 0; c < 3; ++c)
                    samples[(y * columns + x) * 3 + c] = float_from_half(halves[t][c]);
            }
        }
    });
    return image;
}

}  // namespace relief::detail
