// SPDX-License-Identifier: Apache-2.0
// BC7: encodes blocks with modes 5 and 6, and decodes all modes.
//
// A block has up to three subsets of texels. The colors of a subset lie on a line between two
// endpoints, and an index of 2 to 4 bits per texel selects one. In mode 6 all four channels share
// an index of 4 bits; in modes 4 and 5 one channel has its own. Encoding fits a line to the exact
// colors, rounds its endpoints, chooses indices, and fits again by least squares. Errors are
// computed from the decoded integers. Source: [Khronos Data Format], section BPTC.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "image/texel_loops.h"
#include "parallel.h"
#include "relief/mesh/block_compression.h"

namespace relief {
using namespace relief::detail;

namespace {

constexpr std::size_t block_texels = 16;
constexpr std::size_t block_size = 16;

struct Bc7Mode {
    unsigned subsets, partition_bits, rotation_bits, selection_bits, color_bits, alpha_bits;
    unsigned endpoint_parity, subset_parity;  ///< Bits of parity per endpoint, or per subset.
    unsigned index_bits, second_index_bits;
};

constexpr Bc7Mode bc7_modes[8] = {{3, 4, 0, 0, 4, 0, 1, 0, 3, 0}, {2, 6, 0, 0, 6, 0, 0, 1, 3, 0},
                                  {3, 6, 0, 0, 5, 0, 0, 0, 2, 0}, {2, 6, 0, 0, 7, 0, 1, 0, 2, 0},
                                  {1, 0, 2, 1, 5, 6, 0, 0, 2, 3}, {1, 0, 2, 0, 7, 8, 0, 0, 2, 2},
                                  {1, 0, 0, 0, 7, 7, 1, 0, 4, 0}, {2, 6, 0, 0, 5, 5, 1, 0, 2, 0}};

/// The weights of the second endpoint in 64ths, by the bits of indices.
constexpr std::array<std::uint8_t, 4> weights_2 = {0, 21, 43, 64};
constexpr std::array<std::uint8_t, 8> weights_3 = {0, 9, 18, 27, 37, 46, 55, 64};
constexpr std::array<std::uint8_t, 16> weights_4 = {0,  4,  9,  13, 17, 21, 26, 30,
                                                    34, 38, 43, 47, 51, 55, 60, 64};

unsigned weight_of(unsigned index, unsigned bits) {
    if (bits == 2) return weights_2[index];
    return bits == 3 ? weights_3[index] : weights_4[index];
}

/// Two subsets: bit t is the subset of texel t.
constexpr std::uint16_t partitions_2[64] = {
    0xCCCC, 0x8888, 0xEEEE, 0xECC8, 0xC880, 0xFEEC, 0xFEC8, 0xEC80, 0xC800, 0xFFEC, 0xFE80,
    0xE800, 0xFFE8, 0xFF00, 0xFFF0, 0xF000, 0xF710, 0x008E, 0x7100, 0x08CE, 0x008C, 0x7310,
    0x3100, 0x8CCE, 0x088C, 0x3110, 0x6666, 0x366C, 0x17E8, 0x0FF0, 0x718E, 0x399C, 0xAAAA,
    0xF0F0, 0x5A5A, 0x33CC, 0x3C3C, 0x55AA, 0x9696, 0xA55A, 0x73CE, 0x13C8, 0x324C, 0x3BDC,
    0x6996, 0xC33C, 0x9966, 0x0660, 0x0272, 0x04E4, 0x4E40, 0x2720, 0xC936, 0x936C, 0x39C6,
    0x639C, 0x9336, 0x9CC6, 0x817E, 0xE718, 0xCCF0, 0x0FCC, 0x7744, 0xEE22};

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

/// The texels whose index lacks its highest bit, which is 0: of the second of two subsets, and of
/// the second and third of three. That of the first subset is texel 0.
constexpr std::uint8_t anchors_2[64] = {
    15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 2,  8, 2, 2, 8,
    8,  15, 2,  8,  2,  2,  8,  8,  2,  2,  15, 15, 6,  8,  2,  8,  15, 15, 2, 8, 2, 2,
    2,  15, 15, 6,  6,  2,  6,  8,  15, 15, 2,  2,  15, 15, 15, 15, 15, 2,  2, 15};
constexpr std::uint8_t second_anchors_3[64] = {
    3,  3,  15, 15, 8, 3,  15, 15, 8,  8,  6, 6,  6, 5,  3, 3,  3,  3,  8,  15, 3,  3,
    6,  10, 5,  8,  8, 6,  8,  5,  15, 15, 8, 15, 3, 5,  6, 10, 8,  15, 15, 3,  15, 5,
    15, 15, 15, 15, 3, 15, 5,  5,  5,  8,  5, 10, 5, 10, 8, 13, 15, 12, 3,  3};
constexpr std::uint8_t third_anchors_3[64] = {
    15, 8, 8, 3,  15, 15, 3,  8,  15, 15, 15, 15, 15, 15, 15, 8,  15, 8,  15, 3,  15, 8,
    15, 8, 3, 15, 6,  10, 15, 15, 10, 8,  15, 3,  15, 10, 10, 8,  9,  10, 6,  15, 8,  15,
    3,  6, 6, 8,  15, 3,  15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 3,  15, 15, 8};

// Decoding.

class BitReader {
  public:
    explicit BitReader(const std::byte* block) {
        for (std::size_t i = 0; i < block_size; ++i)
            words_[i / 8] |= std::to_integer<std::uint64_t>(block[i]) << (8 * (i % 8));
    }

    unsigned read(unsigned count) {
        unsigned value = 0;
        for (unsigned i = 0; i < count; ++i, ++next_)
            value |= static_cast<unsigned>(words_[next_ / 64] >> (next_ % 64) & 1U) << i;
        return value;
    }

  private:
    std::array<std::uint64_t, 2> words_{};
    unsigned next_ = 0;
};

unsigned subset_of(unsigned subsets, unsigned partition, unsigned texel) {
    if (subsets == 1) return 0;
    if (subsets == 2) return partitions_2[partition] >> texel & 1U;
    return partitions_3[partition] >> (2 * texel) & 3U;
}

bool is_anchor(unsigned subsets, unsigned partition, unsigned texel) {
    if (texel == 0) return true;
    if (subsets == 2) return texel == anchors_2[partition];
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
using BlockColors = std::array<BlockColor, block_texels>;

BlockColors decode_bc7_block(const std::byte* block) {
    BlockColors colors{};
    BitReader bits(block);
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
    std::array<unsigned, block_texels> first{};
    std::array<unsigned, block_texels> second{};
    for (unsigned t = 0; t < block_texels; ++t)
        first[t] = bits.read(mode.index_bits - (is_anchor(mode.subsets, partition, t) ? 1 : 0));
    if (mode.second_index_bits > 0) {
        for (unsigned t = 0; t < block_texels; ++t)
            second[t] = bits.read(mode.second_index_bits - (t == 0 ? 1 : 0));
    }
    for (unsigned t = 0; t < block_texels; ++t) {
        const unsigned end = 2 * subset_of(mode.subsets, partition, t);
        const unsigned first_weight = weight_of(first[t], mode.index_bits);
        unsigned color_weight = first_weight;
        unsigned alpha_weight = first_weight;
        if (mode.second_index_bits > 0) {
            const unsigned second_weight = weight_of(second[t], mode.second_index_bits);
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

// Encoding.

class BitWriter {
  public:
    void write(unsigned value, unsigned count) {
        for (unsigned i = 0; i < count; ++i, ++next_)
            words_[next_ / 64] |= static_cast<std::uint64_t>(value >> i & 1U) << (next_ % 64);
    }
    void store(std::byte* block) const {
        for (std::size_t i = 0; i < block_size; ++i)
            block[i] = static_cast<std::byte>(words_[i / 8] >> (8 * (i % 8)) & 255U);
    }

  private:
    std::array<std::uint64_t, 2> words_{};
    unsigned next_ = 0;
};

using ColorPoint = std::array<float, 4>;

/// The exact colors of a block, from 0 to 255.
using BlockPoints = std::array<ColorPoint, block_texels>;

/// A line between two endpoints, not rounded. Channels from `channels` on are not used.
struct ColorLine {
    ColorPoint first{}, second{};
};

/// Integer endpoints with their indices.
struct LineCodes {
    std::array<std::array<unsigned, 4>, 2> ends{};  ///< Without parity.
    std::array<unsigned, 2> parity{};
    std::array<unsigned, block_texels> index{};
    std::array<float, block_texels> weight{};  ///< Of the second endpoint.
    float error = 1e30F;
};

float clamped_code(float value) {
    return value > 0.0F ? (value < 255.0F ? value : 255.0F) : 0.0F;
}

/// The line through the mean along the direction of largest variance, as long as the colors.
template <std::size_t channels>
ColorLine principal_line(const BlockPoints& points) {
    ColorPoint mean{};
    for (std::size_t c = 0; c < channels; ++c) {
        for (const ColorPoint& point : points)
            mean[c] += point[c];
        mean[c] /= 16.0F;
    }
    float covariance[4][4] = {};
    for (const ColorPoint& point : points) {
        for (std::size_t a = 0; a < channels; ++a) {
            for (std::size_t b = 0; b < channels; ++b)
                covariance[a][b] += (point[a] - mean[a]) * (point[b] - mean[b]);
        }
    }
    // Power iteration, from the row of the largest variance.
    std::size_t largest = 0;
    for (std::size_t c = 1; c < channels; ++c) {
        if (covariance[c][c] > covariance[largest][largest]) largest = c;
    }
    ColorPoint axis{};
    for (std::size_t c = 0; c < channels; ++c)
        axis[c] = covariance[largest][c];
    for (int round = 0; round < 6; ++round) {
        ColorPoint next{};
        float size = 0.0F;
        for (std::size_t a = 0; a < channels; ++a) {
            for (std::size_t b = 0; b < channels; ++b)
                next[a] += covariance[a][b] * axis[b];
            size = std::max(size, std::abs(next[a]));
        }
        if (!(size > 1e-12F)) break;
        for (std::size_t c = 0; c < channels; ++c)
            axis[c] = next[c] / size;
    }
    float squares = 0.0F;
    for (std::size_t c = 0; c < channels; ++c)
        squares += axis[c] * axis[c];
    if (!(squares > 1e-12F)) return {mean, mean};
    float least = 0.0F;
    float greatest = 0.0F;
    for (const ColorPoint& point : points) {
        float along = 0.0F;
        for (std::size_t c = 0; c < channels; ++c)
            along += axis[c] * (point[c] - mean[c]);
        along /= squares;
        least = std::min(least, along);
        greatest = std::max(greatest, along);
    }
    ColorLine line;
    for (std::size_t c = 0; c < channels; ++c) {
        line.first[c] = clamped_code(mean[c] + least * axis[c]);
        line.second[c] = clamped_code(mean[c] + greatest * axis[c]);
    }
    return line;
}

/// Chooses the index of each texel, and computes the squared error. The colors of a line are nearly
/// evenly spaced: of more than 4, only the one at the projection of a texel and its neighbors are
/// compared. Measured errors are the same in three digits as with all colors.
template <std::size_t channels, std::size_t levels>
void choose_indices(const BlockPoints& points, const std::array<std::array<unsigned, 4>, 2>& ends,
                    const std::array<std::uint8_t, levels>& weights, LineCodes& codes) {
    std::array<ColorPoint, levels> palette{};
    for (std::size_t i = 0; i < levels; ++i) {
        for (std::size_t c = 0; c < channels; ++c)
            palette[i][c] = static_cast<float>(color_between(ends[0][c], ends[1][c], weights[i]));
    }
    ColorPoint direction{};
    float squares = 0.0F;
    for (std::size_t c = 0; c < channels; ++c) {
        direction[c] = palette[levels - 1][c] - palette[0][c];
        squares += direction[c] * direction[c];
    }
    const float scale = squares > 0.0F ? (static_cast<float>(levels) - 1.0F) / squares : 0.0F;
    codes.error = 0.0F;
    for (std::size_t t = 0; t < block_texels; ++t) {
        const ColorPoint& point = points[t];
        unsigned begin = 0;
        unsigned end = levels;
        if constexpr (levels > 4) {
            float along = 0.0F;
            for (std::size_t c = 0; c < channels; ++c)
                along += direction[c] * (point[c] - palette[0][c]);
            const float place = std::clamp(along * scale, 0.0F, static_cast<float>(levels - 1));
            const auto nearest = static_cast<unsigned>(place + 0.5F);
            begin = nearest > 0 ? nearest - 1 : 0;
            end = std::min<unsigned>(nearest + 2, levels);
        }
        unsigned best = begin;
        float least = 1e30F;
        for (unsigned i = begin; i < end; ++i) {
            float error = 0.0F;
            for (std::size_t c = 0; c < channels; ++c) {
                const float difference = point[c] - palette[i][c];
                error += difference * difference;
            }
            if (error < least) {
                least = error;
                best = i;
            }
        }
        codes.index[t] = best;
        codes.weight[t] = static_cast<float>(weights[best]) / 64.0F;
        codes.error += least;
    }
}

/// The endpoints that are best for the indices, by least squares.
template <std::size_t channels>
ColorLine refitted(const BlockPoints& points, const LineCodes& codes, const ColorLine& line) {
    float first_squares = 0.0F;
    float products = 0.0F;
    float second_squares = 0.0F;
    ColorPoint first_sum{}, second_sum{};
    for (std::size_t t = 0; t < block_texels; ++t) {
        const float second = codes.weight[t];
        const float first = 1.0F - second;
        first_squares += first * first;
        products += first * second;
        second_squares += second * second;
        for (std::size_t c = 0; c < channels; ++c) {
            first_sum[c] += first * points[t][c];
            second_sum[c] += second * points[t][c];
        }
    }
    const float determinant = first_squares * second_squares - products * products;
    if (!(determinant > 1e-3F)) return line;
    ColorLine result;
    for (std::size_t c = 0; c < channels; ++c) {
        result.first[c] =
            clamped_code((second_squares * first_sum[c] - products * second_sum[c]) / determinant);
        result.second[c] =
            clamped_code((first_squares * second_sum[c] - products * first_sum[c]) / determinant);
    }
    return result;
}

/// Rounds an endpoint to 8 bits of which the lowest is `parity` in all channels.
std::array<unsigned, 4> rounded_with_parity(const ColorPoint& point, unsigned parity) {
    std::array<unsigned, 4> codes{};
    for (std::size_t c = 0; c < 4; ++c) {
        const float half = (point[c] - static_cast<float>(parity)) / 2.0F + 0.5F;
        codes[c] = static_cast<unsigned>(std::clamp(static_cast<int>(half), 0, 127));
    }
    return codes;
}

int rounds_of(BlockQuality quality) {
    if (quality == BlockQuality::fast) return 1;
    return quality == BlockQuality::normal ? 3 : 6;
}

LineCodes encode_mode_6(const BlockPoints& points, BlockQuality quality) {
    ColorLine line = principal_line<4>(points);
    LineCodes best;
    const int rounds = rounds_of(quality);
    for (int round = 0; round < rounds; ++round) {
        LineCodes best_of_round;
        for (unsigned parities = 0; parities < 4; ++parities) {
            LineCodes codes;
            codes.parity = {parities & 1U, parities >> 1U};
            codes.ends = {rounded_with_parity(line.first, codes.parity[0]),
                          rounded_with_parity(line.second, codes.parity[1])};
            auto ends = codes.ends;
            for (std::size_t end = 0; end < 2; ++end) {
                for (unsigned& code : ends[end])
                    code = code << 1U | codes.parity[end];
            }
            choose_indices<4>(points, ends, weights_4, codes);
            if (codes.error < best_of_round.error) best_of_round = codes;
        }
        if (best_of_round.error < best.error) best = best_of_round;
        line = refitted<4>(points, best_of_round, line);
    }
    return best;
}

/// Rounds an endpoint of mode 5: colors have 7 bits, a single channel has 8.
std::array<unsigned, 4> rounded_to(const ColorPoint& point, std::size_t channels) {
    std::array<unsigned, 4> codes{};
    const float scale = channels == 1 ? 1.0F : 127.0F / 255.0F;
    for (std::size_t c = 0; c < channels; ++c)
        codes[c] = static_cast<unsigned>(point[c] * scale + 0.5F);
    return codes;
}

/// Fits a line of mode 5: three color channels, or one.
template <std::size_t channels>
LineCodes encode_mode_5_line(const BlockPoints& points, BlockQuality quality) {
    ColorLine line = principal_line<channels>(points);
    LineCodes best;
    const int rounds = rounds_of(quality);
    for (int round = 0; round < rounds; ++round) {
        LineCodes codes;
        codes.ends = {rounded_to(line.first, channels), rounded_to(line.second, channels)};
        auto ends = codes.ends;
        for (auto& end : ends) {
            for (std::size_t c = 0; c < channels; ++c)
                end[c] = channels == 1 ? end[c] : widened(end[c], 7);
        }
        choose_indices<channels>(points, ends, weights_2, codes);
        if (codes.error < best.error) best = codes;
        line = refitted<channels>(points, codes, line);
    }
    return best;
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

/// The endpoints and indices of a line as they are stored, with index 0 in the lower half.
void make_storable(LineCodes& codes, unsigned levels) {
    if (codes.index[0] < levels / 2) return;
    std::swap(codes.ends[0], codes.ends[1]);
    std::swap(codes.parity[0], codes.parity[1]);
    for (unsigned& index : codes.index)
        index = levels - 1 - index;
}

void store_mode_6(LineCodes codes, std::byte* block) {
    make_storable(codes, 16);
    BitWriter bits;
    bits.write(1U << 6U, 7);
    for (std::size_t c = 0; c < 4; ++c) {
        for (const auto& end : codes.ends)
            bits.write(end[c], 7);
    }
    for (const unsigned parity : codes.parity)
        bits.write(parity, 1);
    for (std::size_t t = 0; t < block_texels; ++t)
        bits.write(codes.index[t], t == 0 ? 3 : 4);
    bits.store(block);
}

void store_mode_5(LineCodes color, LineCodes single, unsigned rotation, std::byte* block) {
    make_storable(color, 4);
    make_storable(single, 4);
    BitWriter bits;
    bits.write(1U << 5U, 6);
    bits.write(rotation, 2);
    for (std::size_t c = 0; c < 3; ++c) {
        for (const auto& end : color.ends)
            bits.write(end[c], 7);
    }
    for (const auto& end : single.ends)
        bits.write(end[0], 8);
    for (const LineCodes& line : {color, single}) {
        for (std::size_t t = 0; t < block_texels; ++t)
            bits.write(line.index[t], t == 0 ? 1 : 2);
    }
    bits.store(block);
}

/// A block whose texels all have the same color, rounded to 8 bits.
void store_single_color(const ColorPoint& point, std::byte* block) {
    LineCodes color, single;
    for (std::size_t c = 0; c < 3; ++c) {
        const auto& pair = exact_codes.pair[static_cast<std::size_t>(point[c] + 0.5F)];
        color.ends[0][c] = pair[0];
        color.ends[1][c] = pair[1];
    }
    color.index.fill(1);
    single.ends[0][0] = single.ends[1][0] = static_cast<unsigned>(point[3] + 0.5F);
    store_mode_5(color, single, 0, block);
}

void encode_bc7_block(const BlockPoints& points, BlockQuality quality, std::byte* block) {
    const bool is_single = std::all_of(points.begin(), points.end(),
                                       [&](const ColorPoint& point) { return point == points[0]; });
    if (is_single) return store_single_color(points[0], block);
    const LineCodes mode_6 = encode_mode_6(points, quality);
    float best_error = mode_6.error;
    store_mode_6(mode_6, block);
    if (quality == BlockQuality::fast) return;
    for (unsigned rotation = 0; rotation < 4; ++rotation) {
        BlockPoints rotated = points;
        BlockPoints alone{};
        for (std::size_t t = 0; t < block_texels; ++t) {
            if (rotation > 0) std::swap(rotated[t][3], rotated[t][rotation - 1]);
            alone[t][0] = rotated[t][3];
        }
        const LineCodes single = encode_mode_5_line<1>(alone, quality);
        if (single.error >= best_error) continue;
        const LineCodes color = encode_mode_5_line<3>(rotated, quality);
        if (color.error + single.error >= best_error) continue;
        best_error = color.error + single.error;
        store_mode_5(color, single, rotation, block);
    }
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

template <typename Sample>
void encode_bc7_rows(const ImageView& image, BlockQuality quality, std::size_t begin,
                     std::size_t end, std::vector<std::byte>& blocks, Report& report) {
    const int columns = (image.width + 3) / 4;
    const int last_x = image.width - 1;
    const int last_y = image.height - 1;
    for (std::size_t row = begin; row < end; ++row) {
        for (int column = 0; column < columns; ++column) {
            BlockPoints points;
            for (int t = 0; t < 16; ++t) {
                const int place_x = 4 * column + t % 4;
                const int place_y = 4 * static_cast<int>(row) + t / 4;
                const int x = std::min(place_x, last_x);
                const int y = std::min(place_y, last_y);
                const Sample* const sample =
                    image.row<Sample>(y) + static_cast<std::ptrdiff_t>(x) * image.channels;
                ColorPoint& point = points[static_cast<std::size_t>(t)];
                point[3] = 255.0F;
                bool all_finite = true;
                for (int c = 0; c < image.channels; ++c) {
                    bool is_finite = true;
                    point[static_cast<std::size_t>(c)] = exact_code(sample[c], is_finite);
                    all_finite = all_finite && is_finite;
                }
                if (!all_finite && x == place_x && y == place_y) {
                    report.add("sample that is not finite", "texel",
                               static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                   static_cast<std::size_t>(x),
                               "stored as 0");
                }
            }
            const std::size_t index =
                row * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
            encode_bc7_block(points, quality, &blocks[index * block_size]);
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
            const BlockColors colors = decode_bc7_block(&blocks[i * block_size]);
            for (std::size_t t = 0; t < block_texels; ++t) {
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
