// SPDX-License-Identifier: Apache-2.0
/// \file
/// A height map as a continuous field: bilinear between the centers of texels, as textures are
/// sampled.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "image/texel_loops.h"
#include "relief/mesh/image.h"

namespace relief::detail {

/// The heights between the centers of four neighboring texels. x and y are from the upper left one,
/// 0 to 1.
struct BilinearPatch {
    double upper_left, upper_right, lower_left, lower_right;

    [[nodiscard]] double twist() const {
        return upper_left - upper_right - lower_left + lower_right;
    }
    [[nodiscard]] double at(double x, double y) const {
        return mix(mix(upper_left, upper_right, x), mix(lower_left, lower_right, x), y);
    }
    /// Returns the derivatives to the right and downwards.
    [[nodiscard]] glm::dvec2 slope(double x, double y) const {
        return {upper_right - upper_left + twist() * y, lower_left - upper_left + twist() * x};
    }
    [[nodiscard]] double max() const {
        return std::max(std::max(upper_left, upper_right), std::max(lower_left, lower_right));
    }

    static double mix(double a, double b, double weight) { return a + (b - a) * weight; }
};

class BilinearHeights {
  public:
    /// \param heights  finite, row by row from the upper left texel; at least one
    BilinearHeights(std::span<const float> heights, int width, int height, const Wraps& wrap)
        : width_(width), height_(height), wrap_(wrap) {
        texels_.reserve(stride() * (static_cast<std::size_t>(height) + 2));
        for (int y = -1; y <= height; ++y) {
            const int row = place_within(y, height, wrap.y);
            for (int x = -1; x <= width; ++x) {
                const int column = place_within(x, width, wrap.x);
                texels_.push_back(
                    heights[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                            static_cast<std::size_t>(column)]);
            }
        }
    }

    /// The number of texels along both axes.
    [[nodiscard]] glm::dvec2 size() const { return {width_, height_}; }
    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] const Wraps& wraps() const { return wrap_; }

    /// Returns the height at texture coordinates, which are finite.
    [[nodiscard]] double at(const glm::dvec2& texcoord) const {
        // In texels from the center of the border texel; at least 0.5, so that truncation rounds
        // down.
        const double x = reduced(texcoord.x, wrap_.x) * width_ + 0.5;
        const double y = reduced(texcoord.y, wrap_.y) * height_ + 0.5;
        const auto column = static_cast<std::size_t>(x);
        const auto row = static_cast<std::size_t>(y);
        const float* const upper = &texels_[row * stride() + column];
        const float* const lower = upper + stride();
        const double along_x = x - static_cast<double>(column);
        const BilinearPatch patch{upper[0], upper[1], lower[0], lower[1]};
        return patch.at(along_x, y - static_cast<double>(row));
    }

    /// Returns the patch to the right of and below the center of a texel, which may be outside of
    /// the map.
    [[nodiscard]] BilinearPatch patch(std::int64_t column, std::int64_t row) const {
        const bool is_inside = column >= -1 && column < width_ && row >= -1 && row < height_;
        if (is_inside) {
            const float* const upper =
                &texels_[border_index(row) * stride() + border_index(column)];
            const float* const lower = upper + stride();
            return {upper[0], upper[1], lower[0], lower[1]};
        }
        const auto at = [this](std::int64_t x, std::int64_t y) {
            return static_cast<double>(
                texels_[border_index(reduced(y, height_, wrap_.y)) * stride() +
                        border_index(reduced(x, width_, wrap_.x))]);
        };
        return {at(column, row), at(column + 1, row), at(column, row + 1), at(column + 1, row + 1)};
    }

    /// Returns the derivatives along u and v: differences of heights half a texel to both sides.
    [[nodiscard]] glm::dvec2 slope(const glm::dvec2& texcoord) const {
        const glm::dvec2 half = 0.5 / size();
        return {width_ *
                    (at({texcoord.x + half.x, texcoord.y}) - at({texcoord.x - half.x, texcoord.y})),
                height_ * (at({texcoord.x, texcoord.y + half.y}) -
                           at({texcoord.x, texcoord.y - half.y}))};
    }

  private:
    /// Returns the place in a line with the border texel, whose index is -1.
    static std::size_t border_index(std::int64_t index) {
        return static_cast<std::size_t>(index + 1);
    }

    /// Returns the coordinate within [0,1] that has the same height.
    static double reduced(double coordinate, Wrap wrap) {
        if (coordinate >= 0.0 && coordinate < 1.0) return coordinate;
        if (wrap == Wrap::clamp) return std::clamp(coordinate, 0.0, 1.0);
        if (wrap == Wrap::repeat) return coordinate - std::floor(coordinate);
        const double within_two = coordinate - 2.0 * std::floor(coordinate / 2.0);
        return within_two > 1.0 ? 2.0 - within_two : within_two;
    }

    /// Returns the texel within [0, count) that has the same height.
    static int reduced(std::int64_t texel, int count, Wrap wrap) {
        const std::int64_t near = wrap == Wrap::clamp
                                      ? std::clamp<std::int64_t>(texel, 0, count - 1)
                                      : texel % (2 * std::int64_t{count});
        return place_within(static_cast<int>(near), count, wrap);
    }

    [[nodiscard]] std::size_t stride() const { return static_cast<std::size_t>(width_) + 2; }

    int width_;
    int height_;
    Wraps wrap_;
    std::vector<float> texels_;  ///< With a border of one texel, by the wrap mode.
};

}  // namespace relief::detail
