// SPDX-License-Identifier: Apache-2.0
// Builds a manifold from triangles: selects the valid triangles, links neighbors, and numbers the
// vertices. If cutting edges leaves two edges between the same two vertices (sheets that meet in a
// ring around both), the triangles at the later edges are cut off completely, and the vertices are
// numbered again.
#include <algorithm>
#include <tuple>

#include "geometry/direction.h"
#include "progress_stage.h"
#include "topology/topology.h"

namespace relief::detail {
namespace {

/// An edge of a triangle, relative to the edge's smaller vertex.
struct EdgeUse {
    std::uint32_t other_vertex;  ///< Larger vertex of the edge.
    bool arrives;                ///< True if the triangle runs towards the smaller vertex.
    Corner corner;               ///< Corner at which the triangle's edge begins.

    friend bool operator<(const EdgeUse& a, const EdgeUse& b) {
        return std::tuple(a.other_vertex, a.arrives, a.corner) <
               std::tuple(b.other_vertex, b.arrives, b.corner);
    }
};

/// Calls visit(uses) for the sorted uses of every edge.
template <typename Visit>
void for_each_edge(std::size_t vertex_count, std::span<const glm::uvec3> triangles,
                   const Visit& visit) {
    const CornersByVertex corners(vertex_count, triangles);
    std::vector<EdgeUse> uses;
    for (std::uint32_t v = 0; v < vertex_count; ++v) {
        check_cancelled(v);
        uses.clear();
        for (const Corner corner : corners.at(v)) {
            const Corner previous = previous_in_triangle(corner);
            const std::uint32_t next_vertex = vertex_of(next_in_triangle(corner), triangles);
            const std::uint32_t previous_vertex = vertex_of(previous, triangles);
            if (next_vertex > v) uses.push_back({next_vertex, false, corner});
            if (previous_vertex > v) uses.push_back({previous_vertex, true, previous});
        }
        std::sort(uses.begin(), uses.end());
        for (auto first = uses.begin(); first != uses.end();) {
            const auto last = std::find_if(first, uses.end(), [&](const EdgeUse& use) {
                return use.other_vertex != first->other_vertex;
            });
            visit(std::span<const EdgeUse>(first, last));
            first = last;
        }
    }
}

class TopologyMaker {
  public:
    TopologyMaker(const Mesh& mesh, std::span<const std::uint32_t> classes,
                  std::span<const Corner> order, Report& report)
        : mesh_(mesh), classes_(classes), order_(order), report_(report) {}

    Topology make();

  private:
    void choose_triangles();
    void find_neighbors();
    void find_vertices();
    void give_vertex(Corner first);
    bool cut_off_double_edges();
    void mark_cut();

    const Mesh& mesh_;
    std::span<const std::uint32_t> classes_;
    std::span<const Corner> order_;
    Report& report_;
    Topology result_;
    /// Triangles of the result with the indices of position classes.
    std::vector<glm::uvec3> welded_;
    std::vector<bool> is_cut_class_;  ///< One per position class.
    bool has_non_manifold_edges_ = false;
};

void TopologyMaker::choose_triangles() {
    welded_.reserve(mesh_.triangles.size());
    result_.source_triangle.reserve(mesh_.triangles.size());
    const std::size_t count = order_.empty() ? mesh_.triangles.size() : order_.size();
    for (std::uint32_t i = 0; i < count; ++i) {
        check_cancelled(i);
        const Corner first = order_.empty() ? 3 * i : order_[i];
        const std::uint32_t t = triangle_of(first);
        const glm::uvec3 triangle = triangle_from(first, mesh_.triangles);
        const glm::uvec3 welded{classes_[triangle.x], classes_[triangle.y], classes_[triangle.z]};
        if (welded.x == welded.y || welded.y == welded.z || welded.z == welded.x) {
            report_.add("collapsed triangle", "triangle", t, "is left out: it has no area");
            continue;
        }
        const bool finite = is_finite(mesh_.positions[triangle.x]) &&
                            is_finite(mesh_.positions[triangle.y]) &&
                            is_finite(mesh_.positions[triangle.z]);
        if (!finite) {
            report_.add("triangle with a non-finite position", "triangle", t, "is kept as it is");
            result_.set_aside.push_back(t);
            continue;
        }
        welded_.push_back(welded);
        result_.source_triangle.push_back(t);
    }
}

void TopologyMaker::find_neighbors() {
    result_.opposite.assign(3 * welded_.size(), no_corner);
    is_cut_class_.assign(mesh_.positions.size(), false);
    for_each_edge(mesh_.positions.size(), welded_, [&](std::span<const EdgeUse> uses) {
        if (uses.size() == 1) return;
        if (uses.size() == 2 && uses[0].arrives != uses[1].arrives) {
            result_.opposite[uses[0].corner] = uses[1].corner;
            result_.opposite[uses[1].corner] = uses[0].corner;
            return;
        }
        has_non_manifold_edges_ = true;
        const Corner corner = uses[0].corner;
        report_.add("non-manifold edge", "edge of triangle",
                    result_.source_triangle[triangle_of(corner)],
                    "is an edge of each of its triangles by itself; its ends stay together");
        is_cut_class_[vertex_of(corner, welded_)] = true;
        is_cut_class_[vertex_of(next_in_triangle(corner), welded_)] = true;
    });
}

/// Creates a vertex for all corners that are connected to this one across edges at its position.
void TopologyMaker::give_vertex(Corner first) {
    // Walks back to the beginning of the fan, or once around.
    Corner start = first;
    for (;;) {
        const Corner before = result_.opposite[previous_in_triangle(start)];
        if (before == no_corner || before == first) break;
        start = before;
    }
    const auto vertex = static_cast<std::uint32_t>(result_.position_vertex.size());
    result_.position_vertex.push_back(vertex_of(first, welded_));
    for (Corner corner = start;;) {
        result_.triangles[triangle_of(corner)][static_cast<int>(corner % 3)] = vertex;
        const Corner beyond = result_.opposite[corner];
        if (beyond == no_corner) break;
        corner = next_in_triangle(beyond);
        if (corner == start) break;
    }
}

void TopologyMaker::find_vertices() {
    result_.position_vertex.clear();
    result_.position_vertex.reserve(mesh_.positions.size());
    result_.triangles.assign(welded_.size(), glm::uvec3(no_corner));
    for (Corner corner = 0; corner < 3 * welded_.size(); ++corner) {
        check_cancelled(corner);
        if (vertex_of(corner, result_.triangles) == no_corner) give_vertex(corner);
    }
}

/// \return true if there were any
bool TopologyMaker::cut_off_double_edges() {
    if (!has_non_manifold_edges_) return false;
    std::vector<std::uint32_t> wanted;
    for_each_edge(
        result_.position_vertex.size(), result_.triangles, [&](std::span<const EdgeUse> uses) {
            for (const EdgeUse& use : uses) {
                const bool is_first =
                    use.corner == uses[0].corner || use.corner == result_.opposite[uses[0].corner];
                if (!is_first) wanted.push_back(triangle_of(use.corner));
            }
        });
    for (const std::uint32_t triangle : wanted) {
        for (Corner corner = 3 * triangle; corner < 3 * triangle + 3; ++corner) {
            Corner& beyond = result_.opposite[corner];
            if (beyond != no_corner) result_.opposite[beyond] = no_corner;
            beyond = no_corner;
            is_cut_class_[vertex_of(corner, welded_)] = true;
        }
    }
    return !wanted.empty();
}

void TopologyMaker::mark_cut() {
    std::vector<bool> is_taken(mesh_.positions.size(), false);
    for (const std::uint32_t position : result_.position_vertex) {
        if (is_taken[position]) is_cut_class_[position] = true;
        is_taken[position] = true;
    }
    for (const std::uint32_t position : result_.position_vertex)
        result_.is_cut.push_back(is_cut_class_[position]);
}

Topology TopologyMaker::make() {
    choose_triangles();
    find_neighbors();
    do {
        find_vertices();
    } while (cut_off_double_edges());
    mark_cut();
    return std::move(result_);
}

}  // namespace

Topology topology_of(const Mesh& mesh, std::span<const std::uint32_t> classes, Report& report,
                     std::span<const Corner> order) {
    return TopologyMaker(mesh, classes, order, report).make();
}

}  // namespace relief::detail
