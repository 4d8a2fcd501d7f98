// SPDX-License-Identifier: Apache-2.0
/// \file
/// The headers of KTX2 and DDS files, and the place of their levels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "relief/mesh/image_file.h"
#include "relief/mesh/texture_file.h"

namespace relief::detail {

/// A level in a file.
struct StoredLevel {
    std::uint64_t offset = 0;
    std::uint64_t size = 0;
};

/// A file whose header is valid: all levels are inside of the file.
struct TextureContainer {
    GpuTexture header;  ///< Without levels.
    std::vector<StoredLevel> levels;
    bool is_zstd = false;
};

/// Returns the size of a level.
int level_side(int side, std::size_t level);

/// Reads the header of a KTX2 file. \throws FileError
TextureContainer open_ktx2(std::span<const std::byte> bytes, const std::filesystem::path& name);

/// Reads the header of a DDS file; absent if its format is none of TextureFormat. \throws FileError
std::optional<TextureContainer> open_dds(std::span<const std::byte> bytes,
                                         const std::filesystem::path& name);

/// Returns the decompressed bytes of a level. \throws FileError
std::vector<std::byte> load_level(const TextureContainer& container,
                                  std::span<const std::byte> bytes, std::size_t level,
                                  const std::filesystem::path& name);

/// Writes a file in parts, without a copy of the levels.
void write_ktx2(const GpuTexture& texture, const TextureWriteOptions& options,
                const std::function<void(std::span<const std::byte>)>& write);

/// Returns a whole file.
std::vector<std::byte> ktx2_bytes(const GpuTexture& texture, const TextureWriteOptions& options);
std::vector<std::byte> dds_bytes(const GpuTexture& texture);

/// Reports the text entries of a texture that DDS does not store.
void report_lost_entries(const GpuTexture& texture, Report& report);

/// The properties of the image of level 0.
ImageInfo image_info_of(const GpuTexture& header);

/// Decodes level 0 of a file.
Image read_largest_level(const TextureContainer& container, std::span<const std::byte> bytes,
                         const std::filesystem::path& name);

/// Little-endian numbers of a file.
template <typename Number>
Number little(std::span<const std::byte> bytes, std::size_t offset) {
    Number value = 0;
    for (std::size_t i = 0; i < sizeof(Number); ++i)
        value |= static_cast<Number>(std::to_integer<Number>(bytes[offset + i]) << (8 * i));
    return value;
}
template <typename Number>
void append_little(std::vector<std::byte>& bytes, Number value) {
    for (std::size_t i = 0; i < sizeof(Number); ++i)
        bytes.push_back(static_cast<std::byte>(value >> (8 * i) & 255U));
}

}  // namespace relief::detail
