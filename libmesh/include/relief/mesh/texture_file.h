// SPDX-License-Identifier: Apache-2.0
/// \file
/// Textures for GPUs: mip levels in a format of the GPU, read from and written to KTX2 and DDS.
///
/// read_image() also reads these files, as an image of the largest level from
/// decode_texture_level(); read_image_info() names the code of zero of signed formats.
/// Tests: tests/mesh/io/image/texture_file_test.cpp.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/block_compression.h"
#include "relief/mesh/enum_names.h"
#include "relief/mesh/image.h"
#include "relief/mesh/report.h"

namespace RELIEF_API relief {

/// The storage of texels. Numbers are bits per channel; integers are from 0 to 1.
enum class TextureFormat {
    r8,
    rg8,
    rgba8,
    r16,
    rg16,
    rgba16,
    r16f,
    rg16f,
    rgba16f,
    r32f,
    rg32f,
    rgba32f,
    bc4,
    bc4_snorm,
    bc5,
    bc5_snorm,
    bc7,
    bc1,
    bc1a,
    bc3,
    bc6h,
    bc6h_sfloat,
};

template <>
inline constexpr auto enum_names<TextureFormat> = std::to_array<EnumName<TextureFormat>>(
    {{"r8", TextureFormat::r8},           {"rg8", TextureFormat::rg8},
     {"rgba8", TextureFormat::rgba8},     {"r16", TextureFormat::r16},
     {"rg16", TextureFormat::rg16},       {"rgba16", TextureFormat::rgba16},
     {"r16f", TextureFormat::r16f},       {"rg16f", TextureFormat::rg16f},
     {"rgba16f", TextureFormat::rgba16f}, {"r32f", TextureFormat::r32f},
     {"rg32f", TextureFormat::rg32f},     {"rgba32f", TextureFormat::rgba32f},
     {"bc4", TextureFormat::bc4},         {"bc4-snorm", TextureFormat::bc4_snorm},
     {"bc5", TextureFormat::bc5},         {"bc5-snorm", TextureFormat::bc5_snorm},
     {"bc7", TextureFormat::bc7},         {"bc1", TextureFormat::bc1},
     {"bc1a", TextureFormat::bc1a},       {"bc3", TextureFormat::bc3},
     {"bc6h", TextureFormat::bc6h},       {"bc6h-sfloat", TextureFormat::bc6h_sfloat}});

/// Returns the number of channels of a format: 1 to 4.
int channels_of(TextureFormat format);

/// Returns the block format; absent if texels are stored one by one.
std::optional<BlockFormat> block_format_of(TextureFormat format);

/// Returns the bits of the samples of decoded levels: 8, 16 or 32.
int bits_of(TextureFormat format);

/// Returns whether KTX2 and DDS have a variant of a format whose colors are sRGB-coded.
bool has_srgb_variant(TextureFormat format);

/// A texture with its mip levels.
struct GpuTexture {
    TextureFormat format = TextureFormat::rgba8;
    bool is_srgb = false;  ///< Colors are sRGB-coded: r8, rg8, rgba8, bc1, bc1a, bc3 and bc7.
    int width = 0;
    int height = 0;
    /// Level 0 is the largest; each further one has half the size, rounded down, but at least 1.
    std::vector<std::vector<std::byte>> levels;
    /// Text entries. KTX2 stores them; DDS stores none.
    std::map<std::string, std::string> metadata;
    /// The order in which shaders read the channels, as four letters of "rgba01"; empty for the
    /// stored order. Only KTX2 stores it.
    std::string swizzle;
};

/// Returns the bytes of a level of this size.
std::size_t texture_level_size(TextureFormat format, int width, int height);

/// Encodes a level.
///
/// \param image  the channels of the format; the same number of bits for formats without blocks
///         (32 for 16-bit floats). Three channels are accepted for four; alpha is 1 then
/// \param quality  for block formats
/// \param report  as from encode_blocks(), and values beyond the range of 16-bit floats, which
///         become +-65504
/// \throws InvalidInput if the image is empty or has another format
std::vector<std::byte> encode_texture_level(const ImageView& image, TextureFormat format,
                                            BlockQuality quality = BlockQuality::normal,
                                            Report& report = IgnoredReport());

/// Decodes a level. Blocks are decoded as by decode_blocks(); 16-bit floats become float.
/// \throws InvalidInput if there is no such level, or it has another size
Image decode_texture_level(const GpuTexture& texture, std::size_t level);

struct TextureWriteOptions {
    /// KTX2: compresses levels with zstd, 1 (fast) to 22 (small). Absent: not compressed.
    std::optional<int> zstd_level;
};

/// Writes a texture. The extension decides the format: .ktx2 or .dds.
///
/// A temporary file is written and renamed. The same texture gives the same bytes. KTX2 files name
/// relief as their writer, and right and down as the directions of x and y. DDS holds no text: the
/// entries of the texture are lost, so a reader must be told what they say.
///
/// \param report  names the entries that a DDS file loses
/// \throws FileError if the file cannot be written, or for another extension
/// \throws InvalidInput if a level has another size than the format requires, a level or the
///         format's sRGB variant does not exist, DDS is to store a compression, or a text is
///         invalid
void write_texture(const std::filesystem::path& file, const GpuTexture& texture,
                   const TextureWriteOptions& options = {}, Report& report = IgnoredReport());

/// Reads a KTX2 or DDS file with one of the formats of TextureFormat, with all its levels.
/// \throws FileError if the file is missing, damaged or truncated, has another format (which is
///         named), is a volume, cube map or array, or exceeds a limit; nothing is allocated for
///         sizes that the file cannot hold
GpuTexture read_texture(const std::filesystem::path& file);

/// The same from memory. `name` is for messages.
GpuTexture read_texture(std::span<const std::byte> bytes, const std::string& name);

/// Adds z to a map of x and y, whose codes do not change.
///
/// \param map  two channels of any number of bits
/// \param report  counts texels whose x and y are longer than 1; their z is 0
/// \return three channels; z is coded like x and y
/// \throws InvalidInput if the image is empty or has another number of channels
Image with_rebuilt_z(const Image& map, FlatCode flat, Report& report = IgnoredReport());

/// Reads a normal map as an image: as read_image() for data, but textures of two channels get z.
/// \param report  as from with_rebuilt_z()
/// \throws FileError as read_image() does
Image read_normal_map_image(const std::filesystem::path& file, Report& report = IgnoredReport());

}  // namespace relief
