// SPDX-License-Identifier: Apache-2.0
// Boxes of scenes, and the camera that frames one. World space, radians. Non-finite vertices have
// no place and no say. Tests: tests/shade/scene/scene_test.cpp.
#include "relief/shade/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "relief/mesh/error.h"
#include "scene/is_finite.h"
#include "scene/orbit_axes.h"

namespace relief {

namespace {

/// How much more than the box is seen, so that nothing touches the picture's edge.
constexpr float framing_margin = 1.05F;

/// The eight corners of a box, seen from its centre along the axes of a camera.
std::array<glm::vec3, 8> corners_in(const glm::mat3& world_from_view, const glm::vec3& half_size) {
    std::array<glm::vec3, 8> corners;
    for (std::size_t i = 0; i < 8; ++i) {
        const glm::vec3 sign((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1);
        corners[i] = glm::transpose(world_from_view) * (sign * half_size);
    }
    return corners;
}

void check_view(float azimuth, float elevation, float vertical_fov, float aspect) {
    if (!std::isfinite(azimuth) || !std::isfinite(elevation)) {
        throw InvalidInput(
            fmt::format("camera direction {}, {} is not finite", azimuth, elevation));
    }
    if (!(vertical_fov > 0.0F && vertical_fov < std::numbers::pi_v<float>)) {
        throw InvalidInput(
            fmt::format("vertical field of view is {}, but must be within (0, pi)", vertical_fov));
    }
    if (!(aspect > 0.0F) || !std::isfinite(aspect)) {
        throw InvalidInput(fmt::format("aspect ratio is {}, but must be positive", aspect));
    }
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

Camera framed(const Bounds& world, float azimuth, float elevation, float vertical_fov,
              float aspect) {
    check_view(azimuth, elevation, vertical_fov, aspect);
    const glm::mat3 axes = orbit_axes(static_cast<double>(azimuth), static_cast<double>(elevation));
    const glm::vec3 center =
        world.empty() ? glm::vec3(0.0F) : world.min + (world.max - world.min) * 0.5F;
    const glm::vec3 half_size =
        world.empty() ? glm::vec3(0.0F) : (world.max - world.min) * (0.5F * framing_margin);

    const float tan_y = std::tan(vertical_fov * 0.5F);
    const float tan_x = tan_y * aspect;
    float distance = 0.0F;
    float depth = 0.0F;  // Half of the box's extent along the view.
    for (const glm::vec3& corner : corners_in(axes, half_size)) {
        distance = std::max(
            distance, corner.z + std::max(std::abs(corner.x) / tan_x, std::abs(corner.y) / tan_y));
        depth = std::max(depth, std::abs(corner.z));
    }
    // A flat box seen edge-on, or none at all: distance 1 for a point, else the eye stays outside.
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

}  // namespace relief
