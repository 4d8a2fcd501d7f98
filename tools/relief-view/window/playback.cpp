// SPDX-License-Identifier: Apache-2.0
#include "window/playback.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace relief::tools {
using namespace relief::shade;

namespace {

/// Times at which the reach of an animation is measured.
constexpr int reach_samples = 16;

void add_corners(Bounds& bounds, const Bounds& box, const glm::mat4& world_from_object) {
    if (box.empty()) return;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec4 at((corner & 1) != 0 ? box.max.x : box.min.x,
                           (corner & 2) != 0 ? box.max.y : box.min.y,
                           (corner & 4) != 0 ? box.max.z : box.min.z, 1.0F);
        const glm::vec3 world(world_from_object * at);
        if (!std::isfinite(world.x + world.y + world.z)) continue;
        bounds.min = glm::min(bounds.min, world);
        bounds.max = glm::max(bounds.max, world);
    }
}

/// Copies the place of lights that nodes carry.
template <typename Light, typename Copy>
void copy_places(const std::vector<Light>& from, const std::vector<Carried>& carried,
                 std::vector<Light>& to, const Copy& copy) {
    const std::size_t count = std::min({from.size(), carried.size(), to.size()});
    for (std::size_t i = 0; i < count; ++i) {
        if (carried[i].node) copy(from[i], to[i]);
    }
}

std::array<std::size_t, 3> counts_of(const Scene& scene) {
    return {scene.directional_lights.size(), scene.point_lights.size(), scene.spot_lights.size()};
}

}  // namespace

void Playback::take(const SceneGraph& graph, bool is_same) {
    const std::optional<std::size_t> clip = graph_.clip;
    const std::size_t clip_count = clips_.size();
    const std::size_t camera = graph_.chosen_camera;
    graph_ = graph;
    light_counts_ = counts_of(graph_.scene);
    clips_ = clip_names(graph_);
    if (is_same && camera < graph_.cameras.size()) shade::choose_camera(graph_, camera);
    if (is_same && clips_.size() == clip_count) {
        graph_.clip = clip;
    } else if (!is_same) {
        time_ = 0.0;
        speed_ = 1.0F;
        is_playing_ = true;
    }
    measure();
}

void Playback::choose_camera(std::size_t index) {
    shade::choose_camera(graph_, index);
    measure();
}

void Playback::set_clip(std::optional<std::size_t> clip) {
    graph_.clip = clip;
    time_ = 0.0;
    measure();
}

/// Measures the length of the clip, whether it moves the camera, and how far it reaches.
void Playback::measure() {
    duration_ = shade::duration(graph_);
    moves_camera_ = false;
    reach_ = {};
    if (duration_ == 0.0) return;
    std::vector<Bounds> boxes;
    for (const Shared<Mesh>& mesh : graph_.scene.meshes)
        boxes.push_back(bounds_of(*mesh));
    std::optional<Camera> first;
    for (int i = 0; i < reach_samples; ++i) {
        shade::pose(graph_, duration_ * i / reach_samples);
        const Scene& posed = graph_.scene;
        for (std::size_t k = 0; k < posed.instances.size(); ++k) {
            const Instance& instance = posed.instances[k];
            const Bounds box =
                instance.pose ? bounds_of(*deformed_mesh(posed, k)) : boxes[instance.mesh];
            add_corners(reach_, box, instance.world_from_object);
        }
        if (!graph_.scene.camera) continue;
        if (!first) first = graph_.scene.camera;
        moves_camera_ |= graph_.scene.camera->world_from_view != first->world_from_view;
    }
}

double Playback::time_in_clip() const {
    if (duration_ == 0.0) return 0.0;
    const double rest = std::fmod(time_, duration_);
    return rest < 0.0 ? rest + duration_ : rest;
}

bool Playback::advance(double seconds) {
    if (!is_playing() || speed_ == 0.0F) return false;
    time_ += static_cast<double>(speed_) * seconds;
    return true;
}

void Playback::step(double seconds) {
    is_playing_ = false;
    time_ = std::max(time_ + seconds, 0.0);
}

void Playback::pose(Scene& scene, const LightCarriers& lights, double seconds) {
    Scene& moved = graph_.scene;
    const bool has_same_lights = counts_of(scene) == light_counts_;
    moved.materials = scene.materials;
    moved.directional_lights = scene.directional_lights;
    moved.point_lights = scene.point_lights;
    moved.spot_lights = scene.spot_lights;
    graph_.directional_lights = lights.directional;
    graph_.point_lights = lights.point;
    graph_.spot_lights = lights.spot;
    shade::pose(graph_, seconds);
    scene.materials = moved.materials;
    if (has_same_lights) {
        scene.directional_lights = moved.directional_lights;
        scene.point_lights = moved.point_lights;
        scene.spot_lights = moved.spot_lights;
    }
    const std::size_t count = std::min(scene.instances.size(), moved.instances.size());
    for (std::size_t i = 0; i < count; ++i) {
        scene.instances[i].world_from_object = moved.instances[i].world_from_object;
        scene.instances[i].pose = moved.instances[i].pose;
    }
    copy_places(moved.directional_lights, lights.directional, scene.directional_lights,
                [](const DirectionalLight& from, DirectionalLight& to) {
                    to.direction_world = from.direction_world;
                });
    copy_places(
        moved.point_lights, lights.point, scene.point_lights,
        [](const PointLight& from, PointLight& to) { to.position_world = from.position_world; });
    copy_places(moved.spot_lights, lights.spot, scene.spot_lights,
                [](const SpotLight& from, SpotLight& to) {
                    to.point.position_world = from.point.position_world;
                    to.direction_world = from.direction_world;
                });
}

std::optional<Camera> Playback::camera() const {
    return moves_camera_ ? graph_.scene.camera : std::nullopt;
}

const Orbit* Playback::orbit_of(std::size_t node) const {
    for (const Animation& animation : graph_.animations) {
        const auto* orbit = std::get_if<Orbit>(&animation);
        if (orbit != nullptr && orbit->node == node) return orbit;
    }
    return nullptr;
}

std::optional<float> Playback::orbit_speed(std::size_t node) const {
    const Orbit* orbit = orbit_of(node);
    return orbit == nullptr ? std::nullopt : std::optional(orbit->azimuth_speed);
}

void Playback::set_orbit_speed(std::size_t node, float radians_per_second) {
    const Orbit* found = orbit_of(node);
    if (found == nullptr) return;
    for (Animation& animation : graph_.animations) {
        auto* orbit = std::get_if<Orbit>(&animation);
        if (orbit != found) continue;
        const double change =
            static_cast<double>(orbit->azimuth_speed) - static_cast<double>(radians_per_second);
        orbit->azimuth +=
            static_cast<float>(std::remainder(change * time_, 2.0 * std::numbers::pi));
        orbit->azimuth_speed = radians_per_second;
    }
    measure();
}

nlohmann::ordered_json Playback::json() const {
    if (duration_ == 0.0 && clips_.empty()) return nullptr;
    return {{"playing", is_playing()},
            {"time", time_},
            {"duration", duration_},
            {"speed", speed_},
            {"clip", graph_.clip ? nlohmann::ordered_json(*graph_.clip) : nullptr},
            {"clips", clips_}};
}

}  // namespace relief::tools
