// SPDX-License-Identifier: Apache-2.0
/// \file
/// Along a row of texels, which columns have the nearest of some places, of which each column knows
/// how far its own is straight above or below. Exact, in whole numbers, and in time that grows with
/// the row's length alone, however far away places are. Source: [Felzenszwalb 2012], the lower
/// envelope of parabolas; here with all that meet in a point, as several may be equally near.
/// Tests: tests/mesh/bake/nearest_columns_test.cpp.
#pragma once

#include <cstdint>
#include <vector>

namespace relief {

class NearestColumns {
  public:
    void clear() {
        parabolas_.clear();
        current_ = 0;
    }

    /// The next column that has a place; columns ascend.
    /// \param distance  of the column's nearest place, along the column
    void add(int column, int distance);

    [[nodiscard]] bool is_empty() const { return parabolas_.empty(); }

    /// Squared distance from a column to the nearest of all places; there must be one. Columns
    /// asked for ascend.
    [[nodiscard]] std::int64_t squared_distance(int column);

    /// Calls visit(column) for all columns that have a place as near as that, ascending; for the
    /// column that squared_distance() was asked for last.
    template <typename Visit>
    void for_nearest(int column, const Visit& visit) const {
        for (std::size_t i = current_;; ++i) {
            visit(static_cast<int>(parabolas_[i].column));
            if (i + 1 == parabolas_.size() || !ends_at(i, column)) return;
        }
    }

  private:
    /// (x - column)^2 + squared
    struct Parabola {
        std::int64_t column, squared;
    };
    /// Where two meet, as a fraction: the denominator is positive where b is right of a.
    struct Crossing {
        std::int64_t numerator, denominator;
    };
    static Crossing crossing(const Parabola& a, const Parabola& b) {
        return {b.column * b.column + b.squared - a.column * a.column - a.squared,
                2 * (b.column - a.column)};
    }
    /// Whether the next parabola is as low there.
    [[nodiscard]] bool ends_at(std::size_t i, int column) const {
        const Crossing end = crossing(parabolas_[i], parabolas_[i + 1]);
        return end.numerator == column * end.denominator;
    }

    std::vector<Parabola> parabolas_;  ///< Those that are lowest somewhere, be it in a point.
    std::size_t current_ = 0;
};

}  // namespace relief
