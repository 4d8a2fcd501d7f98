// SPDX-License-Identifier: Apache-2.0
/// \file
/// A surface (topology.h) as a mesh of OpenMesh's. With topology_decimation.cpp and
/// topology_subdivision.cpp, this is all that knows OpenMesh.
///
/// Half-edges are linked one by one instead of face by face: OpenMesh's add_face refuses some
/// orders of faces and says so on stderr; what topology_of made has no case to refuse. Vertices and
/// faces keep their numbers. Linear. Tests: tests/mesh/geometry/topology/topology_test.cpp.
#pragma once

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "geometry/topology/topology.h"

namespace relief {

struct SurfaceTraits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    using Normal = OpenMesh::Vec3d;
};
using SurfaceMesh = OpenMesh::TriMesh_ArrayKernelT<SurfaceTraits>;

/// \param points  one for each vertex of the topology
/// \param edges   if not null, gets the number of the OpenMesh edge from each corner to the next
void build(SurfaceMesh& mesh, const Topology& topology, std::span<const glm::dvec3> points,
           std::vector<std::uint32_t>* edges = nullptr);

}  // namespace relief
