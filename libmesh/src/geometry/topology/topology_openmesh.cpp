// SPDX-License-Identifier: Apache-2.0
#include "geometry/topology/topology_openmesh.h"

namespace relief {
namespace {

using Halfedge = SurfaceMesh::HalfedgeHandle;
using Vertex = SurfaceMesh::VertexHandle;

Vertex vertex_at(const Topology& topology, Corner corner) {
    return Vertex(static_cast<int>(vertex_of(corner, topology.triangles)));
}

/// One edge for each pair of opposite corners, or for each corner at a boundary.
std::vector<Halfedge> add_edges(SurfaceMesh& mesh, const Topology& topology) {
    std::vector<Halfedge> halfedges(topology.opposite.size());
    for (Corner corner = 0; corner < halfedges.size(); ++corner) {
        const Corner beyond = topology.opposite[corner];
        if (beyond != no_corner && beyond < corner) continue;
        halfedges[corner] = mesh.new_edge(vertex_at(topology, corner),
                                          vertex_at(topology, next_in_triangle(corner)));
        if (beyond != no_corner)
            halfedges[beyond] = mesh.opposite_halfedge_handle(halfedges[corner]);
    }
    return halfedges;
}

void add_faces(SurfaceMesh& mesh, const Topology& topology,
               const std::vector<Halfedge>& halfedges) {
    for (std::size_t t = 0; t < topology.triangles.size(); ++t) {
        const SurfaceMesh::FaceHandle face = mesh.new_face();
        const auto first = static_cast<Corner>(3 * t);
        mesh.set_halfedge_handle(face, halfedges[first]);
        for (Corner corner = first; corner < first + 3; ++corner) {
            mesh.set_face_handle(halfedges[corner], face);
            mesh.set_next_halfedge_handle(halfedges[corner], halfedges[next_in_triangle(corner)]);
            mesh.set_halfedge_handle(vertex_at(topology, corner), halfedges[corner]);
        }
    }
}

/// The outer sides of boundary edges, joined around each hole; a boundary vertex begins with its
/// own, as OpenMesh asks.
void link_boundaries(SurfaceMesh& mesh, const Topology& topology,
                     const std::vector<Halfedge>& halfedges) {
    for (Corner corner = 0; corner < halfedges.size(); ++corner) {
        if (topology.opposite[corner] != no_corner) continue;
        // Around the vertex at which the outer side arrives, to the edge where its fan ends.
        Corner arriving = previous_in_triangle(corner);
        while (topology.opposite[arriving] != no_corner)
            arriving = previous_in_triangle(topology.opposite[arriving]);
        const Halfedge next = mesh.opposite_halfedge_handle(halfedges[arriving]);
        mesh.set_next_halfedge_handle(mesh.opposite_halfedge_handle(halfedges[corner]), next);
        mesh.set_halfedge_handle(vertex_at(topology, corner), next);
    }
}

}  // namespace

void build(SurfaceMesh& mesh, const Topology& topology, std::span<const glm::dvec3> points,
           std::vector<std::uint32_t>* edges) {
    mesh.reserve(points.size(), 3 * topology.triangles.size() / 2 + 1, topology.triangles.size());
    for (const glm::dvec3& point : points)
        mesh.new_vertex({point.x, point.y, point.z});
    const std::vector<Halfedge> halfedges = add_edges(mesh, topology);
    add_faces(mesh, topology, halfedges);
    link_boundaries(mesh, topology, halfedges);
    if (edges == nullptr) return;
    edges->clear();
    for (const Halfedge halfedge : halfedges)
        edges->push_back(static_cast<std::uint32_t>(mesh.edge_handle(halfedge).idx()));
}

}  // namespace relief
