// SPDX-License-Identifier: Apache-2.0
#include "mesh/peers.h"

#include <algorithm>
#include <memory>

#ifdef RELIEF_HAS_OPENMESH
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#endif
#ifdef RELIEF_HAS_CGAL
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/compute_normal.h>
#include <CGAL/Surface_mesh.h>
#endif

namespace relief::bench {
namespace {

#ifdef RELIEF_HAS_OPENMESH
/// update_normals() computes face normals, then vertex normals with uniform weights. The half-edges
/// are part of the setup.
Peer open_mesh(const Mesh& mesh) {
    using Halfedges = OpenMesh::TriMesh_ArrayKernelT<>;
    const auto peer = std::make_shared<Halfedges>();
    std::vector<OpenMesh::VertexHandle> handles;
    for (const glm::vec3& p : mesh.positions)
        handles.push_back(peer->add_vertex({p.x, p.y, p.z}));
    for (const glm::uvec3& t : mesh.triangles)
        peer->add_face(handles[t.x], handles[t.y], handles[t.z]);
    peer->request_face_normals();
    peer->request_vertex_normals();
    return {"OpenMesh update_normals, uniform", [peer] { peer->update_normals(); }};
}
#endif

#ifdef RELIEF_HAS_CGAL
Peer cgal(const Mesh& mesh) {
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
    const auto peer = std::make_shared<Surface>();
    std::vector<Surface::Vertex_index> handles;
    for (const glm::vec3& p : mesh.positions)
        handles.push_back(peer->add_vertex({p.x, p.y, p.z}));
    for (const glm::uvec3& t : mesh.triangles)
        peer->add_face(handles[t.x], handles[t.y], handles[t.z]);
    auto normals = peer->add_property_map<Surface::Vertex_index, Kernel::Vector_3>("v:n").first;
    return {"CGAL compute_vertex_normals", [peer, normals] {
                CGAL::Polygon_mesh_processing::compute_vertex_normals(*peer, normals);
            }};
}
#endif

}  // namespace

std::vector<Peer> normal_peers([[maybe_unused]] const Mesh& mesh) {
    std::vector<Peer> peers;
#ifdef RELIEF_HAS_OPENMESH
    peers.push_back(open_mesh(mesh));
#endif
#ifdef RELIEF_HAS_CGAL
    peers.push_back(cgal(mesh));
#endif
    return peers;
}

}  // namespace relief::bench
