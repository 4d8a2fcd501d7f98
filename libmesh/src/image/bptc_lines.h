// SPDX-License-Identifier: Apache-2.0
/// \file
/// Lines through colors and partitions, for the searches for encodings of BC6H and BC7: the colors
/// of a subset of texels lie on a line, which is fitted to exact colors, and one of 64 partitions
/// divides the texels. 32 blocks are processed at once, one per vector lane.
/// Source: [Khronos Data Format], section BPTC.
#pragma once

#include <cstddef>
#include <cstdint>

#include "portable_math.h"

namespace relief::detail {

/// Partitions into two subsets: bit t is the subset of texel t.
inline constexpr std::uint16_t bptc_partitions_2[64] = {
    0xCCCC, 0x8888, 0xEEEE, 0xECC8, 0xC880, 0xFEEC, 0xFEC8, 0xEC80, 0xC800, 0xFFEC, 0xFE80,
    0xE800, 0xFFE8, 0xFF00, 0xFFF0, 0xF000, 0xF710, 0x008E, 0x7100, 0x08CE, 0x008C, 0x7310,
    0x3100, 0x8CCE, 0x088C, 0x3110, 0x6666, 0x366C, 0x17E8, 0x0FF0, 0x718E, 0x399C, 0xAAAA,
    0xF0F0, 0x5A5A, 0x33CC, 0x3C3C, 0x55AA, 0x9696, 0xA55A, 0x73CE, 0x13C8, 0x324C, 0x3BDC,
    0x6996, 0xC33C, 0x9966, 0x0660, 0x0272, 0x04E4, 0x4E40, 0x2720, 0xC936, 0x936C, 0x39C6,
    0x639C, 0x9336, 0x9CC6, 0x817E, 0xE718, 0xCCF0, 0x0FCC, 0x7744, 0xEE22};

/// The texel whose index lacks its highest bit, which is 0, of the second of two subsets. That of
/// the first subset is texel 0.
inline constexpr std::uint8_t bptc_anchors_2[64] = {
    15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 2,  8, 2, 2, 8,
    8,  15, 2,  8,  2,  2,  8,  8,  2,  2,  15, 15, 6,  8,  2,  8,  15, 15, 2, 8, 2, 2,
    2,  15, 15, 6,  6,  2,  6,  8,  15, 15, 2,  2,  15, 15, 15, 15, 15, 2,  2, 15};

inline constexpr std::size_t bptc_texels = 16;

/// The number of blocks that are encoded at once. It is more than 16, because GCC unrolls loops of
/// up to 16 steps before it could vectorize them.
inline constexpr std::size_t bptc_lanes = 32;

/// One number for each block.
struct alignas(64) BptcLanes {
    float value[bptc_lanes];

    float& operator[](std::size_t lane) { return value[lane]; }
    float operator[](std::size_t lane) const { return value[lane]; }
    void fill(float number) {
        for (float& one : value)
            one = number;
    }
};

/// One number for each texel of each block.
struct BptcTexels {
    BptcLanes texel[bptc_texels];

    BptcLanes& operator[](std::size_t t) { return texel[t]; }
    const BptcLanes& operator[](std::size_t t) const { return texel[t]; }
};

/// The channels of a line, in any order.
template <std::size_t channels>
struct ChannelSet {
    const BptcTexels* channel[channels];

    const BptcTexels& operator[](std::size_t c) const { return *channel[c]; }
};

/// Rounds to the nearest integer. Values are below 2^22.
RELIEF_INLINE float nearest_integer(float value) {
    constexpr float shift = 12582912.0F;  // 1.5 * 2^23: its sums have no fraction.
    return (value + shift) - shift;
}

/// Rounds multiples of 1/64 down.
RELIEF_INLINE float rounded_down(float value) {
    return nearest_integer(value - 0.4921875F);
}

RELIEF_INLINE float limited(float value, float least, float greatest) {
    const float raised = value < least ? least : value;
    return raised > greatest ? greatest : raised;
}

/// A line between two endpoints, not rounded.
template <std::size_t channels>
struct RealLine {
    BptcLanes ends[2][channels];
};

/// The range of endpoints.
struct EndRange {
    float least, greatest;
};

/// Starts a power iteration: chooses the row of the largest variance.
template <std::size_t channels>
RELIEF_INLINE void choose_row(const BptcLanes (&covariance)[channels][channels],
                              BptcLanes (&axis)[channels]) {
    for (std::size_t k = 0; k < channels; ++k)
        axis[k] = covariance[0][k];
    BptcLanes largest = covariance[0][0];
    for (std::size_t c = 1; c < channels; ++c) {
        for (std::size_t lane = 0; lane < bptc_lanes; ++lane) {
            const bool is_larger = covariance[c][c][lane] > largest[lane];
            largest[lane] = is_larger ? covariance[c][c][lane] : largest[lane];
            for (std::size_t k = 0; k < channels; ++k)
                axis[k][lane] = is_larger ? covariance[c][k][lane] : axis[k][lane];
        }
    }
}

/// The line through the mean along the direction of largest variance, as long as the colors; its
/// endpoints are limited to a range.
/// \param weight  1 for the texels of the subset, else 0
template <std::size_t channels>
RELIEF_INLINE void fit_principal_line(const ChannelSet<channels>& values, const BptcTexels& weight,
                                      const EndRange& range, RealLine<channels>& line) {
    BptcLanes count;
    count.fill(0.0F);
    for (std::size_t t = 0; t < bptc_texels; ++t) {
        for (std::size_t lane = 0; lane < bptc_lanes; ++lane)
            count[lane] += weight[t][lane];
    }
    BptcLanes mean[channels];
    BptcTexels centered[channels];
    for (std::size_t c = 0; c < channels; ++c) {
        mean[c].fill(0.0F);
        for (std::size_t t = 0; t < bptc_texels; ++t) {
            for (std::size_t lane = 0; lane < bptc_lanes; ++lane)
                mean[c][lane] += weight[t][lane] * values[c][t][lane];
        }
        for (std::size_t lane = 0; lane < bptc_lanes; ++lane)
            mean[c][lane] /= count[lane] > 1.0F ? count[lane] : 1.0F;
        for (std::size_t t = 0; t < bptc_texels; ++t) {
            for (std::size_t lane = 0; lane < bptc_lanes; ++lane) {
                centered[c][t][lane] = weight[t][lane] * (values[c][t][lane] - mean[c][lane]);
            }
        }
    }
    BptcLanes covariance[channels][channels];
    for (std::size_t a = 0; a < channels; ++a) {
        for (std::size_t b = a; b < channels; ++b) {
            BptcLanes sum;
            sum.fill(0.0F);
            for (std::size_t t = 0; t < bptc_texels; ++t) {
                for (std::size_t lane = 0; lane < bptc_lanes; ++lane)
                    sum[lane] += centered[a][t][lane] * centered[b][t][lane];
            }
            covariance[a][b] = sum;
            covariance[b][a] = sum;
        }
    }
    BptcLanes axis[channels];
    choose_row<channels>(covariance, axis);
    for (int round = 0; round < 5; ++round) {
        BptcLanes next[channels];
        for (std::size_t lane = 0; lane < bptc_lanes; ++lane) {
            float size = 1e-12F;
            for (std::size_t a = 0; a < channels; ++a) {
                float sum = 0.0F;
                for (std::size_t b = 0; b < channels; ++b)
                    sum += covariance[a][b][lane] * axis[b][lane];
                next[a][lane] = sum;
                const float magnitude = sum < 0.0F ? -sum : sum;
                size = magnitude > size ? magnitude : size;
            }
            for (std::size_t c = 0; c < channels; ++c)
                axis[c][lane] = next[c][lane] / size;
        }
    }
    BptcLanes least, greatest, squares;
    least.fill(0.0F);
    greatest.fill(0.0F);
    for (std::size_t lane = 0; lane < bptc_lanes; ++lane) {
        float sum = 0.0F;
        for (std::size_t c = 0; c < channels; ++c)
            sum += axis[c][lane] * axis[c][lane];
        squares[lane] = sum > 1e-12F ? sum : 1.0F;
    }
    for (std::size_t t = 0; t < bptc_texels; ++t) {
        for (std::size_t lane = 0; lane < bptc_lanes; ++lane) {
            float along = 0.0F;
            for (std::size_t c = 0; c < channels; ++c)
                along += axis[c][lane] * centered[c][t][lane];
            least[lane] = along < least[lane] ? along : least[lane];
            greatest[lane] = along > greatest[lane] ? along : greatest[lane];
        }
    }
    for (std::size_t c = 0; c < channels; ++c) {
        for (std::size_t lane = 0; lane < bptc_lanes; ++lane) {
            const float step = axis[c][lane] / squares[lane];
            line.ends[0][c][lane] =
                limited(mean[c][lane] + least[lane] * step, range.least, range.greatest);
            line.ends[1][c][lane] =
                limited(mean[c][lane] + greatest[lane] * step, range.least, range.greatest);
        }
    }
}

/// The endpoints that are best for the indices, by least squares, limited to a range.
template <std::size_t channels, int steps>
RELIEF_INLINE void refit_line(const ChannelSet<channels>& values, const BptcTexels& weight,
                              const BptcTexels& index, const EndRange& range,
                              RealLine<channels>& line) {
    BptcLanes first_squares, products, second_squares;
    BptcLanes first_sum[channels], second_sum[channels];
    first_squares.fill(0.0F);
    products.fill(0.0F);
    second_squares.fill(0.0F);
    for (std::size_t c = 0; c < channels; ++c) {
        first_sum[c].fill(0.0F);
        second_sum[c].fill(0.0F);
    }
    for (std::size_t t = 0; t < bptc_texels; ++t) {
        for (std::size_t lane = 0; lane < bptc_lanes; ++lane) {
            const float second = index[t][lane] * (1.0F / static_cast<float>(steps));
            const float first = 1.0F - second;
            const float counted_first = weight[t][lane] * first;
            const float counted_second = weight[t][lane] * second;
            first_squares[lane] += counted_first * first;
            products[lane] += counted_first * second;
            second_squares[lane] += counted_second * second;
            for (std::size_t c = 0; c < channels; ++c) {
                first_sum[c][lane] += counted_first * values[c][t][lane];
                second_sum[c][lane] += counted_second * values[c][t][lane];
            }
        }
    }
    for (std::size_t lane = 0; lane < bptc_lanes; ++lane) {
        const float determinant =
            first_squares[lane] * second_squares[lane] - products[lane] * products[lane];
        const bool is_usable = determinant > 1e-3F;
        const float divisor = is_usable ? determinant : 1.0F;
        for (std::size_t c = 0; c < channels; ++c) {
            const float first =
                (second_squares[lane] * first_sum[c][lane] - products[lane] * second_sum[c][lane]) /
                divisor;
            const float second =
                (first_squares[lane] * second_sum[c][lane] - products[lane] * first_sum[c][lane]) /
                divisor;
            line.ends[0][c][lane] =
                is_usable ? limited(first, range.least, range.greatest) : line.ends[0][c][lane];
            line.ends[1][c][lane] =
                is_usable ? limited(second, range.least, range.greatest) : line.ends[1][c][lane];
        }
    }
}

// Partitions.

inline constexpr std::size_t max_partitions = 16;

/// The partitions of a block with the smallest variance beside the lines of both subsets.
struct PartitionChoice {
    BptcLanes number[max_partitions], score[max_partitions];
};

/// Sums of values and of their products over the texels of a subset.
template <std::size_t channels>
struct SubsetSums {
    static constexpr std::size_t count = channels + channels * (channels + 1) / 2;
    BptcLanes sum[count];  ///< Of each channel; of the products (a, b) with a <= b.
};

/// Terms of such sums of each texel, followed by zeros.
struct SumTerms {
    BptcLanes texel[bptc_texels + 1];
};

/// Adds the variance beside the line to scores: the trace less the largest eigenvalue, by power
/// iteration. \param texels  number of texels of the subset
template <std::size_t channels>
RELIEF_INLINE void add_rest_of_line(const SubsetSums<channels>& sums, float texels,
                                    BptcLanes& score) {
    const float inverse = 1.0F / texels;
    BptcLanes covariance[channels][channels];
    std::size_t next_sum = channels;
    for (std::size_t a = 0; a < channels; ++a) {
        for (std::size_t b = a; b < channels; ++b, ++next_sum) {
            for (std::size_t lane = 0; lane < bptc_lanes; ++lane) {
                const float product = sums.sum[a][lane] * sums.sum[b][lane];
                covariance[a][b][lane] = sums.sum[next_sum][lane] - product * inverse;
            }
            covariance[b][a] = covariance[a][b];
        }
    }
    BptcLanes axis[channels];
    choose_row<channels>(covariance, axis);
    for (std::size_t lane = 0; lane < bptc_lanes; ++lane) {
        float next[channels];
        float trace = 0.0F;
        float squares = 1e-12F;
        for (std::size_t a = 0; a < channels; ++a) {
            float value = 0.0F;
            for (std::size_t b = 0; b < channels; ++b)
                value += covariance[a][b][lane] * axis[b][lane];
            next[a] = value;
            squares += value * value;
            trace += covariance[a][a][lane];
        }
        float along = 0.0F;
        for (std::size_t a = 0; a < channels; ++a) {
            float value = 0.0F;
            for (std::size_t b = 0; b < channels; ++b)
                value += covariance[a][b][lane] * next[b];
            along += value * next[a];
        }
        score[lane] += trace - along / squares;
    }
}

/// Inserts a partition where its score belongs.
RELIEF_INLINE void insert_partition(std::size_t partition, BptcLanes& score, std::size_t wanted,
                                    PartitionChoice& choice) {
    BptcLanes number;
    number.fill(static_cast<float>(partition));
    for (std::size_t k = 0; k < wanted; ++k) {
        for (std::size_t lane = 0; lane < bptc_lanes; ++lane) {
            const float old_score = choice.score[k][lane];
            const float old_number = choice.number[k][lane];
            const bool is_better = score[lane] < old_score;
            choice.score[k][lane] = is_better ? score[lane] : old_score;
            choice.number[k][lane] = is_better ? number[lane] : old_number;
            score[lane] = is_better ? old_score : score[lane];
            number[lane] = is_better ? old_number : number[lane];
        }
    }
}

/// Adds the terms of four texels.
RELIEF_INLINE void add_four(const SumTerms& terms, const std::size_t* texels, BptcLanes& sum) {
    const BptcLanes& a = terms.texel[texels[0]];
    const BptcLanes& b = terms.texel[texels[1]];
    const BptcLanes& c = terms.texel[texels[2]];
    const BptcLanes& d = terms.texel[texels[3]];
    for (std::size_t lane = 0; lane < bptc_lanes; ++lane)
        sum[lane] += (a[lane] + b[lane]) + (c[lane] + d[lane]);
}

/// Chooses the best of the first partitions. \param tried  their number
template <std::size_t channels>
RELIEF_INLINE void choose_partitions(const ChannelSet<channels>& values, std::size_t tried,
                                     std::size_t wanted, PartitionChoice& choice) {
    constexpr std::size_t sum_count = SubsetSums<channels>::count;
    // Values from the first texel on, so that products are small; and products.
    SumTerms terms[sum_count];
    for (std::size_t c = 0; c < channels; ++c) {
        for (std::size_t t = 0; t < bptc_texels; ++t) {
            for (std::size_t lane = 0; lane < bptc_lanes; ++lane)
                terms[c].texel[t][lane] = values[c][t][lane] - values[c][0][lane];
        }
    }
    std::size_t next_term = channels;
    for (std::size_t a = 0; a < channels; ++a) {
        for (std::size_t b = a; b < channels; ++b, ++next_term) {
            for (std::size_t t = 0; t < bptc_texels; ++t) {
                for (std::size_t lane = 0; lane < bptc_lanes; ++lane) {
                    terms[next_term].texel[t][lane] =
                        terms[a].texel[t][lane] * terms[b].texel[t][lane];
                }
            }
        }
    }
    SubsetSums<channels> all;
    for (std::size_t i = 0; i < sum_count; ++i) {
        all.sum[i].fill(0.0F);
        for (std::size_t t = 0; t < bptc_texels; ++t) {
            for (std::size_t lane = 0; lane < bptc_lanes; ++lane)
                all.sum[i][lane] += terms[i].texel[t][lane];
        }
        terms[i].texel[bptc_texels].fill(0.0F);
    }
    for (std::size_t k = 0; k < wanted; ++k) {
        choice.number[k].fill(0.0F);
        choice.score[k].fill(1e30F);
    }
    for (std::size_t partition = 0; partition < tried; ++partition) {
        // The texels of the second subset, in groups of four: the last one is filled with zeros.
        std::size_t texels[bptc_texels + 4];
        std::size_t count = 0;
        for (std::size_t t = 0; t < bptc_texels; ++t) {
            texels[count] = t;
            count += bptc_partitions_2[partition] >> t & 1U;
        }
        for (std::size_t k = 0; k < 4; ++k)
            texels[count + k] = bptc_texels;
        SubsetSums<channels> first, second;
        for (std::size_t i = 0; i < sum_count; ++i) {
            second.sum[i].fill(0.0F);
            for (std::size_t k = 0; k < count; k += 4)
                add_four(terms[i], &texels[k], second.sum[i]);
            for (std::size_t lane = 0; lane < bptc_lanes; ++lane)
                first.sum[i][lane] = all.sum[i][lane] - second.sum[i][lane];
        }
        BptcLanes score;
        score.fill(0.0F);
        add_rest_of_line<channels>(first, static_cast<float>(bptc_texels - count), score);
        add_rest_of_line<channels>(second, static_cast<float>(count), score);
        insert_partition(partition, score, wanted, choice);
    }
}

}  // namespace relief::detail
