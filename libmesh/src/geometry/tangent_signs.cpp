// SPDX-License-Identifier: Apache-2.0
// Triangles without a gradient vote for nothing: they are given a sign first by what groups could
// claim them at their vertices, then from neighbour to neighbour, in rounds.
// Tests: tests/mesh/geometry/tangents_test.cpp.
#include "geometry/tangent_signs.h"

#include <algorithm>

#include "geometry/corner_links.h"
#include "parallel.h"

namespace relief {
namespace {

/// Neighbours across edges at all vertices of triangles without a gradient: for a corner whose
/// triangle goes on from V to W, the corner at V of the neighbour across the edge VW, or no_corner.
std::vector<Corner> corners_across(std::span<const glm::uvec3> triangles,
                                   const CornersByVertex& corners,
                                   std::span<const Gradient> kinds) {
    std::vector<std::uint8_t> concerned(corners.vertex_count(), 0);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        if (kinds[t] != Gradient::none) continue;
        for (int i = 0; i < 3; ++i)
            concerned[triangles[t][i]] = 1;
    }
    std::vector<Corner> across(3 * triangles.size(), no_corner);
    parallel_for(corners.vertex_count(), 1024, [&](std::size_t begin, std::size_t end) {
        CornerLinker linker(triangles, kinds);
        for (std::size_t vertex = begin; vertex < end; ++vertex) {
            if (concerned[vertex] == 0) continue;
            const std::span<const Corner> around = corners.at(vertex);
            linker.link(around);
            for (CornerLinker::Place i = 0; i < around.size(); ++i) {
                if (linker.across(i) != CornerLinker::nowhere)
                    across[around[i]] = around[linker.across(i)];
            }
        }
    });
    return across;
}

class SignFinder {
  public:
    SignFinder(std::span<const Corner> across, std::span<const Gradient> kinds,
               std::vector<std::int8_t>& signs)
        : across_(across), kinds_(kinds), signs_(signs), votes_(signs.size()) {}

    void find() {
        for (Corner corner = 0; corner < 3 * signs_.size(); ++corner) {
            if (is_open(corner) && !is_open(across_previous(corner))) vote_along_chain(corner);
        }
        while (!voted_.empty()) {
            const std::vector<std::uint32_t> elected = elect();
            for (const std::uint32_t triangle : elected) {
                for (Corner corner = 3 * triangle; corner < 3 * triangle + 3; ++corner)
                    vote(across_[corner], signs_[triangle]);
            }
        }
    }

  private:
    struct Votes {
        std::int8_t sum = 0;
        bool any = false;
    };

    /// The corner at the same vertex across the edge on which the triangle arrives at it.
    [[nodiscard]] Corner across_previous(Corner corner) const {
        const Corner beyond = across_[previous_in_triangle(corner)];
        return beyond == no_corner ? no_corner : previous_in_triangle(beyond);
    }

    /// Whether the corner's triangle takes part and has no sign yet.
    [[nodiscard]] bool is_open(Corner corner) const {
        return corner != no_corner && signs_[triangle_of(corner)] == 0 &&
               kinds_[triangle_of(corner)] == Gradient::none;
    }

    [[nodiscard]] std::int8_t sign_at(Corner corner) const {
        return corner == no_corner ? std::int8_t{0} : signs_[triangle_of(corner)];
    }

    void vote(Corner corner, std::int8_t sign) {
        if (!is_open(corner) || sign == 0) return;
        Votes& votes = votes_[triangle_of(corner)];
        if (!votes.any) voted_.push_back(triangle_of(corner));
        votes.any = true;
        votes.sum = static_cast<std::int8_t>(votes.sum + sign);
    }

    /// Around one vertex, the triangles with gradients at both ends of a run of triangles without
    /// vote for all of them.
    void vote_along_chain(Corner first) {
        const std::int8_t before = sign_at(across_previous(first));
        Corner end = first;
        while (is_open(end))
            end = across_[end];
        const std::int8_t after = sign_at(end);
        for (Corner corner = first; corner != end; corner = across_[corner]) {
            vote(corner, before);
            vote(corner, after);
        }
    }

    /// All votes of a round are cast before any counts, so that no order matters.
    std::vector<std::uint32_t> elect() {
        std::vector<std::uint32_t> elected;
        elected.swap(voted_);
        for (const std::uint32_t triangle : elected)
            signs_[triangle] = votes_[triangle].sum >= 0 ? 1 : -1;
        return elected;
    }

    std::span<const Corner> across_;
    std::span<const Gradient> kinds_;
    std::vector<std::int8_t>& signs_;
    std::vector<Votes> votes_;
    std::vector<std::uint32_t> voted_;
};

std::int8_t sign_of(Gradient kind) {
    return static_cast<std::int8_t>(int(kind == Gradient::upright) -
                                    int(kind == Gradient::mirrored));
}

}  // namespace

std::vector<std::int8_t> triangle_signs(std::span<const glm::uvec3> triangles,
                                        const CornersByVertex& corners,
                                        std::span<const Gradient> kinds) {
    std::vector<std::int8_t> signs(kinds.size());
    std::transform(kinds.begin(), kinds.end(), signs.begin(), sign_of);
    if (std::find(kinds.begin(), kinds.end(), Gradient::none) != kinds.end()) {
        const std::vector<Corner> across = corners_across(triangles, corners, kinds);
        SignFinder(across, kinds, signs).find();
    }
    return signs;
}

}  // namespace relief
