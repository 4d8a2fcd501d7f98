// SPDX-License-Identifier: Apache-2.0
/// \file
/// The panels beside the picture, and the controls that they consist of.
/// Tests: tests/tools/window/user_interface_test.cpp, effects_panel_test.cpp.
#pragma once

#include <filesystem>
#include <functional>
#include <glm/vec2.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "relief/mesh/execution.h"
#include "relief/shade/effects.h"
#include "relief/shade/scene_fields.h"
#include "view_options.h"
#include "window/background_jobs.h"
#include "window/capture.h"
#include "window/input_files.h"
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

/// Starts a row of two columns: draws the label, and makes the next item as wide as the second
/// column.
/// \return the ImGui identifier of the item
std::string begin_row(const char* label);

/// A checkbox. \return whether the value changed
bool check(const char* label, bool& value);

/// A color field. \return whether the value changed
/// \param has_limit  whether 1 is the largest component
bool pick_color(const char* label, glm::vec3& color, bool has_limit = true);

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
    /// A click with the right button sets this value; a tooltip says so while the value differs.
    std::optional<float> default_value = std::nullopt;
};

/// \return whether the value changed
bool slide(const char* label, float& value, const Slider& slider = {});

/// A slider in degrees for a value in radians.
bool slide_angle(const char* label, float& radians, const Slider& degrees);

/// A slider with the title and the range of a scene field.
template <typename Owner>
bool slide(Owner& owner, float Owner::*member) {
    const SceneField field = field_of(member);
    return slide(
        field.title().c_str(), owner.*member,
        {.min = field.range.min, .max = field.range.max, .default_value = field.default_value()});
}

/// A drag field for values from 0 without an upper limit; `step` is the change per pixel.
bool drag_up(const char* label, float& value, float step = 0.01F);

/// The user's input in a file field.
struct FileChoice {
    std::optional<std::filesystem::path> file;  ///< A path that was typed or pasted.
    bool is_cleared = false;                    ///< The user pressed the clear button.
};

/// A small picture of an image, as a part of a texture.
struct Thumbnail {
    unsigned texture = 0;
    glm::vec2 min{0.0F};       ///< Of the upper left corner, in texture coordinates of OpenGL.
    glm::vec2 max{1.0F};       ///< Of the lower right corner.
    glm::ivec2 size{0};        ///< Pixels.
    glm::ivec2 image_size{0};  ///< Of the image itself.
};

/// A text field for the path of a file.
/// \param shown  the current value, if there is one
/// \param thumbnail  shown before the text, if there is one
FileChoice file_field(const char* label, const std::optional<std::string>& shown,
                      const std::optional<Thumbnail>& thumbnail = std::nullopt);

/// Shows a label such as "Reading big.obj: parsing", and a progress bar if the share is known.
void draw_progress(const std::string& what, const Progress::State& progress);

/// Joins the parts that fit into a line, from the first one on. A first part that is too long loses
/// its middle.
/// \param width_of  the width of a text
std::string fitting_line(const std::vector<std::string>& parts, float width,
                         const std::function<float(const std::string&)>& width_of);

/// Returns a text, or if it is too long "..." and the longest end that fits.
std::string fitting_end(const std::string& text, float width,
                        const std::function<float(const std::string&)>& width_of);

// The effects panel: the reasons for each effect, measured times, and the shader source.

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
    PictureExchange::Shown thumbnail_texture{};
};

/// The panels' requests to the window.
struct PanelRequests {
    std::vector<Action> actions;                  ///< Of buttons and menus.
    std::optional<std::filesystem::path> open;    ///< A file that was selected.
    std::optional<std::string> material_variant;  ///< Empty: the materials without a variant.
    std::optional<float> ambient_occlusion;       ///< Its distance; 0 is none.
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
