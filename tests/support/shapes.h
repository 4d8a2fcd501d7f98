// SPDX-License-Identifier: Apache-2.0
/// \file
/// Meshes whose exact normals and tangents are known in closed form, and random frames in double.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <utility>
#include <vector>

#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"

namespace relief::test {

/// The unit square in the xy plane, facing +z, of n x n cells. The texture coordinates cover
/// [0,1]^2 with an upright image: u runs along +x, v along -y.
Mesh grid(int cells);

/// The unit sphere by longitude and latitude, with a texture seam and poles. Normals are the
/// positions, u runs eastwards, v from the north pole (+y) down.
Mesh sphere(int slices, int stacks);

/// A cube of edge 2 around the origin with 24 vertices. Every face has its own normal and the whole
/// upright image.
Mesh cube();

/// Returns the same triangles, each with its own vertices, with positions, normals and texture
/// coordinates.
Mesh soup(const Mesh& mesh);

/// Returns a mesh with only positions and triangles.
inline Mesh mesh_from(std::vector<glm::vec3> positions, std::vector<glm::uvec3> triangles) {
    Mesh mesh;
    mesh.positions = std::move(positions);
    mesh.triangles = std::move(triangles);
    return mesh;
}

/// Returns the mesh with tangents at its vertices. Vertices are split if necessary.
Mesh with_tangents(Mesh mesh, TangentMethod mode = TangentMethod::mikktspace);

/// Returns the vertex at a corner of a triangle; triangle t has the corners 3t to 3t + 2.
inline std::uint32_t vertex_at(const Mesh& mesh, std::size_t corner) {
    return mesh.triangles[corner / 3][static_cast<int>(corner % 3)];
}

/// Frames in double, and the same frames rounded to float.
struct ReferenceFrames {
    std::vector<glm::dvec3> normals;
    std::vector<glm::dvec3> tangents;
    std::vector<glm::vec3> float_normals;
    std::vector<glm::vec4> float_tangents;

    void add(const glm::dvec3& normal, const glm::dvec3& tangent, float w);
};

/// Uniformly distributed frames with alternating handedness, the same on every machine.
ReferenceFrames random_frames(std::size_t count);

}  // namespace relief::test
