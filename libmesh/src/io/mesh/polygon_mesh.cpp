// SPDX-License-Identifier: Apache-2.0
// Triangulation of polygons: quads by MikkTSpace's diagonal, larger ones by ear clipping.
//
// All decisions are made in double precision from the float corners, so that they do not depend on
// scale or compiler. Bad input (no plane, crossing edges, NaN) gives a fan and false. An index out
// of range is a FileError with the face.
#include "io/mesh/polygon_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <queue>

#include "geometry/weld.h"
#include "large_memory.h"
#include "progress_stage.h"
#include "relief/mesh/report.h"

namespace relief::detail {
namespace {

/// Returns twice the vector area of a polygon: its normal by Newell's method. It is computed
/// relative to the first corner, so that large coordinates lose no digits.
glm::dvec3 newell_normal(std::span<const glm::vec3> positions) {
    glm::dvec3 sum(0.0);
    const glm::dvec3 origin(positions[0]);
    for (std::size_t i = 1; i + 1 < positions.size(); ++i) {
        sum += glm::cross(glm::dvec3(positions[i]) - origin, glm::dvec3(positions[i + 1]) - origin);
    }
    return sum;
}

template <typename Vector>
double squared_distance(const Vector& a, const Vector& b) {
    double sum = 0.0;
    for (int i = 0; i < Vector::length(); ++i) {
        const double difference = static_cast<double>(a[i]) - static_cast<double>(b[i]);
        sum += difference * difference;
    }
    return sum;
}

/// The only reflex corner of a quad, or -1 if there is none or more than one.
int reflex_corner_of_quad(std::span<const glm::vec3> positions) {
    const glm::dvec3 normal = newell_normal(positions);
    int reflex = -1;
    for (int i = 0; i < 4; ++i) {
        const auto at = [&](int k) { return glm::dvec3(positions[static_cast<size_t>(k) % 4]); };
        const glm::dvec3 turn = glm::cross(at(i) - at(i + 3), at(i + 1) - at(i));
        if (!(glm::dot(turn, normal) < 0.0)) continue;
        if (reflex >= 0) return -1;
        reflex = i;
    }
    return reflex;
}

bool quad_is_cut_from_first_to_third(std::span<const glm::vec3> positions,
                                     std::span<const glm::vec2> texcoords) {
    const int reflex = reflex_corner_of_quad(positions);
    if (reflex >= 0) return reflex % 2 == 0;
    if (!texcoords.empty()) {
        const double first_to_third = squared_distance(texcoords[0], texcoords[2]);
        const double second_to_fourth = squared_distance(texcoords[1], texcoords[3]);
        if (first_to_third < second_to_fourth) return true;
        if (second_to_fourth < first_to_third) return false;
    }
    return !(squared_distance(positions[1], positions[3]) <
             squared_distance(positions[0], positions[2]));
}

/// Returns twice the signed area of a triangle: positive if it is counter-clockwise.
double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    const glm::dvec2 ab = b - a;
    const glm::dvec2 ac = c - a;
    return ab.x * ac.y - ab.y * ac.x;
}

/// Finds points in triangles: a tree of boxes whose points can be removed.
class PointTree {
  public:
    using Index = std::uint32_t;
    using Triangle = std::array<glm::dvec2, 3>;

    /// \param points  must outlive the tree
    PointTree(std::span<const glm::dvec2> points, std::vector<Index> chosen)
        : points_(points), order_(std::move(chosen)), leaf_of_(points.size(), none) {
        if (!order_.empty()) add_node(none, 0, order_.size());
    }

    /// Removes a point, if the tree has it.
    void remove(Index point) {
        if (leaf_of_[point] == none) return;
        for (Index node = leaf_of_[point]; node != none; node = nodes_[node].parent)
            --nodes_[node].left;
        leaf_of_[point] = none;
    }

    /// Returns true if a point lies in a counter-clockwise triangle or on its border. Points equal
    /// to its corners do not count.
    /// \param steps  is increased by the number of boxes that were visited
    bool has_point_in(const Triangle& triangle, std::size_t& steps) {
        open_.clear();
        if (!nodes_.empty()) open_.push_back(0);
        while (!open_.empty()) {
            const Node& node = nodes_[open_.back()];
            open_.pop_back();
            ++steps;
            if (node.left == 0 || is_outside(node, triangle)) continue;
            if (node.child != none) {
                open_.push_back(node.child);
                open_.push_back(node.other_child);
                continue;
            }
            for (std::size_t i = node.begin; i < node.end; ++i) {
                if (leaf_of_[order_[i]] != none && is_inside(points_[order_[i]], triangle))
                    return true;
            }
        }
        return false;
    }

  private:
    static constexpr Index none = std::numeric_limits<Index>::max();
    static constexpr std::size_t points_per_leaf = 8;

    struct Node {
        glm::dvec2 min{0.0}, max{0.0};
        std::size_t begin = 0, end = 0;  ///< The node's part of order_.
        std::size_t left = 0;            ///< Points that are not removed.
        Index parent = none;
        Index child = none, other_child = none;  ///< None in leaves.
    };

    /// The depth of recursion is the logarithm of the number of points.
    Index add_node(Index parent, std::size_t begin, std::size_t end) {
        const auto number = static_cast<Index>(nodes_.size());
        Node node;
        node.min = node.max = points_[order_[begin]];
        for (std::size_t i = begin; i < end; ++i) {
            node.min = glm::min(node.min, points_[order_[i]]);
            node.max = glm::max(node.max, points_[order_[i]]);
        }
        node.begin = begin;
        node.end = end;
        node.left = end - begin;
        node.parent = parent;
        nodes_.push_back(node);
        if (end - begin <= points_per_leaf) {
            for (std::size_t i = begin; i < end; ++i)
                leaf_of_[order_[i]] = number;
            return number;
        }
        const int axis = node.max.x - node.min.x >= node.max.y - node.min.y ? 0 : 1;
        const std::size_t middle = begin + (end - begin) / 2;
        const auto at = [&](std::size_t i) {
            return order_.begin() + static_cast<std::ptrdiff_t>(i);
        };
        std::nth_element(at(begin), at(middle), at(end), [&](Index a, Index b) {
            return points_[a][axis] != points_[b][axis] ? points_[a][axis] < points_[b][axis]
                                                        : a < b;
        });
        const Index child = add_node(number, begin, middle);
        const Index other_child = add_node(number, middle, end);
        nodes_[number].child = child;
        nodes_[number].other_child = other_child;
        return number;
    }

    /// Returns true if no point of a box is inside. The corner of the box that lies farthest to the
    /// inside of an edge bounds all points, because rounding keeps the order of numbers.
    static bool is_outside(const Node& node, const Triangle& triangle) {
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec2& a = triangle[i];
            const glm::dvec2& b = triangle[(i + 1) % 3];
            const glm::dvec2 inmost(b.y - a.y > 0.0 ? node.min.x : node.max.x,
                                    b.x - a.x > 0.0 ? node.max.y : node.min.y);
            if (turn(a, b, inmost) < 0.0) return true;
        }
        return false;
    }

    static bool is_inside(const glm::dvec2& p, const Triangle& triangle) {
        const auto& [a, b, c] = triangle;
        return p != a && p != b && p != c && turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 &&
               turn(c, a, p) >= 0.0;
    }

    std::span<const glm::dvec2> points_;
    std::vector<Index> order_;    ///< The points, by leaf.
    std::vector<Index> leaf_of_;  ///< None for points that are not in the tree.
    std::vector<Node> nodes_;
    std::vector<Index> open_;
};

/// Ear clipping of one polygon in its plane.
class EarClipper {
  public:
    explicit EarClipper(std::span<const glm::vec3> positions);

    /// Appends the triangles.
    PolygonCut clip(std::vector<glm::uvec3>& triangles);

  private:
    using Corner = PointTree::Index;
    enum class Kind { ear, flat, other };  ///< Flat corners are cut only if there is no ear.
    /// The corners of a kind, and some that were of it, with the lowest first.
    using LowestFirst = std::priority_queue<Corner, std::vector<Corner>, std::greater<>>;

    bool blocked(Corner a, Corner b, Corner c);
    Kind kind_of(Corner corner);
    void update(Corner corner);
    std::optional<Corner> first_of(Kind kind, LowestFirst& corners);
    std::optional<Corner> next_to_cut();
    void remove(Corner corner);

    static constexpr std::size_t max_tests = 200'000'000;

    std::vector<glm::dvec2> points_;  ///< Projected so that the polygon is counter-clockwise.
    std::vector<Corner> previous_, next_;
    std::vector<Kind> kinds_;
    LowestFirst ears_, flats_;
    /// Corners that are not convex at first: only they can block an ear.
    std::optional<PointTree> blockers_;
    std::vector<bool> removed_;
    Corner lowest_ = 0;  ///< The lowest remaining corner.
    std::size_t tests_ = 0;
    bool has_plane_ = false;
};

EarClipper::EarClipper(std::span<const glm::vec3> positions) {
    const glm::dvec3 normal = newell_normal(positions);
    const glm::dvec3 size = glm::abs(normal);
    // Dropping the coordinate of the largest normal component keeps the other two exact.
    const int drop = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    has_plane_ = std::isfinite(size.x + size.y + size.z) && size[drop] > 0.0;
    int u = (drop + 1) % 3;
    int v = (drop + 2) % 3;
    if (normal[drop] < 0.0) std::swap(u, v);
    const auto count = static_cast<Corner>(positions.size());
    for (const glm::vec3& position : positions)
        points_.emplace_back(position[u], position[v]);
    previous_.resize(count);
    next_.resize(count);
    for (Corner i = 0; i < count; ++i) {
        previous_[i] = (i + count - 1) % count;
        next_[i] = (i + 1) % count;
    }
    removed_.assign(count, false);
    kinds_.assign(count, Kind::other);
    if (!has_plane_) return;
    std::vector<Corner> not_convex;
    for (Corner i = 0; i < count; ++i) {
        if (!(turn(points_[previous_[i]], points_[i], points_[next_[i]]) > 0.0))
            not_convex.push_back(i);
    }
    blockers_.emplace(points_, std::move(not_convex));
    for (Corner i = 0; i < count; ++i)
        update(i);
}

/// Returns true if another corner lies in the triangle or on its border. Points equal to its
/// corners do not count.
bool EarClipper::blocked(Corner a, Corner b, Corner c) {
    if (tests_ >= max_tests) return true;
    return blockers_->has_point_in({points_[a], points_[b], points_[c]}, tests_);
}

EarClipper::Kind EarClipper::kind_of(Corner corner) {
    const Corner a = previous_[corner];
    const Corner c = next_[corner];
    const double area = turn(points_[a], points_[corner], points_[c]);
    if (area > 0.0) return blocked(a, corner, c) ? Kind::other : Kind::ear;
    // A spike that reverses direction is not flat: cutting it would uncover the area that it
    // covers.
    const bool goes_on = glm::dot(points_[corner] - points_[a], points_[c] - points_[corner]) >= 0;
    return area == 0.0 && goes_on ? Kind::flat : Kind::other;
}

void EarClipper::update(Corner corner) {
    const Kind before = kinds_[corner];
    kinds_[corner] = kind_of(corner);
    if (kinds_[corner] == before) return;
    if (kinds_[corner] == Kind::ear) ears_.push(corner);
    if (kinds_[corner] == Kind::flat) flats_.push(corner);
}

/// Returns the first corner of a kind after the lowest remaining one, which is the last itself.
std::optional<EarClipper::Corner> EarClipper::first_of(Kind kind, LowestFirst& corners) {
    bool has_lowest = false;
    std::optional<Corner> first;
    while (!corners.empty() && !first) {
        const Corner corner = corners.top();
        const bool is_of_kind = !removed_[corner] && kinds_[corner] == kind;
        if (is_of_kind && corner != lowest_) {
            first = corner;
        } else {
            has_lowest |= is_of_kind;
            corners.pop();
        }
    }
    if (has_lowest) corners.push(lowest_);
    return first || !has_lowest ? first : lowest_;
}

/// The first ear after the lowest remaining corner, otherwise the first flat corner, otherwise
/// none.
std::optional<EarClipper::Corner> EarClipper::next_to_cut() {
    while (removed_[lowest_])
        ++lowest_;
    const std::optional<Corner> ear = first_of(Kind::ear, ears_);
    return ear ? ear : first_of(Kind::flat, flats_);
}

void EarClipper::remove(Corner corner) {
    removed_[corner] = true;
    blockers_->remove(corner);
    const Corner before = previous_[corner];
    const Corner after = next_[corner];
    next_[before] = after;
    previous_[after] = before;
    update(before);
    update(after);
}

PolygonCut EarClipper::clip(std::vector<glm::uvec3>& triangles) {
    std::size_t left = points_.size();
    while (has_plane_ && left > 3 && tests_ < max_tests) {
        const std::optional<Corner> corner = next_to_cut();
        if (!corner) break;
        triangles.emplace_back(previous_[*corner], *corner, next_[*corner]);
        remove(*corner);
        --left;
    }
    Corner first = 0;
    while (removed_[first])
        ++first;
    for (Corner b = next_[first]; next_[b] != first; b = next_[b]) {
        triangles.emplace_back(first, b, next_[b]);
    }
    if (left == 3) return PolygonCut::ears;
    return tests_ < max_tests ? PolygonCut::fan : PolygonCut::fan_at_limit;
}

}  // namespace

PolygonCut triangulate_polygon(std::span<const glm::vec3> positions,
                               std::span<const glm::vec2> texcoords,
                               std::vector<glm::uvec3>& triangles) {
    assert(positions.size() >= 3 && (texcoords.empty() || texcoords.size() == positions.size()));
    if (positions.size() == 3) {
        triangles.emplace_back(0, 1, 2);
        return PolygonCut::ears;
    }
    if (positions.size() > 4) return EarClipper(positions).clip(triangles);
    if (quad_is_cut_from_first_to_third(positions, texcoords)) {
        triangles.emplace_back(0, 1, 2);
        triangles.emplace_back(0, 2, 3);
    } else {
        triangles.emplace_back(0, 1, 3);
        triangles.emplace_back(1, 2, 3);
    }
    return PolygonCut::ears;
}

namespace {

[[noreturn]] void fail_at_face(std::size_t face, std::uint32_t vertex, std::size_t vertex_count,
                               const std::filesystem::path& file) {
    throw FileError(file, fmt::format("face {} names vertex {}, but there are only {}", face,
                                      vertex, vertex_count));
}

void check_indices(const Polygons& polygons, std::size_t vertex_count,
                   const std::filesystem::path& file) {
    std::size_t corner = 0;
    for (std::size_t i = 0; i < polygons.corner_counts.size(); ++i) {
        check_cancelled(i);
        for (const std::size_t end = corner + polygons.corner_counts[i]; corner < end; ++corner) {
            if (polygons.corners[corner] < vertex_count) continue;
            fail_at_face(i, polygons.corners[corner], vertex_count, file);
        }
    }
}

bool are_triangles(const Polygons& polygons) {
    return std::all_of(polygons.corner_counts.begin(), polygons.corner_counts.end(),
                       [](std::uint32_t count) { return count == 3; });
}

/// All polygons are triangles: nothing to cut.
CutPolygons whole_triangles(const Polygons& polygons) {
    CutPolygons result;
    const std::size_t count = polygons.corner_counts.size();
    reserve_to_fill(result.triangles, count);
    for (std::size_t i = 0; i < count; ++i) {
        check_cancelled(i);
        const std::uint32_t* corner = &polygons.corners[3 * i];
        result.triangles.emplace_back(corner[0], corner[1], corner[2]);
    }
    result.polygons.resize(count);
    std::iota(result.polygons.begin(), result.polygons.end(), 0U);
    return result;
}

}  // namespace

CutPolygons cut_polygons(const Mesh& vertices, const Polygons& polygons, Report& report) {
    if (are_triangles(polygons)) return whole_triangles(polygons);
    CutPolygons result;
    result.triangles.reserve(polygons.corner_counts.size());
    result.polygons.reserve(polygons.corner_counts.size());
    std::vector<glm::vec3> positions;
    std::vector<glm::vec2> texcoords;
    std::vector<glm::uvec3> cuts;
    const std::uint32_t* corner = polygons.corners.data();
    ProgressStage stage("cutting polygons", polygons.corner_counts.size());
    for (std::size_t i = 0; i < polygons.corner_counts.size(); ++i) {
        stage.at(i);
        const std::uint32_t count = polygons.corner_counts[i];
        positions.clear();
        texcoords.clear();
        cuts.clear();
        for (std::uint32_t k = 0; count > 3 && k < count; ++k) {
            positions.push_back(vertices.positions[corner[k]]);
            if (!vertices.texcoords.empty()) texcoords.push_back(vertices.texcoords[corner[k]]);
        }
        if (count < 3) {
            report.add("face of fewer than three corners", "face", i, "left out");
        } else if (count == 3) {
            cuts.emplace_back(0, 1, 2);
        } else {
            const PolygonCut cut = triangulate_polygon(positions, texcoords, cuts);
            if (cut == PolygonCut::fan)
                report.add("polygon without an ear", "face", i, "cut as a fan");
            if (cut == PolygonCut::fan_at_limit)
                report.add("polygon too complex to cut", "face", i, "its rest is cut as a fan");
        }
        for (const glm::uvec3& cut : cuts) {
            result.triangles.emplace_back(corner[cut.x], corner[cut.y], corner[cut.z]);
            result.polygons.push_back(static_cast<std::uint32_t>(i));
        }
        corner += count;
    }
    return result;
}

void check_faces(const Mesh& mesh, const std::filesystem::path& file) {
    const std::size_t vertex_count = mesh.positions.size();
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        check_cancelled(i);
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t vertex = mesh.triangles[i][k];
            if (vertex >= vertex_count) fail_at_face(i, vertex, vertex_count, file);
        }
    }
}

void add_triangles(Mesh& mesh, const Polygons& polygons, const std::filesystem::path& file,
                   Report& report) {
    check_indices(polygons, mesh.positions.size(), file);
    mesh.triangles = cut_polygons(mesh, polygons, report).triangles;
    if (mesh.triangles.empty()) throw FileError(file, "has no triangle");
}

namespace {

/// Merges positions; if they have colors, both must be equal.
std::vector<std::uint32_t> first_equal_vertex(const ObjStatements& statements) {
    if (statements.colors.empty()) return weld_bits<glm::vec3>(statements.positions);
    std::vector<std::array<float, 7>> rows;
    rows.reserve(statements.positions.size());
    for (std::size_t i = 0; i < statements.positions.size(); ++i) {
        const glm::vec3& p = statements.positions[i];
        const glm::vec4& c = statements.colors[i];
        rows.push_back({p.x, p.y, p.z, c.r, c.g, c.b, c.a});
    }
    return weld_bits<std::array<float, 7>>(rows);
}

/// Numbers combinations in order of first use. A position nearly always has few of them, which are
/// searched linearly; from the seventeenth on they are hashed.
class VertexNumbers {
  public:
    struct Vertex {
        std::uint32_t position, texcoord, normal;
    };

    explicit VertexNumbers(std::size_t position_count) : newest_(position_count, none), hashed_(0) {
        vertices_.reserve(position_count);
        previous_.reserve(position_count);
    }

    std::uint32_t number_of(const Vertex& vertex) {
        std::uint32_t& newest = newest_[vertex.position];
        std::uint32_t steps = 0;
        for (std::uint32_t at = newest; at != none; at = previous_[at]) {
            const Vertex& known = vertices_[at];
            if (known.texcoord == vertex.texcoord && known.normal == vertex.normal) return at;
            if (++steps == max_steps) return hashed_number_of(vertex);
        }
        previous_.push_back(newest);
        newest = added(vertex);
        return newest;
    }

    /// Returns all combinations, indexed by their number.
    [[nodiscard]] const std::vector<Vertex>& vertices() const { return vertices_; }

  private:
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    static constexpr std::uint32_t max_steps = 16;

    std::uint32_t added(const Vertex& vertex) {
        vertices_.push_back(vertex);
        return static_cast<std::uint32_t>(vertices_.size() - 1);
    }

    std::uint32_t hashed_number_of(const Vertex& vertex) {
        const std::uint32_t known =
            hashed_.number_of({vertex.position, vertex.texcoord, vertex.normal});
        if (known == number_of_hashed_.size()) {
            previous_.push_back(none);  // Hashed combinations are in no chain.
            number_of_hashed_.push_back(added(vertex));
        }
        return number_of_hashed_[known];
    }

    std::vector<Vertex> vertices_;
    std::vector<std::uint32_t>
        previous_;                       ///< The previous vertex with the same position, by vertex.
    std::vector<std::uint32_t> newest_;  ///< The newest vertex, by position.
    KeyNumbers<3> hashed_;
    std::vector<std::uint32_t> number_of_hashed_;
};

}  // namespace

std::vector<std::uint32_t> unify_vertices(const ObjStatements& statements, Mesh& mesh) {
    ProgressStage stage("joining vertices", statements.corners.size());
    const std::vector<std::uint32_t> positions = first_equal_vertex(statements);
    const std::vector<std::uint32_t> texcoords = weld_bits<glm::vec2>(statements.texcoords);
    const std::vector<std::uint32_t> normals = weld_bits<glm::vec3>(statements.normals);
    const bool has_texcoords = !statements.corners.empty() && statements.corners[0].texcoord >= 0;
    const bool has_normals = !statements.corners.empty() && statements.corners[0].normal >= 0;
    VertexNumbers numbers(statements.positions.size());
    std::vector<std::uint32_t> vertex_of_corner;
    reserve_to_fill(vertex_of_corner, statements.corners.size());
    for (const ObjCorner& corner : statements.corners) {
        stage.at(vertex_of_corner.size());
        assert((corner.texcoord >= 0) == has_texcoords && (corner.normal >= 0) == has_normals);
        vertex_of_corner.push_back(numbers.number_of(
            {positions[static_cast<std::uint32_t>(corner.position)],
             has_texcoords ? texcoords[static_cast<std::uint32_t>(corner.texcoord)] : 0,
             has_normals ? normals[static_cast<std::uint32_t>(corner.normal)] : 0}));
    }
    const std::vector<VertexNumbers::Vertex>& vertices = numbers.vertices();
    const auto gather = [&](const auto& values, std::uint32_t VertexNumbers::Vertex::*index,
                            auto& gathered) {
        check_cancelled();
        gathered.reserve(vertices.size());
        for (const VertexNumbers::Vertex& vertex : vertices)
            gathered.push_back(values[vertex.*index]);
    };
    gather(statements.positions, &VertexNumbers::Vertex::position, mesh.positions);
    if (!statements.colors.empty())
        gather(statements.colors, &VertexNumbers::Vertex::position, mesh.colors);
    if (has_texcoords)
        gather(statements.texcoords, &VertexNumbers::Vertex::texcoord, mesh.texcoords);
    if (has_normals) gather(statements.normals, &VertexNumbers::Vertex::normal, mesh.normals);
    return vertex_of_corner;
}

}  // namespace relief::detail
