// SPDX-License-Identifier: Apache-2.0
/// \file
/// Changes of a map across its seams and inside, computed from rows in order, for maps that are not
/// in memory.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/height_map.h"

namespace RELIEF_API relief {
namespace detail {

class SeamSurvey {
  public:
    /// \param width, height  of the map
    SeamSurvey(int width, int height);

    /// Adds the next row from the top. All rows of a map have the same type. Heights that are not
    /// finite are ignored.
    template <typename Sample>
    void add_row(std::span<const Sample> row);

    /// Returns the result over all rows.
    [[nodiscard]] Tiling tiling() const;

  private:
    /// The root of a mean square.
    struct Mean {
        double squares = 0.0;
        std::size_t count = 0;
        void add(double difference);
        [[nodiscard]] double root() const;
    };
    [[nodiscard]] static double seam_of(const std::vector<Mean>& lines);
    [[nodiscard]] Mean change_to(std::span<const double> next) const;

    int height_;
    int rows_ = 0;
    std::vector<std::size_t>
        columns_;  ///< The left column of each evaluated pair; the last one is at the seam.
    std::vector<int> row_pairs_;  ///< The upper row of each evaluated pair.
    std::vector<Mean> across_columns_, across_rows_;
    std::vector<double> first_, previous_;
};

}  // namespace detail
}  // namespace relief
