// SPDX-License-Identifier: Apache-2.0
// The parts of a surface: gives all triangles of a part one winding, orients closed parts outwards,
// and removes small parts. Tests: tests/mesh/topology/repair_test.cpp.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <numeric>
#include <vector>

#include "progress_stage.h"
#include "topology/column_hits.h"
#include "topology/repair_parts.h"

namespace relief::detail {
namespace {

constexpr double infinite_length = std::numeric_limits<double>::infinity();

struct RepairPart {
    std::size_t first = 0;  ///< In PartOrder::faces.
    std::size_t count = 0;
    double area = 0.0;  ///< Of the faces without a back.
    double flipped_area = 0.0;
    double volume = 0.0;  ///< Six times the signed volume, with the winding of its faces now.
    bool is_closed = true;
    glm::dvec3 low{infinite_length};
    glm::dvec3 high{-infinite_length};

    [[nodiscard]] double diagonal() const { return glm::length(high - low); }
};

/// The faces by part, and in the order of their breadth-first search.
struct PartOrder {
    std::vector<std::uint32_t> faces;
    std::vector<RepairPart> parts;
};

/// Searches the parts and sets `is_flipped` so that joined faces have one winding.
PartOrder find_parts(RepairSurface& surface) {
    PartOrder order;
    order.faces.reserve(surface.faces.size());
    surface.part_of.assign(surface.faces.size(), no_position);
    for (std::uint32_t start = 0; start < surface.faces.size(); ++start) {
        if (surface.part_of[start] != no_position) continue;
        const auto part = static_cast<std::uint32_t>(order.parts.size());
        const std::size_t first = order.faces.size();
        surface.part_of[start] = part;
        order.faces.push_back(start);
        for (std::size_t i = first; i < order.faces.size(); ++i) {
            check_cancelled(i);
            const std::uint32_t face = order.faces[i];
            for (Corner corner = 3 * face; corner < 3 * face + 3; ++corner) {
                const Corner other = surface.opposite[corner];
                if (other == no_corner || surface.part_of[other / 3] != no_position) continue;
                surface.part_of[other / 3] = part;
                if (surface.is_twisted(corner, other)) surface.is_flipped[other / 3] ^= 1;
                order.faces.push_back(other / 3);
            }
        }
        RepairPart& found = order.parts.emplace_back();
        found.first = first;
        found.count = order.faces.size() - first;
    }
    surface.parts = static_cast<std::uint32_t>(order.parts.size());
    return order;
}

/// Cuts the edges at which a part has two windings. Returns whether there are any.
bool cut_twisted_edges(RepairSurface& surface, Report& report) {
    bool is_cut = false;
    for (Corner corner = 0; corner < surface.opposite.size(); ++corner) {
        const Corner other = surface.opposite[corner];
        if (other == no_corner || !surface.is_twisted(corner, other)) continue;
        report.add("edge of a part that has no consistent winding", "edge",
                   std::min(surface.faces[corner / 3].triangle, surface.faces[other / 3].triangle),
                   "is cut");
        surface.cut(corner);
        is_cut = true;
    }
    return is_cut;
}

void measure(const RepairSurface& surface, const PartOrder& order, RepairPart& part) {
    const glm::dvec3 origin = surface.point(surface.position_at(3 * order.faces[part.first]));
    for (std::size_t i = part.first; i < part.first + part.count; ++i) {
        const std::uint32_t face = order.faces[i];
        const glm::uvec3& p = surface.faces[face].positions;
        const glm::dvec3 a = surface.point(p.x);
        const glm::dvec3 b = surface.point(p.y);
        const glm::dvec3 c = surface.point(p.z);
        const double area = glm::length(glm::cross(b - a, c - a));
        const double volume = glm::dot(a - origin, glm::cross(b - origin, c - origin));
        if (!surface.faces[face].has_back()) part.area += area;
        if (surface.is_reversed(face)) part.flipped_area += area;
        part.volume += surface.is_flipped[face] != 0 ? -volume : volume;
        part.low = glm::min(part.low, glm::min(a, glm::min(b, c)));
        part.high = glm::max(part.high, glm::max(a, glm::max(b, c)));
        for (Corner corner = 3 * face; corner < 3 * face + 3; ++corner)
            part.is_closed = part.is_closed && surface.opposite[corner] != no_corner;
    }
}

void flip(RepairSurface& surface, const PartOrder& order, RepairPart& part) {
    for (std::size_t i = part.first; i < part.first + part.count; ++i)
        surface.is_flipped[order.faces[i]] ^= 1;
    part.flipped_area = part.area - part.flipped_area;
    part.volume = -part.volume;
}

/// Finds closed parts that are inside of others, with a limit of the work.
class Nesting {
  public:
    Nesting(const RepairSurface& surface, const PartOrder& order)
        : surface_(surface), order_(order) {}

    /// Returns whether a part is inside of an odd number of other closed parts: whether a line from
    /// one of its positions leaves them an odd number of times.
    [[nodiscard]] bool is_inside(std::size_t index) {
        const RepairPart& part = order_.parts[index];
        const glm::dvec3 p = surface_.point(surface_.position_at(3 * order_.faces[part.first]));
        bool is_odd = false;
        for (std::size_t i = 0; i < order_.parts.size(); ++i) {
            const RepairPart& other = order_.parts[i];
            const bool is_around = glm::all(glm::lessThanEqual(other.low, part.low)) &&
                                   glm::all(glm::greaterThanEqual(other.high, part.high));
            if (i == index || !other.is_closed || !is_around) continue;
            work_ += other.count;
            if (work_ > max_work) return false;
            is_odd = is_odd != has_odd_crossings(p, other);
        }
        return is_odd;
    }
    [[nodiscard]] bool has_reached_limit() const { return work_ > max_work; }

  private:
    static constexpr std::size_t max_work = 100'000'000;

    [[nodiscard]] bool has_odd_crossings(const glm::dvec3& p, const RepairPart& part) const {
        bool is_odd = false;
        const auto flat = [](const glm::dvec3& at) { return glm::dvec2(at.y, at.z); };
        for (std::size_t i = part.first; i < part.first + part.count; ++i) {
            const glm::uvec3& corners = surface_.faces[order_.faces[i]].positions;
            const glm::dvec3 a = surface_.point(corners.x);
            const glm::dvec3 b = surface_.point(corners.y);
            const glm::dvec3 c = surface_.point(corners.z);
            if (std::max({a.x, b.x, c.x}) < p.x || !covers(flat(p), flat(a), flat(b), flat(c)))
                continue;
            const glm::dvec3 normal = glm::cross(b - a, c - a);
            // The line meets the plane at p + s * (1, 0, 0).
            const double s = glm::dot(normal, a - p);
            is_odd = is_odd != (normal.x > 0.0 ? s > 0.0 : s < 0.0);
        }
        return is_odd;
    }

    const RepairSurface& surface_;
    const PartOrder& order_;
    std::size_t work_ = 0;
};

void orient_outwards(RepairSurface& surface, PartOrder& order, Report& report) {
    for (RepairPart& part : order.parts) {
        // Ties: the face with the smallest positions keeps its winding.
        if (2.0 * part.flipped_area > part.area) flip(surface, order, part);
    }
    Nesting nesting(surface, order);
    std::vector<std::size_t> inside_out;
    for (std::size_t i = 0; i < order.parts.size(); ++i) {
        const RepairPart& part = order.parts[i];
        if (part.is_closed && part.volume < 0.0 && !nesting.is_inside(i)) inside_out.push_back(i);
    }
    for (const std::size_t i : inside_out)
        flip(surface, order, order.parts[i]);
    if (nesting.has_reached_limit())
        report.add("too many nested parts", "mesh", 0,
                   "cavities are not looked for any more: closed parts are oriented outwards");
    for (std::size_t face = 0; face < surface.faces.size(); ++face) {
        if (surface.is_reversed(face))
            report.add("triangle with the wrong winding", "triangle", surface.faces[face].triangle,
                       "is reversed");
    }
}

/// Removes the faces of parts that are shorter than a length, except for the largest part.
void drop_small_parts(RepairSurface& surface, const PartOrder& order, double length,
                      Report& report) {
    double largest = 0.0;
    for (const RepairPart& part : order.parts)
        largest = std::max(largest, part.diagonal());
    std::vector<std::uint32_t> number(surface.faces.size(), no_position);
    std::vector<RepairFace> kept;
    std::vector<std::uint8_t> flipped;
    std::vector<std::uint32_t> part_of;
    for (std::uint32_t face = 0; face < surface.faces.size(); ++face) {
        const double size = order.parts[surface.part_of[face]].diagonal();
        if (size < length && size < largest) {
            const RepairFace& removed = surface.faces[face];
            report.add("triangle of a small part", "triangle", removed.triangle, "is removed");
            if (removed.has_back())
                report.add("triangle of a small part", "triangle", removed.back, "is removed");
            continue;
        }
        number[face] = static_cast<std::uint32_t>(kept.size());
        kept.push_back(surface.faces[face]);
        flipped.push_back(surface.is_flipped[face]);
        part_of.push_back(surface.part_of[face]);
    }
    const auto moved = [&](Corner corner) {
        return corner == no_corner || number[corner / 3] == no_position
                   ? no_corner
                   : 3 * number[corner / 3] + corner % 3;
    };
    std::vector<Corner> opposite(3 * kept.size(), no_corner);
    for (Corner corner = 0; corner < surface.opposite.size(); ++corner) {
        if (moved(corner) != no_corner) opposite[moved(corner)] = moved(surface.opposite[corner]);
    }
    std::vector<Corner> crowd;
    std::vector<CrowdedEdge> crowded;
    for (const CrowdedEdge& edge : surface.crowded) {
        const auto begin = static_cast<std::uint32_t>(crowd.size());
        for (std::uint32_t i = edge.begin; i < edge.end; ++i) {
            if (moved(surface.crowd[i]) != no_corner) crowd.push_back(moved(surface.crowd[i]));
        }
        crowded.push_back({begin, static_cast<std::uint32_t>(crowd.size())});
    }
    surface.faces = std::move(kept);
    surface.is_flipped = std::move(flipped);
    surface.part_of = std::move(part_of);
    surface.opposite = std::move(opposite);
    surface.crowd = std::move(crowd);
    surface.crowded = std::move(crowded);
}

}  // namespace

void orient_parts(RepairSurface& surface, const RepairOptions& options, Report& report) {
    PartOrder order = find_parts(surface);
    const bool has_cut_twisted = cut_twisted_edges(surface, report);
    const bool has_cut_pinched = options.separate && cut_pinched_edges(surface);
    // Cuts may have divided parts.
    if (has_cut_twisted || has_cut_pinched) order = find_parts(surface);
    for (RepairPart& part : order.parts)
        measure(surface, order, part);
    if (options.orient) orient_outwards(surface, order, report);
    if (options.drop_parts > 0.0) drop_small_parts(surface, order, options.drop_parts, report);
}

}  // namespace relief::detail
