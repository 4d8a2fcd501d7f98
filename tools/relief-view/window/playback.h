// SPDX-License-Identifier: Apache-2.0
/// \file
/// Playback of a scene's animation: time, speed and clip. It uses neither a window nor OpenGL.
/// Tests: tests/tools/window/playback_test.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "relief/shade/scene.h"
#include "relief/shade/scene_graph.h"

namespace relief::tools {

/// The nodes that carry the lights of a scene, in the order of its lists.
struct LightCarriers {
    std::vector<shade::Carried> directional;
    std::vector<shade::Carried> point;
    std::vector<shade::Carried> spot;
};

/// Plays the animation of a scene. Time is in seconds and only grows while it plays, because
/// animations of different lengths repeat on their own.
class Playback {
  public:
    /// Takes over the animation of a scene that was read. The same scene, read again, keeps the
    /// time, the speed and whether it plays; another one plays from the start.
    void take(const shade::SceneGraph& graph, bool is_same);

    /// Returns whether the clip moves numbers or colors of materials.
    [[nodiscard]] bool moves_materials() const { return shade::moves_materials(graph_); }

    /// Returns whether the clip moves anything.
    [[nodiscard]] bool has_motion() const { return duration_ > 0.0; }
    [[nodiscard]] bool is_playing() const { return is_playing_ && has_motion(); }
    void set_playing(bool is_playing) { is_playing_ = is_playing; }

    [[nodiscard]] double time() const { return time_; }
    void set_time(double seconds) { time_ = seconds; }
    /// The time within the longest animation, from 0 to duration().
    [[nodiscard]] double time_in_clip() const;
    /// The length of the longest animation; 0 without one.
    [[nodiscard]] double duration() const { return duration_; }

    [[nodiscard]] float speed() const { return speed_; }
    void set_speed(float factor) { speed_ = factor; }

    [[nodiscard]] const std::vector<std::string>& clips() const { return clips_; }
    /// If absent, all clips play.
    [[nodiscard]] std::optional<std::size_t> clip() const { return graph_.clip; }
    /// Plays a clip, or all of them, from the start.
    void set_clip(std::optional<std::size_t> clip);

    /// Adds the elapsed time, times the speed, if the animation plays. \return whether it does
    bool advance(double seconds);

    /// Stops a playing animation, and moves it by some seconds, not before its start.
    void step(double seconds);

    /// Moves instances and lights of the scene to their place at a time, and sets the numbers and
    /// colors that move. Lights without a node stay where they are. If lights were added or removed
    /// since take(), their colors do not move.
    void pose(shade::Scene& scene, const LightCarriers& lights, double seconds);
    void pose(shade::Scene& scene, const LightCarriers& lights) { pose(scene, lights, time_); }

    /// The camera of the last pose, if the animation moves it.
    [[nodiscard]] std::optional<shade::Camera> camera() const;

    /// The names of the cameras of the file, and the one whose motion camera() tells.
    [[nodiscard]] std::vector<std::string> cameras() const { return shade::camera_names(graph_); }
    [[nodiscard]] std::size_t chosen_camera() const { return graph_.chosen_camera; }
    /// The next pose() places the camera.
    void choose_camera(std::size_t index);
    /// The camera of the last pose. Requires cameras().
    [[nodiscard]] const shade::Camera& shown_camera() const { return *graph_.scene.camera; }

    /// The names of the material variants of the file.
    [[nodiscard]] const std::vector<std::string>& material_variants() const {
        return graph_.material_variants;
    }

    /// The box of everything at several times of the animation.
    [[nodiscard]] const Bounds& reach() const { return reach_; }

    /// The radians per second at which a node orbits; none if it does not.
    [[nodiscard]] std::optional<float> orbit_speed(std::size_t node) const;
    /// Changes that speed. The node stays where it is now.
    void set_orbit_speed(std::size_t node, float radians_per_second);

    [[nodiscard]] nlohmann::ordered_json json() const;

  private:
    void measure();
    [[nodiscard]] const shade::Orbit* orbit_of(std::size_t node) const;

    shade::SceneGraph graph_;
    std::vector<std::string> clips_;
    double duration_ = 0.0;
    double time_ = 0.0;
    float speed_ = 1.0F;
    bool is_playing_ = true;
    bool moves_camera_ = false;
    std::array<std::size_t, 3> light_counts_{};  ///< Of the file, by kind.
    Bounds reach_;
};

}  // namespace relief::tools
