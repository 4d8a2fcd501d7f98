// SPDX-License-Identifier: Apache-2.0
/// \file
/// The surface that a mesh is: triangles joined across edges by position, cut where it is no
/// surface.
///
/// Vertices with equal positions are one. Two triangles are neighbours where they, and no others,
/// run along an edge in opposite directions; at any other edge (three triangles, or two that run
/// the same way) all are cut apart, and so are the fans of triangles that only share a vertex.
/// What is left is a manifold with boundary, whatever the input was. Linear time but for sorting
/// the edges of each vertex. Tests: tests/mesh/geometry/topology/topology_test.cpp.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "geometry/corners.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace relief {

struct Topology {
    std::vector<glm::uvec3> triangles;           ///< Over the surface's own vertices.
    std::vector<std::uint32_t> source_triangle;  ///< The mesh's, for each of `triangles`.
    /// For each vertex, the smallest mesh vertex at its position.
    std::vector<std::uint32_t> position_vertex;
    /// Whether other vertices stand at its position, or the surface was cut there: if it moves,
    /// they must move with it.
    std::vector<bool> is_cut;
    /// The edge from corner c to the next corner of its triangle: the corner at which the
    /// neighbour's same edge, run backwards, begins; no_corner at a boundary.
    std::vector<Corner> opposite;
    /// Triangles of the mesh with a non-finite corner: no part of the surface.
    std::vector<std::uint32_t> set_aside;
};

/// \param classes  for each mesh vertex, the smallest one with its position (weld.h)
/// \param report   counts collapsed triangles (two corners at one position), which are left out;
///                 triangles set aside; non-manifold edges
Topology topology_of(const Mesh& mesh, std::span<const std::uint32_t> classes, Report& report);

}  // namespace relief
