// SPDX-License-Identifier: Apache-2.0
// Separates the fans of triangles that meet at one position, so that every position belongs to one
// fan. Tests: tests/mesh/topology/repair_test.cpp.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "geometry/direction.h"
#include "geometry/weld.h"
#include "progress_stage.h"
#include "topology/repair_parts.h"

namespace relief::detail {
namespace {

/// Returns for each corner the smallest corner of its fan.
std::vector<std::uint32_t> fans_of(const RepairSurface& surface) {
    DisjointSets fans(surface.opposite.size());
    for (Corner corner = 0; corner < surface.opposite.size(); ++corner) {
        check_cancelled(corner);
        const Corner other = surface.opposite[corner];
        if (other == no_corner || other < corner) continue;
        const bool is_same = surface.position_at(corner) == surface.position_at(other);
        fans.join(corner, is_same ? other : next_in_triangle(other));
        fans.join(next_in_triangle(corner), is_same ? next_in_triangle(other) : other);
    }
    std::vector<std::uint32_t> result(surface.opposite.size());
    for (Corner corner = 0; corner < result.size(); ++corner)
        result[corner] = fans.find(corner);
    return result;
}

/// A corner at which an edge begins, and the fans at the smaller and the larger end of the edge.
struct EdgeFans {
    std::pair<std::uint32_t, std::uint32_t> fans;
    Corner corner;
};

EdgeFans edge_fans(const RepairSurface& surface, std::span<const std::uint32_t> fans,
                   Corner corner) {
    const Corner next = next_in_triangle(corner);
    const bool ascends = surface.position_at(corner) < surface.position_at(next);
    return {{fans[ascends ? corner : next], fans[ascends ? next : corner]}, corner};
}

/// Returns the edges that are joined once, and the others, sorted by their fans.
std::vector<EdgeFans> sorted_fans(const RepairSurface& surface, std::span<const std::uint32_t> fans,
                                  const CrowdedEdge& edge) {
    std::vector<EdgeFans> all;
    for (std::uint32_t i = edge.begin; i < edge.end; ++i) {
        const Corner corner = surface.crowd[i];
        const Corner other = surface.opposite[corner];
        if (other == no_corner || corner < other) all.push_back(edge_fans(surface, fans, corner));
    }
    std::sort(all.begin(), all.end(), [](const EdgeFans& a, const EdgeFans& b) {
        return a.fans != b.fans ? a.fans < b.fans : a.corner < b.corner;
    });
    return all;
}

/// The distance by which fans are moved apart.
double gap_of(const RepairSurface& surface) {
    glm::vec3 low(std::numeric_limits<float>::infinity());
    glm::vec3 high(-std::numeric_limits<float>::infinity());
    for (const RepairFace& face : surface.faces) {
        for (glm::length_t i = 0; i < 3; ++i) {
            low = glm::min(low, surface.positions[face.positions[i]]);
            high = glm::max(high, surface.positions[face.positions[i]]);
        }
    }
    const glm::dvec3 size = glm::dvec3(high) - glm::dvec3(low);
    const double longest = std::max({size.x, size.y, size.z});
    const glm::vec3 far = glm::max(glm::abs(low), glm::abs(high));
    const float largest = std::max({far.x, far.y, far.z});
    const double spacing = std::ldexp(1.0, std::max(std::ilogb(largest) - 23, -149));
    return std::max(std::ldexp(1.0, std::ilogb(longest) + 1 - 20), 16.0 * spacing);
}

/// Returns the direction into the triangles of a fan, or its normal if the fan is closed.
/// \param corners  all of the fan, ascending
glm::dvec3 direction_of(const RepairSurface& surface, std::span<const Corner> corners) {
    glm::dvec3 inside(0.0);
    glm::dvec3 normal(0.0);
    bool is_closed = true;
    for (const Corner corner : corners) {
        const Corner next = next_in_triangle(corner);
        const Corner previous = previous_in_triangle(corner);
        const glm::dvec3 here = surface.point(surface.position_at(corner));
        const glm::dvec3 a = direction_or_zero(surface.point(surface.position_at(next)) - here);
        const glm::dvec3 b = direction_or_zero(surface.point(surface.position_at(previous)) - here);
        inside += a + b;
        const glm::dvec3 across = glm::cross(a, b);
        normal += surface.is_flipped[corner / 3] != 0 ? -across : across;
        is_closed = is_closed && surface.opposite[corner] != no_corner &&
                    surface.opposite[previous] != no_corner;
    }
    const glm::dvec3 first = direction_or_zero(is_closed ? normal : inside);
    if (first != glm::dvec3(0.0)) return first;
    const glm::dvec3 second = direction_or_zero(is_closed ? inside : normal);
    return second != glm::dvec3(0.0) ? second : glm::dvec3(0.0, 0.0, 1.0);
}

}  // namespace

bool cut_pinched_edges(RepairSurface& surface) {
    if (surface.crowded.empty()) return false;
    const std::vector<std::uint32_t> before = fans_of(surface);
    std::vector<CrowdedEdge> cut;
    for (const CrowdedEdge& edge : surface.crowded) {
        const std::vector<EdgeFans> ends = sorted_fans(surface, before, edge);
        const bool is_pinched =
            std::adjacent_find(ends.begin(), ends.end(), [](const auto& a, const auto& b) {
                return a.fans == b.fans;
            }) != ends.end();
        if (!is_pinched) continue;
        for (std::uint32_t i = edge.begin; i < edge.end; ++i)
            surface.cut(surface.crowd[i]);
        cut.push_back(edge);
    }
    if (cut.empty()) return false;
    // Each piece of a fan has now at most two triangles at the edge, in opposite directions.
    const std::vector<std::uint32_t> after = fans_of(surface);
    for (const CrowdedEdge& edge : cut) {
        const std::vector<EdgeFans> ends = sorted_fans(surface, after, edge);
        for (std::size_t i = 1; i < ends.size(); ++i) {
            if (ends[i - 1].fans != ends[i].fans) continue;
            surface.opposite[ends[i - 1].corner] = ends[i].corner;
            surface.opposite[ends[i].corner] = ends[i - 1].corner;
        }
    }
    return true;
}

std::vector<std::uint32_t> separate_fans(RepairSurface& surface,
                                         std::vector<glm::vec3>& position_of_fan, Report& report) {
    const std::vector<std::uint32_t> fans = fans_of(surface);
    // The corners by position and fan.
    std::vector<Corner> order(fans.size());
    std::iota(order.begin(), order.end(), 0U);
    std::vector<std::uint32_t> first_fan(surface.positions.size(), no_corner);
    for (const Corner corner : order)
        first_fan[surface.position_at(corner)] =
            std::min(first_fan[surface.position_at(corner)], fans[corner]);
    std::erase_if(order, [&](Corner corner) {
        return first_fan[surface.position_at(corner)] == fans[corner];
    });
    std::sort(order.begin(), order.end(), [&](Corner a, Corner b) {
        const std::uint32_t left = surface.position_at(a);
        const std::uint32_t right = surface.position_at(b);
        if (left != right) return left < right;
        return fans[a] != fans[b] ? fans[a] < fans[b] : a < b;
    });
    // Fans are numbered like the positions; the others follow.
    position_of_fan = surface.positions;
    const double gap = order.empty() ? 0.0 : gap_of(surface);
    std::vector<std::uint32_t> result(fans.size());
    for (Corner corner = 0; corner < fans.size(); ++corner)
        result[corner] = surface.position_at(corner);
    double step = 0.0;
    for (std::size_t begin = 0; begin < order.size();) {
        std::size_t end = begin;
        while (end < order.size() && fans[order[end]] == fans[order[begin]])
            ++end;
        const std::uint32_t position = surface.position_at(order[begin]);
        const bool is_next = begin > 0 && surface.position_at(order[begin - 1]) == position;
        step = is_next ? step + gap : gap;
        const std::span<const Corner> corners(order.data() + begin, end - begin);
        const auto fan = static_cast<std::uint32_t>(position_of_fan.size());
        constexpr double most = std::numeric_limits<float>::max();
        const glm::dvec3 moved = surface.point(position) + step * direction_of(surface, corners);
        position_of_fan.push_back(rounded(glm::clamp(moved, -most, most)));
        std::uint32_t triangle = no_position;
        for (const Corner corner : corners) {
            result[corner] = fan;
            triangle = std::min(triangle, surface.faces[corner / 3].triangle);
        }
        report.add("triangles that meet others only at a position", "fan", triangle,
                   "get a vertex of their own, a little away");
        begin = end;
    }
    return result;
}

}  // namespace relief::detail
