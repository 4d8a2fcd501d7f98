// SPDX-License-Identifier: Apache-2.0
/// \file
/// The manifold surface of a mesh: triangles joined across edges by position, cut where the mesh is
/// not manifold.
///
/// Vertices with equal positions are one. Two triangles are neighbors if they, and no others, run
/// along an edge in opposite directions. At any other edge (three triangles, or two in the same
/// direction) all triangles are cut apart. Fans of triangles that share only a vertex are cut apart
/// too. The result is always a manifold with boundary. The time is linear except for sorting the
/// edges of each vertex.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "geometry/corners.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace relief::detail {

struct Topology {
    std::vector<glm::uvec3> triangles;  ///< Indices of the surface's own vertices.
    /// Index of the mesh triangle for each of `triangles`.
    std::vector<std::uint32_t> source_triangle;
    /// For each vertex, the smallest mesh vertex at its position.
    std::vector<std::uint32_t> position_vertex;
    /// True if other vertices have its position, or if the surface was cut there: they must move
    /// together.
    std::vector<bool> is_cut;
    /// For the edge from corner c to the next corner of its triangle: the corner at which the
    /// neighbor's opposite edge begins, or no_corner at a boundary.
    std::vector<Corner> opposite;
    /// Mesh triangles with a non-finite corner; they are not part of the surface.
    std::vector<std::uint32_t> set_aside;
};

/// \param classes  for each mesh vertex, the smallest vertex with its position (weld.h)
/// \param report   counts collapsed triangles (two corners at one position), which are left out;
///                 triangles set aside; non-manifold edges
/// \param order    the first corners of mesh triangles, in the order of the surface's triangles;
/// the
///                 others are left out. Empty: all triangles of the mesh as they are
Topology topology_of(const Mesh& mesh, std::span<const std::uint32_t> classes, Report& report,
                     std::span<const Corner> order = {});

}  // namespace relief::detail
