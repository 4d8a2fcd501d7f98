// SPDX-License-Identifier: Apache-2.0
/// \file
/// The panels beside the picture, and the small ones among them: scene, environment, debug view and
/// picture. Tests: tests/tools/window/user_interface_test.cpp.
#pragma once

#include <optional>

#include "variant.h"
#include "window/capture.h"
#include "window/draw_thread.h"
#include "window/effects_panel.h"
#include "window/viewer_state.h"
#include "window/window_system.h"

namespace relief::tools {

class Comparison;
class SceneAccuracy;

/// The data that the user interface shows in one frame, and the objects that it edits.
struct PanelInput {
    ViewerState& state;
    WindowLayout& layout;
    const RenderedPicture& drawn;
    const std::string& renderer;
    double loading_seconds = 0.0;  ///< 0 if nothing is being read.
    std::string loading;           ///< The name of the file that is being read.
    Progress::State progress;      ///< Progress of reading, or else of preparing the next picture.
    bool is_drawing = false;       ///< Otherwise the picture is up to date.
    CaptureSettings* capture = nullptr;
    std::string captured;     ///< A message about saved files.
    std::string layout_note;  ///< A message about the saved layout.
    EffectTimes& effect_times;
    ShaderPanel& shaders;
    Comparison* comparison = nullptr;
    SceneAccuracy* accuracy = nullptr;
};

/// The panels' requests to the window.
struct PanelRequests {
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

void draw_scene_panel(const PanelInput& input);
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

/// Draws all panels in one column. \return its width in window units
float draw_panels(const PanelInput& input, PanelRequests& requests);

/// Draws the status line at the bottom: triangles, frame time, current work.
void draw_status(const PanelInput& input, PanelRequests& requests);

/// Draws the list of shortcuts in the center of the window.
void draw_help(bool& is_open);

}  // namespace relief::tools
