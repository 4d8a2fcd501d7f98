// SPDX-License-Identifier: Apache-2.0
/// \file
/// Meshes whose true normals and tangents are known in closed form.
#pragma once

#include <glm/glm.hpp>
#include <utility>
#include <vector>

#include "relief/mesh/mesh.h"

namespace relief::test {

/// The unit square in the xy plane, facing +z, n x n cells; texture coordinates cover [0,1]^2 with
/// the image upright: u along +x, v down along -y.
Mesh grid(int cells);

/// The unit sphere by longitude and latitude, with a texture seam and poles; normals are the
/// positions, u eastwards, v from the north pole (+y) down.
Mesh sphere(int slices, int stacks);

/// A cube of edge 2 around the origin, 24 vertices: every face has its own, with its own normal and
/// the whole texture upright on it.
Mesh cube();

/// The same triangles, each with vertices of its own; positions, normals and texture coordinates.
Mesh soup(const Mesh& mesh);

/// With nothing but these.
inline Mesh mesh_from(std::vector<glm::vec3> positions, std::vector<glm::uvec3> triangles) {
    Mesh mesh;
    mesh.positions = std::move(positions);
    mesh.triangles = std::move(triangles);
    return mesh;
}

}  // namespace relief::test
