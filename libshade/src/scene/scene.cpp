// SPDX-License-Identifier: Apache-2.0
// Properties of a scene as a whole: its box, the names of its parts in messages, the use of the
// default material, and cameras that see all of it with default lights to go with them. World
// space, radians. Vertices that are not finite are ignored.
#include "relief/shade/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "portable_math.h"
#include "relief/mesh/report.h"
#include "relief/shade/effects.h"
#include "relief/shade/frame_settings.h"
#include "scene/scene_parts.h"

namespace relief {

// Boxes, names and the default material

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

void add_instance(const Scene& scene, std::size_t instance, Bounds& world) {
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

// Framing

namespace {

/// The picture shows the box enlarged by this factor, so that nothing touches its edge.
constexpr float box_margin = 1.05F;

/// Returns the eight corners of a box relative to its center, in the axes of a camera.
std::array<glm::vec3, 8> corners_in(const glm::mat3& world_from_view, const glm::vec3& half_size) {
    std::array<glm::vec3, 8> corners;
    for (std::size_t i = 0; i < 8; ++i) {
        const glm::vec3 sign((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1);
        corners[i] = glm::transpose(world_from_view) * (sign * half_size);
    }
    return corners;
}

float tan_of_half(float angle) {
    return static_cast<float>(portable::tan(static_cast<double>(angle) * 0.5));
}

void check_view(float azimuth, float elevation, float vertical_fov, float aspect) {
    if (!std::isfinite(azimuth) || !std::isfinite(elevation)) {
        throw InvalidInput(
            fmt::format("camera direction {}, {} is not finite", azimuth, elevation));
    }
    check_field_of_view("", vertical_fov);
    if (!(aspect > 0.0F) || !std::isfinite(aspect)) {
        throw InvalidInput(fmt::format("aspect ratio is {}, but must be positive", aspect));
    }
}

/// The factor between the picture's size and the size of the model in it.
constexpr float vertex_margin = 1.04F;

/// Returns the distance of the eye from the target, along the line of sight, at which it sees this
/// point.
///
/// \param point  relative to the target, in the axes of the camera: z points to the eye
float distance_to_see(const glm::vec3& point, float tan_x, float tan_y) {
    return point.z + vertex_margin * std::max(std::abs(point.x) / tan_x, std::abs(point.y) / tan_y);
}

/// Calls visit(point) for every vertex, relative to a place of the world and in the axes of a
/// camera.
template <typename Visit>
void for_each_point(const Scene& scene, const Camera& camera, const glm::vec3& place,
                    const Visit& visit) {
    const glm::mat3 view_from_world = glm::transpose(glm::mat3(camera.world_from_view));
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        glm::mat4 from_place = scene.instances[i].world_from_object;
        from_place[3] -= glm::vec4(place, 0.0F);
        const glm::mat4 view_from_object = glm::mat4(view_from_world) * from_place;
        const Shared<Mesh> mesh = deformed_mesh(scene, i);
        for (const glm::vec3& position : mesh->positions)
            visit(glm::vec3(view_from_object * glm::vec4(position, 1.0F)));
    }
}

/// Returns the factor by which the distance from the camera to `target` must change for the camera
/// to see every finite vertex. 1 if there is none.
float fitting_factor(const Scene& scene, const Camera& camera, const glm::vec3& target,
                     float aspect) {
    const float tan_y = tan_of_half(camera.vertical_fov);
    const float tan_x = aspect * tan_y;
    float needed = 0;
    for_each_point(scene, camera, target, [&](const glm::vec3& point) {
        const float distance = distance_to_see(point, tan_x, tan_y);
        if (std::isfinite(distance)) needed = std::max(needed, distance);
    });
    const float distance = glm::distance(glm::vec3(camera.world_from_view[3]), target);
    return needed > 0 && distance > 0 ? needed / distance : 1.0F;
}

}  // namespace

Camera framed(const Bounds& world, float azimuth, float elevation, float vertical_fov,
              float aspect) {
    check_view(azimuth, elevation, vertical_fov, aspect);
    const glm::mat3 axes = orbit_axes(static_cast<double>(azimuth), static_cast<double>(elevation));
    const glm::vec3 center =
        world.empty() ? glm::vec3(0.0F) : world.min + (world.max - world.min) * 0.5F;
    const glm::vec3 half_size =
        world.empty() ? glm::vec3(0.0F) : (world.max - world.min) * (0.5F * box_margin);

    const float tan_y = tan_of_half(vertical_fov);
    const float tan_x = tan_y * aspect;
    float distance = 0.0F;
    float depth = 0.0F;  // Half of the extent of the box along the view.
    for (const glm::vec3& corner : corners_in(axes, half_size)) {
        distance = std::max(
            distance, corner.z + std::max(std::abs(corner.x) / tan_x, std::abs(corner.y) / tan_y));
        depth = std::max(depth, std::abs(corner.z));
    }
    // A box without extent is seen from distance 1. The eye stays outside of a flat box seen
    // edge-on.
    const float size = glm::length(half_size);
    if (!(size > 0.0F)) distance = 1.0F;
    distance = std::max(distance, depth + 0.01F * size);

    Camera camera;
    camera.vertical_fov = vertical_fov;
    camera.world_from_view = glm::mat4(axes);
    camera.world_from_view[3] = glm::vec4(center + axes[2] * distance, 1.0F);
    camera.near = size > 0.0F ? std::max(distance - depth, 0.001F * distance) : 0.1F;
    camera.far = size > 0.0F ? distance + depth + 0.01F * size : 10.0F;
    return camera;
}

Camera orthographic(const Scene& scene, Camera camera, float aspect) {
    float half = 0.0F;
    for_each_point(scene, camera, glm::vec3(camera.world_from_view[3]),
                   [&](const glm::vec3& point) {
                       const float reach = std::max(std::abs(point.x) / aspect, std::abs(point.y));
                       if (std::isfinite(reach)) half = std::max(half, reach);
                   });
    camera.orthographic_height = half > 0.0F ? 2.0F * vertex_margin * half : 1.0F;
    return camera;
}

Camera at_distance(Camera camera, const glm::vec3& target, float factor) {
    if (camera.orthographic_height) {
        *camera.orthographic_height *= factor;
        return camera;
    }
    const glm::vec3 eye(camera.world_from_view[3]);
    const float moved = (factor - 1.0F) * glm::distance(eye, target);
    camera.world_from_view[3] = glm::vec4(target + factor * (eye - target), 1.0F);
    camera.far += moved;
    camera.near = std::max(camera.near + moved, min_near_share * camera.far);
    return camera;
}

Camera framed(const Scene& scene, float azimuth, float elevation, float vertical_fov, float aspect,
              float distance_factor) {
    if (!(distance_factor > 0.0F && std::isfinite(distance_factor))) {
        throw InvalidInput(
            fmt::format("distance factor is {}, but must be positive and finite", distance_factor));
    }
    const Bounds bounds = world_bounds(scene);
    const glm::vec3 center =
        bounds.empty() ? glm::vec3(0.0F) : bounds.min + (bounds.max - bounds.min) * 0.5F;
    const Camera boxed = framed(bounds, azimuth, elevation, vertical_fov, aspect);
    const float factor = distance_factor * fitting_factor(scene, boxed, center, aspect);
    return at_distance(boxed, center, factor);
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

}  // namespace relief
