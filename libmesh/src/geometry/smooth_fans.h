// SPDX-License-Identifier: Apache-2.0
/// \file
/// Groups of corners at a position whose triangles are joined by smooth edges.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
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
};

/// Corners at one position belong to one fan if smooth edges from that position (see HardEdges)
/// join their triangles, directly or through other triangles. Triangles that share only the
/// position belong to different fans (a bow-tie, the tips of two cones).
///
/// At an edge of three or more triangles, two of them are joined if the angle between their normals
/// is within the limit, directly or through other triangles at the edge. The normals of neighbors
/// with inconsistent winding are opposite, so the edge between them counts as hard.
///
/// Triangles without a normal (zero) join no others. If the corners of one are at three positions,
/// on a line, the triangles along its longest side and along its other sides share an edge at both
/// ends of the longest side. The corners of all triangles without a normal at one position form a
/// fan of their own.
SmoothFans smooth_fans(const FanInput& input, const HardEdges& hard_edges);

}  // namespace relief::detail
