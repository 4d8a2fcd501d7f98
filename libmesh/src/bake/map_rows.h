// SPDX-License-Identifier: Apache-2.0
/// \file
/// The steps of a bake that rows from rays and rows from shards share: memory for rows, checks of
/// the options of a map, padding, and the result. Tests: tests/mesh/bake/bake_shards_test.cpp,
/// padding_test.cpp.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "bake/edge_padding.h"
#include "bake/layers.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/bake_shards.h"

namespace relief::detail {

/// The layers of some rows of a map, and their memory.
struct Strip {
    std::array<std::vector<float>, baked_layers.size()> layers;
    std::vector<TexelState> states;

    Strip(const BakeLayers& requested, std::size_t width, std::size_t rows);

    /// Returns the number of rows whose layers take about 60 MB: a multiple of 64, or the height.
    static int row_count(const BakeLayers& requested, int width, int height);

    /// Returns a view of `count` rows from row `begin` of the strip.
    BakedRows rows(int width, int first_row, int begin, int count);
};

/// Passes the rows of a whole map on, padded as its options say.
class PaddedRows {
  public:
    /// \throws FileError if the temporary file of a filled border cannot be created
    PaddedRows(const BakeMapOptions& map, const std::function<void(const BakedRows&)>& take);
    PaddedRows(const PaddedRows&) = delete;
    PaddedRows& operator=(const PaddedRows&) = delete;

    /// Adds the next rows. Row counts are multiples of 64, except for the last rows.
    void push(const BakedRows& rows) { dilation_.push(rows); }

  private:
    std::optional<BorderFill> border_;
    Dilation dilation_;
};

/// Checks the options of padding. \throws InvalidInput
void check_padding(const BakeMapOptions& map);

/// Completes the result of a map from what its rows found.
/// \param is_whole  all rows of the map were baked
BakeResult completed(const BakeShard& shard, const BakeDistances& distances, bool is_whole,
                     Report& report);

}  // namespace relief::detail
