// SPDX-License-Identifier: Apache-2.0
/// \file
/// The surface that a repair works on, and the steps of the repair.
///
/// Positions and faces are in an order of their values, so that no result depends on the order of
/// the mesh.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

#include "geometry/corners.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/repair.h"
#include "relief/mesh/report.h"

namespace relief::detail {

constexpr std::uint32_t no_position = std::numeric_limits<std::uint32_t>::max();

struct RepairFace {
    glm::uvec3 positions;  ///< The smallest one is first.
    std::uint32_t triangle;
    std::uint32_t first_corner;  ///< That of the triangle with the first position, 0 to 2.
    /// The triangle of the other side that follows this one; no_position: none.
    std::uint32_t back = no_position;

    [[nodiscard]] bool has_back() const { return back != no_position; }
};

/// The triangles at an edge that are more than two.
struct CrowdedEdge {
    std::uint32_t begin;  ///< In RepairSurface::crowd.
    std::uint32_t end;
};

struct RepairSurface {
    std::vector<glm::vec3> positions;        ///< Ascending.
    std::vector<std::uint32_t> position_of;  ///< By vertex of the mesh; no_position: not finite.
    std::vector<RepairFace> faces;           ///< In an order of their positions.
    std::vector<std::uint32_t> set_aside;    ///< Triangles that stay as they are.
    std::vector<Corner> opposite;            ///< By corner of a face, as in topology.h.
    std::vector<Corner> crowd;               ///< The edges of crowded edges.
    std::vector<CrowdedEdge> crowded;
    std::vector<std::uint8_t> is_flipped;  ///< By face.
    std::vector<std::uint32_t> part_of;    ///< By face: the number of its part.
    std::uint32_t parts = 0;

    [[nodiscard]] std::uint32_t position_at(Corner corner) const {
        return faces[corner / 3].positions[static_cast<glm::length_t>(corner % 3)];
    }
    [[nodiscard]] glm::dvec3 point(std::uint32_t position) const {
        return glm::dvec3(positions[position]);
    }
    /// Returns whether the triangle of a face is reversed. One with a back has both windings.
    [[nodiscard]] bool is_reversed(std::size_t face) const {
        return is_flipped[face] != 0 && !faces[face].has_back();
    }
    /// Returns whether two faces run along their common edge in the same direction as they are now.
    [[nodiscard]] bool is_twisted(Corner a, Corner b) const {
        return (position_at(a) == position_at(b)) != (is_flipped[a / 3] != is_flipped[b / 3]);
    }
    void cut(Corner corner) {
        const Corner other = opposite[corner];
        if (other == no_corner) return;
        opposite[corner] = no_corner;
        opposite[other] = no_corner;
    }
};

/// Welds the positions, and gathers the triangles that stay as faces.
RepairSurface repair_surface(const Mesh& mesh, const RepairOptions& options, Report& report);

/// Joins the faces at each edge.
void join_faces(RepairSurface& surface, const RepairOptions& options, Report& report);

/// Finds the parts, orients them if `orient` is set, and removes small ones.
void orient_parts(RepairSurface& surface, const RepairOptions& options, Report& report);

/// Cuts crowded edges whose triangles are in the same fans at both ends, although they are not
/// joined, and joins those that are at one edge of the separated fans. Returns whether edges
/// were cut.
bool cut_pinched_edges(RepairSurface& surface);

/// Moves fans at one position apart.
/// \return by corner of a face, the number of its fan: equal for all corners that stay together
std::vector<std::uint32_t> separate_fans(RepairSurface& surface,
                                         std::vector<glm::vec3>& position_of_fan, Report& report);

}  // namespace relief::detail
