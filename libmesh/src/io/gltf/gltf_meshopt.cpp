// SPDX-License-Identifier: Apache-2.0
// Decodes buffer views that EXT_meshopt_compression or KHR_meshopt_compression has compressed.
//
// Debian's meshoptimizer 0.18 does not know version 1 of the attribute codec and the color filter,
// which KHR_meshopt_compression added. The first part of this file implements them; all reads are
// checked. Source: the glTF extension KHR_meshopt_compression, appendices A and B.
#include "io/gltf/gltf_compression.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>

#include "io/gltf/gltf_contents.h"
#include "large_memory.h"
#include "progress_stage.h"
#include "relief/mesh/report.h"

namespace relief::detail {
namespace {

constexpr std::size_t group_size = 16;
constexpr std::size_t max_block_elements = 256;
constexpr std::size_t channel_size = 4;
constexpr std::size_t min_tail_size = 24;

using Deltas = std::array<std::uint8_t, max_block_elements>;

/// Reads bytes in order; reading past the end gives nullopt.
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

/// Decodes 16 deltas of `bits` bits each. A code with all bits set is replaced by a byte that
/// follows the group.
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
        // 1-bit codes start at the lowest bit of a byte, wider ones at the highest.
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

/// Decodes the deltas of one byte position for all elements of a block.
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

/// Undoes zigzag coding (0, -1, 1, -2, ...), which maps small differences of both signs to small
/// codes.
template <typename Value>
Value zigzag_decoded(Value code) {
    const auto half = static_cast<Value>(code >> 1);
    return (code & 1) != 0 ? static_cast<Value>(~half) : half;
}

/// Decodes values of one type in a channel. Each one is a difference from the one before; `last`
/// holds the last value.
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

/// Decodes the four bytes of one channel for all elements of a block.
void apply_channel(unsigned mode, const std::array<Deltas, channel_size>& deltas, std::size_t count,
                   std::size_t stride, char* last, char* elements) {
    const auto add = []<typename Value>(Value previous, Value code) {
        return static_cast<Value>(previous + zigzag_decoded(code));
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
            // The encoder rotated the difference left by this many bits.
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

/// Decodes colors of one component size. `Signed` is the type of the chroma components.
template <typename Unsigned, typename Signed>
void decode_colors(std::string& elements) {
    constexpr int largest = std::numeric_limits<Unsigned>::max();
    for (std::size_t at = 0; at < elements.size(); at += 4 * sizeof(Unsigned)) {
        std::array<Unsigned, 4> color;
        std::memcpy(color.data(), elements.data() + at, sizeof(color));
        // The highest bit of alpha encodes the number of bits of the components.
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
    const std::size_t padded_tail = std::max(tail_size, min_tail_size);
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
        std::min(8192 / stride / group_size * group_size, max_block_elements);
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

namespace {

/// The parameters of one compressed view, and its bytes.
struct PackedView {
    std::string mode;
    std::string filter;
    std::size_t count = 0;
    std::size_t stride = 0;
    std::string_view bytes;
};

PackedView packed_view(const GltfContents& contents, const Json& packed) {
    const std::string_view buffer = contents.buffers[size_in(packed, "buffer")].bytes();
    const std::size_t offset = size_in(packed, "byteOffset");
    const std::size_t length = size_in(packed, "byteLength");
    if (offset + length > buffer.size()) fail_gltf("its data lies in a buffer without data");
    PackedView view;
    view.mode = text_in(packed, "mode");
    view.filter = packed.contains("filter") ? text_in(packed, "filter") : "NONE";
    view.count = size_in(packed, "count");
    view.stride = size_in(packed, "byteStride");
    view.bytes = buffer.substr(offset, length);
    return view;
}

/// Checks that the mode and the filter allow the stride.
void check_stride(const PackedView& view) {
    const std::size_t stride = view.stride;
    bool fits = false;
    if (view.mode == "ATTRIBUTES") {
        fits = stride % 4 == 0 && stride >= 4 && stride <= 256;
        if (view.filter == "OCTAHEDRAL" || view.filter == "COLOR") {
            fits = stride == 4 || stride == 8;
        } else if (view.filter == "QUATERNION") {
            fits = stride == 8;
        } else if (view.filter != "EXPONENTIAL" && view.filter != "NONE") {
            fail_gltf("its filter is '{}'", view.filter);
        }
    } else if (view.mode == "TRIANGLES" || view.mode == "INDICES") {
        if (view.filter != "NONE") fail_gltf("{} have no filter {}", view.mode, view.filter);
        fits = stride == 2 || stride == 4;
    } else {
        fail_gltf("its mode is '{}'", view.mode);
    }
    if (!fits) fail_gltf("{} with filter {} have no stride of {}", view.mode, view.filter, stride);
    if (view.mode == "TRIANGLES" && view.count % 3 != 0)
        fail_gltf("{} indices are not a multiple of 3", view.count);
}

/// Checks that this many bytes can decode to the claimed length.
void check_length(const PackedView& view, std::size_t length) {
    // The best ratio: in version 1 of the attributes, one control byte stands for four byte
    // positions of 256 equal elements.
    constexpr std::size_t max_expansion = 1024;
    // Both factors are below 2^53, and strides are below 2^9 here: nothing overflows.
    if (view.count > length || view.count * view.stride != length) {
        fail_gltf("{} elements of {} bytes are not the {} bytes of the view", view.count,
                  view.stride, length);
    }
    if (length / max_expansion > view.bytes.size())
        fail_gltf("{} bytes cannot encode {}", view.bytes.size(), length);
}

bool decode_view(const PackedView& view, std::string& elements) {
    const auto* data = reinterpret_cast<const unsigned char*>(view.bytes.data());
    const std::size_t size = view.bytes.size();
    if (view.mode == "TRIANGLES")
        return meshopt_decodeIndexBuffer(elements.data(), view.count, view.stride, data, size) == 0;
    if (view.mode == "INDICES") {
        return meshopt_decodeIndexSequence(elements.data(), view.count, view.stride, data, size) ==
               0;
    }
    if (size > 0 && data[0] == meshopt_attributes_v1)
        return decode_meshopt_attributes_v1(view.bytes, view.count, view.stride, elements);
    return meshopt_decodeVertexBuffer(elements.data(), view.count, view.stride, data, size) == 0;
}

void unfilter(const PackedView& view, std::string& elements) {
    if (view.filter == "OCTAHEDRAL") {
        meshopt_decodeFilterOct(elements.data(), view.count, view.stride);
    } else if (view.filter == "QUATERNION") {
        meshopt_decodeFilterQuat(elements.data(), view.count, view.stride);
    } else if (view.filter == "EXPONENTIAL") {
        meshopt_decodeFilterExp(elements.data(), view.count, view.stride);
    } else if (view.filter == "COLOR") {
        decode_meshopt_colors(elements, view.stride);
    }
}

std::string unpacked_bytes(const PackedView& view, std::size_t length, MemoryBudget& budget) {
    check_stride(view);
    check_length(view, length);
    require_memory(length, 1);
    budget.take(length, 1, [] { return "its data"; });
    std::string elements(length, '\0');
    if (length == 0) return elements;
    if (!decode_view(view, elements)) fail_gltf("its data is damaged");
    unfilter(view, elements);
    return elements;
}

/// Returns the name of the extension that compresses a view, or null.
const char* extension_of(const Json& view) {
    for (const char* extension : meshopt_extensions) {
        if (find(view, "extensions", extension) != nullptr) return extension;
    }
    return nullptr;
}

/// Replaces one view by its decoded form.
void unpack_view(GltfContents& contents, std::size_t number, const char* extension) {
    const Json packed = contents.root["bufferViews"][number]["extensions"][extension];
    const std::size_t length = size_in(contents.root["bufferViews"][number], "byteLength");
    std::string elements;
    try {
        elements = unpacked_bytes(packed_view(contents, packed), length, contents.budget);
    } catch (const InvalidInput& error) {
        fail_gltf("bufferViews[{}].extensions.{}: {}", number, extension, error.what());
    }
    const std::size_t offset = append_bytes(contents, elements);
    Json& view = contents.root["bufferViews"][number];
    view["buffer"] = contents.added_buffer;
    view["byteOffset"] = offset;
    erase_extension(view, extension);
    const std::size_t begin = size_in(packed, "byteOffset");
    contents.retired_bytes.push_back(
        {size_in(packed, "buffer"), begin, begin + size_in(packed, "byteLength")});
    ++contents.unpacked[extension];
}

bool is_marked_fallback(const Json& buffer) {
    for (const char* extension : meshopt_extensions) {
        const Json* fallback = find(buffer, "extensions", extension, "fallback");
        if (fallback != nullptr && *fallback == true) return true;
    }
    return false;
}

}  // namespace

std::vector<bool> meshopt_placeholders(const Json& root, bool has_binary_chunk) {
    const Json& buffers = array_in(root, "buffers");
    std::vector<bool> has_views(buffers.size(), false);
    std::vector<bool> needs_data(buffers.size(), false);
    for (const Json& view : array_in(root, "bufferViews")) {
        const std::size_t buffer = size_in(view, "buffer");
        const char* extension = extension_of(view);
        has_views[buffer] = true;
        if (extension == nullptr)
            needs_data[buffer] = true;
        else
            needs_data[size_in(view["extensions"][extension], "buffer")] = true;
    }
    std::vector<bool> result(buffers.size(), false);
    for (std::size_t i = 0; i < buffers.size(); ++i) {
        const bool is_chunk = i == 0 && has_binary_chunk && !is_marked_fallback(buffers[i]);
        result[i] = !buffers[i].contains("uri") && !is_chunk && has_views[i] && !needs_data[i];
    }
    return result;
}

void unpack_meshopt(GltfContents& contents) {
    std::vector<std::size_t> packed_views;
    std::size_t total = 0;
    const Json& views = array_in(contents.root, "bufferViews");
    for (std::size_t i = 0; i < views.size(); ++i) {
        if (!contents.buffers[size_in(views[i], "buffer")].is_placeholder) continue;
        packed_views.push_back(i);
        total += size_in(views[i], "byteLength");
    }
    if (packed_views.empty()) return;
    std::size_t packed_size = 0;
    for (const GltfBuffer& buffer : contents.buffers)
        packed_size += buffer.size;
    // One allocation, but limited by what the data can plausibly need.
    reserve_bytes(contents, std::min(total, 16 * packed_size));
    ProgressStage stage("unpacking", packed_views.size());
    for (const std::size_t i : packed_views) {
        unpack_view(contents, i, extension_of(contents.root["bufferViews"][i]));
        stage.advance(1);
    }
    for (const char* extension : meshopt_extensions) {
        for (std::size_t i = 0; i < contents.buffers.size(); ++i) {
            if (contents.buffers[i].is_placeholder)
                erase_extension(contents.root["buffers"][i], extension);
        }
        remove_unused_extension(contents.root, extension);
    }
}

}  // namespace relief::detail
