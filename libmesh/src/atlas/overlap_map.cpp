// SPDX-License-Identifier: Apache-2.0
#include "atlas/overlap_map.h"

#include <algorithm>
#include <cstdlib>
#include <limits>

namespace relief::detail {

OverlapMap::OverlapMap(int width, int height)
    : width_(width),
      rows_(static_cast<std::size_t>(height)),
      bend_(static_cast<std::size_t>(width) + 1, 0) {}

void OverlapMap::clear() {
    for (std::vector<ChartRun>& row : rows_)
        row.clear();
}

void OverlapMap::insert(std::uint32_t chart, const CellMask& mask, const Position& at) {
    for (int y = 0; y < mask.height; ++y)
        for (const Run& run : mask.row(y))
            rows_[static_cast<std::size_t>(at.y + y)].push_back(
                {at.x + run.begin, at.x + run.end, chart});
}

void OverlapMap::remove(std::uint32_t chart, const CellMask& mask, const Position& at) {
    for (int y = 0; y < mask.height; ++y)
        std::erase_if(rows_[static_cast<std::size_t>(at.y + y)],
                      [&](const ChartRun& run) { return run.chart == chart; });
}

OverlapMap::Best OverlapMap::best_in_row(const CellMask& mask, Positions positions, int stride,
                                         std::span<const std::int32_t> weights, int near_x) {
    const int begin = std::max(positions.begin, 0);
    const int last = std::min(positions.end - 1, width_ - mask.width) - begin;
    std::int64_t value = 0;  // At position `begin`, which is 0 here.
    std::int64_t slope = 0;
    const auto bend = [&](int x, std::int64_t change) {
        if (x <= 0) {
            slope += change;
            value += change * (1 - x);
        } else if (x <= last) {
            bend_[static_cast<std::size_t>(x)] += change;
        }
    };
    std::size_t operations = static_cast<std::size_t>(last) + 1;
    for (int row = stride / 2; row < mask.height; row += stride) {
        const std::span<const Run> runs = mask.row(row);
        if (runs.empty()) continue;
        const std::vector<ChartRun>& others = rows_[static_cast<std::size_t>(positions.y + row)];
        const int left = begin + runs.front().begin;
        const int right = begin + last + runs.back().end;
        operations += others.size();
        for (const ChartRun& other : others) {
            if (other.end <= left || other.begin >= right) continue;
            const std::int64_t weight = weights[other.chart];
            const int from = other.begin - begin + 1;
            const int to = other.end - begin + 1;
            for (const Run& run : runs) {
                bend(from - run.end, weight);
                bend(from - run.begin, -weight);
                bend(to - run.end, -weight);
                bend(to - run.begin, weight);
            }
            operations += 4 * runs.size();
        }
    }
    work_ += operations;
    Best best{begin, std::numeric_limits<std::int64_t>::max()};
    for (int x = 0; x <= last; ++x) {
        if (x > 0) {
            std::int64_t& change = bend_[static_cast<std::size_t>(x)];
            slope += change;
            value += slope;
            change = 0;
        }
        if (value < best.cost ||
            (value == best.cost && std::abs(x + begin - near_x) < std::abs(best.x - near_x)))
            best = {x + begin, value};
    }
    best.cost *= stride;
    return best;
}

void OverlapMap::add_overlaps(const CellMask& mask, const Position& at,
                              std::span<std::int64_t> cells) const {
    for (int y = 0; y < mask.height; ++y) {
        for (const ChartRun& other : rows_[static_cast<std::size_t>(at.y + y)]) {
            for (const Run& run : mask.row(y)) {
                const int shared =
                    std::min(other.end, at.x + run.end) - std::max(other.begin, at.x + run.begin);
                if (shared > 0) cells[other.chart] += shared;
            }
        }
    }
}

}  // namespace relief::detail
