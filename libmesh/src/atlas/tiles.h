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

/// Packs charts into tiles: the largest come first, each to the tile with the smallest area. If
/// there are few charts, some change their tile afterwards to fill all tiles equally.
///
/// \param tiles  at least 1
/// \throws InvalidInput as packed()
TiledPacking packed_into_tiles(std::span<const FlatChart> charts, const PackingOptions& options,
                               int tiles);

}  // namespace relief::detail
