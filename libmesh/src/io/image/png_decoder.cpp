// SPDX-License-Identifier: Apache-2.0
// Plain PNG files: chunks with their checksums -> zlib stream -> filtered rows -> samples.
// Whatever is odd gives nothing, and the image module is asked instead: a file that is wrong in any
// way, or of the few kinds not known here. Source: [ISO/IEC 15948].
// Tests: tests/mesh/io/image/png_test.cpp, image_file_real_test.cpp.
#include "io/image/png_decoder.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "io/image/deflate.h"
#include "io/image/png_filter.h"
#include "relief/mesh/image_file.h"

namespace relief {
namespace {

using Bytes = std::span<const std::byte>;

constexpr int palette_type = 3;

std::uint32_t big32(Bytes bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
        value = value << 8 | std::to_integer<std::uint32_t>(bytes[at + i]);
    return value;
}

int byte_at(Bytes bytes, std::size_t at) {
    return std::to_integer<int>(bytes[at]);
}

/// The chunks' contents, or nothing where a checksum is wrong or their order is not the usual one.
struct Chunks {
    Bytes header;
    Bytes palette;
    Bytes transparency;
    std::vector<std::byte> packed;
};

std::optional<Chunks> chunks_of(Bytes stripped) {
    constexpr std::size_t signature = 8;
    constexpr std::size_t frame = 12;  // Length, type and checksum around a chunk's data.
    Chunks chunks;
    chunks.packed.reserve(stripped.size());
    for (std::size_t at = signature; stripped.size() - at >= frame;) {
        const std::size_t length = big32(stripped, at);
        if (length > stripped.size() - at - frame) return std::nullopt;
        const Bytes data = stripped.subspan(at + 8, length);
        if (crc32(stripped.subspan(at + 4, length + 4)) != big32(stripped, at + 8 + length))
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
std::optional<std::vector<std::uint8_t>> palette_from(const Chunks& chunks, int bits) {
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

/// How the rows of a PNG lie in its stream.
struct Rows {
    std::size_t size = 0;  ///< In bytes, without the one that names the filter.
    std::size_t step = 0;  ///< From a sample to the same of the texel on the left.
    std::size_t count = 0;
};

Rows rows_of(const PlainPng& png) {
    const auto texel_bits = static_cast<std::size_t>(png.stored_bits * png.stored_channels);
    return {(static_cast<std::size_t>(png.width) * texel_bits + 7) / 8,
            std::max<std::size_t>(texel_bits / 8, 1), static_cast<std::size_t>(png.height)};
}

/// All rows, one behind the other, in one piece of memory: each moves to the front by the filter
/// bytes before it.
std::optional<std::vector<std::uint8_t>> unfiltered_rows(const PlainPng& png) {
    const Rows rows = rows_of(png);
    std::vector<std::uint8_t> bytes((rows.size + 1) * rows.count);
    if (!inflate(png.packed, std::as_writable_bytes(std::span(bytes)))) return std::nullopt;
    const std::vector<std::uint8_t> zeros(rows.size, 0);
    std::span<const std::uint8_t> above = zeros;
    for (std::size_t y = 0; y < rows.count; ++y) {
        std::uint8_t* const line = bytes.data() + y * (rows.size + 1);
        if (!undo_filter(line[0], rows.step, {line + 1, rows.size}, above)) return std::nullopt;
        std::uint8_t* const row = bytes.data() + y * rows.size;
        std::memmove(row, line + 1, rows.size);
        above = {row, rows.size};
    }
    bytes.resize(rows.size * rows.count);
    return bytes;
}

/// Samples of 1, 2, 4 or 8 bits as 8-bit ones, indices as their palette's texels; nothing where an
/// index is beyond the palette.
std::optional<std::vector<std::uint8_t>> unpacked(const PlainPng& png,
                                                  const std::vector<std::uint8_t>& bytes) {
    const std::size_t row_size = rows_of(png).size;
    const auto bits = static_cast<unsigned>(png.stored_bits);
    const unsigned mask = (1U << bits) - 1U;
    const auto channels = static_cast<std::size_t>(png.channels);
    std::vector<std::uint8_t> samples;
    samples.reserve(static_cast<std::size_t>(png.width) * static_cast<std::size_t>(png.height) *
                    channels);
    for (std::size_t row = 0; row < bytes.size(); row += row_size) {
        for (unsigned x = 0; x < static_cast<unsigned>(png.width); ++x) {
            const unsigned bit = x * bits;
            const unsigned value = bytes[row + bit / 8] >> (8 - bits - bit % 8) & mask;
            if (png.palette.empty()) {
                samples.push_back(static_cast<std::uint8_t>(value * 255U / mask));
                continue;
            }
            if ((value + 1) * channels > png.palette.size()) return std::nullopt;
            const auto entry = png.palette.begin() + static_cast<std::ptrdiff_t>(value * channels);
            samples.insert(samples.end(), entry, entry + png.channels);
        }
    }
    return samples;
}

/// PNG has the high byte first.
std::vector<std::uint16_t> words_of(const std::vector<std::uint8_t>& bytes) {
    std::vector<std::uint16_t> words(bytes.size() / 2);
    for (std::size_t i = 0; i < words.size(); ++i)
        words[i] = static_cast<std::uint16_t>(bytes[2 * i] << 8 | bytes[2 * i + 1]);
    return words;
}

}  // namespace

std::optional<PlainPng> open_plain_png(std::span<const std::byte> stripped) {
    std::optional<Chunks> chunks = chunks_of(stripped);
    if (!chunks || chunks->header.size() != 13) return std::nullopt;
    const Bytes header = chunks->header;
    static constexpr std::array channels_of_type{1, 0, 3, 1, 2, 0, 4};
    const std::uint64_t width = big32(header, 0);
    const std::uint64_t height = big32(header, 4);
    const int type = byte_at(header, 9);
    PlainPng png;
    png.stored_bits = byte_at(header, 8);
    if (type >= static_cast<int>(channels_of_type.size()) || !is_allowed(type, png.stored_bits))
        return std::nullopt;
    png.stored_channels = channels_of_type[static_cast<std::size_t>(type)];
    const bool is_usual = byte_at(header, 10) == 0 && byte_at(header, 11) == 0;
    const bool is_interlaced = byte_at(header, 12) != 0;
    constexpr std::uint64_t most_texels = max_image_samples / 4;
    if (png.stored_channels == 0 || !is_usual || is_interlaced || width == 0 || height == 0 ||
        width > most_texels / height) {
        return std::nullopt;
    }
    png.channels = png.stored_channels;
    if (type == palette_type) {
        auto palette = palette_from(*chunks, png.stored_bits);
        if (!palette) return std::nullopt;
        png.palette = std::move(*palette);
        png.channels = chunks->transparency.empty() ? 3 : 4;
    } else if (!chunks->transparency.empty()) {
        return std::nullopt;
    }
    png.width = static_cast<int>(width);
    png.height = static_cast<int>(height);
    png.packed = std::move(chunks->packed);
    return png;
}

std::optional<Image::Samples> decode(const PlainPng& png) {
    std::optional<std::vector<std::uint8_t>> bytes = unfiltered_rows(png);
    if (!bytes) return std::nullopt;
    if (png.stored_bits == 16) return words_of(*bytes);
    if (png.stored_bits == 8 && png.palette.empty()) return std::move(*bytes);
    return unpacked(png, *bytes);
}

}  // namespace relief
