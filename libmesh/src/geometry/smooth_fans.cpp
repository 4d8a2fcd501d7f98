// SPDX-License-Identifier: Apache-2.0
// The edges from each position to its neighbors are sorted by neighbor, and corners that share a
// smooth edge are joined. The decision at an edge depends only on the normals of its triangles, so
// it is the same for any order of triangles and vertices.
//
// A triangle without a normal has no edges of its own. If two of its corners are at one position,
// its two remaining sides are one edge, and the triangles there are neighbors already. If all three
// are at different positions, it lies on a line, and its longest side coincides with the two
// others: seen from an end of the longest side, both sides of the triangle are one edge.
//
// A crease angle is inferred by sorting edges by the angle between their triangles: it separates
// hard from smooth edges with the fewest errors. Edges with one triangle or with more than two are
// ignored.
#include "geometry/smooth_fans.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/corners.h"
#include "geometry/direction.h"
#include "geometry/edge_pairs.h"
#include "geometry/normal_sums.h"
#include "geometry/weld.h"
#include "parallel.h"
#include "portable_math.h"
#include "progress_stage.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"

namespace relief {
using namespace relief::detail;

namespace {

// Float positions determine an angle with an error of about 1e-7 for well-shaped triangles. The
// slack keeps edges at the limit consistently smooth.
constexpr double limit_slack = 1e-5;

/// An edge from the central position to a neighbor, at one of the corners.
struct Spoke {
    std::uint32_t neighbor;
    std::uint32_t corner;  ///< Index among the corners at this position.
    std::uint32_t group;   ///< Smoothing group of its triangle, 0 if the mesh has none.
    bool leaves;           ///< Whether the triangle runs from the central position.
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
    FansAtPosition(const FanInput& input, const HardEdges& hard_edges)
        : input_(input), hard_edges_(hard_edges) {}

    /// Fans of the corners at this position, by index among them.
    DisjointSets& find(std::span<const Corner> corners) {
        corners_ = corners;
        fans_.reset(corners.size());
        if (input_.joins_positions &&
            std::none_of(corners.begin(), corners.end(),
                         [&](Corner corner) { return is_doubled(triangle_of(corner)); })) {
            for (std::uint32_t i = 1; i < corners.size(); ++i)
                fans_.join(0, i);
            return fans_;
        }
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
    /// Gathers the edges of triangles with a normal, and joins the corners of all others.
    void gather_spokes() {
        spokes_.clear();
        same_edges_.clear();
        std::optional<std::uint32_t> without_normal;
        for (std::uint32_t i = 0; i < corners_.size(); ++i) {
            const Corner corner = corners_[i];
            const std::uint32_t triangle = triangle_of(corner);
            const std::uint32_t next = vertex_of(next_in_triangle(corner), input_.welded);
            const std::uint32_t previous = vertex_of(previous_in_triangle(corner), input_.welded);
            if (input_.normals[triangle] == glm::vec3(0.0F)) {
                if (is_at_end_of_line(corner)) same_edges_.add(next, previous);
                fans_.join(i, without_normal.value_or(i));
                without_normal = i;
                continue;
            }
            const std::uint32_t group =
                hard_edges_.smoothing_groups.empty() ? 0 : hard_edges_.smoothing_groups[triangle];
            spokes_.push_back({next, i, group, true});
            spokes_.push_back({previous, i, group, false});
        }
        if (!same_edges_.empty()) {
            same_edges_.settle();
            for (Spoke& spoke : spokes_)
                spoke.neighbor = same_edges_.of(spoke.neighbor);
        }
        std::sort(spokes_.begin(), spokes_.end(), spoke_comes_before);
    }

    /// Tests whether the corner of a triangle without a normal is at an end of its longest side,
    /// and its corners are at three positions.
    [[nodiscard]] bool is_at_end_of_line(Corner corner) const {
        const std::uint32_t triangle = triangle_of(corner);
        const glm::uvec3& welded = input_.welded[triangle];
        if (welded.x == welded.y || welded.y == welded.z || welded.z == welded.x) return false;
        std::array<glm::dvec3, 3> at{};
        for (std::size_t i = 0; i < at.size(); ++i)
            at[i] = input_.positions[input_.triangles[triangle][static_cast<int>(i)]];
        // Not finite if a position is not.
        std::size_t middle = 0;
        double longest = -1.0;
        for (std::size_t i = 0; i < at.size(); ++i) {
            const glm::dvec3 side = at[(i + 2) % 3] - at[(i + 1) % 3];
            const double square = glm::dot(side, side);
            if (!std::isfinite(square)) return false;
            // Two sides round to the same length if the third is tiny.
            if (square < longest || (square == longest && !comes_before(at[i], at[middle])))
                continue;
            middle = i;
            longest = square;
        }
        return corner % 3 != middle;
    }

    [[nodiscard]] const glm::vec3& normal_at(const Spoke& spoke) const {
        return input_.normals[triangle_of(corners_[spoke.corner])];
    }

    [[nodiscard]] bool is_doubled(std::uint32_t triangle) const {
        return !input_.doubled.empty() && input_.doubled[triangle] != 0;
    }

    void join_along_edge(std::span<Spoke> spokes) {
        if (std::any_of(spokes.begin(), spokes.end(), [&](const Spoke& spoke) {
                return is_doubled(triangle_of(corners_[spoke.corner]));
            }))
            join_sides(spokes);
        else if (spokes.size() == 2)
            join_if_smooth(spokes[0], spokes[1]);
        else if (spokes.size() > 2)
            join_around(spokes);
    }

    void join_if_smooth(const Spoke& a, const Spoke& b) {
        if (!hard_edges_.crease_angle ||
            angle_between(glm::dvec3(normal_at(a)), glm::dvec3(normal_at(b))) <=
                *hard_edges_.crease_angle + limit_slack)
            fans_.join(a.corner, b.corner);
    }

    /// All normals at one edge lie on a circle, so only adjacent ones, and the last and the first,
    /// are compared. The circle begins at the first normal by value.
    void join_around(std::span<Spoke> spokes) {
        std::sort(spokes.begin(), spokes.end(), [&](const Spoke& a, const Spoke& b) {
            return comes_before(glm::dvec3(normal_at(a)), glm::dvec3(normal_at(b)));
        });
        const glm::dvec3 ahead(normal_at(spokes.front()));
        glm::dvec3 aside(0.0);
        for (const Spoke& spoke : spokes) {
            const glm::dvec3 off = in_plane(glm::dvec3(normal_at(spoke)), ahead);
            if (glm::dot(off, off) > glm::dot(aside, aside)) aside = off;
        }
        aside = direction_or_zero(aside);
        around_.clear();
        for (const Spoke& spoke : spokes) {
            const glm::dvec3 normal(normal_at(spoke));
            around_.push_back(
                {portable::atan2(glm::dot(normal, aside), glm::dot(normal, ahead)), spoke});
        }
        std::stable_sort(around_.begin(), around_.end(),
                         [](const SpokeAt& a, const SpokeAt& b) { return a.angle < b.angle; });
        for (std::size_t i = 0; i < around_.size(); ++i)
            join_if_smooth(around_[i].spoke, around_[(i + 1) % around_.size()].spoke);
    }

    /// Joins the sheets of doubled triangles. All decisions are made by value.
    void join_sides(std::span<Spoke> spokes) {
        const auto position = [&](Corner corner) {
            return glm::dvec3(input_.positions[vertex_of(corner, input_.triangles)]);
        };
        // The end of the edge, the third corner, and the central one.
        const auto corners = [&](const Spoke& spoke) {
            const Corner corner = corners_[spoke.corner];
            const Corner next = next_in_triangle(corner);
            const Corner previous = previous_in_triangle(corner);
            if (spoke.leaves) return std::array{next, previous, corner};
            return std::array{previous, next, corner};
        };
        std::sort(spokes.begin(), spokes.end(), [&](const Spoke& a, const Spoke& b) {
            if (normal_at(a) != normal_at(b))
                return comes_before(glm::dvec3(normal_at(a)), glm::dvec3(normal_at(b)));
            for (std::size_t i = 0; i < 3; ++i) {
                const glm::dvec3 at_a = position(corners(a)[i]);
                const glm::dvec3 at_b = position(corners(b)[i]);
                if (at_a != at_b) return comes_before(at_a, at_b);
            }
            return a.leaves && !b.leaves;
        });
        at_edge_.clear();
        for (std::uint32_t i = 0; i < spokes.size(); ++i) {
            const Spoke& spoke = spokes[i];
            const Corner corner = corners_[spoke.corner];
            const std::uint32_t stack = input_.stacks[triangle_of(corner)];
            // A triangle that occurs several times continues as one.
            const auto same =
                std::find_if(at_edge_.begin(), at_edge_.end(), [&](const TriangleAtEdge& other) {
                    return other.stack == stack && other.ascends == spoke.leaves;
                });
            if (same != at_edge_.end()) {
                join_if_smooth(spokes[same->corner], spoke);
                continue;
            }
            const glm::dvec3 edge = position(corners(spoke)[0]) - position(corner);
            at_edge_.push_back(
                {i, spoke.leaves,
                 outward_from(glm::dvec3(normal_at(spoke)), spoke.leaves ? edge : -edge), stack});
        }
        for (const auto& [a, b] : pairs_.join(at_edge_))
            join_if_smooth(spokes[a], spokes[b]);
    }

    struct SpokeAt {
        double angle;
        Spoke spoke;
    };

    const FanInput& input_;
    const HardEdges& hard_edges_;
    std::span<const Corner> corners_;
    DisjointSets fans_;
    std::vector<Spoke> spokes_;
    std::vector<SpokeAt> around_;
    Aliases same_edges_;                   ///< Neighbors in the same direction.
    std::vector<TriangleAtEdge> at_edge_;  ///< Their corners are indices of spokes.
    EdgePairs pairs_;
};

}  // namespace

SmoothFans detail::smooth_fans(const FanInput& input, const HardEdges& hard_edges) {
    constexpr std::size_t grain = 4096;
    const CornersByVertex corners(input.positions.size(), input.welded);
    SmoothFans fans;
    fans.fan_of_corner.resize(3 * input.triangles.size());
    // Each fan is represented by one of its corners first, and gets an index afterwards.
    parallel_for(input.positions.size(), grain, [&](std::size_t begin, std::size_t end) {
        FansAtPosition at(input, hard_edges);
        for (std::size_t v = begin; v < end; ++v) {
            const std::span<const Corner> here = corners.at(v);
            DisjointSets& found = at.find(here);
            for (std::uint32_t i = 0; i < here.size(); ++i)
                fans.fan_of_corner[here[i]] = here[found.find(i)];
        }
    });
    std::vector<std::uint32_t> number(3 * input.triangles.size());
    for (std::size_t c = 0; c < number.size(); ++c) {
        check_cancelled(c);
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

/// Sides of the triangles with a normal, sorted by edge.
std::vector<EdgeSide> sides_of(std::span<const glm::uvec3> welded,
                               std::span<const glm::vec3> normals) {
    std::vector<EdgeSide> sides;
    sides.reserve(3 * welded.size());
    for (Corner corner = 0; corner < 3 * welded.size(); ++corner) {
        check_cancelled(corner);
        if (normals[triangle_of(corner)] == glm::vec3(0.0F)) continue;
        const std::uint32_t a = vertex_of(corner, welded);
        const std::uint32_t b = vertex_of(next_in_triangle(corner), welded);
        sides.push_back({std::min(a, b), std::max(a, b), corner});
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
    EdgeJudge(const Mesh& mesh, std::span<const glm::uvec3> welded,
              std::span<const glm::vec3> normals)
        : mesh_(mesh), welded_(welded), normals_(normals) {}

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
    std::span<const glm::vec3> normals_;
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
    if (mesh.normals.empty())
        throw InvalidInput("the mesh has no normals that could show hard edges");
    const std::vector<glm::uvec3> welded =
        welded_triangles(mesh.triangles, weld_positions(mesh.positions));
    const std::vector<glm::vec3> normals = normals_or_zero(mesh.positions, mesh.triangles);
    const std::vector<EdgeSide> sides = sides_of(welded, normals);
    const EdgeJudge judge(mesh, welded, normals);
    InferredCreases found;
    std::vector<JudgedEdge> edges;
    for (std::size_t begin = 0; begin < sides.size();) {
        std::size_t end = begin + 1;
        while (end < sides.size() && sides[end].low == sides[begin].low &&
               sides[end].high == sides[begin].high)
            ++end;
        if (end - begin == 2) edges.push_back(judge.judge(sides[begin], sides[begin + 1]));
        begin = end;
    }
    found.edges = edges.size();
    found.hard = static_cast<std::size_t>(
        std::count_if(edges.begin(), edges.end(), [](const JudgedEdge& e) { return e.is_hard; }));
    if (found.hard > 0) part(edges, found);
    return found;
}

}  // namespace relief
