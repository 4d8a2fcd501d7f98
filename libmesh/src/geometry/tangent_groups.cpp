// SPDX-License-Identifier: Apache-2.0
// Groups of corners that share a tangent, and the sums within them.
//
// Corners at one vertex form a group if their triangles follow each other across edges and have the
// same texture orientation. Every corner has at most one neighbor on each side (tangent_signs.h),
// so a group is a chain or a ring, and walking along it needs neither a stack nor a search. Sums
// are exact (tangent_contributions.h). At most vertices all triangles belong to one group, and no
// walk is needed.
//
// Exactly opposite directions are excluded from a member's sum in one of two ways: pair by pair, or
// by direction. The second way sums members with equal directions once. Each member then takes the
// sum of all, minus those with opposite u, minus those with opposite v, plus those with both
// opposite, which were subtracted twice.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <mutex>
#include <numbers>
#include <numeric>
#include <tuple>

#include "geometry/direction.h"
#include "geometry/gather.h"
#include "geometry/tangent_fans.h"
#include "geometry/tangent_groups.h"
#include "geometry/tangent_signs.h"
#include "parallel.h"
#include "portable_math.h"

namespace relief::detail {
namespace {

constexpr std::size_t max_pairwise = 64;

// In float, a cosine is not above -1 within 2.4e-4 radians of a half turn, which gives the size of
// the steps.
constexpr std::int32_t steps = 1 << 15;

// Offset that keeps the borders between steps away from the axes, where directions are frequent.
constexpr double offset = 0.12345;

/// Directions in a plane, quantized to steps of a turn.
class TurnSteps {
  public:
    explicit TurnSteps(const glm::dvec3& normal)
        : x_axis_(normal == glm::dvec3(0.0) ? normal
                                            : glm::dvec3(perpendicular_to(glm::vec3(normal)))),
          y_axis_(glm::cross(normal, x_axis_)) {}

    /// -1 for zero, which has no opposite.
    [[nodiscard]] std::int32_t of(const glm::dvec3& direction) const {
        const double x = glm::dot(direction, x_axis_);
        const double y = glm::dot(direction, y_axis_);
        if (x == 0.0 && y == 0.0) return -1;
        const double angle = y < 0.0 ? -upper_angle(-y, x) : upper_angle(y, x);
        const double turn = (angle + offset) / (2.0 * std::numbers::pi);
        return static_cast<std::int32_t>((turn - std::floor(turn)) * steps) % steps;
    }

    /// Returns the opposite step; -2, which no direction has, for -1.
    static std::int32_t opposite(std::int32_t step) {
        return step < 0 ? -2 : (step + steps / 2) % steps;
    }

  private:
    glm::dvec3 x_axis_;
    glm::dvec3 y_axis_;
};

struct SteppedTerm {
    TangentSum term;
    std::int32_t u_step;
    std::int32_t v_step;
};

/// Sums by key, in ascending order of keys.
template <typename Key>
class SumsByKey {
  public:
    /// \param members  in ascending order of `key_of(member)`
    template <typename KeyOf>
    SumsByKey(std::span<const SteppedTerm> members, const KeyOf& key_of) {
        for (const SteppedTerm& member : members) {
            const Key key = key_of(member);
            if (sums_.empty() || sums_.back().first != key) sums_.emplace_back(key, TangentSum{});
            sums_.back().second += member.term;
        }
    }

    [[nodiscard]] TangentSum at(const Key& key) const {
        const auto found =
            std::lower_bound(sums_.begin(), sums_.end(), key,
                             [](const auto& entry, const Key& k) { return entry.first < k; });
        return found != sums_.end() && found->first == key ? found->second : TangentSum{};
    }

  private:
    std::vector<std::pair<Key, TangentSum>> sums_;
};

std::vector<TangentSum> sums_by_steps(std::span<const SteppedTerm> members) {
    const auto u_of = [](const SteppedTerm& m) { return m.u_step; };
    const auto v_of = [](const SteppedTerm& m) { return m.v_step; };
    const auto uv_of = [](const SteppedTerm& m) { return std::pair(m.u_step, m.v_step); };
    std::vector<SteppedTerm> sorted(members.begin(), members.end());
    std::sort(sorted.begin(), sorted.end(),
              [&](const SteppedTerm& a, const SteppedTerm& b) { return uv_of(a) < uv_of(b); });
    const SumsByKey<std::int32_t> by_u(sorted, u_of);
    const SumsByKey<std::pair<std::int32_t, std::int32_t>> by_both(sorted, uv_of);
    std::sort(sorted.begin(), sorted.end(),
              [&](const SteppedTerm& a, const SteppedTerm& b) { return v_of(a) < v_of(b); });
    const SumsByKey<std::int32_t> by_v(sorted, v_of);
    TangentSum all;
    for (const SteppedTerm& member : sorted)
        all += member.term;

    std::vector<TangentSum> sums;
    sums.reserve(members.size());
    for (const SteppedTerm& member : members) {
        const std::int32_t u = TurnSteps::opposite(member.u_step);
        const std::int32_t v = TurnSteps::opposite(member.v_step);
        TangentSum sum = all;
        sum -= by_u.at(u);
        sum -= by_v.at(v);
        sum += by_both.at({u, v});
        sums.push_back(sum);
    }
    return sums;
}

bool are_opposite(const SidedTerm& a, const SidedTerm& b) {
    return glm::dot(a.along_u, b.along_u) <= -1.0F || glm::dot(a.along_v, b.along_v) <= -1.0F;
}

std::vector<TangentSum> sums_by_pairs(std::span<const SidedTerm> members) {
    std::vector<TangentSum> sums;
    for (const SidedTerm& member : members) {
        TangentSum sum;
        for (const SidedTerm& other : members) {
            if (!are_opposite(member, other)) sum += other.term;
        }
        sums.push_back(sum);
    }
    return sums;
}

}  // namespace

glm::vec3 float_direction_in_plane(const glm::vec3& vector, const glm::vec3& normal) {
    const glm::vec3 projected = vector - glm::dot(normal, vector) * normal;
    const float length = glm::length(projected);
    return length > 0.0F ? 1.0F / length * projected : glm::vec3(0.0F);
}

std::vector<TangentSum> sums_without_opposites(std::span<const SidedTerm> members,
                                               const glm::dvec3& normal) {
    if (members.size() <= max_pairwise) return sums_by_pairs(members);
    const TurnSteps turn(normal);
    std::vector<SteppedTerm> stepped;
    stepped.reserve(members.size());
    for (const SidedTerm& m : members)
        stepped.push_back({m.term, turn.of(glm::dvec3(m.along_u)), turn.of(glm::dvec3(m.along_v))});
    return sums_by_steps(stepped);
}

namespace {

// A sum shorter than this fraction of the sum of lengths has no direction beyond the precision of
// the triangles' floats.
constexpr double cancelled_tangents = 1e-6;

/// Averages the groups at one vertex at a time. Reuses its buffers.
class GroupAverager {
  public:
    GroupAverager(const GroupInput& input, std::span<glm::vec4> corners, GroupFindings& findings)
        : input_(input),
          corners_(corners),
          findings_(findings),
          linker_(input.mesh, input.gradients.kinds),
          fans_(corners, input.mesh.triangles) {}

    void average_at(std::size_t vertex) {
        const std::span<const Corner> around = input_.corners.at(vertex);
        if (around.empty()) return;
        plane_ = TangentPlane(input_.mesh.normals[vertex]);
        glm::vec4 tangent;
        if (!fans_.average(around, plane_, tangent)) return average_carefully(around);
        for (const Corner corner : around)
            corners_[corner] = tangent;
    }

  private:
    /// Handles any case: finds groups by walking from neighbor to neighbor.
    [[gnu::noinline]] void average_carefully(std::span<const Corner> around) {
        around_ = around;
        linker_.link(around);
        contributions_.clear();
        for (const Corner corner : around)
            contributions_.push_back(contribution_at(corners_, corner));
        tangents_.assign(around.size(), glm::vec4(0.0F));
        is_open_.assign(around.size(), 1);
        for (Place place = 0; place < around.size(); ++place) {
            if (linker_.twin(place) != place) {
                is_open_[place] = 0;
                note_repeated(place);
            } else if (contributions_[place].side == 0 &&
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

    /// Records each duplicate triangle once, at its smallest vertex.
    void note_repeated(Place place) {
        const glm::uvec3& corners = input_.mesh.triangles[triangle(place)];
        const std::uint32_t here = vertex_of(around_[place], input_.mesh.triangles);
        if (here == std::min({corners.x, corners.y, corners.z}))
            findings_.repeated.push_back({triangle(place), triangle(linker_.twin(place))});
    }

    /// The neighbor on one side if it belongs to the same group.
    [[nodiscard]] Place in_group(Place neighbor, Place place) const {
        return neighbor != CornerLinker::nowhere && sign(neighbor) == sign(place)
                   ? neighbor
                   : CornerLinker::nowhere;
    }

    /// Corners of the group of `place`, in order around the vertex.
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

    /// Corners of one handedness.
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
            if (contributions_[place].side == 0) continue;
            highest = std::max(highest, int(contributions_[place].exponent));
            ++count;
        }
        if (count == 0) return;
        const ContributionScale scale(highest, count);
        TangentSum all;
        for (const Place place : group_) {
            if (contributions_[place].side != 0) all += scale.scaled(contributions_[place]);
        }
        const std::vector<TangentSum> parted =
            input_.groups == TangentGroups::connected && can_oppose() ? parted_sums(scale)
                                                                      : std::vector<TangentSum>();
        std::size_t member = 0;
        for (const Place place : group_) {
            const bool has_contribution = contributions_[place].side != 0;
            settle(place, has_contribution && !parted.empty() ? parted[member] : all);
            member += has_contribution ? 1 : 0;
        }
    }

    /// Assigns the direction of a sum to a corner, or the direction of its own triangle if the sum
    /// cancels.
    void settle(Place place, const TangentSum& sum) {
        const CornerContribution& contribution = contributions_[place];
        const bool cancels = sum.cancels(cancelled_tangents);
        if (cancels) findings_.cancelled.push_back(around_[place]);
        if (cancels && contribution.side == 0) return;
        const glm::dvec3 used =
            cancels ? glm::dvec3(contribution.x, contribution.y, contribution.z) : sum.vector();
        tangents_[place] = glm::vec4(plane_.tangent_along(used), float(sign(place)));
    }

    /// Texture directions of the group's corners with contributions, in float precision.
    void collect_axes() {
        const glm::vec3 normal = float_normal();
        axes_.clear();
        for (const Place place : group_) {
            if (contributions_[place].side == 0) continue;
            const TriangleGradient gradient =
                triangle_gradient(input_.mesh.positions, input_.mesh.texcoords,
                                  input_.mesh.triangles[triangle(place)]);
            axes_.push_back({{},
                             float_direction_in_plane(gradient.along_u, normal),
                             float_direction_in_plane(gradient.along_v, normal)});
        }
    }

    /// Tests whether two members can be opposite. This is impossible if all are clearly on one side
    /// of the first.
    [[nodiscard]] bool can_oppose() {
        collect_axes();
        constexpr float beside = 0.01F;
        return std::any_of(axes_.begin(), axes_.end(), [&](const SidedTerm& member) {
            return !(glm::dot(axes_[0].along_u, member.along_u) > beside &&
                     glm::dot(axes_[0].along_v, member.along_v) > beside);
        });
    }

    [[nodiscard]] std::vector<TangentSum> parted_sums(const ContributionScale& scale) {
        auto member = axes_.begin();
        for (const Place place : group_) {
            if (contributions_[place].side != 0)
                (member++)->term = scale.scaled(contributions_[place]);
        }
        return sums_without_opposites(axes_, plane_.normal());
    }

    /// Returns the given normal bit by bit if it has unit length within float precision.
    [[nodiscard]] glm::vec3 float_normal() const {
        const glm::vec3 given = input_.mesh.normals[vertex_of(around_[0], input_.mesh.triangles)];
        return std::abs(glm::length(glm::dvec3(given)) - 1.0) < 1e-6 ? given
                                                                     : glm::vec3(plane_.normal());
    }

    const GroupInput& input_;
    std::span<glm::vec4> corners_;
    GroupFindings& findings_;
    CornerLinker linker_;
    FanAverager fans_;
    TangentPlane plane_;
    std::span<const Corner> around_;
    std::vector<CornerContribution> contributions_;
    std::vector<glm::vec4> tangents_;
    std::vector<std::uint8_t> is_open_;
    std::vector<Place> group_;
    std::vector<SidedTerm> axes_;
};

// The same loop with and without three-operand instructions.
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

}  // namespace relief::detail
