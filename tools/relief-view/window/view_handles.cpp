// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/view_handles_test.cpp.
#include "window/view_handles.h"

#include <algorithm>
#include <cmath>
#include <variant>

namespace relief::tools {
using namespace relief::shade;

namespace {

glm::vec3 eye_of(const Camera& camera) {
    return glm::vec3(camera.world_from_view[3]);
}

/// Unit vector from the scene towards the camera.
glm::vec3 back_of(const Camera& camera) {
    return glm::vec3(camera.world_from_view[2]);
}

const glm::vec3& position_of(const AnyLight& light) {
    if (const auto* spot = std::get_if<SpotLight>(&light)) return spot->point.position_world;
    return std::get<PointLight>(light).position_world;
}

glm::vec3 unit_or_up(const glm::vec3& v) {
    const float length = glm::length(v);
    return length > 0.0F ? v / length : glm::vec3(0.0F, 1.0F, 0.0F);
}

/// Returns whether a point is on the half of the sphere that the camera does not see.
bool is_behind(const Camera& camera, const BoundingSphere& sphere, const glm::vec3& point) {
    const glm::vec3 normal = point - sphere.center;
    const glm::vec3 view = camera.orthographic_height ? back_of(camera) : eye_of(camera) - point;
    return glm::dot(normal, view) < 0.0F;
}

/// The point of the sphere under the pointer. Outside of the outline, the point of the sphere that
/// is nearest to the ray.
struct SpherePoint {
    glm::vec3 direction{0.0F, 1.0F, 0.0F};  ///< Unit vector from the center.
    bool is_outside = false;
};
SpherePoint on_sphere(const Ray& ray, const BoundingSphere& sphere, bool wants_back) {
    const glm::vec3 along = glm::normalize(ray.direction);
    const glm::vec3 offset = sphere.center - ray.origin;
    const float middle = glm::dot(offset, along);
    const glm::vec3 nearest = ray.origin + middle * along - sphere.center;
    const float squared = sphere.radius * sphere.radius - glm::dot(nearest, nearest);
    if (!(squared > 0.0F)) return {unit_or_up(nearest), true};
    const float half = std::sqrt(squared);
    // From inside of the sphere, only its far side is in front of the camera.
    const bool is_far = wants_back || middle - half < 0.0F;
    return {unit_or_up(nearest + (is_far ? half : -half) * along), false};
}

}  // namespace

std::array<AxisEnd, 6> axis_ends(const OrbitCamera& camera) {
    const glm::mat3 view_from_world =
        glm::transpose(glm::mat3(camera_of(camera, BoundingSphere{}).world_from_view));
    constexpr std::array<std::pair<Action, const char*>, 6> ends{{{Action::right, "+x"},
                                                                  {Action::left, "-x"},
                                                                  {Action::top, "+y"},
                                                                  {Action::bottom, "-y"},
                                                                  {Action::front, "+z"},
                                                                  {Action::back, "-z"}}};
    std::array<AxisEnd, 6> all;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        const glm::vec3 direction =
            (i % 2 == 0 ? 1.0F : -1.0F) * view_from_world[static_cast<int>(i / 2)];
        all[i] = {ends[i].first, ends[i].second, {direction.x, direction.y}, direction.z};
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const AxisEnd& a, const AxisEnd& b) { return a.depth < b.depth; });
    return all;
}

std::optional<glm::vec2> projected(const Camera& camera, const glm::vec3& point_world) {
    const glm::mat3 view_from_world = glm::transpose(glm::mat3(camera.world_from_view));
    const glm::vec3 point = view_from_world * (point_world - eye_of(camera));
    if (camera.orthographic_height) return 2.0F / *camera.orthographic_height * glm::vec2(point);
    if (!(point.z < 0.0F)) return std::nullopt;
    return glm::vec2(point) / (-point.z * std::tan(0.5F * camera.vertical_fov));
}

glm::vec3 handle_of(const AnyLight& light, const BoundingSphere& sphere) {
    const auto* directional = std::get_if<DirectionalLight>(&light);
    if (directional == nullptr) return position_of(light);
    return sphere.center - sphere.radius * unit_or_up(directional->direction_world);
}

LightDrag::LightDrag(const AnyLight& light, const Camera& camera, const BoundingSphere& sphere,
                     const glm::vec2& pointer) {
    const glm::vec3 handle = handle_of(light, sphere);
    offset_ = projected(camera, handle).value_or(pointer) - pointer;
    is_behind_ = is_behind(camera, sphere, handle);
}

AnyLight LightDrag::moved(const AnyLight& light, const Camera& camera, const BoundingSphere& sphere,
                          const glm::vec2& pointer) {
    const Ray ray = ray_through(camera, pointer + offset_);
    AnyLight result = light;
    if (auto* directional = std::get_if<DirectionalLight>(&result)) {
        const bool was_outside = is_outside_;
        is_outside_ = on_sphere(ray, sphere, is_behind_).is_outside;
        if (was_outside && !is_outside_) is_behind_ = !is_behind_;
        directional->direction_world = -on_sphere(ray, sphere, is_behind_).direction;
        return result;
    }
    // The plane through the light that is parallel to the view.
    const glm::vec3 back = back_of(camera);
    const float along = glm::dot(ray.direction, back);
    if (along == 0.0F) return result;
    const float distance = glm::dot(position_of(light) - ray.origin, back) / along;
    const glm::vec3 position = ray.origin + distance * ray.direction;
    if (auto* spot = std::get_if<SpotLight>(&result)) {
        spot->point.position_world = position;
    } else {
        std::get<PointLight>(result).position_world = position;
    }
    return result;
}

}  // namespace relief::tools
