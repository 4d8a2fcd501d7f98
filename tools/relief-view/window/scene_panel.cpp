// SPDX-License-Identifier: Apache-2.0
// What the scene holds, what was found in it, and where the camera is.
// Tests: tests/tools/window/window_test.cpp.
#include <fmt/format.h>
#include <imgui.h>

#include "relief/shade/labels.h"
#include "window/panels.h"

namespace relief::tools {
namespace {

void draw_instances(const Scene& scene) {
    if (!ImGui::TreeNode("instances", "%zu instances", scene.instances.size())) return;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
        ImGui::BulletText("%s: %zu triangles", instance_label(scene, i).c_str(),
                          mesh.triangles.size());
    }
    ImGui::TreePop();
}

void draw_findings(const PanelInput& input) {
    for (const std::string& note : input.state.notes())
        ImGui::TextWrapped("%s", note.c_str());
    const auto draw = [](const Report& report) {
        for (const Finding& finding : report.findings()) {
            ImGui::TextWrapped("%zu x %s: %s", finding.count, finding.kind.c_str(),
                               finding.outcome.c_str());
        }
    };
    draw(input.state.findings());
    draw(input.drawn.findings);
}

}  // namespace

void draw_scene_panel(const PanelInput& input) {
    ViewerState& state = input.state;
    if (!state.has_scene()) {
        ImGui::TextWrapped("Drop a model here: .glb .gltf .obj .ply .stl .off, or a scene: .json");
        return;
    }
    ImGui::TextWrapped("%s", state.options().model.filename().c_str());
    draw_instances(state.scene());
    draw_findings(input);
    OrbitCamera& camera = state.camera();
    float degrees = glm::degrees(camera.vertical_fov);
    if (ImGui::SliderFloat("Field of view", &degrees, 2.0F, 150.0F, "%.1f deg"))
        camera.vertical_fov = glm::radians(degrees);
}

}  // namespace relief::tools
