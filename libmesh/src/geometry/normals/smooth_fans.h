// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which corners at a position belong together: those of triangles joined by smooth edges.
/// Tests: tests/mesh/geometry/normals/corner_normals_test.cpp.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "relief/mesh/normals.h"

namespace relief {

/// Corners in groups; which number a group has means nothing.
struct SmoothFans {
    std::vector<std::uint32_t> fan_of_corner;  ///< Three to a triangle.
    std::size_t count = 0;
};

/// Corners at one position are in one fan if their triangles are joined, also by way of others, by
/// edges from that position that are smooth (HardEdges says which are). Triangles that only touch
/// in the position are in different fans (a bow-tie, the tips of two cones).
///
/// At an edge of three and more triangles, two are joined if their normals are within the angle of
/// each other, also by way of others there. Where neighbours are wound in opposite ways their
/// normals are opposite, and the edge is as hard as any.
///
/// Triangles without a normal are looked through: they join nothing that their neighbours on either
/// side would not, and go with one of those.
///
/// \param triangles  over positions: vertices at the same place have the same index
/// \param normals    unit, one for each triangle; zero where it has none
SmoothFans smooth_fans(std::size_t position_count, std::span<const glm::uvec3> triangles,
                       std::span<const glm::vec3> normals, const HardEdges& hard_edges);

}  // namespace relief
