// SPDX-License-Identifier: Apache-2.0
// Frames, matrices and textures of a scene, in double. See prepared_scene.h. Normals go through the
// matrix of cofactors, which for a singular matrix is what the inverse transpose tends to.
// Tests: tests/shade/reference/reference_test.cpp.
#include "reference/prepared_scene.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "geometry/direction.h"
#include "relief/mesh/error.h"
#include "relief/mesh/frames.h"
#include "relief/shade/effects.h"
#include "relief/shade/image_source.h"
#include "render/material_textures.h"

namespace relief::reference {

namespace {

const Material& material_of_range(const std::vector<Material>& materials,
                                  const MaterialRange& range) {
    return range.material ? materials[*range.material] : default_material();
}

bool uses_stored_tangents(const Material& material) {
    if (material.tangent_frame != TangentFrame::stored) return false;
    return material.bump_map ||
           (material.normal_map && material.normal_map->space == NormalSpace::tangent);
}

bool needs_tangents(const std::vector<Material>& materials, const Mesh& mesh) {
    if (mesh.texcoords.empty() || !mesh.tangents.empty()) return false;
    return std::any_of(mesh.material_ranges.begin(), mesh.material_ranges.end(),
                       [&](const MaterialRange& range) {
                           return uses_stored_tangents(material_of_range(materials, range));
                       });
}

Mesh framed_mesh(const std::vector<Material>& materials, const Mesh& mesh, Report& report) {
    FrameOptions options;
    if (needs_tangents(materials, mesh)) options.tangents = TangentMode::mikktspace;
    const bool complete = !mesh.normals.empty() && options.tangents == TangentMode::keep;
    return complete ? mesh : with_frames(mesh, options, report).mesh;
}

/// The matrix of normals, up to a positive factor, and whether the place is mirrored.
struct NormalMatrix {
    glm::dmat3 matrix;
    bool mirrors = false;
};

NormalMatrix normal_matrix(const glm::dmat3& m) {
    const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]),
                               glm::cross(m[0], m[1]));
    const bool mirrors = glm::dot(m[0], cofactors[0]) < 0.0;
    return {mirrors ? -cofactors : cofactors, mirrors};
}

PreparedInstance prepared(const Instance& instance, const Mesh& mesh,
                          const glm::dmat4& view_from_world) {
    const glm::dmat4 world_from_object(instance.world_from_object);
    const auto [matrix, mirrors] = normal_matrix(glm::dmat3(world_from_object));
    PreparedInstance result;
    result.mesh = &mesh;
    result.mirrors = mirrors;
    result.world_from_object_normal = matrix;
    for (const glm::vec3& position : mesh.positions) {
        const glm::dvec4 world = world_from_object * glm::dvec4(glm::dvec3(position), 1.0);
        result.positions_world.emplace_back(world);
        result.positions_view.emplace_back(view_from_world * world);
    }
    for (const glm::vec3& normal : mesh.normals)
        result.normals_world.push_back(direction_or_zero(matrix * glm::dvec3(normal)));
    for (const glm::vec4& tangent : mesh.tangents) {
        const glm::dvec3 along =
            direction_or_zero(glm::dmat3(world_from_object) * glm::dvec3(tangent));
        const double w = static_cast<double>(tangent.w);
        result.tangents_world.emplace_back(along, mirrors ? -w : w);
    }
    return result;
}

void find_flat_code(PreparedScene& prepared, const Scene& scene, const Material& material) {
    if (!material.normal_map) return;
    const std::size_t image = material.normal_map->texture.image;
    const Image decoded = decode(scene.images[image], ImageUse::data);
    prepared.normal_map_bits[image] = decoded.bits();
    prepared.detected_flat_codes[image] = detected_flat_code(scene.images[image], decoded);
}

/// Decodes the textures of all materials that are on meshes with texture coordinates.
void decode_textures(PreparedScene& prepared, const Scene& scene, Report& report) {
    std::set<std::uint32_t> textured;
    for (const Mesh& mesh : scene.meshes) {
        for (const MaterialRange& range : mesh.material_ranges) {
            if (!mesh.texcoords.empty() && range.material) textured.insert(*range.material);
        }
    }
    for (const std::uint32_t number : textured)
        prepared.texels.want(scene, scene.materials[number]);
    for (const std::uint32_t number : textured) {
        Material& material = prepared.materials[number];
        leave_out_textures(scene, prepared.texels.unreadable(), number, material, report);
        find_flat_code(prepared, scene, material);
    }
}

/// Counts triangles that have no place.
void report_unplaced(const Mesh& mesh, Report& report) {
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const glm::uvec3& corners = mesh.triangles[i];
        for (int corner = 0; corner < 3; ++corner) {
            if (is_finite(mesh.positions[corners[corner]])) continue;
            report.add("vertex that is not finite", "triangle", i, "is not drawn");
            break;
        }
    }
}

}  // namespace

PreparedScene::PreparedScene(const Scene& described, Report& report)
    : scene(described), materials(described.materials) {
    validate(scene);
    if (!scene.camera) throw InvalidInput("the scene has no camera");
    const glm::dmat4 world_from_view(scene.camera->world_from_view);
    eye_world = glm::dvec3(world_from_view[3]);
    decode_textures(*this, scene, report);
    for (const Mesh& mesh : scene.meshes) {
        meshes.push_back(framed_mesh(materials, mesh, report));
        report_unplaced(mesh, report);
    }
    for (const Instance& instance : scene.instances) {
        instances.push_back(
            prepared(instance, meshes[instance.mesh], glm::inverse(world_from_view)));
    }
    if (scene.environment) environment.emplace(*scene.environment, report);
}

std::size_t PreparedScene::range_of(std::uint32_t instance, std::uint32_t triangle) const {
    const auto& ranges = instances[instance].mesh->material_ranges;
    const auto after = std::upper_bound(
        ranges.begin(), ranges.end(), triangle,
        [](std::uint32_t t, const MaterialRange& range) { return t < range.first_triangle; });
    return after == ranges.begin() ? 0 : static_cast<std::size_t>(after - ranges.begin()) - 1;
}

const Material& PreparedScene::material_of(std::uint32_t instance, std::uint32_t triangle) const {
    const auto& ranges = instances[instance].mesh->material_ranges;
    if (ranges.empty()) return default_material();
    return material_of_range(materials, ranges[range_of(instance, triangle)]);
}

FlatCode PreparedScene::flat_code(const NormalMap& map) const {
    return map.flat ? *map.flat : detected_flat_codes.at(map.texture.image);
}

}  // namespace relief::reference
