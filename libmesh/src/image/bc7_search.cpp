// SPDX-License-Identifier: Apache-2.0
// BC7: searches for the encoding of blocks with the least error, in modes 1, 3, 5, 6 and 7.
//
// The colors of a subset of texels lie on a line between two endpoints. Mode 6 has one subset, and
// all four channels share an index of 4 bits. In mode 5 one channel has its own index. Modes 1 and
// 3 (opaque) and 7 (with alpha) have two subsets, by one of 64 partitions: those with the smallest
// variance beside the lines of both subsets are tried. Encoding fits a line to the exact colors,
// rounds its endpoints, chooses indices, and fits again by least squares. Errors are computed from
// the decoded integers. 32 blocks are processed at once, one per vector lane, so results do not
// depend on the size of vector registers. Source: [Khronos Data Format], section BPTC.
#include <utility>

#include "image/bc7_format.h"
#include "portable_math.h"

namespace relief::detail {
namespace {

/// The channels of a line, in any order.
template <std::size_t channels>
struct ChannelSet {
    const Bc7Texels* channel[channels];

    const Bc7Texels& operator[](std::size_t c) const { return *channel[c]; }
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

// Endpoints.

/// The storage of endpoints: bits without parity, and whether there is a bit of parity below them.
struct EndCoding {
    int bits;
    bool has_parity;
    [[nodiscard]] constexpr int all_bits() const { return bits + (has_parity ? 1 : 0); }
};

/// Rounds a value to a stored number.
template <EndCoding coding>
RELIEF_INLINE float end_code(float value, float parity) {
    constexpr int all_bits = coding.all_bits();
    constexpr auto scale = static_cast<float>((1 << all_bits) - 1) / 255.0F;
    constexpr auto greatest = static_cast<float>((1 << coding.bits) - 1);
    if constexpr (coding.has_parity)
        return nearest_integer(limited((value * scale - parity) * 0.5F, 0.0F, greatest));
    return nearest_integer(limited(value * scale, 0.0F, greatest));
}

/// Returns the 8 bits of a stored number: the highest bits are repeated.
template <EndCoding coding>
RELIEF_INLINE float end_value(float code, float parity) {
    constexpr int all_bits = coding.all_bits();
    const float full = coding.has_parity ? 2.0F * code + parity : code;
    if constexpr (all_bits == 8) return full;
    constexpr auto high = static_cast<float>(1 << (8 - all_bits));
    constexpr auto low = static_cast<float>(1 << (2 * all_bits - 8));
    return high * full + rounded_down(full / low);
}

/// A line between two endpoints, not rounded.
template <std::size_t channels>
struct RealLine {
    Bc7Lanes ends[2][channels];
};

/// The stored numbers of a line, with the indices of the texels.
template <std::size_t channels>
struct LineFit {
    Bc7Lanes codes[2][channels];
    Bc7Lanes parity[2];
    Bc7Texels index;
    Bc7Lanes error;
};

// Fitting.

/// Starts a power iteration: chooses the row of the largest variance.
template <std::size_t channels>
RELIEF_INLINE void choose_row(const Bc7Lanes (&covariance)[channels][channels],
                              Bc7Lanes (&axis)[channels]) {
    for (std::size_t k = 0; k < channels; ++k)
        axis[k] = covariance[0][k];
    Bc7Lanes largest = covariance[0][0];
    for (std::size_t c = 1; c < channels; ++c) {
        for (std::size_t lane = 0; lane < bc7_lanes; ++lane) {
            const bool is_larger = covariance[c][c][lane] > largest[lane];
            largest[lane] = is_larger ? covariance[c][c][lane] : largest[lane];
            for (std::size_t k = 0; k < channels; ++k)
                axis[k][lane] = is_larger ? covariance[c][k][lane] : axis[k][lane];
        }
    }
}

/// The line through the mean along the direction of largest variance, as long as the colors.
/// \param weight  1 for the texels of the subset, else 0
template <std::size_t channels>
RELIEF_INLINE void fit_principal_line(const ChannelSet<channels>& values, const Bc7Texels& weight,
                                      RealLine<channels>& line) {
    Bc7Lanes count;
    count.fill(0.0F);
    for (std::size_t t = 0; t < bc7_texels; ++t) {
        for (std::size_t lane = 0; lane < bc7_lanes; ++lane)
            count[lane] += weight[t][lane];
    }
    Bc7Lanes mean[channels];
    Bc7Texels centered[channels];
    for (std::size_t c = 0; c < channels; ++c) {
        mean[c].fill(0.0F);
        for (std::size_t t = 0; t < bc7_texels; ++t) {
            for (std::size_t lane = 0; lane < bc7_lanes; ++lane)
                mean[c][lane] += weight[t][lane] * values[c][t][lane];
        }
        for (std::size_t lane = 0; lane < bc7_lanes; ++lane)
            mean[c][lane] /= count[lane] > 1.0F ? count[lane] : 1.0F;
        for (std::size_t t = 0; t < bc7_texels; ++t) {
            for (std::size_t lane = 0; lane < bc7_lanes; ++lane) {
                centered[c][t][lane] = weight[t][lane] * (values[c][t][lane] - mean[c][lane]);
            }
        }
    }
    Bc7Lanes covariance[channels][channels];
    for (std::size_t a = 0; a < channels; ++a) {
        for (std::size_t b = a; b < channels; ++b) {
            Bc7Lanes sum;
            sum.fill(0.0F);
            for (std::size_t t = 0; t < bc7_texels; ++t) {
                for (std::size_t lane = 0; lane < bc7_lanes; ++lane)
                    sum[lane] += centered[a][t][lane] * centered[b][t][lane];
            }
            covariance[a][b] = sum;
            covariance[b][a] = sum;
        }
    }
    Bc7Lanes axis[channels];
    choose_row<channels>(covariance, axis);
    for (int round = 0; round < 5; ++round) {
        Bc7Lanes next[channels];
        for (std::size_t lane = 0; lane < bc7_lanes; ++lane) {
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
    Bc7Lanes least, greatest, squares;
    least.fill(0.0F);
    greatest.fill(0.0F);
    for (std::size_t lane = 0; lane < bc7_lanes; ++lane) {
        float sum = 0.0F;
        for (std::size_t c = 0; c < channels; ++c)
            sum += axis[c][lane] * axis[c][lane];
        squares[lane] = sum > 1e-12F ? sum : 1.0F;
    }
    for (std::size_t t = 0; t < bc7_texels; ++t) {
        for (std::size_t lane = 0; lane < bc7_lanes; ++lane) {
            float along = 0.0F;
            for (std::size_t c = 0; c < channels; ++c)
                along += axis[c][lane] * centered[c][t][lane];
            least[lane] = along < least[lane] ? along : least[lane];
            greatest[lane] = along > greatest[lane] ? along : greatest[lane];
        }
    }
    for (std::size_t c = 0; c < channels; ++c) {
        for (std::size_t lane = 0; lane < bc7_lanes; ++lane) {
            const float step = axis[c][lane] / squares[lane];
            line.ends[0][c][lane] = limited(mean[c][lane] + least[lane] * step, 0.0F, 255.0F);
            line.ends[1][c][lane] = limited(mean[c][lane] + greatest[lane] * step, 0.0F, 255.0F);
        }
    }
}

/// Rounds a line, chooses the index of each texel, and computes the squared error. The colors of a
/// line are nearly evenly spaced: the index is that of the projection.
template <std::size_t channels, int steps, EndCoding coding>
RELIEF_INLINE void evaluate_line(const ChannelSet<channels>& values, const Bc7Texels& weight,
                                 const RealLine<channels>& line, LineFit<channels>& fit) {
    Bc7Lanes first[channels], direction[channels];
    Bc7Lanes scale;
    for (std::size_t lane = 0; lane < bc7_lanes; ++lane) {
        float squares = 0.0F;
        for (std::size_t c = 0; c < channels; ++c) {
            float rounded[2];
            for (std::size_t end = 0; end < 2; ++end) {
                const float code = end_code<coding>(line.ends[end][c][lane], fit.parity[end][lane]);
                fit.codes[end][c][lane] = code;
                rounded[end] = end_value<coding>(code, fit.parity[end][lane]);
            }
            first[c][lane] = rounded[0];
            direction[c][lane] = rounded[1] - rounded[0];
            squares += direction[c][lane] * direction[c][lane];
        }
        scale[lane] = squares > 0.0F ? static_cast<float>(steps) / squares : 0.0F;
    }
    fit.error.fill(0.0F);
    for (std::size_t t = 0; t < bc7_texels; ++t) {
        for (std::size_t lane = 0; lane < bc7_lanes; ++lane) {
            float along = 0.0F;
            for (std::size_t c = 0; c < channels; ++c)
                along += direction[c][lane] * (values[c][t][lane] - first[c][lane]);
            const float step =
                nearest_integer(limited(along * scale[lane], 0.0F, static_cast<float>(steps)));
            // The weights of the format, in 64ths.
            const float part = nearest_integer(step * (64.0F / static_cast<float>(steps)));
            float error = 0.0F;
            for (std::size_t c = 0; c < channels; ++c) {
                const float color = rounded_down(first[c][lane] +
                                                 direction[c][lane] * part * (1.0F / 64.0F) + 0.5F);
                const float rest = values[c][t][lane] - color;
                error += rest * rest;
            }
            fit.index[t][lane] = step;
            fit.error[lane] += weight[t][lane] * error;
        }
    }
}

/// The endpoints that are best for the indices, by least squares.
template <std::size_t channels, int steps>
RELIEF_INLINE void refit_line(const ChannelSet<channels>& values, const Bc7Texels& weight,
                              const LineFit<channels>& fit, RealLine<channels>& line) {
    Bc7Lanes first_squares, products, second_squares;
    Bc7Lanes first_sum[channels], second_sum[channels];
    first_squares.fill(0.0F);
    products.fill(0.0F);
    second_squares.fill(0.0F);
    for (std::size_t c = 0; c < channels; ++c) {
        first_sum[c].fill(0.0F);
        second_sum[c].fill(0.0F);
    }
    for (std::size_t t = 0; t < bc7_texels; ++t) {
        for (std::size_t lane = 0; lane < bc7_lanes; ++lane) {
            const float second = fit.index[t][lane] * (1.0F / static_cast<float>(steps));
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
    for (std::size_t lane = 0; lane < bc7_lanes; ++lane) {
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
                is_usable ? limited(first, 0.0F, 255.0F) : line.ends[0][c][lane];
            line.ends[1][c][lane] =
                is_usable ? limited(second, 0.0F, 255.0F) : line.ends[1][c][lane];
        }
    }
}

/// Replaces the fit of each block by another one if that has a smaller error.
template <std::size_t channels>
RELIEF_INLINE void keep_better(const LineFit<channels>& other, LineFit<channels>& fit) {
    for (std::size_t lane = 0; lane < bc7_lanes; ++lane) {
        const bool is_better = other.error[lane] < fit.error[lane];
        for (std::size_t end = 0; end < 2; ++end) {
            for (std::size_t c = 0; c < channels; ++c) {
                fit.codes[end][c][lane] =
                    is_better ? other.codes[end][c][lane] : fit.codes[end][c][lane];
            }
            fit.parity[end][lane] = is_better ? other.parity[end][lane] : fit.parity[end][lane];
        }
        for (std::size_t t = 0; t < bc7_texels; ++t)
            fit.index[t][lane] = is_better ? other.index[t][lane] : fit.index[t][lane];
        fit.error[lane] = is_better ? other.error[lane] : fit.error[lane];
    }
}

enum class Parity { none, of_ends, of_subset };

/// Sets the parity of each endpoint that rounds its channels best.
template <std::size_t channels, EndCoding coding>
RELIEF_INLINE void choose_parities(const RealLine<channels>& line, bool is_shared,
                                   LineFit<channels>& fit) {
    for (std::size_t lane = 0; lane < bc7_lanes; ++lane) {
        float gain[2] = {};
        for (std::size_t end = 0; end < 2; ++end) {
            for (std::size_t c = 0; c < channels; ++c) {
                const float value = line.ends[end][c][lane];
                const float even = end_value<coding>(end_code<coding>(value, 0.0F), 0.0F) - value;
                const float odd = end_value<coding>(end_code<coding>(value, 1.0F), 1.0F) - value;
                gain[end] += even * even - odd * odd;
            }
        }
        const float both = gain[0] + gain[1];
        for (std::size_t end = 0; end < 2; ++end)
            fit.parity[end][lane] = (is_shared ? both : gain[end]) > 0.0F ? 1.0F : 0.0F;
    }
}

struct SearchEffort {
    int rounds;           ///< Of fitting.
    int thorough_rounds;  ///< Of these, the last ones try all parities.
    std::size_t partitions;
};

constexpr SearchEffort effort_of(BlockQuality quality) {
    if (quality == BlockQuality::fast) return {2, 1, 1};
    if (quality == BlockQuality::normal) return {2, 1, 2};
    return {4, 3, 6};
}

/// Fits a line to the texels of a subset.
template <std::size_t channels, int steps, EndCoding coding, Parity parity>
RELIEF_INLINE void search_line(const ChannelSet<channels>& values, const Bc7Texels& weight,
                               const SearchEffort& effort, LineFit<channels>& best) {
    RealLine<channels> line;
    fit_principal_line<channels>(values, weight, line);
    best.error.fill(1e30F);
    constexpr int all_parities = parity == Parity::none ? 1 : parity == Parity::of_subset ? 2 : 4;
    for (int round = 0; round < effort.rounds; ++round) {
        const bool tries_all = round >= effort.rounds - effort.thorough_rounds;
        const int tries = tries_all ? all_parities : 1;
        LineFit<channels> fit;
        fit.error.fill(1e30F);
        for (int parities = 0; parities < tries; ++parities) {
            LineFit<channels> other;
            if (tries > 1 || parity == Parity::none) {
                const int second = parity == Parity::of_subset ? parities : parities / 2;
                other.parity[0].fill(static_cast<float>(parities % 2));
                other.parity[1].fill(static_cast<float>(second));
            } else {
                choose_parities<channels, coding>(line, parity == Parity::of_subset, other);
            }
            evaluate_line<channels, steps, coding>(values, weight, line, other);
            keep_better<channels>(other, fit);
        }
        keep_better<channels>(fit, best);
        if (round + 1 < effort.rounds) refit_line<channels, steps>(values, weight, fit, line);
    }
}

// Partitions.

constexpr std::size_t max_partitions = 6;

/// The partitions of a block with the smallest variance beside the lines of both subsets.
struct PartitionChoice {
    Bc7Lanes number[max_partitions], score[max_partitions];
};

/// Sums of values and of their products over the texels of a subset.
template <std::size_t channels>
struct SubsetSums {
    static constexpr std::size_t count = channels + channels * (channels + 1) / 2;
    Bc7Lanes sum[count];  ///< Of each channel; of the products (a, b) with a <= b.
};

/// Terms of such sums of each texel, followed by zeros.
struct SumTerms {
    Bc7Lanes texel[bc7_texels + 1];
};

/// Adds the variance beside the line to scores: the trace less the largest eigenvalue, by power
/// iteration. \param texels  number of texels of the subset
template <std::size_t channels>
RELIEF_INLINE void add_rest_of_line(const SubsetSums<channels>& sums, float texels,
                                    Bc7Lanes& score) {
    const float inverse = 1.0F / texels;
    Bc7Lanes covariance[channels][channels];
    std::size_t next_sum = channels;
    for (std::size_t a = 0; a < channels; ++a) {
        for (std::size_t b = a; b < channels; ++b, ++next_sum) {
            for (std::size_t lane = 0; lane < bc7_lanes; ++lane) {
                const float product = sums.sum[a][lane] * sums.sum[b][lane];
                covariance[a][b][lane] = sums.sum[next_sum][lane] - product * inverse;
            }
            covariance[b][a] = covariance[a][b];
        }
    }
    Bc7Lanes axis[channels];
    choose_row<channels>(covariance, axis);
    for (std::size_t lane = 0; lane < bc7_lanes; ++lane) {
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
RELIEF_INLINE void insert_partition(std::size_t partition, Bc7Lanes& score, std::size_t wanted,
                                    PartitionChoice& choice) {
    Bc7Lanes number;
    number.fill(static_cast<float>(partition));
    for (std::size_t k = 0; k < wanted; ++k) {
        for (std::size_t lane = 0; lane < bc7_lanes; ++lane) {
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
RELIEF_INLINE void add_four(const SumTerms& terms, const std::size_t* texels, Bc7Lanes& sum) {
    const Bc7Lanes& a = terms.texel[texels[0]];
    const Bc7Lanes& b = terms.texel[texels[1]];
    const Bc7Lanes& c = terms.texel[texels[2]];
    const Bc7Lanes& d = terms.texel[texels[3]];
    for (std::size_t lane = 0; lane < bc7_lanes; ++lane)
        sum[lane] += (a[lane] + b[lane]) + (c[lane] + d[lane]);
}

template <std::size_t channels>
RELIEF_INLINE void choose_partitions(const ChannelSet<channels>& values, std::size_t wanted,
                                     PartitionChoice& choice) {
    constexpr std::size_t sum_count = SubsetSums<channels>::count;
    // Values from the first texel on, so that products are small; and products.
    SumTerms terms[sum_count];
    for (std::size_t c = 0; c < channels; ++c) {
        for (std::size_t t = 0; t < bc7_texels; ++t) {
            for (std::size_t lane = 0; lane < bc7_lanes; ++lane)
                terms[c].texel[t][lane] = values[c][t][lane] - values[c][0][lane];
        }
    }
    std::size_t next_term = channels;
    for (std::size_t a = 0; a < channels; ++a) {
        for (std::size_t b = a; b < channels; ++b, ++next_term) {
            for (std::size_t t = 0; t < bc7_texels; ++t) {
                for (std::size_t lane = 0; lane < bc7_lanes; ++lane) {
                    terms[next_term].texel[t][lane] =
                        terms[a].texel[t][lane] * terms[b].texel[t][lane];
                }
            }
        }
    }
    SubsetSums<channels> all;
    for (std::size_t i = 0; i < sum_count; ++i) {
        all.sum[i].fill(0.0F);
        for (std::size_t t = 0; t < bc7_texels; ++t) {
            for (std::size_t lane = 0; lane < bc7_lanes; ++lane)
                all.sum[i][lane] += terms[i].texel[t][lane];
        }
        terms[i].texel[bc7_texels].fill(0.0F);
    }
    for (std::size_t k = 0; k < wanted; ++k) {
        choice.number[k].fill(0.0F);
        choice.score[k].fill(1e30F);
    }
    for (std::size_t partition = 0; partition < 64; ++partition) {
        // The texels of the second subset, in groups of four: the last one is filled with zeros.
        std::size_t texels[bc7_texels + 4];
        std::size_t count = 0;
        for (std::size_t t = 0; t < bc7_texels; ++t) {
            texels[count] = t;
            count += bc7_partitions_2[partition] >> t & 1U;
        }
        for (std::size_t k = 0; k < 4; ++k)
            texels[count + k] = bc7_texels;
        SubsetSums<channels> first, second;
        for (std::size_t i = 0; i < sum_count; ++i) {
            second.sum[i].fill(0.0F);
            for (std::size_t k = 0; k < count; k += 4)
                add_four(terms[i], &texels[k], second.sum[i]);
            for (std::size_t lane = 0; lane < bc7_lanes; ++lane)
                first.sum[i][lane] = all.sum[i][lane] - second.sum[i][lane];
        }
        Bc7Lanes score;
        score.fill(0.0F);
        add_rest_of_line<channels>(first, static_cast<float>(bc7_texels - count), score);
        add_rest_of_line<channels>(second, static_cast<float>(count), score);
        insert_partition(partition, score, wanted, choice);
    }
}

// The best encoding of each block.

template <std::size_t channels>
void copy_line(const LineFit<channels>& fit, std::size_t lane, std::size_t first_end,
               std::size_t first_channel, Bc7Encoding& encoding) {
    for (std::size_t end = 0; end < 2; ++end) {
        for (std::size_t c = 0; c < channels; ++c) {
            encoding.ends[first_end + end][first_channel + c] =
                static_cast<std::uint8_t>(fit.codes[end][c][lane]);
        }
        encoding.parity[first_end + end] = static_cast<std::uint8_t>(fit.parity[end][lane]);
    }
}

RELIEF_INLINE void try_mode_6(const Bc7Colors& colors, const SearchEffort& effort,
                              Bc7Encodings& encodings) {
    Bc7Texels all;
    for (Bc7Lanes& one : all.texel)
        one.fill(1.0F);
    LineFit<4> fit;
    search_line<4, 15, EndCoding{7, true}, Parity::of_ends>(
        {{&colors.channel[0], &colors.channel[1], &colors.channel[2], &colors.channel[3]}}, all,
        effort, fit);
    for (std::size_t lane = 0; lane < colors.count; ++lane) {
        Bc7Encoding& encoding = encodings[lane];
        if (fit.error[lane] >= encoding.error) continue;
        encoding.mode = 6;
        encoding.error = fit.error[lane];
        copy_line<4>(fit, lane, 0, 0, encoding);
        for (std::size_t t = 0; t < bc7_texels; ++t)
            encoding.index[t] = static_cast<std::uint8_t>(fit.index[t][lane]);
    }
}

RELIEF_INLINE void try_mode_5(const Bc7Colors& colors, const SearchEffort& effort,
                              Bc7Encodings& encodings) {
    Bc7Texels all;
    for (Bc7Lanes& one : all.texel)
        one.fill(1.0F);
    for (unsigned rotation = 0; rotation < 4; ++rotation) {
        const Bc7Texels* order[4] = {&colors.channel[0], &colors.channel[1], &colors.channel[2],
                                     &colors.channel[3]};
        if (rotation > 0) std::swap(order[3], order[rotation - 1]);
        LineFit<3> shared;
        LineFit<1> alone;
        search_line<3, 3, EndCoding{7, false}, Parity::none>({{order[0], order[1], order[2]}}, all,
                                                             effort, shared);
        search_line<1, 3, EndCoding{8, false}, Parity::none>({{order[3]}}, all, effort, alone);
        for (std::size_t lane = 0; lane < colors.count; ++lane) {
            Bc7Encoding& encoding = encodings[lane];
            const float error = shared.error[lane] + alone.error[lane];
            if (error >= encoding.error) continue;
            encoding.mode = 5;
            encoding.rotation = rotation;
            encoding.error = error;
            copy_line<3>(shared, lane, 0, 0, encoding);
            copy_line<1>(alone, lane, 0, 3, encoding);
            for (std::size_t t = 0; t < bc7_texels; ++t) {
                encoding.index[t] = static_cast<std::uint8_t>(shared.index[t][lane]);
                encoding.second_index[t] = static_cast<std::uint8_t>(alone.index[t][lane]);
            }
        }
    }
}

/// A partition for each block.
struct BlockSubsets {
    Bc7Lanes partition;
    Bc7Texels weight[2];  ///< 1 for the texels of the subset, else 0.

    explicit BlockSubsets(const Bc7Lanes& partitions) : partition(partitions) {
        for (std::size_t lane = 0; lane < bc7_lanes; ++lane) {
            const unsigned bits = bc7_partitions_2[static_cast<std::size_t>(partition[lane])];
            for (std::size_t t = 0; t < bc7_texels; ++t) {
                const unsigned bit = bits >> t & 1U;
                weight[0][t][lane] = static_cast<float>(1U - bit);
                weight[1][t][lane] = static_cast<float>(bit);
            }
        }
    }
};

/// Tries a mode of two subsets with a partition for each block.
/// \param extra  the error of channels that the mode does not store
template <std::size_t channels, int steps, EndCoding coding, Parity parity>
RELIEF_INLINE void try_subsets(const Bc7Colors& colors, unsigned mode, const BlockSubsets& subsets,
                               const Bc7Lanes& extra, const SearchEffort& effort,
                               Bc7Encodings& encodings) {
    ChannelSet<channels> values;
    for (std::size_t c = 0; c < channels; ++c)
        values.channel[c] = &colors.channel[c];
    LineFit<channels> fits[2];
    for (std::size_t subset = 0; subset < 2; ++subset)
        search_line<channels, steps, coding, parity>(values, subsets.weight[subset], effort,
                                                     fits[subset]);
    for (std::size_t lane = 0; lane < colors.count; ++lane) {
        Bc7Encoding& encoding = encodings[lane];
        const float error = fits[0].error[lane] + fits[1].error[lane] + extra[lane];
        if (error >= encoding.error) continue;
        encoding.mode = mode;
        encoding.error = error;
        encoding.partition = static_cast<unsigned>(subsets.partition[lane]);
        const unsigned bits = bc7_partitions_2[encoding.partition];
        copy_line<channels>(fits[0], lane, 0, 0, encoding);
        copy_line<channels>(fits[1], lane, 2, 0, encoding);
        for (std::size_t t = 0; t < bc7_texels; ++t)
            encoding.index[t] = static_cast<std::uint8_t>(fits[bits >> t & 1U].index[t][lane]);
    }
}

RELIEF_INLINE void search_encodings(const Bc7Colors& colors, BlockQuality quality,
                                    Bc7Encodings& encodings) {
    const SearchEffort effort = effort_of(quality);
    try_mode_6(colors, effort, encodings);
    const bool is_fast = quality == BlockQuality::fast;
    if (!is_fast) try_mode_5(colors, effort, encodings);
    // The error of alpha in modes that store none, whose alpha is 255.
    Bc7Lanes alpha_error;
    alpha_error.fill(0.0F);
    for (std::size_t t = 0; t < bc7_texels; ++t) {
        for (std::size_t lane = 0; lane < bc7_lanes; ++lane) {
            const float rest = 255.0F - colors.channel[3][t][lane];
            alpha_error[lane] += rest * rest;
        }
    }
    bool has_opaque = false;
    bool has_alpha = false;
    for (std::size_t lane = 0; lane < colors.count; ++lane) {
        const bool is_opaque = alpha_error[lane] == 0.0F;
        has_opaque = has_opaque || is_opaque;
        has_alpha = has_alpha || !is_opaque;
    }
    PartitionChoice partitions;
    if (has_opaque) {
        choose_partitions<3>({{&colors.channel[0], &colors.channel[1], &colors.channel[2]}},
                             effort.partitions, partitions);
        for (std::size_t k = 0; k < effort.partitions; ++k) {
            const BlockSubsets subsets(partitions.number[k]);
            try_subsets<3, 7, EndCoding{6, true}, Parity::of_subset>(
                colors, 1, subsets, alpha_error, effort, encodings);
            if (is_fast) continue;
            try_subsets<3, 3, EndCoding{7, true}, Parity::of_ends>(colors, 3, subsets, alpha_error,
                                                                   effort, encodings);
        }
    }
    if (!has_alpha || is_fast) return;
    Bc7Lanes none;
    none.fill(0.0F);
    choose_partitions<4>(
        {{&colors.channel[0], &colors.channel[1], &colors.channel[2], &colors.channel[3]}},
        effort.partitions, partitions);
    for (std::size_t k = 0; k < effort.partitions; ++k) {
        const BlockSubsets subsets(partitions.number[k]);
        try_subsets<4, 3, EndCoding{5, true}, Parity::of_ends>(colors, 7, subsets, none, effort,
                                                               encodings);
    }
}

RELIEF_TARGET_512 void search_encodings_512(const Bc7Colors& colors, BlockQuality quality,
                                            Bc7Encodings& encodings) {
    search_encodings(colors, quality, encodings);
}
RELIEF_TARGET_256 void search_encodings_256(const Bc7Colors& colors, BlockQuality quality,
                                            Bc7Encodings& encodings) {
    search_encodings(colors, quality, encodings);
}
[[gnu::noinline]] void search_encodings_any(const Bc7Colors& colors, BlockQuality quality,
                                            Bc7Encodings& encodings) {
    search_encodings(colors, quality, encodings);
}

}  // namespace

void choose_bc7_encodings(const Bc7Colors& colors, BlockQuality quality, Bc7Encodings& encodings) {
    switch (best_vector_target()) {
        case VectorTarget::widest:
            return search_encodings_512(colors, quality, encodings);
        case VectorTarget::wide:
            return search_encodings_256(colors, quality, encodings);
        case VectorTarget::any:
            break;
    }
    search_encodings_any(colors, quality, encodings);
}

}  // namespace relief::detail
