// SPDX-License-Identifier: Apache-2.0
// Version 1 of meshopt's attribute codec and its colour filter, after appendices A and B of
// KHR_meshopt_compression; the words are the specification's: blocks of elements, one data block
// for every byte of an element, groups of 16 deltas, channels of 4 bytes.
// Tests: tests/mesh/io/gltf/gltf_meshopt_test.cpp.
#include "io/gltf/meshopt_bitstream.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>

namespace relief {
namespace {

constexpr std::size_t group_size = 16;
constexpr std::size_t most_block_elements = 256;
constexpr std::size_t channel_size = 4;
constexpr std::size_t smallest_tail = 24;

using Deltas = std::array<std::uint8_t, most_block_elements>;

/// Bytes one after the other; nothing behind the end.
class ByteReader {
  public:
    explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

    std::optional<std::string_view> take(std::size_t count) {
        if (count > bytes_.size()) return std::nullopt;
        const std::string_view taken = bytes_.substr(0, count);
        bytes_.remove_prefix(count);
        return taken;
    }
    [[nodiscard]] bool is_at_end() const { return bytes_.empty(); }

  private:
    std::string_view bytes_;
};

std::uint8_t byte_at(std::string_view bytes, std::size_t index) {
    return static_cast<std::uint8_t>(bytes[index]);
}

/// 16 deltas of `bits` bits each; those with all bits set stand for a byte behind them.
bool decode_group(ByteReader& data, unsigned bits, std::uint8_t* deltas) {
    if (bits == 0) {
        std::fill_n(deltas, group_size, std::uint8_t{0});
        return true;
    }
    const auto packed = data.take(group_size * bits / 8);
    if (!packed) return false;
    if (bits == 8) {
        std::memcpy(deltas, packed->data(), group_size);
        return true;
    }
    const unsigned per_byte = 8 / bits;
    const auto sentinel = static_cast<std::uint8_t>((1U << bits) - 1);
    for (unsigned i = 0; i < group_size; ++i) {
        // Single bits begin at the lowest of a byte, all others at the highest.
        const unsigned place = i % per_byte;
        const unsigned shift = bits == 1 ? place : 8 - bits * (place + 1);
        const auto code =
            static_cast<std::uint8_t>(byte_at(*packed, i / per_byte) >> shift) & sentinel;
        deltas[i] = static_cast<std::uint8_t>(code);
        if (code != sentinel) continue;
        const auto whole = data.take(1);
        if (!whole) return false;
        deltas[i] = byte_at(*whole, 0);
    }
    return true;
}

/// The deltas of one byte position over all elements of a block.
bool decode_byte_position(ByteReader& data, unsigned control, std::size_t count, Deltas& deltas) {
    constexpr unsigned all_zero = 2;
    constexpr unsigned literal = 3;
    if (control == all_zero) {
        deltas.fill(0);
        return true;
    }
    if (control == literal) {
        const auto bytes = data.take(count);
        if (bytes) std::memcpy(deltas.data(), bytes->data(), count);
        return bytes.has_value();
    }
    static constexpr std::array<std::array<unsigned, 4>, 2> bit_lengths = {
        {{0, 1, 2, 4}, {1, 2, 4, 8}}};
    const std::size_t group_count = (count + group_size - 1) / group_size;
    const auto header = data.take((group_count + 3) / 4);
    if (!header) return false;
    for (std::size_t group = 0; group < group_count; ++group) {
        const unsigned mode = byte_at(*header, group / 4) >> (group % 4 * 2) & 3U;
        if (!decode_group(data, bit_lengths[control][mode], &deltas[group * group_size]))
            return false;
    }
    return true;
}

/// Undoes the zigzag order 0, -1, 1, -2, ... in which small differences of both signs are small.
template <typename Value>
Value unzigzagged(Value code) {
    const auto half = static_cast<Value>(code >> 1);
    return (code & 1) != 0 ? static_cast<Value>(~half) : half;
}

/// Values of one type within a channel, each from the one before it, which `last` holds.
template <typename Value, typename Undo>
void apply_deltas(const std::array<Deltas, channel_size>& deltas, std::size_t first_byte,
                  std::size_t count, std::size_t stride, char* last, char* elements,
                  const Undo& undo) {
    Value previous;
    std::memcpy(&previous, last, sizeof(Value));
    for (std::size_t i = 0; i < count; ++i) {
        Value code = 0;
        for (std::size_t k = 0; k < sizeof(Value); ++k)
            code =
                static_cast<Value>(code | static_cast<Value>(deltas[first_byte + k][i]) << (8 * k));
        previous = undo(previous, code);
        std::memcpy(elements + i * stride, &previous, sizeof(Value));
    }
    std::memcpy(last, &previous, sizeof(Value));
}

/// The four bytes of one channel, over all elements of a block.
void apply_channel(unsigned mode, const std::array<Deltas, channel_size>& deltas, std::size_t count,
                   std::size_t stride, char* last, char* elements) {
    const auto add = []<typename Value>(Value previous, Value code) {
        return static_cast<Value>(previous + unzigzagged(code));
    };
    switch (mode & 15U) {
        case 0:
            for (std::size_t k = 0; k < 4; ++k)
                apply_deltas<std::uint8_t>(deltas, k, count, stride, last + k, elements + k, add);
            break;
        case 1:
            for (std::size_t k = 0; k < 4; k += 2)
                apply_deltas<std::uint16_t>(deltas, k, count, stride, last + k, elements + k, add);
            break;
        default: {
            // The encoder turned the difference left by these bits; here it is turned back.
            const unsigned right = mode >> 4;
            apply_deltas<std::uint32_t>(deltas, 0, count, stride, last, elements,
                                        [right](std::uint32_t previous, std::uint32_t code) {
                                            return previous ^
                                                   (code >> right | code << (32 - right) % 32);
                                        });
        }
    }
}

bool is_channel_mode(std::uint8_t mode) {
    return (mode & 15U) == 2 || mode == 0 || mode == 1;
}

bool decode_block(ByteReader& data, std::string_view modes, std::size_t count, std::size_t stride,
                  std::string& last, char* elements) {
    const auto control = data.take(stride / channel_size);
    if (!control) return false;
    for (std::size_t channel = 0; channel < stride / channel_size; ++channel) {
        std::array<Deltas, channel_size> deltas;
        for (std::size_t k = 0; k < channel_size; ++k) {
            const unsigned bits = byte_at(*control, channel) >> (2 * k) & 3U;
            if (!decode_byte_position(data, bits, count, deltas[k])) return false;
        }
        const std::size_t begin = channel * channel_size;
        apply_channel(byte_at(modes, channel), deltas, count, stride, last.data() + begin,
                      elements + begin);
    }
    return true;
}

/// Colours of one component size; signed components are read as `Signed`.
template <typename Unsigned, typename Signed>
void decode_colors(std::string& elements) {
    constexpr int largest = std::numeric_limits<Unsigned>::max();
    for (std::size_t at = 0; at < elements.size(); at += 4 * sizeof(Unsigned)) {
        std::array<Unsigned, 4> color;
        std::memcpy(color.data(), elements.data() + at, sizeof(color));
        // The highest bit of alpha says how many bits the components have.
        int scale = color[3];
        for (const int shift : {1, 2, 4, 8})
            scale |= scale >> shift;
        const int y = color[0];
        const int co = static_cast<Signed>(color[1]);
        const int cg = static_cast<Signed>(color[2]);
        const int alpha = color[3] & (scale >> 1);
        const std::array<int, 4> rgba = {y + co - cg, y + cg, y - co - cg,
                                         alpha << 1 | (alpha & 1)};
        for (std::size_t k = 0; k < 4; ++k) {
            const float value = static_cast<float>(rgba[k]) * static_cast<float>(largest) /
                                static_cast<float>(std::max(scale, 1));
            color[k] =
                static_cast<Unsigned>(std::clamp(static_cast<int>(std::lround(value)), 0, largest));
        }
        std::memcpy(elements.data() + at, color.data(), sizeof(color));
    }
}

}  // namespace

bool decode_meshopt_attributes_v1(std::string_view packed, std::size_t count, std::size_t stride,
                                  std::string& elements) {
    const std::size_t tail_size = stride + stride / channel_size;
    const std::size_t padded_tail = std::max(tail_size, smallest_tail);
    if (packed.size() < 1 + padded_tail || byte_at(packed, 0) != meshopt_attributes_v1)
        return false;
    const std::string_view tail = packed.substr(packed.size() - tail_size);
    const std::string_view modes = tail.substr(stride);
    if (!std::all_of(modes.begin(), modes.end(),
                     [](char mode) { return is_channel_mode(static_cast<std::uint8_t>(mode)); })) {
        return false;
    }
    std::string last(tail.substr(0, stride));
    ByteReader data(packed.substr(1, packed.size() - 1 - padded_tail));
    const std::size_t block_size =
        std::min(8192 / stride / group_size * group_size, most_block_elements);
    for (std::size_t begin = 0; begin < count; begin += block_size) {
        if (!decode_block(data, modes, std::min(block_size, count - begin), stride, last,
                          elements.data() + begin * stride)) {
            return false;
        }
    }
    return data.is_at_end();
}

void decode_meshopt_colors(std::string& elements, std::size_t stride) {
    if (stride == 4)
        decode_colors<std::uint8_t, std::int8_t>(elements);
    else
        decode_colors<std::uint16_t, std::int16_t>(elements);
}

}  // namespace relief
