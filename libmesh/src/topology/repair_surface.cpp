// SPDX-License-Identifier: Apache-2.0
// The first steps of a repair: welds positions, removes triangles that are not finite, collapsed or
// duplicates, and joins the others across edges. Tests: tests/mesh/topology/repair_test.cpp.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "geometry/direction.h"
#include "geometry/value_order.h"
#include "geometry/weld.h"
#include "parallel.h"
#include "progress_stage.h"
#include "topology/repair_parts.h"

namespace relief::detail {
namespace {

bool is_finite_point(const glm::vec3& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

/// Numbers the welded positions in ascending order.
void number_positions(const Mesh& mesh, double tolerance, RepairSurface& surface, Report& report) {
    const std::vector<glm::vec3>& at = mesh.positions;
    const std::vector<std::uint32_t> classes =
        tolerance > 0.0 ? weld_near_positions(at, tolerance) : weld_positions(at);
    // The smallest position of each class, which its first vertex represents.
    std::vector<std::uint32_t> smallest(classes);
    for (std::uint32_t v = 0; v < classes.size(); ++v) {
        if (compare_values(at[v], at[smallest[classes[v]]]) < 0) smallest[classes[v]] = v;
    }
    std::vector<std::uint32_t> order;
    for (std::uint32_t v = 0; v < classes.size(); ++v) {
        if (classes[v] == v && is_finite_point(at[v])) order.push_back(v);
    }
    check_cancelled();
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return compare_values(at[smallest[a]], at[smallest[b]]) < 0;
    });
    check_cancelled();
    std::vector<std::uint32_t> number(classes.size(), no_position);
    for (const std::uint32_t v : order) {
        number[v] = static_cast<std::uint32_t>(surface.positions.size());
        surface.positions.push_back(at[smallest[v]] + 0.0F);
    }
    surface.position_of.resize(classes.size());
    for (std::uint32_t v = 0; v < classes.size(); ++v) {
        surface.position_of[v] = number[classes[v]];
        if (number[classes[v]] != no_position && at[v] != surface.positions[number[classes[v]]])
            report.add("vertex near another one", "vertex", v, "is welded with it");
    }
}

/// Compares the attributes at the corners of two triangles, which begin at given corners.
int compare_attributes(const Mesh& mesh, const RepairFace& a, const RepairFace& b) {
    int order = 0;
    const auto compare = [&](const auto& values) {
        for (std::uint32_t k = 0; k < 3 && order == 0 && !values.empty(); ++k) {
            const auto vertex = [&](const RepairFace& face) {
                return mesh.triangles[face.triangle]
                                     [static_cast<glm::length_t>((face.first_corner + k) % 3)];
            };
            order = compare_values(values[vertex(a)], values[vertex(b)]);
        }
    };
    compare(mesh.texcoords);
    compare(mesh.normals);
    compare(mesh.colors);
    compare(mesh.tangents);
    compare(mesh.texcoords_2);
    return order;
}

/// The corners of a face without its winding.
struct FaceKey {
    std::uint32_t middle;
    std::uint32_t largest;
    bool is_reversed;

    explicit FaceKey(const RepairFace& face)
        : middle(std::min(face.positions.y, face.positions.z)),
          largest(std::max(face.positions.y, face.positions.z)),
          is_reversed(face.positions.y > face.positions.z) {}

    [[nodiscard]] bool has_corners_of(const FaceKey& other) const {
        return middle == other.middle && largest == other.largest;
    }
};

/// Sorts the faces by their positions, then by winding, attributes and index.
void sort_faces(const Mesh& mesh, std::size_t position_count, std::vector<RepairFace>& faces) {
    std::vector<std::uint32_t> begin(position_count + 1, 0);
    for (const RepairFace& face : faces)
        ++begin[face.positions.x + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<RepairFace> sorted(faces.size());
    std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
    for (const RepairFace& face : faces)
        sorted[next[face.positions.x]++] = face;
    parallel_for(position_count, 4096, [&](std::size_t first, std::size_t last) {
        for (std::size_t p = first; p < last; ++p) {
            std::sort(sorted.begin() + begin[p], sorted.begin() + begin[p + 1],
                      [&](const RepairFace& a, const RepairFace& b) {
                          const FaceKey left(a);
                          const FaceKey right(b);
                          if (left.middle != right.middle) return left.middle < right.middle;
                          if (left.largest != right.largest) return left.largest < right.largest;
                          if (left.is_reversed != right.is_reversed) return right.is_reversed;
                          const int order = compare_attributes(mesh, a, b);
                          return order != 0 ? order < 0 : a.triangle < b.triangle;
                      });
        }
    });
    faces = std::move(sorted);
}

/// Removes duplicates among sorted faces.
void remove_duplicates(const RepairOptions& options, std::vector<RepairFace>& faces,
                       Report& report) {
    std::vector<RepairFace> kept;
    kept.reserve(faces.size());
    for (std::size_t begin = 0; begin < faces.size();) {
        const FaceKey key(faces[begin]);
        const std::size_t front = kept.size();
        std::size_t end = begin + 1;
        bool is_two_sided = false;
        while (end < faces.size() && faces[end].positions.x == faces[begin].positions.x &&
               FaceKey(faces[end]).has_corners_of(key)) {
            is_two_sided = is_two_sided || FaceKey(faces[end]).is_reversed != key.is_reversed;
            ++end;
        }
        for (std::size_t i = begin; i < end; ++i) {
            const bool is_reversed = FaceKey(faces[i]).is_reversed != key.is_reversed;
            const bool is_first =
                i == begin || FaceKey(faces[i - 1]).is_reversed != FaceKey(faces[i]).is_reversed;
            if (options.remove_duplicates && !is_first)
                report.add("repeated triangle", "triangle", faces[i].triangle, "is removed");
            else if (is_two_sided && options.two_sided == TwoSided::remove)
                report.add("two-sided triangle", "triangle", faces[i].triangle,
                           "is removed with its back");
            else if (is_reversed && options.two_sided == TwoSided::single)
                report.add("two-sided triangle", "triangle", faces[i].triangle,
                           "is removed; the other side stays");
            else if (is_reversed && is_first && options.two_sided == TwoSided::together)
                kept[front].back = faces[i].triangle;
            else
                kept.push_back(faces[i]);
        }
        begin = end;
    }
    faces = std::move(kept);
}

/// Joins the faces at one edge.
class EdgePairs {
  public:
    /// \param joins_twisted  also joins faces that run along the edge in the same direction
    EdgePairs(RepairSurface& surface, bool joins_twisted)
        : surface_(surface), joins_twisted_(joins_twisted) {}

    /// \param corners  the edges of the faces between two positions
    void join(std::span<const Corner> corners) {
        if (corners.size() < 2) return;
        if (corners.size() == 2) {
            if (joins_twisted_ || !is_twisted(corners[0], corners[1]))
                connect(corners[0], corners[1]);
            return;
        }
        if (corners.size() > max_compared) return;  // All are cut.
        open_.clear();
        for (const Corner corner : corners)
            open_.push_back({corner, direction_of(corner)});
        while (join_flattest(false)) {
        }
        while (joins_twisted_ && join_flattest(true)) {
        }
    }

    /// More triangles at an edge are not compared, because that would take too long.
    static constexpr std::size_t max_compared = 512;

  private:
    struct Open {
        Corner corner;
        glm::dvec3 away;  ///< From the edge, in the plane of the face.
    };

    /// Returns whether two faces run along the edge in the same direction. A face with a back runs
    /// in both.
    [[nodiscard]] bool is_twisted(Corner a, Corner b) const {
        return surface_.position_at(a) == surface_.position_at(b) &&
               !surface_.faces[a / 3].has_back() && !surface_.faces[b / 3].has_back();
    }
    void connect(Corner a, Corner b) {
        surface_.opposite[a] = b;
        surface_.opposite[b] = a;
    }
    [[nodiscard]] glm::dvec3 direction_of(Corner corner) const {
        const std::uint32_t low =
            std::min(surface_.position_at(corner), surface_.position_at(next_in_triangle(corner)));
        const std::uint32_t high =
            std::max(surface_.position_at(corner), surface_.position_at(next_in_triangle(corner)));
        const glm::dvec3 start = surface_.point(low);
        const glm::dvec3 edge = direction_or_zero(surface_.point(high) - start);
        return direction_or_zero(in_plane(
            surface_.point(surface_.position_at(previous_in_triangle(corner))) - start, edge));
    }
    /// Joins the pair whose dihedral angle is nearest to 180 degrees.
    bool join_flattest(bool twisted) {
        double best = 2.0;
        std::size_t best_i = 0;
        std::size_t best_j = 0;
        for (std::size_t i = 0; i < open_.size(); ++i) {
            for (std::size_t j = i + 1; j < open_.size(); ++j) {
                if (is_twisted(open_[i].corner, open_[j].corner) != twisted) continue;
                const double cosine = glm::dot(open_[i].away, open_[j].away);
                if (cosine >= best) continue;
                best = cosine;
                best_i = i;
                best_j = j;
            }
        }
        if (best > 1.5) return false;
        connect(open_[best_i].corner, open_[best_j].corner);
        open_.erase(open_.begin() + static_cast<std::ptrdiff_t>(best_j));
        open_.erase(open_.begin() + static_cast<std::ptrdiff_t>(best_i));
        return true;
    }

    RepairSurface& surface_;
    bool joins_twisted_;
    std::vector<Open> open_;
};

}  // namespace

RepairSurface repair_surface(const Mesh& mesh, const RepairOptions& options, Report& report) {
    RepairSurface surface;
    number_positions(mesh, options.weld_tolerance, surface, report);
    surface.faces.reserve(mesh.triangles.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        check_cancelled(t);
        const glm::uvec3 triangle = mesh.triangles[t];
        std::array<std::uint32_t, 3> p{surface.position_of[triangle.x],
                                       surface.position_of[triangle.y],
                                       surface.position_of[triangle.z]};
        if (p[0] == no_position || p[1] == no_position || p[2] == no_position) {
            if (options.remove_non_finite)
                report.add("triangle with a non-finite corner", "triangle", t, "is removed");
            else
                surface.set_aside.push_back(t);
            continue;
        }
        if (p[0] == p[1] || p[1] == p[2] || p[2] == p[0]) {
            if (options.remove_collapsed)
                report.add("collapsed triangle", "triangle", t, "is removed");
            else
                surface.set_aside.push_back(t);
            continue;
        }
        const auto first =
            static_cast<std::uint32_t>(std::min_element(p.begin(), p.end()) - p.begin());
        surface.faces.push_back({{p[first], p[(first + 1) % 3], p[(first + 2) % 3]}, t, first});
    }
    sort_faces(mesh, surface.positions.size(), surface.faces);
    remove_duplicates(options, surface.faces, report);
    surface.is_flipped.assign(surface.faces.size(), 0);
    return surface;
}

void join_faces(RepairSurface& surface, const RepairOptions& options, Report& report) {
    const std::size_t edge_count = 3 * surface.faces.size();
    const auto ends = [&](Corner corner) {
        const std::uint32_t a = surface.position_at(corner);
        const std::uint32_t b = surface.position_at(next_in_triangle(corner));
        return std::pair(std::min(a, b), std::max(a, b));
    };
    std::vector<std::uint32_t> begin(surface.positions.size() + 1, 0);
    for (Corner corner = 0; corner < edge_count; ++corner) {
        ++begin[ends(corner).first + 1];
    }
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
    // The larger end and the corner, so that they are sorted as one number.
    std::vector<std::uint64_t> edges(edge_count);
    for (Corner corner = 0; corner < edge_count; ++corner) {
        const auto [low, high] = ends(corner);
        edges[next[low]++] = static_cast<std::uint64_t>(high) << 32 | corner;
    }
    surface.opposite.assign(edge_count, no_corner);
    const auto for_groups = [&](std::size_t position, const auto& visit) {
        for (std::size_t from = begin[position]; from < begin[position + 1];) {
            std::size_t to = from + 1;
            while (to < begin[position + 1] && edges[to] >> 32 == edges[from] >> 32)
                ++to;
            visit(from, to);
            from = to;
        }
    };
    parallel_for(surface.positions.size(), 4096, [&](std::size_t first, std::size_t last) {
        EdgePairs pairs(surface, options.orient);
        std::vector<Corner> group;
        for (std::size_t p = first; p < last; ++p) {
            std::sort(edges.begin() + begin[p], edges.begin() + begin[p + 1]);
            for_groups(p, [&](std::size_t from, std::size_t to) {
                group.clear();
                for (std::size_t i = from; i < to; ++i)
                    group.push_back(static_cast<Corner>(edges[i]));
                pairs.join(group);
            });
        }
    });
    for (std::size_t p = 0; p < surface.positions.size(); ++p) {
        for_groups(p, [&](std::size_t from, std::size_t to) {
            if (to - from < 3) return;
            std::uint32_t triangle = no_position;
            const auto crowd_begin = static_cast<std::uint32_t>(surface.crowd.size());
            for (std::size_t i = from; i < to; ++i) {
                const auto corner = static_cast<Corner>(edges[i]);
                surface.crowd.push_back(corner);
                triangle = std::min(triangle, surface.faces[corner / 3].triangle);
            }
            surface.crowded.push_back(
                {crowd_begin, static_cast<std::uint32_t>(surface.crowd.size())});
            if (!options.separate) return;
            if (to - from > EdgePairs::max_compared)
                report.add("edge of more than 512 triangles", "edge", triangle,
                           "is cut between all of them");
            else
                report.add("non-manifold edge", "edge", triangle,
                           "is cut, except for its flattest pairs of triangles");
        });
    }
}

}  // namespace relief::detail
