// SPDX-License-Identifier: Apache-2.0
/// \file
/// Groups of corners at a position whose triangles are joined by smooth edges.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "relief/mesh/normals.h"

namespace relief {

/// Fans of corners. Fan indices have no meaning.
struct SmoothFans {
    std::vector<std::uint32_t> fan_of_corner;  ///< Three per triangle.
    std::size_t count = 0;
};

/// Corners at one position belong to one fan if smooth edges from that position (see HardEdges)
/// join their triangles, directly or through other triangles. Triangles that share only the
/// position belong to different fans (a bow-tie, the tips of two cones).
///
/// At an edge of three or more triangles, two of them are joined if the angle between their normals
/// is within the limit, directly or through other triangles at the edge. The normals of neighbors
/// with inconsistent winding are opposite, so the edge between them counts as hard.
///
/// Triangles without a normal do not join neighbors that would not be joined without them. They
/// belong to the fan of one of their neighbors.
///
/// \param triangles  indices of positions: vertices at the same position have the same index
/// \param normals    one unit normal per triangle; zero for a triangle without a normal
SmoothFans smooth_fans(std::size_t position_count, std::span<const glm::uvec3> triangles,
                       std::span<const glm::vec3> normals, const HardEdges& hard_edges);

}  // namespace relief
