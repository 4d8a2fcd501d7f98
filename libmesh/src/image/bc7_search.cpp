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
#include "image/bptc_lines.h"
#include "portable_math.h"

namespace relief::detail {
namespace {

constexpr EndRange color_range = {0.0F, 255.0F};

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

/// The stored numbers of a line, with the indices of the texels.
template <std::size_t channels>
struct LineFit {
    BptcLanes codes[2][channels];
    BptcLanes parity[2];
    BptcTexels index;
    BptcLanes error;
};

/// Rounds a line, chooses the index of each texel, and computes the squared error. The colors of a
/// line are nearly evenly spaced: the index is that of the projection.
template <std::size_t channels, int steps, EndCoding coding>
RELIEF_INLINE void evaluate_line(const ChannelSet<channels>& values, const BptcTexels& weight,
                                 const RealLine<channels>& line, LineFit<channels>& fit) {
    BptcLanes first[channels], direction[channels];
    BptcLanes scale;
    for (std::size_t lane = 0; lane < bptc_lanes; ++lane) {
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
    for (std::size_t t = 0; t < bptc_texels; ++t) {
        for (std::size_t lane = 0; lane < bptc_lanes; ++lane) {
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

/// Replaces the fit of each block by another one if that has a smaller error.
template <std::size_t channels>
RELIEF_INLINE void keep_better(const LineFit<channels>& other, LineFit<channels>& fit) {
    for (std::size_t lane = 0; lane < bptc_lanes; ++lane) {
        const bool is_better = other.error[lane] < fit.error[lane];
        for (std::size_t end = 0; end < 2; ++end) {
            for (std::size_t c = 0; c < channels; ++c) {
                fit.codes[end][c][lane] =
                    is_better ? other.codes[end][c][lane] : fit.codes[end][c][lane];
            }
            fit.parity[end][lane] = is_better ? other.parity[end][lane] : fit.parity[end][lane];
        }
        for (std::size_t t = 0; t < bptc_texels; ++t)
            fit.index[t][lane] = is_better ? other.index[t][lane] : fit.index[t][lane];
        fit.error[lane] = is_better ? other.error[lane] : fit.error[lane];
    }
}

enum class Parity { none, of_ends, of_subset };

/// Sets the parity of each endpoint that rounds its channels best.
template <std::size_t channels, EndCoding coding>
RELIEF_INLINE void choose_parities(const RealLine<channels>& line, bool is_shared,
                                   LineFit<channels>& fit) {
    for (std::size_t lane = 0; lane < bptc_lanes; ++lane) {
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

/// Searches the stored numbers of a line. \param line  fitted to the texels of a subset
template <std::size_t channels, int steps, EndCoding coding, Parity parity>
RELIEF_INLINE void search_line(const ChannelSet<channels>& values, const BptcTexels& weight,
                               const SearchEffort& effort, RealLine<channels> line,
                               LineFit<channels>& best) {
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
        if (round + 1 < effort.rounds)
            refit_line<channels, steps>(values, weight, fit.index, color_range, line);
    }
}

/// Fits a line to all texels, and searches its stored numbers.
template <std::size_t channels, int steps, EndCoding coding, Parity parity>
RELIEF_INLINE void search_whole(const ChannelSet<channels>& values, const BptcTexels& all,
                                const SearchEffort& effort, LineFit<channels>& best) {
    RealLine<channels> line;
    fit_principal_line<channels>(values, all, color_range, line);
    search_line<channels, steps, coding, parity>(values, all, effort, line, best);
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
    BptcTexels all;
    for (BptcLanes& one : all.texel)
        one.fill(1.0F);
    LineFit<4> fit;
    search_whole<4, 15, EndCoding{7, true}, Parity::of_ends>(
        {{&colors.channel[0], &colors.channel[1], &colors.channel[2], &colors.channel[3]}}, all,
        effort, fit);
    for (std::size_t lane = 0; lane < colors.count; ++lane) {
        Bc7Encoding& encoding = encodings[lane];
        if (fit.error[lane] >= encoding.error) continue;
        encoding.mode = 6;
        encoding.error = fit.error[lane];
        copy_line<4>(fit, lane, 0, 0, encoding);
        for (std::size_t t = 0; t < bptc_texels; ++t)
            encoding.index[t] = static_cast<std::uint8_t>(fit.index[t][lane]);
    }
}

RELIEF_INLINE void try_mode_5(const Bc7Colors& colors, const SearchEffort& effort,
                              Bc7Encodings& encodings) {
    BptcTexels all;
    for (BptcLanes& one : all.texel)
        one.fill(1.0F);
    for (unsigned rotation = 0; rotation < 4; ++rotation) {
        const BptcTexels* order[4] = {&colors.channel[0], &colors.channel[1], &colors.channel[2],
                                      &colors.channel[3]};
        if (rotation > 0) std::swap(order[3], order[rotation - 1]);
        LineFit<3> shared;
        LineFit<1> alone;
        search_whole<3, 3, EndCoding{7, false}, Parity::none>({{order[0], order[1], order[2]}}, all,
                                                              effort, shared);
        search_whole<1, 3, EndCoding{8, false}, Parity::none>({{order[3]}}, all, effort, alone);
        for (std::size_t lane = 0; lane < colors.count; ++lane) {
            Bc7Encoding& encoding = encodings[lane];
            const float error = shared.error[lane] + alone.error[lane];
            if (error >= encoding.error) continue;
            encoding.mode = 5;
            encoding.rotation = rotation;
            encoding.error = error;
            copy_line<3>(shared, lane, 0, 0, encoding);
            copy_line<1>(alone, lane, 0, 3, encoding);
            for (std::size_t t = 0; t < bptc_texels; ++t) {
                encoding.index[t] = static_cast<std::uint8_t>(shared.index[t][lane]);
                encoding.second_index[t] = static_cast<std::uint8_t>(alone.index[t][lane]);
            }
        }
    }
}

/// A partition for each block.
struct BlockSubsets {
    BptcLanes partition;
    BptcTexels weight[2];  ///< 1 for the texels of the subset, else 0.

    explicit BlockSubsets(const BptcLanes& partitions) : partition(partitions) {
        for (std::size_t lane = 0; lane < bptc_lanes; ++lane) {
            const unsigned bits = bptc_partitions_2[static_cast<std::size_t>(partition[lane])];
            for (std::size_t t = 0; t < bptc_texels; ++t) {
                const unsigned bit = bits >> t & 1U;
                weight[0][t][lane] = static_cast<float>(1U - bit);
                weight[1][t][lane] = static_cast<float>(bit);
            }
        }
    }
};

/// The lines of both subsets, which several modes round differently.
template <std::size_t channels>
struct SubsetLines {
    RealLine<channels> line[2];

    RELIEF_INLINE SubsetLines(const Bc7Colors& colors, const BlockSubsets& subsets) {
        ChannelSet<channels> values;
        for (std::size_t c = 0; c < channels; ++c)
            values.channel[c] = &colors.channel[c];
        for (std::size_t subset = 0; subset < 2; ++subset)
            fit_principal_line<channels>(values, subsets.weight[subset], color_range, line[subset]);
    }
};

/// Tries a mode of two subsets with a partition for each block.
/// \param extra  the error of channels that the mode does not store
template <std::size_t channels, int steps, EndCoding coding, Parity parity>
RELIEF_INLINE void try_subsets(const Bc7Colors& colors, unsigned mode, const BlockSubsets& subsets,
                               const SubsetLines<channels>& lines, const BptcLanes& extra,
                               const SearchEffort& effort, Bc7Encodings& encodings) {
    ChannelSet<channels> values;
    for (std::size_t c = 0; c < channels; ++c)
        values.channel[c] = &colors.channel[c];
    LineFit<channels> fits[2];
    for (std::size_t subset = 0; subset < 2; ++subset)
        search_line<channels, steps, coding, parity>(values, subsets.weight[subset], effort,
                                                     lines.line[subset], fits[subset]);
    for (std::size_t lane = 0; lane < colors.count; ++lane) {
        Bc7Encoding& encoding = encodings[lane];
        const float error = fits[0].error[lane] + fits[1].error[lane] + extra[lane];
        if (error >= encoding.error) continue;
        encoding.mode = mode;
        encoding.error = error;
        encoding.partition = static_cast<unsigned>(subsets.partition[lane]);
        const unsigned bits = bptc_partitions_2[encoding.partition];
        copy_line<channels>(fits[0], lane, 0, 0, encoding);
        copy_line<channels>(fits[1], lane, 2, 0, encoding);
        for (std::size_t t = 0; t < bptc_texels; ++t)
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
    BptcLanes alpha_error;
    alpha_error.fill(0.0F);
    for (std::size_t t = 0; t < bptc_texels; ++t) {
        for (std::size_t lane = 0; lane < bptc_lanes; ++lane) {
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
        choose_partitions<3>({{&colors.channel[0], &colors.channel[1], &colors.channel[2]}}, 64,
                             effort.partitions, partitions);
        for (std::size_t k = 0; k < effort.partitions; ++k) {
            const BlockSubsets subsets(partitions.number[k]);
            const SubsetLines<3> lines(colors, subsets);
            try_subsets<3, 7, EndCoding{6, true}, Parity::of_subset>(
                colors, 1, subsets, lines, alpha_error, effort, encodings);
            if (is_fast) continue;
            try_subsets<3, 3, EndCoding{7, true}, Parity::of_ends>(colors, 3, subsets, lines,
                                                                   alpha_error, effort, encodings);
        }
    }
    if (!has_alpha || is_fast) return;
    BptcLanes none;
    none.fill(0.0F);
    choose_partitions<4>(
        {{&colors.channel[0], &colors.channel[1], &colors.channel[2], &colors.channel[3]}}, 64,
        effort.partitions, partitions);
    for (std::size_t k = 0; k < effort.partitions; ++k) {
        const BlockSubsets subsets(partitions.number[k]);
        const SubsetLines<4> lines(colors, subsets);
        try_subsets<4, 3, EndCoding{5, true}, Parity::of_ends>(colors, 7, subsets, lines, none,
                                                               effort, encodings);
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
