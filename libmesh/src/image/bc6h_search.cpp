// SPDX-License-Identifier: Apache-2.0
// BC6H: searches for the encoding of blocks with the least error, in all 14 modes.
//
// The colors of a subset of texels lie on a line between two endpoints, in codes that are nearly
// the bits of half floats. Four modes have one subset and indices of 4 bits, ten have two subsets,
// by one of 32 partitions, and indices of 3 bits. Most modes store one endpoint, and the others as
// differences of few bits; differences that do not fit are limited, so every mode gives a valid
// encoding, and the one with the least error wins. Lines are fitted to the exact colors, and again
// to the indices by least squares. The highest bit of the index of an anchor is not stored: a line
// begins at the end that is nearer to its anchor, and the index of the anchor is limited. Errors
// are those of the decoded codes before the last bit is rounded. 32 blocks are processed at once,
// one per vector lane, so results do not depend on the size of vector registers.
// Source: [Khronos Data Format], section BPTC.
#include <utility>

#include "image/bc6h_format.h"
#include "image/bptc_lines.h"
#include "portable_math.h"

namespace relief::detail {
namespace {

// Endpoints.

/// The storage of endpoints in a mode. A code stands for the middle of a step, except for 0, the
/// largest codes, and codes of 16 bits.
struct EndStorage {
    float step;             ///< In the unit of colors.
    float least, greatest;  ///< Codes.
    float top;              ///< The value of the largest code.
    bool is_exact;          ///< Codes of 16 bits, which are values.
    std::array<EndRange, 3> difference;
};

EndStorage storage_of(const Bc6hMode& mode, bool is_signed) {
    EndStorage storage{};
    storage.step = static_cast<float>(1 << (16 - mode.bits)) / bc6h_unit;
    storage.greatest = static_cast<float>((1 << (is_signed ? mode.bits - 1 : mode.bits)) - 1);
    storage.least = is_signed ? -storage.greatest : 0.0F;
    storage.top = (is_signed ? 32767.0F : 65535.0F) / bc6h_unit;
    storage.is_exact = mode.bits == 16;
    for (std::size_t c = 0; c < 3; ++c) {
        const auto half = static_cast<float>(1 << (mode.other_bits[c] - 1));
        storage.difference[c] =
            mode.has_differences ? EndRange{-half, half - 1.0F} : EndRange{-1e6F, 1e6F};
    }
    return storage;
}

/// Rounds a value to a code.
RELIEF_INLINE float end_code(float value, const EndStorage& storage) {
    const float size = (value < 0.0F ? -value : value) / storage.step;
    const float number = nearest_integer(storage.is_exact ? size : size - 0.5F);
    const float code = limited(number, 0.0F, storage.greatest);
    return limited(value < 0.0F ? -code : code, storage.least, storage.greatest);
}

RELIEF_INLINE float end_value(float code, const EndStorage& storage) {
    const float number = code < 0.0F ? -code : code;
    const float middle = (storage.is_exact ? number : number + 0.5F) * storage.step;
    const float inside = number < 0.5F ? 0.0F : middle;
    const float value = number > storage.greatest - 0.5F ? storage.top : inside;
    return code < 0.0F ? -value : value;
}

// Fitting.

/// The texels of the subsets of blocks.
template <std::size_t subsets>
struct Subsets {
    BptcLanes partition;
    BptcTexels is_in[subsets];   ///< 1 for the texels of the subset, else 0.
    BptcTexels weight[subsets];  ///< The same, weighted.
    BptcTexels max_index;        ///< The largest index of a texel: half for anchors.
};

/// The stored numbers of blocks.
template <std::size_t subsets>
struct CodedLines {
    BptcLanes mode;
    BptcLanes codes[2 * subsets][3];
    BptcTexels index;
    BptcLanes error;
};

template <std::size_t subsets>
constexpr int index_steps = subsets == 1 ? 15 : 7;

template <std::size_t subsets>
RELIEF_INLINE void choose_subsets(const Bc6hColors& colors, const BptcLanes& partition,
                                  Subsets<subsets>& result) {
    result.partition = partition;
    constexpr auto last = static_cast<float>(index_steps<subsets>);
    constexpr auto half = static_cast<float>(index_steps<subsets> / 2);
    for (std::size_t lane = 0; lane < bptc_lanes; ++lane) {
        const auto number = static_cast<std::size_t>(partition[lane]);
        const unsigned bits = subsets == 1 ? 0U : bptc_partitions_2[number];
        const std::size_t second_anchor = subsets == 1 ? 0 : bptc_anchors_2[number];
        for (std::size_t t = 0; t < bptc_texels; ++t) {
            const bool is_anchor = t == 0 || t == second_anchor;
            result.max_index[t][lane] = is_anchor ? half : last;
            for (std::size_t s = 0; s < subsets; ++s) {
                const float is_in = (bits >> t & 1U) == s ? 1.0F : 0.0F;
                result.is_in[s][t][lane] = is_in;
                result.weight[s][t][lane] = is_in * colors.weight[t][lane];
            }
        }
    }
}

/// Makes lines begin at the end that is nearer to the anchor of their subset.
template <std::size_t subsets>
RELIEF_INLINE void begin_at_anchors(const Bc6hColors& colors, const Subsets<subsets>& texels,
                                    RealLine<3> (&lines)[subsets]) {
    for (std::size_t s = 0; s < subsets; ++s) {
        for (std::size_t lane = 0; lane < bptc_lanes; ++lane) {
            const std::size_t anchor =
                s == 0 ? 0 : bptc_anchors_2[static_cast<std::size_t>(texels.partition[lane])];
            float beyond_middle = 0.0F;
            for (std::size_t c = 0; c < 3; ++c) {
                const float first = lines[s].ends[0][c][lane];
                const float second = lines[s].ends[1][c][lane];
                const float value = colors.channel[c][anchor][lane];
                beyond_middle += (second - first) * ((value - first) + (value - second));
            }
            if (!(beyond_middle > 0.0F)) continue;
            for (std::size_t c = 0; c < 3; ++c)
                std::swap(lines[s].ends[0][c][lane], lines[s].ends[1][c][lane]);
        }
    }
}

/// Rounds lines, chooses the index of each texel, and computes the weighted squared error. The
/// colors of a line are nearly evenly spaced: the index is that of the projection.
template <std::size_t subsets>
RELIEF_INLINE void code_lines(const Bc6hColors& colors, const Subsets<subsets>& texels,
                              const EndStorage& storage, const RealLine<3> (&lines)[subsets],
                              CodedLines<subsets>& coded) {
    constexpr auto steps = static_cast<float>(index_steps<subsets>);
    BptcLanes first[subsets][3], direction[subsets][3], scale[subsets];
    for (std::size_t s = 0; s < subsets; ++s) {
        for (std::size_t lane = 0; lane < bptc_lanes; ++lane) {
            float squares = 0.0F;
            for (std::size_t c = 0; c < 3; ++c) {
                float value[2];
                for (std::size_t end = 0; end < 2; ++end) {
                    float code = end_code(lines[s].ends[end][c][lane], storage);
                    if (s + end > 0) {
                        const float base = coded.codes[0][c][lane];
                        code = base + limited(code - base, storage.difference[c].least,
                                              storage.difference[c].greatest);
                    }
                    coded.codes[2 * s + end][c][lane] = code;
                    value[end] = end_value(code, storage);
                }
                first[s][c][lane] = value[0];
                direction[s][c][lane] = value[1] - value[0];
                squares += direction[s][c][lane] * direction[s][c][lane];
            }
            scale[s][lane] = squares > 0.0F ? steps / squares : 0.0F;
        }
    }
    coded.error.fill(0.0F);
    for (std::size_t t = 0; t < bptc_texels; ++t) {
        for (std::size_t lane = 0; lane < bptc_lanes; ++lane) {
            float start[3], way[3];
            float projection_scale = scale[0][lane];
            for (std::size_t c = 0; c < 3; ++c) {
                start[c] = first[0][c][lane];
                way[c] = direction[0][c][lane];
            }
            if constexpr (subsets == 2) {
                const bool is_second = texels.is_in[1][t][lane] > 0.5F;
                projection_scale = is_second ? scale[1][lane] : projection_scale;
                for (std::size_t c = 0; c < 3; ++c) {
                    start[c] = is_second ? first[1][c][lane] : start[c];
                    way[c] = is_second ? direction[1][c][lane] : way[c];
                }
            }
            float along = 0.0F;
            for (std::size_t c = 0; c < 3; ++c)
                along += way[c] * (colors.channel[c][t][lane] - start[c]);
            const float step =
                nearest_integer(limited(along * projection_scale, 0.0F, texels.max_index[t][lane]));
            // The weights of the format, in 64ths.
            const float part = nearest_integer(step * (64.0F / steps)) * (1.0F / 64.0F);
            float error = 0.0F;
            for (std::size_t c = 0; c < 3; ++c) {
                const float rest = colors.channel[c][t][lane] - (start[c] + way[c] * part);
                error += rest * rest;
            }
            coded.index[t][lane] = step;
            coded.error[lane] += colors.weight[t][lane] * error;
        }
    }
}

/// Replaces the numbers of each block by others if these have a smaller error.
template <std::size_t subsets>
RELIEF_INLINE void keep_better(const CodedLines<subsets>& other, CodedLines<subsets>& best) {
    for (std::size_t lane = 0; lane < bptc_lanes; ++lane) {
        const bool is_better = other.error[lane] < best.error[lane];
        for (std::size_t end = 0; end < 2 * subsets; ++end) {
            for (std::size_t c = 0; c < 3; ++c) {
                best.codes[end][c][lane] =
                    is_better ? other.codes[end][c][lane] : best.codes[end][c][lane];
            }
        }
        for (std::size_t t = 0; t < bptc_texels; ++t)
            best.index[t][lane] = is_better ? other.index[t][lane] : best.index[t][lane];
        best.mode[lane] = is_better ? other.mode[lane] : best.mode[lane];
        best.error[lane] = is_better ? other.error[lane] : best.error[lane];
    }
}

// The search.

struct SearchEffort {
    int line_rounds;  ///< Of fitting before endpoints are rounded, each followed by rounding.
    int mode_rounds;  ///< Of fitting to the indices of each mode.
    std::size_t partitions;
};

constexpr SearchEffort effort_of(BlockQuality quality) {
    if (quality == BlockQuality::fast) return {1, 0, 1};
    if (quality == BlockQuality::normal) return {2, 0, 2};
    return {2, 1, 4};
}

template <std::size_t subsets>
RELIEF_INLINE void refit_lines(const ChannelSet<3>& values, const Subsets<subsets>& texels,
                               const CodedLines<subsets>& coded, const EndRange& range,
                               RealLine<3> (&lines)[subsets]) {
    for (std::size_t s = 0; s < subsets; ++s)
        refit_line<3, index_steps<subsets>>(values, texels.weight[s], coded.index, range, lines[s]);
}

/// Rounds lines in all modes with this number of subsets. \param rounds  of fitting in each mode
template <std::size_t subsets>
RELIEF_INLINE void code_in_modes(const Bc6hColors& colors, const Subsets<subsets>& texels,
                                 const RealLine<3> (&lines)[subsets], const EndRange& range,
                                 int rounds, CodedLines<subsets>& best) {
    const ChannelSet<3> values = {{&colors.channel[0], &colors.channel[1], &colors.channel[2]}};
    const std::size_t first = subsets == 2 ? 0 : bc6h_two_subset_modes;
    const std::size_t end = subsets == 2 ? bc6h_two_subset_modes : bc6h_modes.size();
    for (std::size_t mode = first; mode < end; ++mode) {
        const EndStorage storage = storage_of(bc6h_modes[mode], colors.is_signed);
        RealLine<3> of_mode[subsets];
        for (std::size_t s = 0; s < subsets; ++s)
            of_mode[s] = lines[s];
        for (int round = 0; round <= rounds; ++round) {
            CodedLines<subsets> coded;
            coded.mode.fill(static_cast<float>(mode));
            code_lines<subsets>(colors, texels, storage, of_mode, coded);
            keep_better<subsets>(coded, best);
            if (round < rounds) refit_lines<subsets>(values, texels, coded, range, of_mode);
        }
    }
}

/// Tries the modes with this number of subsets, with a partition for each block.
template <std::size_t subsets>
RELIEF_INLINE void try_modes(const Bc6hColors& colors, const BptcLanes& partition,
                             const SearchEffort& effort, Bc6hEncodings& encodings) {
    const ChannelSet<3> values = {{&colors.channel[0], &colors.channel[1], &colors.channel[2]}};
    const float top = (colors.is_signed ? 32767.0F : 65535.0F) / bc6h_unit;
    const EndRange range = {colors.is_signed ? -top : 0.0F, top};
    Subsets<subsets> texels;
    choose_subsets<subsets>(colors, partition, texels);
    RealLine<3> lines[subsets];
    for (std::size_t s = 0; s < subsets; ++s)
        fit_principal_line<3>(values, texels.is_in[s], range, lines[s]);
    begin_at_anchors<subsets>(colors, texels, lines);
    constexpr Bc6hMode exact = {subsets, 16, {16, 16, 16}, false};
    const EndStorage exact_storage = storage_of(exact, colors.is_signed);
    CodedLines<subsets> best;
    best.error.fill(1e30F);
    for (int round = 0; round < effort.line_rounds; ++round) {
        CodedLines<subsets> coded;
        code_lines<subsets>(colors, texels, exact_storage, lines, coded);
        refit_lines<subsets>(values, texels, coded, range, lines);
        code_in_modes<subsets>(colors, texels, lines, range, effort.mode_rounds, best);
    }
    for (std::size_t lane = 0; lane < colors.count; ++lane) {
        Bc6hEncoding& encoding = encodings[lane];
        if (best.error[lane] >= encoding.error) continue;
        encoding.error = best.error[lane];
        encoding.mode = static_cast<std::size_t>(best.mode[lane]);
        encoding.partition = static_cast<unsigned>(partition[lane]);
        for (std::size_t line_end = 0; line_end < 2 * subsets; ++line_end) {
            for (std::size_t c = 0; c < 3; ++c) {
                encoding.ends[line_end][c] =
                    static_cast<std::int32_t>(best.codes[line_end][c][lane]);
            }
        }
        for (std::size_t t = 0; t < bptc_texels; ++t)
            encoding.index[t] = static_cast<std::uint8_t>(best.index[t][lane]);
    }
}

RELIEF_INLINE void search_encodings(const Bc6hColors& colors, BlockQuality quality,
                                    Bc6hEncodings& encodings) {
    const SearchEffort effort = effort_of(quality);
    BptcLanes none;
    none.fill(0.0F);
    try_modes<1>(colors, none, effort, encodings);
    PartitionChoice partitions;
    choose_partitions<3>({{&colors.channel[0], &colors.channel[1], &colors.channel[2]}},
                         bc6h_partitions, effort.partitions, partitions);
    for (std::size_t k = 0; k < effort.partitions; ++k)
        try_modes<2>(colors, partitions.number[k], effort, encodings);
}

RELIEF_TARGET_512 void search_encodings_512(const Bc6hColors& colors, BlockQuality quality,
                                            Bc6hEncodings& encodings) {
    search_encodings(colors, quality, encodings);
}
RELIEF_TARGET_256 void search_encodings_256(const Bc6hColors& colors, BlockQuality quality,
                                            Bc6hEncodings& encodings) {
    search_encodings(colors, quality, encodings);
}
[[gnu::noinline]] void search_encodings_any(const Bc6hColors& colors, BlockQuality quality,
                                            Bc6hEncodings& encodings) {
    search_encodings(colors, quality, encodings);
}

}  // namespace

void choose_bc6h_encodings(const Bc6hColors& colors, BlockQuality quality,
                           Bc6hEncodings& encodings) {
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
