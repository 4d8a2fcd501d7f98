// SPDX-License-Identifier: Apache-2.0
#include "window/panels.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>  // For checkboxes with a mixed state.

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <type_traits>

#include "common/text.h"
#include "debug_options.h"
#include "relief/shade/frame_settings.h"
#include "window/controls.h"

namespace relief::tools {
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

namespace {

/// The name of the image, or of the first of six.
std::string name_of(const Environment& environment) {
    return std::visit(
        [](const auto& source) {
            if constexpr (std::is_same_v<std::decay_t<decltype(source)>, CubeFaces>) {
                return source.faces.front().name;
            } else {
                return source.image.name;
            }
        },
        environment.source);
}

const char* layout_of(const Environment& environment) {
    static constexpr const char* names[] = {"six images", "a cross of six faces",
                                            "a latitude-longitude panorama",
                                            "an angular light probe"};
    return names[environment.source.index()];
}

bool edit(Environment& environment) {
    ImGui::TextDisabled("%s", layout_of(environment));
    bool changed = drag_up("Intensity", environment.intensity);
    environment.intensity = std::clamp(environment.intensity, 0.0F, 1e6F);
    changed |= ImGui::Checkbox("Show as background", &environment.skybox);
    probe_item("Show as background");
    changed |= ImGui::Checkbox("Light the scene", &environment.lights);
    probe_item("Light the scene");
    return changed;
}

}  // namespace

void draw_environment_panel(const PanelInput& input) {
    ViewerState& state = input.state;
    if (!state.has_scene()) return;
    std::optional<std::string> name;
    if (state.scene().environment) name = name_of(*state.scene().environment);
    const FileChoice choice = file_field("Image or folder", name);
    if (choice.file) {
        state.set_environment(*choice.file);
    } else if (choice.is_cleared) {
        state.edit([](Scene& scene) { scene.environment.reset(); });
    }
    if (!state.scene().environment) return;
    Environment environment = *state.scene().environment;
    if (edit(environment)) state.edit([&](Scene& scene) { scene.environment = environment; });
}

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
    if (!markers.markers) return ImGui::TextUnformatted("Searching for problems");
    if (markers.conditions.empty()) ImGui::TextUnformatted("No problems found");
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
    float length = choices.frame_length.value_or(default_frame_length);
    if (choices.vertex_frames &&
        ImGui::SliderFloat("Length", &length, 1e-3F, 0.2F, "%.3f", ImGuiSliderFlags_Logarithmic)) {
        choices.frame_length = length;
        changed = true;
    }
    int marks = !choices.health_markers ? 0 : *choices.health_markers == HealthChoice::all ? 2 : 1;
    if (ImGui::Combo("Health", &marks, "No markers\0Problems\0Problems and notes\0")) {
        choices.health_markers.reset();
        if (marks > 0)
            choices.health_markers = marks == 2 ? HealthChoice::all : HealthChoice::problem;
        changed = true;
    }
    if (choices.health_markers) draw_legend(input.state.markers());
    if (changed) input.state.set_debug(choices);
}

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

namespace {

constexpr float column_width = 23.0F;  // In line heights.

std::size_t triangles_of(const Scene& scene) {
    std::size_t count = 0;
    for (const Instance& instance : scene.instances)
        count += scene.meshes[instance.mesh]->triangles.size();
    return count;
}

std::string status_text(const PanelInput& input) {
    if (!input.state.has_scene()) return "";
    const std::string saved = input.captured.empty() ? "" : "   " + input.captured;
    return fmt::format("{}   {} x {} pixels   {:.1f} ms per picture   picture {}, {}   {}{}",
                       counted(triangles_of(input.state.scene()), "triangle"),
                       input.drawn.settings.width, input.drawn.settings.height,
                       input.drawn.times.draw, input.drawn.frames,
                       input.is_drawing ? "drawing" : "idle", input.renderer, saved);
}

struct Panel {
    const char* name;
    bool is_open_at_first;
    void (*draw)(const PanelInput&, PanelRequests&);
};

/// A panel without requests to the window.
template <void (*draw)(const PanelInput&)>
void plain(const PanelInput& input, PanelRequests&) {
    draw(input);
}

constexpr std::array all_panels{
    Panel{"Scene", true, plain<draw_scene_panel>},
    Panel{"Lights", false, plain<draw_light_panel>},
    Panel{"Materials", false, plain<draw_material_panel>},
    Panel{"Environment", false, plain<draw_environment_panel>},
    Panel{"Picture", false, plain<draw_picture_panel>},
    Panel{"View", false, plain<draw_view_panel>},
    Panel{"Compare", false, plain<draw_compare_panel>},
    Panel{"Save", false, draw_capture_panel},
    Panel{"Effects", true, draw_effects_panel},
    Panel{"Accuracy", false, draw_accuracy_panel},
};

/// Draws a panel's header, which opens and closes the panel. The layout stores the state.
/// \return whether the panel is open
bool begins(const Panel& panel, WindowLayout& layout) {
    const auto remembered = layout.open_panels.find(panel.name);
    const bool was_open =
        remembered == layout.open_panels.end() ? panel.is_open_at_first : remembered->second;
    ImGui::SetNextItemOpen(was_open);
    const bool is_open = ImGui::CollapsingHeader(panel.name);
    probe_item(panel.name);
    if (is_open != was_open) layout.open_panels[panel.name] = is_open;
    return is_open;
}

}  // namespace

std::vector<std::string> panel_names() {
    std::vector<std::string> names;
    for (const Panel& panel : all_panels)
        names.emplace_back(panel.name);
    return names;
}

float draw_panels(const PanelInput& input, PanelRequests& requests) {
    const ImGuiIO& io = ImGui::GetIO();
    const float width = column_width * ImGui::GetFontSize();
    const float status_height = ImGui::GetFrameHeightWithSpacing();
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize({width, io.DisplaySize.y - status_height});
    ImGui::Begin("Panels", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove);
    ImGui::PushItemWidth(0.5F * width);
    for (const Panel& panel : all_panels) {
        if (begins(panel, input.layout)) panel.draw(input, requests);
    }
    ImGui::PopItemWidth();
    ImGui::End();
    return width;
}

void draw_status(const PanelInput& input, PanelRequests& requests) {
    const ImGuiIO& io = ImGui::GetIO();
    const float height = ImGui::GetFrameHeightWithSpacing();
    ImGui::SetNextWindowPos({0, io.DisplaySize.y - height});
    ImGui::SetNextWindowSize({io.DisplaySize.x, height});
    const float letter = ImGui::GetFontSize();
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.6F * letter, 0.15F * letter});
    ImGui::Begin("Status", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
    const std::string& error =
        input.state.error().empty() ? input.drawn.error : input.state.error();
    if (input.loading_seconds > 0.0) {
        draw_progress("Reading " + input.loading, input.progress);
        ImGui::SameLine();
        ImGui::Text("%.1f s", input.loading_seconds);
        ImGui::SameLine();
        if (ImGui::SmallButton("Cancel")) requests.cancel_loading = true;
        probe_item("Cancel");
    } else if (!input.progress.stage.empty()) {
        draw_progress("Preparing", input.progress);
    } else if (!error.empty()) {
        ImGui::TextColored({1.0F, 0.5F, 0.4F, 1.0F}, "%s", error.c_str());
    } else {
        ImGui::TextUnformatted(status_text(input).c_str());
    }
    ImGui::End();
    ImGui::PopStyleVar();
}

void draw_help(bool& is_open) {
    const ImGuiIO& io = ImGui::GetIO();
    ImGui::SetNextWindowPos({0.5F * io.DisplaySize.x, 0.5F * io.DisplaySize.y}, ImGuiCond_Always,
                            {0.5F, 0.5F});
    ImGui::Begin("Shortcuts", &is_open,
                 ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_AlwaysAutoResize);
    const auto row = [](std::string_view how, std::string_view what) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(how.data(), how.data() + how.size());
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(what.data(), what.data() + what.size());
    };
    if (ImGui::BeginTable("shortcuts", 2, ImGuiTableFlags_SizingFixedFit)) {
        for (const Gesture& gesture : gestures())
            row(gesture.input, gesture.description);
        for (const Shortcut& shortcut : shortcuts())
            row(shortcut.key, shortcut.description);
        ImGui::EndTable();
    }
    ImGui::End();
}

}  // namespace relief::tools
