// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the rows about tangents share: textured meshes, and looking at corners.
#pragma once

#include <cstdint>
#include <vector>

#include "hard_cases/mesh_case.h"

namespace relief::test {

/// A torus of 576 triangles with a texture seam.
Mesh textured_torus();

/// 4 x 4 flat cells facing +z, the image upright.
Mesh textured_grid();

/// A wavy grid whose texture coordinates are multiples of 1/16.
Mesh coarsely_textured();

/// By this method; findings are discarded.
std::vector<glm::vec4> tangents_of(const Mesh& mesh, const TangentMethod& method);

std::uint32_t vertex_at(const Mesh& mesh, std::size_t corner);

/// The mesh after `change(mesh, v)` for every vertex.
template <typename Change>
Mesh changed(Mesh mesh, const Change& change) {
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        change(mesh, v);
    return mesh;
}

}  // namespace relief::test
