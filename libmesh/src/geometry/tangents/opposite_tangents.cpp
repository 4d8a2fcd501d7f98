// SPDX-License-Identifier: Apache-2.0
// Either pair by pair, or by steps: then members with equal steps are summed once, and each member
// takes the sum of all, less those opposite in u, less those opposite in v, plus those opposite in
// both, who were subtracted twice. Tests: tests/mesh/geometry/tangents/opposite_tangents_test.cpp.
#include "geometry/tangents/opposite_tangents.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>

#include "geometry/corner_angle.h"
#include "geometry/direction.h"

namespace relief {
namespace {

constexpr std::size_t most_pairwise = 64;

// A cosine in float is not above -1 from 2.4e-4 radians before the half turn. Hence the steps'
// size.
constexpr std::int32_t steps_around = 1 << 15;

// Keeps the borders between steps away from the axes, where directions like to lie.
constexpr double step_offset = 0.12345;

/// Directions in a plane, counted in steps around a full turn.
class TurnSteps {
  public:
    explicit TurnSteps(const glm::dvec3& normal)
        : x_axis_(normal == glm::dvec3(0.0) ? normal
                                            : glm::dvec3(perpendicular_to(glm::vec3(normal)))),
          y_axis_(glm::cross(normal, x_axis_)) {}

    /// -1 for zero, which opposes nothing.
    [[nodiscard]] std::int32_t of(const glm::dvec3& direction) const {
        const double x = glm::dot(direction, x_axis_);
        const double y = glm::dot(direction, y_axis_);
        if (x == 0.0 && y == 0.0) return -1;
        const double angle = y < 0.0 ? -upper_angle(-y, x) : upper_angle(y, x);
        const double turn = (angle + step_offset) / (2.0 * std::numbers::pi);
        return static_cast<std::int32_t>((turn - std::floor(turn)) * steps_around) % steps_around;
    }

    /// The step half a turn away; -2, which no direction has, for -1.
    static std::int32_t opposite(std::int32_t step) {
        return step < 0 ? -2 : (step + steps_around / 2) % steps_around;
    }

  private:
    glm::dvec3 x_axis_;
    glm::dvec3 y_axis_;
};

struct SteppedTerm {
    VoteSum term;
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
            if (sums_.empty() || sums_.back().first != key) sums_.emplace_back(key, VoteSum{});
            sums_.back().second += member.term;
        }
    }

    [[nodiscard]] VoteSum at(const Key& key) const {
        const auto found =
            std::lower_bound(sums_.begin(), sums_.end(), key,
                             [](const auto& entry, const Key& k) { return entry.first < k; });
        return found != sums_.end() && found->first == key ? found->second : VoteSum{};
    }

  private:
    std::vector<std::pair<Key, VoteSum>> sums_;
};

std::vector<VoteSum> sums_by_steps(std::span<const SteppedTerm> members) {
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
    VoteSum all;
    for (const SteppedTerm& member : sorted)
        all += member.term;

    std::vector<VoteSum> sums;
    sums.reserve(members.size());
    for (const SteppedTerm& member : members) {
        const std::int32_t u = TurnSteps::opposite(member.u_step);
        const std::int32_t v = TurnSteps::opposite(member.v_step);
        VoteSum sum = all;
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

std::vector<VoteSum> sums_by_pairs(std::span<const SidedTerm> members) {
    std::vector<VoteSum> sums;
    for (const SidedTerm& member : members) {
        VoteSum sum;
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

std::vector<VoteSum> sums_without_opposites(std::span<const SidedTerm> members,
                                            const glm::dvec3& normal) {
    if (members.size() <= most_pairwise) return sums_by_pairs(members);
    const TurnSteps turn(normal);
    std::vector<SteppedTerm> stepped;
    stepped.reserve(members.size());
    for (const SidedTerm& m : members)
        stepped.push_back({m.term, turn.of(glm::dvec3(m.along_u)), turn.of(glm::dvec3(m.along_v))});
    return sums_by_steps(stepped);
}

}  // namespace relief
