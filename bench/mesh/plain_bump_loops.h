// SPDX-License-Identifier: Apache-2.0
/// \file
/// Plain loops that compute normal maps, for comparison. The compiler vectorizes them for the same
/// instruction sets as the library's loops, with the same options.
#pragma once

#include <cstddef>
#include <cstdint>

#include "portable_math.h"
#include "relief/mesh/image.h"

namespace relief::bench {

/// The numbers of texels that plain_sobel_codes() can compute at once.
inline constexpr std::size_t plain_block_sizes[] = {128, 512};

/// Computes the same codes as normal_map_from_height() with Kernel::sobel3 and Wrap::repeat on both
/// axes: nearest codes of 16 bits, green up, clamped to the range of codes.
///
/// \param heights  float, at least 3 x 3
/// \param strength  in texels
void plain_sobel_codes(relief::detail::VectorTarget target, std::size_t block_size,
                       const Image& heights, float strength, Image& map);

/// Encodes slopes to the right and down, as other libraries compute them, as nearest codes.
void plain_codes_of_slopes(relief::detail::VectorTarget target, const float* right,
                           const float* down, std::size_t count, std::uint16_t* codes);

}  // namespace relief::bench
