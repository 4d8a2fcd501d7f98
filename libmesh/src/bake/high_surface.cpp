// SPDX-License-Identifier: Apache-2.0
// Tests: tests/mesh/bake/bake_test.cpp.
#include "bake/high_surface.h"

#include "geometry/direction.h"
#include "relief/mesh/frames.h"

namespace relief {
namespace {

/// Copies with normals of the meshes that have none.
std::vector<Mesh> with_missing_normals(std::span<const Mesh> meshes, Report& report) {
    std::vector<Mesh> made(meshes.size());
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        validate(meshes[i]);
        if (!meshes[i].normals.empty() || meshes[i].triangles.empty()) continue;
        FrameOptions frames;
        frames.tangents = TangentMode::none;
        made[i] = with_frames(meshes[i], frames, report).mesh;
    }
    return made;
}

std::vector<const Mesh*> chosen(std::span<const Mesh> meshes, const std::vector<Mesh>& made) {
    std::vector<const Mesh*> result;
    for (std::size_t i = 0; i < meshes.size(); ++i)
        result.push_back(made[i].normals.empty() ? &meshes[i] : &made[i]);
    return result;
}

std::vector<RayMesh> ray_meshes(const std::vector<const Mesh*>& meshes) {
    std::vector<RayMesh> result;
    for (const Mesh* mesh : meshes)
        result.push_back({mesh->positions, mesh->triangles});
    return result;
}

}  // namespace

HighSurface::HighSurface(std::span<const Mesh> meshes, Report& report)
    : made_(with_missing_normals(meshes, report)),
      meshes_(chosen(meshes, made_)),
      scene_(ray_meshes(meshes_)) {}

glm::dvec3 HighSurface::normal(const RayHit& hit, std::size_t sample, Report& found) const {
    const Mesh& mesh = *meshes_[hit.mesh];
    const glm::uvec3 corners = mesh.triangles[hit.triangle];
    glm::dvec3 sum(0.0);
    for (int i = 0; i < 3; ++i)
        sum += hit.weights[i] * glm::dvec3(mesh.normals[corners[i]]);
    const glm::dvec3 unit = direction_or_zero(sum);
    if (unit != glm::dvec3(0.0)) return unit;
    found.add("high normal without direction", "texel", sample, "is its triangle's");
    const auto place = scene_.corners(hit.mesh, hit.triangle);
    return direction_or_zero(glm::cross(place[1] - place[0], place[2] - place[0]));
}

}  // namespace relief
