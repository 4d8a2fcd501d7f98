// SPDX-License-Identifier: Apache-2.0
/// \file
/// Rows of mip levels of float images, one by one. Their bits are those of mip_levels().
#pragma once

#include <cstddef>

#include "relief/export.h"

namespace RELIEF_API relief {
namespace detail {

/// Returns the size of the level below a size.
inline std::size_t halved_size(std::size_t size) {
    return size > 1 ? size / 2 : 1;
}

/// Consecutive rows of a level.
struct MipSourceRows {
    std::size_t first = 0;
    std::size_t count = 0;
};

/// Returns the rows of a level of this height that row `y` of the next level averages.
MipSourceRows mip_source_rows(std::size_t height, std::size_t y);

/// Computes row `y` of the level below a level of this size.
/// \param rows  the rows of mip_source_rows(), of 1 to 4 channels
void halve_float_rows(int channels, std::size_t width, std::size_t height, std::size_t y,
                      const float* rows, float* row);

}  // namespace detail
}  // namespace relief
