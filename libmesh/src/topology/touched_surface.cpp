// SPDX-License-Identifier: Apache-2.0
// Balls that touch a surface: they are listed by the cells of a grid, and each triangle is compared
// with those of its cells. Tests: tests/mesh/topology/touched_surface_test.cpp.
#include "topology/touched_surface.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>

#include "parallel.h"
#include "relaxed_store.h"
#include "topology/triangle_distance.h"

namespace relief::detail {
namespace {

struct Box {
    glm::dvec3 low, high;
};

Box box_of(const Ball& ball) {
    return {ball.center - ball.radius, ball.center + ball.radius};
}

/// Lists of the balls whose boxes overlap each cell.
class BallGrid {
  public:
    explicit BallGrid(std::span<const Ball> balls)
        : count_(static_cast<std::uint32_t>(balls.size())), bounds_(box_of(balls[0])) {
        double largest = 0.0;
        for (const Ball& ball : balls) {
            const Box box = box_of(ball);
            bounds_ = {glm::min(bounds_.low, box.low), glm::max(bounds_.high, box.high)};
            largest = std::max(largest, ball.radius);
        }
        // A cell is at least as large as the largest ball, so each ball is in at most 8 cells.
        for (int i = 0; i < 3; ++i) {
            const double size = bounds_.high[i] - bounds_.low[i];
            const double count = largest > 0.0 ? size / (2.0 * largest) : max_cells;
            cells_[i] = static_cast<int>(std::clamp(count, 1.0, max_cells));
            per_length_[i] = size > 0.0 ? cells_[i] / size : 0.0;
        }
        const auto cells = static_cast<std::size_t>(cells_.x) * static_cast<std::size_t>(cells_.y) *
                           static_cast<std::size_t>(cells_.z);
        begin_.assign(cells + 1, 0);
        for (const Ball& ball : balls)
            visit(box_of(ball), [&](std::size_t cell) { ++begin_[cell + 1]; });
        std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
        balls_.resize(begin_.back());
        std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
        for (std::uint32_t i = 0; i < count_; ++i)
            visit(box_of(balls[i]), [&](std::size_t cell) { balls_[next[cell]++] = i; });
    }

    /// Visits the balls near a box, some of them several times.
    template <typename Visit>
    void visit_balls(const Box& box, const Visit& visit_ball) const {
        if (glm::any(glm::lessThan(box.high, bounds_.low)) ||
            glm::any(glm::lessThan(bounds_.high, box.low)))
            return;
        const glm::dvec3 sides(cell_of(box.high) - cell_of(box.low) + 1);
        if (sides.x * sides.y * sides.z > static_cast<double>(count_)) {
            for (std::uint32_t i = 0; i < count_; ++i)
                visit_ball(i);
            return;
        }
        visit(box, [&](std::size_t cell) {
            for (std::uint32_t i = begin_[cell]; i < begin_[cell + 1]; ++i)
                visit_ball(balls_[i]);
        });
    }

  private:
    static constexpr double max_cells = 64.0;  ///< Along each axis.

    [[nodiscard]] glm::ivec3 cell_of(const glm::dvec3& p) const {
        const glm::dvec3 last(cells_ - 1);
        return glm::clamp((p - bounds_.low) * per_length_, glm::dvec3(0.0), last);
    }
    template <typename Visit>
    void visit(const Box& box, const Visit& visit_cell) const {
        const glm::ivec3 first = cell_of(box.low);
        const glm::ivec3 last = cell_of(box.high);
        for (int z = first.z; z <= last.z; ++z) {
            for (int y = first.y; y <= last.y; ++y) {
                for (int x = first.x; x <= last.x; ++x)
                    visit_cell(static_cast<std::size_t>((z * cells_.y + y) * cells_.x + x));
            }
        }
    }

    std::uint32_t count_;
    Box bounds_;
    glm::ivec3 cells_{1};
    glm::dvec3 per_length_{0.0};
    std::vector<std::uint32_t> begin_;  ///< By cell: its first entry in balls_.
    std::vector<std::uint32_t> balls_;
};

}  // namespace

std::vector<bool> touch_surface(std::span<const Ball> balls, const CollapseInput& input) {
    if (balls.empty()) return {};
    const BallGrid grid(balls);
    std::vector<std::uint8_t> touched(balls.size(), 0);
    const std::vector<glm::uvec3>& triangles = input.topology.triangles;
    parallel_for(triangles.size(), 16384, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            const glm::uvec3& triangle = triangles[t];
            const Corners corners = {input.point(triangle.x), input.point(triangle.y),
                                     input.point(triangle.z)};
            const Box box{glm::min(corners[0], glm::min(corners[1], corners[2])),
                          glm::max(corners[0], glm::max(corners[1], corners[2]))};
            grid.visit_balls(box, [&](std::uint32_t i) {
                const Ball& ball = balls[i];
                const double limit = ball.radius * ball.radius;
                const glm::dvec3 outside = glm::max(
                    glm::dvec3(0.0), glm::max(box.low - ball.center, ball.center - box.high));
                if (glm::dot(outside, outside) > limit) return;
                // Other threads may write the same value.
                if (squared_distance(ball.center, corners) <= limit) relaxed_store(touched[i], 1);
            });
        }
    });
    return {touched.begin(), touched.end()};
}

}  // namespace relief::detail
