// SPDX-License-Identifier: Apache-2.0
// Heights to codes of normals in one loop, for kernels of 3x3 in float. What limits it is the
// square root and the division, and memory. Tests: tests/mesh/image/bump_kernels_test.cpp.
#include "image/codes_3x3.h"

#include <algorithm>
#include <cstdint>

#include "image/border.h"
#include "image/normal_store.h"

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
    for (std::size_t i = 0; i < width; ++i)
        to[i] = static_cast<float>(samples[i]);
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

/// Coordinates of a piece of a row, each by itself.
template <typename Code>
struct Coordinates {
    alignas(64) std::array<Code, columns_at_once> x, y, z;
};

template <FlatCode flat, typename Code>
RELIEF_INLINE bool coordinates_loop(const float* __restrict above, const float* __restrict here,
                                    const float* __restrict below, const Weights3x3& weights,
                                    std::size_t count, float green, Code* __restrict x,
                                    Code* __restrict y, Code* __restrict z) {
    const float own = weights.own;
    const float beside = weights.beside;
    const float right_scale = weights.right_scale;
    const float up_scale = weights.up_scale;
    std::uint32_t too_steep = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const float left_line = own * here[i] + beside * (above[i] + below[i]);
        const float right_line = own * here[i + 2] + beside * (above[i + 2] + below[i + 2]);
        const float right = (right_line - left_line) * right_scale;
        const float up = (own * (above[i + 1] - below[i + 1]) +
                          beside * ((above[i] - below[i]) + (above[i + 2] - below[i + 2]))) *
                         up_scale;
        const float square = right * right + up * up;
        too_steep |= is_too_steep(square);
        const float scale = 1 / std::sqrt(square + 1);
        x[i] = encoded<flat, Code>(0 - right * scale);
        y[i] = encoded<flat, Code>(0 - green * up * scale);
        z[i] = encoded<flat, Code>(scale);
    }
    return too_steep != 0;
}

template <FlatCode flat, typename Code>
RELIEF_INLINE bool codes_of(const std::array<const float*, 3>& rows, const Weights3x3& weights,
                            std::size_t count, float green, Code* codes) {
    Coordinates<Code> at;
    const bool too_steep = coordinates_loop<flat>(rows[0], rows[1], rows[2], weights, count, green,
                                                  at.x.data(), at.y.data(), at.z.data());
    interleave(at.x.data(), at.y.data(), at.z.data(), count, codes);
    return too_steep;
}

template <FlatCode flat, typename Code>
RELIEF_TARGET_512 bool codes_512(const std::array<const float*, 3>& rows, const Weights3x3& weights,
                                 std::size_t count, float green, Code* codes) {
    return codes_of<flat>(rows, weights, count, green, codes);
}
template <FlatCode flat, typename Code>
RELIEF_TARGET_256 bool codes_256(const std::array<const float*, 3>& rows, const Weights3x3& weights,
                                 std::size_t count, float green, Code* codes) {
    return codes_of<flat>(rows, weights, count, green, codes);
}
template <FlatCode flat, typename Code>
[[gnu::noinline]] bool codes_any(const std::array<const float*, 3>& rows, const Weights3x3& weights,
                                 std::size_t count, float green, Code* codes) {
    return codes_of<flat>(rows, weights, count, green, codes);
}

template <FlatCode flat, typename Code>
bool codes_with(VectorTarget target, const std::array<const float*, 3>& rows,
                const Weights3x3& weights, std::size_t count, float green, Code* codes) {
    switch (target) {
        case VectorTarget::widest:
            return codes_512<flat>(rows, weights, count, green, codes);
        case VectorTarget::wide:
            return codes_256<flat>(rows, weights, count, green, codes);
        case VectorTarget::any:
            break;
    }
    return codes_any<flat>(rows, weights, count, green, codes);
}

}  // namespace

template <typename Code>
bool codes_3x3(VectorTarget target, const std::array<const float*, 3>& rows,
               const Weights3x3& weights, std::size_t count, const NormalMapFormat& format,
               Code* codes) {
    const float green = format.green == Green::up ? 1.0F : -1.0F;
    if (format.flat == FlatCode::half)
        return codes_with<FlatCode::half>(target, rows, weights, count, green, codes);
    return codes_with<FlatCode::middle>(target, rows, weights, count, green, codes);
}

template bool codes_3x3(VectorTarget, const std::array<const float*, 3>&, const Weights3x3&,
                        std::size_t, const NormalMapFormat&, std::uint8_t*);
template bool codes_3x3(VectorTarget, const std::array<const float*, 3>&, const Weights3x3&,
                        std::size_t, const NormalMapFormat&, std::uint16_t*);

}  // namespace relief
