// SPDX-License-Identifier: Apache-2.0
#include "support/shapes.h"

#include "relief/mesh/mesh.h"

namespace relief::test {

Mesh grid(int cells) {
    Mesh mesh = make_quad(cells);
    mesh.name.clear();
    for (glm::vec3& position : mesh.positions)
        position = glm::vec3(0.5F) * (position + glm::vec3(1.0F, 1.0F, 0.0F));
    return mesh;
}

Mesh sphere(int slices, int stacks) {
    Mesh mesh = make_sphere(slices, stacks);
    mesh.name.clear();
    return mesh;
}

Mesh cube() {
    Mesh mesh = make_cube();
    mesh.name.clear();
    return mesh;
}

Mesh soup(const Mesh& mesh) {
    Mesh result;
    for (const glm::uvec3& triangle : mesh.triangles) {
        const auto first = static_cast<std::uint32_t>(result.positions.size());
        for (int i = 0; i < 3; ++i) {
            result.positions.push_back(mesh.positions[triangle[i]]);
            result.normals.push_back(mesh.normals[triangle[i]]);
            result.texcoords.push_back(mesh.texcoords[triangle[i]]);
        }
        result.triangles.emplace_back(first, first + 1, first + 2);
    }
    return result;
}

Mesh with_tangents(Mesh mesh, TangentMethod mode) {
    Report report;
    return with_frames(std::move(mesh), {.tangents = mode}, report).mesh;
}

}  // namespace relief::test
