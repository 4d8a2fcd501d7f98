// SPDX-License-Identifier: Apache-2.0
/// \file
/// Boxes in the plane, sorted along a Morton curve: finds those that meet a box.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

#include "progress_stage.h"

namespace relief::detail {

struct PlaneBox {
    glm::vec2 min{std::numeric_limits<float>::infinity()};
    glm::vec2 max{-std::numeric_limits<float>::infinity()};

    void add(const glm::vec2& point) {
        min = glm::min(min, point);
        max = glm::max(max, point);
    }
    /// True if both have a point in common.
    [[nodiscard]] bool meets(const PlaneBox& other) const {
        return min.x <= other.max.x && other.min.x <= max.x && min.y <= other.max.y &&
               other.min.y <= max.y;
    }
};

/// A tree without pointers: box i of a level encloses boxes 8 * i to 8 * i + 7 of the level below.
class BoxTree {
  public:
    /// \param boxes  finite, not empty
    explicit BoxTree(std::span<const PlaneBox> boxes) : order_(boxes.size()) {
        PlaneBox all;
        for (const PlaneBox& box : boxes) {
            all.add(box.min);
            all.add(box.max);
        }
        const auto cell = [](double x, double low, double high) {
            return high > low ? static_cast<std::uint32_t>(65535.0 * ((x - low) / (high - low)))
                              : 0U;
        };
        std::vector<std::uint64_t> keys(boxes.size());
        for (std::uint32_t i = 0; i < boxes.size(); ++i) {
            check_cancelled(i);
            const glm::dvec2 middle =
                0.5 * glm::dvec2(boxes[i].min) + 0.5 * glm::dvec2(boxes[i].max);
            const std::uint64_t code = spread(cell(middle.x, all.min.x, all.max.x)) |
                                       spread(cell(middle.y, all.min.y, all.max.y)) << 1;
            keys[i] = code << 32 | i;
        }
        std::size_t steps = 0;
        std::sort(keys.begin(), keys.end(), [&](std::uint64_t a, std::uint64_t b) {
            check_cancelled(++steps);
            return a < b;
        });
        std::vector<PlaneBox> level(boxes.size());
        for (std::size_t i = 0; i < keys.size(); ++i) {
            check_cancelled(i);
            order_[i] = static_cast<std::uint32_t>(keys[i]);
            level[i] = boxes[order_[i]];
        }
        levels_.push_back(std::move(level));
        while (levels_.back().size() > 1) {
            const std::vector<PlaneBox>& below = levels_.back();
            std::vector<PlaneBox> above((below.size() + fan - 1) / fan);
            for (std::size_t i = 0; i < below.size(); ++i) {
                above[i / fan].add(below[i].min);
                above[i / fan].add(below[i].max);
            }
            levels_.push_back(std::move(above));
        }
    }

    /// The indices of the boxes along the curve: neighbors are close to each other.
    [[nodiscard]] std::span<const std::uint32_t> order() const { return order_; }

    /// Calls visit(index) for the boxes that meet `box`, until it returns true.
    /// \param box  may be reduced by `visit` \return whether a call returned true
    template <typename Visit>
    bool find(const PlaneBox& box, const Visit& visit) const {
        return !order_.empty() && find(levels_.size() - 1, 0, box, visit);
    }

  private:
    static constexpr std::size_t fan = 8;

    /// Spreads 16 bits to every second bit.
    static std::uint64_t spread(std::uint32_t x) {
        std::uint64_t y = x;
        y = (y | y << 8) & 0x00FF00FF;
        y = (y | y << 4) & 0x0F0F0F0F;
        y = (y | y << 2) & 0x33333333;
        return (y | y << 1) & 0x55555555;
    }

    template <typename Visit>
    bool find(std::size_t level, std::size_t node, const PlaneBox& box, const Visit& visit) const {
        if (!levels_[level][node].meets(box)) return false;
        if (level == 0) return visit(order_[node]);
        const std::size_t end = std::min(fan * node + fan, levels_[level - 1].size());
        for (std::size_t child = fan * node; child < end; ++child)
            if (find(level - 1, child, box, visit)) return true;
        return false;
    }

    std::vector<std::uint32_t> order_;
    std::vector<std::vector<PlaneBox>> levels_;
};

}  // namespace relief::detail
