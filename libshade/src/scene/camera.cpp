// SPDX-License-Identifier: Apache-2.0
// Cameras that see all of a box or a scene. World space, radians. Vertices that are not finite are
// ignored. Tests: tests/shade/scene/scene_test.cpp.
#include "relief/shade/camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "portable_math.h"
#include "relief/mesh/report.h"
#include "relief/shade/scene.h"
#include "scene/scene_parts.h"

namespace relief::shade {
using namespace relief::detail;
using namespace relief::shade::detail;

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

glm::mat3 detail::orbit_axes(double azimuth, double elevation) {
    const glm::dvec2 azimuth_sincos(portable::sin(azimuth), portable::cos(azimuth));
    const glm::dvec2 elevation_sincos(portable::sin(elevation), portable::cos(elevation));
    const glm::dvec3 back(azimuth_sincos.x * elevation_sincos.y, elevation_sincos.x,
                          azimuth_sincos.y * elevation_sincos.y);
    const glm::dvec3 right(azimuth_sincos.y, 0.0, -azimuth_sincos.x);
    return {glm::vec3(right), glm::vec3(glm::cross(back, right)), glm::vec3(back)};
}

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

}  // namespace relief::shade
