// SPDX-License-Identifier: Apache-2.0
// Vectorized loops from slopes to normals and codes, and from heights to codes for 3x3 kernels.
//
// Codes are computed and stored by blocks of 64 texels. Blocks are so small that a processor that
// executes out of order computes the next block while it stores the last one, so that the times of
// arithmetic and memory overlap. Codes are computed as 32-bit integers in one array for each
// component, and then interleaved in registers. Square root and division are those of IEEE 754, so
// that every register width gives the same bits.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

#include "bump/bump_rows.h"
#include "compiler.h"
#include "image/normal_coding.h"

namespace relief::detail {
namespace {

/// An unsigned integer of the size of a Real.
template <typename Real>
using BitsOf = std::conditional_t<sizeof(Real) == 4, std::uint32_t, std::uint64_t>;

/// The bit pattern of the greatest square of a slope for which Real is accurate. The bit patterns
/// of positive numbers have the order of the values. NaN and infinity exceed every limit, with or
/// without a sign bit.
template <typename Real>
constexpr auto steep_limit =
    std::bit_cast<BitsOf<Real>>(static_cast<Real>(sizeof(Real) == 4 ? 1e30 : 1e300));

template <typename Real>
RELIEF_INLINE bool steep_loop(const Real* __restrict right, const Real* __restrict up,
                              std::size_t count) {
    BitsOf<Real> steepest = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const Real square = right[i] * right[i] + up[i] * up[i];
        steepest = std::max(steepest, std::bit_cast<BitsOf<Real>>(square));
    }
    return steepest > steep_limit<Real>;
}

/// Returns the inverse of the length of (-right, -up, 1).
template <typename Real>
RELIEF_INLINE Real inverse_length(Real right, Real up) {
    return 1 / std::sqrt(right * right + up * up + 1);
}

template <typename Real>
RELIEF_INLINE void normals_loop(const Real* __restrict right, const Real* __restrict up,
                                std::size_t count, float* __restrict normals) {
    for (std::size_t i = 0; i < count; ++i) {
        const Real scale = inverse_length(right[i], up[i]);
        // Subtracting from zero turns -0 into 0.
        normals[3 * i] = static_cast<float>(0 - right[i] * scale);
        normals[3 * i + 1] = static_cast<float>(0 - up[i] * scale);
        normals[3 * i + 2] = static_cast<float>(scale);
    }
}

constexpr std::size_t texels_per_block = 64;

/// Distance in texels of the codes whose memory is prefetched. The processor does not predict
/// accesses across the ends of rows and pages, or after many stores.
constexpr std::size_t texels_ahead = 512;

template <int for_writing>
RELIEF_INLINE void prefetch(const void* begin, std::size_t bytes) {
    for (std::size_t at = 0; at < bytes; at += 64)
        __builtin_prefetch(static_cast<const char*>(begin) + at, for_writing);
}

/// A component of a texel before it is encoded or narrowed: float code steps, codes that were
/// computed in double, or float samples.
template <typename Sample, typename Real>
using ComponentOf = std::conditional_t<std::is_same_v<Sample, float> || std::is_same_v<Real, float>,
                                       float, std::uint32_t>;

/// The texels of a block, by component.
template <typename Component>
struct Block {
    alignas(64) std::array<Component, texels_per_block> x, y, z;
};

/// Selects lane index(i) of the concatenation of two vectors as lane i.
template <auto index, typename Lanes, int... i>
RELIEF_INLINE void shuffle(const Lanes& a, const Lanes& b, Lanes& result,
                           std::integer_sequence<int, i...>) {
    result = __builtin_shufflevector(a, b, index(i)...);
}

/// Loads codes, or encodes finite code steps by the formulas of NormalCoding.
template <FlatCode flat, typename Code, typename Words, typename Component>
RELIEF_INLINE void load_codes(const Component* from, Words& codes) {
    if constexpr (std::is_same_v<Component, float>) {
        using Floats = Vector<float, sizeof(Words)>;
        using Integers = Vector<std::int32_t, sizeof(Words)>;
        constexpr float middle = NormalCoding<Code, float>::middle;
        Floats steps;
        std::memcpy(&steps, from, sizeof(Words));
        if constexpr (flat == FlatCode::half) {
            codes = (Words) __builtin_convertvector(middle + steps, Integers);
        } else {
            // A half with the sign of the steps.
            constexpr auto half = std::bit_cast<std::uint32_t>(0.5F);
            const auto rounding = (Floats)(((Words)steps & 0x80000000U) | half);
            codes = (Words)(__builtin_convertvector(steps + rounding, Integers) +
                            static_cast<std::int32_t>(middle));
        }
    } else {
        std::memcpy(&codes, from, sizeof(Words));
    }
}

/// Returns the lane of a word of 16-bit texels: of the outer words, or beyond them of the inner
/// ones.
constexpr int lane_of_word(int word, int lanes) {
    const int texel = word / 3 * 2;
    return word % 3 == 1 ? lanes + texel : texel + word % 3 / 2;
}

/// Interleaves `lanes` texels from index `first` of a block on.
template <int lanes, FlatCode flat, typename Component, typename Code>
RELIEF_INLINE void interleave_lanes(const Block<Component>& block, std::size_t first,
                                    Code* texels) {
    using Words = Vector<std::uint32_t, 4 * lanes>;
    constexpr std::make_integer_sequence<int, lanes> all;
    Words x, y, z;
    load_codes<flat, Code>(&block.x[first], x);
    load_codes<flat, Code>(&block.y[first], y);
    load_codes<flat, Code>(&block.z[first], z);
    if constexpr (sizeof(Code) == 2) {
        // Two texels are the words x0 y0, z0 x1 and y1 z1. The outer two have the lanes of their
        // texels. The inner one has the lane of z0.
        using Pairs = Vector<std::uint64_t, 4 * lanes>;
        Words low, high;
        shuffle<[](int i) { return i % 2 == 0 ? i : lanes + i; }>(x, y, low, all);
        shuffle<[](int i) { return i % 2 == 0 ? i : lanes + i; }>(y, z, high, all);
        const Words outer = low | high << 16;
        const Words inner = z | (Words)((Pairs)x >> 16);
        Words begin, end;
        shuffle<[](int i) { return lane_of_word(i, lanes); }>(outer, inner, begin, all);
        shuffle<[](int i) { return lane_of_word(lanes + i % (lanes / 2), lanes); }>(outer, inner,
                                                                                    end, all);
        std::memcpy(texels, &begin, sizeof(Words));
        std::memcpy(texels + 2 * lanes, &end, sizeof(Words) / 2);
    } else if constexpr (lanes > 4) {
        // Three bytes of each word are moved together, first in each 16 bytes.
        using Bytes = Vector<std::uint8_t, 4 * lanes>;
        constexpr std::make_integer_sequence<int, 4 * lanes> all_bytes;
        const auto four = (Bytes)(x | y << 8 | z << 16);
        Bytes three;
        shuffle<[](int i) { return i % 16 < 12 ? i / 16 * 16 + i % 16 / 3 * 4 + i % 16 % 3 : i; }>(
            four, four, three, all_bytes);
        Words words;
        shuffle<[](int i) { return i / 3 * 4 % lanes + i % 3; }>((Words)three, (Words)three, words,
                                                                 all);
        std::memcpy(texels, &words, std::size_t{3} * lanes);
    } else {
        // SSE2 cannot select bytes.
        for (int i = 0; i < lanes; ++i) {
            texels[3 * i] = static_cast<Code>(x[i]);
            texels[3 * i + 1] = static_cast<Code>(y[i]);
            texels[3 * i + 2] = static_cast<Code>(z[i]);
        }
    }
}

/// Stores a block as codes, with registers of `lanes` words, or as float samples.
template <int lanes, FlatCode flat, typename Component, typename Sample>
RELIEF_INLINE void interleave(const Block<Component>& block, Sample* __restrict texels) {
    if constexpr (std::is_same_v<Sample, float>) {
        for (std::size_t i = 0; i < texels_per_block; ++i) {
            texels[3 * i] = block.x[i];
            texels[3 * i + 1] = block.y[i];
            texels[3 * i + 2] = block.z[i];
        }
    } else {
        for (std::size_t i = 0; i < texels_per_block; i += lanes)
            interleave_lanes<lanes, flat>(block, i, texels + 3 * i);
    }
}

template <FlatCode flat, typename Sample, typename Real>
RELIEF_INLINE ComponentOf<Sample, Real> encoded(Real component) {
    using Coding = NormalCoding<Sample, Real>;
    if constexpr (std::is_same_v<Sample, float>) {
        return Coding::encoded(component);
    } else {
        const Real steps = Coding::steps(flat) * component;
        if constexpr (std::is_same_v<Real, float>)
            return steps;
        else if constexpr (flat == FlatCode::half)
            return static_cast<std::uint32_t>(Coding::from_half_steps(steps));
        else
            return static_cast<std::uint32_t>(Coding::from_middle_steps(steps));
    }
}

template <FlatCode flat, typename Sample, typename Real>
RELIEF_INLINE void encode_slopes(const Real* __restrict right, const Real* __restrict up,
                                 Real green, Block<ComponentOf<Sample, Real>>& block) {
    for (std::size_t i = 0; i < texels_per_block; ++i) {
        const Real scale = inverse_length(right[i], up[i]);
        block.x[i] = encoded<flat, Sample>(0 - right[i] * scale);
        block.y[i] = encoded<flat, Sample>(0 - green * up[i] * scale);
        block.z[i] = encoded<flat, Sample>(scale);
    }
}

template <int lanes, FlatCode flat, typename Sample, typename Real>
RELIEF_INLINE void codes_of(const Real* right, const Real* up, std::size_t count, Real green,
                            Sample* codes) {
    Block<ComponentOf<Sample, Real>> block;
    std::array<Real, texels_per_block> last_right{}, last_up{};
    std::array<Sample, 3 * texels_per_block> last;
    for (std::size_t first = 0; first < count; first += texels_per_block) {
        const std::size_t size = std::min(texels_per_block, count - first);
        const bool whole = size == texels_per_block;
        if (!whole) {
            std::copy_n(right + first, size, last_right.data());
            std::copy_n(up + first, size, last_up.data());
        }
        Sample* const to = codes + 3 * first;
        prefetch<1>(to + 3 * texels_ahead, 3 * texels_per_block * sizeof(Sample));
        encode_slopes<flat, Sample>(whole ? right + first : last_right.data(),
                                    whole ? up + first : last_up.data(), green, block);
        interleave<lanes, flat>(block, whole ? to : last.data());
        if (!whole) std::copy_n(last.data(), 3 * size, to);
    }
}

template <typename Real>
RELIEF_TARGET_512 bool steep_512(const Real* right, const Real* up, std::size_t count) {
    return steep_loop(right, up, count);
}
template <typename Real>
RELIEF_TARGET_256 bool steep_256(const Real* right, const Real* up, std::size_t count) {
    return steep_loop(right, up, count);
}
template <typename Real>
RELIEF_TARGET_512 void normals_512(const Real* right, const Real* up, std::size_t count,
                                   float* normals) {
    normals_loop(right, up, count, normals);
}
template <typename Real>
RELIEF_TARGET_256 void normals_256(const Real* right, const Real* up, std::size_t count,
                                   float* normals) {
    normals_loop(right, up, count, normals);
}
template <FlatCode flat, typename Sample, typename Real>
RELIEF_TARGET_512 void codes_512(const Real* right, const Real* up, std::size_t count, Real green,
                                 Sample* codes) {
    codes_of<16, flat>(right, up, count, green, codes);
}
template <FlatCode flat, typename Sample, typename Real>
RELIEF_TARGET_256 void codes_256(const Real* right, const Real* up, std::size_t count, Real green,
                                 Sample* codes) {
    codes_of<8, flat>(right, up, count, green, codes);
}
template <FlatCode flat, typename Sample, typename Real>
[[gnu::noinline]] void codes_any(const Real* right, const Real* up, std::size_t count, Real green,
                                 Sample* codes) {
    codes_of<4, flat>(right, up, count, green, codes);
}

template <FlatCode flat, typename Sample, typename Real>
void codes_with(VectorTarget target, const Real* right, const Real* up, std::size_t count,
                Real green, Sample* codes) {
    switch (target) {
        case VectorTarget::widest:
            return codes_512<flat>(right, up, count, green, codes);
        case VectorTarget::wide:
            return codes_256<flat>(right, up, count, green, codes);
        case VectorTarget::any:
            return codes_any<flat>(right, up, count, green, codes);
    }
}

/// The products of weights and scales. Their signs are those of the components of normals.
struct Scaled3x3 {
    float own_x, beside_x, own_y, beside_y;
};

/// Returns the columns of a row from `offset` on, without letting the compiler know that they are
/// in the same array. Clang keeps heights from one texel to the next otherwise, and does not
/// vectorize.
RELIEF_INLINE const float* columns(const float* row, std::size_t offset) {
    const float* first = row + offset;
    asm("" : "+r"(first));
    return first;
}

/// Computes `count` normals of a block in code steps. Returns whether a slope is too steep.
template <std::size_t count>
RELIEF_INLINE bool encode_heights(const float* __restrict above, const float* __restrict here,
                                  const float* __restrict below, const Scaled3x3& w,
                                  const float steps, Block<float>& block) {
    const float* const above_center = columns(above, 1);
    const float* const below_center = columns(below, 1);
    const float* const above_right = columns(above, 2);
    const float* const right = columns(here, 2);
    const float* const below_right = columns(below, 2);
    std::uint32_t steepest = 0;
    for (std::size_t i = 0; i < count; ++i) {
        // The corners contribute the sum and the difference of the diagonals.
        const float rising = above_right[i] - below[i];
        const float falling = below_right[i] - above[i];
        const float x = w.own_x * (right[i] - here[i]) + w.beside_x * (rising + falling);
        const float y =
            w.own_y * (above_center[i] - below_center[i]) + w.beside_y * (rising - falling);
        const float square = x * x + y * y;
        steepest = std::max(steepest, std::bit_cast<std::uint32_t>(square));
        const float scale = steps / std::sqrt(square + 1);
        block.x[i] = x * scale;
        block.y[i] = y * scale;
        block.z[i] = scale;
    }
    return steepest > steep_limit<float>;
}

/// Computes codes of up to four texels from a copy of their heights, which extends beyond the
/// borders of the row. Returns whether a slope is too steep.
template <FlatCode flat, typename Code>
RELIEF_INLINE bool four_3x3(const Rows3x3& rows, const Scaled3x3& weights, std::size_t width,
                            std::size_t first, Code* codes) {
    constexpr std::size_t lanes = 4;
    const std::size_t count = std::min(lanes, width - first);
    std::array<std::array<float, lanes + 2>, 3> heights;
    for (std::size_t i = 0; i < 3; ++i) {
        heights[i][0] = first == 0 ? rows.left[i] : rows.rows[i][first - 1];
        for (std::size_t k = 0; k <= lanes; ++k)
            heights[i][k + 1] = first + k < width ? rows.rows[i][first + k] : rows.right[i];
    }
    Block<float> block;
    const bool too_steep =
        encode_heights<lanes>(heights[0].data(), heights[1].data(), heights[2].data(), weights,
                              NormalCoding<Code, float>::steps(flat), block);
    if (too_steep) return true;
    std::array<Code, 3 * lanes> texels;
    interleave_lanes<lanes, flat>(block, 0, texels.data());
    std::copy_n(texels.data(), 3 * count, codes + 3 * first);
    return false;
}

template <int lanes, FlatCode flat, typename Code>
RELIEF_INLINE bool blocks_3x3(const Rows3x3& rows, const Scaled3x3& weights, std::size_t width,
                              Code* codes) {
    if (width < texels_per_block + 2) {
        for (std::size_t first = 0; first < width; first += 4) {
            if (four_3x3<flat>(rows, weights, width, first, codes)) return true;
        }
        return false;
    }
    if (four_3x3<flat>(rows, weights, width, 0, codes)) return true;
    const auto [above, here, below] = rows.rows;
    const auto* const next = static_cast<const char*>(rows.next);
    const std::size_t next_size = rows.next_size;
    Block<float> block;
    // The last block overlaps the one before it.
    const std::size_t last = width - 1 - texels_per_block;
    for (std::size_t at = 1; at < width - 1; at += texels_per_block) {
        const std::size_t first = std::min(at, last);
        Code* const to = codes + 3 * first;
        prefetch<1>(to + 3 * texels_ahead, 3 * texels_per_block * sizeof(Code));
        prefetch<0>(next + first * next_size, texels_per_block * next_size);
        if (encode_heights<texels_per_block>(above + first - 1, here + first - 1, below + first - 1,
                                             weights, NormalCoding<Code, float>::steps(flat),
                                             block))
            return true;
        interleave<lanes, flat>(block, to);
    }
    return four_3x3<flat>(rows, weights, width, width - 4, codes);
}

template <FlatCode flat, typename Code>
RELIEF_TARGET_512 bool codes_3x3_512(const Rows3x3& rows, const Scaled3x3& weights,
                                     std::size_t width, Code* codes) {
    return blocks_3x3<16, flat>(rows, weights, width, codes);
}
template <FlatCode flat, typename Code>
RELIEF_TARGET_256 bool codes_3x3_256(const Rows3x3& rows, const Scaled3x3& weights,
                                     std::size_t width, Code* codes) {
    return blocks_3x3<8, flat>(rows, weights, width, codes);
}
template <FlatCode flat, typename Code>
[[gnu::noinline]] bool codes_3x3_any(const Rows3x3& rows, const Scaled3x3& weights,
                                     std::size_t width, Code* codes) {
    return blocks_3x3<4, flat>(rows, weights, width, codes);
}

template <FlatCode flat, typename Code>
bool codes_3x3_with(VectorTarget target, const Rows3x3& rows, const Scaled3x3& weights,
                    std::size_t width, Code* codes) {
    switch (target) {
        case VectorTarget::widest:
            return codes_3x3_512<flat>(rows, weights, width, codes);
        case VectorTarget::wide:
            return codes_3x3_256<flat>(rows, weights, width, codes);
        case VectorTarget::any:
            break;
    }
    return codes_3x3_any<flat>(rows, weights, width, codes);
}

}  // namespace

template <typename Real>
bool any_too_steep(VectorTarget target, const Real* right, const Real* up, std::size_t count) {
    switch (target) {
        case VectorTarget::widest:
            return steep_512(right, up, count);
        case VectorTarget::wide:
            return steep_256(right, up, count);
        case VectorTarget::any:
            break;
    }
    return steep_loop(right, up, count);
}

template <typename Real>
void store_normals(VectorTarget target, const Real* right, const Real* up, std::size_t count,
                   float* normals) {
    switch (target) {
        case VectorTarget::widest:
            return normals_512(right, up, count, normals);
        case VectorTarget::wide:
            return normals_256(right, up, count, normals);
        case VectorTarget::any:
            return normals_loop(right, up, count, normals);
    }
}

template <typename Sample, typename Real>
void store_codes(VectorTarget target, const Real* right, const Real* up, std::size_t count,
                 const NormalMapFormat& format, Sample* codes) {
    const Real green = format.green == Green::up ? 1 : -1;
    if (format.flat == FlatCode::half)
        codes_with<FlatCode::half>(target, right, up, count, green, codes);
    else
        codes_with<FlatCode::middle>(target, right, up, count, green, codes);
}

template <typename Sample, typename Real>
void store_dithered_codes(const Real* right, const Real* up, std::size_t count,
                          const NormalMapFormat& format, std::size_t first,
                          const DitherRow& thresholds, Sample* codes) {
    const NormalCoding<Sample> coding{format.flat};
    const double green = format.green == Green::up ? 1 : -1;
    for (std::size_t i = 0; i < count; ++i) {
        const double x = right[i];
        const double y = up[i];
        const double scale = inverse_length(x, y);
        codes[3 * i] = coding.dithered(-x * scale, thresholds.at(first + i, 0));
        codes[3 * i + 1] = coding.dithered(-y * green * scale, thresholds.at(first + i, 1));
        codes[3 * i + 2] = coding.dithered(scale, thresholds.at(first + i, 2));
    }
}

#define RELIEF_INSTANTIATE(Real)                                                              \
    template bool any_too_steep(VectorTarget, const Real*, const Real*, std::size_t);         \
    template void store_normals(VectorTarget, const Real*, const Real*, std::size_t, float*); \
    template void store_codes(VectorTarget, const Real*, const Real*, std::size_t,            \
                              const NormalMapFormat&, std::uint8_t*);                         \
    template void store_codes(VectorTarget, const Real*, const Real*, std::size_t,            \
                              const NormalMapFormat&, std::uint16_t*);                        \
    template void store_codes(VectorTarget, const Real*, const Real*, std::size_t,            \
                              const NormalMapFormat&, float*);                                \
    template void store_dithered_codes(const Real*, const Real*, std::size_t,                 \
                                       const NormalMapFormat&, std::size_t, const DitherRow&, \
                                       std::uint8_t*);                                        \
    template void store_dithered_codes(const Real*, const Real*, std::size_t,                 \
                                       const NormalMapFormat&, std::size_t, const DitherRow&, \
                                       std::uint16_t*);
RELIEF_INSTANTIATE(float)
RELIEF_INSTANTIATE(double)
#undef RELIEF_INSTANTIATE

template <typename Code>
bool codes_3x3(VectorTarget target, const Rows3x3& rows, const Weights3x3& weights,
               std::size_t width, const NormalMapFormat& format, Code* codes) {
    const float x_scale = -weights.right_scale;
    const float y_scale = format.green == Green::up ? -weights.up_scale : weights.up_scale;
    const Scaled3x3 scaled{weights.own * x_scale, weights.beside * x_scale, weights.own * y_scale,
                           weights.beside * y_scale};
    if (format.flat == FlatCode::half)
        return codes_3x3_with<FlatCode::half>(target, rows, scaled, width, codes);
    return codes_3x3_with<FlatCode::middle>(target, rows, scaled, width, codes);
}

template bool codes_3x3(VectorTarget, const Rows3x3&, const Weights3x3&, std::size_t,
                        const NormalMapFormat&, std::uint8_t*);
template bool codes_3x3(VectorTarget, const Rows3x3&, const Weights3x3&, std::size_t,
                        const NormalMapFormat&, std::uint16_t*);

}  // namespace relief::detail
