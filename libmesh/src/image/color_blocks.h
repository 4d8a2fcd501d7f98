// SPDX-License-Identifier: Apache-2.0
/// \file
/// BC1 and BC3: blocks of colors.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "relief/mesh/block_compression.h"

namespace relief::detail {

/// encode_blocks() for bc1, bc1a and bc3.
std::vector<std::byte> encode_color_blocks(const ImageView& image, BlockFormat format,
                                           BlockQuality quality, Report& report);

/// decode_blocks() for bc1, bc1a and bc3. The number of bytes is checked.
Image decode_color_blocks(std::span<const std::byte> blocks, BlockFormat format, int width,
                          int height);

}  // namespace relief::detail
