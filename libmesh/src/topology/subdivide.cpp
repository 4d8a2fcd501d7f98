// SPDX-License-Identifier: Apache-2.0
// Loop subdivision, level by level.
//
// The rules of [Loop 1987] apply to the manifold surface of the mesh (topology.h): inner vertices
// by their valence, boundaries as cubic splines. The triangles of the mesh determine texture
// coordinates and colors. Positions stay in double precision, relative to the center of the mesh,
// until the last level.
#include "relief/mesh/topology.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "geometry/direction.h"
#include "geometry/weld.h"
#include "portable_math.h"
#include "progress_stage.h"
#include "relief/mesh/report.h"
#include "topology/topology.h"

namespace relief {
using namespace relief::detail;

namespace {

struct LoopPoints {
    std::vector<glm::dvec3> at_vertices;  ///< One per vertex of the topology.
    std::vector<glm::dvec3> on_edges;     ///< One per corner: on the edge to the next corner.
};

/// Returns a corner at each vertex: the one at which its outgoing boundary edge begins, or for an
/// inner vertex its last one. Every vertex of a topology has triangles.
std::vector<Corner> corners_at_vertices(const Topology& topology, std::size_t vertex_count) {
    std::vector<Corner> result(vertex_count, no_corner);
    for (Corner corner = 0; corner < topology.opposite.size(); ++corner) {
        check_cancelled(corner);
        Corner& known = result[vertex_of(corner, topology.triangles)];
        if (known == no_corner || topology.opposite[known] != no_corner) known = corner;
    }
    return result;
}

/// The points of a topology, by corner.
class CornerPoints {
  public:
    /// \param points  one per vertex of the topology
    CornerPoints(const Topology& topology, std::span<const glm::dvec3> points)
        : topology_(topology), points_(points) {}

    /// Returns the corner beyond the edge from a corner to the next one, or no_corner.
    [[nodiscard]] Corner opposite(Corner corner) const { return topology_.opposite[corner]; }
    [[nodiscard]] const glm::dvec3& at(Corner corner) const {
        return points_[vertex_of(corner, topology_.triangles)];
    }
    [[nodiscard]] const glm::dvec3& after(Corner corner) const {
        return at(next_in_triangle(corner));
    }
    [[nodiscard]] const glm::dvec3& before(Corner corner) const {
        return at(previous_in_triangle(corner));
    }

  private:
    const Topology& topology_;
    std::span<const glm::dvec3> points_;
};

/// The rule for vertices. \param first  one of corners_at_vertices()
glm::dvec3 moved_vertex(const CornerPoints& points, Corner first) {
    const glm::dvec3& point = points.at(first);
    if (points.opposite(first) == no_corner) {
        // The edge that arrives is the first one without a neighbor, counter-clockwise.
        Corner arriving = previous_in_triangle(first);
        while (points.opposite(arriving) != no_corner)
            arriving = previous_in_triangle(points.opposite(arriving));
        return (point * 6.0 + points.at(arriving) + points.after(first)) * 0.125;
    }
    glm::dvec3 sum(0.0);
    int valence = 0;
    Corner corner = first;
    do {  // Clockwise.
        ++valence;
        sum += points.after(corner);
        corner = next_in_triangle(points.opposite(corner));
    } while (corner != first);
    const double part = 1.0 / valence;
    const double t = 3.0 + 2.0 * portable::cos(2.0 * std::numbers::pi * part);
    const double alpha = (40.0 - t * t) / 64.0;
    return sum * (part * alpha) + point * (1.0 - alpha);
}

/// The rule for the edge from a corner to the next one.
glm::dvec3 middle_of_edge(const CornerPoints& points, Corner corner) {
    const glm::dvec3 ends = points.at(corner) + points.after(corner);
    const Corner beyond = points.opposite(corner);
    if (beyond == no_corner) return ends * 0.5;
    return (ends * 3.0 + points.before(corner) + points.before(beyond)) * 0.125;
}

/// \param points  one per vertex of the topology
LoopPoints loop_points(const Topology& topology, std::span<const glm::dvec3> points) {
    const CornerPoints corner_points(topology, points);
    LoopPoints result;
    result.at_vertices.reserve(points.size());
    for (const Corner corner : corners_at_vertices(topology, points.size())) {
        check_cancelled(result.at_vertices.size());
        result.at_vertices.push_back(moved_vertex(corner_points, corner));
    }
    result.on_edges.resize(topology.opposite.size());
    for (Corner corner = 0; corner < topology.opposite.size(); ++corner) {
        check_cancelled(corner);
        const Corner beyond = topology.opposite[corner];
        // Both corners of an edge have the bits of the smaller one.
        result.on_edges[corner] =
            beyond < corner ? result.on_edges[beyond] : middle_of_edge(corner_points, corner);
    }
    return result;
}

void check(const Mesh& mesh, int levels) {
    validate(mesh);
    if (levels < 1)
        throw InvalidInput(
            fmt::format("the number of levels is {}, but must be at least 1", levels));
    constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max() / 3;
    std::uint64_t triangles = mesh.triangles.size();
    for (int level = 0; level < levels; ++level) {
        triangles *= 4;
        if (triangles <= most) continue;
        throw InvalidInput(fmt::format("{} triangles make {} after {} levels, but the limit is {}",
                                       mesh.triangles.size(), triangles, level + 1, most));
    }
}

/// Edges of the subdivided triangles. Each edge has one index, also if several triangles share it.
struct EdgeNumbers {
    std::vector<std::uint32_t>
        of_corner;                 ///< Edge from a corner to the next; no_corner if there is none.
    std::vector<glm::uvec2> ends;  ///< One per edge, the smaller vertex first.
};

EdgeNumbers number_edges(std::size_t vertex_count, std::span<const glm::uvec3> triangles,
                         const std::vector<bool>& is_cut) {
    EdgeNumbers result;
    result.of_corner.assign(3 * triangles.size(), no_corner);
    const CornersByVertex corners(vertex_count, triangles,
                                  [&](std::size_t t) { return is_cut[t]; });
    std::vector<std::pair<std::uint32_t, Corner>> edges;  // Pairs of larger vertex and corner.
    for (std::uint32_t v = 0; v < vertex_count; ++v) {
        check_cancelled(v);
        edges.clear();
        for (const Corner corner : corners.at(v)) {
            const Corner previous = previous_in_triangle(corner);
            const std::uint32_t after = vertex_of(next_in_triangle(corner), triangles);
            const std::uint32_t before = vertex_of(previous, triangles);
            if (after > v) edges.emplace_back(after, corner);
            if (before > v) edges.emplace_back(before, previous);
        }
        std::sort(edges.begin(), edges.end());
        for (std::size_t i = 0; i < edges.size(); ++i) {
            if (i == 0 || edges[i].first != edges[i - 1].first)
                result.ends.emplace_back(v, edges[i].first);
            result.of_corner[edges[i].second] = static_cast<std::uint32_t>(result.ends.size() - 1);
        }
    }
    return result;
}

/// A mesh between two levels.
struct Level {
    Mesh mesh;
    std::vector<std::uint32_t> classes;  ///< For each vertex, the first at its position.
    /// Position of each vertex relative to the center of the mesh.
    std::vector<glm::dvec3> points;
};

/// Data of one level: the surface, and its edges by vertex and by position.
struct Cut {
    Topology topology;
    std::vector<bool> is_cut;  ///< One per triangle of the mesh.
    EdgeNumbers edges;
    EdgeNumbers class_edges;
};

Cut cut_of(const Level& level, Report& report) {
    Cut cut{topology_of(level.mesh, level.classes, report), {}, {}, {}};
    cut.is_cut.assign(level.mesh.triangles.size(), false);
    for (const std::uint32_t t : cut.topology.source_triangle)
        cut.is_cut[t] = true;
    check_cancelled();
    cut.edges = number_edges(level.points.size(), level.mesh.triangles, cut.is_cut);
    cut.class_edges = number_edges(
        level.points.size(), welded_triangles(level.mesh.triangles, level.classes), cut.is_cut);
    return cut;
}

/// Sums of points by position class, and their mean.
class Means {
  public:
    explicit Means(std::size_t count) : sums_(count, glm::dvec3(0.0)), counts_(count, 0) {}
    void add(std::size_t place, const glm::dvec3& point) {
        sums_[place] += point;
        ++counts_[place];
    }
    [[nodiscard]] bool has(std::size_t place) const { return counts_[place] != 0; }
    [[nodiscard]] glm::dvec3 at(std::size_t place) const {
        return sums_[place] / static_cast<double>(counts_[place]);
    }

  private:
    std::vector<glm::dvec3> sums_;
    std::vector<unsigned> counts_;
};

/// Returns the new positions of all vertices, followed by the edge midpoints. Surfaces that meet at
/// a position all move to the mean.
std::vector<glm::dvec3> moved_points(const Level& level, const Cut& cut) {
    const Topology& topology = cut.topology;
    std::vector<glm::dvec3> points;
    for (const std::uint32_t vertex : topology.position_vertex)
        points.push_back(level.points[vertex]);
    const LoopPoints loop = loop_points(topology, points);

    Means at_classes(level.points.size());
    for (std::size_t v = 0; v < points.size(); ++v)
        at_classes.add(topology.position_vertex[v], loop.at_vertices[v]);
    Means on_edges(cut.class_edges.ends.size());
    for (std::size_t corner = 0; corner < loop.on_edges.size(); ++corner) {
        check_cancelled(corner);
        const std::size_t mesh_corner = 3 * topology.source_triangle[corner / 3] + corner % 3;
        on_edges.add(cut.class_edges.of_corner[mesh_corner], loop.on_edges[corner]);
    }

    std::vector<glm::dvec3> moved = level.points;
    for (std::size_t v = 0; v < level.points.size(); ++v) {
        check_cancelled(v);
        if (at_classes.has(level.classes[v])) moved[v] = at_classes.at(level.classes[v]);
    }
    moved.resize(level.points.size() + cut.edges.ends.size());
    for (std::size_t corner = 0; corner < cut.edges.of_corner.size(); ++corner) {
        const std::uint32_t edge = cut.edges.of_corner[corner];
        if (edge != no_corner)
            moved[level.points.size() + edge] = on_edges.at(cut.class_edges.of_corner[corner]);
    }
    return moved;
}

/// For each vertex of the next level, the first vertex at its position.
std::vector<std::uint32_t> next_classes(const Level& level, const Cut& cut) {
    std::vector<std::uint32_t> class_edge(cut.edges.ends.size());
    for (std::size_t corner = 0; corner < cut.edges.of_corner.size(); ++corner) {
        const std::uint32_t edge = cut.edges.of_corner[corner];
        if (edge != no_corner) class_edge[edge] = cut.class_edges.of_corner[corner];
    }
    std::vector<std::uint32_t> first(cut.class_edges.ends.size(), no_corner);
    std::vector<std::uint32_t> classes = level.classes;
    for (std::uint32_t edge = 0; edge < class_edge.size(); ++edge) {
        std::uint32_t& known = first[class_edge[edge]];
        if (known == no_corner) known = static_cast<std::uint32_t>(level.points.size()) + edge;
        classes.push_back(known);
    }
    return classes;
}

/// Appends the values at edge midpoints to those at vertices.
template <typename T>
void add_middles(std::vector<T>& values, const EdgeNumbers& edges) {
    if (values.empty()) return;
    values.reserve(values.size() + edges.ends.size());
    for (const glm::uvec2& ends : edges.ends)
        values.push_back((values[ends.x] + values[ends.y]) * 0.5F);
}

/// Replaces each triangle by four, by itself if it was excluded, or by nothing.
void cut_triangles(Mesh& mesh, const Cut& cut, std::size_t vertex_count) {
    std::vector<bool> is_kept(mesh.triangles.size(), false);
    for (const std::uint32_t t : cut.topology.set_aside)
        is_kept[t] = true;
    std::vector<glm::uvec3> triangles;
    triangles.reserve(4 * mesh.triangles.size());
    std::vector<std::uint32_t> first_of(mesh.triangles.size() + 1, 0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        check_cancelled(t);
        const glm::uvec3& old = mesh.triangles[t];
        if (is_kept[t]) triangles.push_back(old);
        if (cut.is_cut[t]) {
            const auto middle = [&](std::size_t i) {
                return static_cast<std::uint32_t>(vertex_count) + cut.edges.of_corner[3 * t + i];
            };
            triangles.emplace_back(old.x, middle(0), middle(2));
            triangles.emplace_back(middle(0), old.y, middle(1));
            triangles.emplace_back(middle(2), middle(1), old.z);
            triangles.emplace_back(middle(0), middle(1), middle(2));
        }
        first_of[t + 1] = static_cast<std::uint32_t>(triangles.size());
    }
    if (!mesh.smoothing_groups.empty()) {
        std::vector<std::uint32_t> groups;
        groups.reserve(triangles.size());
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
            groups.resize(first_of[t + 1], mesh.smoothing_groups[t]);
        mesh.smoothing_groups = std::move(groups);
    }
    for (MaterialRange& range : mesh.material_ranges) {
        const std::uint32_t end = range.first_triangle + range.triangle_count;
        range.first_triangle = first_of[range.first_triangle];
        range.triangle_count = first_of[end] - range.first_triangle;
    }
    mesh.triangles = std::move(triangles);
}

void subdivide_once(Level& level, Report& report) {
    const Cut cut = cut_of(level, report);
    const std::size_t vertex_count = level.points.size();
    std::vector<glm::dvec3> points = moved_points(level, cut);
    check_cancelled();
    level.classes = next_classes(level, cut);
    check_cancelled();
    level.points = std::move(points);
    add_middles(level.mesh.texcoords, cut.edges);
    add_middles(level.mesh.texcoords_2, cut.edges);
    add_middles(level.mesh.colors, cut.edges);
    cut_triangles(level.mesh, cut, vertex_count);
    // Before the last level, they only mark finite vertices.
    level.mesh.positions.resize(level.points.size(), glm::vec3(0.0F));
}

FrameOptions frames_for(const Mesh& input, FrameOptions frames, Report& report) {
    const bool had_tangents = !input.tangents.empty() && !input.texcoords.empty();
    if (frames.tangents == TangentMethod::keep)
        frames.tangents = had_tangents ? TangentMethod::mikktspace : TangentMethod::none;
    if (!input.tangents.empty()) {
        report.add("tangents of other triangles", "mesh", 0,
                   frames.tangents == TangentMethod::none ? "are removed" : "are recomputed");
    }
    const bool needs_normals =
        !input.normals.empty() || frames.tangents == TangentMethod::mikktspace;
    if (frames.normals == NormalMode::keep && needs_normals) frames.normals = NormalWeight::angle;
    return frames;
}

}  // namespace

Mesh subdivided(const Mesh& mesh, int levels, const FrameOptions& frames, Report& report) {
    check(mesh, levels);
    const Bounds bounds = bounds_of(mesh);
    const glm::dvec3 center =
        bounds.empty() ? glm::dvec3(0.0) : (glm::dvec3(bounds.min) + glm::dvec3(bounds.max)) / 2.0;
    Level level{mesh, weld_positions(mesh.positions), {}};
    level.mesh.normals.clear();
    level.mesh.tangents.clear();
    for (const glm::vec3& position : mesh.positions)
        level.points.push_back(glm::dvec3(position) - center);
    for (int i = 0; i < levels; ++i) {
        Report of_quarters;  // The same problems again.
        subdivide_once(level, i == 0 ? report : of_quarters);
    }
    for (std::size_t v = 0; v < level.points.size(); ++v)
        level.mesh.positions[v] = glm::vec3(level.points[v] + center);

    const FrameOptions wanted = frames_for(mesh, frames, report);
    if (wanted.normals == NormalMode::keep) return std::move(level.mesh);
    return with_frames(std::move(level.mesh), wanted, report).mesh;
}

}  // namespace relief
