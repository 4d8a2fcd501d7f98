// SPDX-License-Identifier: Apache-2.0
// Corners at one vertex form a group when their triangles follow each other across edges and their
// textures run the same way. As every corner has at most one neighbour to each side
// (corner_links.h), a group is a chain or a ring, and walking along it needs neither a stack nor a
// search. Tests: tests/mesh/geometry/tangents_test.cpp.
#include "geometry/tangent_groups.h"

#include <algorithm>
#include <numbers>

#include "geometry/direction.h"
#include "geometry/opposite_tangents.h"
#include "parallel.h"

namespace relief {
namespace {

// What is left of a vector in the plane of the normal when it is less than this part of the vector
// is rounding of the normal's floats, not a direction.
constexpr double out_of_plane = 1e-6;

// Tangents that cancel to less than this part of their sum say nothing: the triangles' own floats
// are not better.
constexpr double cancelled = 1e-6;

/// The direction that a vector has in the plane of the normal; zero where it has none.
glm::dvec3 direction_in_plane(const glm::dvec3& vector, const glm::dvec3& normal) {
    const glm::dvec3 projected = in_plane(vector, normal);
    return glm::length(projected) > out_of_plane * glm::length(vector)
               ? direction_or_zero(projected)
               : glm::dvec3(0.0);
}

/// The angle of the corner as the normal sees it. An edge along the normal points nowhere in its
/// plane; the reference implementation counts such a corner as a right angle.
double seen_angle(Corner corner, const glm::dvec3& normal, const TangentInput& input) {
    const auto position = [&](Corner c) {
        return glm::dvec3(input.positions[vertex_of(c, input.triangles)]);
    };
    const glm::dvec3 here = position(corner);
    const glm::dvec3 a = direction_in_plane(position(next_in_triangle(corner)) - here, normal);
    const glm::dvec3 b = direction_in_plane(position(previous_in_triangle(corner)) - here, normal);
    if (a == glm::dvec3(0.0) || b == glm::dvec3(0.0)) return std::numbers::pi / 2.0;
    return angle_between(a, b);
}

/// The neighbour to one side that belongs to the same group.
Corner in_group(Corner neighbour, Corner corner, std::span<const std::int8_t> signs) {
    return neighbour != no_corner && signs[triangle_of(neighbour)] == signs[triangle_of(corner)]
               ? neighbour
               : no_corner;
}

/// All corners of the group of `corner`, in the order in which they lie around the vertex.
void walk_group(Corner corner, const CornerLinks& links, std::span<const std::int8_t> signs,
                std::vector<Corner>& group) {
    Corner first = corner;
    for (;;) {
        const Corner before = in_group(links.across_previous(first), first, signs);
        if (before == no_corner) break;
        first = before;
        if (first == corner) break;  // A ring.
    }
    group.clear();
    Corner current = first;
    do {
        group.push_back(current);
        current = in_group(links.across[current], current, signs);
    } while (current != no_corner && current != first);
}

/// Averages groups at one vertex after another; keeps its buffers.
class GroupAverager {
  public:
    GroupAverager(const TangentInput& input, std::span<const std::int8_t> signs,
                  CornerTangents& result)
        : input_(input), signs_(signs), result_(result) {}

    /// All groups at one vertex.
    void average_at(std::size_t vertex) {
        normal_ = direction_or_zero(glm::dvec3(input_.normals[vertex]));
        for (const Corner corner : input_.corners.at(vertex)) {
            const std::uint32_t triangle = triangle_of(corner);
            if (signs_[triangle] == 0 || input_.links.twin[triangle] != triangle) continue;
            if (result_.states[corner] != CornerState::open) continue;
            walk_group(corner, input_.links, signs_, group_);
            settle_group();
        }
    }

  private:
    /// A corner whose triangle has a gradient, and its texture directions in the normal's plane.
    struct Member {
        glm::dvec3 along_u;
        glm::dvec3 along_v;
        double angle;
        std::uint32_t triangle;
    };

    void settle(Corner corner, const glm::dvec3& tangent, CornerState state) {
        result_.states[corner] = state;
        if (tangent == glm::dvec3(0.0)) return;
        result_.values[corner] =
            glm::vec4(rounded(tangent), static_cast<float>(signs_[triangle_of(corner)]));
    }

    /// Gives a corner the direction of a sum, or if that cancels its own triangle's.
    void settle(Corner corner, const StableSum& sum, const glm::dvec3& own) {
        if (sum.cancels(cancelled)) {
            settle(corner, own, CornerState::cancelled);
        } else {
            settle(corner, direction_or_zero(in_plane(sum.vector, normal_)), CornerState::agreed);
        }
    }

    void settle_group() {
        collect_members();
        if (members_.empty()) return;
        terms_.clear();
        for (const Member& member : members_)
            terms_.push_back(member.angle * member.along_u);
        const StableSum all = stable_sum(terms_);
        const std::vector<StableSum> parted =
            can_oppose() ? parted_sums() : std::vector<StableSum>();
        std::size_t member = 0;
        for (const Corner corner : group_) {
            if (!has_gradient(input_.gradients.kinds[triangle_of(corner)])) {
                settle(corner, all, glm::dvec3(0.0));
                continue;
            }
            settle(corner, parted.empty() ? all : parted[member], members_[member].along_u);
            ++member;
        }
    }

    void collect_members() {
        members_.clear();
        for (const Corner corner : group_) {
            const std::uint32_t triangle = triangle_of(corner);
            if (!has_gradient(input_.gradients.kinds[triangle])) continue;
            members_.push_back(
                {direction_in_plane(glm::dvec3(input_.gradients.along_u[triangle]), normal_),
                 direction_in_plane(glm::dvec3(input_.gradients.along_v[triangle]), normal_),
                 seen_angle(corner, normal_, input_), triangle});
        }
    }

    /// Whether any two members can be opposite. Not if all are on one side of the first.
    [[nodiscard]] bool can_oppose() const {
        const Member& first = members_.front();
        return std::any_of(members_.begin(), members_.end(), [&](const Member& member) {
            return !(glm::dot(first.along_u, member.along_u) > 0.0 &&
                     glm::dot(first.along_v, member.along_v) > 0.0);
        });
    }

    [[nodiscard]] std::vector<StableSum> parted_sums() const {
        const glm::vec3 normal = float_normal();
        std::vector<SidedTerm> sided;
        sided.reserve(members_.size());
        for (const Member& member : members_) {
            const TriangleGradients& gradients = input_.gradients;
            sided.push_back({member.angle * member.along_u,
                             float_direction_in_plane(gradients.along_u[member.triangle], normal),
                             float_direction_in_plane(gradients.along_v[member.triangle], normal)});
        }
        return sums_without_opposites(sided, normal_);
    }

    /// The normal as it was given where that is unit as far as float can be, to the last bit.
    [[nodiscard]] glm::vec3 float_normal() const {
        const glm::vec3 given = input_.normals[vertex_of(group_.front(), input_.triangles)];
        return std::abs(glm::length(glm::dvec3(given)) - 1.0) < 1e-6 ? given : glm::vec3(normal_);
    }

    const TangentInput& input_;
    std::span<const std::int8_t> signs_;
    CornerTangents& result_;
    glm::dvec3 normal_{0.0};
    std::vector<Corner> group_;
    std::vector<Member> members_;
    std::vector<glm::dvec3> terms_;
};

/// Finds signs for triangles without a gradient: first by what groups could claim them at their
/// vertices, then from neighbour to neighbour.
class SignFinder {
  public:
    SignFinder(const TangentInput& input, std::vector<std::int8_t>& signs)
        : input_(input), signs_(signs), votes_(signs.size()) {}

    void find() {
        for (Corner corner = 0; corner < 3 * signs_.size(); ++corner) {
            if (is_open(corner) && !is_open(input_.links.across_previous(corner))) {
                vote_along_chain(corner);
            }
        }
        while (!voted_.empty()) {
            const std::vector<std::uint32_t> elected = elect();
            for (const std::uint32_t triangle : elected) {
                for (Corner corner = 3 * triangle; corner < 3 * triangle + 3; ++corner)
                    vote(input_.links.across[corner], signs_[triangle]);
            }
        }
    }

  private:
    struct Votes {
        std::int8_t sum = 0;
        bool any = false;
    };

    /// Whether the corner's triangle takes part and has no sign yet.
    [[nodiscard]] bool is_open(Corner corner) const {
        return corner != no_corner && signs_[triangle_of(corner)] == 0 &&
               input_.gradients.kinds[triangle_of(corner)] == Gradient::none;
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
        const std::int8_t before = sign_at(input_.links.across_previous(first));
        Corner end = first;
        while (is_open(end))
            end = input_.links.across[end];
        const std::int8_t after = sign_at(end);
        for (Corner corner = first; corner != end; corner = input_.links.across[corner]) {
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

    const TangentInput& input_;
    std::vector<std::int8_t>& signs_;
    std::vector<Votes> votes_;
    std::vector<std::uint32_t> voted_;
};

}  // namespace

std::vector<std::int8_t> triangle_signs(const TangentInput& input) {
    const std::vector<Gradient>& kinds = input.gradients.kinds;
    std::vector<std::int8_t> signs(kinds.size(), 0);
    bool all = true;
    for (std::size_t t = 0; t < kinds.size(); ++t) {
        if (has_gradient(kinds[t])) signs[t] = kinds[t] == Gradient::upright ? 1 : -1;
        all = all && signs[t] != 0;
    }
    if (!all) SignFinder(input, signs).find();
    return signs;
}

CornerTangents grouped_tangents(const TangentInput& input, std::span<const std::int8_t> signs) {
    CornerTangents result{std::vector<glm::vec4>(3 * input.triangles.size(), glm::vec4(0.0F)),
                          std::vector<CornerState>(3 * input.triangles.size())};
    parallel_for(input.corners.vertex_count(), 2048, [&](std::size_t begin, std::size_t end) {
        GroupAverager averager(input, signs, result);
        for (std::size_t vertex = begin; vertex < end; ++vertex)
            averager.average_at(vertex);
    });
    return result;
}

}  // namespace relief
