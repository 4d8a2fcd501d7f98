// SPDX-License-Identifier: Apache-2.0
// The controls, the effects panel, the small panels (scene, environment, debug view and picture),
// the toolbar and its file dialog. Tests: tests/tools/window/user_interface_test.cpp,
// effects_panel_test.cpp.
#include "window/panels.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>  // For checkboxes with a mixed state.
#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/text.h"
#include "effect_options.h"
#include "relief/shade/frame_settings.h"

namespace relief::tools {

// Controls.

namespace {

/// The positions of the controls of this frame, by name.
struct UiProbe {
    bool is_enabled = false;
    nlohmann::ordered_json positions = nlohmann::ordered_json::object();
};

UiProbe& ui_probe() {
    static UiProbe probe;
    return probe;
}

}  // namespace

void enable_ui_probe() {
    ui_probe().is_enabled = true;
}

void clear_ui_probe() {
    ui_probe().positions = nlohmann::ordered_json::object();
}

void probe_item(const std::string& name) {
    if (!ui_probe().is_enabled || !ImGui::IsItemVisible()) return;
    const ImVec2 min = ImGui::GetItemRectMin();
    const ImVec2 max = ImGui::GetItemRectMax();
    ui_probe().positions[name] = {std::round(0.5F * (min.x + max.x)),
                                  std::round(0.5F * (min.y + max.y))};
}

nlohmann::ordered_json ui_probe_json() {
    return ui_probe().positions;
}

namespace {

// In line heights. The labels have space for the longest one, "Metallic-roughness map".
constexpr float column_width = 27.0F;
constexpr float label_width = 12.5F;

}  // namespace

std::string begin_row(const char* label) {
    const std::string text(label, ImGui::FindRenderedTextEnd(label));
    if (text.empty()) return label;
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(text.c_str());
    ImGui::SameLine(label_width * ImGui::GetFontSize());
    ImGui::SetNextItemWidth(-FLT_MIN);
    return std::string("##") + label;
}

bool check(const char* label, bool& value) {
    const bool changed = ImGui::Checkbox(begin_row(label).c_str(), &value);
    probe_item(label);
    return changed;
}

bool pick_color(const char* label, glm::vec3& color, bool has_limit) {
    const ImGuiColorEditFlags flags =
        ImGuiColorEditFlags_Float |
        (has_limit ? ImGuiColorEditFlags_None : ImGuiColorEditFlags_HDR);
    const bool changed = ImGui::ColorEdit3(begin_row(label).c_str(), &color.x, flags);
    probe_item(label);
    return changed;
}

bool choose_index(const char* label, std::size_t& index, std::span<const std::string> names) {
    const bool is_open = ImGui::BeginCombo(begin_row(label).c_str(), names[index].c_str());
    probe_item(label);
    if (!is_open) return false;
    const std::size_t before = index;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (ImGui::Selectable(names[i].c_str(), i == before)) index = i;
        probe_item(std::string(label) + ": " + names[i]);
    }
    ImGui::EndCombo();
    return index != before;
}

bool slide(const char* label, float& value, const Slider& slider) {
    const ImGuiSliderFlags flags =
        ImGuiSliderFlags_AlwaysClamp |
        (slider.is_logarithmic ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None);
    const std::string id = begin_row(label);
    bool changed =
        ImGui::SliderFloat(id.c_str(), &value, slider.min, slider.max, slider.format, flags);
    probe_item(label);
    if (slider.default_value && value != *slider.default_value && ImGui::IsItemHovered()) {
        ImGui::SetTooltip("Right click: %s",
                          fmt::format("reset to {:g}", *slider.default_value).c_str());
        if (ImGui::IsMouseClicked(ImGuiMouseButton_Right)) {
            value = *slider.default_value;
            changed = true;
        }
    }
    return changed;
}

bool slide_angle(const char* label, float& radians, const Slider& degrees) {
    float value = glm::degrees(radians);
    const bool changed = slide(label, value, degrees);
    if (changed) radians = glm::radians(value);
    return changed;
}

bool drag_up(const char* label, float& value, float step) {
    constexpr float max = 1e6F;
    const bool changed = ImGui::DragFloat(begin_row(label).c_str(), &value, step, 0.0F, max, "%.3g",
                                          ImGuiSliderFlags_AlwaysClamp);
    probe_item(label);
    return changed;
}

namespace {

/// Removes quotes and file://, which terminals and file managers add to a pasted path.
std::filesystem::path path_of(std::string text) {
    const auto is_around = [](char c) { return c == ' ' || c == '\'' || c == '"' || c == '\n'; };
    while (!text.empty() && is_around(text.back()))
        text.pop_back();
    while (!text.empty() && is_around(text.front()))
        text.erase(text.begin());
    const std::string scheme = "file://";
    return text.starts_with(scheme) ? text.substr(scheme.size()) : text;
}

}  // namespace

namespace {

/// Draws a thumbnail as high as a text field; a tooltip shows it larger.
void draw(const Thumbnail& thumbnail) {
    const auto id = reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(thumbnail.texture));
    const ImVec2 min(thumbnail.min.x, thumbnail.min.y);
    const ImVec2 max(thumbnail.max.x, thumbnail.max.y);
    const float height = ImGui::GetFrameHeight();
    const glm::vec2 size =
        glm::vec2(thumbnail.size) *
        (height / static_cast<float>(std::max(thumbnail.size.x, thumbnail.size.y)));
    ImGui::Image(id, {size.x, size.y}, min, max);
    if (!ImGui::IsItemHovered()) return;
    ImGui::BeginTooltip();
    const glm::vec2 large = 6.0F * size;
    ImGui::Image(id, {large.x, large.y}, min, max);
    ImGui::Text("%d x %d", thumbnail.image_size.x, thumbnail.image_size.y);
    ImGui::EndTooltip();
}

/// A text field. While nobody types, it shows the end of a text that is too long, since paths end
/// with the name of the file.
bool edit_path(std::string& text) {
    ImGuiStorage* const storage = ImGui::GetStateStorage();
    const ImGuiID id = ImGui::GetID("##path");
    const float width = ImGui::CalcItemWidth() - 2.0F * ImGui::GetStyle().FramePadding.x;
    const auto width_of = [](const std::string& part) {
        return ImGui::CalcTextSize(part.c_str()).x;
    };
    const std::string end = fitting_end(text, width, width_of);
    const bool is_replaced = end != text && !storage->GetBool(id);
    const ImU32 color = ImGui::GetColorU32(ImGuiCol_Text);
    if (is_replaced) ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(0.0F, 0.0F, 0.0F, 0.0F));
    const bool is_entered = ImGui::InputTextWithHint(
        "##path", "path of a file", &text,
        ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    if (is_replaced) ImGui::PopStyleColor();
    storage->SetBool(id, ImGui::IsItemActive());
    if (is_replaced && !ImGui::IsItemActive()) {
        const ImVec2 corner = ImGui::GetItemRectMin();
        const ImVec2& padding = ImGui::GetStyle().FramePadding;
        ImGui::GetWindowDrawList()->AddText({corner.x + padding.x, corner.y + padding.y}, color,
                                            end.c_str());
    }
    return is_entered;
}

}  // namespace

FileChoice file_field(const char* label, const std::optional<std::string>& shown,
                      const std::optional<Thumbnail>& thumbnail) {
    FileChoice choice;
    begin_row(label);
    ImGui::PushID(label);
    if (thumbnail) {
        draw(*thumbnail);
        probe_item(std::string("thumbnail of ") + label);
        ImGui::SameLine(0.0F, ImGui::GetStyle().ItemInnerSpacing.x);
        ImGui::SetNextItemWidth(-1.0F);
    }
    const float button = ImGui::GetFrameHeight();
    if (shown) ImGui::SetNextItemWidth(-button - ImGui::GetStyle().ItemInnerSpacing.x);
    std::string text = shown.value_or("");
    // Dear ImGui keeps the text while it is edited.
    if (edit_path(text)) {
        const std::filesystem::path file = path_of(text);
        if (file.empty()) {
            choice.is_cleared = shown.has_value();
        } else if (text != shown) {
            choice.file = file;
        }
    }
    probe_item(label);
    if (shown && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", shown->c_str());
    if (shown) {
        ImGui::SameLine(0.0F, ImGui::GetStyle().ItemInnerSpacing.x);
        if (ImGui::Button("x", {button, 0.0F})) choice.is_cleared = true;
        probe_item(std::string("clear ") + label);
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("Remove");
    }
    ImGui::PopID();
    return choice;
}

void draw_progress(const std::string& what, const Progress::State& progress) {
    const std::string stage = progress.stage.empty() ? "" : ": " + progress.stage;
    ImGui::TextUnformatted((what + stage).c_str());
    if (progress.part) {
        ImGui::SameLine();
        const std::string percent = fmt::format("{:.0f} %", 100.0 * *progress.part);
        ImGui::ProgressBar(static_cast<float>(*progress.part),
                           {12.0F * ImGui::GetFontSize(), ImGui::GetTextLineHeight()},
                           percent.c_str());
    }
}

std::string fitting_end(const std::string& text, float width,
                        const std::function<float(const std::string&)>& width_of) {
    if (width_of(text) <= width) return text;
    const auto continues = [&](std::size_t i) {  // A character of UTF-8 is not divided.
        return i < text.size() && (static_cast<unsigned char>(text[i]) & 0xC0U) == 0x80U;
    };
    for (std::size_t begin = 1; begin < text.size(); ++begin) {
        const std::string end = "..." + text.substr(begin);
        if (!continues(begin) && width_of(end) <= width) return end;
    }
    return "...";
}

std::string fitting_line(const std::vector<std::string>& parts, float width,
                         const std::function<float(const std::string&)>& width_of) {
    const std::string gap = "   ";
    std::string line;
    for (const std::string& part : parts) {
        if (part.empty()) continue;
        const std::string longer = line.empty() ? part : line + gap + part;
        if (width_of(longer) <= width) {
            line = longer;
            continue;
        }
        if (!line.empty()) return line;
        const auto continues = [&](std::size_t i) {  // A character of UTF-8 is not divided.
            return (static_cast<unsigned char>(part[i]) & 0xC0U) == 0x80U;
        };
        for (std::size_t kept = part.size() - 1; kept > 1; --kept) {
            std::size_t end = kept / 2;
            std::size_t begin = part.size() - (kept - end);
            while (end > 0 && continues(end))
                --end;
            while (begin + 1 < part.size() && continues(begin))
                ++begin;
            line = part.substr(0, end) + "..." + part.substr(begin);
            if (width_of(line) <= width) break;
        }
        return line;
    }
    return line;
}

// The effects panel.

std::string numbered_lines(const std::string& source) {
    const bool has_open_end = !source.empty() && source.back() != '\n';
    const auto count = std::count(source.begin(), source.end(), '\n') + (has_open_end ? 1 : 0);
    const std::size_t width = fmt::format("{}", count).size();
    std::istringstream lines(source);
    std::string text;
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number)
        text += fmt::format("{:>{}}  {}\n", number, width, line);
    return text;
}

void ShaderPanel::assemble(const FramePlan& plan) {
    programs_.clear();
    error_.clear();
    try {
        for (ShaderListing& listing : shader_listings(plan)) {
            Program program{describe(listing.features), std::move(listing), "", ""};
            program.vertex = numbered_lines(program.listing.vertex);
            program.fragment = numbered_lines(program.listing.fragment);
            programs_.push_back(std::move(program));
        }
    } catch (const std::exception& error) {  // A file in RELIEF_SHADER_DIR may be incomplete.
        error_ = error.what();
    }
}

void ShaderPanel::draw_stage(const char* name, const std::string& source, std::string& numbered) {
    if (!ImGui::BeginTabItem(name)) return probe_item(name);
    probe_item(name);
    if (ImGui::Button("Copy without numbers")) ImGui::SetClipboardText(source.c_str());
    probe_item("Copy without numbers");
    // The field is read-only, so the text does not change.
    ImGui::InputTextMultiline("##source", numbered.data(), numbered.size() + 1,
                              {-1.0F, 24.0F * ImGui::GetTextLineHeight()},
                              ImGuiInputTextFlags_ReadOnly);
    ImGui::EndTabItem();
}

void ShaderPanel::draw(const std::shared_ptr<const FramePlan>& plan) {
    if (plan_ != plan) assemble(*plan);
    plan_ = plan;
    if (!error_.empty()) ImGui::TextWrapped("%s", error_.c_str());
    for (std::size_t i = 0; i < programs_.size(); ++i) {
        Program& program = programs_[i];
        const bool is_open = ImGui::TreeNode(fmt::format("{}##{}", program.name, i).c_str());
        probe_item(fmt::format("Program {}", i + 1));
        if (!is_open) continue;
        if (ImGui::BeginTabBar("stages")) {
            draw_stage("Fragment shader", program.listing.fragment, program.fragment);
            draw_stage("Vertex shader", program.listing.vertex, program.vertex);
            ImGui::EndTabBar();
        }
        ImGui::TreePop();
    }
}

namespace {

/// 0: automatic, 1: forced on, 2: forced off.
int forced(const EffectRequest& requests, const std::string& name) {
    for (const ForcedEffect& effect : requests.forced) {
        if (effect.name == name) return effect.on ? 1 : 2;
    }
    return 0;
}

void draw_switch(ViewerState& state, const std::string& name) {
    int choice = forced(state.effects(), name);
    ImGui::PushID(name.c_str());
    ImGui::SetNextItemWidth(4.5F * ImGui::GetFontSize());
    if (ImGui::Combo("##forced", &choice, "auto\0on\0off\0")) {
        EffectRequest requests = state.effects();
        std::erase_if(requests.forced,
                      [&](const ForcedEffect& effect) { return effect.name == name; });
        if (choice != 0) requests.forced.push_back({name, choice == 1});
        state.set_effects(std::move(requests));
    }
    probe_item("force " + name);
    ImGui::PopID();
}

/// Draws the rows of the effects that are on, or of those that are off.
void draw_reasons(const PanelInput& input, const std::vector<EffectReason>& reasons, bool are_on) {
    for (const EffectReason& reason : reasons) {
        if (reason.on != are_on) continue;
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        draw_switch(input.state, reason.effect);
        // The times come before the names, because long names reach beyond the panel.
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(input.effect_times.text(reason.effect).c_str());
        ImGui::TableNextColumn();
        const ImVec4 color =
            ImGui::GetStyleColorVec4(reason.on ? ImGuiCol_Text : ImGuiCol_TextDisabled);
        ImGui::TextColored(color, "%s", reason.effect.c_str());
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", reason.reason.c_str());
    }
}

/// Draws the measured times, or a button that measures them.
void draw_effect_times(const PanelInput& input, PanelRequests& requests) {
    const EffectTimes::State effect_times = input.effect_times.state();
    if (effect_times.is_running) {
        const std::size_t done = effect_times.costs.effects.size();
        const std::string text = fmt::format("effect {} of {}", done + 1, effect_times.count);
        ImGui::ProgressBar(effect_times.count == 0
                               ? 0.0F
                               : static_cast<float>(done) / static_cast<float>(effect_times.count),
                           {0.5F * ImGui::GetContentRegionAvail().x, 0.0F}, text.c_str());
        ImGui::SameLine();
        if (ImGui::Button("Stop")) requests.stop_measuring = true;
        probe_item("Stop");
        return;
    }
    if (ImGui::Button("Measure times")) requests.measure_effects = true;
    probe_item("Measure times");
    if (!effect_times.error.empty()) return ImGui::TextWrapped("%s", effect_times.error.c_str());
    if (effect_times.costs.effects.empty())
        return ImGui::TextWrapped(
            "The time of an effect is the difference between a frame with it and a frame without "
            "it.");
    const TimeStatistics& frame = effect_times.costs.frame;
    ImGui::TextWrapped("Frame: %.2f ms (%.2f to %.2f), %d x %d pixels, %s", frame.median, frame.p10,
                       frame.p90, effect_times.width, effect_times.height,
                       counted(static_cast<std::size_t>(effect_times.samples), "sample").c_str());
}

}  // namespace

void draw_effects_panel(const PanelInput& input, PanelRequests& requests) {
    if (!input.drawn.plan) return;
    const FramePlan& plan = *input.drawn.plan;
    // Debug views do not draw the effects.
    if (input.state.debug().view == DebugView::picture) draw_effect_times(input, requests);
    const bool is_open = ImGui::TreeNode("Shaders");
    probe_item("Shaders");
    if (is_open) {
        input.shaders.draw(input.drawn.plan);
        ImGui::TreePop();
    }
    if (ImGui::BeginTable("effects", 3, ImGuiTableFlags_SizingFixedFit)) {
        for (const bool are_on : {true, false}) {
            draw_reasons(input, plan.reasons, are_on);
            if (!plan.draws.empty()) draw_reasons(input, plan.draws.front().reasons, are_on);
        }
        ImGui::EndTable();
    }
}

// The small panels, and all panels in a column.

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
    changed |= slide_angle("Rotation", environment.rotation, {-180.0F, 180.0F, "%.0f deg"});
    changed |= check("Show as background", environment.skybox);
    if (environment.skybox) changed |= slide(environment, &Environment::skybox_blur);
    changed |= check("Environment light", environment.lights);
    return changed;
}

}  // namespace

void draw_environment_panel(const PanelInput& input) {
    ViewerState& state = input.state;
    if (!state.has_scene()) return;
    std::optional<std::string> name;
    if (state.scene().environment) name = name_of(*state.scene().environment);
    const FileChoice choice = file_field("Image or folder", name);
    if (!name && ImGui::Button("Photo studio")) state.set_environment("studio");
    if (!name) probe_item("Photo studio");
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
    if (!ImGui::BeginCombo(begin_row("Show").c_str(), debug_view_info(view).name.data()))
        return false;
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
    changed |= check("Wireframe", choices.wireframe);
    changed |= check("Vertex frames", choices.vertex_frames);
    float length = choices.frame_length.value_or(default_frame_length);
    if (choices.vertex_frames &&
        slide("Length", length, {1e-3F, 0.2F, "%.3f", true, default_frame_length})) {
        choices.frame_length = length;
        changed = true;
    }
    changed |= check("Grid and axes", choices.grid);
    if (choices.grid && input.state.has_scene())
        ImGui::TextDisabled("A cell is %g wide.", input.state.grid().spacing);
    int marks = !choices.health_markers ? 0 : *choices.health_markers == HealthChoice::all ? 2 : 1;
    if (ImGui::Combo(begin_row("Health").c_str(), &marks,
                     "No markers\0Problems\0Problems and notes\0")) {
        choices.health_markers.reset();
        if (marks > 0)
            choices.health_markers = marks == 2 ? HealthChoice::all : HealthChoice::problem;
        changed = true;
    }
    if (choices.health_markers) draw_legend(input.state.markers());
    bool has_light_markers = input.state.has_light_markers();
    if (check("Light markers", has_light_markers)) input.state.act(Action::light_markers);
    if (changed) input.state.set_debug(choices);
}

void draw_picture_panel(const PanelInput& input) {
    if (!input.state.has_scene()) return;
    const Scene& scene = input.state.scene();
    float stops = std::log2(scene.exposure);
    ToneMapping tone = scene.tone_mapping;
    glm::vec3 background(scene.background);
    bool changed =
        slide("Exposure", stops,
              {std::log2(min_exposure), std::log2(max_exposure), "%.1f stops", false, 0.0F});
    changed |= choose("Tone curve", tone);
    changed |= pick_color("Background", background);
    if (!changed) return;
    input.state.edit([&](Scene& edited) {
        edited.exposure = std::exp2(stops);
        edited.tone_mapping = tone;
        edited.background = glm::vec4(background, edited.background.w);
    });
}

namespace {

/// The parts of the status line, the most important one first.
std::vector<std::string> status_parts(const PanelInput& input) {
    if (!input.state.has_scene()) return {};
    const FrameSettings& settings = input.drawn.settings;
    return {input.captured,
            counted(triangle_count(input.state.scene()), "triangle"),
            fmt::format("{} x {} pixels", settings.width, settings.height),
            fmt::format("{:.1f} ms per picture", input.drawn.times.draw),
            input.is_drawing ? "drawing" : "idle",
            input.renderer,
            fmt::format("picture {}", input.drawn.frames)};
}

/// Shows a line that fits; if a message is cut, its tooltip has all of it.
void draw_line(const std::vector<std::string>& parts, const ImVec4& color) {
    const auto width_of = [](const std::string& text) {
        return ImGui::CalcTextSize(text.c_str()).x;
    };
    const std::string line = fitting_line(parts, ImGui::GetContentRegionAvail().x, width_of);
    ImGui::TextColored(color, "%s", line.c_str());
    const bool is_cut = !parts.empty() && !line.starts_with(parts.front());
    if (is_cut && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", parts.front().c_str());
}

struct Panel {
    const char* group;  ///< The caption above the first panel of each group.
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
    Panel{"Contents", "Scene", true, draw_scene_panel},
    Panel{"Contents", "Lights", false, plain<draw_light_panel>},
    Panel{"Contents", "Materials", false, plain<draw_material_panel>},
    Panel{"Contents", "Environment", false, plain<draw_environment_panel>},
    Panel{"Image", "Picture", false, plain<draw_picture_panel>},
    Panel{"Image", "View", false, plain<draw_view_panel>},
    Panel{"Image", "Compare", false, plain<draw_compare_panel>},
    Panel{"Image", "Save", false, draw_capture_panel},
    Panel{"Analysis", "Effects", false, draw_effects_panel},
    Panel{"Analysis", "Accuracy", false, draw_accuracy_panel},
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

/// Menu entries with the descriptions and keys of shortcuts.
void draw_menu(const char* name, std::initializer_list<Action> entries, PanelRequests& requests) {
    if (ImGui::Button(name)) ImGui::OpenPopup(name);
    probe_item(name);
    if (!ImGui::BeginPopup(name)) return;
    for (const Action action : entries) {
        const auto& all = shortcuts();
        const auto found = std::find_if(all.begin(), all.end(), [&](const Shortcut& shortcut) {
            return shortcut.action == action;
        });
        const std::string text(found->description);
        if (ImGui::MenuItem(text.c_str(), std::string(found->key).c_str()))
            requests.actions.push_back(action);
        probe_item(text);
    }
    ImGui::EndPopup();
}

/// Draws the buttons above the panels. \return their height in window units
float draw_toolbar(const ViewerState& state, float width, PanelRequests& requests) {
    const ImGuiStyle& style = ImGui::GetStyle();
    const float height = ImGui::GetFrameHeight() + 2.0F * style.WindowPadding.y;
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize({width, height});
    ImGui::Begin("Toolbar", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
    const auto button = [&](const char* name, Action action, const char* tooltip) {
        if (ImGui::Button(name)) requests.actions.push_back(action);
        probe_item(name);
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", tooltip);
        ImGui::SameLine();
    };
    button("Open...", Action::open, "Open a model or a scene (Ctrl+O)");
    draw_menu("Save as", {Action::save_picture, Action::save_scene, Action::save_model}, requests);
    ImGui::SameLine();
    draw_menu("Edit", {Action::undo, Action::redo, Action::copy_camera, Action::paste_camera},
              requests);
    ImGui::SameLine();
    draw_menu("Views",
              {Action::fit, Action::front, Action::back, Action::right, Action::left, Action::top,
               Action::bottom, Action::next_file, Action::previous_file, Action::theme,
               Action::larger_ui, Action::smaller_ui},
              requests);
    ImGui::SameLine();
    if (state.has_scene() && state.playback().has_motion()) {
        button(state.playback().is_playing() ? "Pause##toolbar" : "Play##toolbar", Action::play,
               "Play or pause the animation (P)");
    } else {
        button("Turn", Action::turntable, "Start or stop the turntable (Space)");
    }
    button("Help", Action::help, "Show all shortcuts (F1)");
    ImGui::End();
    return height;
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
    const float top = draw_toolbar(input.state, width, requests);
    ImGui::SetNextWindowPos({0, top});
    ImGui::SetNextWindowSize({width, io.DisplaySize.y - status_height - top});
    ImGui::Begin("Panels", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_AlwaysVerticalScrollbar);
    std::string_view group;
    for (const Panel& panel : all_panels) {
        if (group != panel.group) ImGui::TextDisabled("%s", panel.group);
        group = panel.group;
        if (begins(panel, input.layout)) panel.draw(input, requests);
    }
    ImGui::End();
    return width;
}

namespace {

constexpr std::array speeds{0.1F, 0.25F, 0.5F, 1.0F, 2.0F, 4.0F};

void choose_speed(ViewerState& state) {
    std::vector<std::string> names;
    std::size_t index = 0;
    for (const float speed : speeds) {
        if (speed == state.playback().speed()) index = names.size();
        names.push_back(fmt::format("{:g} x", speed));
    }
    ImGui::SetNextItemWidth(5.0F * ImGui::GetFontSize());
    if (choose_index("##Speed", index, names))
        state.change_playback([&](Playback& playback) { playback.set_speed(speeds[index]); });
}

void choose_clip(ViewerState& state) {
    const Playback& now = state.playback();
    std::vector<std::string> names = {"all"};
    names.insert(names.end(), now.clips().begin(), now.clips().end());
    std::size_t index = now.clip() ? *now.clip() + 1 : 0;
    ImGui::SetNextItemWidth(8.0F * ImGui::GetFontSize());
    if (!choose_index("##Clip", index, names)) return;
    state.change_playback([&](Playback& playback) {
        playback.set_clip(index == 0 ? std::nullopt : std::optional(index - 1));
    });
}

}  // namespace

float draw_playback(ViewerState& state, float left, float bottom) {
    const Playback& now = state.playback();
    if (!state.has_scene() || (!now.has_motion() && now.clips().size() < 2)) return 0.0F;
    const ImGuiIO& io = ImGui::GetIO();
    const float letter = ImGui::GetFontSize();
    const float width = io.DisplaySize.x - left;
    // Narrow windows show the clips below.
    const bool has_clips = now.clips().size() > 1;
    const bool is_narrow = has_clips && width < 32.0F * letter;
    const float height = ImGui::GetFrameHeight() + 0.6F * letter +
                         (is_narrow ? ImGui::GetFrameHeightWithSpacing() : 0.0F);
    ImGui::SetNextWindowPos({left, io.DisplaySize.y - bottom - height});
    ImGui::SetNextWindowSize({width, height});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.6F * letter, 0.3F * letter});
    ImGui::Begin("Playback", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
    if (ImGui::Button(now.is_playing() ? "Pause" : "Play", {4.5F * letter, 0.0F}))
        state.act(Action::play);
    probe_item("Play");
    ImGui::SameLine();
    const bool clips_are_beside = has_clips && !is_narrow;
    const float others =
        (clips_are_beside ? 13.0F : 5.0F) * letter + 3.0F * ImGui::GetStyle().ItemSpacing.x;
    ImGui::SetNextItemWidth(std::max(ImGui::GetContentRegionAvail().x - others, 4.0F * letter));
    auto time = static_cast<float>(now.time_in_clip());
    const auto end = static_cast<float>(now.duration());
    const std::string format = fmt::format("%.2f of {:.2f} s", end);
    if (slide("##time", time, {0.0F, end, format.c_str()})) {
        state.change_playback([&](Playback& playback) {
            playback.set_playing(false);
            playback.set_time(static_cast<double>(time));
        });
    }
    ImGui::SameLine();
    choose_speed(state);
    if (clips_are_beside) ImGui::SameLine();
    if (has_clips) choose_clip(state);
    ImGui::End();
    ImGui::PopStyleVar();
    return height;
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
    if (input.loading != nullptr) {
        const std::filesystem::path& model = input.loading->model;
        const bool is_shown = input.state.has_scene() && input.state.options().model == model;
        draw_progress((is_shown ? "Updating " : "Reading ") + model.filename().string(),
                      input.progress);
        ImGui::SameLine();
        ImGui::Text("%.1f s", input.loading_seconds);
        ImGui::SameLine();
        if (ImGui::SmallButton("Cancel")) requests.cancel_loading = true;
        probe_item("Cancel");
    } else if (!input.progress.stage.empty()) {
        draw_progress("Preparing", input.progress);
    } else if (!error.empty()) {
        const bool is_light = ImGui::GetStyleColorVec4(ImGuiCol_WindowBg).x > 0.5F;
        draw_line({error},
                  is_light ? ImVec4(0.7F, 0.1F, 0.0F, 1.0F) : ImVec4(1.0F, 0.5F, 0.4F, 1.0F));
    } else {
        draw_line(status_parts(input), ImGui::GetStyleColorVec4(ImGuiCol_Text));
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

// The file dialog.

void FileDialog::open(const std::filesystem::path& folder) {
    is_open_ = true;
    listing_ = list_folder(folder);
}

std::optional<std::filesystem::path> FileDialog::draw(
    const std::vector<std::string>& recent_files) {
    if (!is_open_) return std::nullopt;
    constexpr const char* title = "Open a model, a scene or a map";
    if (!ImGui::IsPopupOpen(title)) ImGui::OpenPopup(title);
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({0.5F * screen.x, 0.5F * screen.y}, ImGuiCond_Always, {0.5F, 0.5F});
    ImGui::SetNextWindowSize({0.7F * screen.x, 0.8F * screen.y});
    std::optional<std::filesystem::path> selected;
    std::optional<std::filesystem::path> folder;
    if (!ImGui::BeginPopupModal(title, nullptr,
                                ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove))
        return std::nullopt;
    std::string path = listing_.folder.string();
    ImGui::SetNextItemWidth(-FLT_MIN);
    if (ImGui::InputText("##path", &path, ImGuiInputTextFlags_EnterReturnsTrue)) {
        std::error_code none;
        const std::filesystem::path typed = path_of(path);
        (std::filesystem::is_directory(typed, none) ? folder : selected) = typed;
    }
    probe_item("path");
    if (!listing_.error.empty()) ImGui::TextWrapped("%s", listing_.error.c_str());
    ImGui::BeginChild("files", {0.0F, -1.5F * ImGui::GetFrameHeightWithSpacing()}, true);
    for (const std::filesystem::path& inner : listing_.folders) {
        const std::string name = inner.filename().string() + "/";
        if (ImGui::Selectable(inner == listing_.folder.parent_path() ? "../" : name.c_str()))
            folder = inner;
        probe_item(name);
    }
    for (const std::filesystem::path& file : listing_.files) {
        const std::string name = file.filename().string();
        if (ImGui::Selectable(name.c_str())) selected = file;
        probe_item(name);
    }
    ImGui::EndChild();
    if (!recent_files.empty()) {
        if (ImGui::BeginCombo("##recent", "Recent files", ImGuiComboFlags_NoArrowButton)) {
            for (const std::string& file : recent_files) {
                if (ImGui::Selectable(file.c_str())) selected = file;
            }
            ImGui::EndCombo();
        }
        ImGui::SameLine();
    }
    const bool is_cancelled =
        ImGui::Button("Cancel##dialog") ||
        (!ImGui::IsAnyItemActive() && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape)));
    probe_item("Cancel the dialog");
    if (folder) listing_ = list_folder(*folder);
    if (selected || is_cancelled) {
        is_open_ = false;
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
    return selected;
}

}  // namespace relief::tools
