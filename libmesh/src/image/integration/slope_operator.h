// SPDX-License-Identifier: Apache-2.0
/// \file
/// Slope kernels as linear operators on whole images, border included, with their transposes and
/// the frequencies that they see: what turns "heights of these slopes" into equations.
/// Tests: tests/mesh/image/integration/heights_from_normals_test.cpp.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "relief/mesh/bump.h"

namespace relief {

/// A weight at a place.
struct Weighted {
    int place;
    double weight;
};

/// A linear map from n samples of a line to n others.
class LineOperator {
  public:
    /// What a clamped line goes on as: what is differentiated, point-reflected, so that planes stay
    /// planes; what is averaged, as its last sample.
    enum class Beyond { reflected, last };

    /// \param taps  of a sample: offsets and weights; beyond the border by `wrap` (bump.h)
    LineOperator(int count, std::span<const Weighted> taps, Wrap wrap, Beyond clamped);
    [[nodiscard]] LineOperator transposed() const;

    /// Of one result: the samples that it comes from.
    [[nodiscard]] std::span<const Weighted> entries(int row) const {
        return {entries_.data() + starts_[static_cast<std::size_t>(row)],
                entries_.data() + starts_[static_cast<std::size_t>(row) + 1]};
    }
    /// Adds the result to `to`.
    void add_to(const double* from, double* to) const;
    [[nodiscard]] int count() const { return count_; }

  private:
    explicit LineOperator(int count) : count_(count) {}
    void find_inside();

    int count_;
    std::vector<std::size_t> starts_;
    std::vector<Weighted> entries_;
    /// Rows [inside_begin_, inside_end_) all have the entries of the first, moved along.
    int inside_begin_ = 0, inside_end_ = 0;
};

/// Slopes along x and along y (upwards) of the rows of an image.
class SlopeOperator {
  public:
    SlopeOperator(int width, int height, const GradientKernel& kernel, Wraps wrap,
                  glm::dvec2 texel);

    /// Slopes of one row of heights.
    void slopes(const double* heights, int row, double* along_x, double* along_y) const;

    /// Rows of slopes, from wherever they are.
    using SlopeRows = std::function<void(int row, double* along_x, double* along_y)>;
    /// The transpose of `slopes`: one number for each height.
    void transpose(const SlopeRows& slopes, double* heights) const;

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }

  private:
    void transpose_band(const SlopeRows& slopes, double* heights, int begin, int end) const;

    int width_, height_;
    LineOperator difference_x_, smoothing_x_, difference_y_, smoothing_y_;
    LineOperator difference_x_t_, smoothing_x_t_, difference_y_t_, smoothing_y_t_;
};

}  // namespace relief
