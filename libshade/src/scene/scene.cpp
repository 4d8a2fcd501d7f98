// SPDX-License-Identifier: Apache-2.0
// Properties of a scene as a whole: its box, the names of its parts in messages, the use of the
// default material, its ambient light, and its default lights and environment. Vertices that are
// not finite are ignored.
#include "relief/shade/scene.h"

#include <fmt/format.h>

#include <algorithm>

#include "portable_math.h"
#include "relief/shade/effects.h"
#include "relief/shade/frame_settings.h"
#include "scene/scene_parts.h"

namespace relief::shade {
using namespace relief::detail;
using namespace relief::shade::detail;

namespace {

/// Returns the name in quotes, or the number if the name is empty.
std::string label(const char* kind, std::size_t index, const std::string& name) {
    if (!name.empty()) return fmt::format("{} '{}'", kind, name);
    return fmt::format("{} {}", kind, index);
}

/// Returns the name of a part; empty if there is no such part.
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

void detail::add_instance(const Scene& scene, std::size_t instance, Bounds& world) {
    const glm::mat4& world_from_object = scene.instances[instance].world_from_object;
    const Shared<Mesh> mesh = deformed_mesh(scene, instance);
    for (const glm::vec3& position_object : mesh->positions) {
        const glm::vec3 position(world_from_object * glm::vec4(position_object, 1.0F));
        if (!is_finite(position)) continue;
        world.min = glm::min(world.min, position);
        world.max = glm::max(world.max, position);
    }
}

Bounds world_bounds(const Scene& scene) {
    Bounds bounds;
    for (std::size_t i = 0; i < scene.instances.size(); ++i)
        add_instance(scene, i, bounds);
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

glm::vec3 ambient_light(const Scene& scene) {
    glm::vec3 sum = scene.ambient;
    const auto add = [&](const auto& light) {
        if (light.on) sum += light.ambient;
    };
    for (const DirectionalLight& light : scene.directional_lights)
        add(light);
    for (const PointLight& light : scene.point_lights)
        add(light);
    for (const SpotLight& light : scene.spot_lights)
        add(light.point);
    return sum;
}

std::optional<std::string> add_default_environment(Scene& scene) {
    if (scene.environment) return std::nullopt;
    const auto shows_surroundings = [](const Material& material) {
        const std::optional<MetallicRoughness>& model = material.metallic_roughness;
        return model && !material.unlit &&
               (model->metallic > 0.0F || model->clearcoat > 0.0F || model->transmission > 0.0F);
    };
    for (const Instance& instance : scene.instances) {
        for (const MaterialRange& range : scene.meshes[instance.mesh]->material_ranges) {
            if (!range.material || range.triangle_count == 0) continue;
            if (!shows_surroundings(scene.materials[*range.material])) continue;
            scene.environment = studio_environment();
            return material_label(scene, range.material);
        }
    }
    return std::nullopt;
}

void add_default_lights(Scene& scene, const Camera& camera) {
    constexpr float ambient = 0.08F;
    const glm::mat3 world_from_view(camera.world_from_view);
    const glm::vec3 to_key_view{-0.7F, 0.64F, 0.32F};
    const glm::vec3 to_fill_view{0.85F, 0.05F, 0.5F};
    scene.directional_lights.push_back(
        {.direction_world = world_from_view * -to_key_view, .irradiance = {1.0F, 0.97F, 0.92F}});
    scene.directional_lights.push_back(
        {.direction_world = world_from_view * -to_fill_view, .irradiance = {0.18F, 0.2F, 0.23F}});
    scene.ambient = glm::vec3(ambient);
}

}  // namespace relief::shade
