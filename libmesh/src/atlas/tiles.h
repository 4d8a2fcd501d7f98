// SPDX-License-Identifier: Apache-2.0
/// \file
/// Packs charts into several maps of one size and density.
#pragma once

#include <span>
#include <vector>

#include "atlas/packing.h"

namespace relief::detail {

struct TiledPacking {
    Packing packing;
    std::vector<int> tile;  ///< For each chart, 0 to tiles - 1.
};

/// \param tiles  at least 1. The largest charts come first, each to the tile with the smallest
/// area.
///         Of few charts, some change their tile afterwards, so that all tiles are equally full
/// \throws InvalidInput as packed()
TiledPacking packed_into_tiles(std::span<const FlatChart> charts, const PackingOptions& options,
                               int tiles);

}  // namespace relief::detail
