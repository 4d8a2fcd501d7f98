// SPDX-License-Identifier: Apache-2.0
#include "window/orbit_camera.h"
#include "light_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>
#include <vector>

namespace relief::tools {
using namespace relief::shade;

namespace {

constexpr float half_turn = std::numbers::pi_v<float>;
constexpr float pole = 0.5F * half_turn;
constexpr float margin = 1.04F;  // Around the model, as in framed().
// The smallest ratio of the near to the far plane. A smaller one would reduce the depth precision.
constexpr float min_near_share = 1e-4F;
constexpr float zoom_step = 0.9F;      // Factor of the distance per step.
constexpr float min_distance = 1e-4F;  // In radii of the sphere, limited by float precision.
constexpr float max_distance = 1e4F;

/// Axes of the camera in world space: right, up, backward.
glm::mat3 axes_of(const OrbitCamera& orbit) {
    const glm::vec3 back(std::cos(orbit.elevation) * std::sin(orbit.azimuth),
                         std::sin(orbit.elevation),
                         std::cos(orbit.elevation) * std::cos(orbit.azimuth));
    const glm::vec3 right(std::cos(orbit.azimuth), 0.0F, -std::sin(orbit.azimuth));
    return {right, glm::cross(back, right), back};
}

/// The visible height at the distance of the target.
float visible_height(const OrbitCamera& orbit) {
    return 2.0F * orbit.distance * std::tan(0.5F * orbit.vertical_fov);
}

/// Limits an angle to one turn, so that repeated rotation loses no precision.
float wrapped(float angle) {
    return std::remainder(angle, 2.0F * half_turn);
}

}  // namespace

BoundingSphere bounding_sphere(const Bounds& bounds) {
    if (bounds.empty()) return {};
    const glm::vec3 half = 0.5F * bounds.max - 0.5F * bounds.min;
    const float radius = glm::length(half);
    const bool has_size = radius > std::numeric_limits<float>::min() && std::isfinite(radius);
    return {bounds.min + half, has_size ? radius : 1.0F};
}

Camera camera_of(const OrbitCamera& orbit, const BoundingSphere& sphere) {
    const glm::mat3 axes = axes_of(orbit);
    float distance = orbit.distance;
    if (orbit.orthographic) {
        // The model stays in front of the near plane when the picture is enlarged.
        const float depth = glm::dot(sphere.center - orbit.target, axes[2]);
        distance = std::max(distance, depth + 1.5F * margin * sphere.radius);
    }
    const glm::vec3 eye = orbit.target + distance * axes[2];
    Camera camera;
    if (orbit.orthographic) camera.orthographic_height = visible_height(orbit);
    camera.world_from_view = glm::mat4(axes);
    camera.world_from_view[3] = glm::vec4(eye, 1.0F);
    camera.vertical_fov = orbit.vertical_fov;
    return with_depth_range(camera, sphere);
}

Camera with_depth_range(Camera camera, const BoundingSphere& sphere) {
    const glm::vec3 eye(camera.world_from_view[3]);
    const float depth = glm::dot(eye - sphere.center, glm::vec3(camera.world_from_view[2]));
    camera.far = std::max(depth + margin * sphere.radius, margin * sphere.radius);
    camera.near = std::max(depth - margin * sphere.radius, min_near_share * camera.far);
    return camera;
}

OrbitCamera orbit_of(const CameraOption& option, const CameraPlace& place, float vertical_fov,
                     bool orthographic) {
    return {place.target,   option.azimuth, option.elevation,
            place.distance, vertical_fov,   orthographic};
}

OrbitCamera orbit_of(const Camera& camera, const BoundingSphere& sphere) {
    const glm::vec3 eye(camera.world_from_view[3]);
    const glm::vec3 back = glm::normalize(glm::vec3(camera.world_from_view[2]));
    OrbitCamera orbit;
    orbit.elevation = std::asin(std::clamp(back.y, -1.0F, 1.0F));
    const glm::vec3 right(camera.world_from_view[0]);
    // At the poles, the azimuth follows from the right axis.
    const bool at_pole = std::abs(back.y) > 0.99999F;
    orbit.azimuth = at_pole ? std::atan2(-right.z, right.x) : std::atan2(back.x, back.z);
    orbit.vertical_fov = camera.vertical_fov;
    const float depth = glm::dot(eye - sphere.center, back);
    orbit.distance = depth > min_distance * sphere.radius ? depth : sphere.radius;
    orbit.target = eye - orbit.distance * back;
    if (camera.orthographic_height) {
        orbit.orthographic = true;
        orbit.distance = *camera.orthographic_height / (2.0F * std::tan(0.5F * orbit.vertical_fov));
    }
    return orbit;
}

void orbit_by(OrbitCamera& orbit, const glm::vec2& pixels, int view_height) {
    const glm::vec2 turn = pixels * (half_turn / static_cast<float>(std::max(view_height, 1)));
    orbit.azimuth = wrapped(orbit.azimuth - turn.x);
    orbit.elevation = std::clamp(orbit.elevation + turn.y, -pole, pole);
}

void pan_by(OrbitCamera& orbit, const glm::vec2& pixels, int view_height) {
    const glm::mat3 axes = axes_of(orbit);
    const float unit = visible_height(orbit) / static_cast<float>(std::max(view_height, 1));
    orbit.target += unit * (pixels.y * axes[1] - pixels.x * axes[0]);
}

void zoom_by(OrbitCamera& orbit, float steps, const glm::vec2& pointer,
             const BoundingSphere& sphere) {
    const float before = visible_height(orbit);
    orbit.distance = std::clamp(orbit.distance * std::pow(zoom_step, steps),
                                min_distance * sphere.radius, max_distance * sphere.radius);
    const glm::mat3 axes = axes_of(orbit);
    const float shrunk = 0.5F * (before - visible_height(orbit));
    orbit.target += shrunk * (pointer.x * axes[0] + pointer.y * axes[1]);
}

void fit(OrbitCamera& orbit, const BoundingSphere& sphere, float aspect) {
    const float half_height = 0.5F * orbit.vertical_fov;
    const float half_width = std::atan(std::tan(half_height) * aspect);
    const float half = std::min(half_height, half_width);
    orbit.target = sphere.center;
    orbit.distance =
        margin * sphere.radius / (orbit.orthographic ? std::tan(half) : std::sin(half));
}

std::string degrees_text(float radians) {
    constexpr int fewest_digits = 6;
    constexpr int digits_of_double = 17;
    const double degrees = glm::degrees(static_cast<double>(radians));
    for (int digits = fewest_digits;; ++digits) {
        const std::string text = fmt::format("{:.{}g}", degrees, digits);
        const auto again = static_cast<float>(glm::radians(std::stod(text)));
        if (again == radians || digits == digits_of_double) return text;
    }
}

std::string to_text(const OrbitCamera& orbit) {
    return fmt::format("{},{}@{},{},{},{}", degrees_text(orbit.azimuth),
                       degrees_text(orbit.elevation), orbit.target.x, orbit.target.y,
                       orbit.target.z, orbit.distance);
}

namespace {

using glm::dvec3;

/// The ray parameter of the hit with a triangle. The signs of three volumes are computed in double
/// precision, so a ray can pass between adjacent triangles only because of rounding.
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

/// The smallest ray parameter of the hits in a mesh.
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
    if (camera.orthographic_height) {
        const glm::vec2 place = 0.5F * *camera.orthographic_height * pointer;
        return {glm::vec3(camera.world_from_view * glm::vec4(place, 0.0F, 1.0F)),
                -glm::vec3(camera.world_from_view[2])};
    }
    const float half_height = std::tan(0.5F * camera.vertical_fov);
    const glm::vec3 view(half_height * pointer.x, half_height * pointer.y, -1.0F);
    return {glm::vec3(camera.world_from_view[3]), glm::mat3(camera.world_from_view) * view};
}

std::optional<glm::vec3> surface_hit(const Scene& scene, const Ray& ray) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        // An affine map keeps the ray parameter.
        const glm::dmat4 object_from_world =
            glm::inverse(glm::dmat4(scene.instances[i].world_from_object));
        const dvec3 origin(object_from_world * glm::dvec4(ray.origin, 1.0));
        const dvec3 direction(object_from_world * glm::dvec4(ray.direction, 0.0));
        nearest = std::min(nearest, nearest_in(*deformed_mesh(scene, i), origin, direction));
    }
    if (!std::isfinite(nearest)) return std::nullopt;
    return glm::vec3(dvec3(ray.origin) + nearest * dvec3(ray.direction));
}

void aim_at(OrbitCamera& orbit, const glm::vec3& point) {
    const Camera camera = camera_of(orbit, BoundingSphere{});
    const glm::vec3 back(camera.world_from_view[2]);
    const float depth = glm::dot(glm::vec3(camera.world_from_view[3]) - point, back);
    if (!(depth > 0.0F) && !orbit.orthographic) return;
    orbit.target = point;
    if (!orbit.orthographic) orbit.distance = depth;
}

namespace {

std::vector<std::string> to_string(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> words;
    for (std::string word; stream >> word;)
        words.push_back(word);
    return words;
}

/// The value of an option, "--fov 35" or "--fov=35".
std::optional<std::string> value_of(const std::vector<std::string>& words,
                                    const std::string& option) {
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (words[i] == option && i + 1 < words.size()) return words[i + 1];
        if (words[i].starts_with(option + "=")) return words[i].substr(option.size() + 1);
    }
    return std::nullopt;
}

}  // namespace

ViewText parse_view_text(const std::string& text) {
    const std::vector<std::string> words = to_string(text);
    std::optional<std::string> camera = value_of(words, "--camera");
    if (!camera && words.size() == 1) camera = words.front();
    if (!camera) throw UsageError("the pasted text contains no camera", "copy one with Ctrl+C");
    ViewText view;
    view.camera = parse_camera("pasted " + *camera, *camera);
    if (const auto fov = value_of(words, "--fov"))
        view.vertical_fov = parse_fov("pasted --fov " + *fov, *fov);
    view.orthographic = std::find(words.begin(), words.end(), "--orthographic") != words.end();
    return view;
}

}  // namespace relief::tools
