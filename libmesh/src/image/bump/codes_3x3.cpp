// SPDX-License-Identifier: Apache-2.0
// Heights to codes of normals in one loop, for kernels of 3x3 in float. What limits it is the
// square root and the division, and memory.
#include "image/bump/codes_3x3.h"

#include <algorithm>
#include <cstdint>

#include "image/bump/normal_store.h"
#include "image/texel_loops.h"

namespace relief {

std::optional<Weights3x3> weights_3x3(const KernelWeights<float>& weights, float right_scale,
                                      float up_scale) {
    const auto& differences = weights.differences;
    const bool fits = differences.size() == 1 && differences[0].before == -1 &&
                      differences[0].after == 1 && differences[0].weight == 1.0F &&
                      weights.smoothing.size() <= 2;
    if (!fits) return {};
    return Weights3x3{weights.smoothing[0],
                      weights.smoothing.size() == 2 ? weights.smoothing[1] : 0.0F, right_scale,
                      up_scale};
}

template <typename Sample>
PaddedRows<Sample>::PaddedRows(const HeightRows& heights, Wrap wrap)
    : heights_(heights), wrap_(wrap) {
    for (Slot& slot : slots_)
        slot.samples.resize(static_cast<std::size_t>(heights.width) + 2);
}

template <typename Sample>
typename PaddedRows<Sample>::Slot& PaddedRows<Sample>::load(int row,
                                                            const std::array<int, 3>& needed) {
    const auto has_row = [row](const Slot& slot) { return slot.row == row; };
    const auto found = std::find_if(slots_.begin(), slots_.end(), has_row);
    if (found != slots_.end()) return *found;
    // One that holds none of the three rows; there is one, since `row` is among them and not here.
    Slot& slot = *std::find_if(slots_.begin(), slots_.end(), [&](const Slot& candidate) {
        return std::find(needed.begin(), needed.end(), candidate.row) == needed.end();
    });
    const auto* samples = static_cast<const Sample*>(heights_.row(row));
    const auto width = static_cast<std::size_t>(heights_.width);
    float* const to = slot.samples.data() + 1;
    if constexpr (std::is_same_v<Sample, float>)
        std::copy_n(samples, width, to);
    else
        std::transform(samples, samples + width, to,
                       [](Sample sample) { return static_cast<float>(sample); });
    slot.samples.front() = to[place_within(-1, heights_.width, wrap_)];
    slot.samples.back() = to[place_within(heights_.width, heights_.width, wrap_)];
    slot.row = row;
    return slot;
}

template <typename Sample>
std::array<const float*, 3> PaddedRows<Sample>::around(int row, Wrap wrap) {
    const std::array<int, 3> needed = {place_within(row - 1, heights_.height, wrap), row,
                                       place_within(row + 1, heights_.height, wrap)};
    std::array<const float*, 3> rows{};
    for (std::size_t i = 0; i < 3; ++i)
        rows[i] = load(needed[i], needed).samples.data();
    return rows;
}

template class PaddedRows<std::uint8_t>;
template class PaddedRows<std::uint16_t>;
template class PaddedRows<float>;

namespace {

/// The weights with their scales, and the sign of green.
struct Scaled3x3 {
    float own_right, beside_right, own_up, beside_up;
};

/// Minus a component that has been multiplied by the greatest code's value, as a code. Rounding is
/// symmetric, so that the sign can wait until the end.
template <FlatCode flat, typename Code>
RELIEF_INLINE Code code_of_negative(float steps) {
    if constexpr (flat == FlatCode::half)
        return NormalCoding<Code, float>::from_half_steps(-steps);
    else
        return NormalCoding<Code, float>::from_middle_steps(-steps);
}

template <FlatCode flat, typename Code>
RELIEF_INLINE bool coordinates_loop(const float* __restrict above, const float* __restrict here,
                                    const float* __restrict below, const Scaled3x3& weights,
                                    std::size_t count, Code* __restrict x, Code* __restrict y,
                                    Code* __restrict z) {
    const Scaled3x3 w = weights;
    constexpr float steps = NormalCoding<Code, float>::steps(flat);
    std::uint32_t too_steep = 0;
    for (std::size_t i = 0; i < count; ++i) {
        // What the corners add to both slopes are the sum and the difference of the diagonals.
        const float rising = above[i + 2] - below[i];
        const float falling = below[i + 2] - above[i];
        const float right =
            w.own_right * (here[i + 2] - here[i]) + w.beside_right * (rising + falling);
        const float up =
            w.own_up * (above[i + 1] - below[i + 1]) + w.beside_up * (rising - falling);
        const float square = right * right + up * up;
        too_steep |= is_too_steep(square);
        const float scale = steps / std::sqrt(square + 1);
        x[i] = code_of_negative<flat, Code>(right * scale);
        y[i] = code_of_negative<flat, Code>(up * scale);
        z[i] = code_of_negative<flat, Code>(-scale);
    }
    return too_steep != 0;
}

/// Asks for memory ahead of its use, so that it comes while something else is computed: where rows
/// end, pages do, or all is stored at once, the processor does not see by itself what comes next.
template <int for_writing>
RELIEF_INLINE void ask_for(const void* begin, std::size_t bytes) {
    for (std::size_t at = 0; at < bytes; at += 64)
        __builtin_prefetch(static_cast<const char*>(begin) + at, for_writing);
}

/// What is worked on before memory for the next is asked for.
constexpr std::size_t texels_per_block = 256;

/// Coordinates of a block, each by itself.
template <typename Code>
struct Coordinates {
    alignas(64) std::array<Code, texels_per_block> x, y, z;
};

/// Where heights come next.
struct Ahead {
    const char* begin;
    std::size_t size;  ///< Bytes for each texel.
};

template <FlatCode flat, typename Code>
RELIEF_INLINE bool codes_of(const std::array<const float*, 3>& rows, const Scaled3x3& weights,
                            std::size_t count, Code* codes, const Ahead& ahead) {
    Coordinates<Code> at;
    bool too_steep = false;
    for (std::size_t first = 0; first < count; first += texels_per_block) {
        const std::size_t size = std::min(texels_per_block, count - first);
        Code* const to = codes + 3 * first;
        ask_for<1>(to + 3 * size, 3 * size * sizeof(Code));
        ask_for<0>(ahead.begin + first * ahead.size, size * ahead.size);
        too_steep |= coordinates_loop<flat>(rows[0] + first, rows[1] + first, rows[2] + first,
                                            weights, size, at.x.data(), at.y.data(), at.z.data());
        interleave(at.x.data(), at.y.data(), at.z.data(), size, to);
    }
    return too_steep;
}

template <FlatCode flat, typename Code>
RELIEF_TARGET_512 bool codes_512(const std::array<const float*, 3>& rows, const Scaled3x3& weights,
                                 std::size_t count, Code* codes, const Ahead& ahead) {
    return codes_of<flat>(rows, weights, count, codes, ahead);
}
template <FlatCode flat, typename Code>
RELIEF_TARGET_256 bool codes_256(const std::array<const float*, 3>& rows, const Scaled3x3& weights,
                                 std::size_t count, Code* codes, const Ahead& ahead) {
    return codes_of<flat>(rows, weights, count, codes, ahead);
}
template <FlatCode flat, typename Code>
[[gnu::noinline]] bool codes_any(const std::array<const float*, 3>& rows, const Scaled3x3& weights,
                                 std::size_t count, Code* codes, const Ahead& ahead) {
    return codes_of<flat>(rows, weights, count, codes, ahead);
}

template <FlatCode flat, typename Code>
bool codes_with(VectorTarget target, const std::array<const float*, 3>& rows,
                const Scaled3x3& weights, std::size_t count, Code* codes, const Ahead& ahead) {
    switch (target) {
        case VectorTarget::widest:
            return codes_512<flat>(rows, weights, count, codes, ahead);
        case VectorTarget::wide:
            return codes_256<flat>(rows, weights, count, codes, ahead);
        case VectorTarget::any:
            break;
    }
    return codes_any<flat>(rows, weights, count, codes, ahead);
}

}  // namespace

template <typename Code>
bool codes_3x3(VectorTarget target, const std::array<const float*, 3>& rows,
               const Weights3x3& weights, std::size_t count, const NormalMapFormat& format,
               Code* codes, const void* next, std::size_t next_size) {
    const Ahead ahead{static_cast<const char*>(next), next_size};
    const float up_scale = format.green == Green::up ? weights.up_scale : -weights.up_scale;
    const Scaled3x3 scaled{weights.own * weights.right_scale, weights.beside * weights.right_scale,
                           weights.own * up_scale, weights.beside * up_scale};
    if (format.flat == FlatCode::half)
        return codes_with<FlatCode::half>(target, rows, scaled, count, codes, ahead);
    return codes_with<FlatCode::middle>(target, rows, scaled, count, codes, ahead);
}

template bool codes_3x3(VectorTarget, const std::array<const float*, 3>&, const Weights3x3&,
                        std::size_t, const NormalMapFormat&, std::uint8_t*, const void*,
                        std::size_t);
template bool codes_3x3(VectorTarget, const std::array<const float*, 3>&, const Weights3x3&,
                        std::size_t, const NormalMapFormat&, std::uint16_t*, const void*,
                        std::size_t);

}  // namespace relief
