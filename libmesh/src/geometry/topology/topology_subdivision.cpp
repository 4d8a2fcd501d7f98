// SPDX-License-Identifier: Apache-2.0
// OpenMesh's Loop subdivider, run for one level, of which only the points are used: its vertex for
// an edge has the number of the vertices plus that of the edge. Its table of weights has room for
// 50 neighbours and is read beyond its end where a vertex has more, so it is made as long as
// needed. Tests: tests/mesh/geometry/topology/subdivide_test.cpp.
#include "geometry/topology/topology_subdivision.h"

#include <OpenMesh/Tools/Subdivider/Uniform/LoopT.hh>
#include <algorithm>

#include "geometry/topology/topology_openmesh.h"

namespace relief {
namespace {

glm::dvec3 point_of(const SurfaceMesh& mesh, std::size_t vertex) {
    const OpenMesh::Vec3d& p = mesh.point(SurfaceMesh::VertexHandle(static_cast<int>(vertex)));
    return {p[0], p[1], p[2]};
}

std::size_t largest_valence(const Topology& topology) {
    std::vector<std::size_t> valence(topology.position_vertex.size(), 0);
    for (const glm::uvec3& triangle : topology.triangles) {
        for (int i = 0; i < 3; ++i)
            ++valence[triangle[i]];
    }
    return valence.empty() ? 0 : *std::max_element(valence.begin(), valence.end());
}

}  // namespace

LoopPoints loop_points(const Topology& topology, std::span<const glm::dvec3> points) {
    SurfaceMesh mesh;
    std::vector<std::uint32_t> edges;
    build(mesh, topology, points, &edges);
    OpenMesh::Subdivider::Uniform::LoopT<SurfaceMesh> loop;
    loop.init_weights(largest_valence(topology) + 2);
    loop(mesh, 1);

    LoopPoints result;
    for (std::size_t v = 0; v < points.size(); ++v)
        result.at_vertices.push_back(point_of(mesh, v));
    for (const std::uint32_t edge : edges)
        result.on_edges.push_back(point_of(mesh, points.size() + edge));
    return result;
}

}  // namespace relief
