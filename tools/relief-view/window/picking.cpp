// SPDX-License-Identifier: Apache-2.0
// Ray against triangle by the signs of three volumes, in double, so that no crack between two
// triangles lets a ray through but by its own rounding. Tests: tests/tools/window/picking_test.cpp.
#include "window/picking.h"

#include <cmath>
#include <limits>

namespace relief::tools {
namespace {

using glm::dvec3;

/// How far along the ray a triangle is hit, in lengths of its direction; none: not at all.
std::optional<double> hit(const dvec3& origin, const dvec3& direction,
                          const std::array<dvec3, 3>& corners) {
    const dvec3 a = corners[0] - origin, b = corners[1] - origin, c = corners[2] - origin;
    const double u = glm::dot(direction, glm::cross(c, b));
    const double v = glm::dot(direction, glm::cross(a, c));
    const double w = glm::dot(direction, glm::cross(b, a));
    const bool is_inside = (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
    const double sum = u + v + w;
    if (!is_inside || sum == 0.0) return std::nullopt;
    const dvec3 point = (u * a + v * b + w * c) / sum;
    const double along = glm::dot(point, direction) / glm::dot(direction, direction);
    if (!(along > 0.0)) return std::nullopt;
    return along;
}

/// The nearest hit of one instance, in the same measure as for the ray in world space.
double nearest_in(const Mesh& mesh, const dvec3& origin, const dvec3& direction) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& triangle : mesh.triangles) {
        const std::array<dvec3, 3> corners = {dvec3(mesh.positions[triangle[0]]),
                                              dvec3(mesh.positions[triangle[1]]),
                                              dvec3(mesh.positions[triangle[2]])};
        const std::optional<double> along = hit(origin, direction, corners);
        if (along && *along < nearest) nearest = *along;
    }
    return nearest;
}

}  // namespace

Ray ray_through(const Camera& camera, const glm::vec2& pointer) {
    const float half_height = std::tan(0.5F * camera.vertical_fov);
    const glm::vec3 view(half_height * pointer.x, half_height * pointer.y, -1.0F);
    return {glm::vec3(camera.world_from_view[3]), glm::mat3(camera.world_from_view) * view};
}

std::optional<glm::vec3> surface_on(const Scene& scene, const Ray& ray) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Instance& instance : scene.instances) {
        // An affine map keeps the measure along the ray.
        const glm::dmat4 object_from_world = glm::inverse(glm::dmat4(instance.world_from_object));
        const dvec3 origin(object_from_world * glm::dvec4(ray.origin, 1.0));
        const dvec3 direction(object_from_world * glm::dvec4(ray.direction, 0.0));
        nearest = std::min(nearest, nearest_in(*scene.meshes[instance.mesh], origin, direction));
    }
    if (!std::isfinite(nearest)) return std::nullopt;
    return glm::vec3(dvec3(ray.origin) + nearest * dvec3(ray.direction));
}

void aim_at(OrbitCamera& orbit, const glm::vec3& point) {
    const Camera camera = camera_of(orbit, Ball{});
    const glm::vec3 back(camera.world_from_view[2]);
    const float depth = glm::dot(glm::vec3(camera.world_from_view[3]) - point, back);
    if (!(depth > 0.0F)) return;
    orbit.target = point;
    orbit.distance = depth;
}

}  // namespace relief::tools
