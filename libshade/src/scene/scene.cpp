// SPDX-License-Identifier: Apache-2.0
// Properties of a scene as a whole: its box, the names of its parts in messages, and the use
// of the default material. World space.
#include "relief/shade/scene.h"

#include <fmt/format.h>

#include <algorithm>

#include "relief/shade/effects.h"
#include "relief/shade/frame_settings.h"
#include "scene/is_finite.h"

namespace relief {

namespace {

/// The name in quotes, or the number if the name is empty.
std::string label(const char* kind, std::size_t index, const std::string& name) {
    if (!name.empty()) return fmt::format("{} '{}'", kind, name);
    return fmt::format("{} {}", kind, index);
}

/// The name of a part; empty if there is no such part.
template <typename Named>
std::string name_of(const std::vector<Named>& parts, std::size_t index) {
    return index < parts.size() ? parts[index].name : std::string();
}

std::string name_of(const std::vector<Shared<Mesh>>& meshes, std::size_t index) {
    return index < meshes.size() ? meshes[index]->name : std::string();
}

/// Tells whether a mesh has triangles without a material.
bool has_bare_triangles(const Mesh& mesh) {
    if (mesh.triangles.empty()) return false;
    return mesh.material_ranges.empty() ||
           std::any_of(mesh.material_ranges.begin(), mesh.material_ranges.end(),
                       [](const MaterialRange& range) { return !range.material; });
}

}  // namespace

Bounds world_bounds(const Scene& scene) {
    Bounds bounds;
    for (const Instance& instance : scene.instances) {
        for (const glm::vec3& position : scene.meshes.at(instance.mesh)->positions) {
            const glm::vec3 world(instance.world_from_object * glm::vec4(position, 1.0F));
            if (!is_finite(world)) continue;
            bounds.min = glm::min(bounds.min, world);
            bounds.max = glm::max(bounds.max, world);
        }
    }
    return bounds;
}

std::string material_label(const Scene& scene, std::optional<std::size_t> material) {
    if (!material) return "the default material";
    return label("material", *material, name_of(scene.materials, *material));
}

std::string instance_label(const Scene& scene, std::size_t instance) {
    const std::string name = name_of(scene.instances, instance);
    if (name.empty() && instance < scene.instances.size()) {
        const std::size_t mesh = scene.instances[instance].mesh;
        if (!name_of(scene.meshes, mesh).empty()) return mesh_label(scene, mesh);
    }
    return label("instance", instance, name);
}

std::string mesh_label(const Scene& scene, std::size_t mesh) {
    return label("mesh", mesh, name_of(scene.meshes, mesh));
}

bool uses_default_material(const Scene& scene) {
    return std::any_of(scene.meshes.begin(), scene.meshes.end(),
                       [](const Mesh& mesh) { return has_bare_triangles(mesh); });
}

void name_default_material(Scene& scene) {
    const auto index = static_cast<std::uint32_t>(scene.materials.size());
    bool is_used = false;
    for (Shared<Mesh>& shared : scene.meshes) {
        if (!has_bare_triangles(*shared)) continue;
        is_used = true;
        Mesh& mesh = shared.edit();
        if (mesh.material_ranges.empty()) {
            mesh.material_ranges.push_back(
                {0, static_cast<std::uint32_t>(mesh.triangles.size()), std::nullopt});
        }
        for (MaterialRange& range : mesh.material_ranges) {
            if (!range.material) range.material = index;
        }
    }
    if (is_used) scene.materials.push_back(default_material());
}

}  // namespace relief
