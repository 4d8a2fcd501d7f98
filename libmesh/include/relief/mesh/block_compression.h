// SPDX-License-Identifier: Apache-2.0
/// \file
/// Block compression for GPUs: BC1, BC3, BC4, BC5, BC6H and BC7, encoded from exact data and
/// decoded.
///
/// A block stores 4 x 4 texels in 8 bytes (BC1, BC4) or 16 bytes (BC3, BC5, BC6H, BC7). Files:
/// texture_file.h. Maps with their mip levels: map_texture.h.
/// Tests: tests/mesh/image/block_compression_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/enum_names.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/image.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/report.h"

namespace RELIEF_API relief {

enum class BlockFormat {
    bc4,  ///< One channel: two codes of 8 bits per block, and 6 or 4 values between them.
    /// One channel from -1 to 1: signed codes of 8 bits, of which 0 is exactly 0.
    bc4_snorm,
    bc5,        ///< Two channels, each as in bc4: for x and y of normals.
    bc5_snorm,  ///< Two channels, each as in bc4_snorm: flat is exactly flat.
    bc7,        ///< Three or four channels of colors, or of masks that belong together.
    bc1,        ///< Three channels: two colors of 16 bits per block, and two between them.
    bc1a,       ///< The same with alpha that is 0 or 1.
    bc3,        ///< Four channels: colors as in bc1, and alpha as in bc4.
    /// Three channels from 0 to 65504, with steps of half floats: for colors above 1, and heights.
    bc6h,
    bc6h_sfloat,  ///< The same from -65504 to 65504, with half of the codes for each sign.
};

template <>
inline constexpr auto enum_names<BlockFormat> =
    std::to_array<EnumName<BlockFormat>>({{"bc4", BlockFormat::bc4},
                                          {"bc4-snorm", BlockFormat::bc4_snorm},
                                          {"bc5", BlockFormat::bc5},
                                          {"bc5-snorm", BlockFormat::bc5_snorm},
                                          {"bc7", BlockFormat::bc7},
                                          {"bc1", BlockFormat::bc1},
                                          {"bc1a", BlockFormat::bc1a},
                                          {"bc3", BlockFormat::bc3},
                                          {"bc6h", BlockFormat::bc6h},
                                          {"bc6h-sfloat", BlockFormat::bc6h_sfloat}});

/// The time that encoding may take. The bytes do not depend on threads or processors.
enum class BlockQuality {
    fast,    ///< BC4 and BC5: the range of the values.
    normal,  ///< The range with the smallest error among a few; for normals, of the angle.
    best,    ///< Many more ranges. No block has a larger error than with `normal`.
};

template <>
inline constexpr auto enum_names<BlockQuality> = std::to_array<EnumName<BlockQuality>>(
    {{"fast", BlockQuality::fast}, {"normal", BlockQuality::normal}, {"best", BlockQuality::best}});

/// Returns the bytes of a block: 8 or 16.
std::size_t bytes_per_block(BlockFormat format);

/// Returns the number of channels that a format stores: 1 to 4.
int channels_of(BlockFormat format);

/// Returns whether a format stores values from -1 to 1.
bool is_signed(BlockFormat format);

/// Returns the bytes of an image: blocks of 4 x 4 texels, the last ones filled up.
std::size_t block_data_size(BlockFormat format, int width, int height);

/// Encodes an image.
///
/// \param image  one channel for BC4, two for BC5, three for bc1, three (alpha is 1) or four for
/// BC7,
///         bc1a and BC3; any number of bits. bc1a stores an alpha below 0.5 as transparent black.
///         BC6H: three channels, whose errors count relative to their size, or one, which all three
///         channels store, and whose errors count absolutely; integers are from 0 to 1. Other
///         signed formats take n from -1 to 1 coded as (n + 1) / 2 in float, and with
///         FlatCode::middle in 8 and 16 bits
/// \param report  counts samples that are not finite, which become 0 (of float images), and texels
///         beyond the range of BC6H
/// \return blocks row by row, row 0 at the top. Values beyond the format's range are clamped. If
///         the size is no multiple of 4, the last texels of rows and columns are repeated
/// \throws InvalidInput if the image is empty or has another number of channels
///
/// A block of one value in [0,1] has an error of at most 1/14 of a code of 8 bits with BC4 and BC5,
/// and none if it is such a code. Source: [Khronos Data Format].
std::vector<std::byte> encode_blocks(const ImageView& image, BlockFormat format,
                                     BlockQuality quality, Report& report = IgnoredReport());

struct NormalBlockOptions {
    BlockFormat format = BlockFormat::bc5;  ///< bc5 or bc5_snorm.
    BlockQuality quality = BlockQuality::normal;
    Green green = Green::up;
};

/// Encodes x and y of normals such that the angle between the decoded normal and the given one is
/// small; z is rebuilt as sqrt(1 - x^2 - y^2) by the reader.
///
/// \param normals  three float channels, y up, of any length
/// \param report  counts normals that are zero or not finite, which become flat, and normals that
///         face back (z < 0), which become the nearest ones with z = 0
/// \param execution  threads, progress and cancellation; the bytes do not depend on it
/// \return blocks as from encode_blocks(). bc5 has FlatCode::half, as engines decode it: (0,0,1)
///         has an error of at most 0.05 degrees. bc5_snorm decodes it exactly
/// \throws InvalidInput if the image is empty or has another format, or for formats but BC5;
///         Cancelled
std::vector<std::byte> encode_normal_blocks(const ImageView& normals,
                                            const NormalBlockOptions& options,
                                            Report& report = IgnoredReport(),
                                            const ExecutionOptions& execution = {});

/// Decodes blocks.
///
/// \param blocks  block_data_size() bytes
/// \return BC4, BC5: 16 bits per sample, rounded from the exact values between the codes; signed
///         formats are coded with FlatCode::middle. BC7: four channels of 8 bits, exact; blocks of
///         the reserved mode are transparent black. BC1, BC3: channels of 8 bits, rounded from the
///         exact colors between the endpoints; decoders of GPUs may differ by one code. BC6H: three
///         channels of floats, exact; blocks of the reserved modes are black
/// \throws InvalidInput if a size is not positive, or the number of bytes is another one
///
/// Source: [Khronos Data Format].
Image decode_blocks(std::span<const std::byte> blocks, BlockFormat format, int width, int height);

/// encode_blocks() for BC7. It uses mode 6, in which all channels share their indices, mode 5, in
/// which one channel has its own, and partitions into two subsets: modes 1 and 3 for opaque colors,
/// mode 7 for others. `fast` uses only modes 1 and 6, and one color in mode 5.
std::vector<std::byte> encode_bc7(const ImageView& image, BlockQuality quality,
                                  Report& report = IgnoredReport());

/// decode_blocks() for BC7.
Image decode_bc7(std::span<const std::byte> blocks, int width, int height);

}  // namespace relief
