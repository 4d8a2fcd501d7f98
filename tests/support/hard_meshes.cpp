// SPDX-License-Identifier: Apache-2.0
#include "support/hard_meshes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "relief/mesh/normals.h"
#include "support/shapes.h"

namespace relief::test {

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
    return mesh_from({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});
}

Mesh square_with_normals(const std::vector<glm::vec3>& normals) {
    Mesh mesh = square();
    mesh.normals = normals;
    return mesh;
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
    return mesh_from({{a - 1, 1, 0},
                      {a - 1, 2, 0},
                      {a, 1, 0},
                      {a, 2, 0},
                      {b, 1, 0},
                      {b, 2, 0},
                      {b + 1, 1, 1},
                      {b + 1, 2, 1}},
                     {{0, 2, 3}, {0, 3, 1}, {4, 6, 7}, {4, 7, 5}});
}

namespace {

/// A mesh that faces +z, with texture coordinates projected along z.
Mesh flat(std::vector<glm::vec3> positions, std::vector<glm::uvec3> triangles) {
    Mesh mesh;
    for (const glm::vec3& p : positions) {
        mesh.normals.emplace_back(0.0F, 0.0F, 1.0F);
        mesh.texcoords.emplace_back(p.x, 1.0F - p.y);
    }
    mesh.positions = std::move(positions);
    mesh.triangles = std::move(triangles);
    return mesh;
}

/// A wavy grid with tilted normals, so that nothing is aligned with the axes by chance.
Mesh wavy() {
    Mesh mesh = grid(6);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const auto t = static_cast<float>(i);
        mesh.positions[i].z = 0.1F * std::sin(1.7F * t);
        mesh.normals[i] =
            glm::normalize(glm::vec3(0.3F * std::cos(t), 0.3F * std::sin(2.0F * t), 1.0F));
    }
    return mesh;
}

template <typename Change>
NamedMesh changed(std::string name, const Change& change) {
    NamedMesh named{std::move(name), wavy()};
    change(named.mesh);
    return named;
}

void add_shapes(std::vector<NamedMesh>& meshes) {
    const glm::vec3 o(0, 0, 0);
    const glm::vec3 x(1, 0, 0);
    const glm::vec3 y(0, 1, 0);
    const glm::vec3 xy(1, 1, 0);
    meshes.push_back({"empty", Mesh{}});
    meshes.push_back({"vertices without triangles", flat({o, x, y}, {})});
    meshes.push_back({"one triangle", flat({o, x, y}, {{0, 1, 2}})});
    meshes.push_back(
        {"triangle with a repeated index", flat({o, x, y, xy}, {{0, 1, 1}, {1, 3, 2}})});
    meshes.push_back({"only repeated indices", flat({o, x}, {{0, 0, 0}, {0, 1, 1}})});
    meshes.push_back({"collinear", flat({o, x, 2.0F * x, y}, {{0, 1, 2}, {0, 2, 3}})});
    meshes.push_back(
        {"needle", flat({o, x, {0.5F, 1e-6F, 0}, {0.5F, -1, 0}}, {{0, 1, 2}, {1, 0, 3}})});
    meshes.push_back({"fold-over", flat({o, x, y, {0.9F, 0.9F, 0}}, {{0, 1, 2}, {1, 2, 3}})});
    meshes.push_back(
        {"double-sided sheet", flat({o, x, xy, y}, {{0, 1, 2}, {0, 2, 3}, {2, 1, 0}, {3, 2, 0}})});
    meshes.push_back(
        {"repeated triangle", flat({o, x, xy, y}, {{0, 1, 2}, {1, 2, 0}, {0, 1, 2}, {0, 2, 3}})});
    meshes.push_back({"three triangles on an edge", flat({o, x, y, {0.5F, -1, 0}, {0.5F, 0, 1}},
                                                         {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}})});
    meshes.push_back({"bow-tie", flat({o, x, y, -x, -y}, {{0, 1, 2}, {0, 3, 4}})});
}

void add_scales(std::vector<NamedMesh>& meshes) {
    for (const float scale : {1e-30F, 1e-18F, 1e20F, 1e30F}) {
        meshes.push_back(changed(fmt::format("positions times {}", scale), [&](Mesh& mesh) {
            for (glm::vec3& position : mesh.positions)
                position *= scale;
        }));
    }
    for (const float scale : {1e-38F, 1e-25F, 1e-18F, 1e30F}) {
        meshes.push_back(changed(fmt::format("texture times {}", scale), [&](Mesh& mesh) {
            for (glm::vec2& texcoord : mesh.texcoords)
                texcoord *= scale;
        }));
    }
    meshes.push_back(changed("far from the origin", [](Mesh& mesh) {
        for (glm::vec3& position : mesh.positions)
            position += glm::vec3(1e6F, -1e6F, 1e6F);
    }));
    meshes.push_back(changed("texture far from its origin", [](Mesh& mesh) {
        for (glm::vec2& texcoord : mesh.texcoords)
            texcoord += 1e6F;
    }));
    meshes.push_back(changed("the largest floats", [](Mesh& mesh) {
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            mesh.positions[i] = (mesh.positions[i] - 0.5F) * 2.0F * 3.4e38F;
            mesh.texcoords[i] = (mesh.texcoords[i] - 0.5F) * 2.0F * 3.4e38F;
        }
    }));
}

void add_non_finite(std::vector<NamedMesh>& meshes) {
    meshes.push_back(changed("NaN position", [](Mesh& m) { m.positions[17].y = not_a_number; }));
    meshes.push_back(changed("infinite position", [](Mesh& m) { m.positions[17].x = infinite; }));
    meshes.push_back(
        changed("NaN texture coordinate", [](Mesh& m) { m.texcoords[17].x = not_a_number; }));
    meshes.push_back(
        changed("infinite texture coordinate", [](Mesh& m) { m.texcoords[17].y = -infinite; }));
    meshes.push_back(changed("NaN normal", [](Mesh& m) { m.normals[17].z = not_a_number; }));
    meshes.push_back(changed("infinite normal", [](Mesh& m) { m.normals[17].z = infinite; }));
    meshes.push_back(changed("everything NaN", [](Mesh& m) {
        std::fill(m.positions.begin(), m.positions.end(), glm::vec3(not_a_number));
        std::fill(m.normals.begin(), m.normals.end(), glm::vec3(not_a_number));
        std::fill(m.texcoords.begin(), m.texcoords.end(), glm::vec2(not_a_number));
    }));
}

void add_textures_and_normals(std::vector<NamedMesh>& meshes) {
    meshes.push_back(changed("no texture gradient", [](Mesh& m) {
        std::fill(m.texcoords.begin(), m.texcoords.end(), glm::vec2(0.0F));
    }));
    meshes.push_back(changed("texture on a line", [](Mesh& m) {
        for (glm::vec2& t : m.texcoords)
            t.y = t.x;
    }));
    meshes.push_back(changed("texture gradient on one side only", [](Mesh& m) {
        for (glm::vec2& t : m.texcoords)
            t.x = std::max(t.x, 0.5F);
    }));
    meshes.push_back(changed("mirrored texture", [](Mesh& m) {
        for (glm::vec2& t : m.texcoords)
            t.x = std::abs(t.x - 0.5F);
    }));
    meshes.push_back(changed("texture without order", [](Mesh& m) {
        for (std::size_t i = 0; i < m.texcoords.size(); ++i)
            m.texcoords[i] = glm::fract(glm::vec2(0.7F, 0.3F) * static_cast<float>(i * i));
    }));
    meshes.push_back(changed("zero normals", [](Mesh& m) {
        std::fill(m.normals.begin(), m.normals.end(), glm::vec3(0.0F));
    }));
    meshes.push_back(changed("normals in the surface", [](Mesh& m) {
        std::fill(m.normals.begin(), m.normals.end(), glm::vec3(1.0F, 0.0F, 0.0F));
    }));
    for (const float scale : {1e-30F, 0.1F, 7.0F, 1e30F}) {
        meshes.push_back(changed(fmt::format("normals of length {}", scale), [&](Mesh& m) {
            for (glm::vec3& n : m.normals)
                n *= scale;
        }));
    }
}

}  // namespace

std::vector<NamedMesh> hard_meshes() {
    std::vector<NamedMesh> meshes;
    add_shapes(meshes);
    add_scales(meshes);
    add_non_finite(meshes);
    add_textures_and_normals(meshes);
    return meshes;
}

}  // namespace relief::test
