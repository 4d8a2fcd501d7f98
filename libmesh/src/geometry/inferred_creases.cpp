// SPDX-License-Identifier: Apache-2.0
// Sorts edges by the angle between their triangles and finds the crease angle that separates hard
// from smooth edges with the fewest errors. Edges with one triangle or with more than two are
// ignored.
#include "relief/mesh/normals.h"

#include <algorithm>
#include <glm/trigonometric.hpp>
#include <utility>
#include <vector>

#include "geometry/corners.h"
#include "geometry/normal_sums.h"
#include "geometry/weld.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"

namespace relief {
namespace {

constexpr double same_degrees = 0.5;

/// One side of an edge: its vertices in ascending order and the corner at which it begins.
struct EdgeSide {
    std::uint32_t low, high;
    Corner corner;
};

std::vector<EdgeSide> sides_of(std::span<const glm::uvec3> welded) {
    std::vector<EdgeSide> sides;
    sides.reserve(3 * welded.size());
    for (Corner corner = 0; corner < 3 * welded.size(); ++corner) {
        const std::uint32_t a = vertex_of(corner, welded);
        const std::uint32_t b = vertex_of(next_in_triangle(corner), welded);
        if (a != b) sides.push_back({std::min(a, b), std::max(a, b), corner});
    }
    std::sort(sides.begin(), sides.end(), [](const EdgeSide& a, const EdgeSide& b) {
        if (a.low != b.low) return a.low < b.low;
        return a.high != b.high ? a.high < b.high : a.corner < b.corner;
    });
    return sides;
}

/// An edge between two triangles.
struct JudgedEdge {
    double angle = 0.0;  ///< Degrees between the triangles' normals.
    bool is_hard = false;
};

class EdgeJudge {
  public:
    EdgeJudge(const Mesh& mesh, std::span<const glm::uvec3> welded)
        : mesh_(mesh), welded_(welded), normals_(normals_or_zero(mesh.positions, mesh.triangles)) {}

    /// The angle is NaN if a triangle has no area.
    [[nodiscard]] JudgedEdge judge(const EdgeSide& a, const EdgeSide& b) const {
        const double angle = degrees_between(glm::dvec3(normals_[triangle_of(a.corner)]),
                                             glm::dvec3(normals_[triangle_of(b.corner)]));
        return {angle, differs_at(a, b, a.low) || differs_at(a, b, a.high)};
    }

  private:
    [[nodiscard]] bool differs_at(const EdgeSide& a, const EdgeSide& b, std::uint32_t end) const {
        return degrees_between(normal_at(a, end), normal_at(b, end)) > same_degrees;
    }
    [[nodiscard]] glm::dvec3 normal_at(const EdgeSide& side, std::uint32_t end) const {
        const Corner corner =
            vertex_of(side.corner, welded_) == end ? side.corner : next_in_triangle(side.corner);
        return glm::dvec3(mesh_.normals[vertex_of(corner, mesh_.triangles)]);
    }

    const Mesh& mesh_;
    std::span<const glm::uvec3> welded_;
    std::vector<glm::vec3> normals_;
};

/// Finds the crease angle that misclassifies the fewest edges.
void part(std::vector<JudgedEdge>& edges, InferredCreases& found) {
    std::sort(edges.begin(), edges.end(), [](const JudgedEdge& a, const JudgedEdge& b) {
        return a.angle != b.angle ? a.angle < b.angle : a.is_hard < b.is_hard;
    });
    // The first edges count as smooth, the others as hard. Ties: the largest number of smooth edges
    // wins.
    std::size_t wrong = found.edges - found.hard;
    std::size_t least = wrong;
    std::size_t smooth = 0;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        if (edges[i].is_hard)
            ++wrong;
        else
            --wrong;
        const bool is_last = i + 1 == edges.size();
        if (!is_last && edges[i + 1].angle == edges[i].angle) continue;
        if (wrong > least) continue;
        least = wrong;
        smooth = i + 1;
    }
    found.misclassified = least;
    if (smooth == edges.size()) return;
    const double before = smooth > 0 ? edges[smooth - 1].angle : 0.0;
    found.crease_angle = glm::radians(0.5 * (before + edges[smooth].angle));
}

}  // namespace

InferredCreases inferred_creases(const Mesh& mesh) {
    validate(mesh);
    if (mesh.normals.empty()) throw InvalidInput("the mesh has no normals to tell hard edges by");
    const std::vector<glm::uvec3> welded =
        welded_triangles(mesh.triangles, weld_positions(mesh.positions));
    const std::vector<EdgeSide> sides = sides_of(welded);
    const EdgeJudge judge(mesh, welded);
    InferredCreases found;
    std::vector<JudgedEdge> edges;
    for (std::size_t begin = 0; begin < sides.size();) {
        std::size_t end = begin + 1;
        while (end < sides.size() && sides[end].low == sides[begin].low &&
               sides[end].high == sides[begin].high)
            ++end;
        if (end - begin == 2) {
            const JudgedEdge edge = judge.judge(sides[begin], sides[begin + 1]);
            if (edge.angle >= 0.0) edges.push_back(edge);
        }
        begin = end;
    }
    found.edges = edges.size();
    found.hard = static_cast<std::size_t>(
        std::count_if(edges.begin(), edges.end(), [](const JudgedEdge& e) { return e.is_hard; }));
    if (found.hard > 0) part(edges, found);
    return found;
}

}  // namespace relief
