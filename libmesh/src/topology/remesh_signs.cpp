// SPDX-License-Identifier: Apache-2.0
// Which points of a grid are outside: a flood through cells without triangles from outside, and a
// search along edges that no triangle crosses for the points between cells of the surface.
#include <algorithm>
#include <bit>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "parallel.h"
#include "progress_stage.h"
#include "topology/remesh_grid.h"

namespace relief::detail {
namespace {

constexpr std::uint64_t all_bits = ~std::uint64_t{0};
constexpr std::uint64_t low_x = 0x0101010101010101;   ///< The bits with x = 0.
constexpr std::uint64_t high_x = 0x8080808080808080;  ///< The bits with x = 7.
constexpr std::uint64_t low_y = 0x00000000000000FF;
constexpr std::uint64_t high_y = 0xFF00000000000000;

/// Extends the reached cells of a brick as far as cells without triangles permit.
void flood(Brick& brick) {
    BrickMask& reached = brick.reached;
    bool has_changed = true;
    while (has_changed) {
        has_changed = false;
        for (std::size_t step = 0; step < 16; ++step) {
            // Upwards, then downwards.
            const std::size_t z = step < 8 ? step : 15 - step;
            const std::uint64_t empty = ~brick.surface[z];
            std::uint64_t word = reached[z];
            if (z > 0) word |= reached[z - 1];
            if (z < 7) word |= reached[z + 1];
            word &= empty;
            std::uint64_t before = 0;
            while (word != before) {
                before = word;
                word |=
                    ((word & ~high_x) << 1 | (word & ~low_x) >> 1 | word << 8 | word >> 8) & empty;
            }
            if (word == reached[z]) continue;
            reached[z] = word;
            has_changed = true;
        }
    }
}

/// Returns the cells of the neighbor on a side that touch reached cells of a brick.
BrickMask spread(const BrickMask& reached, int axis, int side) {
    BrickMask result{};
    for (std::size_t z = 0; z < 8; ++z) {
        const std::uint64_t word = reached[z];
        if (axis == 0)
            result[z] = side > 0 ? (word & high_x) >> 7 : (word & low_x) << 7;
        else if (axis == 1)
            result[z] = side > 0 ? (word & high_y) >> 56 : (word & low_y) << 56;
    }
    if (axis == 2) result[side > 0 ? 0 : 7] = reached[side > 0 ? 7 : 0];
    return result;
}

/// Floods the grid from its first corner.
class CellFlood {
  public:
    explicit CellFlood(RemeshGrid& grid) : grid_(grid), is_waiting_(grid.bricks.size(), false) {}

    void run() {
        BrickMask all;
        all.fill(all_bits);
        enter(glm::ivec3(0), all);
        for (std::size_t i = 0; !stack_.empty(); ++i) {
            check_cancelled(i);
            const glm::ivec3 place = stack_.back();
            stack_.pop_back();
            leave(place, all);
        }
    }

  private:
    void enter(const glm::ivec3& place, const BrickMask& cells) {
        const std::int32_t index = grid_.brick_at(place);
        if (index == RemeshGrid::no_brick) {
            std::uint8_t& is_reached = grid_.place_reached[grid_.place_index(place)];
            const bool any = std::any_of(cells.begin(), cells.end(),
                                         [](std::uint64_t word) { return word != 0; });
            if (is_reached != 0 || !any) return;
            is_reached = 1;
            stack_.push_back(place);
            return;
        }
        Brick& brick = grid_.bricks[static_cast<std::size_t>(index)];
        bool any = false;
        for (std::size_t z = 0; z < 8; ++z) {
            const std::uint64_t fresh = cells[z] & ~brick.surface[z] & ~brick.reached[z];
            any = any || fresh != 0;
            brick.reached[z] |= fresh;
        }
        if (!any || is_waiting_[static_cast<std::size_t>(index)]) return;
        is_waiting_[static_cast<std::size_t>(index)] = true;
        stack_.push_back(place);
    }
    void leave(const glm::ivec3& place, const BrickMask& all) {
        const std::int32_t index = grid_.brick_at(place);
        if (index != RemeshGrid::no_brick) {
            is_waiting_[static_cast<std::size_t>(index)] = false;
            flood(grid_.bricks[static_cast<std::size_t>(index)]);
        }
        const BrickMask& reached = index == RemeshGrid::no_brick
                                       ? all
                                       : grid_.bricks[static_cast<std::size_t>(index)].reached;
        for (int axis = 0; axis < 3; ++axis) {
            for (const int side : {-1, 1}) {
                glm::ivec3 next = place;
                next[axis] += side;
                if (next[axis] < 0 || next[axis] >= grid_.bricks_along()[axis]) continue;
                enter(next, spread(reached, axis, side));
            }
        }
    }

    RemeshGrid& grid_;
    std::vector<bool> is_waiting_;
    std::vector<glm::ivec3> stack_;
};

/// Returns, for each brick, the points at the corners of given cells.
///
/// \param outside  whether the cells are those that are reached, or the empty ones that are not
std::vector<BrickMask> corners_of(const RemeshGrid& grid, bool outside) {
    std::vector<BrickMask> masks(grid.bricks.size());
    for (std::size_t b = 0; b < masks.size(); ++b) {
        const Brick& brick = grid.bricks[b];
        for (std::size_t z = 0; z < 8; ++z)
            masks[b][z] = outside ? brick.reached[z] : ~brick.reached[z] & ~brick.surface[z];
    }
    // A point at the corner of a cell has the coordinates of the cell, or larger ones by 1.
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<BrickMask> next(masks.size());
        parallel_for(masks.size(), 512, [&](std::size_t begin, std::size_t end) {
            for (std::size_t b = begin; b < end; ++b) {
                glm::ivec3 place = grid.bricks[b].place;
                --place[axis];
                const std::int32_t below = grid.brick_at(place);
                BrickMask from{};
                if (below != RemeshGrid::no_brick)
                    from = masks[static_cast<std::size_t>(below)];
                else if (grid.is_reached(place) == outside)
                    from.fill(all_bits);
                const BrickMask carried = spread(from, axis, 1);
                for (std::size_t z = 0; z < 8; ++z) {
                    const std::uint64_t word = masks[b][z];
                    std::uint64_t shifted = 0;
                    if (axis == 0) shifted = (word & ~high_x) << 1;
                    if (axis == 1) shifted = word << 8;
                    if (axis == 2) shifted = z > 0 ? masks[b][z - 1] : 0;
                    next[b][z] = word | shifted | carried[z];
                }
            }
        });
        masks = std::move(next);
    }
    return masks;
}

/// Decides the sides of points around which all cells meet triangles, from the nearest decided
/// points along edges that no triangle crosses. Points that cannot be decided are inside.
class PointSearch {
  public:
    explicit PointSearch(RemeshGrid& grid) : grid_(grid) {}

    void run() {
        for (std::size_t b = 0; b < grid_.bricks.size(); ++b) {
            const Brick& brick = grid_.bricks[b];
            for (std::size_t z = 0; z < 8; ++z) {
                for (std::uint64_t word = ~brick.known[z]; word != 0; word &= word - 1) {
                    const int bit = std::countr_zero(word);
                    candidates_.push_back(8 * brick.place +
                                          glm::ivec3(bit % 8, bit / 8, static_cast<int>(z)));
                }
            }
        }
        while (!candidates_.empty()) {
            check_cancelled();
            decide_candidates();
        }
    }

  private:
    enum class Side : std::uint8_t { unknown, inside, outside };

    [[nodiscard]] Side side_of(const glm::ivec3& point) const {
        const std::int32_t index = grid_.brick_at(point >> 3);
        if (index == RemeshGrid::no_brick)
            return grid_.is_reached(point >> 3) ? Side::outside : Side::inside;
        const Brick& brick = grid_.bricks[static_cast<std::size_t>(index)];
        const glm::ivec3 in = point & 7;
        const int bit = in.x + 8 * in.y;
        const auto z = static_cast<std::size_t>(in.z);
        if ((brick.known[z] >> bit & 1) == 0) return Side::unknown;
        return (brick.outside[z] >> bit & 1) != 0 ? Side::outside : Side::inside;
    }
    [[nodiscard]] bool is_crossed(const glm::ivec3& point, int axis) const {
        const std::int32_t index = grid_.brick_at(point >> 3);
        if (index == RemeshGrid::no_brick) return false;
        const glm::ivec3 in = point & 7;
        return (grid_.bricks[static_cast<std::size_t>(index)]
                        .crossed[static_cast<std::size_t>(axis)][static_cast<std::size_t>(in.z)] >>
                    (in.x + 8 * in.y) &
                1) != 0;
    }
    /// Calls visit(neighbor) for the points at the other ends of edges that are not crossed.
    template <typename Visit>
    void visit_neighbors(const glm::ivec3& point, const Visit& visit) const {
        for (int axis = 0; axis < 3; ++axis) {
            glm::ivec3 other = point;
            ++other[axis];
            if (!is_crossed(point, axis)) visit(other);
            other[axis] -= 2;
            if (!is_crossed(other, axis)) visit(other);
        }
    }

    void decide_candidates() {
        std::vector<Side> sides(candidates_.size(), Side::unknown);
        parallel_for(candidates_.size(), 1024, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                visit_neighbors(candidates_[i], [&](const glm::ivec3& other) {
                    sides[i] = std::max(sides[i], side_of(other));
                });
        });
        std::vector<glm::ivec3> decided;
        for (std::size_t i = 0; i < candidates_.size(); ++i) {
            if (sides[i] == Side::unknown) continue;
            const glm::ivec3& point = candidates_[i];
            if (side_of(point) != Side::unknown) continue;  // It was a candidate twice.
            Brick& brick = grid_.bricks[static_cast<std::size_t>(grid_.brick_at(point >> 3))];
            const glm::ivec3 in = point & 7;
            const std::uint64_t bit = std::uint64_t{1} << (in.x + 8 * in.y);
            brick.known[static_cast<std::size_t>(in.z)] |= bit;
            if (sides[i] == Side::outside) brick.outside[static_cast<std::size_t>(in.z)] |= bit;
            decided.push_back(point);
        }
        candidates_.clear();
        for (const glm::ivec3& point : decided)
            visit_neighbors(point, [&](const glm::ivec3& other) {
                if (side_of(other) == Side::unknown) candidates_.push_back(other);
            });
    }

    RemeshGrid& grid_;
    std::vector<glm::ivec3> candidates_;
};

}  // namespace

void find_outside(RemeshGrid& grid, bool shell) {
    CellFlood(grid).run();
    const std::vector<BrickMask> outside = corners_of(grid, true);
    const std::vector<BrickMask> inside = corners_of(grid, false);
    for (std::size_t b = 0; b < grid.bricks.size(); ++b) {
        Brick& brick = grid.bricks[b];
        for (std::size_t z = 0; z < 8; ++z) {
            // Points near a triangle are inside of a shell.
            const std::uint64_t near = shell ? brick.near[z] : 0;
            brick.outside[z] = outside[b][z] & ~near;
            brick.known[z] = outside[b][z] | inside[b][z] | near;
        }
    }
    PointSearch(grid).run();
}

}  // namespace relief::detail
