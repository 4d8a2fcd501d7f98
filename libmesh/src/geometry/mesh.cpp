// SPDX-License-Identifier: Apache-2.0
// Checking a mesh, and its bounds.
#include "relief/mesh/mesh.h"

#include <fmt/format.h>

#include <cmath>

#include "relief/mesh/error.h"

namespace relief {
namespace {

void check_length(const Mesh& mesh, std::size_t length, std::string_view attribute) {
    if (length != 0 && length != mesh.positions.size()) {
        throw InvalidInput(fmt::format("there are {} {}, but {} positions", length, attribute,
                                       mesh.positions.size()));
    }
}

void check_ranges(const Mesh& mesh) {
    std::size_t covered = 0;
    for (const MaterialRange& range : mesh.material_ranges) {
        if (range.first_triangle != covered) {
            throw InvalidInput(fmt::format("a material range starts at triangle {} instead of {}",
                                           range.first_triangle, covered));
        }
        covered += range.triangle_count;
    }
    if (!mesh.material_ranges.empty() && covered != mesh.triangles.size()) {
        throw InvalidInput(fmt::format("material ranges cover {} triangles, but there are {}",
                                       covered, mesh.triangles.size()));
    }
}

}  // namespace

Bounds bounds_of(const Mesh& mesh) {
    Bounds bounds;
    for (const glm::vec3& position : mesh.positions) {
        if (!std::isfinite(position.x) || !std::isfinite(position.y) ||
            !std::isfinite(position.z)) {
            continue;
        }
        bounds.min = glm::min(bounds.min, position);
        bounds.max = glm::max(bounds.max, position);
    }
    return bounds;
}

void validate(const Mesh& mesh) {
    check_length(mesh, mesh.normals.size(), "normals");
    check_length(mesh, mesh.texcoords.size(), "texture coordinates");
    check_length(mesh, mesh.tangents.size(), "tangents");
    check_length(mesh, mesh.colors.size(), "colours");
    for (std::size_t triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t vertex = mesh.triangles[triangle][corner];
            if (vertex >= mesh.positions.size()) {
                throw InvalidInput(fmt::format("triangle {} names vertex {}, but there are only {}",
                                               triangle, vertex, mesh.positions.size()));
            }
        }
    }
    check_ranges(mesh);
}

}  // namespace relief
