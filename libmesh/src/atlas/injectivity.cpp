// SPDX-License-Identifier: Apache-2.0
#include "atlas/injectivity.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "progress_stage.h"

namespace relief::detail {
namespace {

/// An edge of the border between two vertices of the chart.
struct BorderEdge {
    Corner corner;
    std::uint32_t from, to;
};

bool is_between(int x, int a, int b) {
    return std::min(a, b) <= x && x <= std::max(a, b);
}

bool is_on(const LatticePoint& p, const LatticePoint& a, const LatticePoint& b) {
    return is_between(p.x, a.x, b.x) && is_between(p.y, a.y, b.y);
}

/// True if two segments have a point in common.
bool touch(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c,
           const LatticePoint& d) {
    const auto sign = [](std::int64_t x) { return (x > 0) - (x < 0); };
    const int c_side = sign(orientation(a, b, c));
    const int d_side = sign(orientation(a, b, d));
    const int a_side = sign(orientation(c, d, a));
    const int b_side = sign(orientation(c, d, b));
    if (c_side * d_side < 0 && a_side * b_side < 0) return true;
    return (c_side == 0 && is_on(c, a, b)) || (d_side == 0 && is_on(d, a, b)) ||
           (a_side == 0 && is_on(a, c, d)) || (b_side == 0 && is_on(b, c, d));
}

/// True if two edges that begin at `m` run along each other.
bool coincide(const LatticePoint& m, const LatticePoint& a, const LatticePoint& b) {
    if (orientation(m, a, b) != 0) return false;
    return std::int64_t{a.x - m.x} * (b.x - m.x) + std::int64_t{a.y - m.y} * (b.y - m.y) > 0;
}

/// True if two edges of the border meet elsewhere than at a common vertex.
bool meet(const BorderEdge& e, const BorderEdge& f, std::span<const LatticePoint> points) {
    // The two sides of a cut that did not open.
    if (e.from == f.to && e.to == f.from) return false;
    if (e.from == f.from && e.to == f.to) return true;
    if (e.to == f.from) return coincide(points[e.to], points[e.from], points[f.to]);
    if (e.from == f.to) return coincide(points[e.from], points[e.to], points[f.from]);
    if (e.from == f.from) return coincide(points[e.from], points[e.to], points[f.to]);
    if (e.to == f.to) return coincide(points[e.to], points[e.from], points[f.from]);
    return touch(points[e.from], points[e.to], points[f.from], points[f.to]);
}

/// The edges of the border in square cells; an edge is in all cells that it touches.
class EdgeGrid {
  public:
    EdgeGrid(std::span<const BorderEdge> edges, std::span<const LatticePoint> points) {
        LatticePoint low(std::numeric_limits<int>::max());
        LatticePoint high(0);
        for (const BorderEdge& edge : edges) {
            low = glm::min(low, glm::min(points[edge.from], points[edge.to]));
            high = glm::max(high, glm::max(points[edge.from], points[edge.to]));
        }
        const int wanted =
            std::clamp(static_cast<int>(std::sqrt(static_cast<double>(edges.size()))), 1, 2048);
        low_ = low;
        cell_ = std::max(high.x - low.x, high.y - low.y) / wanted + 1;
        columns_ = (high.x - low.x) / cell_ + 1;
        const int rows = (high.y - low.y) / cell_ + 1;
        begin_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows) + 1, 0);
        for (const BorderEdge& edge : edges)
            for_each_cell(points[edge.from], points[edge.to],
                          [&](std::size_t cell) { ++begin_[cell + 1]; });
        std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
        members_.resize(begin_.back());
        std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
        for (std::uint32_t i = 0; i < edges.size(); ++i)
            for_each_cell(points[edges[i].from], points[edges[i].to],
                          [&](std::size_t cell) { members_[next[cell]++] = i; });
    }

    [[nodiscard]] std::size_t cell_count() const { return begin_.size() - 1; }
    [[nodiscard]] std::span<const std::uint32_t> members(std::size_t cell) const {
        return std::span(members_).subspan(begin_[cell], begin_[cell + 1] - begin_[cell]);
    }

  private:
    template <typename Visit>
    void for_each_cell(const LatticePoint& from, const LatticePoint& to, const Visit& visit) const {
        const LatticePoint a = (from.y < to.y ? from : to) - low_;
        const LatticePoint b = (from.y < to.y ? to : from) - low_;
        const double slope = b.y > a.y ? static_cast<double>(b.x - a.x) / (b.y - a.y) : 0.0;
        for (int row = a.y / cell_; row <= b.y / cell_; ++row) {
            // The part of the edge in this row, one unit wider than it is.
            const auto x_at = [&](std::int64_t y) {
                if (y <= a.y) return static_cast<double>(a.x);
                if (y >= b.y) return static_cast<double>(b.x);
                return a.x + slope * static_cast<double>(y - a.y);
            };
            const double x0 = x_at(std::int64_t{row} * cell_);
            const double x1 = x_at((std::int64_t{row} + 1) * cell_);
            const bool is_flat = a.y == b.y;
            const double low = is_flat ? std::min(a.x, b.x) : std::min(x0, x1);
            const double high = is_flat ? std::max(a.x, b.x) : std::max(x0, x1);
            const int first = std::max(static_cast<int>(low) - 1, 0) / cell_;
            const int last = std::min((static_cast<int>(high) + 1) / cell_, columns_ - 1);
            for (int column = first; column <= last; ++column)
                visit(static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                      static_cast<std::size_t>(column));
        }
    }

    LatticePoint low_{0};
    int cell_ = 1;
    int columns_ = 1;
    std::vector<std::uint32_t> begin_;
    std::vector<std::uint32_t> members_;
};

std::vector<BorderEdge> border_of(const ChartMesh& chart) {
    std::vector<BorderEdge> edges;
    for (Corner corner = 0; corner < chart.opposite.size(); ++corner) {
        if (chart.opposite[corner] != no_corner) continue;
        const glm::uvec3& v = chart.vertices[corner / 3];
        edges.push_back({corner, v[static_cast<glm::length_t>(corner % 3)],
                         v[static_cast<glm::length_t>((corner + 1) % 3)]});
    }
    return edges;
}

/// Returns the edge of the border that continues at the end of another one.
Corner next_on_border(const ChartMesh& chart, Corner corner) {
    Corner at = next_in_triangle(corner);
    while (chart.opposite[at] != no_corner)
        at = next_in_triangle(chart.opposite[at]);
    return at;
}

/// The number of border loops with a positive area.
std::size_t positive_loops(const ChartMesh& chart, std::span<const BorderEdge> border,
                           std::span<const LatticePoint> points) {
    std::vector<bool> is_visited(chart.opposite.size(), false);
    const auto point = [&](Corner corner) {
        return points[chart.vertices[corner / 3][static_cast<glm::length_t>(corner % 3)]];
    };
    std::size_t count = 0;
    for (const BorderEdge& edge : border) {
        if (is_visited[edge.corner]) continue;
        const LatticePoint origin = points[edge.from];
        // Modulo 2^64: intermediate sums may overflow, but the area does not.
        std::uint64_t twice_area = 0;
        Corner at = edge.corner;
        do {
            is_visited[at] = true;
            const Corner next = next_on_border(chart, at);
            twice_area += static_cast<std::uint64_t>(orientation(origin, point(at), point(next)));
            at = next;
        } while (at != edge.corner);
        if (static_cast<std::int64_t>(twice_area) > 0) ++count;
    }
    return count;
}

}  // namespace

std::optional<std::uint32_t> overlap_in(const ChartMesh& chart,
                                        std::span<const LatticePoint> points) {
    for (std::uint32_t i = 0; i < chart.faces.size(); ++i) {
        const glm::uvec3& v = chart.vertices[i];
        if (orientation(points[v.x], points[v.y], points[v.z]) <= 0) return i;
    }
    // Two positive triangles with a common edge are on different sides of it.
    if (chart.faces.size() == 1 || is_pair(chart)) return std::nullopt;
    const std::vector<BorderEdge> border = border_of(chart);
    if (border.empty()) return 0;  // A closed surface.
    const EdgeGrid grid(border, points);
    for (std::size_t cell = 0; cell < grid.cell_count(); ++cell) {
        const std::span<const std::uint32_t> members = grid.members(cell);
        for (std::size_t i = 0; i < members.size(); ++i) {
            check_cancelled(i + 1);
            for (std::size_t j = i + 1; j < members.size(); ++j) {
                if (meet(border[members[i]], border[members[j]], points))
                    return border[members[i]].corner / 3;
            }
        }
    }
    if (positive_loops(chart, border, points) != 1) return 0;
    return std::nullopt;
}

}  // namespace relief::detail
