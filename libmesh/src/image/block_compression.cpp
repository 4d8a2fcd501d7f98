// SPDX-License-Identifier: Apache-2.0
// BC4 and BC5: encodes and decodes blocks of one or two channels. bc7_blocks.cpp has BC7,
// bc6h_blocks.cpp BC6H, and bc1_blocks.cpp BC1 and BC3.
//
// A block of a channel has two codes of 8 bits, and 3 bits per texel that select one of 8 values:
// the codes and 6 values between them, or, in the other order of the codes, the codes, 4 values
// between them, and the ends of the range. Encoding searches for the pair of codes with the least
// weighted sum of squared errors. 16 blocks are processed at once, one per vector lane, so results
// do not depend on the size of vector registers.
//
// For normals, the squared angle between (x, y, z) and (x + dx, y + dy, z + dz) is in first order
//     (1 - y^2)/z^2 dx^2 + (1 - x^2)/z^2 dy^2 + 2 xy/z^2 dx dy,
// because z dz = -(x dx + y dy). The weights of the channels are the factors of the squares. The
// last term is included by encoding x first, and y with the targets y - dx xy/(1 - x^2), which are
// best for the errors dx that remain. z^2 has a lower limit in these formulas, because the first
// order is wrong near z = 0.
#include "relief/mesh/block_compression.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <type_traits>

#include "image/bc6h_blocks.h"
#include "image/color_blocks.h"
#include "image/normal_coding.h"
#include "image/texel_loops.h"
#include "parallel.h"
#include "portable_math.h"

namespace relief {
using namespace relief::detail;

namespace {

constexpr std::size_t texels_per_block = 16;
constexpr std::size_t block_lanes = 16;  ///< Blocks that are encoded at once.

/// One number for each block.
struct alignas(64) BlockLanes : std::array<float, block_lanes> {};

/// One number for each texel of each block.
using TexelLanes = std::array<BlockLanes, texels_per_block>;

struct ChannelTargets {
    TexelLanes value;   ///< In codes: from 0 to 255, or from -127 to 127.
    TexelLanes weight;  ///< Above 0.
};

/// The codes of a channel's blocks, low < high, with 6 values between them.
struct CodeFit {
    BlockLanes low, high, error;
};

struct CodeRange {
    float min, max;
};

constexpr CodeRange range_of(bool is_signed) {
    return is_signed ? CodeRange{-127.0F, 127.0F} : CodeRange{0.0F, 255.0F};
}

/// Rounds to the nearest integer, ties to even. Values are below 2^22.
RELIEF_INLINE float nearest_code(float value) {
    constexpr float shift = 12582912.0F;  // 1.5 * 2^23: its sums have no fraction.
    return (value + shift) - shift;
}

RELIEF_INLINE float clamped_to(float value, float least, float greatest) {
    const float raised = value < least ? least : value;
    return raised > greatest ? greatest : raised;
}

/// Returns the step from `low` that is nearest to a value, of `steps` steps.
template <int steps>
RELIEF_INLINE float step_of(float offset, float scale) {
    return nearest_code(clamped_to(offset * scale, 0.0F, static_cast<float>(steps)));
}

/// Returns the weighted squared error of a pair of codes.
RELIEF_INLINE float error_of(const ChannelTargets& targets, std::size_t lane, float low,
                             float high) {
    const float scale = 7.0F / (high - low);
    const float step = (high - low) / 7.0F;
    float sum = 0.0F;
#pragma GCC unroll 16
    for (std::size_t t = 0; t < texels_per_block; ++t) {
        const float offset = targets.value[t][lane] - low;
        const float rest = offset - step * step_of<7>(offset, scale);
        sum += targets.weight[t][lane] * (rest * rest);
    }
    return sum;
}

/// The same for 4 values between the codes and both ends of the range.
RELIEF_INLINE float error_with_ends(const ChannelTargets& targets, std::size_t lane, float low,
                                    float high, CodeRange range) {
    const float scale = 5.0F / (high - low);
    const float step = (high - low) / 5.0F;
    float sum = 0.0F;
#pragma GCC unroll 16
    for (std::size_t t = 0; t < texels_per_block; ++t) {
        const float value = targets.value[t][lane];
        const float offset = value - low;
        const float rest = offset - step * step_of<5>(offset, scale);
        const float from_least = value - range.min;
        const float from_greatest = value - range.max;
        float square = rest * rest;
        square = from_least * from_least < square ? from_least * from_least : square;
        square = from_greatest * from_greatest < square ? from_greatest * from_greatest : square;
        sum += targets.weight[t][lane] * square;
    }
    return sum;
}

/// Makes two numbers valid codes with low < high.
RELIEF_INLINE void make_codes(float& low, float& high, CodeRange range) {
    low = clamped_to(nearest_code(low), range.min, range.max - 1.0F);
    high = clamped_to(nearest_code(high), low + 1.0F, range.max);
}

/// Replaces the fit of each block by the candidate if its error is smaller.
RELIEF_INLINE void consider(const ChannelTargets& targets, const BlockLanes& low,
                            const BlockLanes& high, CodeFit& fit) {
    BlockLanes error;
    for (std::size_t lane = 0; lane < block_lanes; ++lane)
        error[lane] = error_of(targets, lane, low[lane], high[lane]);
    for (std::size_t lane = 0; lane < block_lanes; ++lane) {
        const bool is_better = error[lane] < fit.error[lane];
        fit.low[lane] = is_better ? low[lane] : fit.low[lane];
        fit.high[lane] = is_better ? high[lane] : fit.high[lane];
        fit.error[lane] = is_better ? error[lane] : fit.error[lane];
    }
}

/// Moves both codes of the fits, and keeps what is better.
RELIEF_INLINE void consider_moved(const ChannelTargets& targets, float low_move, float high_move,
                                  CodeRange range, const BlockLanes& from_low,
                                  const BlockLanes& from_high, CodeFit& fit) {
    BlockLanes low, high;
    for (std::size_t lane = 0; lane < block_lanes; ++lane) {
        low[lane] = from_low[lane] + low_move;
        high[lane] = from_high[lane] + high_move;
        make_codes(low[lane], high[lane], range);
    }
    consider(targets, low, high, fit);
}

/// Computes the codes that are best for the steps that the texels have now, by least squares.
RELIEF_INLINE void refine_codes(const ChannelTargets& targets, CodeRange range, BlockLanes& low,
                                BlockLanes& high) {
    for (std::size_t lane = 0; lane < block_lanes; ++lane) {
        const float base = low[lane];
        const float scale = 7.0F / (high[lane] - base);
        float sum = 0.0F;
        float steps = 0.0F;
        float steps_squared = 0.0F;
        float offsets = 0.0F;
        float products = 0.0F;
#pragma GCC unroll 16
        for (std::size_t t = 0; t < texels_per_block; ++t) {
            const float offset = targets.value[t][lane] - base;
            const float weight = targets.weight[t][lane];
            const float step = step_of<7>(offset, scale);
            const float weighted = weight * step;
            sum += weight;
            steps += weighted;
            steps_squared += weighted * step;
            offsets += weight * offset;
            products += weighted * offset;
        }
        const float determinant = sum * steps_squared - steps * steps;
        const bool has_slope = determinant > 1e-3F * sum * sum;
        const float quotient =
            (sum * products - steps * offsets) / (has_slope ? determinant : 1.0F);
        const float slope = has_slope ? quotient : (high[lane] - base) / 7.0F;
        const float start = has_slope ? (offsets - slope * steps) / sum : 0.0F;
        float new_low = base + start;
        float new_high = base + start + 7.0F * slope;
        make_codes(new_low, new_high, range);
        low[lane] = new_low;
        high[lane] = new_high;
    }
}

/// The range of the values, rounded outwards.
RELIEF_INLINE void outer_range(const TexelLanes& value, CodeRange range, BlockLanes& low,
                               BlockLanes& high) {
    for (std::size_t lane = 0; lane < block_lanes; ++lane) {
        float least = value[0][lane];
        float greatest = least;
#pragma GCC unroll 16
        for (std::size_t t = 1; t < texels_per_block; ++t) {
            least = value[t][lane] < least ? value[t][lane] : least;
            greatest = value[t][lane] > greatest ? value[t][lane] : greatest;
        }
        const float rounded_low = nearest_code(least);
        const float rounded_high = nearest_code(greatest);
        low[lane] = rounded_low > least ? rounded_low - 1.0F : rounded_low;
        high[lane] = rounded_high < greatest ? rounded_high + 1.0F : rounded_high;
        make_codes(low[lane], high[lane], range);
    }
}

/// Searches the codes of a channel's blocks.
RELIEF_INLINE void search_codes(const ChannelTargets& targets, BlockQuality quality,
                                CodeRange range, CodeFit& fit) {
    outer_range(targets.value, range, fit.low, fit.high);
    if (quality == BlockQuality::fast) return;
    const BlockLanes outer_low = fit.low;
    const BlockLanes outer_high = fit.high;
    fit.error.fill(1e30F);
    consider(targets, outer_low, outer_high, fit);
    // The range, and ranges that are narrower by a part of it: each is refined by least squares.
    constexpr float insets[] = {0.0F, 0.06F, 0.12F};
    const int starts = quality == BlockQuality::best ? 3 : 2;
    for (int start = 0; start < starts; ++start) {
        BlockLanes low, high;
        for (std::size_t lane = 0; lane < block_lanes; ++lane) {
            const float inset = insets[start] * (outer_high[lane] - outer_low[lane]);
            low[lane] = outer_low[lane] + inset;
            high[lane] = outer_high[lane] - inset;
            make_codes(low[lane], high[lane], range);
        }
        const int rounds = quality == BlockQuality::best ? 4 : 2;
        for (int round = 0; round < rounds; ++round) {
            refine_codes(targets, range, low, high);
            consider(targets, low, high, fit);
        }
    }
    const int reach = quality == BlockQuality::best ? 2 : 1;
    const int rounds = quality == BlockQuality::best ? 3 : 1;
    for (int round = 0; round < rounds; ++round) {
        const BlockLanes from_low = fit.low;
        const BlockLanes from_high = fit.high;
        for (int low_move = -reach; low_move <= reach; ++low_move) {
            for (int high_move = -reach; high_move <= reach; ++high_move) {
                if (low_move == 0 && high_move == 0) continue;
                consider_moved(targets, static_cast<float>(low_move), static_cast<float>(high_move),
                               range, from_low, from_high, fit);
            }
        }
    }
}

/// Searches codes for blocks that contain values near the ends of the range, which need not lie
/// between the codes then. \param ends  becomes 1 where these codes are better, else 0
RELIEF_INLINE void search_with_ends(const ChannelTargets& targets, CodeRange range, CodeFit& fit,
                                    BlockLanes& ends) {
    constexpr float margin = 0.5F;
    BlockLanes inner_low, inner_high, has_end;
    for (std::size_t lane = 0; lane < block_lanes; ++lane) {
        float least = range.max;
        float greatest = range.min;
        float found = 0.0F;
#pragma GCC unroll 16
        for (std::size_t t = 0; t < texels_per_block; ++t) {
            const float value = targets.value[t][lane];
            const bool is_end = (value < range.min + margin) | (value > range.max - margin);
            const float low = is_end ? range.max : value;
            const float high = is_end ? range.min : value;
            least = low < least ? low : least;
            greatest = high > greatest ? high : greatest;
            found = is_end ? 1.0F : found;
        }
        inner_low[lane] = least;
        inner_high[lane] = greatest;
        has_end[lane] = found;
        ends[lane] = 0.0F;
    }
    for (int low_move = -1; low_move <= 1; ++low_move) {
        for (int high_move = -1; high_move <= 1; ++high_move) {
            BlockLanes low, high, error;
            for (std::size_t lane = 0; lane < block_lanes; ++lane) {
                float first = inner_low[lane] + static_cast<float>(low_move);
                float second = inner_high[lane] + static_cast<float>(high_move);
                make_codes(first, second, range);
                const float sum = error_with_ends(targets, lane, first, second, range);
                error[lane] = has_end[lane] > 0.5F ? sum : 1e30F;
                low[lane] = first;
                high[lane] = second;
            }
            for (std::size_t lane = 0; lane < block_lanes; ++lane) {
                const bool is_better = error[lane] < fit.error[lane];
                fit.low[lane] = is_better ? low[lane] : fit.low[lane];
                fit.high[lane] = is_better ? high[lane] : fit.high[lane];
                fit.error[lane] = is_better ? error[lane] : fit.error[lane];
                ends[lane] = is_better ? 1.0F : ends[lane];
            }
        }
    }
}

/// The bits of a channel's blocks: their codes, and 24 bits for each half of the texels.
struct BlockBits {
    alignas(64) std::array<std::int32_t, block_lanes> first, second, lower_half, upper_half;
};

/// Chooses the value of each texel. \param decoded  gets the values
RELIEF_INLINE void choose_values(const TexelLanes& value, const CodeFit& fit, BlockBits& bits,
                                 TexelLanes& decoded) {
    for (std::size_t lane = 0; lane < block_lanes; ++lane) {
        const float low = fit.low[lane];
        const float high = fit.high[lane];
        const float scale = 7.0F / (high - low);
        const float step = (high - low) / 7.0F;
        std::int32_t halves[2] = {0, 0};
#pragma GCC unroll 16
        for (std::size_t t = 0; t < texels_per_block; ++t) {
            const float steps = step_of<7>(value[t][lane] - low, scale);
            decoded[t][lane] = low + step * steps;
            const auto from_low = static_cast<std::int32_t>(steps);
            std::int32_t index = 8 - from_low;
            index = from_low == 7 ? 0 : index;
            index = from_low == 0 ? 1 : index;
            halves[t / 8] |= index << (3 * (t % 8));
        }
        bits.first[lane] = static_cast<std::int32_t>(high);
        bits.second[lane] = static_cast<std::int32_t>(low);
        bits.lower_half[lane] = halves[0];
        bits.upper_half[lane] = halves[1];
    }
}

/// The same for the blocks whose range has ends; others are not changed.
RELIEF_INLINE void choose_values_with_ends(const TexelLanes& value, const CodeFit& fit,
                                           const BlockLanes& ends, CodeRange range, BlockBits& bits,
                                           TexelLanes& decoded) {
    for (std::size_t lane = 0; lane < block_lanes; ++lane) {
        const float low = fit.low[lane];
        const float high = fit.high[lane];
        const float scale = 5.0F / (high - low);
        const float step = (high - low) / 5.0F;
        const bool has_ends = ends[lane] > 0.5F;
        std::int32_t halves[2] = {0, 0};
#pragma GCC unroll 16
        for (std::size_t t = 0; t < texels_per_block; ++t) {
            const float steps = step_of<5>(value[t][lane] - low, scale);
            float result = low + step * steps;
            const auto from_low = static_cast<std::int32_t>(steps);
            std::int32_t index = from_low + 1;
            index = from_low == 0 ? 0 : index;
            index = from_low == 5 ? 1 : index;
            const float rest = value[t][lane] - result;
            float square = rest * rest;
            const float from_least = value[t][lane] - range.min;
            const bool is_least = from_least * from_least < square;
            square = is_least ? from_least * from_least : square;
            index = is_least ? 6 : index;
            result = is_least ? range.min : result;
            const float from_greatest = value[t][lane] - range.max;
            const bool is_greatest = from_greatest * from_greatest < square;
            index = is_greatest ? 7 : index;
            result = is_greatest ? range.max : result;
            decoded[t][lane] = has_ends ? result : decoded[t][lane];
            halves[t / 8] |= index << (3 * (t % 8));
        }
        bits.first[lane] = has_ends ? static_cast<std::int32_t>(low) : bits.first[lane];
        bits.second[lane] = has_ends ? static_cast<std::int32_t>(high) : bits.second[lane];
        bits.lower_half[lane] = has_ends ? halves[0] : bits.lower_half[lane];
        bits.upper_half[lane] = has_ends ? halves[1] : bits.upper_half[lane];
    }
}

/// Writes little-endian blocks of 8 bytes.
RELIEF_INLINE void store_blocks(const BlockBits& bits, std::size_t count, std::size_t stride,
                                std::byte* blocks) {
    for (std::size_t lane = 0; lane < count; ++lane) {
        const std::uint64_t block = (static_cast<std::uint64_t>(bits.first[lane]) & 255U) |
                                    (static_cast<std::uint64_t>(bits.second[lane]) & 255U) << 8U |
                                    static_cast<std::uint64_t>(bits.lower_half[lane]) << 16U |
                                    static_cast<std::uint64_t>(bits.upper_half[lane]) << 40U;
        for (std::size_t i = 0; i < 8; ++i)
            blocks[lane * stride + i] = static_cast<std::byte>(block >> (8 * i));
    }
}

/// The meaning of codes of normals: code = zero + scale * component.
struct ComponentCodes {
    float zero, scale;
};

/// 16 blocks of one or two channels.
struct BlockGroup {
    std::array<TexelLanes, 2> value;  ///< In codes.
    std::size_t count = 0;            ///< Of the blocks that exist.
};

struct GroupOptions {
    std::size_t channels;
    BlockQuality quality;
    bool is_signed;
    bool are_normals;
    ComponentCodes codes;
};

/// Computes the weights of both channels, and the factor by which an error of x changes the target
/// of y.
RELIEF_INLINE void weigh_normals(const BlockGroup& group, ComponentCodes codes,
                                 TexelLanes& x_weight, TexelLanes& y_weight, TexelLanes& coupling) {
    constexpr float least_zz = 0.04F;
    for (std::size_t t = 0; t < texels_per_block; ++t) {
        for (std::size_t lane = 0; lane < block_lanes; ++lane) {
            const float x = (group.value[0][t][lane] - codes.zero) / codes.scale;
            const float y = (group.value[1][t][lane] - codes.zero) / codes.scale;
            const float rest = 1.0F - x * x - y * y;
            const float zz = rest < least_zz ? least_zz : rest;
            x_weight[t][lane] = (zz + x * x) / zz;
            y_weight[t][lane] = (zz + y * y) / zz;
            coupling[t][lane] = x * y / (zz + y * y);
        }
    }
}

RELIEF_INLINE void encode_channel(const ChannelTargets& targets, const GroupOptions& options,
                                  BlockBits& bits, TexelLanes& decoded) {
    const CodeRange range = range_of(options.is_signed);
    CodeFit fit;
    search_codes(targets, options.quality, range, fit);
    const bool tries_ends = options.quality == BlockQuality::best ||
                            (options.quality == BlockQuality::normal && !options.are_normals);
    BlockLanes ends;
    if (tries_ends) search_with_ends(targets, range, fit, ends);
    choose_values(targets.value, fit, bits, decoded);
    if (tries_ends) choose_values_with_ends(targets.value, fit, ends, range, bits, decoded);
}

RELIEF_INLINE void encode_group(const BlockGroup& group, const GroupOptions& options,
                                std::byte* blocks) {
    std::array<ChannelTargets, 2> targets;
    TexelLanes decoded, coupling;
    BlockBits bits;
    const bool is_weighted = options.are_normals && options.quality != BlockQuality::fast;
    if (is_weighted)
        weigh_normals(group, options.codes, targets[0].weight, targets[1].weight, coupling);
    for (std::size_t channel = 0; channel < options.channels; ++channel) {
        ChannelTargets& target = targets[channel];
        target.value = group.value[channel];
        if (!is_weighted) {
            for (BlockLanes& weights : target.weight)
                weights.fill(1.0F);
        } else if (channel == 1) {
            for (std::size_t t = 0; t < texels_per_block; ++t) {
                for (std::size_t lane = 0; lane < block_lanes; ++lane)
                    target.value[t][lane] -=
                        coupling[t][lane] * (decoded[t][lane] - group.value[0][t][lane]);
            }
        }
        encode_channel(target, options, bits, decoded);
        store_blocks(bits, group.count, 8 * options.channels, blocks + 8 * channel);
    }
}

RELIEF_TARGET_512 void encode_group_512(const BlockGroup& group, const GroupOptions& options,
                                        std::byte* blocks) {
    encode_group(group, options, blocks);
}
RELIEF_TARGET_256 void encode_group_256(const BlockGroup& group, const GroupOptions& options,
                                        std::byte* blocks) {
    encode_group(group, options, blocks);
}
[[gnu::noinline]] void encode_group_any(const BlockGroup& group, const GroupOptions& options,
                                        std::byte* blocks) {
    encode_group(group, options, blocks);
}

using EncodeGroup = void (*)(const BlockGroup&, const GroupOptions&, std::byte*);

EncodeGroup group_encoder() {
    switch (best_vector_target()) {
        case VectorTarget::widest:
            return encode_group_512;
        case VectorTarget::wide:
            return encode_group_256;
        case VectorTarget::any:
            break;
    }
    return encode_group_any;
}

// The texels of groups of blocks.

constexpr std::size_t group_columns = 4 * block_lanes;  ///< Texels in a row of a group.

/// Distributes a row of a group to its blocks.
void store_row(const std::array<float, group_columns>& row, std::size_t row_in_block,
               TexelLanes& value) {
    for (std::size_t column = 0; column < 4; ++column) {
        BlockLanes& to = value[4 * row_in_block + column];
        for (std::size_t lane = 0; lane < block_lanes; ++lane)
            to[lane] = row[4 * lane + column];
    }
}

/// Calls load(row, first_column, group, row_in_block) for the rows of each group, and encodes.
template <typename Load>
void encode_groups(int width, int height, const GroupOptions& options, std::span<std::byte> blocks,
                   Report& report, const Load& load) {
    const std::size_t columns = (static_cast<std::size_t>(width) + 3) / 4;
    const std::size_t rows = (static_cast<std::size_t>(height) + 3) / 4;
    const std::size_t block_size = 8 * options.channels;
    const EncodeGroup encode = group_encoder();
    const std::size_t grain = texels_per_piece / 4 / static_cast<std::size_t>(width) + 1;
    parallel_for_reporting(
        rows, grain, report, [&](std::size_t begin, std::size_t end, Report& found) {
            BlockGroup group;
            for (std::size_t row = begin; row < end; ++row) {
                for (std::size_t first = 0; first < columns; first += block_lanes) {
                    for (std::size_t y = 0; y < 4; ++y)
                        load(4 * row + y, 4 * first, y, group, found);
                    group.count = std::min(block_lanes, columns - first);
                    encode(group, options, blocks.data() + (row * columns + first) * block_size);
                }
            }
        });
}

/// The row of an image that a row of blocks stores: the last one is repeated.
int stored_row(std::size_t row, int height) {
    return static_cast<int>(std::min(row, static_cast<std::size_t>(height) - 1));
}

// Normals.

/// Returns the x and y that are stored for a normal which is not a unit vector that faces outwards.
/// \param is_repeated  the texel was reported already
std::array<float, 2> stored_odd_normal(const float* normal, bool is_repeated, std::size_t texel,
                                       Report& report) {
    Direction direction{static_cast<double>(normal[0]), static_cast<double>(normal[1]),
                        static_cast<double>(normal[2])};
    if (!make_unit(direction)) {
        if (!is_repeated) report.add("normal without direction", "texel", texel, "stored as flat");
    } else if (direction.z < 0.0) {
        if (!is_repeated) {
            report.add("normal that faces back", "texel", texel,
                       "stored as the nearest direction with z = 0");
        }
        direction.z = 0.0;
        make_unit(direction);
        if (direction.z > 0.0) direction = {0.0, 0.0, 1.0};
    }
    return {static_cast<float>(direction.x), static_cast<float>(direction.y)};
}

class NormalLoader {
  public:
    NormalLoader(const ImageView& normals, const GroupOptions& options, Green green)
        : normals_(normals), codes_(options.codes), up_(green == Green::up ? 1.0F : -1.0F) {}

    void operator()(std::size_t row, std::size_t first_column, std::size_t row_in_block,
                    BlockGroup& group, Report& report) const {
        const auto width = static_cast<std::size_t>(normals_.width);
        const int y = stored_row(row, normals_.height);
        const float* from = normals_.row<float>(y) + 3 * first_column;
        std::array<float, 3 * group_columns> repeated;
        if (first_column + group_columns > width) {
            const float* const all = normals_.row<float>(y);
            for (std::size_t x = 0; x < group_columns; ++x)
                std::copy_n(all + 3 * std::min(first_column + x, width - 1), 3, &repeated[3 * x]);
            from = repeated.data();
        }
        std::array<float, group_columns> xs, ys;
        if (!convert(from, xs, ys)) {
            for (std::size_t x = 0; x < group_columns; ++x) {
                const float* const normal = from + 3 * x;
                if (is_plain(normal)) continue;
                const bool is_repeated =
                    row != static_cast<std::size_t>(y) || first_column + x >= width;
                const auto stored = stored_odd_normal(
                    normal, is_repeated, static_cast<std::size_t>(y) * width + first_column + x,
                    report);
                xs[x] = codes_.zero + codes_.scale * stored[0];
                ys[x] = codes_.zero + codes_.scale * up_ * stored[1];
            }
        }
        store_row(xs, row_in_block, group.value[0]);
        store_row(ys, row_in_block, group.value[1]);
    }

  private:
    /// The length can be computed in float, and the normal faces outwards. False for NaN.
    static bool is_plain(const float* normal) {
        const float squares = normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2];
        return squares > 1e-12F && squares < 1e12F && normal[2] >= 0.0F;
    }

    /// Computes the codes of a row. \return whether all normals are plain
    bool convert(const float* from, std::array<float, group_columns>& xs,
                 std::array<float, group_columns>& ys) const {
        std::int32_t odd = 0;
        const float y_scale = codes_.scale * up_;
        for (std::size_t x = 0; x < group_columns; ++x) {
            const float* const normal = from + 3 * x;
            const float squares =
                normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2];
            odd += squares > 1e-12F ? 0 : 1;
            odd += squares < 1e12F ? 0 : 1;
            odd += normal[2] >= 0.0F ? 0 : 1;
            const float inverse = 1.0F / std::sqrt(squares);
            xs[x] = codes_.zero + codes_.scale * (normal[0] * inverse);
            ys[x] = codes_.zero + y_scale * (normal[1] * inverse);
        }
        return odd == 0;
    }

    const ImageView& normals_;
    ComponentCodes codes_;
    float up_;
};

// Other samples.

/// Returns a sample in codes, clamped; absent if it is not finite.
template <typename Sample>
float block_code_of(Sample sample, bool is_signed, bool& is_finite) {
    if constexpr (std::is_same_v<Sample, float>) {
        is_finite = std::isfinite(sample);
        if (!is_finite) return 0.0F;
        const float coded = is_signed ? 127.0F * (2.0F * sample - 1.0F) : 255.0F * sample;
        return clamped_to(coded, is_signed ? -127.0F : 0.0F, is_signed ? 127.0F : 255.0F);
    } else {
        is_finite = true;
        if (is_signed) {
            return 127.0F * NormalCoding<Sample, float>{FlatCode::middle}.decoded(sample);
        }
        return static_cast<float>(sample) * (255.0F / static_cast<float>(largest_sample<Sample>));
    }
}

template <typename Sample>
void encode_samples(const ImageView& image, const GroupOptions& options,
                    std::span<std::byte> blocks, Report& report) {
    const auto width = static_cast<std::size_t>(image.width);
    encode_groups(image.width, image.height, options, blocks, report,
                  [&](std::size_t row, std::size_t first_column, std::size_t row_in_block,
                      BlockGroup& group, Report& found) {
                      const int y = stored_row(row, image.height);
                      const Sample* const from = image.row<Sample>(y);
                      for (std::size_t channel = 0; channel < options.channels; ++channel) {
                          std::array<float, group_columns> values;
                          for (std::size_t x = 0; x < group_columns; ++x) {
                              const std::size_t column = std::min(first_column + x, width - 1);
                              bool is_finite = true;
                              values[x] = block_code_of(from[column * options.channels + channel],
                                                        options.is_signed, is_finite);
                              const bool is_stored =
                                  row == static_cast<std::size_t>(y) && first_column + x < width;
                              if (!is_finite && is_stored)
                                  found.add("sample that is not finite", "texel",
                                            static_cast<std::size_t>(y) * width + column,
                                            "stored as 0");
                          }
                          store_row(values, row_in_block, group.value[channel]);
                      }
                  });
}

// Decoding.

/// The values of a block of one channel, which its indices select.
template <bool is_signed>
std::array<std::uint16_t, 8> palette_of(std::uint32_t first, std::uint32_t second) {
    const auto number = [](std::uint32_t code) {
        return is_signed ? static_cast<std::int32_t>(static_cast<std::int8_t>(code))
                         : static_cast<std::int32_t>(code);
    };
    const bool has_ends = number(first) <= number(second);
    // The code -128 is another one for -1.
    const std::int32_t a = std::max(number(first), -127);
    const std::int32_t b = std::max(number(second), -127);
    const std::int32_t steps = has_ends ? 5 : 7;
    const auto sample = [steps](std::int32_t numerator) {
        // Rounds numerator / steps to 16 bits: a code of 8 bits is 257 codes of 16, or
        // 32767 / 127 from 32768 for signed ones. No value lies in the middle of two codes.
        if constexpr (is_signed) {
            const std::int32_t size = std::abs(numerator) * 32767;
            const std::int32_t divisor = 127 * steps;
            const std::int32_t rounded = (2 * size + divisor) / (2 * divisor);
            return static_cast<std::uint16_t>(32768 + (numerator < 0 ? -rounded : rounded));
        } else {
            return static_cast<std::uint16_t>((2 * 257 * numerator + steps) / (2 * steps));
        }
    };
    std::array<std::uint16_t, 8> palette;
    palette[0] = sample(a * steps);
    palette[1] = sample(b * steps);
    for (std::int32_t i = 1; i < steps; ++i)
        palette[static_cast<std::size_t>(i) + 1] = sample((steps - i) * a + i * b);
    if (has_ends) {
        palette[6] = is_signed ? std::uint16_t{1} : std::uint16_t{0};
        palette[7] = 65535;
    }
    return palette;
}

/// Decodes a channel of a block into its rows of an image.
template <bool is_signed>
void decode_channel(const std::byte* block, std::size_t channels, std::uint16_t* first,
                    std::size_t row_samples, std::size_t columns, std::size_t rows) {
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < 8; ++i)
        bits |= std::to_integer<std::uint64_t>(block[i]) << (8 * i);
    const auto palette = palette_of<is_signed>(static_cast<std::uint32_t>(bits & 255U),
                                               static_cast<std::uint32_t>(bits >> 8U & 255U));
    for (std::size_t y = 0; y < rows; ++y) {
        for (std::size_t x = 0; x < columns; ++x)
            first[y * row_samples + x * channels] = palette[bits >> (16 + 3 * (4 * y + x)) & 7U];
    }
}

void check_size(int width, int height) {
    if (width < 1 || height < 1)
        throw InvalidInput(
            fmt::format("the image has {} x {} texels, but needs at least 1 x 1", width, height));
}

bool is_bc6h(BlockFormat format) {
    return format == BlockFormat::bc6h || format == BlockFormat::bc6h_sfloat;
}

std::vector<std::byte> encode_channels(const ImageView& image, BlockFormat format,
                                       BlockQuality quality, Report& report) {
    const GroupOptions options{
        static_cast<std::size_t>(channels_of(format)), quality, is_signed(format), false, {}};
    std::vector<std::byte> blocks(block_data_size(format, image.width, image.height));
    with_sample_type(image, [&]<typename Sample>(Sample) {
        encode_samples<Sample>(image, options, blocks, report);
    });
    return blocks;
}

}  // namespace

std::size_t bytes_per_block(BlockFormat format) {
    switch (format) {
        case BlockFormat::bc1:
        case BlockFormat::bc1a:
        case BlockFormat::bc4:
        case BlockFormat::bc4_snorm:
            return 8;
        default:
            return 16;
    }
}

int channels_of(BlockFormat format) {
    switch (format) {
        case BlockFormat::bc4:
        case BlockFormat::bc4_snorm:
            return 1;
        case BlockFormat::bc5:
        case BlockFormat::bc5_snorm:
            return 2;
        case BlockFormat::bc1:
        case BlockFormat::bc6h:
        case BlockFormat::bc6h_sfloat:
            return 3;
        default:
            return 4;
    }
}

bool is_signed(BlockFormat format) {
    return format == BlockFormat::bc4_snorm || format == BlockFormat::bc5_snorm;
}

std::size_t block_data_size(BlockFormat format, int width, int height) {
    check_size(width, height);
    return (static_cast<std::size_t>(width) + 3) / 4 *
           ((static_cast<std::size_t>(height) + 3) / 4) * bytes_per_block(format);
}

std::vector<std::byte> encode_blocks(const ImageView& image, BlockFormat format,
                                     BlockQuality quality, Report& report) {
    check_size(image.width, image.height);
    if (format == BlockFormat::bc7) return encode_bc7(image, quality, report);
    if (is_bc6h(format)) return encode_bc6h(image, format, quality, report);
    if (channels_of(format) > 2) return encode_color_blocks(image, format, quality, report);
    if (image.channels != channels_of(format)) {
        throw InvalidInput(fmt::format("{} has {} channels, not {}", enum_name(format),
                                       channels_of(format), image.channels));
    }
    return encode_channels(image, format, quality, report);
}

std::vector<std::byte> encode_normal_blocks(const ImageView& normals,
                                            const NormalBlockOptions& options, Report& report,
                                            const ExecutionOptions& execution) {
    const ExecutionScope scope(execution);
    check_floats(normals, 3, "normals");
    if (channels_of(options.format) != 2) {
        throw InvalidInput(
            fmt::format("normals are stored in bc5, not in {}", enum_name(options.format)));
    }
    const ComponentCodes codes =
        is_signed(options.format) ? ComponentCodes{0.0F, 127.0F} : ComponentCodes{127.5F, 127.5F};
    const GroupOptions group{2, options.quality, is_signed(options.format), true, codes};
    std::vector<std::byte> blocks(block_data_size(options.format, normals.width, normals.height));
    encode_groups(normals.width, normals.height, group, blocks, report,
                  NormalLoader(normals, group, options.green));
    return blocks;
}

Image decode_blocks(std::span<const std::byte> blocks, BlockFormat format, int width, int height) {
    const std::size_t size = block_data_size(format, width, height);
    if (blocks.size() != size) {
        throw InvalidInput(fmt::format("{} x {} texels of {} have {} bytes, not {}", width, height,
                                       enum_name(format), size, blocks.size()));
    }
    if (format == BlockFormat::bc7) return decode_bc7(blocks, width, height);
    if (is_bc6h(format)) return decode_bc6h(blocks, format, width, height);
    if (channels_of(format) > 2) return decode_color_blocks(blocks, format, width, height);
    const auto channels = static_cast<std::size_t>(channels_of(format));
    const auto columns = static_cast<std::size_t>(width);
    const auto rows = static_cast<std::size_t>(height);
    Image image = make_image(width, height, channels_of(format), 16, ColorSpace::data);
    const std::span<std::uint16_t> samples = image.as<std::uint16_t>();
    const std::size_t block_columns = (columns + 3) / 4;
    const std::size_t grain = texels_per_piece / 4 / columns + 1;
    parallel_for((rows + 3) / 4, grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin * block_columns; i < end * block_columns; ++i) {
            const std::size_t x = i % block_columns * 4;
            const std::size_t y = i / block_columns * 4;
            for (std::size_t channel = 0; channel < channels; ++channel) {
                const auto decode =
                    is_signed(format) ? decode_channel<true> : decode_channel<false>;
                decode(&blocks[(i * channels + channel) * 8], channels,
                       &samples[(y * columns + x) * channels + channel], columns * channels,
                       std::min<std::size_t>(4, columns - x), std::min<std::size_t>(4, rows - y));
            }
        }
    });
    return image;
}

}  // namespace relief
