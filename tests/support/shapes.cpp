// SPDX-License-Identifier: Apache-2.0
#include "support/shapes.h"

#include <random>

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

namespace {

glm::dvec3 random_direction(std::mt19937_64& random) {
    // Standard distributions differ between libraries; the generator does not.
    const auto coordinate = [&] { return static_cast<double>(random() >> 11U) * 0x1p-52 - 1.0; };
    while (true) {
        // The order of evaluation of function arguments is unspecified, so each value has its own
        // statement.
        const double x = coordinate();
        const double y = coordinate();
        const glm::dvec3 vector(x, y, coordinate());
        const double length = glm::length(vector);
        if (length > 0.1 && length < 1.0) return vector / length;
    }
}

}  // namespace

void ReferenceFrames::add(const glm::dvec3& normal, const glm::dvec3& tangent, float w) {
    normals.push_back(normal);
    tangents.push_back(tangent);
    float_normals.emplace_back(normal);
    float_tangents.emplace_back(glm::vec3(tangent), w);
}

ReferenceFrames random_frames(std::size_t count) {
    std::mt19937_64 random(1);
    ReferenceFrames frames;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 normal = random_direction(random);
        const glm::dvec3 other = random_direction(random);
        frames.add(normal, glm::normalize(other - normal * glm::dot(normal, other)),
                   i % 2 == 0 ? 1.0F : -1.0F);
    }
    return frames;
}

}  // namespace relief::test
