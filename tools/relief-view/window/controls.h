// SPDX-License-Identifier: Apache-2.0
/// \file
/// The controls that panels consist of: combo boxes, sliders, file fields and progress bars. Each
/// reports its position to the UI test probe, which is part of --dump-state.
/// Tests: tests/tools/window/user_interface_test.cpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "relief/mesh/execution.h"
#include "relief/mesh/fields.h"

namespace relief::tools {

/// Enables the UI test probe. Without this call, positions are not stored.
void enable_ui_probe();

/// Starts a frame: removes the positions of the last frame.
void clear_ui_probe();

/// Stores the center of the last ImGui item under this name, in window units, if the item is
/// visible.
void probe_item(const std::string& name);

/// Stores a place of the picture under this name, in window units.
void probe_place(const std::string& name, const glm::vec2& place);

/// For example {"Lights": [120, 240]}.
nlohmann::ordered_json ui_probe_json();

/// A rectangle in window units.
struct UiRectangle {
    glm::vec2 min{0.0F};
    glm::vec2 max{0.0F};
};

/// The places of the parts of a row, for tests of the layout.
struct ProbedRow {
    std::string name;
    UiRectangle label;
    UiRectangle control;
    UiRectangle number;         ///< Of a slider; otherwise without a size.
    UiRectangle panel;          ///< The part of the panel that can be seen.
    float number_width = 0.0F;  ///< The width of the text of the number.
};
/// The rows of this frame, if the probe is enabled.
const std::vector<ProbedRow>& probed_rows();

/// Widths that controls need to show their values, in line heights.
inline constexpr float slider_room = 9.5F;
inline constexpr float list_room = 7.0F;
inline constexpr float drag_room = 4.5F;
inline constexpr float check_room = 1.5F;
inline constexpr float path_room = 9.0F;

/// Starts a row of two columns: draws the label, and makes the next item as wide as the rest of the
/// row. The item begins after a label that is wider than its column. If the rest is too small, the
/// item comes below the label.
/// \param room  the width that the item needs, in line heights
/// \return the ImGui identifier of the item
std::string begin_row(const char* label, float room = list_room);

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

/// A slider with its number beside it. A click on the number, or Ctrl+click on the slider, types
/// another one. \return whether the value changed
bool slide(const char* label, float& value, const Slider& slider = {});

/// A slider in degrees for a value in radians.
bool slide_angle(const char* label, float& radians, const Slider& degrees);

/// A drag field for values from 0 without an upper limit; `step` is the change per pixel.
bool drag_up(const char* label, float& value, float step = 0.01F);

/// A slider for a number with this unit; a drag field if the range is too wide for a slider.
bool edit_number(const char* label, float& value, FieldRange range, FieldUnit unit,
                 float default_value);

/// A drag field in which 0 stands for no value.
bool edit_optional(const char* label, std::optional<float>& value);

/// A control for a number or a color with the title, range, unit and default of its field. Other
/// fields have none.
template <typename Owner, typename Value>
bool edit_field(Owner& owner, const SceneField<Owner, Value>& field) {
    Value& value = owner.*field.member;
    const std::string title = field.title();
    if constexpr (std::is_same_v<Value, float>) {
        return edit_number(title.c_str(), value, field.slider_range, field.unit,
                           field.default_value());
    } else if constexpr (std::is_same_v<Value, int>) {
        auto number = static_cast<float>(value);
        if (!edit_number(title.c_str(), number, field.slider_range, field.unit,
                         static_cast<float>(field.default_value())))
            return false;
        value = static_cast<int>(std::lround(std::clamp(number, field.range.min, field.range.max)));
        return true;
    } else if constexpr (std::is_same_v<Value, std::optional<float>>) {
        return edit_optional(title.c_str(), value);
    } else if constexpr (std::is_same_v<Value, glm::vec3>) {
        return pick_color(title.c_str(), value, field.slider_range.max <= 1.0F);
    } else {
        return false;
    }
}
template <typename Owner, typename Value>
bool edit_field(Owner& owner, Value Owner::*member) {
    return edit_field(owner, field_of(member));
}

/// Returns a path without quotes and file://, which terminals and file managers add to a pasted
/// one.
std::filesystem::path pasted_path(std::string text);

/// The user's input in a file field.
struct FileChoice {
    std::optional<std::filesystem::path> file;  ///< A path that was typed or pasted.
    bool is_cleared = false;                    ///< The user pressed the clear button.
    bool is_browsing = false;                   ///< The user wants to select a file in a dialog.
};

/// A small picture of an image, as a part of a texture.
struct Thumbnail {
    unsigned texture = 0;
    glm::vec2 min{0.0F};       ///< Of the upper left corner, in texture coordinates of OpenGL.
    glm::vec2 max{1.0F};       ///< Of the lower right corner.
    glm::ivec2 size{0};        ///< Pixels.
    glm::ivec2 image_size{0};  ///< Of the image itself.
};

/// A text field for the path of a file, with a button for a file dialog.
/// \param shown  the current value, if there is one
/// \param thumbnail  shown before the text, if there is one
FileChoice file_field(const char* label, const std::optional<std::string>& shown,
                      const std::optional<Thumbnail>& thumbnail = std::nullopt);

/// The name of a stage of Progress in panels, for example "compiling shaders" for "programs".
std::string stage_title(const std::string& stage);

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

}  // namespace relief::tools
