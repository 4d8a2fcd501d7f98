// SPDX-License-Identifier: Apache-2.0
// How radiance becomes a picture: exposure, tone curve, what is behind.
// Tests: tests/tools/window/window_test.cpp.
#include <imgui.h>

#include <cmath>

#include "window/panels.h"

namespace relief::tools {

void draw_picture_panel(const PanelInput& input) {
    if (!input.state.has_scene()) return;
    const Scene& scene = input.state.scene();
    float stops = std::log2(scene.exposure);
    int tone = static_cast<int>(scene.tone_mapping);
    glm::vec4 background = scene.background;
    bool changed = ImGui::SliderFloat("Exposure", &stops, -8.0F, 8.0F, "%.1f stops");
    changed |= ImGui::Combo("Tone curve", &tone, "None\0Reinhard\0ACES\0");
    changed |= ImGui::ColorEdit3("Background", &background.x, ImGuiColorEditFlags_Float);
    float intensity = scene.environment ? scene.environment->intensity : 0.0F;
    bool skybox = scene.environment && scene.environment->skybox;
    bool lights = scene.environment && scene.environment->lights;
    if (scene.environment) {
        changed |= ImGui::DragFloat("Surroundings", &intensity, 0.01F, 0.0F, 1e6F, "%.3g");
        changed |= ImGui::Checkbox("Shown behind", &skybox);
        changed |= ImGui::Checkbox("Sheds light", &lights);
    }
    if (!changed) return;
    input.state.edit([&](Scene& edited) {
        edited.exposure = std::exp2(stops);
        edited.tone_mapping = static_cast<ToneMapping>(tone);
        edited.background = background;
        if (!edited.environment) return;
        edited.environment->intensity = std::max(intensity, 0.0F);
        edited.environment->skybox = skybox;
        edited.environment->lights = lights;
    });
}

}  // namespace relief::tools
