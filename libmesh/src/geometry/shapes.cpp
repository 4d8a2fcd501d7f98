// SPDX-License-Identifier: Apache-2.0
// Simple shapes, computed in double and rounded once. Object space, y up. Seams repeat their first
// positions exactly. Counts out of range throw InvalidInput.
#include "relief/mesh/mesh.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "portable_math.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

constexpr int max_parts = 4096;

void check_count(const char* thing, int count, int least) {
    if (count < least || count > max_parts) {
        throw InvalidInput(
            fmt::format("{} are {}, but must be within [{}, {}]", thing, count, least, max_parts));
    }
}

/// Adds two counter-clockwise triangles for every cell of a grid of rows x columns vertices, row 0
/// on top.
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

/// Returns the angle of a step of a full turn. The last step equals the first.
double turn(int step, int steps) {
    return step == steps ? 0.0 : 2.0 * std::numbers::pi * step / steps;
}

/// Adds a disc at this height that faces up or down.
void add_disc(Mesh& mesh, double height, int slices) {
    const auto center = static_cast<std::uint32_t>(mesh.positions.size());
    const auto add = [&](double x, double z) {
        mesh.positions.emplace_back(x, height, z);
        mesh.normals.emplace_back(0.0F, height, 0.0F);
        mesh.texcoords.emplace_back(0.5 + 0.5 * x, 0.5 + 0.5 * z * height);
    };
    add(0.0, 0.0);
    for (int slice = 0; slice < slices; ++slice)
        add(portable::sin(turn(slice, slices)), portable::cos(turn(slice, slices)));
    const auto count = static_cast<std::uint32_t>(slices);
    for (std::uint32_t slice = 0; slice < count; ++slice) {
        const std::uint32_t here = center + 1 + slice;
        const std::uint32_t next = center + 1 + (slice + 1) % count;
        if (height > 0.0) {
            mesh.triangles.emplace_back(center, here, next);
        } else {
            mesh.triangles.emplace_back(center, next, here);
        }
    }
}

}  // namespace

Mesh make_quad(int cells) {
    check_count("cells of a quad", cells, 1);
    Mesh mesh;
    mesh.name = "quad";
    const auto side = static_cast<std::uint32_t>(cells + 1);
    for (std::uint32_t row = 0; row < side; ++row) {
        for (std::uint32_t column = 0; column < side; ++column) {
            const glm::vec2 uv = glm::vec2(column, row) / static_cast<float>(cells);
            mesh.positions.emplace_back(2.0F * uv.x - 1.0F, 1.0F - 2.0F * uv.y, 0.0F);
            mesh.normals.emplace_back(0.0F, 0.0F, 1.0F);
            mesh.texcoords.push_back(uv);
        }
    }
    add_cells(mesh, 0, side, side);
    return mesh;
}

Mesh make_sphere(int slices, int stacks) {
    check_count("slices of a sphere", slices, 3);
    check_count("stacks of a sphere", stacks, 2);
    Mesh mesh;
    mesh.name = "sphere";
    for (int stack = 0; stack <= stacks; ++stack) {
        for (int slice = 0; slice <= slices; ++slice) {
            const double v = static_cast<double>(stack) / stacks;
            const double longitude = turn(slice, slices);
            const double colatitude = std::numbers::pi * v;
            const double ring = stack == 0 || stack == stacks ? 0.0 : portable::sin(colatitude);
            const glm::vec3 position(ring * portable::sin(longitude), portable::cos(colatitude),
                                     ring * portable::cos(longitude));
            mesh.positions.push_back(position);
            mesh.normals.push_back(position);
            mesh.texcoords.emplace_back(static_cast<double>(slice) / slices, v);
        }
    }
    add_cells(mesh, 0, static_cast<std::uint32_t>(slices + 1),
              static_cast<std::uint32_t>(stacks + 1));
    return mesh;
}

Mesh make_cube() {
    Mesh mesh;
    mesh.name = "cube";
    // For each face: outward normal, and the directions of the texture's right and up.
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

Mesh make_torus(float tube_radius, int slices, int sides) {
    check_count("slices of a torus", slices, 3);
    check_count("sides of a torus", sides, 3);
    if (!(tube_radius > 0.0F && tube_radius <= 1.0F)) {
        throw InvalidInput(
            fmt::format("a torus's tube radius is {}, but must be within (0, 1]", tube_radius));
    }
    Mesh mesh;
    mesh.name = "torus";
    for (int side = 0; side <= sides; ++side) {
        const double around = turn(side, sides);  // It runs from the inner side over the top.
        for (int slice = 0; slice <= slices; ++slice) {
            const double along = turn(slice, slices);
            const glm::dvec3 outwards(portable::sin(along), 0.0, portable::cos(along));
            const glm::dvec3 normal =
                -portable::cos(around) * outwards + glm::dvec3(0.0, portable::sin(around), 0.0);
            mesh.positions.emplace_back(outwards + static_cast<double>(tube_radius) * normal);
            mesh.normals.emplace_back(normal);
            mesh.texcoords.emplace_back(static_cast<double>(slice) / slices,
                                        static_cast<double>(side) / sides);
        }
    }
    add_cells(mesh, 0, static_cast<std::uint32_t>(slices + 1),
              static_cast<std::uint32_t>(sides + 1));
    return mesh;
}

Mesh make_cylinder(int slices) {
    check_count("slices of a cylinder", slices, 3);
    Mesh mesh;
    mesh.name = "cylinder";
    for (int row = 0; row < 2; ++row) {
        for (int slice = 0; slice <= slices; ++slice) {
            const glm::dvec2 rim(portable::sin(turn(slice, slices)),
                                 portable::cos(turn(slice, slices)));
            mesh.positions.emplace_back(rim.x, 1.0 - 2.0 * row, rim.y);
            mesh.normals.emplace_back(rim.x, 0.0, rim.y);
            mesh.texcoords.emplace_back(static_cast<double>(slice) / slices, row);
        }
    }
    add_cells(mesh, 0, static_cast<std::uint32_t>(slices + 1), 2);
    add_disc(mesh, 1.0, slices);
    add_disc(mesh, -1.0, slices);
    return mesh;
}

}  // namespace relief
