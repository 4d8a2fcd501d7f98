// SPDX-License-Identifier: Apache-2.0
/// \file
/// Conversion of a surface (topology.h) to an OpenMesh mesh. Only files in topology/ use OpenMesh.
///
/// Half-edges are linked one by one instead of face by face, because OpenMesh's add_face refuses
/// some orders of faces and prints to stderr. Vertices and faces keep their indices. The time is
/// linear.
#pragma once

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "topology/topology.h"

namespace relief {

struct SurfaceTraits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    using Normal = OpenMesh::Vec3d;
};
using SurfaceMesh = OpenMesh::TriMesh_ArrayKernelT<SurfaceTraits>;

/// \param points  one point per vertex of the topology
/// \param edges   if not null, receives the index of the OpenMesh edge from each corner to the next
void build(SurfaceMesh& mesh, const Topology& topology, std::span<const glm::dvec3> points,
           std::vector<std::uint32_t>* edges = nullptr);

}  // namespace relief
