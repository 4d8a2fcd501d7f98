// SPDX-License-Identifier: Apache-2.0
// Neighbors across edges, and the handedness of every triangle's tangents.
//
// Two triangles that run along an edge in opposite directions are neighbors. If an edge has more
// triangles (where the result of the reference implementation depends on the order of triangles),
// triangles with the same texture orientation are paired first, those with the smaller third
// vertices, by value, with each other. The rest are paired with triangles without a gradient, which
// can join either orientation. Identical triangles count once.
//
// Triangles without a gradient contribute nothing. They get a sign first from the groups at their
// vertices that could include them, then from their neighbors, in rounds.
#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <tuple>

#include "geometry/tangent_signs.h"
#include "geometry/value_order.h"
#include "parallel.h"

namespace relief::detail {
struct EdgeUse {
    std::uint32_t other_vertex;  ///< Other end of the edge.
    bool arrives;                ///< True if the triangle runs towards the vertex.
    Gradient kind;
    std::uint32_t third_vertex;
    std::uint32_t rotation;  ///< Index of the triangle's corner at its first position by value.
    std::uint32_t triangle;
    CornerLinker::Place corner;  ///< Corner of the triangle at the vertex.

    [[nodiscard]] auto rank() const {
        return std::tuple(other_vertex, arrives, kind, third_vertex);
    }
    friend bool operator<(const EdgeUse& a, const EdgeUse& b) {
        return std::tuple(a.rank(), a.rotation, a.triangle) <
               std::tuple(b.rank(), b.rotation, b.triangle);
    }
};

namespace {

using Uses = std::span<EdgeUse>;

/// Returns the index of the corner of a triangle at its first position by value. Of identical
/// triangles, those that begin at the same corner have contributions with the same bits.
std::uint32_t rotation_of(const TangentInput& mesh, const glm::uvec3& triangle) {
    const auto comes_first = [&](std::uint32_t a, std::uint32_t b) {
        return compare_values(mesh.positions[a], mesh.positions[b]) < 0;
    };
    if (comes_first(triangle.x, triangle.y) && comes_first(triangle.x, triangle.z)) return 0;
    return comes_first(triangle.y, triangle.z) ? 1 : 2;
}

/// Uses of one direction of an edge, sorted by kind: upright, mirrored, none.
std::array<Uses, 3> by_kind(Uses uses) {
    std::array<Uses, 3> parts;
    auto begin = uses.begin();
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const auto end = std::find_if(begin, uses.end(), [&](const EdgeUse& use) {
            return static_cast<std::size_t>(use.kind) != i;
        });
        parts[i] = {begin, end};
        begin = end;
    }
    return parts;
}

}  // namespace

CornerLinker::CornerLinker(const TangentInput& mesh, std::span<const Gradient> kinds)
    : mesh_(mesh), kinds_(kinds) {}

CornerLinker::~CornerLinker() = default;

/// Uses of the edges of the vertex, sorted by edge, leaving triangles before arriving ones.
void CornerLinker::collect(std::span<const Corner> around) {
    uses_.clear();
    for (Place place = 0; place < around.size(); ++place) {
        const Corner corner = around[place];
        const std::uint32_t triangle = triangle_of(corner);
        const std::uint32_t next = vertex_of(next_in_triangle(corner), mesh_.triangles);
        const std::uint32_t previous = vertex_of(previous_in_triangle(corner), mesh_.triangles);
        const std::uint32_t rotation = rotation_of(mesh_, mesh_.triangles[triangle]);
        const Gradient kind = kinds_[triangle];
        uses_.push_back({next, false, kind, previous, rotation, triangle, place});
        uses_.push_back({previous, true, kind, next, rotation, triangle, place});
    }
    std::sort(uses_.begin(), uses_.end());
}

void CornerLinker::link(const EdgeUse& leaving, const EdgeUse& arriving) {
    across_[leaving.corner] = arriving.corner;
    across_previous_[arriving.corner] = leaving.corner;
}

/// Removes all but the first of identical triangles and records it as their twin.
Uses CornerLinker::without_twins(Uses uses) {
    auto kept = uses.begin();
    for (auto use = uses.begin(); use != uses.end(); ++use) {
        if (kept != uses.begin() && std::prev(kept)->rank() == use->rank()) {
            twin_[use->corner] = std::prev(kept)->corner;
            continue;
        }
        *kept++ = *use;
    }
    return {uses.begin(), kept};
}

/// Pairs the triangles of both sides, as many as possible, and leaves the rest.
void CornerLinker::pair_up(Uses& leaving, Uses& arriving) {
    const std::size_t pairs = std::min(leaving.size(), arriving.size());
    for (std::size_t i = 0; i < pairs; ++i)
        link(leaving[i], arriving[i]);
    leaving = leaving.subspan(pairs);
    arriving = arriving.subspan(pairs);
}

/// Sorts triangles at one side of an edge by the values of their third vertices, so that the
/// numbering of vertices does not matter.
void CornerLinker::sort_by_value(Uses uses) {
    std::sort(uses.begin(), uses.end(), [&](const EdgeUse& a, const EdgeUse& b) {
        const auto order = [&](const auto& values) {
            return compare_values(values[a.third_vertex], values[b.third_vertex]);
        };
        if (const int by_position = order(mesh_.positions)) return by_position < 0;
        if (const int by_normal = order(mesh_.normals)) return by_normal < 0;
        return order(mesh_.texcoords) < 0;
    });
}

/// Finds the neighbors at one edge.
void CornerLinker::link_edge(Uses uses) {
    const auto turn =
        std::find_if(uses.begin(), uses.end(), [](const EdgeUse& use) { return use.arrives; });
    if (uses.size() == 2 && turn == uses.begin() + 1) {
        link(uses[0], uses[1]);
        return;
    }
    std::array<Uses, 3> leaving = by_kind(without_twins({uses.begin(), turn}));
    std::array<Uses, 3> arriving = by_kind(without_twins({turn, uses.end()}));
    for (std::size_t kind = 0; kind < 3; ++kind) {
        sort_by_value(leaving[kind]);
        sort_by_value(arriving[kind]);
        pair_up(leaving[kind], arriving[kind]);
    }
    // The two calls apply to different triangles. Seen from the other end of the edge, where
    // leaving and arriving are exchanged, they run in the other order with the same result.
    for (std::size_t kind = 0; kind < 2; ++kind) {
        pair_up(leaving[kind], arriving[2]);
        pair_up(leaving[2], arriving[kind]);
    }
}

void CornerLinker::link(std::span<const Corner> around) {
    across_.assign(around.size(), nowhere);
    across_previous_.assign(around.size(), nowhere);
    twin_.resize(around.size());
    std::iota(twin_.begin(), twin_.end(), Place(0));
    collect(around);
    for (auto first = uses_.begin(); first != uses_.end();) {
        const auto last = std::find_if(first, uses_.end(), [&](const EdgeUse& use) {
            return use.other_vertex != first->other_vertex;
        });
        link_edge({first, last});
        first = last;
    }
}

namespace {

/// Participating triangles without a gradient, and their neighbors across edges.
class OpenTriangles {
  public:
    OpenTriangles(const TangentInput& mesh, const CornersByVertex& corners,
                  const TriangleGradients& gradients) {
        for (const std::uint32_t triangle : gradients.without) {
            if (gradients.kinds[triangle] == Gradient::none) triangles_.push_back(triangle);
        }
        across_.assign(3 * triangles_.size(), no_corner);
        link(mesh, corners, gradients.kinds);
    }

    static constexpr std::size_t not_open = std::numeric_limits<std::size_t>::max();

    [[nodiscard]] std::size_t count() const { return triangles_.size(); }
    [[nodiscard]] std::uint32_t triangle(std::size_t place) const { return triangles_[place]; }

    /// Returns the index among the open triangles, or not_open.
    [[nodiscard]] std::size_t place_of(std::uint32_t triangle) const {
        const auto found = std::lower_bound(triangles_.begin(), triangles_.end(), triangle);
        if (found == triangles_.end() || *found != triangle) return not_open;
        return static_cast<std::size_t>(found - triangles_.begin());
    }

    /// For a corner of an open triangle that continues from V to W: the neighbor's corner at V
    /// across the edge VW, or no_corner.
    [[nodiscard]] Corner across(std::size_t place, Corner corner) const {
        return across_[3 * place + corner % 3];
    }

  private:
    /// Visits every vertex of the open triangles.
    void link(const TangentInput& mesh, const CornersByVertex& corners,
              std::span<const Gradient> kinds) {
        std::vector<std::uint32_t> vertices;
        for (const std::uint32_t triangle : triangles_) {
            for (int i = 0; i < 3; ++i)
                vertices.push_back(mesh.triangles[triangle][i]);
        }
        std::sort(vertices.begin(), vertices.end());
        vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
        parallel_for(vertices.size(), 512, [&](std::size_t begin, std::size_t end) {
            CornerLinker linker(mesh, kinds);
            for (std::size_t i = begin; i < end; ++i)
                link_at(corners.at(vertices[i]), linker);
        });
    }

    void link_at(std::span<const Corner> around, CornerLinker& linker) {
        linker.link(around);
        for (CornerLinker::Place i = 0; i < around.size(); ++i) {
            const std::size_t place = place_of(triangle_of(around[i]));
            if (place != not_open && linker.across(i) != CornerLinker::nowhere)
                across_[3 * place + around[i] % 3] = around[linker.across(i)];
        }
    }

    std::vector<std::uint32_t> triangles_;  ///< Ascending.
    std::vector<Corner> across_;
};

class SignFinder {
  public:
    SignFinder(const OpenTriangles& open, std::vector<std::int8_t>& signs)
        : open_(open), signs_(signs), contributions_(open.count()) {}

    void find() {
        for (std::size_t place = 0; place < open_.count(); ++place) {
            const Corner first = 3 * open_.triangle(place);
            for (Corner corner = first; corner < first + 3; ++corner) {
                if (!is_open(across_previous(place, corner))) propagate_along_chain(place, corner);
            }
        }
        while (!updated_.empty()) {
            const std::vector<std::size_t> elected = elect();
            for (const std::size_t place : elected) {
                const std::uint32_t triangle = open_.triangle(place);
                for (Corner corner = 3 * triangle; corner < 3 * triangle + 3; ++corner)
                    contribution(open_.across(place, corner), signs_[triangle]);
            }
        }
    }

  private:
    struct Contributions {
        std::int8_t sum = 0;
        bool any = false;
    };

    /// Returns the corner at the same vertex across the edge on which the triangle arrives.
    [[nodiscard]] Corner across_previous(std::size_t place, Corner corner) const {
        const Corner beyond = open_.across(place, previous_in_triangle(corner));
        return beyond == no_corner ? no_corner : previous_in_triangle(beyond);
    }

    /// Tests whether the corner's triangle participates and has no sign yet.
    [[nodiscard]] bool is_open(Corner corner) const {
        return corner != no_corner && signs_[triangle_of(corner)] == 0 &&
               open_.place_of(triangle_of(corner)) != OpenTriangles::not_open;
    }

    [[nodiscard]] std::int8_t sign_at(Corner corner) const {
        return corner == no_corner ? std::int8_t{0} : signs_[triangle_of(corner)];
    }

    void contribution(Corner corner, std::int8_t sign) {
        if (!is_open(corner) || sign == 0) return;
        const std::size_t place = open_.place_of(triangle_of(corner));
        Contributions& contributions = contributions_[place];
        if (!contributions.any) updated_.push_back(place);
        contributions.any = true;
        contributions.sum = static_cast<std::int8_t>(contributions.sum + sign);
    }

    /// Around one vertex, the triangles with gradients at both ends of a run of triangles without
    /// gradients contribute their signs to the run.
    void propagate_along_chain(std::size_t place, Corner first) {
        const auto next = [&](Corner corner) {
            return open_.across(open_.place_of(triangle_of(corner)), corner);
        };
        const std::int8_t before = sign_at(across_previous(place, first));
        Corner end = first;
        while (is_open(end))
            end = next(end);
        const std::int8_t after = sign_at(end);
        for (Corner corner = first; corner != end; corner = next(corner)) {
            contribution(corner, before);
            contribution(corner, after);
        }
    }

    /// All contributions of a round are collected before they are applied, so the order does not
    /// matter.
    std::vector<std::size_t> elect() {
        std::vector<std::size_t> elected;
        elected.swap(updated_);
        for (const std::size_t place : elected)
            signs_[open_.triangle(place)] = contributions_[place].sum >= 0 ? 1 : -1;
        return elected;
    }

    const OpenTriangles& open_;
    std::vector<std::int8_t>& signs_;
    std::vector<Contributions> contributions_;
    std::vector<std::size_t> updated_;  ///< Indices of open triangles.
};

}  // namespace

TriangleSigns triangle_signs(const TangentInput& mesh, const CornersByVertex& corners,
                             const TriangleGradients& gradients) {
    const std::vector<Gradient>& kinds = gradients.kinds;
    if (std::none_of(gradients.without.begin(), gradients.without.end(),
                     [&](std::uint32_t triangle) { return kinds[triangle] == Gradient::none; }))
        return {kinds, {}};
    std::vector<std::int8_t> signs(kinds.size());
    std::transform(kinds.begin(), kinds.end(), signs.begin(), sign_of);
    const OpenTriangles open(mesh, corners, gradients);
    SignFinder(open, signs).find();
    return {kinds, std::move(signs)};
}

}  // namespace relief::detail
