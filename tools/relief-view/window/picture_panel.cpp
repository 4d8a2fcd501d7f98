// SPDX-License-Identifier: Apache-2.0
// How radiance becomes a picture: exposure, tone curve, what is behind.
// Tests: tests/tools/window/panels_test.cpp.
#include <imgui.h>

#include <cmath>

#include "window/controls.h"
#include "window/panels.h"
#include "window/places.h"

namespace relief::tools {

void draw_picture_panel(const PanelInput& input) {
    if (!input.state.has_scene()) return;
    const Scene& scene = input.state.scene();
    float stops = std::log2(scene.exposure);
    ToneMapping tone = scene.tone_mapping;
    glm::vec4 background = scene.background;
    bool changed = slide("Exposure", stops, {-8.0F, 8.0F, "%.1f stops"});
    changed |= choose("Tone curve", tone, {"None", "Reinhard", "ACES"});
    changed |= ImGui::ColorEdit3("Background", &background.x, ImGuiColorEditFlags_Float);
    if (!changed) return;
    input.state.edit([&](Scene& edited) {
        edited.exposure = std::exp2(stops);
        edited.tone_mapping = tone;
        edited.background = background;
    });
}

}  // namespace relief::tools
