// SPDX-License-Identifier: Apache-2.0
// Relaxed cones. A ray passes the axis of a texel's cone and goes down; within the cone it must not
// leave the surface again. It leaves where the surface falls away from the axis, so a cone ends at
// the first such point above its apex. These points are found through pyramids of the maximum
// heights of patches that fall to each side.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <type_traits>
#include <variant>
#include <vector>

#include "bump/height_field_data.h"
#include "parallel.h"
#include "portable_math.h"
#include "relief/mesh/height_march.h"

namespace relief {
using namespace relief::detail;

namespace {

/// Cones are at most so wide, in texels, so that nothing farther away matters.
constexpr int max_radius = 128;
constexpr int border = max_radius + 4;

/// The range of the slopes of a patch. Each component is linear along the other axis.
struct SlopeRange {
    float min_x, max_x, min_y, max_y;
};

/// The sides to which a patch can fall.
enum Side : std::size_t { falls_right, falls_left, falls_down, falls_up, side_count };

/// The directions in which slopes around an apex are compared, and the bound for those between
/// them: a slope of size 1 changes by at most half the angle between neighbors.
constexpr int direction_count = 64;
constexpr double half_angle = std::numbers::pi / direction_count;

std::array<glm::vec2, direction_count> unit_directions() {
    std::array<glm::vec2, direction_count> directions;
    for (int i = 0; i < direction_count; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / direction_count;
        directions[static_cast<std::size_t>(i)] = {static_cast<float>(portable::cos(angle)),
                                                   static_cast<float>(portable::sin(angle))};
    }
    return directions;
}

/// The patches of a map with a border, and maxima over squares of them.
class FallingPatches {
  public:
    explicit FallingPatches(const BilinearHeights& heights)
        : width_(heights.width() + 2 * border), height_(heights.height() + 2 * border) {
        const std::size_t count =
            static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
        patches_.resize(count);
        slopes_.resize(count);
        for (std::vector<MaximumLevel>& levels : levels_)
            levels = {{width_, height_, std::vector<float>(count, 0.0F)}};
        parallel_for(count, 1 << 14, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const auto width = static_cast<std::size_t>(width_);
                add(i, heights.patch(static_cast<std::int64_t>(i % width) - border,
                                     static_cast<std::int64_t>(i / width) - border));
            }
        });
        for (std::vector<MaximumLevel>& levels : levels_) {
            while (levels.size() < level_count)
                levels.push_back(coarser(levels.back()));
        }
    }

    [[nodiscard]] const BilinearPatch& patch(int x, int y) const { return patches_[index(x, y)]; }
    [[nodiscard]] const SlopeRange& slopes(int x, int y) const { return slopes_[index(x, y)]; }
    [[nodiscard]] const MaximumLevel& level(Side side, int level) const {
        return levels_[side][static_cast<std::size_t>(level)];
    }

    static constexpr std::size_t level_count = 8;

  private:
    [[nodiscard]] std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(x);
    }

    void add(std::size_t i, const BilinearPatch& patch) {
        const glm::vec2 first = patch.slope(0.0, 0.0);
        const glm::vec2 last = patch.slope(1.0, 1.0);
        const SlopeRange range{std::min(first.x, last.x), std::max(first.x, last.x),
                               std::min(first.y, last.y), std::max(first.y, last.y)};
        patches_[i] = patch;
        slopes_[i] = range;
        const auto max = static_cast<float>(patch.max());
        if (range.min_x < 0.0F) levels_[falls_right][0].maxima[i] = max;
        if (range.max_x > 0.0F) levels_[falls_left][0].maxima[i] = max;
        if (range.min_y < 0.0F) levels_[falls_down][0].maxima[i] = max;
        if (range.max_y > 0.0F) levels_[falls_up][0].maxima[i] = max;
    }

    /// Halves a level; sizes are rounded up.
    static MaximumLevel coarser(const MaximumLevel& finer) {
        MaximumLevel level{(finer.width + 1) / 2, (finer.height + 1) / 2, {}};
        for (int y = 0; y < level.height; ++y) {
            const int below = std::min(2 * y + 1, finer.height - 1);
            for (int x = 0; x < level.width; ++x) {
                const int right = std::min(2 * x + 1, finer.width - 1);
                level.maxima.push_back(
                    std::max(std::max(finer.at(2 * x, 2 * y), finer.at(right, 2 * y)),
                             std::max(finer.at(2 * x, below), finer.at(right, below))));
            }
        }
        return level;
    }

    int width_;
    int height_;
    std::vector<BilinearPatch> patches_;
    std::vector<SlopeRange> slopes_;
    std::array<std::vector<MaximumLevel>, side_count> levels_;
};

/// The cone of a texel. Cones are filtered between texels, so the cone of a texel holds for all
/// apexes less than a texel away: a filtered cone is at most as wide as the widest of four.
class ConeSearch {
  public:
    /// \param x, y  of the texel, with the border
    ConeSearch(const FallingPatches& patches, int x, int y, double widest)
        : patches_(patches), x_(x), y_(y), end_(x, y) {
        lowest_ = 1.0F;
        for (int row = y - 1; row <= y + 1; ++row) {
            for (int column = x - 1; column <= x + 1; ++column)
                lowest_ =
                    std::min(lowest_, static_cast<float>(patches.patch(column, row).upper_left));
        }
        // Texels farther away than the maximum radius must not matter.
        steepest_ = std::max(1.0 / widest, (1.0 - lowest_) / max_radius);
    }

    /// Returns the ratio of radius in texels to height.
    /// \param likely  a patch that probably ends the cone, as it does that of a neighbor: it
    ///         excludes most others. Set to the one that does
    double ratio(const std::array<glm::vec2, direction_count>& directions, glm::ivec2& likely) {
        add_near(directions);
        add_patch(likely.x, likely.y);
        constexpr int top = static_cast<int>(FallingPatches::level_count) - 1;
        const int first_row = (y_ - max_radius - 2) >> top;
        const int first_column = (x_ - max_radius - 2) >> top;
        for (int row = first_row; row <= (y_ + max_radius + 2) >> top; ++row) {
            for (int column = first_column; column <= (x_ + max_radius + 2) >> top; ++column)
                add_node(top, column, row);
        }
        likely = end_;
        return 1.0 / steepest_;
    }

  private:
    /// The patches of all apexes and their neighbors. On a line from an apex, heights change by at
    /// most the steepest slope in its direction; without a slope below 0, nothing falls.
    void add_near(const std::array<glm::vec2, direction_count>& directions) {
        std::array<float, direction_count> rises;
        rises.fill(-std::numeric_limits<float>::infinity());
        float largest = 0.0F;
        for (int row = y_ - 2; row <= y_ + 1; ++row) {
            for (int column = x_ - 2; column <= x_ + 1; ++column) {
                const SlopeRange& s = patches_.slopes(column, row);
                const float size_x = std::max(-s.min_x, s.max_x);
                const float size_y = std::max(-s.min_y, s.max_y);
                largest = std::max(largest, size_x * size_x + size_y * size_y);
                for (std::size_t i = 0; i < direction_count; ++i) {
                    const glm::vec2 d = directions[i];
                    rises[i] = std::max(rises[i], std::max(s.min_x * d.x, s.max_x * d.x) +
                                                      std::max(s.min_y * d.y, s.max_y * d.y));
                }
            }
        }
        const double between = std::sqrt(static_cast<double>(largest)) * half_angle;
        for (std::size_t i = 0; i < direction_count; ++i) {
            const double fall = rises[(i + direction_count / 2) % direction_count];
            if (fall + between > 0.0) steepest_ = std::max(steepest_, rises[i] + between);
        }
    }

    [[nodiscard]] bool is_higher(double height, double squared_distance) const {
        const double above = height - lowest_;
        return above > 0.0 && above * above > steepest_ * steepest_ * squared_distance;
    }

    /// Returns the squared distance of patches from the nearest apex.
    [[nodiscard]] double squared_distance(int first_x, int first_y, int size) const {
        const double x = std::max({0, first_x - (x_ + 1), x_ - 1 - (first_x + size)});
        const double y = std::max({0, first_y - (y_ + 1), y_ - 1 - (first_y + size)});
        return x * x + y * y;
    }

    void add_node(int level, int column, int row) {
        const int size = 1 << level;
        const int first_x = column << level;
        const int first_y = row << level;
        float height = 0.0F;
        const auto consider = [&](Side side, bool is_behind) {
            if (is_behind) height = std::max(height, patches_.level(side, level).at(column, row));
        };
        if (first_x < 0 || first_y < 0) return;
        const MaximumLevel& shape = patches_.level(falls_right, level);
        if (column >= shape.width || row >= shape.height) return;
        consider(falls_right, first_x + size > x_ - 1);
        consider(falls_left, first_x < x_ + 1);
        consider(falls_down, first_y + size > y_ - 1);
        consider(falls_up, first_y < y_ + 1);
        if (!is_higher(height, squared_distance(first_x, first_y, size))) return;
        if (level == 0) return add_patch(column, row);
        // The nearest of the four first, because it excludes most.
        const int right = x_ >= first_x + size / 2 ? 1 : 0;
        const int lower = y_ >= first_y + size / 2 ? 1 : 0;
        add_node(level - 1, 2 * column + right, 2 * row + lower);
        add_node(level - 1, 2 * column + 1 - right, 2 * row + lower);
        add_node(level - 1, 2 * column + right, 2 * row + 1 - lower);
        add_node(level - 1, 2 * column + 1 - right, 2 * row + 1 - lower);
    }

    void add_patch(int column, int row) {
        const bool is_near = column >= x_ - 2 && column <= x_ + 1 && row >= y_ - 2 && row <= y_ + 1;
        if (is_near || !falls_away(column, row)) return;
        const double distance = squared_distance(column, row, 1);
        const double above = patches_.patch(column, row).max() - lowest_;
        const double steepness = above / std::sqrt(distance);
        if (steepness <= steepest_) return;
        steepest_ = steepness;
        end_ = {column, row};
    }

    /// Returns true if a patch falls anywhere in the direction from any apex. With an apex moved by
    /// up to a texel, the slope in that direction, times the distance, is least at a corner.
    [[nodiscard]] bool falls_away(int column, int row) const {
        const BilinearPatch& patch = patches_.patch(column, row);
        for (int b = 0; b < 2; ++b) {
            for (int a = 0; a < 2; ++a) {
                const glm::dvec2 slope = patch.slope(a, b);
                const double rise = slope.x * (column + a - x_) + slope.y * (row + b - y_);
                if (rise - std::abs(slope.x) - std::abs(slope.y) < 0.0) return true;
            }
        }
        return false;
    }

    const FallingPatches& patches_;
    int x_;
    int y_;
    glm::ivec2 end_;         ///< The patch that ends the cone; the texel if it is a near one.
    float lowest_ = 0.0F;    ///< The lowest apex.
    double steepest_ = 0.0;  ///< The height by which the cone's flank rises per texel.
};

}  // namespace

Image relaxed_cones(const HeightField& field, int bits) {
    const glm::ivec2 size = field.size();
    Image map = make_image(size.x, size.y, 2, bits, ColorSpace::data);
    const BilinearHeights& heights = field.data_->heights;
    const FallingPatches patches(heights);
    const std::array<glm::vec2, direction_count> directions = unit_directions();
    const double widest = std::max(size.x, size.y);
    std::visit(
        [&]<typename Sample>(std::vector<Sample>& samples) {
            parallel_for(samples.size() / 2, 256, [&](std::size_t begin, std::size_t end) {
                glm::ivec2 likely(border);
                for (std::size_t i = begin; i < end; ++i) {
                    const int x = static_cast<int>(i % static_cast<std::size_t>(size.x));
                    const int y = static_cast<int>(i / static_cast<std::size_t>(size.x));
                    ConeSearch search(patches, x + border, y + border, widest);
                    const double root = std::sqrt(search.ratio(directions, likely) / widest);
                    const double height = patches.patch(x + border, y + border).upper_left;
                    if constexpr (std::is_same_v<Sample, float>) {
                        samples[2 * i] = static_cast<float>(height);
                        // Half a unit in the last place is far below the margins of the search.
                        samples[2 * i + 1] = static_cast<float>(std::min(root, 1.0));
                    } else {
                        constexpr double largest = std::numeric_limits<Sample>::max();
                        samples[2 * i] = static_cast<Sample>(height * largest + 0.5);
                        samples[2 * i + 1] =
                            static_cast<Sample>(std::clamp(root * largest, 1.0, largest));
                    }
                }
            });
        },
        map.samples);
    return map;
}

}  // namespace relief
