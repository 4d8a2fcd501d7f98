// SPDX-License-Identifier: Apache-2.0
// Dual contouring of a grid with several vertices in a cell: one for each component of the surface
// in the cell, and a quadrilateral for each edge between a point inside and one outside.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "geometry/direction.h"
#include "parallel.h"
#include "progress_stage.h"
#include "topology/remesh_grid.h"
#include "topology/triangle_distance.h"

namespace relief::detail {
namespace {

// The corner of a cell with the offsets x, y, z has the number x + 2 y + 4 z. The edge along an
// axis with the offsets u and v along the next two axes has the number 4 axis + u + 2 v.

/// The number of the edge along an axis that begins at a corner.
constexpr std::size_t edge_at(std::size_t corner, std::size_t axis) {
    return 4 * axis + (corner >> (axis + 1) % 3 & 1) + 2 * (corner >> (axis + 2) % 3 & 1);
}

/// The components of the surface in a cell.
struct CellComponents {
    std::array<std::int8_t, 12> of_edge{};  ///< -1: the edge does not cross the surface.
    std::uint8_t count = 0;
};

/// \param inside  a bit for each corner
///
/// Two edges of a face are connected if they are its only ones. If there are four, the surface
/// separates the two outer corners.
constexpr CellComponents components_of(unsigned inside) {
    std::array<std::size_t, 12> parent{};
    for (std::size_t e = 0; e < 12; ++e)
        parent[e] = e;
    const auto root = [&](std::size_t e) {
        while (parent[e] != e)
            e = parent[e];
        return e;
    };
    const auto is_inside = [&](std::size_t corner) { return (inside >> corner & 1) != 0; };
    CellComponents result;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t side = 0; side < 2; ++side) {
            const std::size_t b = (axis + 1) % 3;
            const std::size_t c = (axis + 2) % 3;
            const std::size_t base = side << axis;
            const std::array<std::size_t, 4> corners = {base, base | 1U << b,
                                                        base | 1U << b | 1U << c, base | 1U << c};
            const std::array<std::size_t, 4> edges = {
                edge_at(corners[0], b), edge_at(corners[1], c), edge_at(corners[3], b),
                edge_at(corners[0], c)};
            std::array<std::size_t, 4> crossing{};
            std::size_t count = 0;
            for (std::size_t i = 0; i < 4; ++i) {
                if (is_inside(corners[i]) != is_inside(corners[(i + 1) % 4]))
                    crossing[count++] = edges[i];
            }
            if (count == 2) parent[root(crossing[0])] = root(crossing[1]);
            if (count < 4) continue;
            for (std::size_t i = 0; i < 4; ++i) {
                if (!is_inside(corners[i])) parent[root(edges[i])] = root(edges[(i + 3) % 4]);
            }
        }
    }
    std::array<std::int8_t, 12> number{};
    for (auto& n : number)
        n = -1;
    for (std::size_t e = 0; e < 12; ++e) {
        const auto axis = e / 4;
        const std::size_t low = ((e & 1) << (axis + 1) % 3) | ((e >> 1 & 1) << (axis + 2) % 3);
        result.of_edge[e] = -1;
        if (is_inside(low) == is_inside(low | 1U << axis)) continue;
        if (number[root(e)] < 0) number[root(e)] = static_cast<std::int8_t>(result.count++);
        result.of_edge[e] = number[root(e)];
    }
    return result;
}

const std::array<CellComponents, 256>& component_table() {
    static const std::array<CellComponents, 256> table = [] {
        std::array<CellComponents, 256> all;
        for (unsigned inside = 0; inside < 256; ++inside)
            all[inside] = components_of(inside);
        return all;
    }();
    return table;
}

/// The quadric of the planes that cross a cell, relative to the mean of the crossings.
class PlaneFit {
  public:
    void add(const glm::dvec3& point, const glm::dvec3& normal) {
        points_[count_] = point;
        normals_[count_++] = normal;
    }
    /// Returns the point with the smallest squared distances from the planes, near the mean.
    [[nodiscard]] glm::dvec3 best() const {
        glm::dvec3 sum(0.0);
        glm::dvec3 direction(0.0);
        for (std::size_t i = 0; i < count_; ++i) {
            sum += points_[i];
            direction += glm::dot(normals_[i], normals_[0]) < 0.0 ? -normals_[i] : normals_[i];
        }
        const auto count = static_cast<double>(count_);
        const glm::dvec3 mean = sum / count;
        std::array<glm::dvec3, 3> matrix{};
        glm::dvec3 right(0.0);
        for (std::size_t i = 0; i < count_; ++i) {
            const glm::dvec3& n = normals_[i];
            for (int k = 0; k < 3; ++k)
                matrix[static_cast<std::size_t>(k)] += n[k] * n;
            right += n * glm::dot(n, points_[i] - mean);
        }
        constexpr double flat = 0.995;  ///< Of the length of the sum of unit normals.
        const double length = glm::length(direction);
        if (length > flat * count) {
            const glm::dvec3 axis = direction / length;
            const glm::dvec3 image(glm::dot(matrix[0], axis), glm::dot(matrix[1], axis),
                                   glm::dot(matrix[2], axis));
            return mean + axis * (glm::dot(axis, right) / glm::dot(axis, image));
        }
        return mean + solved(matrix, right);
    }
    [[nodiscard]] glm::dvec3 mean() const {
        glm::dvec3 sum(0.0);
        for (std::size_t i = 0; i < count_; ++i)
            sum += points_[i];
        return sum / static_cast<double>(count_);
    }

  private:
    /// Solves with the pseudoinverse by Jacobi's method. Directions with small eigenvalues are
    /// ignored.
    static glm::dvec3 solved(std::array<glm::dvec3, 3> a, const glm::dvec3& right) {
        constexpr double smallest = 0.03;  ///< Relative to the largest eigenvalue.
        constexpr int sweeps = 5;
        std::array<glm::dvec3, 3> vectors = {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0),
                                             glm::dvec3(0, 0, 1)};
        for (int sweep = 0; sweep < sweeps; ++sweep) {
            for (const auto& [p, q] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2)}) {
                const auto row_p = static_cast<std::size_t>(p);
                const auto row_q = static_cast<std::size_t>(q);
                if (std::abs(a[row_p][q]) < 1e-14) continue;
                const double theta = (a[row_q][q] - a[row_p][p]) / (2.0 * a[row_p][q]);
                const double t = (theta >= 0.0 ? 1.0 : -1.0) /
                                 (std::abs(theta) + std::sqrt(theta * theta + 1.0));
                const double c = 1.0 / std::sqrt(t * t + 1.0);
                const double s = t * c;
                for (auto& row : a) {
                    const double x = row[p];
                    const double y = row[q];
                    row[p] = c * x - s * y;
                    row[q] = s * x + c * y;
                }
                const glm::dvec3 old_p = a[row_p];
                const glm::dvec3 old_q = a[row_q];
                a[row_p] = c * old_p - s * old_q;
                a[row_q] = s * old_p + c * old_q;
                const glm::dvec3 vector_p = vectors[row_p];
                const glm::dvec3 vector_q = vectors[row_q];
                vectors[row_p] = c * vector_p - s * vector_q;
                vectors[row_q] = s * vector_p + c * vector_q;
            }
        }
        const double largest = std::max({a[0].x, a[1].y, a[2].z});
        glm::dvec3 result(0.0);
        for (std::size_t i = 0; i < 3; ++i) {
            const double value = a[i][static_cast<int>(i)];
            if (value > smallest * largest)
                result += vectors[i] * (glm::dot(vectors[i], right) / value);
        }
        return result;
    }

    std::array<glm::dvec3, 12> points_;
    std::array<glm::dvec3, 12> normals_;
    std::size_t count_ = 0;
};

/// The cells of a brick that the surface crosses.
struct BrickCells {
    BrickMask mixed{};
    std::uint32_t first = 0;  ///< The index of the first one.
};

/// A vertex on an edge of the result that would not be manifold.
struct MiddleVertex {
    std::uint64_t key;
    glm::vec3 position;
};

/// A triangle whose vertices may be middle vertices of its brick.
struct BrickTriangles {
    static constexpr std::uint32_t middle_flag = 0x80000000U;
    std::vector<glm::uvec3> triangles;
    std::vector<std::uint32_t> ranges;
    std::vector<MiddleVertex> middles;
};

class Contouring {
  public:
    Contouring(const RemeshGrid& grid, bool shell) : grid_(grid), shell_(shell) {}

    ContouredSurface run() {
        find_cells();
        place_vertices();
        add_triangles();
        return std::move(surface_);
    }

  private:
    void find_cells();
    void place_vertices();
    void add_triangles();
    void add_quadrilateral(const glm::ivec3& point, int axis, BrickTriangles& result) const;
    [[nodiscard]] std::uint32_t vertex_of(const glm::ivec3& cell, std::size_t edge) const;

    [[nodiscard]] unsigned config_of(const glm::ivec3& cell) const {
        const std::size_t index = cell_index(cell);
        return config_[index];
    }
    [[nodiscard]] std::size_t cell_index(const glm::ivec3& cell) const {
        const auto brick = static_cast<std::size_t>(grid_.brick_at(cell >> 3));
        const glm::ivec3 in = cell & 7;
        const BrickCells& cells = cells_[brick];
        std::size_t index = cells.first;
        for (std::size_t z = 0; z < static_cast<std::size_t>(in.z); ++z)
            index += static_cast<std::size_t>(std::popcount(cells.mixed[z]));
        const std::uint64_t below = (std::uint64_t{1} << (in.x + 8 * in.y)) - 1;
        return index + static_cast<std::size_t>(
                           std::popcount(cells.mixed[static_cast<std::size_t>(in.z)] & below));
    }
    /// Returns the place and the plane of the surface on an edge between two sides: that which is
    /// the first one from outside; or that of a gap; or the middle, if the side of a point is only
    /// known from its neighbors.
    [[nodiscard]] std::pair<glm::dvec3, glm::dvec3> crossing(const glm::ivec3& point,
                                                             int axis) const {
        glm::dvec3 at(point);
        const EdgeHits* hits = grid_.hits(point, axis);
        if (hits == nullptr) {
            const GridGap* gap = grid_.gap(point, axis);
            at[axis] += gap != nullptr ? gap->at : 0.5;
            if (gap != nullptr) return {at, gap->normal};
            glm::dvec3 normal(0.0);
            normal[axis] = 1.0;
            return {at, normal};
        }
        const Hit& hit = grid_.is_outside(point) ? hits->first : hits->last;
        at[axis] += static_cast<double>(hit.at);
        const GridTriangle& triangle = grid_.triangles()[hit.triangle];
        if (!shell_) return {at, triangle.normal};
        return {at, direction_or_zero(at - nearest_point(at, triangle.corners).point)};
    }

    const RemeshGrid& grid_;
    bool shell_;
    std::vector<BrickCells> cells_;
    std::vector<std::uint8_t> config_;   ///< By cell: the corners that are inside.
    std::vector<std::uint32_t> vertex_;  ///< By cell: its first vertex.
    ContouredSurface surface_;
};

/// The points inside of the solid in a brick and next to it: 9 x 9 x 9 bits.
class PointWindow {
  public:
    PointWindow(const RemeshGrid& grid, const Brick& brick) {
        for (int z = 0; z < 9; ++z) {
            for (int y = 0; y < 9; ++y)
                rows_[static_cast<std::size_t>(9 * z + y)] =
                    row(grid, brick, {0, y >> 3, z >> 3}, y & 7, z & 7) |
                    (row(grid, brick, {1, y >> 3, z >> 3}, y & 7, z & 7) & 1) << 8;
        }
    }
    [[nodiscard]] bool is_uniform() const {
        return std::all_of(rows_.begin(), rows_.end(),
                           [&](unsigned row) { return row == rows_[0]; }) &&
               (rows_[0] == 0 || rows_[0] == 0x1FF);
    }
    [[nodiscard]] unsigned config(int x, int y, int z) const {
        const auto pair = [&](int dy, int dz) {
            return rows_[static_cast<std::size_t>(9 * (z + dz) + y + dy)] >> x & 3;
        };
        return pair(0, 0) | pair(1, 0) << 2 | pair(0, 1) << 4 | pair(1, 1) << 6;
    }

  private:
    static unsigned row(const RemeshGrid& grid, const Brick& brick, const glm::ivec3& step, int y,
                        int z) {
        const std::int32_t index =
            step == glm::ivec3(0) ? grid.brick_at(brick.place) : grid.brick_at(brick.place + step);
        if (index == RemeshGrid::no_brick) return grid.is_reached(brick.place + step) ? 0 : 0xFF;
        const std::uint64_t word =
            grid.bricks[static_cast<std::size_t>(index)].outside[static_cast<std::size_t>(z)];
        return static_cast<unsigned>(~word >> (8 * y) & 0xFF);
    }

    std::array<unsigned, 81> rows_{};
};

void Contouring::find_cells() {
    cells_.resize(grid_.bricks.size());
    std::vector<std::vector<std::uint8_t>> configs(grid_.bricks.size());
    parallel_for(grid_.bricks.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b) {
            const PointWindow window(grid_, grid_.bricks[b]);
            if (window.is_uniform()) continue;
            for (int z = 0; z < 8; ++z) {
                for (int y = 0; y < 8; ++y) {
                    for (int x = 0; x < 8; ++x) {
                        const unsigned config = window.config(x, y, z);
                        if (config == 0 || config == 0xFF) continue;
                        cells_[b].mixed[static_cast<std::size_t>(z)] |= std::uint64_t{1}
                                                                        << (x + 8 * y);
                        configs[b].push_back(static_cast<std::uint8_t>(config));
                    }
                }
            }
        }
    });
    for (std::size_t b = 0; b < configs.size(); ++b) {
        cells_[b].first = static_cast<std::uint32_t>(config_.size());
        config_.insert(config_.end(), configs[b].begin(), configs[b].end());
    }
    const auto& table = component_table();
    std::uint32_t vertices = 0;
    vertex_.reserve(config_.size());
    for (const std::uint8_t config : config_) {
        vertex_.push_back(vertices);
        vertices += table[config].count;
    }
    surface_.positions.resize(vertices);
}

/// Returns an offset by which a further component in a cell is moved if it has the place of another
/// one, which happens only if their crossings are symmetric.
glm::dvec3 apart(std::size_t component) {
    return {0.003 * static_cast<double>(component), 0.0, 0.0};
}

void Contouring::place_vertices() {
    const auto& table = component_table();
    // Cells do not share vertices: these stay away from the sides by a part of the cell.
    constexpr double margin = 0.01;
    parallel_for(grid_.bricks.size(), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b) {
            std::size_t index = cells_[b].first;
            for (int z = 0; z < 8; ++z) {
                for (std::uint64_t word = cells_[b].mixed[static_cast<std::size_t>(z)]; word != 0;
                     word &= word - 1, ++index) {
                    const int bit = std::countr_zero(word);
                    const glm::ivec3 cell =
                        8 * grid_.bricks[b].place + glm::ivec3(bit % 8, bit / 8, z);
                    const CellComponents& components = table[config_[index]];
                    std::array<PlaneFit, 4> fits;
                    for (std::size_t e = 0; e < 12; ++e) {
                        if (components.of_edge[e] < 0) continue;
                        const auto axis = static_cast<int>(e / 4);
                        glm::ivec3 point = cell;
                        point[(axis + 1) % 3] += static_cast<int>(e & 1);
                        point[(axis + 2) % 3] += static_cast<int>(e >> 1 & 1);
                        const auto [at, normal] = crossing(point, axis);
                        fits[static_cast<std::size_t>(components.of_edge[e])].add(at, normal);
                    }
                    const glm::dvec3 low = glm::dvec3(cell) + margin;
                    const glm::dvec3 high = glm::dvec3(cell) + 1.0 - margin;
                    const std::span<glm::vec3> places(&surface_.positions[vertex_[index]],
                                                      components.count);
                    for (std::size_t c = 0; c < components.count; ++c) {
                        const auto place = [&](const glm::dvec3& at) {
                            return grid_.to_object(glm::clamp(at, low, high));
                        };
                        const auto is_taken = [&] {
                            return std::find(places.begin(),
                                             places.begin() + static_cast<std::ptrdiff_t>(c),
                                             places[c]) !=
                                   places.begin() + static_cast<std::ptrdiff_t>(c);
                        };
                        places[c] = place(fits[c].best());
                        // Two components of a cell rarely have one place.
                        if (is_taken()) places[c] = place(fits[c].mean());
                        for (std::size_t i = 1; is_taken(); ++i)
                            places[c] = place(0.5 * (low + high) + apart(i));
                    }
                }
            }
        }
    });
}

std::uint32_t Contouring::vertex_of(const glm::ivec3& cell, std::size_t edge) const {
    const std::size_t index = cell_index(cell);
    const CellComponents& components = component_table()[config_[index]];
    return vertex_[index] + static_cast<std::uint32_t>(components.of_edge[edge]);
}

/// Triangulates a polygon as a fan from its first vertex.
void add_fan(std::span<const std::uint32_t> polygon, std::uint32_t range, BrickTriangles& result) {
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
        result.triangles.emplace_back(polygon[0], polygon[i], polygon[i + 1]);
        result.ranges.push_back(range);
    }
}

void Contouring::add_quadrilateral(const glm::ivec3& point, int axis,
                                   BrickTriangles& result) const {
    const auto& table = component_table();
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    const bool is_inside = !grid_.is_outside(point);
    // The cells around the edge, counter-clockwise seen from its upper end.
    constexpr std::array<std::array<int, 2>, 4> around = {{{-1, -1}, {0, -1}, {0, 0}, {-1, 0}}};
    std::array<glm::ivec3, 4> cells;
    std::array<std::size_t, 4> edges{};
    std::array<std::uint32_t, 4> vertices{};
    for (std::size_t i = 0; i < 4; ++i) {
        cells[i] = point;
        cells[i][u] += around[i][0];
        cells[i][v] += around[i][1];
        edges[i] = 4 * static_cast<std::size_t>(axis) + static_cast<std::size_t>(-around[i][0]) +
                   2 * static_cast<std::size_t>(-around[i][1]);
        vertices[i] = vertex_of(cells[i], edges[i]);
    }
    std::array<std::uint32_t, 8> polygon{};
    std::size_t count = 0;
    std::size_t first_middle = 8;
    for (std::size_t i = 0; i < 4; ++i) {
        polygon[count++] = vertices[i];
        // The face between this cell and the next one, which extends from the edge along `side`.
        const int side = i % 2 == 0 ? v : u;
        const int step = i == 0 || i == 3 ? -1 : 1;
        glm::ivec3 beside = point;
        beside[side] += step;
        glm::ivec3 above = beside;
        ++above[axis];
        const bool is_ambiguous =
            grid_.is_outside(beside) == is_inside && grid_.is_outside(above) != is_inside;
        if (!is_ambiguous) continue;
        const auto joins_both = [&](const glm::ivec3& cell, std::size_t edge) {
            const CellComponents& components = table[config_of(cell)];
            const std::size_t other = edge ^ (side == u ? 1U : 2U);
            return components.of_edge[edge] == components.of_edge[other];
        };
        const std::size_t next = (i + 1) % 4;
        if (!joins_both(cells[i], edges[i]) || !joins_both(cells[next], edges[next])) continue;
        // The outer end of the edge, which the surface separates from the other outer point.
        glm::ivec3 outer = point;
        if (is_inside) ++outer[axis];
        glm::ivec3 across = outer;
        if (step < 0) --across[side];
        const glm::dvec3 here = crossing(point, axis).first;
        const glm::dvec3 there = crossing(across, side).first;
        const glm::dvec3 middle = 0.5 * here + 0.5 * there;
        // Identifies the outer point, the plane of the face, and its quarter.
        const int plane = 3 - axis - side;
        const int low_axis = std::min(axis, side);
        const auto part = static_cast<unsigned>(
            (low_axis == axis ? (is_inside ? 0 : 1) : (step < 0 ? 0 : 1)) +
            2 * (low_axis == axis ? (step < 0 ? 0 : 1) : (is_inside ? 0 : 1)));
        const auto bits = [](int x) { return static_cast<std::uint64_t>(x); };
        const std::uint64_t key = bits(outer.z) << 44 | bits(outer.y) << 28 | bits(outer.x) << 12 |
                                  bits(plane) << 2 | part;
        first_middle = std::min(first_middle, count);
        polygon[count++] =
            BrickTriangles::middle_flag | static_cast<std::uint32_t>(result.middles.size());
        result.middles.push_back({key, grid_.to_object(middle)});
    }
    if (!is_inside)
        std::reverse(polygon.begin(), polygon.begin() + static_cast<std::ptrdiff_t>(count));
    const EdgeHits* hits = grid_.hits(point, axis);
    std::uint32_t range = 0;
    if (hits != nullptr)
        range = grid_.triangles()[(is_inside ? hits->last : hits->first).triangle].range;
    const std::span<std::uint32_t> used(polygon.data(), count);
    if (first_middle < 8) {
        const auto is_middle = [](std::uint32_t vertex) {
            return (vertex & BrickTriangles::middle_flag) != 0;
        };
        std::rotate(used.begin(), std::find_if(used.begin(), used.end(), is_middle), used.end());
        add_fan(used, range, result);
        return;
    }
    // The diagonal whose triangles are nearer to the surface on the edge; or the shorter one.
    const std::array<glm::dvec3, 4> at = {
        glm::dvec3(surface_.positions[used[0]]), glm::dvec3(surface_.positions[used[1]]),
        glm::dvec3(surface_.positions[used[2]]), glm::dvec3(surface_.positions[used[3]])};
    const glm::dvec3 on_edge(grid_.to_object(crossing(point, axis).first));
    const double first = std::min(squared_distance(on_edge, {at[0], at[1], at[2]}),
                                  squared_distance(on_edge, {at[0], at[2], at[3]}));
    const double second = std::min(squared_distance(on_edge, {at[1], at[2], at[3]}),
                                   squared_distance(on_edge, {at[1], at[3], at[0]}));
    const glm::dvec3 first_diagonal = at[2] - at[0];
    const glm::dvec3 second_diagonal = at[3] - at[1];
    const double first_length = glm::dot(first_diagonal, first_diagonal);
    const double second_length = glm::dot(second_diagonal, second_diagonal);
    // Squared distances below a thousandth of the length count as equal.
    const double rounding = 1e-6 * std::min(first_length, second_length);
    const bool takes_second =
        std::abs(first - second) > rounding ? second < first : second_length < first_length;
    if (takes_second) std::rotate(used.begin(), used.begin() + 1, used.end());
    add_fan(used, range, result);
}

void Contouring::add_triangles() {
    std::vector<BrickTriangles> pieces(grid_.bricks.size());
    parallel_for(pieces.size(), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b) {
            const Brick& brick = grid_.bricks[b];
            const BrickMask& mixed = cells_[b].mixed;
            for (int z = 0; z < 8; ++z) {
                for (std::uint64_t word = mixed[static_cast<std::size_t>(z)]; word != 0;
                     word &= word - 1) {
                    const int bit = std::countr_zero(word);
                    const glm::ivec3 point = 8 * brick.place + glm::ivec3(bit % 8, bit / 8, z);
                    const unsigned config = config_of(point);
                    for (int axis = 0; axis < 3; ++axis) {
                        if ((config & 1) != (config >> (1 << axis) & 1))
                            add_quadrilateral(point, axis, pieces[b]);
                    }
                }
            }
        }
    });
    // Middle vertices belong to two quadrilaterals.
    std::vector<MiddleVertex> middles;
    for (const BrickTriangles& piece : pieces)
        middles.insert(middles.end(), piece.middles.begin(), piece.middles.end());
    const auto precedes = [](const MiddleVertex& a, const MiddleVertex& b) {
        return a.key < b.key;
    };
    std::sort(middles.begin(), middles.end(), precedes);
    middles.erase(std::unique(middles.begin(), middles.end(),
                              [](const auto& a, const auto& b) { return a.key == b.key; }),
                  middles.end());
    const auto first_middle = static_cast<std::uint32_t>(surface_.positions.size());
    for (const MiddleVertex& middle : middles)
        surface_.positions.push_back(middle.position);
    for (const BrickTriangles& piece : pieces) {
        const auto vertex = [&](std::uint32_t index) {
            if ((index & BrickTriangles::middle_flag) == 0) return index;
            const auto place =
                std::lower_bound(middles.begin(), middles.end(),
                                 piece.middles[index & ~BrickTriangles::middle_flag], precedes);
            return first_middle + static_cast<std::uint32_t>(place - middles.begin());
        };
        for (const glm::uvec3& t : piece.triangles)
            surface_.triangles.emplace_back(vertex(t.x), vertex(t.y), vertex(t.z));
        surface_.ranges.insert(surface_.ranges.end(), piece.ranges.begin(), piece.ranges.end());
    }
}

}  // namespace

ContouredSurface contoured(const RemeshGrid& grid, bool shell) {
    return Contouring(grid, shell).run();
}

}  // namespace relief::detail
