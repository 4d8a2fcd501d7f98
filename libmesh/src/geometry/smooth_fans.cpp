// SPDX-License-Identifier: Apache-2.0
// The edges from each position to its neighbors are sorted by neighbor, and corners that share a
// smooth edge are joined. The decision at an edge depends only on its two triangles, so it is the
// same at both ends and for any order of triangles.
//
// A crease angle is inferred by sorting edges by the angle between their triangles: it separates
// hard from smooth edges with the fewest errors. Edges with one triangle or with more than two are
// ignored.
#include "geometry/smooth_fans.h"

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <utility>
#include <vector>

#include "geometry/corners.h"
#include "geometry/direction.h"
#include "geometry/normal_sums.h"
#include "geometry/weld.h"
#include "parallel.h"
#include "portable_math.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"

namespace relief {
namespace {

// Float positions determine an angle with an error of about 1e-7 for well-shaped triangles. The
// slack keeps edges at the limit consistently smooth.
constexpr double limit_slack = 1e-5;

/// An edge from the central position to a neighbor, at one of the corners.
struct Spoke {
    std::uint32_t neighbor;
    std::uint32_t corner;  ///< Index among the corners at this position.
    std::uint32_t group;   ///< Smoothing group of its triangle, 0 if the mesh has none.
};

bool spoke_comes_before(const Spoke& a, const Spoke& b) {
    if (a.neighbor != b.neighbor) return a.neighbor < b.neighbor;
    return a.group != b.group ? a.group < b.group : a.corner < b.corner;
}

/// Equivalence classes of numbers, given by pairs. The smallest number represents a class.
class Aliases {
  public:
    void add(std::uint32_t a, std::uint32_t b) { pairs_.emplace_back(a, b); }
    void clear() { pairs_.clear(); }
    [[nodiscard]] bool empty() const { return pairs_.empty(); }

    void settle() {
        names_.clear();
        for (const auto& [a, b] : pairs_) {
            names_.push_back(a);
            names_.push_back(b);
        }
        std::sort(names_.begin(), names_.end());
        names_.erase(std::unique(names_.begin(), names_.end()), names_.end());
        sets_.reset(names_.size());
        for (const auto& [a, b] : pairs_)
            sets_.join(index(a), index(b));
    }
    std::uint32_t of(std::uint32_t name) {
        const std::uint32_t i = index(name);
        return i < names_.size() && names_[i] == name ? names_[sets_.find(i)] : name;
    }

  private:
    [[nodiscard]] std::uint32_t index(std::uint32_t name) const {
        return static_cast<std::uint32_t>(std::lower_bound(names_.begin(), names_.end(), name) -
                                          names_.begin());
    }

    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs_;
    std::vector<std::uint32_t> names_;
    DisjointSets sets_;  ///< Sets of indices into `names_`.
};

class FansAtPosition {
  public:
    FansAtPosition(std::span<const glm::uvec3> triangles, std::span<const glm::vec3> normals,
                   const HardEdges& hard_edges)
        : triangles_(triangles), normals_(normals), hard_edges_(hard_edges) {}

    /// Fans of the corners at this position, by index among them.
    DisjointSets& find(std::span<const Corner> corners) {
        corners_ = corners;
        fans_.reset(corners.size());
        gather_spokes();
        for (auto begin = spokes_.begin(); begin != spokes_.end();) {
            const auto end = std::find_if(begin, spokes_.end(), [&](const Spoke& spoke) {
                return spoke.neighbor != begin->neighbor || spoke.group != begin->group;
            });
            // Group 0 is OBJ's "off": its triangles are joined to none.
            if (hard_edges_.smoothing_groups.empty() || begin->group != 0)
                join_along_edge({begin, end});
            begin = end;
        }
        return fans_;
    }

  private:
    void gather_spokes() {
        spokes_.clear();
        seen_through_.clear();
        for (std::uint32_t i = 0; i < corners_.size(); ++i) {
            const std::uint32_t triangle = triangle_of(corners_[i]);
            const std::uint32_t group =
                hard_edges_.smoothing_groups.empty() ? 0 : hard_edges_.smoothing_groups[triangle];
            const std::uint32_t next = vertex_of(next_in_triangle(corners_[i]), triangles_);
            const std::uint32_t previous = vertex_of(previous_in_triangle(corners_[i]), triangles_);
            spokes_.push_back({next, i, group});
            spokes_.push_back({previous, i, group});
            if (normal_at(spokes_.back()) == glm::vec3(0.0F)) seen_through_.add(next, previous);
        }
        if (!seen_through_.empty()) {
            seen_through_.settle();
            for (Spoke& spoke : spokes_)
                spoke.neighbor = seen_through_.of(spoke.neighbor);
        }
        std::sort(spokes_.begin(), spokes_.end(), spoke_comes_before);
    }

    [[nodiscard]] const glm::vec3& normal_at(const Spoke& spoke) const {
        return normals_[triangle_of(corners_[spoke.corner])];
    }

    void join(const Spoke& a, const Spoke& b) { fans_.join(a.corner, b.corner); }

    void join_along_edge(std::span<const Spoke> spokes) {
        sound_.clear();
        for (const Spoke& spoke : spokes) {
            if (normal_at(spoke) != glm::vec3(0.0F)) sound_.push_back(spoke);
        }
        if (sound_.size() < spokes.size()) join_seen_through(spokes);
        if (sound_.size() == 2)
            join_if_smooth(sound_[0], sound_[1]);
        else if (sound_.size() > 2)
            join_around();
    }

    /// A triangle without a normal joins the neighbor with the smallest normal by value, or the
    /// other triangles without a normal.
    void join_seen_through(std::span<const Spoke> spokes) {
        const auto by_normal = [&](const Spoke& a, const Spoke& b) {
            return comes_before(glm::dvec3(normal_at(a)), glm::dvec3(normal_at(b)));
        };
        const Spoke& host = sound_.empty()
                                ? spokes.front()
                                : *std::min_element(sound_.begin(), sound_.end(), by_normal);
        for (const Spoke& spoke : spokes) {
            if (normal_at(spoke) == glm::vec3(0.0F)) join(spoke, host);
        }
    }

    void join_if_smooth(const Spoke& a, const Spoke& b) {
        if (!hard_edges_.crease_angle ||
            angle_between(glm::dvec3(normal_at(a)), glm::dvec3(normal_at(b))) <=
                *hard_edges_.crease_angle + limit_slack)
            join(a, b);
    }

    /// All normals at one edge lie on a circle, so only adjacent ones, and the last and the first,
    /// are compared.
    void join_around() {
        const glm::dvec3 ahead(normal_at(sound_.front()));
        glm::dvec3 aside(0.0);
        for (const Spoke& spoke : sound_) {
            const glm::dvec3 off = in_plane(glm::dvec3(normal_at(spoke)), ahead);
            if (glm::dot(off, off) > glm::dot(aside, aside)) aside = off;
        }
        aside = direction_or_zero(aside);
        const auto angle = [&](const Spoke& spoke) {
            const glm::dvec3 normal(normal_at(spoke));
            return portable::atan2(glm::dot(normal, aside), glm::dot(normal, ahead));
        };
        std::sort(sound_.begin(), sound_.end(),
                  [&](const Spoke& a, const Spoke& b) { return angle(a) < angle(b); });
        for (std::size_t i = 0; i < sound_.size(); ++i)
            join_if_smooth(sound_[i], sound_[(i + 1) % sound_.size()]);
    }

    std::span<const glm::uvec3> triangles_;
    std::span<const glm::vec3> normals_;
    const HardEdges& hard_edges_;
    std::span<const Corner> corners_;
    DisjointSets fans_;
    std::vector<Spoke> spokes_;
    std::vector<Spoke> sound_;  ///< Spokes of one edge whose triangles have a normal.
    Aliases seen_through_;      ///< Neighbors on both sides of a triangle without a normal.
};

}  // namespace

SmoothFans smooth_fans(std::size_t position_count, std::span<const glm::uvec3> triangles,
                       std::span<const glm::vec3> normals, const HardEdges& hard_edges) {
    constexpr std::size_t grain = 4096;
    const CornersByVertex corners(position_count, triangles);
    SmoothFans fans;
    fans.fan_of_corner.resize(3 * triangles.size());
    // Each fan is represented by one of its corners first, and gets an index afterwards.
    parallel_for(position_count, grain, [&](std::size_t begin, std::size_t end) {
        FansAtPosition at(triangles, normals, hard_edges);
        for (std::size_t v = begin; v < end; ++v) {
            const std::span<const Corner> here = corners.at(v);
            DisjointSets& found = at.find(here);
            for (std::uint32_t i = 0; i < here.size(); ++i)
                fans.fan_of_corner[here[i]] = here[found.find(i)];
        }
    });
    std::vector<std::uint32_t> number(3 * triangles.size());
    for (std::size_t c = 0; c < number.size(); ++c) {
        if (fans.fan_of_corner[c] == c) number[c] = static_cast<std::uint32_t>(fans.count++);
    }
    for (std::uint32_t& fan : fans.fan_of_corner)
        fan = number[fan];
    return fans;
}

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
