// SPDX-License-Identifier: Apache-2.0
/// \file
/// A map of cells in which charts may overlap.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "atlas/cell_map.h"
#include "atlas/cell_mask.h"

namespace relief::detail {

/// The rows of a map with the runs of all charts. Sums over a row don't depend on the order in
/// which charts were inserted.
class OverlapMap {
  public:
    using Position = CellMap::Position;

    /// Positions [begin, end) in a row.
    struct Positions {
        int y, begin, end;
    };
    struct Best {
        int x;
        std::int64_t cost;
    };

    OverlapMap(int width, int height);

    void clear();
    void insert(std::uint32_t chart, const CellMask& mask, const Position& at);
    void remove(std::uint32_t chart, const CellMask& mask, const Position& at);

    /// Finds the position in a row at which the cells that a mask shares with charts, weighted,
    /// have the least sum. Ties: the position next to `near_x`, then the left one. The sum is a
    /// piecewise linear function of the position, so that all positions together cost little more
    /// than one [Umetani and Murakami 2022].
    /// \param positions  at least one must be inside of the map
    /// \param stride  takes one of so many rows of the mask, for an estimate
    /// \param weights  of the charts, at least 0
    [[nodiscard]] Best best_in_row(const CellMask& mask, Positions positions, int stride,
                                   std::span<const std::int32_t> weights, int near_x);

    /// Adds the number of cells that a mask shares with each chart.
    void add_overlaps(const CellMask& mask, const Position& at,
                      std::span<std::int64_t> cells) const;

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return static_cast<int>(rows_.size()); }
    /// The number of operations of best_in_row() until now, a measure of time that is the same on
    /// all machines.
    [[nodiscard]] std::uint64_t work() const { return work_; }

  private:
    struct ChartRun {
        int begin, end;
        std::uint32_t chart;
    };

    int width_;
    std::vector<std::vector<ChartRun>> rows_;
    std::vector<std::int64_t> bend_;  ///< Changes of the slope; 0 between calls.
    std::uint64_t work_ = 0;
};

}  // namespace relief::detail
