// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/window_test.cpp.
#include "window/panels.h"

#include <fmt/format.h>
#include <imgui.h>

#include <array>

#include "common/text.h"
#include "window/places.h"
#include "window/progress_line.h"

namespace relief::tools {
namespace {

constexpr float column_width = 23.0F;  // In heights of a line.

std::size_t triangles_of(const Scene& scene) {
    std::size_t count = 0;
    for (const Instance& instance : scene.instances)
        count += scene.meshes[instance.mesh]->triangles.size();
    return count;
}

std::string status_text(const PanelInput& input) {
    if (!input.state.has_scene()) return "";
    const std::string saved = input.captured.empty() ? "" : "   " + input.captured;
    return fmt::format("{}   {} x {} pixels   {:.1f} ms a picture   picture {}, {}   {}{}",
                       counted(triangles_of(input.state.scene()), "triangle"),
                       input.drawn.settings.width, input.drawn.settings.height,
                       input.drawn.times.draw, input.drawn.frames,
                       input.is_drawing ? "drawing" : "idle", input.renderer, saved);
}

struct Panel {
    const char* name;
    bool is_open_at_first;
    void (*draw)(const PanelInput&, PanelWishes&);
};

/// A panel that asks nothing of the window.
template <void (*draw)(const PanelInput&)>
void plain(const PanelInput& input, PanelWishes&) {
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

/// A panel's header, which opens and closes it; that is remembered. \return whether it is open
bool begins(const Panel& panel, WindowLayout& layout) {
    const auto remembered = layout.open_panels.find(panel.name);
    const bool was_open =
        remembered == layout.open_panels.end() ? panel.is_open_at_first : remembered->second;
    ImGui::SetNextItemOpen(was_open);
    const bool is_open = ImGui::CollapsingHeader(panel.name);
    mark_place(panel.name);
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

float draw_panels(const PanelInput& input, PanelWishes& wishes) {
    const ImGuiIO& io = ImGui::GetIO();
    const float width = column_width * ImGui::GetFontSize();
    const float status_height = ImGui::GetFrameHeightWithSpacing();
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize({width, io.DisplaySize.y - status_height});
    ImGui::Begin("Panels", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove);
    ImGui::PushItemWidth(0.5F * width);
    for (const Panel& panel : all_panels) {
        if (begins(panel, input.layout)) panel.draw(input, wishes);
    }
    ImGui::PopItemWidth();
    ImGui::End();
    return width;
}

void draw_status(const PanelInput& input, PanelWishes& wishes) {
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
        if (ImGui::SmallButton("Cancel")) wishes.cancel_loading = true;
        mark_place("Cancel");
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
    ImGui::Begin("Keys and hands", &is_open,
                 ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_AlwaysAutoResize);
    const auto row = [](std::string_view how, std::string_view what) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(how.data(), how.data() + how.size());
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(what.data(), what.data() + what.size());
    };
    if (ImGui::BeginTable("bindings", 2, ImGuiTableFlags_SizingFixedFit)) {
        for (const Gesture& gesture : gestures())
            row(gesture.hand, gesture.what);
        for (const Binding& binding : bindings())
            row(binding.key, binding.what);
        ImGui::EndTable();
    }
    ImGui::End();
}

}  // namespace relief::tools
