// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/orbit_camera_test.cpp.
#include "window/orbit_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace relief::tools {
namespace {

constexpr float half_turn = std::numbers::pi_v<float>;
constexpr float pole = 0.5F * half_turn;
constexpr float room = 1.04F;             // Around the model, as framed() leaves it.
constexpr float nearest_share = 1e-4F;    // Of the far plane: nearer, depth loses its precision.
constexpr float step = 0.9F;              // Of the distance, for each step of the wheel.
constexpr float nearest_to_ball = 1e-4F;  // Of its radius; nearer, floats are too coarse.
constexpr float farthest_of_ball = 1e4F;

/// Axes of the eye in world space: right, up, backwards.
glm::mat3 axes_of(const OrbitCamera& orbit) {
    const glm::vec3 back(std::cos(orbit.elevation) * std::sin(orbit.azimuth),
                         std::sin(orbit.elevation),
                         std::cos(orbit.elevation) * std::cos(orbit.azimuth));
    const glm::vec3 right(std::cos(orbit.azimuth), 0.0F, -std::sin(orbit.azimuth));
    return {right, glm::cross(back, right), back};
}

/// The height of what is seen as far away as the target.
float seen_height(const OrbitCamera& orbit) {
    return 2.0F * orbit.distance * std::tan(0.5F * orbit.vertical_fov);
}

/// Within a turn, so that turning on and on costs no digits.
float wrapped(float angle) {
    return std::remainder(angle, 2.0F * half_turn);
}

}  // namespace

Ball ball_around(const Bounds& bounds) {
    if (bounds.empty()) return {};
    const glm::vec3 half = 0.5F * bounds.max - 0.5F * bounds.min;
    const float radius = glm::length(half);
    const bool has_size = radius > std::numeric_limits<float>::min() && std::isfinite(radius);
    return {bounds.min + half, has_size ? radius : 1.0F};
}

Camera camera_of(const OrbitCamera& orbit, const Ball& ball) {
    const glm::mat3 axes = axes_of(orbit);
    const glm::vec3 eye = orbit.target + orbit.distance * axes[2];
    Camera camera;
    camera.world_from_view = glm::mat4(axes);
    camera.world_from_view[3] = glm::vec4(eye, 1.0F);
    camera.vertical_fov = orbit.vertical_fov;
    return seeing(camera, ball);
}

Camera seeing(Camera camera, const Ball& ball) {
    const glm::vec3 eye(camera.world_from_view[3]);
    const float depth = glm::dot(eye - ball.center, glm::vec3(camera.world_from_view[2]));
    camera.far = std::max(depth + room * ball.radius, room * ball.radius);
    camera.near = std::max(depth - room * ball.radius, nearest_share * camera.far);
    return camera;
}

OrbitCamera orbit_of(const CameraOption& option, const CameraPlace& place, float vertical_fov) {
    return {place.target, option.azimuth, option.elevation, place.distance, vertical_fov};
}

OrbitCamera orbit_of(const Camera& camera, const Ball& ball) {
    const glm::vec3 eye(camera.world_from_view[3]);
    const glm::vec3 back = glm::normalize(glm::vec3(camera.world_from_view[2]));
    OrbitCamera orbit;
    orbit.elevation = std::asin(std::clamp(back.y, -1.0F, 1.0F));
    const glm::vec3 right(camera.world_from_view[0]);
    // Straight up or down, azimuth is where the right-hand side says.
    const bool at_pole = std::abs(back.y) > 0.99999F;
    orbit.azimuth = at_pole ? std::atan2(-right.z, right.x) : std::atan2(back.x, back.z);
    orbit.vertical_fov = camera.vertical_fov;
    const float depth = glm::dot(eye - ball.center, back);
    orbit.distance = depth > nearest_to_ball * ball.radius ? depth : ball.radius;
    orbit.target = eye - orbit.distance * back;
    return orbit;
}

void orbit_by(OrbitCamera& orbit, const glm::vec2& pixels, int view_height) {
    const glm::vec2 turn = pixels * (half_turn / static_cast<float>(std::max(view_height, 1)));
    orbit.azimuth = wrapped(orbit.azimuth - turn.x);
    orbit.elevation = std::clamp(orbit.elevation + turn.y, -pole, pole);
}

void pan_by(OrbitCamera& orbit, const glm::vec2& pixels, int view_height) {
    const glm::mat3 axes = axes_of(orbit);
    const float unit = seen_height(orbit) / static_cast<float>(std::max(view_height, 1));
    orbit.target += unit * (pixels.y * axes[1] - pixels.x * axes[0]);
}

void zoom_by(OrbitCamera& orbit, float steps, const glm::vec2& pointer, const Ball& ball) {
    const float before = seen_height(orbit);
    orbit.distance = std::clamp(orbit.distance * std::pow(step, steps),
                                nearest_to_ball * ball.radius, farthest_of_ball * ball.radius);
    const glm::mat3 axes = axes_of(orbit);
    const float shrunk = 0.5F * (before - seen_height(orbit));
    orbit.target += shrunk * (pointer.x * axes[0] + pointer.y * axes[1]);
}

void fit(OrbitCamera& orbit, const Ball& ball, float aspect) {
    const float half_height = 0.5F * orbit.vertical_fov;
    const float half_width = std::atan(std::tan(half_height) * aspect);
    orbit.target = ball.center;
    orbit.distance = room * ball.radius / std::sin(std::min(half_height, half_width));
}

std::string degrees_text(float radians) {
    constexpr int usual_digits = 6;
    constexpr int digits_of_double = 17;
    const double degrees = glm::degrees(static_cast<double>(radians));
    for (int digits = usual_digits;; ++digits) {
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

}  // namespace relief::tools
