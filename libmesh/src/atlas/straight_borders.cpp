// SPDX-License-Identifier: Apache-2.0
// A border between two charts is a chain of edges between two places where it ends: where a third
// chart begins, or where the surface ends. Each chain is replaced by the best path near it. Its
// ends may slide along the borders that it meets, so that chains meet at wide angles.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <queue>
#include <utility>

#include "atlas/charts.h"
#include "progress_stage.h"

namespace relief::detail {
namespace {

/// A path may be this share of the diameter of the smaller chart away from the chain, and this
/// number of edges.
constexpr double max_shift = 0.3;
constexpr int max_shift_edges = 12;
/// The largest share of a chart that one path may give to its neighbor.
constexpr double max_moved = 0.3;
/// Borders run along creases: their edges count less by this share.
constexpr double crease_bonus = 0.5;
/// Cosines of the angles between the normals where a crease begins, and where it is sharp.
constexpr double smooth_cosine = 0.9;
constexpr double sharp_cosine = 0.6;
/// The cost of a right angle in the path, in lengths of its edges.
constexpr double turn_cost = 0.25;
/// Paths that are cheaper by less than this share change nothing.
constexpr double min_gain = 1e-6;
constexpr int passes = 3;

using Chain = std::vector<Corner>;  ///< Edges of one chart, each beginning where the last one ends.

class BorderStraightener {
  public:
    BorderStraightener(const AtlasSurface& surface, Segmentation& segmentation,
                       std::span<const std::uint32_t> group)
        : surface_(surface),
          segmentation_(segmentation),
          group_(group),
          chart_(segmentation.chart),
          face_counts_(segmentation.count, 0),
          corner_at_(surface.positions.size(), no_corner),
          valence_(surface.positions.size(), 0),
          visits_(surface.positions.size()),
          is_cut_(surface.opposite.size(), 0) {
        for (const std::uint32_t each : chart_)
            ++face_counts_[each];
        for (Corner corner = 0; corner < surface.opposite.size(); ++corner) {
            corner_at_[vertex_of(corner)] = corner;
            ++valence_[vertex_of(corner)];
        }
    }

    void straighten() {
        for (int pass = 0; pass < passes; ++pass) {
            bool is_changed = false;
            for (const Corner seed : seeds()) {
                check_cancelled();
                // An earlier path may have moved the border away.
                if (!is_forward_border(seed)) continue;
                is_changed = straighten_at(seed, pass) || is_changed;
            }
            if (!is_changed) return;
        }
    }

  private:
    struct Visit {
        std::uint32_t search = 0;  ///< The search that reached the vertex last.
        std::uint32_t chain = 0;   ///< The search whose chain has the vertex.
        std::uint32_t target = 0;  ///< The search that may end here.
        std::uint32_t band = 0;    ///< The search whose band has the vertex.
        Corner edge = no_corner;   ///< By which the vertex was reached; none for a start.
        double cost = 0.0;
    };

    [[nodiscard]] std::uint32_t vertex_of(Corner corner) const {
        return surface_.faces[corner / 3][static_cast<glm::length_t>(corner % 3)];
    }
    [[nodiscard]] std::uint32_t end_of(Corner edge) const {
        return vertex_of(next_in_triangle(edge));
    }
    [[nodiscard]] bool is_joined(Corner edge) const {
        return surface_.opposite[edge] != no_corner && !surface_.is_border[edge];
    }
    [[nodiscard]] std::uint32_t chart_at(Corner corner) const { return chart_[corner / 3]; }
    /// The chart on the other side of an edge that is joined.
    [[nodiscard]] std::uint32_t chart_across(Corner edge) const {
        return chart_[surface_.opposite[edge] / 3];
    }
    /// True for one of the two sides of a border that may move.
    [[nodiscard]] bool is_forward_border(Corner edge) const {
        return is_joined(edge) && chart_at(edge) < chart_across(edge) &&
               group_[chart_at(edge)] == group_[chart_across(edge)] &&
               group_[chart_at(edge)] != no_face;
    }

    /// True if a border passes through the vertex where an edge begins, and nothing else.
    [[nodiscard]] bool is_inner(std::uint32_t vertex) const { return borders_at(vertex) == 2; }

    /// The number of borders between charts that meet at a vertex; or -1 if the surface ends there.
    [[nodiscard]] int borders_at(std::uint32_t vertex) const {
        const Corner first = corner_at_[vertex];
        Corner at = first;
        std::uint32_t count = 0;
        int borders = 0;
        do {
            const Corner edge = previous_in_triangle(at);
            if (!is_joined(edge)) return -1;
            const Corner next = surface_.opposite[edge];
            borders += chart_at(at) != chart_at(next) ? 1 : 0;
            at = next;
            ++count;
        } while (at != first);
        return count == valence_[vertex] ? borders : -1;
    }

    /// The next edge of a border, on the same side.
    [[nodiscard]] Corner next_on_border(Corner edge) const {
        Corner at = next_in_triangle(edge);
        while (is_joined(at) && chart_across(at) == chart_at(edge))
            at = next_in_triangle(surface_.opposite[at]);
        return at;
    }
    [[nodiscard]] Corner previous_on_border(Corner edge) const {
        Corner at = previous_in_triangle(edge);
        while (is_joined(at) && chart_across(at) == chart_at(edge))
            at = previous_in_triangle(surface_.opposite[at]);
        return at;
    }

    /// Returns the chain through an edge of a border. \return and whether it is closed
    [[nodiscard]] std::pair<Chain, bool> chain_at(Corner seed) const {
        Chain back;
        Corner at = seed;
        while (is_inner(vertex_of(at))) {
            at = previous_on_border(at);
            if (at == seed) break;
            back.push_back(at);
        }
        const bool is_closed = at == seed && !back.empty();
        Chain chain(back.rbegin(), back.rend());
        chain.push_back(seed);
        if (is_closed) return {chain, true};
        at = seed;
        while (is_inner(end_of(at))) {
            at = next_on_border(at);
            chain.push_back(at);
        }
        return {chain, false};
    }

    /// Returns an edge in the middle of each chain.
    [[nodiscard]] std::vector<Corner> seeds() const {
        std::vector<Corner> result;
        std::vector<bool> is_visited(surface_.opposite.size(), false);
        for (Corner corner = 0; corner < surface_.opposite.size(); ++corner) {
            if (!is_forward_border(corner) || is_visited[corner]) continue;
            const auto [chain, is_closed] = chain_at(corner);
            for (const Corner edge : chain)
                is_visited[edge] = true;
            result.push_back(is_closed ? corner : chain[chain.size() / 2]);
        }
        return result;
    }

    bool straighten_at(Corner seed, int pass) {
        auto [chain, is_closed] = chain_at(seed);
        if (!is_closed) return straighten(chain, true);
        if (chain.size() < 4) return false;
        // Two halves, which meet at other places in each pass.
        const auto size = static_cast<std::ptrdiff_t>(chain.size());
        std::rotate(chain.begin(), chain.begin() + pass * size / (2 * passes), chain.end());
        const auto middle = chain.begin() + size / 2;
        const bool is_first_changed = straighten(Chain(chain.begin(), middle), false);
        return straighten(Chain(middle, chain.end()), false) || is_first_changed;
    }

    /// The cost of an edge.
    [[nodiscard]] double cost_of(Corner edge) const {
        const double cosine =
            static_cast<double>(glm::dot(segmentation_.smooth_normal(edge / 3),
                                         segmentation_.smooth_normal(surface_.opposite[edge] / 3)));
        const double crease =
            std::clamp((smooth_cosine - cosine) / (smooth_cosine - sharp_cosine), 0.0, 1.0);
        return surface_.edge_length(edge) * (1.0 - crease_bonus * crease);
    }
    /// The cost of the turn between two edges.
    [[nodiscard]] double turn_between(Corner first, Corner second) const {
        const auto along = [&](Corner edge) {
            return surface_.position(next_in_triangle(edge)) - surface_.position(edge);
        };
        const glm::dvec3 a = along(first);
        const glm::dvec3 b = along(second);
        const double product = std::sqrt(glm::dot(a, a) * glm::dot(b, b));
        if (!(product > 0.0)) return 0.0;
        return turn_cost * std::sqrt(product) * (1.0 - glm::dot(a, b) / product);
    }
    [[nodiscard]] double cost_of(const Chain& chain) const {
        double cost = 0.0;
        for (std::size_t i = 0; i < chain.size(); ++i)
            cost += cost_of(chain[i]) + (i > 0 ? turn_between(chain[i - 1], chain[i]) : 0.0);
        return cost;
    }

    /// Edges along which an end of a chain may slide, from its end on.
    /// \param edge  the first one, of the chart on one side; the chart is on its left
    template <typename Next>
    Chain slide(Corner edge, int steps, const Next& next, bool is_ahead) const {
        Chain edges;
        const auto across = [&](Corner each) {
            return is_joined(each) ? chart_across(each) : no_face;
        };
        const std::uint32_t other = across(edge);
        for (Corner at = edge; static_cast<int>(edges.size()) < steps; at = next(at)) {
            if (across(at) != other) break;
            const std::uint32_t vertex = is_ahead ? end_of(at) : vertex_of(at);
            // Another chain ends here: they share the border between them.
            const bool is_end = other == no_face ? visits_[vertex].chain == search_ ||
                                                       !is_plain_rim(vertex, at, is_ahead)
                                                 : !is_inner(vertex);
            if (is_end) {
                edges.resize(edges.size() / 3);
                return edges;
            }
            edges.push_back(at);
        }
        edges.resize(std::min<std::size_t>(edges.size(), static_cast<std::size_t>(steps) / 2));
        return edges;
    }

    /// True if a vertex at the end of the surface has faces of one chart only.
    [[nodiscard]] bool is_plain_rim(std::uint32_t vertex, Corner edge, bool is_ahead) const {
        Corner at = is_ahead ? next_in_triangle(edge) : edge;
        std::uint32_t count = 0;
        if (is_ahead) {
            for (;; at = next_in_triangle(surface_.opposite[at])) {
                ++count;
                if (!is_joined(at)) break;
                if (chart_across(at) != chart_at(edge)) return false;
            }
        } else {
            for (;; at = surface_.opposite[previous_in_triangle(at)]) {
                ++count;
                const Corner edge_before = previous_in_triangle(at);
                if (!is_joined(edge_before)) break;
                if (chart_across(edge_before) != chart_at(edge)) return false;
            }
        }
        return count == valence_[vertex];
    }

    [[nodiscard]] bool is_of(std::uint32_t chart) const {
        return chart == left_ || chart == right_;
    }

    /// True if a path may pass through a vertex: it is inside of both charts, and no other border
    /// passes through it.
    [[nodiscard]] bool is_free(std::uint32_t vertex) const {
        const Corner first = corner_at_[vertex];
        Corner at = first;
        std::uint32_t count = 0;
        bool is_mixed = false;
        do {
            const Corner edge = previous_in_triangle(at);
            if (!is_of(chart_at(at)) || !is_joined(edge)) return false;
            const Corner next = surface_.opposite[edge];
            is_mixed = is_mixed || chart_at(at) != chart_at(next);
            at = next;
            ++count;
        } while (at != first);
        return count == valence_[vertex] && (!is_mixed || visits_[vertex].chain == search_);
    }

    /// Calls visit(edge) for the edges from a vertex into both charts. \param corner at the vertex
    template <typename Visit>
    void for_each_edge(Corner corner, const Visit& visit) const {
        const auto can_cross = [&](Corner edge) {
            return is_joined(edge) && is_of(chart_across(edge));
        };
        Corner first = corner;
        while (can_cross(first)) {
            first = next_in_triangle(surface_.opposite[first]);
            if (first == corner) break;
        }
        Corner at = first;
        do {
            if (can_cross(at)) visit(at);
            const Corner edge = previous_in_triangle(at);
            if (!can_cross(edge)) return;
            at = surface_.opposite[edge];
        } while (at != first);
    }

    /// Marks the free vertices within some edges of the chain.
    void mark_band(const Chain& chain, int width) {
        front_.clear();
        const auto add = [&](std::uint32_t vertex) {
            if (visits_[vertex].band == search_ || !is_free(vertex)) return;
            visits_[vertex].band = search_;
            front_.push_back(vertex);
        };
        for (const Corner edge : chain) {
            visits_[vertex_of(edge)].chain = search_;
            visits_[end_of(edge)].chain = search_;
        }
        for (std::size_t i = 1; i < chain.size(); ++i)
            add(vertex_of(chain[i]));
        // The ends are not free, but what is around them may be.
        for (const Corner end : {chain.front(), surface_.opposite[chain.back()]})
            for_each_edge(end, [&](Corner edge) { add(end_of(edge)); });
        std::size_t done = 0;
        for (int step = 0; step < width && done < front_.size(); ++step) {
            const std::size_t last = front_.size();
            for (; done < last; ++done)
                for_each_edge(corner_at_[front_[done]], [&](Corner edge) { add(end_of(edge)); });
        }
    }

    /// Returns the cheapest path from one of the starts to a vertex that is marked as a target.
    Chain cheapest_path(const std::vector<Corner>& starts, double max_cost) {
        using Entry = std::pair<double, std::uint32_t>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
        const auto extend = [&](Corner corner, double cost, Corner before) {
            for_each_edge(corner, [&](Corner edge) {
                const std::uint32_t vertex = end_of(edge);
                Visit& visit = visits_[vertex];
                if (visit.band != search_ && visit.target != search_) return;
                const double next =
                    cost + cost_of(edge) + (before != no_corner ? turn_between(before, edge) : 0.0);
                if (next >= max_cost || (visit.search == search_ && visit.cost <= next)) return;
                visit.search = search_;
                visit.cost = next;
                visit.edge = edge;
                queue.emplace(next, vertex);
            });
        };
        for (const Corner start : starts) {
            Visit& visit = visits_[vertex_of(start)];
            visit.search = search_;
            visit.cost = 0.0;
            visit.edge = no_corner;
        }
        for (const Corner start : starts)
            extend(start, 0.0, no_corner);
        while (!queue.empty()) {
            const auto [cost, vertex] = queue.top();
            queue.pop();
            const Visit& visit = visits_[vertex];
            if (cost > visit.cost) continue;
            if (visit.target == search_) {
                Chain path;
                for (Corner edge = visit.edge; edge != no_corner;
                     edge = visits_[vertex_of(edge)].edge)
                    path.push_back(edge);
                std::reverse(path.begin(), path.end());
                return path;
            }
            extend(corner_at_[vertex], cost, visit.edge);
        }
        return {};
    }

    /// Replaces a chain by a better path. \return whether there is one
    bool straighten(const Chain& chain, bool may_slide) {
        ++search_;
        left_ = chart_at(chain.front());
        right_ = chart_across(chain.front());
        const auto smaller =
            static_cast<double>(std::min(face_counts_[left_], face_counts_[right_]));
        const int width =
            std::min(static_cast<int>(max_shift * std::sqrt(smaller)), max_shift_edges);
        if (width < 1) return false;
        mark_band(chain, width);
        std::vector<Corner> starts{chain.front()};
        std::vector<Corner> targets{surface_.opposite[chain.back()]};
        if (vertex_of(starts[0]) == vertex_of(targets[0])) return false;
        if (may_slide) add_slides(chain, width, starts, targets);
        for (const Corner target : targets)
            visits_[vertex_of(target)].target = search_;
        for (const Corner start : starts)
            if (visits_[vertex_of(start)].target == search_) return false;
        const double cost = (1.0 - min_gain) * cost_of(chain);
        const Chain path = cheapest_path(starts, cost);
        return !path.empty() && adopt(path);
    }

    /// Adds corners at the vertices to which the ends of a chain may slide.
    void add_slides(const Chain& chain, int width, std::vector<Corner>& starts,
                    std::vector<Corner>& targets) const {
        const auto next = [&](Corner edge) { return next_on_border(edge); };
        const auto previous = [&](Corner edge) { return previous_on_border(edge); };
        const Corner first = chain.front();
        const Corner last = chain.back();
        // The chart on the left is left of its border, which arrives at the start of the chain.
        for (const Corner edge : slide(previous_on_border(first), width, previous, false))
            starts.push_back(edge);
        for (const Corner edge : slide(next_on_border(surface_.opposite[first]), width, next, true))
            starts.push_back(next_in_triangle(edge));
        for (const Corner edge : slide(next_on_border(last), width, next, true))
            targets.push_back(next_in_triangle(edge));
        for (const Corner edge :
             slide(previous_on_border(surface_.opposite[last]), width, previous, false))
            targets.push_back(edge);
    }

    /// Gives the faces between the chain and the path to the other chart.
    bool adopt(const Chain& path) {
        for (const Corner edge : path)
            is_cut_[edge] = is_cut_[surface_.opposite[edge]] = 1;
        std::vector<std::uint32_t> to_left;
        std::vector<std::uint32_t> to_right;
        const bool is_possible = collect(path, right_, to_left) && collect(path, left_, to_right);
        for (const Corner edge : path)
            is_cut_[edge] = is_cut_[surface_.opposite[edge]] = 0;
        for (const std::uint32_t face : to_left)
            chart_[face] = is_possible ? left_ : right_;
        for (const std::uint32_t face : to_right)
            chart_[face] = is_possible ? right_ : left_;
        if (!is_possible) return false;
        const auto moved = static_cast<std::uint32_t>(to_left.size() - to_right.size());
        face_counts_[left_] += moved;  // Modulo 2^32.
        face_counts_[right_] -= moved;
        return true;
    }

    /// Collects the faces of a chart that the path separates from it, and marks them with no_face.
    /// \return false if they are too many
    bool collect(const Chain& path, std::uint32_t chart, std::vector<std::uint32_t>& faces) {
        const auto limit =
            static_cast<std::size_t>(max_moved * static_cast<double>(face_counts_[chart]));
        const auto add = [&](std::uint32_t face) {
            if (chart_[face] != chart) return;
            chart_[face] = no_face;
            faces.push_back(face);
        };
        for (const Corner edge : path)
            add(chart == right_ ? edge / 3 : surface_.opposite[edge] / 3);
        for (std::size_t i = 0; i < faces.size(); ++i) {
            if (faces.size() > limit) return false;
            for (Corner edge = 3 * faces[i]; edge < 3 * faces[i] + 3; ++edge)
                if (is_joined(edge) && is_cut_[edge] == 0) add(surface_.opposite[edge] / 3);
        }
        return true;
    }

    const AtlasSurface& surface_;
    const Segmentation& segmentation_;
    std::span<const std::uint32_t> group_;
    std::vector<std::uint32_t>& chart_;
    std::vector<std::uint32_t> face_counts_;
    std::vector<Corner> corner_at_;       ///< For each vertex, one of its corners.
    std::vector<std::uint32_t> valence_;  ///< For each vertex, the number of its corners.
    std::vector<Visit> visits_;           ///< For each vertex.
    std::vector<std::uint8_t> is_cut_;    ///< For each edge, whether the path runs along it.
    std::vector<std::uint32_t> front_;
    std::uint32_t search_ = 0;
    std::uint32_t left_ = 0, right_ = 0;  ///< The charts of the chain.
};

}  // namespace

void replace_borders(const AtlasSurface& surface, Segmentation& segmentation,
                     std::span<const std::uint32_t> group) {
    if (segmentation.count > 1) BorderStraightener(surface, segmentation, group).straighten();
}

}  // namespace relief::detail
