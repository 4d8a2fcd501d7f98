// SPDX-License-Identifier: Apache-2.0
/// \file
/// The panels beside the picture, the toolbar, the status line and the file dialog.
/// Tests: tests/tools/window/user_interface_test.cpp.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "relief/mesh/execution.h"
#include "relief/shade/effects.h"
#include "view_options.h"
#include "window/background_jobs.h"
#include "window/capture.h"
#include "window/input_files.h"
#include "window/viewer_state.h"
#include "window/window_system.h"

namespace relief::tools {

class Comparison;
class ProbePanel;
class SceneAccuracy;
class ShaderPanel;

/// The data that the user interface shows in one frame, and the objects that it edits.
struct PanelInput {
    ViewerState& state;
    WindowLayout& layout;
    const RenderedPicture& drawn;
    const std::string& renderer;
    double loading_seconds = 0.0;  ///< 0 if nothing is being read.
    const ViewOptions* loading =
        nullptr;               ///< The options of a read under way; null: there is none.
    Progress::State progress;  ///< Progress of reading, or else of preparing the next picture.
    bool is_drawing = false;   ///< Otherwise the picture is up to date.
    CaptureSettings* capture = nullptr;
    std::string captured;     ///< A message about saved files.
    std::string layout_note;  ///< A message about the saved layout.
    EffectTimes& effect_times;
    ShaderPanel& shaders;
    Comparison* comparison = nullptr;
    SceneAccuracy* accuracy = nullptr;
    Thumbnails* thumbnails = nullptr;
    shade::PictureExchange::Shown thumbnail_texture{};
    ProbePanel* probe = nullptr;
};

/// The panels' requests to the window.
struct PanelRequests {
    std::vector<Action> actions;                  ///< Of buttons and menus.
    std::optional<std::filesystem::path> open;    ///< A file that was selected.
    std::optional<std::string> material_variant;  ///< Empty: the materials without a variant.
    std::optional<float> ambient_occlusion;       ///< Its distance; 0 is none.
    std::optional<MapKind> assume;                ///< Read the model again as with --assume.
    bool cancel_loading = false;
    bool save_picture = false;
    bool save_turn = false;
    bool measure_effects = false;
    bool stop_measuring = false;
    bool save_scene = false;
    bool save_model = false;
    bool measure_accuracy = false;
    bool stop_accuracy = false;
    std::optional<Variant> use_method;
};

void draw_scene_panel(const PanelInput& input, PanelRequests& requests);
void draw_light_panel(const PanelInput& input);
void draw_material_panel(const PanelInput& input);
void draw_environment_panel(const PanelInput& input);
void draw_picture_panel(const PanelInput& input);
void draw_compare_panel(const PanelInput& input);
void draw_capture_panel(const PanelInput& input, PanelRequests& requests);
void draw_effects_panel(const PanelInput& input, PanelRequests& requests);
void draw_accuracy_panel(const PanelInput& input, PanelRequests& requests);
void draw_view_panel(const PanelInput& input);

/// The panel headers from top to bottom.
std::vector<std::string> panel_names();

/// Draws the toolbar and all panels in one column. \return its width in window units
float draw_panels(const PanelInput& input, PanelRequests& requests);

/// Draws the controls of the animation below the picture, if there is one: play, time, speed, clip.
/// \param left, bottom  the width and height that other parts of the window occupy
/// \return its height in window units
float draw_playback(ViewerState& state, float left, float bottom);

/// Draws the status line at the bottom: triangles, frame time, current work.
void draw_status(const PanelInput& input, PanelRequests& requests);

/// Draws the list of shortcuts in the center of the window.
void draw_help(bool& is_open);

/// A dialog that selects a file of a folder, or a recent one.
class FileDialog {
  public:
    /// \param folder  the folder that is listed first
    void open(const std::filesystem::path& folder);
    [[nodiscard]] bool is_open() const { return is_open_; }

    /// \return the selected file; then the dialog is closed
    std::optional<std::filesystem::path> draw(const std::vector<std::string>& recent_files);

  private:
    bool is_open_ = false;
    FolderListing listing_;
};

}  // namespace relief::tools
