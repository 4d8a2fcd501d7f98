// SPDX-License-Identifier: Apache-2.0
// Which points of a grid are outside, by their winding numbers; and the surface that closes gaps,
// where the winding number is a half between triangles.
// Tests: tests/mesh/topology/winding_number_test.cpp.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "geometry/direction.h"
#include "parallel.h"
#include "progress_stage.h"
#include "topology/remesh_grid.h"
#include "topology/winding_number.h"

namespace relief::detail {
namespace {

constexpr double limit = 0.5;  ///< Of the absolute winding number of points inside.

WindingTree tree_of(const RemeshGrid& grid) {
    std::vector<WoundTriangle> triangles;
    triangles.reserve(grid.triangles().size());
    for (const GridTriangle& triangle : grid.triangles()) {
        const auto& c = triangle.corners;
        triangles.push_back(triangle.is_reversed ? WoundTriangle{c[0], c[2], c[1]}
                                                 : WoundTriangle{c[0], c[1], c[2]});
    }
    return WindingTree(std::move(triangles));
}

class WindingSigns {
  public:
    WindingSigns(RemeshGrid& grid, bool shell) : grid_(grid), shell_(shell), tree_(tree_of(grid)) {}

    void run() {
        decide_bricks(0);
        decide_places();
        // Bricks are added where the surface closes a gap far from triangles.
        while (true) {
            check_cancelled();
            const std::vector<glm::ivec3> missing = missing_bricks();
            if (missing.empty()) break;
            for (const glm::ivec3& place : missing)
                grid_.add_brick(place);
            decide_bricks(grid_.bricks.size() - missing.size());
        }
        grid_.sort_bricks();
        find_gaps();
    }

  private:
    /// Returns the absolute winding number: inside of closed parts that face inwards it is 1, too.
    /// It is fine near the limit, which it reaches only between triangles.
    [[nodiscard]] double winding(const glm::dvec3& point) const {
        constexpr double coarse_error = 0.05;
        const double coarse = std::abs(tree_.winding_number(point, WindingTree::coarse));
        if (std::abs(coarse - limit) > coarse_error) return coarse;
        return std::abs(tree_.winding_number(point, WindingTree::fine));
    }

    void decide_bricks(std::size_t first) {
        ProgressStage stage("winding numbers", grid_.bricks.size() - first);
        parallel_for(grid_.bricks.size() - first, 4, [&](std::size_t begin, std::size_t end) {
            for (std::size_t b = first + begin; b < first + end; ++b)
                decide(grid_.bricks[b]);
            stage.advance(end - begin);
        });
    }

    /// Returns whether a brick without triangles is on one side: its corners and its center are
    /// far from the limit, between which the winding number varies little.
    [[nodiscard]] bool is_uniform(const Brick& brick, bool& is_inside) const {
        constexpr double margin = 0.2;
        if (std::ranges::any_of(brick.surface, [](std::uint64_t word) { return word != 0; }))
            return false;
        const glm::dvec3 low(8 * brick.place);
        is_inside = winding(low + 3.5) >= limit;
        for (int i = 0; i < 9; ++i) {
            const glm::dvec3 at =
                i == 8 ? low + 3.5 : low + 7.0 * glm::dvec3(i & 1, i >> 1 & 1, i >> 2 & 1);
            const double away = winding(at) - limit;
            if ((away >= 0.0) != is_inside || std::abs(away) < margin) return false;
        }
        return true;
    }

    void decide(Brick& brick) const {
        bool is_inside = false;
        const bool is_simple = is_uniform(brick, is_inside);
        for (int z = 0; z < 8; ++z) {
            const auto layer = static_cast<std::size_t>(z);
            std::uint64_t outside = 0;
            if (is_simple) {
                outside = is_inside ? 0 : ~std::uint64_t{0};
            } else {
                for (int bit = 0; bit < 64; ++bit) {
                    const glm::ivec3 point = 8 * brick.place + glm::ivec3(bit % 8, bit / 8, z);
                    if (winding(glm::dvec3(point)) < limit) outside |= std::uint64_t{1} << bit;
                }
            }
            // Points near a triangle are inside of a shell.
            brick.outside[layer] = shell_ ? outside & ~brick.near[layer] : outside;
            brick.known[layer] = ~std::uint64_t{0};
        }
    }

    void decide_places() {
        const glm::ivec3 along = grid_.bricks_along();
        const auto layers = static_cast<std::size_t>(along.z);
        parallel_for(layers, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t z = begin; z < end; ++z) {
                for (int y = 0; y < along.y; ++y) {
                    for (int x = 0; x < along.x; ++x) {
                        const glm::ivec3 place(x, y, static_cast<int>(z));
                        if (grid_.brick_at(place) != RemeshGrid::no_brick) continue;
                        const bool is_outside = winding(glm::dvec3(8 * place) + 3.5) < limit;
                        grid_.place_reached[grid_.place_index(place)] = is_outside ? 1 : 0;
                    }
                }
            }
        });
    }

    /// Returns the places without a brick that the surface may touch: next to a place on the other
    /// side, or to a brick with a point on the other side that is next to them.
    [[nodiscard]] std::vector<glm::ivec3> missing_bricks() const {
        const glm::ivec3 along = grid_.bricks_along();
        std::vector<std::vector<glm::ivec3>> found(static_cast<std::size_t>(along.z));
        parallel_for(found.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t z = begin; z < end; ++z) {
                for (int y = 0; y < along.y; ++y) {
                    for (int x = 0; x < along.x; ++x) {
                        const glm::ivec3 place(x, y, static_cast<int>(z));
                        if (grid_.brick_at(place) == RemeshGrid::no_brick && is_touched(place))
                            found[z].push_back(place);
                    }
                }
            }
        });
        std::vector<glm::ivec3> all;
        for (const std::vector<glm::ivec3>& layer : found)
            all.insert(all.end(), layer.begin(), layer.end());
        return all;
    }

    [[nodiscard]] bool is_touched(const glm::ivec3& place) const {
        const bool is_outside = grid_.is_reached(place);
        glm::ivec3 step;
        for (step.z = -1; step.z <= 1; ++step.z) {
            for (step.y = -1; step.y <= 1; ++step.y) {
                for (step.x = -1; step.x <= 1; ++step.x) {
                    const std::int32_t index = grid_.brick_at(place + step);
                    if (index == RemeshGrid::no_brick) {
                        if (grid_.is_reached(place + step) != is_outside) return true;
                        continue;
                    }
                    const Brick& brick = grid_.bricks[static_cast<std::size_t>(index)];
                    if (differs_at(brick, step, is_outside)) return true;
                }
            }
        }
        return false;
    }

    /// Returns whether a point of a brick that is next to the place before it is on another side.
    /// \param step  from that place to the brick
    static bool differs_at(const Brick& brick, const glm::ivec3& step, bool is_outside) {
        constexpr std::uint64_t low_x = 0x0101010101010101;
        constexpr std::uint64_t low_y = 0x00000000000000FF;
        std::uint64_t mask = ~std::uint64_t{0};
        if (step.x != 0) mask &= step.x > 0 ? low_x : low_x << 7;
        if (step.y != 0) mask &= step.y > 0 ? low_y : low_y << 56;
        for (std::size_t z = 0; z < 8; ++z) {
            if ((step.z > 0 && z != 0) || (step.z < 0 && z != 7)) continue;
            const std::uint64_t other = is_outside ? ~brick.outside[z] : brick.outside[z];
            if ((other & mask) != 0) return true;
        }
        return false;
    }

    /// Finds the edges between two sides that cross no triangle.
    void find_gaps() {
        std::vector<std::vector<GridGap>> found(grid_.bricks.size());
        parallel_for(found.size(), 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t b = begin; b < end; ++b) {
                for (int i = 0; i < 512; ++i) {
                    const glm::ivec3 point =
                        8 * grid_.bricks[b].place + glm::ivec3(i & 7, i >> 3 & 7, i >> 6);
                    for (int axis = 0; axis < 3; ++axis)
                        add_gap(point, axis, found[b]);
                }
            }
        });
        for (const std::vector<GridGap>& gaps : found)
            grid_.gaps.insert(grid_.gaps.end(), gaps.begin(), gaps.end());
        std::ranges::sort(grid_.gaps, {}, &GridGap::key);
    }

    void add_gap(const glm::ivec3& point, int axis, std::vector<GridGap>& gaps) const {
        glm::ivec3 end = point;
        ++end[axis];
        if (grid_.is_outside(point) == grid_.is_outside(end)) return;
        if (grid_.hits(point, axis) != nullptr) return;
        const double from = winding(glm::dvec3(point)) - limit;
        const double to = winding(glm::dvec3(end)) - limit;
        // In a shell, the sides may differ in more than the winding number.
        if ((from < 0.0) == (to < 0.0)) return;
        constexpr double end_margin = 0.01;
        GridGap gap;
        gap.key = RemeshGrid::gap_key(point, axis);
        gap.at = std::clamp(from / (from - to), end_margin, 1.0 - end_margin);
        glm::dvec3 place(point);
        place[axis] += gap.at;
        constexpr double step = 0.5;
        glm::dvec3 slope;
        for (int i = 0; i < 3; ++i) {
            glm::dvec3 offset(0.0);
            offset[i] = step;
            slope[i] = winding(place - offset) - winding(place + offset);
        }
        gap.normal = direction_or_zero(slope);
        if (gap.normal == glm::dvec3(0.0)) gap.normal[axis] = 1.0;
        gaps.push_back(gap);
    }

    RemeshGrid& grid_;
    bool shell_;
    WindingTree tree_;
};

}  // namespace

void find_outside_by_winding(RemeshGrid& grid, bool shell) {
    WindingSigns(grid, shell).run();
}

}  // namespace relief::detail
