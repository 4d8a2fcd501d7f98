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
#include "window/file_browser.h"
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
    ImagePreviews* previews = nullptr;  ///< Of the file dialog.
    shade::PictureExchange::Shown preview_texture{};
};

/// The panels' requests to the window.
struct PanelRequests {
    std::vector<Action> actions;                  ///< Of buttons and menus.
    std::optional<std::filesystem::path> open;    ///< A file that was selected.
    std::optional<BrowseRequest> browse;          ///< Select a file in the dialog.
    std::optional<std::string> material_variant;  ///< Empty: the materials without a variant.
    std::optional<float> ambient_occlusion;       ///< Its distance; 0 is none.
    std::optional<MapKind> assume;                ///< Read the model again as with --assume.
    bool cancel_loading = false;                  ///< Of reading, or else of preparing the picture.
    bool redraw = false;                          ///< Prepare the picture that was cancelled.
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
void draw_material_panel(const PanelInput& input, PanelRequests& requests);
void draw_environment_panel(const PanelInput& input, PanelRequests& requests);
void draw_picture_panel(const PanelInput& input);
void draw_compare_panel(const PanelInput& input);
void draw_capture_panel(const PanelInput& input, PanelRequests& requests);
void draw_effects_panel(const PanelInput& input, PanelRequests& requests);
void draw_accuracy_panel(const PanelInput& input, PanelRequests& requests);
void draw_view_panel(const PanelInput& input);

/// The panel headers from top to bottom.
std::vector<std::string> panel_names();

/// The places of the panels of a window.
struct PanelArrangement {
    /// The window is too small for panels beside most of a picture: they are folded until they are
    /// asked for, and the toolbar is above the picture.
    bool is_folded = false;
    bool is_below = false;  ///< Folded panels open below the picture, not beside it.
    float width = 0.0F;     ///< Of the open panels, in window units.
    float height = 0.0F;    ///< Of panels that open below the picture; else 0.
};

/// \param window  the size in window units
/// \param letter  the line height
PanelArrangement arrange_panels(const glm::vec2& window, float letter);

/// The parts of the window that the panels take from the picture, in window units.
struct PanelSpace {
    float left = 0.0F;
    float bottom = 0.0F;      ///< Without the status line.
    glm::vec2 toolbar{0.0F};  ///< The size of a toolbar above the picture, at the upper left.
};

/// Draws the toolbar and the open panels.
/// \param are_open  whether folded panels are open
PanelSpace draw_panels(const PanelInput& input, bool are_open, PanelRequests& requests);

/// Draws the controls of the animation below the picture, if there is one: play, time, speed, clip.
/// \param left, bottom  the width and height that other parts of the window occupy
/// \return its height in window units
float draw_playback(ViewerState& state, float left, float bottom);

/// Draws the status line at the bottom: current work, errors, size of model and picture.
void draw_status(const PanelInput& input, PanelRequests& requests);

/// The list of shortcuts and gestures by group, in the center of the window, with a search.
class HelpWindow {
  public:
    void toggle() { is_open_ = !is_open_; }
    void close() { is_open_ = false; }
    [[nodiscard]] bool is_open() const { return is_open_; }
    /// The next frame gives the keyboard to the search.
    void focus_search() { wants_focus_ = true; }
    void draw();

  private:
    bool is_open_ = false;
    bool wants_focus_ = false;
    std::string search_;
};

/// Draws the progress of reading or drawing in the middle of a view that has no picture yet, with a
/// button that cancels it. \param min, max  the view in window units
void draw_waiting(const PanelInput& input, const glm::vec2& min, const glm::vec2& max,
                  PanelRequests& requests);

}  // namespace relief::tools
