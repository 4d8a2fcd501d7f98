// SPDX-License-Identifier: Apache-2.0
// Corners at one vertex form a group when their triangles follow each other across edges and their
// textures run the same way. As every corner has at most one neighbour to each side
// (corner_links.h), a group is a chain or a ring, and walking along it needs neither a stack nor a
// search. Sums are exact (tangent_votes.h), so that at most vertices, where one fan of triangles
// agrees, there is nothing to walk either: all votes are one group.
// Tests: tests/mesh/geometry/tangents/tangents_test.cpp.
#include "geometry/tangents/tangent_groups.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>

#include "geometry/direction.h"
#include "geometry/tangents/corner_links.h"
#include "geometry/tangents/opposite_tangents.h"
#include "parallel.h"
#include "vector_targets.h"

namespace relief {
namespace {

// Tangents that cancel to less than this part of their sum say nothing: the triangles' own floats
// are not better.
constexpr double cancelled_tangents = 1e-6;

// The square of the cosine of 42 degrees. u directions that are all nearer than this to one of them
// are within 84 degrees of each other; v directions that are not skewed then within 168.
constexpr double near_cosine_squared = 0.553;

/// The plane that a vertex's tangents lie in; all of space where its normal has no direction.
class TangentPlane {
  public:
    TangentPlane() = default;
    explicit TangentPlane(const glm::vec3& normal) : normal_(normal) {
        const double square = glm::dot(normal_, normal_);
        if (square > 0.0 && std::isfinite(square))
            per_square_ = 1.0 / square;
        else
            normal_ = glm::dvec3(0.0);
    }

    /// Unit, or zero.
    [[nodiscard]] glm::dvec3 normal() const { return std::sqrt(per_square_) * normal_; }

    /// The direction that a sum of tangents has in the plane.
    [[nodiscard]] glm::vec3 tangent_along(const glm::dvec3& sum) const {
        const glm::dvec3 projected = sum - (glm::dot(normal_, sum) * per_square_) * normal_;
        const double square = glm::dot(projected, projected);
        return square > 0.0 ? rounded(1.0 / std::sqrt(square) * projected) : glm::vec3(0.0F);
    }

  private:
    glm::dvec3 normal_{0.0};
    double per_square_ = 0.0;
};

/// Averages the groups at one vertex after another; keeps its buffers.
class GroupAverager {
  public:
    GroupAverager(const GroupInput& input, std::span<glm::vec4> corners, GroupFindings& findings)
        : input_(input),
          corners_(corners),
          findings_(findings),
          linker_(input.mesh.triangles, input.gradients.kinds) {}

    void average_at(std::size_t vertex) {
        const std::span<const Corner> around = input_.corners.at(vertex);
        if (around.empty()) return;
        plane_ = TangentPlane(input_.mesh.normals[vertex]);
        if (around.size() > most_at_once || !average_single_fan(around)) average_carefully(around);
    }

  private:
    static constexpr std::size_t most_at_once = 16;

    /// The usual case: one fan, one handedness, all votes near each other. False where it is not.
    bool average_single_fan(std::span<const Corner> around) {
        int highest = std::numeric_limits<int>::min();
        bool usual = true;
        for (std::size_t i = 0; i < around.size(); ++i) {
            const CornerVote vote = vote_at(corners_, around[i]);
            fan_votes_[i] = vote;
            usual &= vote.side != 0 && vote.side == fan_votes_[0].side &&
                     vote.seen == fan_votes_[0].seen && (vote.seen & seen_skewed) == 0;
            highest = std::max(highest, int(vote.exponent));
            const glm::uvec3& triangle = input_.mesh.triangles[triangle_of(around[i])];
            const Corner place = around[i] % 3;
            fan_next_[i] = triangle[static_cast<int>(place == 2 ? 0 : place + 1)];
            fan_previous_[i] = triangle[static_cast<int>(place == 0 ? 2 : place - 1)];
        }
        const std::span votes(fan_votes_.data(), around.size());
        if (!usual || !are_near(votes) ||
            !is_single_fan({fan_next_.data(), around.size()},
                           {fan_previous_.data(), around.size()}))
            return false;
        const VoteScale scale(highest, around.size());
        VoteSum sum;
        for (const CornerVote& vote : votes)
            sum += scale.scaled(vote);
        const glm::vec4 tangent(plane_.tangent_along(sum.vector()), float(votes[0].side));
        for (const Corner corner : around)
            corners_[corner] = tangent;
        return true;
    }

    /// Whether all votes are within 42 degrees of the first.
    static bool are_near(std::span<const CornerVote> votes) {
        const glm::dvec3 first(votes[0].x, votes[0].y, votes[0].z);
        const double first_squared = glm::dot(first, first);
        bool near = true;
        for (const CornerVote& vote : votes) {
            const glm::dvec3 vector(vote.x, vote.y, vote.z);
            const double product = glm::dot(first, vector);
            near &= product > 0.0 && product * product > near_cosine_squared * first_squared *
                                                             glm::dot(vector, vector);
        }
        return near;
    }

    /// Any case: finds groups by walking from neighbour to neighbour.
    [[gnu::noinline]] void average_carefully(std::span<const Corner> around) {
        around_ = around;
        linker_.link(around);
        votes_.clear();
        for (const Corner corner : around)
            votes_.push_back(vote_at(corners_, corner));
        tangents_.assign(around.size(), glm::vec4(0.0F));
        is_open_.assign(around.size(), 1);
        for (Place place = 0; place < around.size(); ++place) {
            if (linker_.twin(place) != place) {
                is_open_[place] = 0;
                note_repeated(place);
            } else if (votes_[place].side == 0 &&
                       has_gradient(input_.gradients.kinds[triangle(place)])) {
                findings_.along_normal.push_back(around[place]);
            }
        }
        for (Place place = 0; place < around.size(); ++place) {
            if (is_open_[place] == 0 || sign(place) == 0) continue;
            if (input_.groups == TangentGroups::connected)
                walk_group(place);
            else
                collect_side(sign(place));
            settle_group();
        }
        for (Place place = 0; place < around.size(); ++place) {
            corners_[around[place]] = tangents_[place];
            findings_.all_settled &= tangents_[place].w != 0.0F;
        }
    }

    using Place = CornerLinker::Place;

    [[nodiscard]] std::uint32_t triangle(Place place) const { return triangle_of(around_[place]); }
    [[nodiscard]] std::int8_t sign(Place place) const { return input_.signs[triangle(place)]; }

    /// Each repeated triangle is noted once, at its smallest vertex.
    void note_repeated(Place place) {
        const glm::uvec3& corners = input_.mesh.triangles[triangle(place)];
        const std::uint32_t here = vertex_of(around_[place], input_.mesh.triangles);
        if (here == std::min({corners.x, corners.y, corners.z}))
            findings_.repeated.push_back({triangle(place), triangle(linker_.twin(place))});
    }

    /// The neighbour to one side that belongs to the same group.
    [[nodiscard]] Place in_group(Place neighbour, Place place) const {
        return neighbour != CornerLinker::nowhere && sign(neighbour) == sign(place)
                   ? neighbour
                   : CornerLinker::nowhere;
    }

    /// All corners of the group of `place`, in the order in which they lie around the vertex.
    void walk_group(Place place) {
        Place first = place;
        for (;;) {
            const Place before = in_group(linker_.across_previous(first), first);
            if (before == CornerLinker::nowhere) break;
            first = before;
            if (first == place) break;  // A ring.
        }
        group_.clear();
        Place current = first;
        do {
            group_.push_back(current);
            current = in_group(linker_.across(current), current);
        } while (current != CornerLinker::nowhere && current != first);
    }

    /// All corners of one handedness.
    void collect_side(std::int8_t side) {
        group_.clear();
        for (Place place = 0; place < around_.size(); ++place) {
            if (is_open_[place] != 0 && sign(place) == side) group_.push_back(place);
        }
    }

    void settle_group() {
        int highest = std::numeric_limits<int>::min();
        std::size_t count = 0;
        for (const Place place : group_) {
            is_open_[place] = 0;
            if (votes_[place].side == 0) continue;
            highest = std::max(highest, int(votes_[place].exponent));
            ++count;
        }
        if (count == 0) return;
        const VoteScale scale(highest, count);
        VoteSum all;
        for (const Place place : group_) {
            if (votes_[place].side != 0) all += scale.scaled(votes_[place]);
        }
        const std::vector<VoteSum> parted =
            input_.groups == TangentGroups::connected && can_oppose() ? parted_sums(scale)
                                                                      : std::vector<VoteSum>();
        std::size_t member = 0;
        for (const Place place : group_) {
            const bool has_vote = votes_[place].side != 0;
            settle(place, has_vote && !parted.empty() ? parted[member] : all);
            member += has_vote ? 1 : 0;
        }
    }

    /// Gives a corner the direction of a sum, or if that cancels its own triangle's.
    void settle(Place place, const VoteSum& sum) {
        const CornerVote& vote = votes_[place];
        const bool cancels = sum.cancels(cancelled_tangents);
        if (cancels) findings_.cancelled.push_back(around_[place]);
        if (cancels && vote.side == 0) return;
        const glm::dvec3 used = cancels ? glm::dvec3(vote.x, vote.y, vote.z) : sum.vector();
        tangents_[place] = glm::vec4(plane_.tangent_along(used), float(sign(place)));
    }

    /// Texture directions of the group's corners that have votes, as float has them.
    void collect_axes() {
        const glm::vec3 normal = float_normal();
        axes_.clear();
        for (const Place place : group_) {
            if (votes_[place].side == 0) continue;
            const TriangleGradient gradient =
                triangle_gradient(input_.mesh.positions, input_.mesh.texcoords,
                                  input_.mesh.triangles[triangle(place)]);
            axes_.push_back({{},
                             float_direction_in_plane(gradient.along_u, normal),
                             float_direction_in_plane(gradient.along_v, normal)});
        }
    }

    /// Whether any two members can be opposite. Not if all are well on one side of the first.
    [[nodiscard]] bool can_oppose() {
        collect_axes();
        constexpr float beside = 0.01F;
        return std::any_of(axes_.begin(), axes_.end(), [&](const SidedTerm& member) {
            return !(glm::dot(axes_[0].along_u, member.along_u) > beside &&
                     glm::dot(axes_[0].along_v, member.along_v) > beside);
        });
    }

    [[nodiscard]] std::vector<VoteSum> parted_sums(const VoteScale& scale) {
        auto member = axes_.begin();
        for (const Place place : group_) {
            if (votes_[place].side != 0) (member++)->term = scale.scaled(votes_[place]);
        }
        return sums_without_opposites(axes_, plane_.normal());
    }

    /// The normal as it was given where that is unit as far as float can be, to the last bit.
    [[nodiscard]] glm::vec3 float_normal() const {
        const glm::vec3 given = input_.mesh.normals[vertex_of(around_[0], input_.mesh.triangles)];
        return std::abs(glm::length(glm::dvec3(given)) - 1.0) < 1e-6 ? given
                                                                     : glm::vec3(plane_.normal());
    }

    const GroupInput& input_;
    std::span<glm::vec4> corners_;
    GroupFindings& findings_;
    CornerLinker linker_;
    TangentPlane plane_;
    std::span<const Corner> around_;
    std::array<CornerVote, most_at_once> fan_votes_;
    std::array<std::uint32_t, most_at_once> fan_next_{};
    std::array<std::uint32_t, most_at_once> fan_previous_{};
    std::vector<CornerVote> votes_;
    std::vector<glm::vec4> tangents_;
    std::vector<std::uint8_t> is_open_;
    std::vector<Place> group_;
    std::vector<SidedTerm> axes_;
};

// The same loop with and without instructions that leave their operands alone.
RELIEF_TARGET_256 [[gnu::flatten]] void average_256(GroupAverager& averager, std::size_t begin,
                                                    std::size_t end) {
    for (std::size_t vertex = begin; vertex < end; ++vertex)
        averager.average_at(vertex);
}
[[gnu::noinline]] void average_any(GroupAverager& averager, std::size_t begin, std::size_t end) {
    for (std::size_t vertex = begin; vertex < end; ++vertex)
        averager.average_at(vertex);
}

template <typename T>
void append(std::vector<T>& all, const std::vector<T>& more) {
    all.insert(all.end(), more.begin(), more.end());
}

}  // namespace

GroupFindings average_groups(const GroupInput& input, std::span<glm::vec4> corners) {
    GroupFindings all;
    std::mutex guard;
    parallel_for(input.corners.vertex_count(), 2048, [&](std::size_t begin, std::size_t end) {
        GroupFindings findings;
        GroupAverager averager(input, corners, findings);
        if (best_vector_target() == VectorTarget::any)
            average_any(averager, begin, end);
        else
            average_256(averager, begin, end);
        const std::scoped_lock lock(guard);
        append(all.cancelled, findings.cancelled);
        append(all.along_normal, findings.along_normal);
        append(all.repeated, findings.repeated);
        all.all_settled &= findings.all_settled;
    });
    std::sort(all.cancelled.begin(), all.cancelled.end());
    std::sort(all.along_normal.begin(), all.along_normal.end());
    std::sort(all.repeated.begin(), all.repeated.end());
    return all;
}

}  // namespace relief
