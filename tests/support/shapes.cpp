// SPDX-License-Identifier: Apache-2.0
#include "support/shapes.h"

#include <cmath>
#include <numbers>

namespace relief::test {
namespace {

/// Two counter-clockwise triangles for every cell of a rows x columns lattice of vertices, row 0 on
/// top.
void add_cells(Mesh& mesh, std::uint32_t first_vertex, std::uint32_t columns, std::uint32_t rows) {
    for (std::uint32_t row = 0; row + 1 < rows; ++row) {
        for (std::uint32_t column = 0; column + 1 < columns; ++column) {
            const std::uint32_t upper_left = first_vertex + row * columns + column;
            const std::uint32_t lower_left = upper_left + columns;
            mesh.triangles.emplace_back(upper_left, lower_left, lower_left + 1);
            mesh.triangles.emplace_back(upper_left, lower_left + 1, upper_left + 1);
        }
    }
}

}  // namespace

Mesh grid(int cells) {
    Mesh mesh;
    const auto side = static_cast<std::uint32_t>(cells + 1);
    for (std::uint32_t row = 0; row < side; ++row) {
        for (std::uint32_t column = 0; column < side; ++column) {
            const glm::vec2 uv = glm::vec2(column, row) / static_cast<float>(cells);
            mesh.positions.emplace_back(uv.x, 1.0F - uv.y, 0.0F);
            mesh.normals.emplace_back(0.0F, 0.0F, 1.0F);
            mesh.texcoords.push_back(uv);
        }
    }
    add_cells(mesh, 0, side, side);
    return mesh;
}

Mesh sphere(int slices, int stacks) {
    Mesh mesh;
    for (int stack = 0; stack <= stacks; ++stack) {
        for (int slice = 0; slice <= slices; ++slice) {
            const double u = static_cast<double>(slice) / slices;
            const double v = static_cast<double>(stack) / stacks;
            // The seam repeats its first meridian exactly, so that positions there are equal.
            const double longitude = slice == slices ? 0.0 : 2.0 * std::numbers::pi * u;
            const double colatitude = std::numbers::pi * v;
            const double ring = stack == 0 || stack == stacks ? 0.0 : std::sin(colatitude);
            const glm::vec3 position(ring * std::sin(longitude), std::cos(colatitude),
                                     ring * std::cos(longitude));
            mesh.positions.push_back(position);
            mesh.normals.push_back(position);
            mesh.texcoords.emplace_back(u, v);
        }
    }
    add_cells(mesh, 0, static_cast<std::uint32_t>(slices + 1),
              static_cast<std::uint32_t>(stacks + 1));
    return mesh;
}

Mesh cube() {
    Mesh mesh;
    // Each face: its outward normal, and the directions of the texture's right and up on it.
    struct Face {
        glm::vec3 normal, right, up;
    };
    const Face faces[] = {
        {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}},   {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
        {{0, 0, -1}, {-1, 0, 0}, {0, 1, 0}}, {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
        {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}},  {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
    };
    for (const Face& face : faces) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const glm::vec2 uv : {glm::vec2(0, 0), {1, 0}, {0, 1}, {1, 1}}) {
            mesh.positions.push_back(face.normal + (2.0F * uv.x - 1.0F) * face.right +
                                     (1.0F - 2.0F * uv.y) * face.up);
            mesh.normals.push_back(face.normal);
            mesh.texcoords.push_back(uv);
        }
        add_cells(mesh, first, 2, 2);
    }
    return mesh;
}

}  // namespace relief::test
