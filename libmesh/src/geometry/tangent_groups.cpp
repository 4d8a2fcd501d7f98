// SPDX-License-Identifier: Apache-2.0
// Corners at one vertex form a group when their triangles follow each other across edges and their
// textures run the same way. As every corner has at most one neighbour to each side
// (corner_links.h), a group is a chain or a ring, and walking along it needs neither a stack nor a
// search. Tests: tests/mesh/geometry/tangents_test.cpp.
#include "geometry/tangent_groups.h"

#include <numbers>

#include "geometry/direction.h"
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
    /// The triangle's tangent in the plane of the vertex normal.
    [[nodiscard]] glm::dvec3 own_tangent(Corner corner) const {
        const std::uint32_t triangle = triangle_of(corner);
        return direction_in_plane(glm::dvec3(input_.gradients.along_u[triangle]), normal_);
    }

    void settle(Corner corner, const glm::dvec3& tangent) {
        if (tangent == glm::dvec3(0.0)) return;
        result_.values[corner] =
            glm::vec4(rounded(tangent), static_cast<float>(signs_[triangle_of(corner)]));
    }

    void settle_group() {
        terms_.clear();
        for (const Corner corner : group_) {
            if (has_gradient(input_.gradients.kinds[triangle_of(corner)])) {
                terms_.push_back(seen_angle(corner, normal_, input_) * own_tangent(corner));
            }
        }
        if (terms_.empty()) return;
        const StableSum sum = stable_sum(terms_);
        const bool agreed = !sum.cancels(cancelled);
        const glm::dvec3 tangent = direction_or_zero(in_plane(sum.vector, normal_));
        for (const Corner corner : group_) {
            result_.states[corner] = agreed ? CornerState::agreed : CornerState::cancelled;
            settle(corner, agreed ? tangent : own_tangent(corner));
        }
    }

    const TangentInput& input_;
    std::span<const std::int8_t> signs_;
    CornerTangents& result_;
    glm::dvec3 normal_{0.0};
    std::vector<Corner> group_;
    std::vector<glm::dvec3> terms_;
};

/// Signs of triangles that border on one with a sign, round by round.
class SignSpreader {
  public:
    SignSpreader(const TangentInput& input, std::vector<std::int8_t>& signs)
        : input_(input),
          signs_(signs),
          offers_(signs.size(), 0),
          is_offered_(signs.size(), false) {}

    /// Offers the triangle's sign to its neighbours without one.
    void offer_from(std::uint32_t triangle) {
        for (std::uint32_t i = 0; i < 3; ++i) {
            const Corner beyond = input_.links.across[3 * triangle + i];
            if (beyond == no_corner) continue;
            const std::uint32_t neighbour = triangle_of(beyond);
            if (signs_[neighbour] != 0) continue;
            if (!is_offered_[neighbour]) offered_.push_back(neighbour);
            is_offered_[neighbour] = true;
            offers_[neighbour] = static_cast<std::int8_t>(offers_[neighbour] + signs_[triangle]);
        }
    }

    /// All offers of a round are made before any is taken, so that no order matters.
    void spread() {
        std::vector<std::uint32_t> taken;
        while (!offered_.empty()) {
            taken.swap(offered_);
            offered_.clear();
            for (const std::uint32_t triangle : taken)
                signs_[triangle] = offers_[triangle] >= 0 ? 1 : -1;
            for (const std::uint32_t triangle : taken)
                offer_from(triangle);
        }
    }

  private:
    const TangentInput& input_;
    std::vector<std::int8_t>& signs_;
    std::vector<std::int8_t> offers_;  ///< The sum over the neighbours that have a sign.
    std::vector<bool> is_offered_;
    std::vector<std::uint32_t> offered_;
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
    if (all) return signs;
    SignSpreader spreader(input, signs);
    for (std::uint32_t t = 0; t < kinds.size(); ++t) {
        if (has_gradient(kinds[t])) spreader.offer_from(t);
    }
    spreader.spread();
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
