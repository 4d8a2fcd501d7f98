// SPDX-License-Identifier: Apache-2.0
#include "support/shapes.h"

#include "relief/mesh/shapes.h"

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

}  // namespace relief::test
