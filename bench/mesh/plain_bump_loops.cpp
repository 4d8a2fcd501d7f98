// SPDX-License-Identifier: Apache-2.0
#include "mesh/plain_bump_loops.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace relief::bench {
using namespace relief::detail;

namespace {

struct Weights {
    float own, beside;
};

RELIEF_INLINE std::uint16_t code_of(float steps) {
    return static_cast<std::uint16_t>(static_cast<std::int32_t>(std::max(0.0F, 32768.0F + steps)));
}

RELIEF_INLINE void interleave(const std::uint16_t* __restrict x, const std::uint16_t* __restrict y,
                              const std::uint16_t* __restrict z, std::size_t count,
                              std::uint16_t* __restrict codes) {
    for (std::size_t i = 0; i < count; ++i) {
        codes[3 * i] = x[i];
        codes[3 * i + 1] = y[i];
        codes[3 * i + 2] = z[i];
    }
}

/// \param above, here, below  the column before the first one
template <std::size_t block_size>
RELIEF_INLINE void sobel_block(const float* __restrict above, const float* __restrict here,
                               const float* __restrict below, Weights w, std::size_t count,
                               std::uint16_t* __restrict codes) {
    // Stores at every third place are slow, so that components are interleaved in a second loop.
    alignas(64) std::array<std::uint16_t, block_size> x, y, z;
    for (std::size_t i = 0; i < count; ++i) {
        const float rising = above[i + 2] - below[i];
        const float falling = below[i + 2] - above[i];
        const float right = w.own * (here[i + 2] - here[i]) + w.beside * (rising + falling);
        const float up = w.own * (above[i + 1] - below[i + 1]) + w.beside * (rising - falling);
        const float scale = 32767.5F / std::sqrt(right * right + up * up + 1.0F);
        x[i] = code_of(-right * scale);
        y[i] = code_of(-up * scale);
        z[i] = code_of(scale);
    }
    interleave(x.data(), y.data(), z.data(), count, codes);
}

template <std::size_t block_size>
RELIEF_INLINE void sobel_image(const float* heights, std::size_t width, std::size_t height,
                               Weights weights, std::uint16_t* codes) {
    for (std::size_t row = 0; row < height; ++row) {
        const std::array rows = {heights + (row + height - 1) % height * width,
                                 heights + row * width, heights + (row + 1) % height * width};
        std::uint16_t* const to = codes + 3 * row * width;
        for (std::size_t first = 1; first + 1 < width; first += block_size)
            sobel_block<block_size>(rows[0] + first - 1, rows[1] + first - 1, rows[2] + first - 1,
                                    weights, std::min(block_size, width - 1 - first),
                                    to + 3 * first);
        for (const std::size_t column : {std::size_t{0}, width - 1}) {
            float around[3][3];
            for (std::size_t i = 0; i < 3; ++i) {
                for (std::size_t k = 0; k < 3; ++k)
                    around[i][k] = rows[i][(column + width + k - 1) % width];
            }
            sobel_block<1>(around[0], around[1], around[2], weights, 1, to + 3 * column);
        }
    }
}

RELIEF_INLINE void slopes_loop(const float* __restrict right, const float* __restrict down,
                               std::size_t count, std::uint16_t* __restrict codes) {
    constexpr std::size_t block_size = 512;
    alignas(64) std::array<std::uint16_t, block_size> x, y, z;
    for (std::size_t first = 0; first < count; first += block_size) {
        const std::size_t size = std::min(block_size, count - first);
        for (std::size_t i = 0; i < size; ++i) {
            const float a = right[first + i];
            const float b = down[first + i];
            const float scale = 32767.5F / std::sqrt(a * a + b * b + 1.0F);
            x[i] = code_of(-a * scale);
            y[i] = code_of(b * scale);
            z[i] = code_of(scale);
        }
        interleave(x.data(), y.data(), z.data(), size, codes + 3 * first);
    }
}

template <std::size_t block_size>
RELIEF_TARGET_512 void sobel_512(const float* heights, std::size_t width, std::size_t height,
                                 Weights weights, std::uint16_t* codes) {
    sobel_image<block_size>(heights, width, height, weights, codes);
}
template <std::size_t block_size>
RELIEF_TARGET_256 void sobel_256(const float* heights, std::size_t width, std::size_t height,
                                 Weights weights, std::uint16_t* codes) {
    sobel_image<block_size>(heights, width, height, weights, codes);
}
template <std::size_t block_size>
[[gnu::noinline]] void sobel_any(const float* heights, std::size_t width, std::size_t height,
                                 Weights weights, std::uint16_t* codes) {
    sobel_image<block_size>(heights, width, height, weights, codes);
}

template <std::size_t block_size>
void sobel_with(VectorTarget target, const Image& heights, Weights weights, Image& map) {
    const float* const in = heights.as<float>().data();
    std::uint16_t* const out = map.as<std::uint16_t>().data();
    const auto width = static_cast<std::size_t>(heights.width);
    const auto height = static_cast<std::size_t>(heights.height);
    switch (target) {
        case VectorTarget::widest:
            return sobel_512<block_size>(in, width, height, weights, out);
        case VectorTarget::wide:
            return sobel_256<block_size>(in, width, height, weights, out);
        case VectorTarget::any:
            return sobel_any<block_size>(in, width, height, weights, out);
    }
}

RELIEF_TARGET_512 void slopes_512(const float* right, const float* down, std::size_t count,
                                  std::uint16_t* codes) {
    slopes_loop(right, down, count, codes);
}
RELIEF_TARGET_256 void slopes_256(const float* right, const float* down, std::size_t count,
                                  std::uint16_t* codes) {
    slopes_loop(right, down, count, codes);
}

}  // namespace

void plain_sobel_codes(VectorTarget target, std::size_t block_size, const Image& heights,
                       float strength, Image& map) {
    const Weights weights{2.0F * (strength / 8.0F), strength / 8.0F};
    if (block_size == 128)
        sobel_with<128>(target, heights, weights, map);
    else
        sobel_with<512>(target, heights, weights, map);
}

void plain_codes_of_slopes(VectorTarget target, const float* right, const float* down,
                           std::size_t count, std::uint16_t* codes) {
    switch (target) {
        case VectorTarget::widest:
            return slopes_512(right, down, count, codes);
        case VectorTarget::wide:
            return slopes_256(right, down, count, codes);
        case VectorTarget::any:
            return slopes_loop(right, down, count, codes);
    }
}

}  // namespace relief::bench
