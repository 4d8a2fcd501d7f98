// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the window shows, as plain data, and what actions do to it. Neither a window nor OpenGL.
/// Tests: tests/tools/window/viewer_state_test.cpp.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "relief/shade/effect_forcing.h"
#include "relief/shade/health_markers.h"
#include "scene_options.h"
#include "window/bindings.h"
#include "window/health_search.h"
#include "window/kept_edits.h"
#include "window/loader.h"
#include "window/orbit_camera.h"

namespace relief::tools {

struct DrawWish;
struct DrawnPicture;

class ViewerState {
  public:
    explicit ViewerState(ViewOptions options);

    [[nodiscard]] const ViewOptions& options() const { return options_; }
    [[nodiscard]] bool has_scene() const { return scene_ != nullptr; }
    [[nodiscard]] const Scene& scene() const { return *scene_; }
    [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }
    [[nodiscard]] const Report& findings() const { return findings_; }
    [[nodiscard]] const std::string& error() const { return error_; }

    /// Takes over what was read, and puts the edits of the scene before it on that (kept_edits.h).
    /// The first scene, and one of another model, is shown whole; the same model read again keeps
    /// the view. An error leaves the scene as it was.
    void take(Loaded loaded);

    /// Images that the scene names have changed: it is to be drawn anew.
    void refresh() { ++revision_; }

    /// Changes lights, materials and whatever else a scene has; copies share its meshes.
    template <typename Edit>
    void edit(const Edit& change) {
        if (!scene_) return;
        auto edited = std::make_shared<Scene>(*scene_);
        change(*edited);
        scene_ = std::move(edited);
        ++revision_;
    }

    /// Turns the lights about the world's y and the view's right-hand side.
    void orbit_lights(const glm::vec2& pixels);

    /// The surface there becomes what the camera goes round; where there is none, nothing happens.
    /// \param pointer  from the centre of the view, in halves of its height, y up
    void aim(const glm::vec2& pointer);

    /// Takes over a view that was copied as text; what is no such text is an error.
    void look_as(const std::string& text);

    void set_effects(EffectWishes effects);
    [[nodiscard]] const EffectWishes& effects() const { return effects_; }

    /// Debug view and overlays.
    void set_debug(const DebugChoices& choices);
    /// Where markers are to be looked for, or not any more: what for. Only once.
    std::optional<HealthWish> take_health_wish();
    void take(FoundHealth found);
    [[nodiscard]] const DebugChoices& debug() const { return options_.debug; }
    [[nodiscard]] const HealthMarkers& markers() const { return markers_; }

    /// What keys do; help, panels, screenshot and quit are the window's.
    void act(Action action);

    void set_view(const glm::ivec2& pixels);
    [[nodiscard]] const glm::ivec2& view() const { return view_; }
    OrbitCamera& camera() { return camera_; }
    [[nodiscard]] const OrbitCamera& camera() const { return camera_; }
    [[nodiscard]] const Ball& ball() const { return ball_; }

    [[nodiscard]] bool is_turning() const { return is_turning_; }
    /// Lets time pass for the turntable. \return whether anything moved
    bool pass(double seconds);

    /// What is to be drawn now; none without a scene or a view.
    [[nodiscard]] std::optional<DrawWish> wish() const;

    /// The options that show the same picture without a window: "relief-view MODEL --camera ...".
    [[nodiscard]] std::string command_line() const;

    [[nodiscard]] nlohmann::ordered_json json(const DrawnPicture& drawn) const;

  private:
    void mark_health();
    void act_on_debug(Action action);
    void look_from(float azimuth, float elevation);

    ViewOptions options_;
    std::shared_ptr<const Scene> scene_;
    std::shared_ptr<const Scene> read_;  ///< The same without any edit.
    KeptEdits kept_;                     ///< Of the last scene that was read.
    std::uint64_t scenes_ = 0;           ///< Read so far.
    std::filesystem::path shown_model_;
    std::uint64_t revision_ = 0;
    HealthMarkers markers_;  ///< Of the scene, where they are asked for and found.
    bool wishes_health_ = false;
    EffectWishes effects_;
    OrbitCamera camera_;
    Ball ball_;
    glm::ivec2 view_{0};
    bool is_turning_ = false;
    std::vector<std::string> notes_;
    Report findings_;
    std::string error_;
};

}  // namespace relief::tools
