// SPDX-License-Identifier: Apache-2.0
// Finds where the edges of a grid cross triangles, or enter their neighborhood.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <numeric>
#include <vector>

#include "geometry/direction.h"
#include "parallel.h"
#include "progress_stage.h"
#include "topology/column_hits.h"
#include "topology/remesh_grid.h"
#include "topology/triangle_distance.h"

namespace relief::detail {
namespace {

/// A hit with its edge.
struct FoundHit {
    std::uint32_t brick;
    std::uint16_t edge;  ///< In the brick: 512 axis + 64 z + 8 y + x.
    float at;
    std::uint32_t triangle;
};

/// Hits are inside of their edges, so that points on different edges differ.
constexpr double end_margin = 0.01;

void add_hit(const RemeshGrid& grid, const glm::ivec3& point, int axis, double at,
             std::uint32_t triangle, std::vector<FoundHit>& found) {
    const std::int32_t brick = grid.brick_at(point >> 3);
    if (brick == RemeshGrid::no_brick) return;
    const glm::ivec3 in = point & 7;
    found.push_back({static_cast<std::uint32_t>(brick),
                     static_cast<std::uint16_t>(512 * axis + 64 * in.z + 8 * in.y + in.x),
                     static_cast<float>(std::clamp(at, end_margin, 1.0 - end_margin)), triangle});
}

/// Finds the grid lines along an axis that a triangle crosses.
void cross_lines(const RemeshGrid& grid, std::uint32_t index, int axis,
                 std::vector<FoundHit>& found) {
    const GridTriangle& triangle = grid.triangles()[index];
    const auto& corners = triangle.corners;
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    const glm::dvec3 low = glm::min(corners[0], glm::min(corners[1], corners[2]));
    const glm::dvec3 high = glm::max(corners[0], glm::max(corners[1], corners[2]));
    const auto first = static_cast<int>(std::ceil(low[u]));
    const auto last = static_cast<int>(std::floor(high[u]));
    if (first > last || std::ceil(low[v]) > std::floor(high[v])) return;
    const auto flat = [&](const glm::dvec3& p) { return glm::dvec2(p[u], p[v]); };
    const glm::dvec2 a = flat(corners[0]);
    const glm::dvec2 b = flat(corners[1]);
    const glm::dvec2 c = flat(corners[2]);
    glm::ivec3 point{0};
    for (point[u] = first; point[u] <= last; ++point[u]) {
        // The part of the triangle at u.
        double from = high[v];
        double to = low[v];
        const auto add_edge = [&](const glm::dvec2& p, const glm::dvec2& q) {
            const double at = point[u];
            if ((p.x < at && q.x < at) || (p.x > at && q.x > at)) return;
            if (p.x == q.x) {
                from = std::min({from, p.y, q.y});
                to = std::max({to, p.y, q.y});
                return;
            }
            const double cross = p.y + (q.y - p.y) * ((at - p.x) / (q.x - p.x));
            from = std::min(from, cross);
            to = std::max(to, cross);
        };
        add_edge(a, b);
        add_edge(b, c);
        add_edge(c, a);
        constexpr double rounding = 1e-6;
        const auto end = static_cast<int>(std::floor(to + rounding));
        for (point[v] = static_cast<int>(std::ceil(from - rounding)); point[v] <= end; ++point[v]) {
            if (!covers(glm::dvec2(point[u], point[v]), a, b, c)) continue;
            const double at =
                std::clamp(corners[0][axis] - (triangle.normal[u] * (point[u] - corners[0][u]) +
                                               triangle.normal[v] * (point[v] - corners[0][v])) /
                                                  triangle.normal[axis],
                           low[axis], high[axis]);
            const double lower = std::floor(at);
            point[axis] = static_cast<int>(lower);
            add_hit(grid, point, axis, at - lower, index, found);
        }
    }
}

/// Calls visit(point) for the points within a distance of the box of a triangle.
template <typename Visit>
void visit_points(const GridTriangle& triangle, double distance, const Visit& visit) {
    const auto& c = triangle.corners;
    const glm::ivec3 first(glm::ceil(glm::min(c[0], glm::min(c[1], c[2])) - distance));
    const glm::ivec3 last(glm::floor(glm::max(c[0], glm::max(c[1], c[2])) + distance));
    // Columns along the axis that is nearest to the normal, within the distance from the plane.
    const glm::dvec3 size = glm::abs(triangle.normal);
    const int w = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    const int u = (w + 1) % 3;
    const int v = (w + 2) % 3;
    glm::ivec3 point(0);
    for (point[u] = first[u]; point[u] <= last[u]; ++point[u]) {
        for (point[v] = first[v]; point[v] <= last[v]; ++point[v]) {
            const double middle = c[0][w] - (triangle.normal[u] * (point[u] - c[0][u]) +
                                             triangle.normal[v] * (point[v] - c[0][v])) /
                                                triangle.normal[w];
            const double reach = distance / size[w] + 1e-6;
            const int from = std::max(first[w], static_cast<int>(std::ceil(middle - reach)));
            const int to = std::min(last[w], static_cast<int>(std::floor(middle + reach)));
            for (point[w] = from; point[w] <= to; ++point[w])
                visit(point);
        }
    }
}

double distance_at(const glm::dvec3& p, const GridTriangle& triangle) {
    return glm::length(p - nearest_point(p, triangle.corners).point);
}

void mark_near_points(RemeshGrid& grid) {
    parallel_for(grid.triangles().size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            const GridTriangle& triangle = grid.triangles()[t];
            visit_points(triangle, shell_distance, [&](const glm::ivec3& point) {
                const std::int32_t brick = grid.brick_at(point >> 3);
                if (brick == RemeshGrid::no_brick ||
                    distance_at(glm::dvec3(point), triangle) > shell_distance)
                    return;
                const glm::ivec3 in = point & 7;
                std::uint64_t& word = grid.bricks[static_cast<std::size_t>(brick)]
                                          .near[static_cast<std::size_t>(in.z)];
                std::atomic_ref(word).fetch_or(std::uint64_t{1} << (in.x + 8 * in.y),
                                               std::memory_order_relaxed);
            });
        }
    });
}

bool is_near(const RemeshGrid& grid, const glm::ivec3& point) {
    const std::int32_t brick = grid.brick_at(point >> 3);
    if (brick == RemeshGrid::no_brick) return false;
    const glm::ivec3 in = point & 7;
    return (grid.bricks[static_cast<std::size_t>(brick)].near[static_cast<std::size_t>(in.z)] >>
                (in.x + 8 * in.y) &
            1) != 0;
}

/// Returns where an edge leaves the neighborhood of a triangle, as a part of the edge: by regula
/// falsi, because the distance is nearly linear. The neighborhood is convex, so that there is one
/// place.
double end_of_surroundings(const GridTriangle& triangle, const glm::ivec3& point, int axis,
                           int side) {
    const auto excess_at = [&](double part) {
        glm::dvec3 p(point);
        p[axis] += side * part;
        return distance_at(p, triangle) - shell_distance;
    };
    double inside = 0.0;
    double outside = 1.0;
    double excess_inside = excess_at(inside);
    double excess_outside = excess_at(outside);
    constexpr int steps = 4;
    for (int i = 0; i < steps && excess_outside > 0.0; ++i) {
        const double middle =
            inside - (outside - inside) * excess_inside / (excess_outside - excess_inside);
        const double excess = excess_at(middle);
        (excess > 0.0 ? outside : inside) = middle;
        (excess > 0.0 ? excess_outside : excess_inside) = excess;
    }
    return inside;
}

/// Finds where the edges from points near a triangle to points that are not near any leave the
/// neighborhood of the triangle.
void leave_surroundings(const RemeshGrid& grid, std::uint32_t index, std::vector<FoundHit>& found) {
    const GridTriangle& triangle = grid.triangles()[index];
    visit_points(triangle, shell_distance, [&](const glm::ivec3& point) {
        if (distance_at(glm::dvec3(point), triangle) > shell_distance) return;
        for (int axis = 0; axis < 3; ++axis) {
            for (const int side : {-1, 1}) {
                glm::ivec3 other = point;
                other[axis] += side;
                if (is_near(grid, other)) continue;
                const double end = end_of_surroundings(triangle, point, axis, side);
                const bool is_lower = side > 0;
                add_hit(grid, is_lower ? point : other, axis, is_lower ? end : 1.0 - end, index,
                        found);
            }
        }
    });
}

/// Compares the shapes of two triangles, then their materials.
bool triangle_precedes(const GridTriangle& a, const GridTriangle& b) {
    for (std::size_t k = 0; k < 3; ++k) {
        if (a.corners[k] != b.corners[k]) return comes_before(a.corners[k], b.corners[k]);
    }
    return a.range < b.range;
}

/// Sorts the hits of each brick, and keeps the first and the last one of each edge.
void store_hits(RemeshGrid& grid, const std::vector<std::vector<FoundHit>>& found) {
    std::vector<std::size_t> begin(grid.bricks.size() + 1, 0);
    for (const auto& piece : found) {
        for (const FoundHit& hit : piece)
            ++begin[hit.brick + 1];
    }
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<FoundHit> sorted(begin.back());
    std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
    for (const auto& piece : found) {
        for (const FoundHit& hit : piece)
            sorted[next[hit.brick]++] = hit;
    }
    std::vector<EdgeHits> hits(sorted.size());
    std::vector<std::uint32_t> counts(grid.bricks.size(), 0);
    parallel_for(grid.bricks.size(), 64, [&](std::size_t first, std::size_t last) {
        for (std::size_t b = first; b < last; ++b) {
            const auto from = sorted.begin() + static_cast<std::ptrdiff_t>(begin[b]);
            const auto to = sorted.begin() + static_cast<std::ptrdiff_t>(begin[b + 1]);
            std::sort(from, to, [&](const FoundHit& x, const FoundHit& y) {
                if (x.edge != y.edge) return x.edge < y.edge;
                if (x.at != y.at) return x.at < y.at;
                return triangle_precedes(grid.triangles()[x.triangle],
                                         grid.triangles()[y.triangle]);
            });
            std::size_t place = begin[b];
            for (auto hit = from; hit != to;) {
                const Hit here{hit->at, hit->triangle};
                EdgeHits& edge = hits[place++];
                edge = {here, here};
                const std::uint16_t number = hit->edge;
                grid.bricks[b].crossed[number / 512][number / 64 % 8] |= std::uint64_t{1}
                                                                         << number % 64;
                // The first triangle counts among hits at the last place.
                for (++hit; hit != to && hit->edge == number; ++hit) {
                    if (hit->at != edge.last.at) edge.last = {hit->at, hit->triangle};
                }
            }
            counts[b] = static_cast<std::uint32_t>(place - begin[b]);
        }
    });
    for (std::size_t b = 0; b < grid.bricks.size(); ++b) {
        grid.bricks[b].first_hit = static_cast<std::uint32_t>(grid.edge_hits.size());
        const auto from = hits.begin() + static_cast<std::ptrdiff_t>(begin[b]);
        grid.edge_hits.insert(grid.edge_hits.end(), from, from + counts[b]);
    }
}

}  // namespace

void find_hits(RemeshGrid& grid, bool shell) {
    if (shell) mark_near_points(grid);
    constexpr std::size_t piece_size = 2048;
    const std::size_t count = grid.triangles().size();
    std::vector<std::vector<FoundHit>> found((count + piece_size - 1) / piece_size);
    parallel_for(found.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t piece = begin; piece < end; ++piece) {
            const std::size_t last = std::min(count, (piece + 1) * piece_size);
            for (std::size_t t = piece * piece_size; t < last; ++t) {
                const auto index = static_cast<std::uint32_t>(t);
                if (shell) {
                    leave_surroundings(grid, index, found[piece]);
                    continue;
                }
                for (int axis = 0; axis < 3; ++axis)
                    cross_lines(grid, index, axis, found[piece]);
            }
        }
    });
    check_cancelled();
    store_hits(grid, found);
}

}  // namespace relief::detail
