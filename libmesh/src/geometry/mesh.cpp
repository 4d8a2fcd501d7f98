// SPDX-License-Identifier: Apache-2.0
// Checking a mesh, and its bounds.
#include "relief/mesh/mesh.h"

#include <fmt/format.h>

#include "geometry/check_triangles.h"
#include "geometry/direction.h"
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
        if (!is_finite(position)) continue;
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
    check_triangles(mesh.triangles, mesh.positions.size());
    check_ranges(mesh);
    if (!mesh.smoothing_groups.empty() && mesh.smoothing_groups.size() != mesh.triangles.size()) {
        throw InvalidInput(fmt::format("there are {} smoothing groups, but {} triangles",
                                       mesh.smoothing_groups.size(), mesh.triangles.size()));
    }
}

}  // namespace relief
