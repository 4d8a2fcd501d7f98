// SPDX-License-Identifier: Apache-2.0
/// \file
/// The state of the window as plain data, and the actions that change it. It uses neither a window
/// nor OpenGL. Tests: tests/tools/window/viewer_state_test.cpp, edit_rebase_test.cpp,
/// user_interface_test.cpp.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "relief/shade/effects.h"
#include "relief/shade/frame_settings.h"
#include "relief/shade/picture_steps.h"
#include "relief/shade/scene.h"
#include "relief/shade/scene_graph.h"
#include "scene_options.h"
#include "window/background_jobs.h"
#include "window/edit_panels.h"
#include "window/edit_rebase.h"
#include "window/orbit_camera.h"
#include "window/playback.h"
#include "window/shortcuts.h"

namespace relief::tools {

/// The limits of the exposure that keys and the slider set: 8 stops.
inline constexpr float min_exposure = 1.0F / 256.0F;
inline constexpr float max_exposure = 256.0F;

/// A node of the scene, or the world.
struct TreeNode {
    std::string name;  ///< "node 3" if the node has no name.
    std::vector<std::size_t> instances;
    /// Names of cameras and lights, for example "point light 2".
    std::vector<std::string> carried;
    std::vector<std::size_t> children;  ///< Indices into SceneTree::nodes.
};

/// The nodes of a graph in their order.
struct SceneTree {
    std::vector<TreeNode> nodes;
    TreeNode world;  ///< Objects without a node.
};
SceneTree tree_of(const shade::SceneGraph& graph);

/// All instances of a node and the nodes below it.
std::vector<std::size_t> instances_below(const SceneTree& tree, const TreeNode& node);

struct DrawRequest;
struct RenderedPicture;

/// The scene, the camera and the options that the window shows.
class ViewerState {
  public:
    explicit ViewerState(ViewOptions options);

    [[nodiscard]] const ViewOptions& options() const { return options_; }
    [[nodiscard]] bool has_scene() const { return scene_ != nullptr; }
    [[nodiscard]] const shade::Scene& scene() const { return *scene_; }
    [[nodiscard]] std::shared_ptr<const shade::Scene> shared_scene() const { return scene_; }
    /// The number of scenes that were read.
    [[nodiscard]] std::uint64_t scenes() const { return scenes_; }
    [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }
    [[nodiscard]] const Report& findings() const { return findings_; }
    [[nodiscard]] const std::string& error() const { return error_.empty() ? edit_error_ : error_; }

    /// Takes over a scene that was read, and rebases the edits of the previous scene
    /// (edit_rebase.h). The camera is reset if the model is another one. After an error, the scene
    /// stays.
    void take(Loaded loaded);

    /// Draws the scene again, because its images have changed.
    void refresh() { ++revision_; }

    /// Changes the scene. Copies of a scene share its meshes. All changes up to the next
    /// end_edit_step() are undone together.
    template <typename Edit>
    void edit(const Edit& change) {
        if (!scene_) return;
        auto edited = std::make_shared<shade::Scene>(*scene_);
        change(*edited);
        begin_edit_step();
        replace(std::move(edited));
    }

    /// Ends a group of edits, for example those of one drag of a slider.
    void end_edit_step() { is_step_open_ = false; }

    /// Changes the scene, unless an exception is thrown. Then error() returns its message until an
    /// edit succeeds.
    template <typename Edit>
    void try_edit(const Edit& change) {
        refused_edit_.reset();
        try {
            edit(change);
            edit_error_.clear();
        } catch (const std::exception& error) {
            edit_error_ = error.what();
        }
    }

    /// Sets a map of a material to a file, as try_edit().
    void set_map(std::size_t material, TextureSlot slot, const std::filesystem::path& file);

    /// Returns true if error() is about a map of the wrong kind.
    [[nodiscard]] bool has_refused_map() const;
    /// Sets the map of the material that was refused anyway.
    /// \return if the map was refused when the scene was read, the kind to assume when it is read
    ///         again
    std::optional<MapKind> use_refused_map();

    /// The lights with the data that only the window stores.
    [[nodiscard]] std::vector<LightRow> light_rows() const;
    void set_light_rows(std::vector<LightRow> rows);

    /// Adds the default material to the list of materials, so that it can be edited. This also
    /// applies to scenes that are read later.
    void name_default_material();

    /// Sets the environment to an image or a folder with six images, also for scenes that are read
    /// later. Errors are reported as by try_edit(). Intensity, skybox and lighting of a previous
    /// environment stay; otherwise the environment lights the scene if a material is
    /// metallic-roughness.
    void set_environment(const std::filesystem::path& file);

    /// The node hierarchy of the file.
    [[nodiscard]] const SceneTree& tree() const { return tree_; }
    /// Hidden instances are not drawn, but stay in the scene.
    [[nodiscard]] bool is_shown(std::size_t instance) const { return !hidden_[instance]; }
    void show(const std::vector<std::size_t>& instances, bool are_shown);

    /// Rotates the lights about the world's y axis and the camera's right axis.
    void orbit_lights(const glm::vec2& pixels);

    /// Rotates the environment about the world's y axis.
    void turn_environment(float pixels);

    /// Makes the surface under the pointer the target of the camera, if there is one.
    /// \param pointer  relative to the center of the view, in halves of its height, y up
    void aim(const glm::vec2& pointer);

    /// Applies the camera of a command line. If the text contains none, error() reports it.
    void apply_view_text(const std::string& text);

    /// Sets the texts that replace parts of the shaders, and the step that the picture shows.
    /// \param step  null: the whole picture
    void set_shaders(const std::shared_ptr<const shade::ShaderTexts>& texts,
                     const shade::PictureStep* step);

    void set_effects(shade::EffectRequest effects);
    [[nodiscard]] const shade::EffectRequest& effects() const { return effects_; }

    /// Shows the picture of a camera of the file, and follows it if the animation moves it.
    /// Requires a scene. \param index  into playback().cameras()
    void choose_camera(std::size_t index);

    /// Sets the debug view and the overlays.
    void set_debug(const DebugChoices& choices);
    /// A new request for the search for mesh problems. Each request is returned once.
    std::optional<HealthRequest> take_health_request();
    void take(HealthResult found);
    [[nodiscard]] const DebugChoices& debug() const { return options_.debug; }
    [[nodiscard]] const shade::HealthMarkers& markers() const { return markers_; }
    /// Returns whether point lights and spotlights are shown as spheres.
    [[nodiscard]] bool has_light_markers() const { return has_light_markers_; }

    /// Handles the actions that affect the scene or the camera.
    void act(Action action);

    void set_view(const glm::ivec2& pixels);
    [[nodiscard]] const glm::ivec2& view() const { return view_; }
    OrbitCamera& camera() { return camera_; }
    [[nodiscard]] const OrbitCamera& camera() const { return camera_; }
    [[nodiscard]] const BoundingSphere& sphere() const { return sphere_; }
    /// The grid below the scene as it was read.
    [[nodiscard]] const shade::Grid& grid() const { return grid_; }

    /// Returns whether the turntable or a light rotates, or the animation plays.
    [[nodiscard]] bool is_turning() const {
        return is_turning_ || light_rows_.is_moving() || playback_.is_playing();
    }
    /// Advances the turntable, the rotation of lights and the animation. \return whether anything
    /// moved
    bool advance(double seconds);

    [[nodiscard]] const Playback& playback() const { return playback_; }
    /// Changes the playback, and shows the scene at its time. If another clip was chosen, a camera
    /// that fits the model fits what this clip reaches; a camera that the user has moved stays.
    template <typename Change>
    void change_playback(const Change& change) {
        const std::optional<std::size_t> clip = playback_.clip();
        change(playback_);
        if (!scene_) return;
        if (playback_.clip() != clip) show_clip();
        move_to(playback_.time());
    }

    /// The scene with its edits, in the pose in which it was read.
    [[nodiscard]] std::shared_ptr<const shade::Scene> scene_at_rest();

    /// The request for the current picture. Empty without a scene or a view.
    [[nodiscard]] std::optional<DrawRequest> request() const;

    /// Options that draw the same picture without a window: "--camera ... --fov ... --size ...".
    [[nodiscard]] std::string command_line() const;

    [[nodiscard]] nlohmann::ordered_json json(const RenderedPicture& drawn) const;

  private:
    /// The values that an edit can change.
    struct EditState {
        std::shared_ptr<const shade::Scene> scene;
        LightRows light_rows;
        std::vector<std::pair<std::size_t, float>> orbit_speeds;  ///< Of nodes of the animation.
        std::vector<std::filesystem::path> environment;
        std::optional<EnvironmentLayout> environment_layout;
        bool left_handed_environment;
    };

    /// A map that set_map() refused because of its kind.
    struct RefusedEdit {
        std::size_t material;
        TextureSlot slot;
        std::filesystem::path file;
        MapKind wanted;
    };

    void set_map(std::size_t material, TextureSlot slot, const std::filesystem::path& file,
                 const AssumedKinds& assumed);
    void set_error(std::string error, std::optional<MapKind> refused = std::nullopt);
    void begin_edit_step();
    [[nodiscard]] EditState edit_state() const;
    void restore(EditState state);
    void exchange_edits(std::vector<EditState>& from, std::vector<EditState>& to);
    void replace(std::shared_ptr<const shade::Scene> scene);
    void show_all_but_hidden();
    /// Measures how far the clip moves the scene.
    void measure_reach();
    /// After a change of clip: the camera fits what this clip reaches if it fitted the model
    /// before.
    void show_clip();
    template <typename Change>
    void move(const Change& change);
    void move_to(double seconds);
    void follow_camera();
    void mark_health();
    void act_on_debug(Action action);
    void look_from(float azimuth, float elevation);

    ViewOptions options_;
    std::shared_ptr<const shade::Scene> scene_;
    std::shared_ptr<const shade::Scene> read_;  ///< The scene without edits.
    RebasedEdits rebased_;                      ///< Edits of the last scene that was read.
    std::vector<EditState> undo_;               ///< The states before each step, the oldest first.
    std::vector<EditState> redo_;               ///< The states after the steps that were undone.
    bool is_step_open_ = false;
    std::uint64_t scenes_ = 0;  ///< The number of scenes that were read.
    /// The scene without hidden instances, with light markers.
    std::shared_ptr<const shade::Scene> shown_;
    bool has_light_markers_ = false;
    std::vector<bool> hidden_;  ///< Indexed by instance.
    bool has_named_default_ = false;
    SceneTree tree_;
    LightRows light_rows_;
    Playback playback_;
    BoundingSphere reach_;   ///< Contains everything, wherever the animation moves it.
    BoundingSphere fitted_;  ///< The part of it that the camera shows when it fits the model.
    /// The camera when it last fitted the model. Absent if an option or the animation chose it, or
    /// if a reload changed the extent of the model.
    std::optional<OrbitCamera> fitting_;
    /// The camera of the animation as it was shown last, until the user moves it.
    std::optional<OrbitCamera> followed_;
    std::filesystem::path shown_model_;
    std::uint64_t revision_ = 0;
    std::uint64_t pose_ = 0;        ///< Changes when only instances and lights move.
    shade::HealthMarkers markers_;  ///< The result of the search for mesh problems.
    bool has_health_request_ = false;
    shade::EffectRequest effects_;
    std::shared_ptr<const shade::ShaderTexts> shaders_;
    std::optional<shade::PictureStep> step_;  ///< None: the whole picture.
    OrbitCamera camera_;
    Bounds bounds_;  ///< Of the scene as it was read.
    BoundingSphere sphere_;
    shade::Grid grid_;
    glm::ivec2 view_{0};
    bool is_turning_ = false;
    std::vector<std::string> notes_;
    Report findings_;
    std::string error_;
    std::optional<MapKind> refused_;  ///< The kind that the read of error_ may assume.
    std::string edit_error_;
    std::optional<RefusedEdit> refused_edit_;  ///< That of edit_error_.
};

}  // namespace relief::tools
