// SPDX-License-Identifier: Apache-2.0
// What the scene holds and what hangs on what, what was found in it, and where the camera is.
// Tests: tests/tools/window/panels_test.cpp.
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>  // Switches that are neither on nor off.

#include <algorithm>
#include <set>

#include "common/text.h"
#include "relief/shade/labels.h"
#include "window/controls.h"
#include "window/panels.h"
#include "window/places.h"

namespace relief::tools {
namespace {

/// A switch that shows all of these, or none; in between where some are hidden.
void draw_switch(ViewerState& state, const std::string& name,
                 const std::vector<std::size_t>& instances) {
    if (instances.empty()) return;
    const auto count = std::count_if(instances.begin(), instances.end(),
                                     [&](std::size_t i) { return state.is_shown(i); });
    const bool are_all = static_cast<std::size_t>(count) == instances.size();
    bool is_on = are_all;
    ImGui::PushItemFlag(ImGuiItemFlags_MixedValue, !are_all && count > 0);
    if (ImGui::Checkbox("##shown", &is_on)) state.show(instances, is_on);
    ImGui::PopItemFlag();
    mark_place("show " + name);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip(are_all ? "Hide it" : "Show it");
    ImGui::SameLine();
}

std::string channels_of(const Mesh& mesh) {
    std::string text;
    const auto add = [&](bool has, const char* name) {
        if (has) text += fmt::format("{}{}", text.empty() ? "" : ", ", name);
    };
    add(!mesh.normals.empty(), "normals");
    add(!mesh.tangents.empty(), "tangents");
    add(!mesh.texcoords.empty(), "texture coordinates");
    add(!mesh.colors.empty(), "colours");
    return text.empty() ? "positions alone" : text;
}

void draw_instance(ViewerState& state, std::size_t index) {
    const Scene& scene = state.scene();
    const std::string label = instance_label(scene, index);
    const Mesh& mesh = scene.meshes[scene.instances[index].mesh];
    ImGui::PushID(static_cast<int>(index));
    draw_switch(state, label, {index});
    if (ImGui::TreeNode("instance", "%s", label.c_str())) {
        ImGui::TextWrapped("%s: %s, %s; %s", mesh_label(scene, scene.instances[index].mesh).c_str(),
                           counted(mesh.triangles.size(), "triangle").c_str(),
                           counted(mesh.positions.size(), "vertex", "vertices").c_str(),
                           channels_of(mesh).c_str());
        std::set<std::optional<std::uint32_t>> materials;
        for (const MaterialRange& range : mesh.material_ranges)
            materials.insert(range.material);
        for (const std::optional<std::uint32_t>& material : materials)
            ImGui::BulletText("%s", material_label(scene, material).c_str());
        ImGui::TreePop();
    }
    ImGui::PopID();
}

void draw_things(ViewerState& state, const TreeNode& node);

void draw_node(ViewerState& state, std::size_t index) {
    const SceneTree& tree = state.tree();
    const TreeNode& node = tree.nodes[index];
    ImGui::PushID(fmt::format("node {}", index).c_str());
    draw_switch(state, node.name, instances_below(tree, node));
    const bool is_open = ImGui::TreeNode("node", "%s", node.name.c_str());
    mark_place(node.name);
    if (is_open) {
        draw_things(state, node);
        ImGui::TreePop();
    }
    ImGui::PopID();
}

/// What hangs on a node, and the nodes below it.
void draw_things(ViewerState& state, const TreeNode& node) {
    for (const std::string& carried : node.carried)
        ImGui::BulletText("%s", carried.c_str());
    for (const std::size_t instance : node.instances)
        draw_instance(state, instance);
    for (const std::size_t child : node.children)
        draw_node(state, child);
}

void draw_tree(ViewerState& state) {
    const Scene& scene = state.scene();
    const std::string text = fmt::format("{}, {}, {}", counted(state.tree().nodes.size(), "node"),
                                         counted(scene.instances.size(), "instance"),
                                         counted(scene.meshes.size(), "mesh", "meshes"));
    const bool is_open = ImGui::TreeNode("tree", "%s", text.c_str());
    mark_place("tree");
    if (!is_open) return;
    draw_things(state, state.tree().world);
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
    if (!input.layout_note.empty()) ImGui::TextWrapped("%s", input.layout_note.c_str());
    if (!state.has_scene()) {
        ImGui::TextWrapped("Drop a model here: .glb .gltf .obj .ply .stl .off, or a scene: .json");
        return;
    }
    ImGui::TextWrapped("%s", state.options().model.filename().c_str());
    draw_tree(state);
    draw_findings(input);
    OrbitCamera& camera = state.camera();
    float degrees = glm::degrees(camera.vertical_fov);
    if (slide("Field of view", degrees, {2.0F, 150.0F, "%.1f deg"}))
        camera.vertical_fov = glm::radians(degrees);
}

}  // namespace relief::tools
