// SPDX-License-Identifier: Apache-2.0
/// \file
/// A map of cells in which charts find places.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "atlas/cell_mask.h"

namespace relief::detail {

/// A map of cells, and the same with larger cells, each of which is occupied if one of its cells
/// is.
class CellMap {
  public:
    struct Position {
        int x, y;
    };

    /// \param level_count  1 for only the smallest cells
    CellMap(int width, int height, int level_count);

    /// Makes all cells free.
    void clear();

    /// Finds the lowest position, and the leftmost one in that row, at which the larger cells of a
    /// mask meet no occupied ones.
    /// \param coarse  coarser(mask, level); level is at least 1
    /// \param first  the row to begin with. \param end  the row before which to stop
    std::optional<Position> find(const CellMask& mask, const CellMask& coarse, int level, int first,
                                 int end);

    /// Moves a mask down and left until neither is possible.
    /// \param lower  lower_border(mask), or empty: the whole mask is tested
    [[nodiscard]] Position slid(const CellMask& mask, std::span<const RowRun> lower,
                                Position at) const;

    void occupy(const CellMask& mask, const Position& at);

    [[nodiscard]] int width() const { return levels_.front().width; }
    [[nodiscard]] int height() const { return levels_.front().height; }

  private:
    struct Level {
        int width = 0;
        int height = 0;
        std::size_t words = 0;  ///< In a row, with one that is always 0.
        /// Table k has a bit for each position from which a run of 2^k cells meets an occupied one.
        std::vector<std::vector<BitWord>> tables;
        std::vector<Run> longest_free;          ///< For each row, its longest run of free cells.
        std::vector<std::int16_t> free_length;  ///< The lengths of these runs.

        [[nodiscard]] BitWord* row(std::size_t table, int y) {
            return tables[table].data() + words * static_cast<std::size_t>(y);
        }
        [[nodiscard]] const BitWord* row(std::size_t table, int y) const {
            return tables[table].data() + words * static_cast<std::size_t>(y);
        }
    };

    [[nodiscard]] bool is_free(const CellMask& mask, const Position& at) const;
    /// Returns whether each run of a mask finds enough free cells in its row, wherever they are.
    static bool has_room(const CellMask& mask, const Level& level, int y);
    std::optional<int> free_column(const CellMask& mask, const Level& level, int y, int count);
    /// Blocks the positions whose bit, shifted, is set, in the words [begin, end).
    void block(const BitWord* table, int shift, std::size_t begin, std::size_t end);
    /// \param changed  the cells of row `y` that may have become occupied
    static void renew_tables(Level& level, int y, const Run& changed);

    std::vector<Level> levels_;
    std::vector<BitWord> blocked_;
};

}  // namespace relief::detail
