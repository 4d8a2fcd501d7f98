// SPDX-License-Identifier: Apache-2.0
// Every edge is looked at from its smaller vertex, where all its triangles meet; so no table of
// edges is needed, and no edge is seen twice.
//
// An edge with one triangle in each direction makes them neighbours. Where there are more (the
// reference implementation then takes them in the order of the list, so that its answer depends on
// that), triangles whose textures run the same way are paired first, those with the smaller third
// vertices with each other; what is left over is paired with triangles without a gradient, which
// can join either kind. Identical triangles count once.
// Tests: tests/mesh/geometry/corner_links_test.cpp.
#include "geometry/corner_links.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>

#include "parallel.h"

namespace relief {
namespace {

/// A triangle at an edge, seen from the edge's smaller vertex.
struct EdgeUse {
    std::uint32_t other_vertex;  ///< The edge's larger vertex.
    bool arrives;                ///< The triangle runs towards the smaller vertex.
    Gradient kind;
    std::uint32_t third_vertex;
    int rotation;   ///< Which corner of the triangle stands at its smallest vertex.
    Corner corner;  ///< Of the triangle at the edge's smaller vertex.

    [[nodiscard]] auto rank() const {
        return std::tuple(other_vertex, arrives, kind, third_vertex);
    }
    friend bool operator<(const EdgeUse& a, const EdgeUse& b) {
        return std::tuple(a.rank(), a.rotation, a.corner) <
               std::tuple(b.rank(), b.rotation, b.corner);
    }
};

using Uses = std::span<EdgeUse>;

/// All uses of the edges from `vertex` to larger vertices, sorted: edge by edge, leaving triangles
/// before arriving ones, and so on.
void collect(std::uint32_t vertex, std::span<const glm::uvec3> triangles,
             std::span<const Corner> around, std::span<const Gradient> kinds,
             std::vector<EdgeUse>& uses) {
    uses.clear();
    for (const Corner corner : around) {
        const std::uint32_t next = vertex_of(next_in_triangle(corner), triangles);
        const std::uint32_t previous = vertex_of(previous_in_triangle(corner), triangles);
        const Gradient kind = kinds[triangle_of(corner)];
        const auto rotation = [&](std::uint32_t third, Corner third_corner) {
            return static_cast<int>((third < vertex ? third_corner : corner) % 3);
        };
        if (next > vertex) {
            uses.push_back({next, false, kind, previous,
                            rotation(previous, previous_in_triangle(corner)), corner});
        }
        if (previous > vertex) {
            uses.push_back(
                {previous, true, kind, next, rotation(next, next_in_triangle(corner)), corner});
        }
    }
    std::sort(uses.begin(), uses.end());
}

void link(const EdgeUse& leaving, const EdgeUse& arriving, CornerLinks& links) {
    links.across[leaving.corner] = arriving.corner;
    links.across[previous_in_triangle(arriving.corner)] = next_in_triangle(leaving.corner);
}

/// Drops all but the first of identical triangles, and notes it as their twin. Each triangle is
/// noted once, at the edge that leaves its smallest vertex.
Uses without_twins(Uses uses, std::uint32_t vertex, CornerLinks& links) {
    auto kept = uses.begin();
    for (auto use = uses.begin(); use != uses.end(); ++use) {
        if (kept != uses.begin() && std::prev(kept)->rank() == use->rank()) {
            if (!use->arrives && use->third_vertex > vertex) {
                links.twin[triangle_of(use->corner)] = triangle_of(std::prev(kept)->corner);
            }
            continue;
        }
        *kept++ = *use;
    }
    return {uses.begin(), kept};
}

/// Makes neighbours of as many as there are on both sides, and leaves the rest.
void pair_up(Uses& leaving, Uses& arriving, CornerLinks& links) {
    const std::size_t pairs = std::min(leaving.size(), arriving.size());
    for (std::size_t i = 0; i < pairs; ++i)
        link(leaving[i], arriving[i], links);
    leaving = leaving.subspan(pairs);
    arriving = arriving.subspan(pairs);
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

/// Finds the neighbours at one edge.
void link_edge(Uses uses, std::uint32_t vertex, CornerLinks& links) {
    const auto turn =
        std::find_if(uses.begin(), uses.end(), [](const EdgeUse& use) { return use.arrives; });
    if (uses.size() == 2 && turn == uses.begin() + 1) {
        link(uses[0], uses[1], links);
        return;
    }
    std::array<Uses, 3> leaving = by_kind(without_twins({uses.begin(), turn}, vertex, links));
    std::array<Uses, 3> arriving = by_kind(without_twins({turn, uses.end()}, vertex, links));
    for (std::size_t kind = 0; kind < 3; ++kind)
        pair_up(leaving[kind], arriving[kind], links);
    for (std::size_t kind = 0; kind < 2; ++kind) {
        pair_up(leaving[kind], arriving[2], links);
        pair_up(leaving[2], arriving[kind], links);
    }
}

}  // namespace

CornerLinks link_corners(std::span<const glm::uvec3> triangles, const CornersByVertex& corners,
                         std::span<const Gradient> kinds) {
    CornerLinks links{std::vector<Corner>(3 * triangles.size(), no_corner),
                      std::vector<std::uint32_t>(triangles.size())};
    std::iota(links.twin.begin(), links.twin.end(), 0U);
    parallel_for(corners.vertex_count(), 4096, [&](std::size_t begin, std::size_t end) {
        std::vector<EdgeUse> uses;
        for (std::size_t v = begin; v < end; ++v) {
            const auto vertex = static_cast<std::uint32_t>(v);
            collect(vertex, triangles, corners.at(v), kinds, uses);
            for (auto first = uses.begin(); first != uses.end();) {
                const auto last = std::find_if(first, uses.end(), [&](const EdgeUse& use) {
                    return use.other_vertex != first->other_vertex;
                });
                link_edge({first, last}, vertex, links);
                first = last;
            }
        }
    });
    return links;
}

}  // namespace relief
