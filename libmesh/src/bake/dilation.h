// SPDX-License-Identifier: Apache-2.0
/// \file
/// Texels beside charts filled from them, so that neither filtering nor mip levels mix in what is
/// no part of the mesh. Tests: tests/mesh/bake/dilation_test.cpp.
///
/// A texel that is not baked, but no further than so many texels from one that is (Euclidean,
/// between centres), gets the mean of all that are nearest to it: of normals the mean direction, of
/// other layers the mean value. So a chart goes on beyond its border as it ends there, the same to
/// all sides, and a level of mip maps that averages 2^k texels sees nothing else within 2^k of the
/// chart. Time grows with the map, not with how far it is filled.
///
/// Rows come from the top and go on as soon as all that may fill them are there: in memory are
/// twice as many rows as texels are filled around a chart, and a strip.
#pragma once

#include <functional>
#include <vector>

#include "relief/mesh/bake.h"

namespace relief {

class NearestColumns;

class Dilation {
  public:
    /// \param texels  at least 0; 0 hands rows on as they are
    Dilation(int width, int height, int texels, std::function<void(const BakedRows&)> take);

    /// The next rows; multiples of 64, but for the map's last. Hands on what is complete, likewise.
    /// Layers that are empty stay so; all rows have the same.
    void push(const BakedRows& rows);

  private:
    /// Rows in memory, from `first_row_`: every layer that there is, one after another.
    struct Window {
        std::vector<std::vector<float>> layers;
        std::vector<TexelState> states;
    };

    void hand_on(int last_row);
    void measure_columns(int last_row);
    void fill_row(int row, const BakedRows& rows, NearestColumns& nearest);
    [[nodiscard]] BakedRows rows_of(int first_row, int last_row);
    [[nodiscard]] Window copy_from(int first_row) const;
    [[nodiscard]] std::size_t texels_in(int rows) const {
        return static_cast<std::size_t>(rows) * static_cast<std::size_t>(width_);
    }

    int width_, height_, texels_;
    std::function<void(const BakedRows&)> take_;
    int first_row_ = 0;  ///< Of those in memory.
    int end_row_ = 0;
    int next_row_ = 0;  ///< To be handed on.
    Window window_;
    /// Of the rows handed on next: to the nearest baked texel of the column, or more than
    /// `texels_`.
    std::vector<std::uint16_t> upwards_, downwards_;
};

}  // namespace relief
