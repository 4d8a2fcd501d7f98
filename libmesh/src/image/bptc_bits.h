// SPDX-License-Identifier: Apache-2.0
/// \file
/// The bits of blocks of BC6H and BC7, and the weights of their indices.
/// Source: [Khronos Data Format], section BPTC.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace relief::detail {

inline constexpr std::size_t bptc_block_size = 16;

/// The weights of the second endpoint in 64ths, by the bits of indices.
inline constexpr std::array<std::uint8_t, 4> bptc_weights_2 = {0, 21, 43, 64};
inline constexpr std::array<std::uint8_t, 8> bptc_weights_3 = {0, 9, 18, 27, 37, 46, 55, 64};
inline constexpr std::array<std::uint8_t, 16> bptc_weights_4 = {0,  4,  9,  13, 17, 21, 26, 30,
                                                                34, 38, 43, 47, 51, 55, 60, 64};

inline unsigned bptc_weight(unsigned index, unsigned bits) {
    if (bits == 2) return bptc_weights_2[index];
    return bits == 3 ? bptc_weights_3[index] : bptc_weights_4[index];
}

class BptcBitReader {
  public:
    explicit BptcBitReader(const std::byte* block) {
        for (std::size_t i = 0; i < bptc_block_size; ++i)
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

class BptcBitWriter {
  public:
    /// Writes the lowest `count` bits.
    void write(unsigned value, unsigned count) {
        const std::uint64_t bits = value & ((1U << count) - 1U);
        words_[next_ / 64] |= bits << (next_ % 64);
        if (next_ % 64 + count > 64) words_[next_ / 64 + 1] |= bits >> (64 - next_ % 64);
        next_ += count;
    }
    void store(std::byte* block) const {
        for (std::size_t i = 0; i < bptc_block_size; ++i)
            block[i] = static_cast<std::byte>(words_[i / 8] >> (8 * (i % 8)) & 255U);
    }

  private:
    std::array<std::uint64_t, 2> words_{};
    std::size_t next_ = 0;
};

}  // namespace relief::detail
