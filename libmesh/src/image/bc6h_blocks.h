// SPDX-License-Identifier: Apache-2.0
/// \file
/// BC6H: blocks of three half floats.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "relief/mesh/block_compression.h"

namespace relief::detail {

/// encode_blocks() for bc6h and bc6h_sfloat.
std::vector<std::byte> encode_bc6h(const ImageView& image, BlockFormat format, BlockQuality quality,
                                   Report& report);

/// decode_blocks() for bc6h and bc6h_sfloat. The number of bytes is checked.
Image decode_bc6h(std::span<const std::byte> blocks, BlockFormat format, int width, int height);

}  // namespace relief::detail
