// SPDX-License-Identifier: Apache-2.0
// Pictures saved from the window: their size, what is behind the model, one or a whole turn.
// Tests: tests/tools/window/window_test.cpp.
#include <imgui.h>

#include <algorithm>

#include "window/panels.h"
#include "window/places.h"

namespace relief::tools {
namespace {

constexpr int largest_picture_side = 16384;

bool button(const char* label) {
    const bool is_pressed = ImGui::Button(label);
    mark_place(label);
    return is_pressed;
}

}  // namespace

void draw_capture_panel(const PanelInput& input, PanelWishes& wishes) {
    if (!input.state.has_scene() || input.capture == nullptr) return;
    CaptureSettings& settings = *input.capture;
    ImGui::Checkbox("Another size than the view's", &settings.own_size);
    mark_place("Another size than the view's");
    if (settings.own_size) {
        ImGui::InputInt("Width, pixels", &settings.width, 0);
        ImGui::InputInt("Height, pixels", &settings.height, 0);
        settings.width = std::clamp(settings.width, 1, largest_picture_side);
        settings.height = std::clamp(settings.height, 1, largest_picture_side);
    }
    ImGui::Checkbox("Transparent background", &settings.transparent);
    mark_place("Transparent background");
    if (button("Save a picture")) wishes.save_picture = true;
    ImGui::InputInt("Pictures a turn", &settings.pictures, 1, 12);
    settings.pictures = std::clamp(settings.pictures, 2, 9999);
    if (button("Save a turn")) wishes.save_turn = true;
    if (button("Save the scene (JSON)")) wishes.save_scene = true;
    if (button("Save the model (GLB)")) wishes.save_model = true;
    if (!input.captured.empty()) ImGui::TextWrapped("%s", input.captured.c_str());
}

}  // namespace relief::tools
