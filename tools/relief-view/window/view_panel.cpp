// SPDX-License-Identifier: Apache-2.0
// What is shown instead of the picture, and what is drawn over it. Tests:
// tests/tools/window/viewer_state_test.cpp.
#include <imgui.h>

#include <string>

#include "debug_options.h"
#include "window/panels.h"

namespace relief::tools {
namespace {

bool choose_view(DebugView& view) {
    bool changed = false;
    if (!ImGui::BeginCombo("Show", debug_view_info(view).name.data())) return false;
    for (const DebugViewInfo& info : debug_views()) {
        if (ImGui::Selectable(info.name.data(), info.view == view)) {
            view = info.view;
            changed = true;
        }
    }
    ImGui::EndCombo();
    return changed;
}

void draw_legend(const HealthMarkers& markers) {
    if (!markers.markers) return ImGui::TextUnformatted("Looking for trouble");
    if (markers.conditions.empty()) ImGui::TextUnformatted("No trouble found");
    for (const MarkedCondition& marked : markers.conditions) {
        const glm::vec3& color = marked.color_srgb;
        const std::string word(condition_info(marked.condition).word);
        ImGui::TextColored({color.r, color.g, color.b, 1.0F}, "%s: %zu", word.c_str(),
                           marked.count);
    }
}

}  // namespace

void draw_view_panel(const PanelInput& input) {
    DebugChoices choices = input.state.debug();
    bool changed = choose_view(choices.view);
    ImGui::TextWrapped("%s", debug_view_info(choices.view).what.data());
    changed |= ImGui::Checkbox("Wireframe", &choices.wireframe);
    changed |= ImGui::Checkbox("Vertex frames", &choices.vertex_frames);
    float length = choices.frame_length.value_or(usual_frame_length);
    if (choices.vertex_frames &&
        ImGui::SliderFloat("Length", &length, 1e-3F, 0.2F, "%.3f", ImGuiSliderFlags_Logarithmic)) {
        choices.frame_length = length;
        changed = true;
    }
    int marks = !choices.health_markers ? 0 : *choices.health_markers == HealthChoice::all ? 2 : 1;
    if (ImGui::Combo("Health", &marks, "No markers\0Trouble\0Remarks too\0")) {
        choices.health_markers.reset();
        if (marks > 0)
            choices.health_markers = marks == 2 ? HealthChoice::all : HealthChoice::trouble;
        changed = true;
    }
    if (choices.health_markers) draw_legend(input.state.markers());
    if (changed) input.state.set_debug(choices);
}

}  // namespace relief::tools
