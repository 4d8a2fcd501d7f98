// SPDX-License-Identifier: Apache-2.0
// Plain PNG files: chunks with their checksums -> zlib stream -> filtered rows -> samples.
// Whatever is odd gives nothing, and the image module is asked instead: a file that is wrong in any
// way, or of the few kinds not known here. Source: [ISO/IEC 15948].
// Tests: tests/mesh/io/png/png_test.cpp, image/image_file_real_test.cpp.
#include "io/png/png_decoder.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>
#include <utility>

#include "io/png/deflate.h"
#include "io/png/png_filter.h"
#include "large_memory.h"
#include "relief/mesh/image_file.h"

namespace relief {
namespace {

using Bytes = std::span<const std::byte>;

constexpr int palette_type = 3;

std::uint32_t big32_at(Bytes bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
        value = value << 8 | std::to_integer<std::uint32_t>(bytes[at + i]);
    return value;
}

int code_at(Bytes bytes, std::size_t at) {
    return std::to_integer<int>(bytes[at]);
}

/// The chunks' contents, or nothing where a checksum is wrong or their order is not the usual one.
struct Chunks : PngChunks {
    std::vector<std::byte> packed;
};

std::optional<Chunks> chunks_of(Bytes stripped) {
    constexpr std::size_t signature = 8;
    constexpr std::size_t frame = 12;  // Length, type and checksum around a chunk's data.
    Chunks chunks;
    chunks.packed.reserve(stripped.size());
    for (std::size_t at = signature; stripped.size() - at >= frame;) {
        const std::size_t length = big32_at(stripped, at);
        if (length > stripped.size() - at - frame) return std::nullopt;
        const Bytes data = stripped.subspan(at + 8, length);
        if (crc32(stripped.subspan(at + 4, length + 4)) != big32_at(stripped, at + 8 + length))
            return std::nullopt;
        const Bytes type_bytes = stripped.subspan(at + 4, 4);
        const std::string_view type(reinterpret_cast<const char*>(type_bytes.data()), 4);
        if ((type == "IHDR") != (at == signature)) return std::nullopt;
        if (type == "IHDR") chunks.header = data;
        if (type == "PLTE") {
            if (!chunks.palette.empty() || !chunks.packed.empty()) return std::nullopt;
            chunks.palette = data;
        }
        if (type == "tRNS") {
            if (!chunks.transparency.empty() || !chunks.packed.empty()) return std::nullopt;
            chunks.transparency = data;
        }
        if (type == "IDAT") chunks.packed.insert(chunks.packed.end(), data.begin(), data.end());
        if (type == "IEND") return chunks;
        at += length + frame;
    }
    return std::nullopt;
}

/// RGB, or RGBA where some entry is not opaque; nothing where the chunks do not fit together.
std::optional<std::vector<std::uint8_t>> palette_from(const PngChunks& chunks, int bits) {
    const std::size_t count = chunks.palette.size() / 3;
    const std::size_t opaque_from = chunks.transparency.size();
    if (count == 0 || count * 3 != chunks.palette.size() || count > std::size_t{1} << bits ||
        opaque_from > count) {
        return std::nullopt;
    }
    std::vector<std::uint8_t> palette;
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t k = 0; k < 3; ++k)
            palette.push_back(static_cast<std::uint8_t>(chunks.palette[3 * i + k]));
        if (opaque_from > 0) {
            palette.push_back(i < opaque_from ? static_cast<std::uint8_t>(chunks.transparency[i])
                                              : std::uint8_t{255});
        }
    }
    return palette;
}

bool is_allowed(int type, int bits) {
    if (bits == 8) return true;
    if (bits == 16) return type != palette_type;
    return (type == 0 || type == palette_type) && (bits == 1 || bits == 2 || bits == 4);
}

/// A row of samples of 1, 2, 4 or 8 bits as 8-bit ones, indices as their palette's texels.
bool unpack_small(const PlainPng& png, const std::uint8_t* stored, std::uint8_t* samples) {
    const auto bits = static_cast<unsigned>(png.stored_bits);
    const unsigned mask = (1U << bits) - 1U;
    const auto channels = static_cast<std::size_t>(png.channels);
    for (unsigned x = 0; x < static_cast<unsigned>(png.width); ++x) {
        const unsigned bit = x * bits;
        const unsigned value = stored[bit / 8] >> (8 - bits - bit % 8) & mask;
        if (png.palette.empty()) {
            *samples++ = static_cast<std::uint8_t>(value * 255U / mask);
            continue;
        }
        if ((value + 1) * channels > png.palette.size()) return false;
        samples = std::copy_n(png.palette.data() + value * channels, channels, samples);
    }
    return true;
}

/// The whole stream, unfiltered and unpacked.
template <typename Sample>
std::optional<Image::Samples> decoded_as(const PlainPng& png) {
    const std::size_t size = png.stored_row_size();
    const auto rows = static_cast<std::size_t>(png.height);
    std::vector<std::uint8_t> bytes((size + 1) * rows);
    if (!inflate(png.packed, std::as_writable_bytes(std::span(bytes)))) return std::nullopt;
    std::vector<Sample> samples;
    reserve_to_fill(samples, png.row_size() / sizeof(Sample) * rows);
    samples.resize(png.row_size() / sizeof(Sample) * rows);
    const std::vector<std::uint8_t> zeros(size, 0);
    std::span<const std::uint8_t> above = zeros;
    std::byte* to = std::as_writable_bytes(std::span(samples)).data();
    for (std::size_t y = 0; y < rows; ++y, to += png.row_size()) {
        std::uint8_t* const line = bytes.data() + y * (size + 1);
        const std::span row(line + 1, size);
        if (!undo_filter(line[0], png.step(), row, above)) return std::nullopt;
        if (!unpack_row(png, row, to)) return std::nullopt;
        above = row;
    }
    return samples;
}

}  // namespace

std::size_t PlainPng::stored_row_size() const {
    return (static_cast<std::size_t>(width) *
                static_cast<std::size_t>(stored_bits * stored_channels) +
            7) /
           8;
}

std::size_t PlainPng::row_size() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(channels * bits() / 8);
}

std::size_t PlainPng::step() const {
    return std::max<std::size_t>(static_cast<std::size_t>(stored_bits * stored_channels) / 8, 1);
}

bool unpack_row(const PlainPng& png, std::span<const std::uint8_t> stored, std::byte* samples) {
    auto* const bytes = reinterpret_cast<std::uint8_t*>(samples);
    if (png.stored_bits < 8 || !png.palette.empty()) return unpack_small(png, stored.data(), bytes);
    std::memcpy(bytes, stored.data(), stored.size());
    if (png.stored_bits == 16) {
        for (std::size_t i = 0; i < stored.size(); i += 2)
            std::swap(bytes[i], bytes[i + 1]);  // PNG has the high byte first.
    }
    return true;
}

std::optional<PlainPng> plain_png(const PngChunks& chunks) {
    const Bytes header = chunks.header;
    if (header.size() != 13) return std::nullopt;
    static constexpr std::array channels_of_type{1, 0, 3, 1, 2, 0, 4};
    const std::uint64_t width = big32_at(header, 0);
    const std::uint64_t height = big32_at(header, 4);
    const int type = code_at(header, 9);
    PlainPng png;
    png.stored_bits = code_at(header, 8);
    if (type >= static_cast<int>(channels_of_type.size()) || !is_allowed(type, png.stored_bits))
        return std::nullopt;
    png.stored_channels = channels_of_type[static_cast<std::size_t>(type)];
    const bool is_usual = code_at(header, 10) == 0 && code_at(header, 11) == 0;
    const bool is_interlaced = code_at(header, 12) != 0;
    constexpr std::uint64_t largest = std::numeric_limits<int>::max();
    if (png.stored_channels == 0 || !is_usual || is_interlaced || width == 0 || height == 0 ||
        width > largest || height > largest) {
        return std::nullopt;
    }
    png.channels = png.stored_channels;
    if (type == palette_type) {
        auto palette = palette_from(chunks, png.stored_bits);
        if (!palette) return std::nullopt;
        png.palette = std::move(*palette);
        png.channels = chunks.transparency.empty() ? 3 : 4;
    } else if (!chunks.transparency.empty()) {
        return std::nullopt;
    }
    png.width = static_cast<int>(width);
    png.height = static_cast<int>(height);
    return png;
}

std::optional<PlainPng> open_plain_png(std::span<const std::byte> stripped) {
    std::optional<Chunks> chunks = chunks_of(stripped);
    if (!chunks) return std::nullopt;
    std::optional<PlainPng> png = plain_png(*chunks);
    constexpr std::size_t most_texels = max_image_samples / 4;
    if (!png || static_cast<std::size_t>(png->width) >
                    most_texels / static_cast<std::size_t>(png->height)) {
        return std::nullopt;
    }
    png->packed = std::move(chunks->packed);
    return png;
}

std::optional<Image::Samples> decode(const PlainPng& png) {
    if (png.stored_bits == 16) return decoded_as<std::uint16_t>(png);
    return decoded_as<std::uint8_t>(png);
}

}  // namespace relief
