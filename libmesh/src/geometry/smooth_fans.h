// SPDX-License-Identifier: Apache-2.0
/// \file
/// Groups of corners at a position whose triangles are joined by smooth edges.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "relief/mesh/buffers.h"
#include "relief/mesh/normals.h"

namespace relief::detail {

/// Fans of corners. Fan indices have no meaning.
struct SmoothFans {
    std::vector<std::uint32_t> fan_of_corner;  ///< Three per triangle.
    std::size_t count = 0;
};

/// A mesh with the positions at which its vertices are welded.
struct FanInput {
    StridedSpan<const glm::vec3> positions;
    TriangleSpan triangles;
    std::span<const glm::uvec3> welded;  ///< The triangles with the indices of welded vertices.
    std::span<const glm::vec3> normals;  ///< One unit normal per triangle, or zero.
    /// For each triangle, the smallest one at its positions (triangle_stacks.h), and whether
    /// triangles of both windings are there. Empty if none is doubled.
    std::span<const std::uint32_t> stacks{};
    std::span<const std::uint8_t> doubled{};
    /// True if all corners at a position belong to one fan unless a triangle there is doubled.
    bool joins_positions = false;
};

/// Corners at one position belong to one fan if smooth edges from that position (see HardEdges)
/// join their triangles, directly or through other triangles. Triangles that share only the
/// position belong to different fans (a bow-tie, the tips of two cones).
///
/// At an edge of three or more triangles, two of them are joined if the angle between their normals
/// is within the limit, directly or through other triangles at the edge. The normals of neighbors
/// with inconsistent winding are opposite, so the edge between them counts as hard.
///
/// At an edge of doubled triangles, triangles that run along it in opposite directions are joined,
/// the flattest pair first (edge_pairs.h), if the angle between them is within the limit. The two
/// sides of a doubled triangle are never joined, so each sheet of a doubled wall has its own fans.
///
/// Triangles without a normal (zero) join no others. If the corners of one are at three positions,
/// on a line, the triangles along its longest side and along its other sides share an edge at both
/// ends of the longest side. The corners of all triangles without a normal at one position form a
/// fan of their own.
SmoothFans smooth_fans(const FanInput& input, const HardEdges& hard_edges);

/// Computes normals like corner_normals(), but averages all triangles at a position that has no
/// doubled triangle, like vertex_normals().
CornerNormals side_normals(StridedSpan<const glm::vec3> positions, TriangleSpan triangles,
                           std::optional<NormalWeight> weight, const NormalOptions& options,
                           Report& report);

}  // namespace relief::detail
