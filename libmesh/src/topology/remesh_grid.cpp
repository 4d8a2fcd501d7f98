// SPDX-License-Identifier: Apache-2.0
// The sparse grid of a remeshing: triangles in its coordinates, the bricks near them, and the cells
// that they meet.
#include "topology/remesh_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "geometry/direction.h"
#include "parallel.h"
#include "progress_stage.h"

namespace relief::detail {
namespace {

/// The coordinates of the lowest position: a brick of margin, and parts of a cell for which the
/// planes of usual models are not those of grid points.
const glm::dvec3 grid_offset = glm::dvec3(8.46875, 8.53125, 8.484375);

/// By how much cells are enlarged when triangles are looked for in them.
constexpr double cell_margin = 1e-4;

/// Calls visit(cell) for the cells of size 1 that a triangle meets, and for some next to them.
template <typename Visit>
void visit_cells(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& normal,
                 const Visit& visit) {
    const glm::dvec3 low = glm::min(corners[0], glm::min(corners[1], corners[2])) - cell_margin;
    const glm::dvec3 high = glm::max(corners[0], glm::max(corners[1], corners[2])) + cell_margin;
    const glm::ivec3 first(glm::floor(low));
    const glm::ivec3 last(glm::floor(high));
    if (first == last) {
        visit(first);
        return;
    }
    // Columns of cells along the axis w that is nearest to the normal.
    const glm::dvec3 size = glm::abs(normal);
    const int w = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    const int u = (w + 1) % 3;
    const int v = (w + 2) % 3;
    const double slope_u = normal[u] / normal[w];
    const double slope_v = normal[v] / normal[w];
    const double reach = 0.5 * (std::abs(slope_u) + std::abs(slope_v)) + cell_margin;
    // The inner sides of the edges in the plane across w.
    struct Side {
        double across_u, across_v, limit;
    };
    std::array<Side, 3> sides{};
    const double turn = normal[w] > 0.0 ? 1.0 : -1.0;
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3& a = corners[i];
        const glm::dvec3& b = corners[(i + 1) % 3];
        const double across_u = -turn * (b[v] - a[v]);
        const double across_v = turn * (b[u] - a[u]);
        const double extent = (0.5 + cell_margin) * (std::abs(across_u) + std::abs(across_v));
        sides[i] = {across_u, across_v, across_u * a[u] + across_v * a[v] - extent};
    }
    glm::ivec3 cell{0};
    for (cell[u] = first[u]; cell[u] <= last[u]; ++cell[u]) {
        const double at_u = cell[u] + 0.5;
        for (cell[v] = first[v]; cell[v] <= last[v]; ++cell[v]) {
            const double at_v = cell[v] + 0.5;
            const auto is_within = [&](const Side& side) {
                return side.across_u * at_u + side.across_v * at_v >= side.limit;
            };
            if (!is_within(sides[0]) || !is_within(sides[1]) || !is_within(sides[2])) continue;
            const double middle =
                corners[0][w] - slope_u * (at_u - corners[0][u]) - slope_v * (at_v - corners[0][v]);
            const auto from = static_cast<int>(std::floor(std::max(middle - reach, low[w])));
            const auto to = static_cast<int>(std::floor(std::min(middle + reach, high[w])));
            for (cell[w] = from; cell[w] <= to; ++cell[w])
                visit(cell);
        }
    }
}

}  // namespace

RemeshGrid::RemeshGrid(const Mesh& mesh, int resolution, Report& report) : offset_(grid_offset) {
    const auto is_finite_point = [](const glm::vec3& p) {
        return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
    };
    glm::vec3 low(std::numeric_limits<float>::infinity());
    glm::vec3 high(-std::numeric_limits<float>::infinity());
    for (const glm::uvec3& t : mesh.triangles) {
        if (!is_finite_point(mesh.positions[t.x]) || !is_finite_point(mesh.positions[t.y]) ||
            !is_finite_point(mesh.positions[t.z]))
            continue;
        for (int k = 0; k < 3; ++k) {
            low = glm::min(low, mesh.positions[t[k]]);
            high = glm::max(high, mesh.positions[t[k]]);
        }
    }
    const glm::dvec3 size = glm::dvec3(high) - glm::dvec3(low);
    const double longest = std::max({size.x, size.y, size.z});
    if (!(longest > 0.0)) throw InvalidInput("there is no finite triangle with an area to remesh");
    low_ = glm::dvec3(low);
    cell_ = longest / resolution;
    const glm::vec3 far = glm::max(glm::abs(low), glm::abs(high));
    const double largest = std::max({far.x, far.y, far.z});
    const double spacing = std::ldexp(1.0, std::max(std::ilogb(largest) - 23, -149));
    if (cell_ < 256.0 * spacing)
        throw InvalidInput(fmt::format(
            "cells of {:.3g} are too small for coordinates of {:.3g}, whose spacing is {:.3g}: "
            "reduce the resolution, or move the mesh to the origin",
            cell_, largest, spacing));
    bricks_along_ = glm::ivec3(glm::floor(size / cell_ + offset_)) / 8 + 2;
    gather_triangles(mesh, report);
    if (triangles_.empty())
        throw InvalidInput("there is no finite triangle with an area to remesh");
    make_bricks();
    mark_cells();
}

void RemeshGrid::gather_triangles(const Mesh& mesh, Report& report) {
    constexpr double min_height = 1e-12;  ///< As for MeshCondition::triangle_collinear.
    std::uint32_t range = 0;
    std::uint32_t range_end = mesh.material_ranges.empty()
                                  ? std::numeric_limits<std::uint32_t>::max()
                                  : mesh.material_ranges[0].triangle_count;
    triangles_.reserve(mesh.triangles.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        check_cancelled(t);
        while (t >= range_end)
            range_end += mesh.material_ranges[++range].triangle_count;
        GridTriangle triangle{};
        triangle.range = range;
        bool is_finite_triangle = true;
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::vec3& p = mesh.positions[mesh.triangles[t][static_cast<int>(k)]];
            is_finite_triangle = is_finite_triangle && std::isfinite(p.x) && std::isfinite(p.y) &&
                                 std::isfinite(p.z);
            triangle.corners[k] = (glm::dvec3(p) - low_) / cell_ + offset_;
        }
        if (!is_finite_triangle) {
            report.add("triangle with a non-finite corner", "triangle", t, "is ignored");
            continue;
        }
        // The winding has no influence on positions.
        const std::array<glm::dvec3, 3> given = triangle.corners;
        std::sort(triangle.corners.begin(), triangle.corners.end(), comes_before);
        const auto& c = triangle.corners;
        const auto first =
            static_cast<std::size_t>(std::find(given.begin(), given.end(), c[0]) - given.begin());
        triangle.is_reversed = given[(first + 1) % 3] != c[1];
        const glm::dvec3 across = glm::cross(c[1] - c[0], c[2] - c[0]);
        const double longest =
            std::max({glm::dot(c[1] - c[0], c[1] - c[0]), glm::dot(c[2] - c[1], c[2] - c[1]),
                      glm::dot(c[0] - c[2], c[0] - c[2])});
        const double area = glm::length(across);
        if (!(area > min_height * longest)) {
            report.add("triangle without area", "triangle", t, "is ignored");
            continue;
        }
        triangle.normal = across / area;
        triangles_.push_back(triangle);
    }
}

void RemeshGrid::make_bricks() {
    const std::size_t count = place_index(bricks_along_ - 1) + 1;
    brick_index_.assign(count, no_brick);
    std::vector<std::uint8_t> is_near(count, 0);
    parallel_for(triangles_.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            std::array<glm::dvec3, 3> corners = triangles_[t].corners;
            for (glm::dvec3& corner : corners)
                corner *= 0.125;
            visit_cells(corners, triangles_[t].normal, [&](const glm::ivec3& place) {
                const glm::ivec3 clamped = glm::clamp(place, glm::ivec3(0), bricks_along_ - 1);
                std::atomic_ref(is_near[place_index(clamped)]).store(1, std::memory_order_relaxed);
            });
        }
    });
    // The neighbors of these bricks exist, too.
    for (int axis = 0; axis < 3; ++axis) {
        const std::vector<std::uint8_t> before = is_near;
        glm::ivec3 step(0);
        step[axis] = 1;
        const auto stride = static_cast<std::size_t>(
            axis == 0 ? 1 : (axis == 1 ? bricks_along_.x : bricks_along_.x * bricks_along_.y));
        glm::ivec3 place(0);
        std::size_t index = 0;
        for (place.z = 0; place.z < bricks_along_.z; ++place.z) {
            for (place.y = 0; place.y < bricks_along_.y; ++place.y) {
                for (place.x = 0; place.x < bricks_along_.x; ++place.x, ++index) {
                    if (before[index] == 0) continue;
                    if (place[axis] > 0) is_near[index - stride] = 1;
                    if (place[axis] + 1 < bricks_along_[axis]) is_near[index + stride] = 1;
                }
            }
        }
    }
    glm::ivec3 place(0);
    std::size_t index = 0;
    for (place.z = 0; place.z < bricks_along_.z; ++place.z) {
        for (place.y = 0; place.y < bricks_along_.y; ++place.y) {
            for (place.x = 0; place.x < bricks_along_.x; ++place.x, ++index) {
                if (is_near[index] == 0) continue;
                brick_index_[index] = static_cast<std::int32_t>(bricks.size());
                bricks.emplace_back().place = place;
            }
        }
    }
    place_reached.assign(count, 0);
}

void RemeshGrid::mark_cells() {
    parallel_for(triangles_.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            visit_cells(triangles_[t].corners, triangles_[t].normal, [&](const glm::ivec3& cell) {
                const std::int32_t brick = brick_at(cell >> 3);
                if (brick == no_brick) return;
                const glm::ivec3 in = cell & 7;
                const std::uint64_t bit = std::uint64_t{1} << (in.x + 8 * in.y);
                std::uint64_t& word =
                    bricks[static_cast<std::size_t>(brick)].surface[static_cast<std::size_t>(in.z)];
                if ((std::atomic_ref(word).load(std::memory_order_relaxed) & bit) == 0)
                    std::atomic_ref(word).fetch_or(bit, std::memory_order_relaxed);
            });
        }
    });
}

const EdgeHits* RemeshGrid::hits(const glm::ivec3& point, int axis) const {
    const std::int32_t index = brick_at(point >> 3);
    if (index == no_brick) return nullptr;
    const Brick& brick = bricks[static_cast<std::size_t>(index)];
    const glm::ivec3 in = point & 7;
    const auto layer = static_cast<std::size_t>(in.z);
    const auto bit = static_cast<unsigned>(in.x + 8 * in.y);
    const auto a = static_cast<std::size_t>(axis);
    const std::uint64_t word = brick.crossed[a][layer];
    if ((word >> bit & 1) == 0) return nullptr;
    auto place = static_cast<std::size_t>(std::popcount(word & ((std::uint64_t{1} << bit) - 1)));
    for (std::size_t i = 0; i < 8 * a + layer; ++i)
        place += static_cast<std::size_t>(std::popcount(brick.crossed[i / 8][i % 8]));
    return &edge_hits[brick.first_hit + place];
}

const GridGap* RemeshGrid::gap(const glm::ivec3& point, int axis) const {
    const std::uint64_t key = gap_key(point, axis);
    const auto found = std::ranges::lower_bound(gaps, key, {}, &GridGap::key);
    return found != gaps.end() && found->key == key ? &*found : nullptr;
}

void RemeshGrid::add_brick(const glm::ivec3& place) {
    brick_index_[place_index(place)] = static_cast<std::int32_t>(bricks.size());
    Brick& brick = bricks.emplace_back();
    brick.place = place;
    brick.first_hit = static_cast<std::uint32_t>(edge_hits.size());
}

void RemeshGrid::sort_bricks() {
    std::ranges::sort(bricks, {}, [&](const Brick& brick) { return place_index(brick.place); });
    for (std::size_t b = 0; b < bricks.size(); ++b)
        brick_index_[place_index(bricks[b].place)] = static_cast<std::int32_t>(b);
}

}  // namespace relief::detail
