// SPDX-License-Identifier: Apache-2.0
#include "mesh/tangent_shapes.h"

#include <cmath>
#include <numbers>

namespace relief::bench {
namespace {

void add_vertex(Mesh& mesh, const glm::dvec3& position, const glm::dvec3& normal,
                const glm::dvec2& texcoord) {
    mesh.positions.emplace_back(position);
    mesh.normals.emplace_back(normal);
    mesh.texcoords.emplace_back(texcoord);
}

}  // namespace

Mesh displaced_grid(std::size_t triangles) {
    const auto cells = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(triangles) / 2.0));
    Mesh mesh;
    for (std::uint32_t row = 0; row <= cells; ++row) {
        for (std::uint32_t column = 0; column <= cells; ++column) {
            const double x = static_cast<double>(column) / cells;
            const double y = static_cast<double>(row) / cells;
            // Hills of two sizes, none steeper than 45 degrees.
            const auto slope = [](double at, double waves) { return 0.35 * std::cos(waves * at); };
            const double height = 0.35 * (std::sin(20.0 * x) / 20.0 + std::sin(20.0 * y) / 20.0 +
                                          std::sin(90.0 * x) / 90.0 + std::sin(90.0 * y) / 90.0);
            const glm::dvec3 normal(-slope(x, 20.0) - slope(x, 90.0),
                                    -slope(y, 20.0) - slope(y, 90.0), 1.0);
            add_vertex(mesh, {x, y, height}, glm::normalize(normal), {x, 1.0 - y});
        }
    }
    for (std::uint32_t row = 0; row < cells; ++row) {
        for (std::uint32_t column = 0; column < cells; ++column) {
            const std::uint32_t lower = row * (cells + 1) + column;
            const std::uint32_t upper = lower + cells + 1;
            mesh.triangles.emplace_back(lower, lower + 1, upper + 1);
            mesh.triangles.emplace_back(lower, upper + 1, upper);
        }
    }
    return mesh;
}

Mesh fan(std::size_t triangles) {
    const auto count = static_cast<std::uint32_t>(triangles);
    Mesh mesh;
    add_vertex(mesh, {0, 0, 0}, {0, 0, 1}, {0.5, 0.5});
    for (std::uint32_t i = 0; i < count; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / count;
        const glm::dvec2 rim(std::cos(angle), std::sin(angle));
        add_vertex(mesh, {rim, 0}, {0, 0, 1}, glm::dvec2(0.5) + 0.5 * glm::dvec2(rim.x, -rim.y));
        mesh.triangles.emplace_back(0, i + 1, (i + 1) % count + 1);
    }
    return mesh;
}

Mesh book(std::size_t triangles) {
    const auto count = static_cast<std::uint32_t>(triangles);
    Mesh mesh;
    add_vertex(mesh, {0, 0, 0}, {0, 0, 1}, {0, 0});
    add_vertex(mesh, {0, 1, 0}, {0, 0, 1}, {0, 1});
    for (std::uint32_t i = 0; i < count; ++i) {
        const double angle = std::numbers::pi * i / count;
        add_vertex(mesh, {std::cos(angle), 0.5, std::sin(angle)}, {0, 0, 1},
                   {1.0 + i % 7, 0.3 * (i % 5)});
        mesh.triangles.emplace_back(i % 2, 1 - i % 2, i + 2);
    }
    return mesh;
}

Mesh collapsed_to_a_point(std::size_t triangles) {
    Mesh mesh = displaced_grid(triangles);
    for (glm::vec3& position : mesh.positions)
        position = glm::vec3(0.0F);
    return mesh;
}

Mesh collapsed_to_a_line(std::size_t triangles) {
    Mesh mesh = displaced_grid(triangles);
    for (glm::vec3& position : mesh.positions)
        position = {position.x, 0, 0};
    return mesh;
}

}  // namespace relief::bench
