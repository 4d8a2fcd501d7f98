// SPDX-License-Identifier: Apache-2.0
/// \file
/// The panels beside the picture, and the controls that they consist of.
/// Tests: tests/tools/window/user_interface_test.cpp, effects_panel_test.cpp.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "relief/mesh/execution.h"
#include "relief/shade/effect_costs.h"
#include "relief/shade/effects.h"
#include "relief/shade/scene_fields.h"
#include "view_options.h"
#include "window/background_jobs.h"
#include "window/capture.h"
#include "window/viewer_state.h"
#include "window/window_system.h"

namespace relief::tools {

// Controls: combo boxes, sliders, file fields and progress bars. Each control reports its position
// to the UI test probe, which is part of --dump-state.

/// Enables the UI test probe. Without this call, positions are not stored.
void enable_ui_probe();

/// Starts a frame: removes the positions of the last frame.
void clear_ui_probe();

/// Stores the center of the last ImGui item under this name, in window units, if the item is
/// visible.
void probe_item(const std::string& name);

/// For example {"Lights": [120, 240]}.
nlohmann::ordered_json ui_probe_json();

/// A combo box. While it is open, the probe reports its entries as "Kind: Spot".
/// \return whether the selection changed
bool choose_index(const char* label, std::size_t& index, std::span<const std::string> names);

/// The same for an enumeration, with the labels of its table of names.
template <typename Enum>
bool choose(const char* label, Enum& value) {
    static const std::vector<std::string> labels = enum_labels<Enum>();
    const auto& names = enum_names<Enum>;
    std::size_t index = 0;
    while (index + 1 < names.size() && names[index].value != value)
        ++index;
    const bool changed = choose_index(label, index, labels);
    value = names[index].value;
    return changed;
}

/// The range of a slider, which also limits typed numbers.
struct Slider {
    float min = 0.0F;
    float max = 1.0F;
    const char* format = "%.3f";  ///< As printf's, with the unit.
    bool is_logarithmic = false;
};

/// \return whether the value changed
bool slide(const char* label, float& value, const Slider& slider = {});

/// A slider with the title and the range of a scene field.
template <typename Owner>
bool slide(Owner& owner, float Owner::*member) {
    const SceneField field = field_of(member);
    return slide(field.title().c_str(), owner.*member, {field.range.min, field.range.max});
}

/// A drag field for values from 0 without an upper limit; `step` is the change per pixel.
bool drag_up(const char* label, float& value, float step = 0.01F);

/// The user's input in a file field.
struct FileChoice {
    std::optional<std::filesystem::path> file;  ///< A path that was typed or pasted.
    bool is_cleared = false;                    ///< The user pressed the clear button.
};

/// A text field for the path of a file.
/// \param shown  the current value, if there is one
FileChoice file_field(const char* label, const std::optional<std::string>& shown);

/// Shows a label such as "Reading big.obj: parsing", and a progress bar if the share is known.
void draw_progress(const std::string& what, const Progress::State& progress);

/// Joins the parts that fit into a line, from the first one on. A first part that is too long loses
/// its middle.
/// \param width_of  the width of a text
std::string fitting_line(const std::vector<std::string>& parts, float width,
                         const std::function<float(const std::string&)>& width_of);

// The effects panel: the reasons for each effect, measured times, and the shader source.

/// Measures the time of each effect on the drawing thread. Results are valid for one plan and size.
class EffectTimes {
  public:
    struct State {
        bool is_running = false;
        std::size_t count = 0;  ///< Number of effects; 0 if it is not yet known.
        EffectCosts costs;      ///< Costs of the effects that have been measured.
        std::string error;
        int width = 0;  ///< Width of the measured frames in pixels; 0 without a measurement.
        int height = 0;
        int samples = 0;
    };
    [[nodiscard]] State state() const;

    /// Starts a measurement. \return the work for the drawing thread
    DrawTask start(const DrawRequest& request);

    /// Cancels and discards the measurement.
    void cancel();

    /// Discards the measurement if it does not match the picture.
    ///
    /// \param plan  the plan of the current picture
    /// \param request  the request at full resolution
    void discard_unless_valid_for(const FramePlan& plan, const DrawRequest& request);

    /// "1.25 ms"; "noise" for a time below the noise, and empty if the effect was not measured.
    [[nodiscard]] std::string text(const std::string& effect) const;

  private:
    /// A measurement, shared by both threads.
    struct Measurement {
        std::atomic<bool> is_wanted = true;
        std::mutex mutex;
        State state;
        FramePlan plan;  ///< Empty until the measurement has started.
    };
    class MeasurementTask;

    std::shared_ptr<Measurement> current_;
};

/// {"going_on", "done", "count", "frame": milliseconds, "size", "samples", "effects": {name:
/// milliseconds}, "error"}, or null without a measurement.
nlohmann::ordered_json json_of(const EffectTimes::State& state);

/// Adds line numbers: " 1  #version 330 core".
std::string numbered_lines(const std::string& source);

/// The shader source of each program, assembled once per plan.
class ShaderPanel {
  public:
    void draw(const std::shared_ptr<const FramePlan>& plan);

  private:
    struct Program {
        std::string name;
        ShaderListing listing;
        std::string vertex;  ///< With line numbers.
        std::string fragment;
    };
    void assemble(const FramePlan& plan);
    static void draw_stage(const char* name, const std::string& source, std::string& numbered);

    std::shared_ptr<const FramePlan> plan_;
    std::vector<Program> programs_;
    std::string error_;
};

// The panels.

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

/// Draws the controls of the animation below the picture, if there is one: play, time, speed, clip.
/// \param left, bottom  the width and height that other parts of the window occupy
/// \return its height in window units
float draw_playback(ViewerState& state, float left, float bottom);

/// Draws the status line at the bottom: triangles, frame time, current work.
void draw_status(const PanelInput& input, PanelRequests& requests);

/// Draws the list of shortcuts in the center of the window.
void draw_help(bool& is_open);

}  // namespace relief::tools
