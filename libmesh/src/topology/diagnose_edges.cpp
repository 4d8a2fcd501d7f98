// SPDX-License-Identifier: Apache-2.0
// Checks for duplicate and back-to-back triangles, edges with more than two triangles or
// inconsistent winding, and fans around vertices. Each vertex sorts what meets there: an edge
// belongs to the smaller of its two vertices, a triangle to the smallest of its three.
#include <algorithm>
#include <numeric>
#include <tuple>

#include "parallel.h"
#include "progress_stage.h"
#include "topology/diagnose_parts.h"

namespace relief::detail {
namespace {

constexpr std::size_t grain = 1024;

// Triangles at an edge lie on each other if their normals are opposite within one degree.
constexpr float folded_cosine = -0.99984770F;

enum class Copy : std::uint8_t { none, repeated, backed };
enum class Edge : std::uint8_t { unremarkable, boundary, folded, flipped, non_manifold };

/// Results by element.
struct FoundEdges {
    std::vector<Copy> copies;           ///< One per triangle.
    std::vector<Edge> edges;            ///< Indexed by the smallest corner that begins the edge.
    std::vector<std::uint8_t> bow_tie;  ///< One per position class.
};

/// A triangle relative to the smallest of its classes.
struct TriangleKey {
    std::uint32_t middle;
    std::uint32_t largest;
    bool is_reversed;  ///< True if it runs from the smallest class to the largest.
    std::uint32_t triangle;
};

/// Key of the triangle at this corner, whose class is the smallest of the three.
TriangleKey key_at(Corner corner, std::span<const glm::uvec3> triangles) {
    const std::uint32_t next = vertex_of(next_in_triangle(corner), triangles);
    const std::uint32_t previous = vertex_of(previous_in_triangle(corner), triangles);
    return {std::min(next, previous), std::max(next, previous), next > previous,
            triangle_of(corner)};
}

/// Classifies the copies of one triangle: [begin, end) have the same corners, in either direction,
/// and are sorted by direction and index. The first of each direction is not a duplicate.
template <typename Iterator>
void judge_copies(Iterator begin, Iterator end, std::vector<Copy>& copies) {
    const Iterator reversed =
        std::find_if(begin, end, [](const TriangleKey& key) { return key.is_reversed; });
    const bool both_ways = reversed != begin && reversed != end;
    for (Iterator key = begin; key != end; ++key) {
        if (key != begin && key != reversed)
            copies[key->triangle] = Copy::repeated;
        else if (both_ways)
            copies[key->triangle] = Copy::backed;
    }
}

void find_copies(std::span<const Corner> around, std::uint32_t vertex,
                 std::span<const glm::uvec3> triangles, std::vector<TriangleKey>& keys,
                 std::vector<Copy>& copies) {
    keys.clear();
    for (const Corner corner : around) {
        const TriangleKey key = key_at(corner, triangles);
        if (vertex < key.middle) keys.push_back(key);
    }
    if (keys.size() < 2) return;
    std::sort(keys.begin(), keys.end(), [](const TriangleKey& a, const TriangleKey& b) {
        return std::tie(a.middle, a.largest, a.is_reversed, a.triangle) <
               std::tie(b.middle, b.largest, b.is_reversed, b.triangle);
    });
    for (auto begin = keys.begin(); begin != keys.end();) {
        const auto end = std::find_if(begin, keys.end(), [&](const TriangleKey& key) {
            return key.middle != begin->middle || key.largest != begin->largest;
        });
        if (end - begin > 1) judge_copies(begin, end, copies);
        begin = end;
    }
}

/// An edge of a triangle at the current vertex.
struct Spoke {
    std::uint32_t other;   ///< Class at its other end.
    Corner corner;         ///< Corner at which the triangle's edge begins.
    bool is_outgoing;      ///< True if it begins here.
    std::uint32_t member;  ///< Index of the triangle among those around the vertex.
};

/// Sets of triangles around one vertex that share an edge there.
class Fans {
  public:
    void reset(std::size_t count) {
        parents_.resize(count);
        std::iota(parents_.begin(), parents_.end(), 0U);
        fans_ = count;
    }

    void join(std::uint32_t a, std::uint32_t b) {
        a = root(a);
        b = root(b);
        if (a == b) return;
        parents_[std::max(a, b)] = std::min(a, b);
        --fans_;
    }

    [[nodiscard]] std::size_t count() const { return fans_; }

  private:
    std::uint32_t root(std::uint32_t member) {
        while (parents_[member] != member)
            member = parents_[member] = parents_[parents_[member]];
        return member;
    }

    std::vector<std::uint32_t> parents_;
    std::size_t fans_ = 0;
};

/// Classifies one edge by its spokes.
Edge judge_edge(std::span<const Spoke> spokes, std::span<const glm::vec3> normals) {
    if (spokes.size() == 1) return Edge::boundary;
    if (spokes.size() > 2) return Edge::non_manifold;
    if (spokes[0].is_outgoing == spokes[1].is_outgoing) return Edge::flipped;
    const glm::vec3& a = normals[triangle_of(spokes[0].corner)];
    const glm::vec3& b = normals[triangle_of(spokes[1].corner)];
    return glm::dot(a, b) < folded_cosine ? Edge::folded : Edge::unremarkable;
}

/// Buffers of one piece of the loop over vertices.
struct Workspace {
    std::vector<TriangleKey> keys;
    std::vector<Spoke> spokes;
    Fans fans;
};

void gather_spokes(std::span<const Corner> around, std::span<const glm::uvec3> triangles,
                   const std::vector<Copy>& copies, Workspace& work) {
    work.spokes.clear();
    std::uint32_t member = 0;
    for (const Corner corner : around) {
        if (copies[triangle_of(corner)] != Copy::none) continue;
        const Corner next = next_in_triangle(corner);
        const Corner previous = previous_in_triangle(corner);
        work.spokes.push_back({vertex_of(next, triangles), corner, true, member});
        work.spokes.push_back({vertex_of(previous, triangles), previous, false, member});
        ++member;
    }
    std::sort(work.spokes.begin(), work.spokes.end(), [](const Spoke& a, const Spoke& b) {
        return a.other != b.other ? a.other < b.other : a.corner < b.corner;
    });
    work.fans.reset(member);
}

/// Classifies edges and fans at one vertex.
void judge_vertex(const DiagnosedMesh& diagnosed, std::uint32_t vertex, Workspace& work,
                  FoundEdges& found) {
    const std::span<const Spoke> spokes(work.spokes);
    for (std::size_t begin = 0; begin < spokes.size();) {
        std::size_t end = begin + 1;
        for (; end < spokes.size() && spokes[end].other == spokes[begin].other; ++end)
            work.fans.join(spokes[begin].member, spokes[end].member);
        if (vertex < spokes[begin].other) {
            found.edges[spokes[begin].corner] =
                judge_edge(spokes.subspan(begin, end - begin), diagnosed.normals);
        }
        begin = end;
    }
    found.bow_tie[vertex] = work.fans.count() > 1 ? 1 : 0;
}

FoundEdges find_edges(const DiagnosedMesh& diagnosed) {
    const std::size_t vertices = diagnosed.classes.size();
    const CornersByVertex corners(vertices, diagnosed.triangles, [&](std::size_t t) {
        return diagnosed.shapes[t] <= TriangleShape::collinear;
    });
    FoundEdges found{std::vector<Copy>(diagnosed.triangles.size(), Copy::none),
                     std::vector<Edge>(3 * diagnosed.triangles.size(), Edge::unremarkable),
                     std::vector<std::uint8_t>(vertices, 0)};
    parallel_for(vertices, grain, [&](std::size_t begin, std::size_t end) {
        std::vector<TriangleKey> keys;
        for (std::size_t v = begin; v < end; ++v)
            find_copies(corners.at(v), static_cast<std::uint32_t>(v), diagnosed.triangles, keys,
                        found.copies);
    });
    parallel_for(vertices, grain, [&](std::size_t begin, std::size_t end) {
        Workspace work;
        for (std::size_t v = begin; v < end; ++v) {
            gather_spokes(corners.at(v), diagnosed.triangles, found.copies, work);
            judge_vertex(diagnosed, static_cast<std::uint32_t>(v), work, found);
        }
    });
    return found;
}

void count_edge(Edge edge, std::size_t triangle, Tally& tally) {
    switch (edge) {
        case Edge::unremarkable:
            break;
        case Edge::boundary:
            tally.add(MeshCondition::edge_boundary, triangle);
            break;
        case Edge::folded:
            tally.add(MeshCondition::edge_folded, triangle);
            break;
        case Edge::flipped:
            tally.add(MeshCondition::edge_flipped, triangle);
            break;
        case Edge::non_manifold:
            tally.add(MeshCondition::edge_non_manifold, triangle);
            break;
    }
}

}  // namespace

void diagnose_edges(const DiagnosedMesh& diagnosed, Tally& tally) {
    const FoundEdges found = find_edges(diagnosed);
    for (std::size_t t = 0; t < found.copies.size(); ++t) {
        check_cancelled(t);
        if (found.copies[t] == Copy::repeated) tally.add(MeshCondition::triangle_repeated, t);
        if (found.copies[t] == Copy::backed) tally.add(MeshCondition::triangle_two_sided, t);
    }
    for (std::size_t corner = 0; corner < found.edges.size(); ++corner)
        count_edge(found.edges[corner], corner / 3, tally);
    for (std::size_t v = 0; v < found.bow_tie.size(); ++v) {
        if (found.bow_tie[v] != 0) tally.add(MeshCondition::vertex_bow_tie, v);
    }
}

}  // namespace relief::detail
