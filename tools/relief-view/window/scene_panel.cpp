// SPDX-License-Identifier: Apache-2.0
// The panel of the scene: its tree, findings, material variant and camera.
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>  // For checkboxes with a mixed state.

#include <algorithm>
#include <set>

#include "common/map_kind.h"
#include "common/text.h"
#include "window/controls.h"
#include "window/panels.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

/// A checkbox that shows or hides these instances. It is mixed if some of them are hidden.
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
    probe_item("show " + name);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip(are_all ? "Hide" : "Show");
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
    add(!mesh.colors.empty(), "colors");
    return text.empty() ? "positions only" : text;
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
    probe_item(node.name);
    if (is_open) {
        draw_things(state, node);
        ImGui::TreePop();
    }
    ImGui::PopID();
}

/// Draws the contents of a node and the nodes below it.
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
    probe_item("tree");
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
    const AssumedKinds& assumed = input.state.options().assumed;
    draw(without_assumed(input.state.findings(), assumed));
    draw(without_assumed(input.drawn.findings, assumed));
}

/// Draws the choice of a material variant, if the file has any.
void choose_variant(const ViewerState& state, PanelRequests& requests) {
    std::vector<std::string> names = state.playback().material_variants();
    if (names.empty()) return;
    names.insert(names.begin(), "none");
    std::size_t index = 0;
    const std::optional<std::string>& chosen = state.options().material_variant;
    for (std::size_t i = 1; chosen && i < names.size(); ++i) {
        if (names[i] == *chosen || *chosen == fmt::format("{}", i)) index = i;
    }
    if (choose_index("Material variant", index, names))
        requests.material_variant = index == 0 ? "" : names[index];
}

}  // namespace

void draw_scene_panel(const PanelInput& input, PanelRequests& requests) {
    ViewerState& state = input.state;
    if (!input.layout_note.empty()) ImGui::TextWrapped("%s", input.layout_note.c_str());
    if (!state.has_scene()) {
        ImGui::TextWrapped(
            "Open or drop a model: .glb .gltf .obj .ply .stl .off, or a scene: .json");
        if (!input.layout.recent_files.empty()) ImGui::TextDisabled("Recent files");
        for (const std::string& file : input.layout.recent_files) {
            const std::string name = std::filesystem::path(file).filename().string();
            if (ImGui::Selectable((name + "##" + file).c_str())) requests.open = file;
            probe_item("recent " + name);
            if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", file.c_str());
        }
        return;
    }
    ImGui::TextWrapped("%s", state.options().model.filename().c_str());
    draw_tree(state);
    draw_findings(input);
    choose_variant(state, requests);
    const auto chosen = input.loading != nullptr
                            ? input.loading->scene_fields.get(&Scene::ambient_occlusion)
                            : std::nullopt;
    bool is_occluded = chosen.value_or(state.scene().ambient_occlusion).has_value();
    if (check("Ambient occlusion", is_occluded))
        requests.ambient_occlusion = is_occluded ? AmbientOcclusion{}.distance : 0.0F;
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("Computes how much light from all around reaches every vertex.");
    if (const std::vector<std::string> cameras = state.playback().cameras(); cameras.size() > 1) {
        std::size_t index = state.playback().chosen_camera();
        if (choose_index("Camera", index, cameras)) state.choose_camera(index);
    }
    OrbitCamera& camera = state.camera();
    slide_angle("Field of view", camera.vertical_fov,
                {min_fov_degrees, max_fov_degrees, "%.1f deg"});
    check("Orthographic", camera.orthographic);
}

}  // namespace relief::tools
