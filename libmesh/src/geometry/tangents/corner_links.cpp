// SPDX-License-Identifier: Apache-2.0
// An edge with one triangle in each direction makes them neighbours. Where there are more (the
// reference implementation then takes them in the order of the list, so that its answer depends on
// that), triangles whose textures run the same way are paired first, those with the smaller third
// vertices with each other; what is left over is paired with triangles without a gradient, which
// can join either kind. Identical triangles count once.
// Tests: tests/mesh/geometry/tangents/corner_links_test.cpp.
#include "geometry/tangents/corner_links.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>

namespace relief {

struct EdgeUse {
    std::uint32_t other_vertex;  ///< The edge's other end.
    bool arrives;                ///< The triangle runs towards the vertex.
    Gradient kind;
    std::uint32_t third_vertex;
    std::uint32_t rotation;  ///< Which corner of the triangle stands at its smallest vertex.
    std::uint32_t triangle;
    CornerLinker::Place corner;  ///< Of the triangle, at the vertex.

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

/// Which corner of a triangle stands at its smallest vertex.
std::uint32_t rotation_of(const glm::uvec3& triangle) {
    if (triangle.x < triangle.y && triangle.x < triangle.z) return 0;
    return triangle.y < triangle.z ? 1 : 2;
}

/// The uses of one direction, sorted, by kind: upright, mirrored, none.
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

CornerLinker::CornerLinker(std::span<const glm::uvec3> triangles, std::span<const Gradient> kinds)
    : triangles_(triangles), kinds_(kinds) {}

CornerLinker::~CornerLinker() = default;

/// All uses of the edges of the vertex, sorted: edge by edge, leaving triangles before arriving
/// ones, and so on.
void CornerLinker::collect(std::span<const Corner> around) {
    uses_.clear();
    for (Place place = 0; place < around.size(); ++place) {
        const Corner corner = around[place];
        const std::uint32_t triangle = triangle_of(corner);
        const std::uint32_t next = vertex_of(next_in_triangle(corner), triangles_);
        const std::uint32_t previous = vertex_of(previous_in_triangle(corner), triangles_);
        const std::uint32_t rotation = rotation_of(triangles_[triangle]);
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

/// Drops all but the first of identical triangles, and notes it as their twin.
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

/// Makes neighbours of as many as there are on both sides, and leaves the rest.
void CornerLinker::pair_up(Uses& leaving, Uses& arriving) {
    const std::size_t pairs = std::min(leaving.size(), arriving.size());
    for (std::size_t i = 0; i < pairs; ++i)
        link(leaving[i], arriving[i]);
    leaving = leaving.subspan(pairs);
    arriving = arriving.subspan(pairs);
}

/// Finds the neighbours at one edge.
void CornerLinker::link_edge(Uses uses) {
    const auto turn =
        std::find_if(uses.begin(), uses.end(), [](const EdgeUse& use) { return use.arrives; });
    if (uses.size() == 2 && turn == uses.begin() + 1) {
        link(uses[0], uses[1]);
        return;
    }
    std::array<Uses, 3> leaving = by_kind(without_twins({uses.begin(), turn}));
    std::array<Uses, 3> arriving = by_kind(without_twins({turn, uses.end()}));
    for (std::size_t kind = 0; kind < 3; ++kind)
        pair_up(leaving[kind], arriving[kind]);
    // The two lines serve different triangles: seen from the edge's other end, where leaving is
    // arriving, they come in the other order to the same.
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

}  // namespace relief
