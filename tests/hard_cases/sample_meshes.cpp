// SPDX-License-Identifier: Apache-2.0
#include "hard_cases/sample_meshes.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "relief/mesh/normals.h"

namespace relief::test {

Mesh mesh_of(std::vector<glm::vec3> positions, std::vector<glm::uvec3> triangles) {
    Mesh mesh;
    mesh.positions = std::move(positions);
    mesh.triangles = std::move(triangles);
    return mesh;
}

Mesh textured_from_above(Mesh mesh) {
    Report ignored;
    if (mesh.normals.empty()) {
        mesh.normals = vertex_normals(mesh.positions, mesh.triangles, NormalWeight::angle, ignored);
    }
    mesh.texcoords.clear();
    for (const glm::vec3& position : mesh.positions)
        mesh.texcoords.emplace_back(position.x, -position.y);
    return mesh;
}

Mesh square() {
    return mesh_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});
}

Mesh flat_grid(int cells) {
    Mesh mesh;
    const auto row = static_cast<std::uint32_t>(cells + 1);
    for (int y = 0; y <= cells; ++y) {
        for (int x = 0; x <= cells; ++x)
            mesh.positions.emplace_back(x, y, 0);
    }
    for (std::uint32_t y = 0; y + 1 < row; ++y) {
        for (std::uint32_t x = 0; x + 1 < row; ++x) {
            const std::uint32_t corner = y * row + x;
            mesh.triangles.emplace_back(corner, corner + 1, corner + row + 1);
            mesh.triangles.emplace_back(corner, corner + row + 1, corner + row);
        }
    }
    return mesh;
}

Mesh wavy_grid(int cells) {
    Mesh mesh = flat_grid(cells);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        mesh.positions[v].z = 0.25F * static_cast<float>(v * v % 7);
    return mesh;
}

Mesh uneven_cube() {
    Mesh mesh;
    for (unsigned corner = 0; corner < 8; ++corner) {
        const auto side = [corner](unsigned axis) {
            return (corner >> axis & 1U) != 0 ? 1.0F : -1.0F;
        };
        mesh.positions.emplace_back(side(0), side(1), side(2));
    }
    mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

Mesh fan(unsigned count) {
    Mesh mesh;
    mesh.positions.emplace_back(0, 0, 0);
    for (unsigned i = 0; i < count; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / count;
        mesh.positions.emplace_back(std::cos(angle), std::sin(angle), 0.0);
        mesh.triangles.emplace_back(0, i + 1, (i + 1) % count + 1);
    }
    return mesh;
}

Mesh ramp(float flat_end, float rising_begin) {
    const float a = flat_end;
    const float b = rising_begin;
    return mesh_of({{a - 1, 1, 0},
                    {a - 1, 2, 0},
                    {a, 1, 0},
                    {a, 2, 0},
                    {b, 1, 0},
                    {b, 2, 0},
                    {b + 1, 1, 1},
                    {b + 1, 2, 1}},
                   {{0, 2, 3}, {0, 3, 1}, {4, 6, 7}, {4, 7, 5}});
}

}  // namespace relief::test
