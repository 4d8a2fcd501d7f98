// SPDX-License-Identifier: Apache-2.0
// Walks the chunks of PNG [ISO/IEC 15948], the segments of JPEG [ITU-T T.81] and the headers of TGA
// and EXR. Walks never read past the end: a truncated file is a FileError. Limits for plausible
// sizes: deflate expands at most 1032 times; a JPEG block of 8 x 8 takes at least one bit, so that
// a byte encodes fewer than 2048 samples; a TGA run has at most 128 texels.
#include "io/image/image_file_container.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>

#include "files.h"
#include "relief/mesh/report.h"

namespace relief::detail {
namespace {

using Bytes = std::span<const std::byte>;

constexpr std::uint64_t deflate_expansion = 1032;
constexpr std::uint64_t jpeg_samples_per_byte = 2048;
constexpr std::uint64_t tga_texels_per_byte = 128;

std::uint32_t byte_at(Bytes bytes, std::size_t offset) {
    return std::to_integer<std::uint32_t>(bytes[offset]);
}

std::uint32_t big16(Bytes bytes, std::size_t offset) {
    return byte_at(bytes, offset) << 8 | byte_at(bytes, offset + 1);
}

std::uint32_t little16(Bytes bytes, std::size_t offset) {
    return byte_at(bytes, offset) | byte_at(bytes, offset + 1) << 8;
}

void append(std::vector<std::byte>& to, Bytes bytes) {
    to.insert(to.end(), bytes.begin(), bytes.end());
}

/// Refuses a header that announces more than its file can hold.
void check_believable(std::uint64_t needed, std::uint64_t possible, std::uint64_t width,
                      std::uint64_t height, std::uint64_t size, const std::filesystem::path& name) {
    if (width == 0 || height == 0)
        throw FileError(name, fmt::format("is empty: {} x {} texels", width, height));
    if (needed <= possible) return;
    throw FileError(name, fmt::format("announces {} x {} texels, which its {} bytes cannot hold",
                                      width, height, size));
}

// --- PNG ---

}  // namespace

/// Parses key, zero, value; malformed text is ignored. iTXt has five more fields in between.
void keep_png_text(std::string_view type, std::string_view data,
                   std::map<std::string, std::string>& text) {
    const std::size_t key_end = data.find('\0');
    if (key_end == std::string_view::npos || key_end == 0) return;
    std::string_view value = data.substr(key_end + 1);
    if (type == "iTXt") {
        if (value.size() < 2 || value[0] != '\0') return;  // Compressed text is not read.
        value.remove_prefix(2);
        for (int field = 0; field < 2; ++field) {  // Language tag and translated key.
            const std::size_t end = value.find('\0');
            if (end == std::string_view::npos) return;
            value.remove_prefix(end + 1);
        }
    }
    text.emplace(data.substr(0, key_end), value);
}

void check_png_size(Bytes header, std::uint64_t compressed, std::uint64_t size,
                    const std::filesystem::path& name) {
    static constexpr std::array<std::uint64_t, 7> channels_of_type{1, 0, 3, 1, 2, 0, 4};
    const std::uint64_t width = big32(header, 0);
    const std::uint64_t height = big32(header, 4);
    const std::uint32_t type = byte_at(header, 9);
    if (type >= channels_of_type.size() || channels_of_type[type] == 0)
        throw FileError(name, fmt::format("PNG has no color type {}", type));
    // Width and height are below 2^32, so the bits of a row are below 2^32 * 64.
    const std::uint64_t row = (width * channels_of_type[type] * byte_at(header, 8) + 7) / 8;
    const std::uint64_t rows_possible =
        deflate_expansion * (compressed + 16) / std::max<std::uint64_t>(row, 1);
    check_believable(height, rows_possible, width, height, size, name);
}

void walk_png(std::uint64_t size, const ReadBytes& read, const std::filesystem::path& name,
              const std::function<void(const PngChunkPlace&)>& visit) {
    constexpr std::uint64_t signature = 8;
    constexpr std::uint64_t frame = 12;  // Length, type and checksum around a chunk's data.
    std::array<std::byte, 8> start{};
    PngChunkPlace chunk{signature, 0, {}};
    for (;; chunk.at += chunk.length + frame) {
        if (size - chunk.at < frame) throw FileError(name, "is cut short: it has no IEND chunk");
        read(chunk.at, start);
        chunk.length = big32(start, 0);
        chunk.type = text_of(start).substr(4);
        if (chunk.length > size - chunk.at - frame) {
            throw FileError(name, fmt::format("is cut short: the chunk at byte {} ends {} bytes "
                                              "after the file",
                                              chunk.at, chunk.length - (size - chunk.at - frame)));
        }
        visit(chunk);
        if (chunk.type == "IEND") return;
    }
}

namespace {

void strip_png(Bytes bytes, const std::filesystem::path& name, ImageContainer& container) {
    container.stripped.reserve(bytes.size());
    append(container.stripped, bytes.first(std::min<std::size_t>(bytes.size(), 8)));
    Bytes header;
    std::uint64_t compressed = 0;
    const auto read = [&](std::uint64_t from, std::span<std::byte> to) {
        std::memcpy(to.data(), bytes.data() + from, to.size());
    };
    walk_png(bytes.size(), read, name, [&](const PngChunkPlace& chunk) {
        const Bytes whole = bytes.subspan(chunk.at, chunk.length + 12);
        const Bytes data = whole.subspan(8, chunk.length);
        if (chunk.type == "IHDR" && chunk.length >= 13) header = data;
        if (chunk.type == "IDAT") compressed += chunk.length;
        if (chunk.type == "tEXt" || chunk.type == "iTXt")
            keep_png_text(chunk.type, text_of(data), container.text);
        for (const std::string_view kept : {"IHDR", "PLTE", "tRNS", "IDAT", "IEND"}) {
            if (chunk.type == kept) append(container.stripped, whole);
        }
    });
    if (header.empty()) throw FileError(name, "has no IHDR chunk");
    check_png_size(header, compressed, bytes.size(), name);
}

// --- JPEG ---

bool stands_alone(std::uint32_t marker) {
    return marker == 0x01 || (marker >= 0xD0 && marker <= 0xD8);
}

bool starts_frame(std::uint32_t marker) {
    return marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
}

/// Application data and comments are dropped, except JFIF (0) and Adobe (14), which define the
/// color coding.
bool is_dropped(std::uint32_t marker) {
    return (marker >= 0xE1 && marker <= 0xEF && marker != 0xEE) || marker == 0xFE;
}

/// Returns the offset of the next marker's code. Coded data, stuffed zeros and fill bytes are
/// skipped.
std::size_t next_marker(Bytes bytes, std::size_t at, const std::filesystem::path& name) {
    while (at + 1 < bytes.size()) {
        const void* found = std::memchr(bytes.data() + at, 0xFF, bytes.size() - at - 1);
        if (found == nullptr) break;
        at = static_cast<std::size_t>(static_cast<const std::byte*>(found) - bytes.data()) + 1;
        const std::uint32_t code = byte_at(bytes, at);
        if (code != 0x00 && code != 0xFF) return at;
    }
    throw FileError(name, "is cut short: it has no end-of-image marker");
}

void strip_jpeg(Bytes bytes, const std::filesystem::path& name, ImageContainer& container) {
    container.stripped.reserve(bytes.size());
    append(container.stripped, bytes.first(2));
    std::uint64_t width = 0, height = 0, components = 0;
    std::size_t kept_to = 2;
    for (std::size_t at = 2;;) {
        const std::size_t code_at = next_marker(bytes, at, name);
        const std::uint32_t code = byte_at(bytes, code_at);
        std::size_t end = code_at + 1;
        if (code != 0xD9 && !stands_alone(code)) {
            const std::size_t left = bytes.size() - end;
            const std::size_t length = left < 2 ? 0 : big16(bytes, end);
            if (length < 2 || length > left) {
                throw FileError(name,
                                fmt::format("is cut short: the segment at byte {} takes {} bytes, "
                                            "but there are only {}",
                                            code_at - 1, length, left));
            }
            if (starts_frame(code) && length >= 8) {
                height = big16(bytes, end + 3);
                width = big16(bytes, end + 5);
                components = byte_at(bytes, end + 7);
                check_believable(width * height * components, jpeg_samples_per_byte * bytes.size(),
                                 width, height, bytes.size(), name);
            }
            end += length;
        }
        if (is_dropped(code)) {
            append(container.stripped, bytes.subspan(kept_to, code_at - 1 - kept_to));
            kept_to = end;
        }
        at = end;
        if (code == 0xD9) break;
        if (at >= bytes.size()) next_marker(bytes, at, name);
    }
    append(container.stripped, bytes.subspan(kept_to));
    if (width == 0) throw FileError(name, "has no frame");
}

// --- TGA ---

void check_tga(Bytes bytes, const std::filesystem::path& name) {
    if (bytes.size() < 18) throw FileError(name, "is cut short: TGA starts with 18 bytes");
    const std::uint32_t type = byte_at(bytes, 2);
    // OpenImageIO 2.4 reads the entries before the first one from memory that is not initialized.
    const std::uint32_t first_entry = little16(bytes, 3);
    if ((type == 1 || type == 9) && first_entry != 0) {
        throw FileError(name, fmt::format("has a color map that starts at entry {}, but only those "
                                          "that start at entry 0 can be read",
                                          first_entry));
    }
    const std::uint64_t width = little16(bytes, 12);
    const std::uint64_t height = little16(bytes, 14);
    const std::uint64_t texel_bytes = (byte_at(bytes, 16) + 7) / 8;
    const bool run_length_coded = type >= 9;
    const std::uint64_t needed = width * height * (run_length_coded ? 1 : texel_bytes);
    check_believable(needed, bytes.size() * (run_length_coded ? tga_texels_per_byte : 1), width,
                     height, bytes.size(), name);
}

bool is_tga(Bytes bytes, const std::filesystem::path& name) {
    constexpr std::string_view footer("TRUEVISION-XFILE.\0", 18);
    if (text_of(bytes).ends_with(footer)) return true;
    return lower_extension(name) == ".tga";
}

// --- EXR ---

std::uint32_t little32(Bytes bytes, std::size_t offset) {
    return little16(bytes, offset) | little16(bytes, offset + 2) << 16;
}

/// The end of the first part's header; nullopt if the bytes end before it.
std::optional<std::size_t> exr_header_end(Bytes bytes) {
    const std::string_view text = text_of(bytes);
    for (std::size_t at = 8;;) {
        const std::size_t key_end = text.find('\0', at);
        if (key_end == at) return at;
        const std::size_t type_end =
            key_end == text.npos ? text.npos : text.find('\0', key_end + 1);
        if (type_end == text.npos || bytes.size() - type_end < 5) return std::nullopt;
        const std::uint32_t size = little32(bytes, type_end + 1);
        if (size > bytes.size() - type_end - 5) return std::nullopt;
        at = type_end + 5 + size;
    }
}

/// Returns the value of an attribute in a complete header; empty if it is absent.
Bytes exr_attribute(Bytes bytes, std::string_view wanted) {
    const std::string_view text = text_of(bytes);
    for (std::size_t at = 8; text[at] != '\0';) {
        const std::size_t key_end = text.find('\0', at);
        const std::size_t type_end = text.find('\0', key_end + 1);
        const Bytes value = bytes.subspan(type_end + 5, little32(bytes, type_end + 1));
        if (text.substr(at, key_end - at) == wanted) return value;
        at = type_end + 5 + value.size();
    }
    return {};
}

}  // namespace

/// Each block of lines or tile has 8 bytes in a table; tiles are held in memory as a whole.
bool check_exr(std::span<const std::byte> start, std::uint64_t size,
               const std::filesystem::path& name) {
    constexpr std::uint64_t max_block_lines = 256;
    constexpr std::uint64_t max_tile_texels = 1 << 24;
    if (!exr_header_end(start)) {
        if (start.size() < size) return false;
        throw FileError(name, "is cut short within its header");
    }
    const Bytes window = exr_attribute(start, "dataWindow");
    if (window.size() < 16) throw FileError(name, "has no data window");
    const auto extent = [&](std::size_t axis) {
        const auto first = static_cast<std::int32_t>(little32(window, axis));
        const auto last = static_cast<std::int32_t>(little32(window, axis + 8));
        return last < first ? 0 : static_cast<std::uint64_t>(std::int64_t{last} - first + 1);
    };
    const std::uint64_t width = extent(0);
    const std::uint64_t height = extent(4);
    std::uint64_t blocks = (height + max_block_lines - 1) / max_block_lines;
    if (const Bytes tiles = exr_attribute(start, "tiles"); tiles.size() >= 8) {
        const std::uint64_t tile_width = little32(tiles, 0);
        const std::uint64_t tile_height = little32(tiles, 4);
        if (tile_width == 0 || tile_height == 0 || tile_width > max_tile_texels / tile_height) {
            throw FileError(
                name, fmt::format("announces tiles of {} x {} texels", tile_width, tile_height));
        }
        blocks =
            ((width + tile_width - 1) / tile_width) * ((height + tile_height - 1) / tile_height);
    }
    check_believable(blocks, size / 8, width, height, size, name);
    return true;
}

const char* format_by_signature(std::string_view start) {
    struct Signature {
        std::string_view start;
        const char* format;
    };
    using namespace std::string_view_literals;
    static constexpr Signature signatures[] = {
        {"\x89PNG\r\n\x1A\n"sv, "png"},
        {"\xFF\xD8\xFF"sv, "jpeg"},
        {"II*\0"sv, "tiff"},
        {"MM\0*"sv, "tiff"},
        {"II+\0"sv, "tiff"},
        {"MM\0+"sv, "tiff"},
        {"\x76\x2F\x31\x01"sv, "openexr"},
        {"#?"sv, "hdr"},
        {"BM"sv, "bmp"},
        {"DDS "sv, "dds"},
        {"\xABKTX 20\xBB\r\n\x1A\n"sv, "ktx2"},
        {"8BPS"sv, "psd"},
    };
    for (const Signature& signature : signatures) {
        if (start.starts_with(signature.start)) return signature.format;
    }
    if (start.size() > 2 && start[0] == 'P' && "123456fF"sv.find(start[1]) != start.npos)
        return "pnm";
    if (start.starts_with("RIFF") && start.substr(0, 12).ends_with("WEBP")) return "webp";
    return nullptr;
}

ImageContainer examine_image(std::span<const std::byte> bytes, const std::filesystem::path& name) {
    if (bytes.empty()) throw FileError(name, "is empty");
    ImageContainer container;
    container.format = format_by_signature(text_of(bytes));
    if (container.format == nullptr && is_tga(bytes, name)) container.format = "targa";
    if (container.format == nullptr) {
        throw FileError(name,
                        "is not an image that relief reads: PNG, JPEG, TIFF, EXR, HDR, BMP, TGA, "
                        "PNM, DDS, KTX2, PSD or WebP");
    }
    const std::string_view format = container.format;
    if (format == "png") strip_png(bytes, name, container);
    if (format == "jpeg") strip_jpeg(bytes, name, container);
    if (format == "targa") check_tga(bytes, name);
    if (format == "openexr") check_exr(bytes, bytes.size(), name);
    return container;
}

}  // namespace relief::detail
