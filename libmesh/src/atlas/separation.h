// SPDX-License-Identifier: Apache-2.0
/// \file
/// Raises the scale of a packing of few charts.
#pragma once

#include <span>

#include "atlas/cell_mask.h"
#include "atlas/packing.h"

namespace relief::detail {

struct SeparationOptions {
    PackingOptions packing;
    Margin margin;               ///< Around each chart.
    int cell = 1;                ///< Texels.
    double largest_scale = 0.0;  ///< At which each chart is inside of the map.
};

/// Raises the scale and moves charts until none overlap, as long as that succeeds within a fixed
/// number of operations.
///
/// Charts that overlap move one after the other to where the weighted number of shared cells is
/// least. Weights rise for pairs that keep overlapping, so that no local minimum persists: guided
/// local search [Egeblad et al. 2007]. The time for a good result grows faster than the number of
/// charts.
/// \param packing  of the charts, in rotations by multiples of 45 degrees
void raise_by_separation(std::span<const FlatChart> charts, const SeparationOptions& options,
                         Packing& packing);

}  // namespace relief::detail
