// SPDX-License-Identifier: Apache-2.0
/// \file
/// Charts as rows of cells.
///
/// A mask has all cells that a chart touches when half of the padding is added around it. Charts
/// whose masks share no cell therefore keep their distance.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <utility>
#include <vector>

namespace relief::detail {

/// Cells [begin, end) of a row.
struct Run {
    int begin, end;
};

/// The cells of a chart, row by row.
struct CellMask {
    int width = 0;
    int height = 0;
    std::vector<Run> runs;              ///< Ascending, with a gap between any two of a row.
    std::vector<std::uint32_t> first;   ///< The first run of each row, and the number of runs.
    std::vector<std::int16_t> longest;  ///< The length of the longest run of each row.

    [[nodiscard]] std::span<const Run> row(int y) const {
        const auto i = static_cast<std::size_t>(y);
        return std::span(runs).subspan(first[i], first[i + 1] - first[i]);
    }
};

/// Cells of a row of a mask.
struct RowRun {
    int y, begin, end;
};

/// An edge of the border of a chart, with the chart on its left side.
using BorderSegment = std::pair<glm::dvec2, glm::dvec2>;

/// The space around a chart: a square whose corners are cut off. Lengths are in texels.
struct Margin {
    double side = 0.0;  ///< To each side, and the largest |x| and |y|.
    double sum = 0.0;   ///< The largest |x| + |y|, from `side` to 2 * `side`.
};

/// The mask of a chart whose box begins at the origin.
/// \param margin  so that the box begins at (margin.side, margin.side) in the mask
/// \param cell  side of a cell, texels. \param scale  texels of a unit of the border and the size
CellMask mask_of(std::span<const BorderSegment> border, const glm::dvec2& size,
                 const Margin& margin, int cell, double scale = 1.0);

/// Rotates a mask by a half turn.
CellMask half_turned(const CellMask& mask);

/// The mask with cells 2^level times as large.
CellMask coarser(const CellMask& mask, int level);

/// The cells of a mask that are occupied newly when it moves down by one cell.
std::vector<RowRun> lower_border(const CellMask& mask);

/// Rows of bits: bit x is bit x % 64 of word x / 64.
using BitWord = std::uint64_t;
inline constexpr int word_bits = 64;

inline std::size_t word_count(int bits) {
    return (static_cast<std::size_t>(bits) + word_bits - 1) / word_bits;
}

/// Sets the bits [begin, end), at least one.
void set_run(BitWord* words, int begin, int end);

/// Returns the first bit from `x` on that is set, or that is not; `width` if there is none.
int next_bit(const BitWord* words, int x, int width, bool is_set);

}  // namespace relief::detail
