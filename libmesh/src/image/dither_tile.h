// SPDX-License-Identifier: Apache-2.0
/// \file
/// Tiles of thresholds for image.h, by rows.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "relief/mesh/image.h"

namespace relief::detail {

/// Thresholds in (0,1), repeated in both directions. The side is a power of two.
struct DitherTile {
    std::size_t side = 1;
    std::vector<float> thresholds;
};

/// \param dither  any but `none`
const DitherTile& dither_tile(Dither dither);

/// The thresholds along a row of an image, for each of the three channels.
class DitherRow {
  public:
    /// \param dither  any but `none`
    DitherRow(Dither dither, int y);

    [[nodiscard]] float at(std::size_t x, std::size_t channel) const {
        return rows_[channel][(x + shifts_[channel]) & mask_];
    }

  private:
    std::size_t mask_;
    std::array<const float*, 3> rows_;
    std::array<std::size_t, 3> shifts_;
};

}  // namespace relief::detail
