// SPDX-License-Identifier: Apache-2.0
/// \file
/// A sparse grid of cells around triangles: bricks of 8 x 8 x 8 cells exist only near the surface.
///
/// A word has one bit for each cell, or grid point, of a layer of a brick: bit x + 8 y. The point
/// with the coordinates of a cell is its lowest corner. Coordinates are in cells.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace relief::detail {

/// One bit for each cell, or grid point, of a brick.
using BrickMask = std::array<std::uint64_t, 8>;

struct Brick {
    glm::ivec3 place{0};                 ///< In bricks.
    BrickMask surface{};                 ///< Cells that a triangle meets.
    BrickMask reached{};                 ///< Cells that are reached from outside.
    BrickMask near{};                    ///< Points close to a triangle, for shells.
    BrickMask outside{};                 ///< Points.
    BrickMask known{};                   ///< Points whose side is decided.
    std::array<BrickMask, 3> crossed{};  ///< Edges from a point along each axis.
    std::uint32_t first_hit = 0;         ///< Of the edges, in the order of axis, layer and bit.
};

/// A triangle in the coordinates of the grid.
struct GridTriangle {
    std::array<glm::dvec3, 3> corners;  ///< Ascending: the winding has no influence.
    glm::dvec3 normal;                  ///< Unit.
    bool is_reversed;                   ///< Its winding is not that of `corners`.
    std::uint32_t range;                ///< The material range.
};

/// A place at which the surface crosses an edge of the grid.
struct Hit {
    float at;  ///< From the lower point, 0 to 1.
    std::uint32_t triangle;
};

/// The hits of an edge that are nearest to its ends.
struct EdgeHits {
    Hit first;
    Hit last;
};

/// A place at which the surface closes a gap between triangles: it crosses an edge without a hit.
struct GridGap {
    std::uint64_t key = 0;  ///< RemeshGrid::gap_key()
    double at = 0.5;        ///< From the lower point, 0 to 1.
    glm::dvec3 normal{0.0};
};

class RemeshGrid {
  public:
    RemeshGrid(const Mesh& mesh, int resolution, Report& report);

    [[nodiscard]] const std::vector<GridTriangle>& triangles() const { return triangles_; }
    [[nodiscard]] glm::ivec3 bricks_along() const { return bricks_along_; }
    /// Maps coordinates of the grid to object space.
    [[nodiscard]] glm::vec3 to_object(const glm::dvec3& point) const {
        return glm::vec3((point - offset_) * cell_ + low_) + 0.0F;
    }

    static constexpr std::int32_t no_brick = -1;
    [[nodiscard]] std::size_t place_index(const glm::ivec3& place) const {
        return static_cast<std::size_t>(place.x) +
               static_cast<std::size_t>(bricks_along_.x) *
                   (static_cast<std::size_t>(place.y) +
                    static_cast<std::size_t>(bricks_along_.y) * static_cast<std::size_t>(place.z));
    }
    /// Returns the index of a brick, or no_brick.
    [[nodiscard]] std::int32_t brick_at(const glm::ivec3& place) const {
        const bool is_inside = glm::all(glm::greaterThanEqual(place, glm::ivec3(0))) &&
                               glm::all(glm::lessThan(place, bricks_along_));
        return is_inside ? brick_index_[place_index(place)] : no_brick;
    }
    /// Returns whether the cells of a place without a brick are reached from outside.
    [[nodiscard]] bool is_reached(const glm::ivec3& place) const {
        const bool is_inside = glm::all(glm::greaterThanEqual(place, glm::ivec3(0))) &&
                               glm::all(glm::lessThan(place, bricks_along_));
        return !is_inside || place_reached[place_index(place)] != 0;
    }
    /// Returns whether a point is outside of the solid.
    [[nodiscard]] bool is_outside(const glm::ivec3& point) const {
        const std::int32_t brick = brick_at(point >> 3);
        if (brick == no_brick) return is_reached(point >> 3);
        const glm::ivec3 in = point & 7;
        return (bricks[static_cast<std::size_t>(brick)].outside[static_cast<std::size_t>(in.z)] >>
                    (in.x + 8 * in.y) &
                1) != 0;
    }
    /// Returns the hits of the edge from a point along an axis, or null.
    [[nodiscard]] const EdgeHits* hits(const glm::ivec3& point, int axis) const;

    static std::uint64_t gap_key(const glm::ivec3& point, int axis) {
        const auto bits = [](int x) { return static_cast<std::uint64_t>(x); };
        return bits(point.z) << 34 | bits(point.y) << 18 | bits(point.x) << 2 | bits(axis);
    }
    /// Returns the gap on the edge from a point along an axis, or null.
    [[nodiscard]] const GridGap* gap(const glm::ivec3& point, int axis) const;

    /// Adds a brick without triangles at the end. sort_bricks() must follow.
    void add_brick(const glm::ivec3& place);
    void sort_bricks();

    std::vector<GridGap> gaps;                ///< In the order of their keys.
    std::vector<Brick> bricks;                ///< In the order of their places.
    std::vector<std::uint8_t> place_reached;  ///< By place, for places without a brick.
    std::vector<EdgeHits> edge_hits;

  private:
    glm::dvec3 low_{0.0};
    glm::dvec3 offset_{0.0};  ///< The coordinates of low_ in the grid.
    double cell_ = 1.0;
    glm::ivec3 bricks_along_{0};
    std::vector<GridTriangle> triangles_;
    std::vector<std::int32_t> brick_index_;

    void gather_triangles(const Mesh& mesh, Report& report);
    void make_bricks();
    void mark_cells();
};

/// Finds where triangles cross the edges of the grid; or, for a shell, where edges enter the
/// neighborhood of triangles, whose points are marked as near.
void find_hits(RemeshGrid& grid, bool shell);

/// Decides which points are outside: all that are reached from outside.
void find_outside(RemeshGrid& grid, bool shell);

/// Decides which points are outside: those with an absolute winding number below a half. Bricks and
/// gaps are added where the surface is between triangles.
void find_outside_by_winding(RemeshGrid& grid, bool shell);

/// The distance from triangles that is solid in a shell, in cells.
constexpr double shell_distance = 0.75;

/// Triangles of the result with the triangles of the grid that they come from.
struct ContouredSurface {
    std::vector<glm::vec3> positions;  ///< Object space.
    std::vector<glm::uvec3> triangles;
    std::vector<std::uint32_t> ranges;  ///< By triangle.
};

/// Computes the surface between points inside and outside.
ContouredSurface contoured(const RemeshGrid& grid, bool shell);

}  // namespace relief::detail
