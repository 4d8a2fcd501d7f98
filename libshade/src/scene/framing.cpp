// SPDX-License-Identifier: Apache-2.0
// The nearest camera on a line of sight that still sees all vertices. World space. Vertices that
// are not finite have no say. Tests: tests/shade/scene/framing_test.cpp.
#include "relief/shade/framing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "relief/mesh/error.h"

namespace relief {
namespace {

/// Room around the model.
constexpr float margin = 1.04F;

/// How far from the target, along the line of sight, the eye must be to see this point.
///
/// \param point  relative to the target, in the camera's axes: z towards the eye
float distance_to_see(const glm::vec3& point, float tan_x, float tan_y) {
    return point.z + margin * std::max(std::abs(point.x) / tan_x, std::abs(point.y) / tan_y);
}

/// How much nearer to (below 1) or farther from `target` the camera must be to see every finite
/// vertex. 1 where there is none.
float fitting_factor(const Scene& scene, const Camera& camera, const glm::vec3& target,
                     float aspect) {
    const float tan_y = std::tan(0.5F * camera.vertical_fov);
    const float tan_x = aspect * tan_y;
    const glm::mat3 view_from_world = glm::transpose(glm::mat3(camera.world_from_view));
    float needed = 0;
    for (const Instance& instance : scene.instances) {
        glm::mat4 from_target = instance.world_from_object;
        from_target[3] -= glm::vec4(target, 0.0F);
        const glm::mat4 view_from_object = glm::mat4(view_from_world) * from_target;
        for (const glm::vec3& position : scene.meshes[instance.mesh]->positions) {
            const glm::vec3 point(view_from_object * glm::vec4(position, 1.0F));
            const float distance = distance_to_see(point, tan_x, tan_y);
            if (std::isfinite(distance)) needed = std::max(needed, distance);
        }
    }
    const float distance = glm::distance(glm::vec3(camera.world_from_view[3]), target);
    return needed > 0 && distance > 0 ? needed / distance : 1.0F;
}

}  // namespace

Camera at_distance(Camera camera, const glm::vec3& target, float factor) {
    // Nearer than this share of the far plane, depth would lose its precision.
    constexpr float nearest_share = 1e-4F;
    const glm::vec3 eye(camera.world_from_view[3]);
    const float moved = (factor - 1.0F) * glm::distance(eye, target);
    camera.world_from_view[3] = glm::vec4(target + factor * (eye - target), 1.0F);
    camera.far += moved;
    camera.near = std::max(camera.near + moved, nearest_share * camera.far);
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

}  // namespace relief
