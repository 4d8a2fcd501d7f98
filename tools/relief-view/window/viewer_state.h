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
#include "window/lamp_rows.h"
#include "window/loader.h"
#include "window/orbit_camera.h"
#include "window/scene_tree.h"

namespace relief::tools {

struct DrawWish;
struct DrawnPicture;

class ViewerState {
  public:
    explicit ViewerState(ViewOptions options);

    [[nodiscard]] const ViewOptions& options() const { return options_; }
    [[nodiscard]] bool has_scene() const { return scene_ != nullptr; }
    [[nodiscard]] const Scene& scene() const { return *scene_; }
    [[nodiscard]] std::shared_ptr<const Scene> shared_scene() const { return scene_; }
    /// How many were read so far.
    [[nodiscard]] std::uint64_t scenes() const { return scenes_; }
    [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }
    [[nodiscard]] const Report& findings() const { return findings_; }
    [[nodiscard]] const std::string& error() const { return error_.empty() ? edit_error_ : error_; }

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
        replace(std::move(edited));
    }

    /// The same for what may fail: then nothing changes, and error() says why until something
    /// succeeds.
    template <typename Edit>
    void try_edit(const Edit& change) {
        try {
            edit(change);
            edit_error_.clear();
        } catch (const std::exception& error) {
            edit_error_ = error.what();
        }
    }

    /// Lamps beside what the window knows of them.
    [[nodiscard]] std::vector<LampRow> lamps() const;
    void set_lamps(std::vector<LampRow> rows);

    /// Gives the default material a place in the list, so that it can be edited, and in scenes that
    /// are read later.
    void name_default_material();

    /// Surroundings from an image or a folder with six, also for what is read later; an error as
    /// with try_edit. What was chosen of the surroundings before stays; else they shed light where
    /// a material is metallic-roughness, as --environment does.
    void set_environment(const std::filesystem::path& file);

    /// What hangs on what, as the file has it.
    [[nodiscard]] const SceneTree& tree() const { return tree_; }
    /// Instances that are not drawn, though the scene has them.
    [[nodiscard]] bool is_shown(std::size_t instance) const { return !hidden_[instance]; }
    void show(const std::vector<std::size_t>& instances, bool are_shown);

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

    /// Whether the camera or a lamp moves by itself.
    [[nodiscard]] bool is_turning() const { return is_turning_ || lamps_.is_moving(); }
    /// Lets time pass for the turntable and for lamps. \return whether anything moved
    bool pass(double seconds);

    /// What is to be drawn now; none without a scene or a view.
    [[nodiscard]] std::optional<DrawWish> wish() const;

    /// The options that show the same picture without a window: "relief-view MODEL --camera ...".
    [[nodiscard]] std::string command_line() const;

    [[nodiscard]] nlohmann::ordered_json json(const DrawnPicture& drawn) const;

  private:
    void replace(std::shared_ptr<const Scene> scene);
    void mark_health();
    void act_on_debug(Action action);
    void look_from(float azimuth, float elevation);

    ViewOptions options_;
    std::shared_ptr<const Scene> scene_;
    std::shared_ptr<const Scene> read_;   ///< The same without any edit.
    KeptEdits kept_;                      ///< Of the last scene that was read.
    std::uint64_t scenes_ = 0;            ///< Read so far.
    std::shared_ptr<const Scene> shown_;  ///< The same without what is hidden.
    std::vector<bool> hidden_;            ///< By instance.
    bool has_named_default_ = false;
    SceneTree tree_;
    LampRows lamps_;
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
    std::string edit_error_;
};

}  // namespace relief::tools
