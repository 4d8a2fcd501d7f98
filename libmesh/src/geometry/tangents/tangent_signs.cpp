// SPDX-License-Identifier: Apache-2.0
// Triangles without a gradient vote for nothing: they are given a sign first by what groups could
// claim them at their vertices, then from neighbour to neighbour, in rounds.
// Tests: tests/mesh/geometry/tangents/tangents_test.cpp.
#include "geometry/tangents/tangent_signs.h"

#include <algorithm>
#include <limits>

#include "geometry/tangents/corner_links.h"
#include "parallel.h"

namespace relief {
namespace {

/// The triangles without a gradient that take part, and who is beyond their edges.
class OpenTriangles {
  public:
    OpenTriangles(std::span<const glm::uvec3> triangles, const CornersByVertex& corners,
                  const TriangleGradients& gradients) {
        for (const std::uint32_t triangle : gradients.without) {
            if (gradients.kinds[triangle] == Gradient::none) triangles_.push_back(triangle);
        }
        across_.assign(3 * triangles_.size(), no_corner);
        link(triangles, corners, gradients.kinds);
    }

    static constexpr std::size_t not_open = std::numeric_limits<std::size_t>::max();

    [[nodiscard]] std::size_t count() const { return triangles_.size(); }
    [[nodiscard]] std::uint32_t triangle(std::size_t place) const { return triangles_[place]; }

    /// Its place among the open ones, or not_open.
    [[nodiscard]] std::size_t place_of(std::uint32_t triangle) const {
        const auto found = std::lower_bound(triangles_.begin(), triangles_.end(), triangle);
        if (found == triangles_.end() || *found != triangle) return not_open;
        return static_cast<std::size_t>(found - triangles_.begin());
    }

    /// Of a corner of an open triangle that goes on from V to W: the corner at V of the neighbour
    /// across the edge VW, or no_corner.
    [[nodiscard]] Corner across(std::size_t place, Corner corner) const {
        return across_[3 * place + corner % 3];
    }

  private:
    /// Looks around every vertex of the open triangles.
    void link(std::span<const glm::uvec3> triangles, const CornersByVertex& corners,
              std::span<const Gradient> kinds) {
        std::vector<std::uint32_t> vertices;
        for (const std::uint32_t triangle : triangles_) {
            for (int i = 0; i < 3; ++i)
                vertices.push_back(triangles[triangle][i]);
        }
        std::sort(vertices.begin(), vertices.end());
        vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
        parallel_for(vertices.size(), 512, [&](std::size_t begin, std::size_t end) {
            CornerLinker linker(triangles, kinds);
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
        : open_(open), signs_(signs), votes_(open.count()) {}

    void find() {
        for (std::size_t place = 0; place < open_.count(); ++place) {
            const Corner first = 3 * open_.triangle(place);
            for (Corner corner = first; corner < first + 3; ++corner) {
                if (!is_open(across_previous(place, corner))) vote_along_chain(place, corner);
            }
        }
        while (!voted_.empty()) {
            const std::vector<std::size_t> elected = elect();
            for (const std::size_t place : elected) {
                const std::uint32_t triangle = open_.triangle(place);
                for (Corner corner = 3 * triangle; corner < 3 * triangle + 3; ++corner)
                    vote(open_.across(place, corner), signs_[triangle]);
            }
        }
    }

  private:
    struct Votes {
        std::int8_t sum = 0;
        bool any = false;
    };

    /// The corner at the same vertex across the edge on which the triangle arrives at it.
    [[nodiscard]] Corner across_previous(std::size_t place, Corner corner) const {
        const Corner beyond = open_.across(place, previous_in_triangle(corner));
        return beyond == no_corner ? no_corner : previous_in_triangle(beyond);
    }

    /// Whether the corner's triangle takes part and has no sign yet.
    [[nodiscard]] bool is_open(Corner corner) const {
        return corner != no_corner && signs_[triangle_of(corner)] == 0 &&
               open_.place_of(triangle_of(corner)) != OpenTriangles::not_open;
    }

    [[nodiscard]] std::int8_t sign_at(Corner corner) const {
        return corner == no_corner ? std::int8_t{0} : signs_[triangle_of(corner)];
    }

    void vote(Corner corner, std::int8_t sign) {
        if (!is_open(corner) || sign == 0) return;
        const std::size_t place = open_.place_of(triangle_of(corner));
        Votes& votes = votes_[place];
        if (!votes.any) voted_.push_back(place);
        votes.any = true;
        votes.sum = static_cast<std::int8_t>(votes.sum + sign);
    }

    /// Around one vertex, the triangles with gradients at both ends of a run of triangles without
    /// vote for all of them.
    void vote_along_chain(std::size_t place, Corner first) {
        const auto next = [&](Corner corner) {
            return open_.across(open_.place_of(triangle_of(corner)), corner);
        };
        const std::int8_t before = sign_at(across_previous(place, first));
        Corner end = first;
        while (is_open(end))
            end = next(end);
        const std::int8_t after = sign_at(end);
        for (Corner corner = first; corner != end; corner = next(corner)) {
            vote(corner, before);
            vote(corner, after);
        }
    }

    /// All votes of a round are cast before any counts, so that no order matters.
    std::vector<std::size_t> elect() {
        std::vector<std::size_t> elected;
        elected.swap(voted_);
        for (const std::size_t place : elected)
            signs_[open_.triangle(place)] = votes_[place].sum >= 0 ? 1 : -1;
        return elected;
    }

    const OpenTriangles& open_;
    std::vector<std::int8_t>& signs_;
    std::vector<Votes> votes_;
    std::vector<std::size_t> voted_;  ///< Places of open triangles.
};

}  // namespace

TriangleSigns triangle_signs(std::span<const glm::uvec3> triangles, const CornersByVertex& corners,
                             const TriangleGradients& gradients) {
    const std::vector<Gradient>& kinds = gradients.kinds;
    if (std::none_of(gradients.without.begin(), gradients.without.end(),
                     [&](std::uint32_t triangle) { return kinds[triangle] == Gradient::none; }))
        return {kinds, {}};
    std::vector<std::int8_t> signs(kinds.size());
    std::transform(kinds.begin(), kinds.end(), signs.begin(), sign_of);
    const OpenTriangles open(triangles, corners, gradients);
    SignFinder(open, signs).find();
    return {kinds, std::move(signs)};
}

}  // namespace relief
