// SPDX-License-Identifier: Apache-2.0
/// \file
/// Edge padding: texels outside the charts get values of the nearest baked texels, so that
/// filtering and mip levels do not mix in the background.
///
/// A texel gets the mean of all baked texels that are nearest to it, by the Euclidean distance
/// between centers: the mean direction for normals, the most frequent id, and the mean value for
/// other layers. So each chart
/// continues beyond its border in all directions alike, and a mip level that averages 2^k texels
/// sees only chart values within 2^k texels of a chart. The time depends only on the size of the
/// map, not on the padding distance. Tests: tests/mesh/bake/padding_test.cpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "relief/mesh/bake.h"

namespace relief::detail {

/// The columns of a row that have the nearest of some points, where each column knows the distance
/// of its own nearest point straight above or below. Integers make it exact, and the time is linear
/// in the length of the row. Source: [Felzenszwalb 2012], the lower envelope of parabolas; unlike
/// there, all parabolas that meet in a point are kept, because several columns may be equally near.
class NearestColumns {
  public:
    void clear() {
        parabolas_.clear();
        current_ = 0;
    }

    /// Adds a column that has a point. Columns must be added in ascending order.
    /// \param distance  the distance of its nearest point, along the column
    void add(int column, int distance);

    [[nodiscard]] bool is_empty() const { return parabolas_.empty(); }

    /// Returns the squared distance from a column to the nearest point, of which there must be one.
    /// Columns must be queried in ascending order.
    [[nodiscard]] std::int64_t squared_distance(int column);

    /// Calls visit(column) for all columns with a point at that distance, in ascending order. The
    /// argument is that of the last call of squared_distance().
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
    /// The intersection of two parabolas as a fraction. The denominator is positive if b is right
    /// of a.
    struct Crossing {
        std::int64_t numerator, denominator;
    };
    static Crossing crossing(const Parabola& a, const Parabola& b) {
        return {b.column * b.column + b.squared - a.column * a.column - a.squared,
                2 * (b.column - a.column)};
    }
    /// Returns whether the next parabola is equally low at that column.
    [[nodiscard]] bool ends_at(std::size_t i, int column) const {
        const Crossing end = crossing(parabolas_[i], parabolas_[i + 1]);
        return end.numerator == column * end.denominator;
    }

    std::vector<Parabola> parabolas_;  ///< The lower envelope, including single points.
    std::size_t current_ = 0;
};

/// Padding up to a distance. Rows come from the top and are passed on as soon as all rows that may
/// affect them have arrived: memory holds a strip and twice as many rows as the distance.
class Dilation {
  public:
    /// \param texels  the distance, at least 0; 0 passes rows on unchanged
    Dilation(int width, int height, int texels, std::function<void(const BakedRows&)> output);

    /// Adds the next rows and passes on complete ones. Row counts are multiples of 64, except for
    /// the last rows of the map. All rows have the same layers; empty layers stay empty.
    void push(const BakedRows& rows);

  private:
    /// The rows in memory, from `first_row_` on, by layer.
    struct Window {
        std::vector<std::vector<float>> layers;
        std::vector<TexelState> states;
    };

    void pass_on(int last_row);
    void measure_columns(int last_row);
    void fill_row(int row, const BakedRows& rows, NearestColumns& nearest);
    [[nodiscard]] BakedRows rows_of(int first_row, int last_row);
    [[nodiscard]] Window copy_from(int first_row) const;
    [[nodiscard]] std::size_t texels_in(int rows) const {
        return static_cast<std::size_t>(rows) * static_cast<std::size_t>(width_);
    }

    int width_, height_, texels_;
    std::function<void(const BakedRows&)> output_;
    int first_row_ = 0;  ///< The first row in memory.
    int end_row_ = 0;
    int next_row_ = 0;  ///< The next row to pass on.
    Window window_;
    /// Distances to the nearest baked texel of the column, for the rows to pass on next. Values
    /// above `texels_` mean that there is none.
    std::vector<std::uint16_t> upwards_, downwards_;
};

/// Padding of the whole map, which protects all mip levels.
///
/// Any texel may depend on any other, so rows are passed on only when the last one has arrived.
/// Until then they are in an unlinked file, which disappears with the process: 4 bytes per texel
/// for each channel of each layer, and 3 more. Memory holds a strip of 64 rows, and the system's
/// cache of the file.
class BorderFill {
  public:
    static constexpr int max_side = 32768;

    /// \param folder  the folder of the file
    /// \throws FileError if the file cannot be created
    BorderFill(int width, int height, const std::filesystem::path& folder,
               std::function<void(const BakedRows&)> output);
    ~BorderFill();
    BorderFill(const BorderFill&) = delete;
    BorderFill& operator=(const BorderFill&) = delete;

    /// Adds the next rows; all have the same layers. The last call passes on all rows, in strips
    /// of 64. \throws FileError if the file cannot be written
    void push(const BakedRows& rows);

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace relief::detail
