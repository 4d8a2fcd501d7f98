// SPDX-License-Identifier: Apache-2.0
#include "hard_cases/tangent_samples.h"

#include "hard_cases/sample_meshes.h"
#include "relief/mesh/shapes.h"

namespace relief::test {

std::vector<glm::vec4> tangents_of(const Mesh& mesh, const TangentMethod& method) {
    Report ignored;
    return method.call(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles, ignored);
}

std::uint32_t vertex_at(const Mesh& mesh, std::size_t corner) {
    return mesh.triangles[corner / 3][static_cast<int>(corner % 3)];
}

Mesh textured_torus() {
    return make_torus(0.4F, 24, 12);
}

Mesh textured_grid() {
    return textured_from_above(flat_grid(4));
}

Mesh coarsely_textured() {
    Mesh mesh = textured_from_above(wavy_grid(6));
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        mesh.texcoords[v].x += 0.0625F * static_cast<float>(v % 3);
    return mesh;
}

}  // namespace relief::test
