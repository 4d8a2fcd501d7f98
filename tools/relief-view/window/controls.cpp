// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/panels_test.cpp.
#include "window/controls.h"

#include <imgui.h>

#include <string>

#include "window/places.h"

namespace relief::tools {

bool choose_index(const char* label, int& index, std::initializer_list<const char*> names) {
    const bool is_open = ImGui::BeginCombo(label, names.begin()[index]);
    mark_place(label);
    if (!is_open) return false;
    const int before = index;
    for (int i = 0; i < static_cast<int>(names.size()); ++i) {
        if (ImGui::Selectable(names.begin()[i], i == before)) index = i;
        mark_place(std::string(label) + ": " + names.begin()[i]);
    }
    ImGui::EndCombo();
    return index != before;
}

bool slide(const char* label, float& value, const Slider& slider) {
    const ImGuiSliderFlags flags =
        ImGuiSliderFlags_AlwaysClamp |
        (slider.is_logarithmic ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None);
    const bool changed =
        ImGui::SliderFloat(label, &value, slider.least, slider.most, slider.format, flags);
    mark_place(label);
    return changed;
}

bool drag_up(const char* label, float& value, float step) {
    constexpr float most = 1e6F;
    const bool changed =
        ImGui::DragFloat(label, &value, step, 0.0F, most, "%.3g", ImGuiSliderFlags_AlwaysClamp);
    mark_place(label);
    return changed;
}

}  // namespace relief::tools
