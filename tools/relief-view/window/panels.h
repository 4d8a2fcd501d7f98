// SPDX-License-Identifier: Apache-2.0
/// \file
/// What stands beside the picture: the scene, its lights and materials, the effects with their
/// reasons. Each panel reads the state and edits it. Tests: tests/tools/window/window_test.cpp.
#pragma once

#include <optional>

#include "variant.h"
#include "window/capture.h"
#include "window/draw_thread.h"
#include "window/effect_prices.h"
#include "window/shader_panel.h"
#include "window/viewer_state.h"
#include "window/window_layout.h"

namespace relief::tools {

class Comparison;
class SceneAccuracy;

/// Everything drawn with Dear ImGui for one frame of the window.
struct PanelInput {
    ViewerState& state;
    WindowLayout& layout;
    const DrawnPicture& drawn;
    const std::string& renderer;
    double loading_seconds = 0.0;  ///< 0: nothing is being read.
    std::string loading;           ///< The file's name.
    Progress::State progress;      ///< Of reading, else of preparing what is drawn next.
    bool is_drawing = false;       ///< Else the picture is the newest, and nothing goes on.
    CaptureSettings* capture = nullptr;
    std::string captured;     ///< What was saved, in words.
    std::string layout_note;  ///< What became of the layout that was remembered.
    EffectPrices& prices;
    ShaderPanel& shaders;
    Comparison* comparison = nullptr;
    SceneAccuracy* accuracy = nullptr;
};

/// What a panel asks the window to do.
struct PanelWishes {
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
void draw_capture_panel(const PanelInput& input, PanelWishes& wishes);
void draw_effects_panel(const PanelInput& input, PanelWishes& wishes);
void draw_accuracy_panel(const PanelInput& input, PanelWishes& wishes);
void draw_view_panel(const PanelInput& input);

/// The headers of all panels, from the top.
std::vector<std::string> panel_names();

/// All of them in one column. \return its width in the window's units
float draw_panels(const PanelInput& input, PanelWishes& wishes);

/// The line at the bottom: triangles, the frame's time, what is going on.
void draw_status(const PanelInput& input, PanelWishes& wishes);

/// The list of bindings, in the middle of the window.
void draw_help(bool& is_open);

}  // namespace relief::tools
