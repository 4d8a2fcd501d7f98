// SPDX-License-Identifier: Apache-2.0
/// \file
/// Controls that panels consist of: combo boxes, sliders, file fields and progress bars. Each
/// control reports its position to the UI test probe, which is part of --dump-state. Tests:
/// tests/tools/window/user_interface_test.cpp.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "relief/mesh/execution.h"

namespace relief::tools {

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
bool choose_index(const char* label, int& index, std::initializer_list<const char*> names);

/// The same for an enumeration. The names are in the order of its values.
template <typename Choice>
bool choose(const char* label, Choice& choice, std::initializer_list<const char*> names) {
    int index = static_cast<int>(choice);
    const bool changed = choose_index(label, index, names);
    choice = static_cast<Choice>(index);
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

}  // namespace relief::tools
