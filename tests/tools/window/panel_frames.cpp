// SPDX-License-Identifier: Apache-2.0
#include "tools/window/panel_frames.h"

#include <gtest/gtest.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <utility>

#include "window/interface_style.h"

namespace relief::test {
using namespace relief::tools;

namespace {

void do_nothing() {}

}  // namespace

PanelFrames::PanelFrames()
    : comparison_(CompareChoices{}, do_nothing), accuracy_(do_nothing), previews_(do_nothing) {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DeltaTime = 1.0F / 60.0F;
    for (int i = 0; i < ImGuiKey_COUNT; ++i)
        io.KeyMap[i] = i;
    enable_ui_probe();
    set_size({1280, 800});
}

PanelFrames::~PanelFrames() {
    ImGui::DestroyContext();
}

void PanelFrames::show(const Workplace& workplace, const std::string& model) {
    Loaded loaded;
    loaded.options.model = workplace / model;
    Stages silent(true);
    loaded.composed = compose_scene(loaded.options, silent, loaded.findings);
    state_.take(std::move(loaded));
}

void PanelFrames::show(shade::Scene scene) {
    Loaded loaded;
    loaded.options.model = "scene " + std::to_string(++shown_);
    loaded.composed.emplace();
    loaded.composed->graph.scene = std::move(scene);
    state_.take(std::move(loaded));
}

void PanelFrames::set_size(const glm::ivec2& size, float scale) {
    ImGui::GetIO().DisplaySize = {static_cast<float>(size.x), static_cast<float>(size.y)};
    apply_interface_style({scale, scale}, false);
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    ImGui::GetIO().Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
}

PanelRequests PanelFrames::draw() {
    PanelRequests requests = draw_once();
    for (int i = 0; i < 3; ++i)
        draw_once();
    return requests;
}

void PanelFrames::open_tree(const std::string& name) {
    ImGuiWindow* const panels = ImGui::FindWindowByName("Panels");
    const float step = 0.4F * panels->InnerRect.GetHeight();
    for (float y = 0.0F; y < panels->ScrollMax.y + step; y += step) {
        panels->Scroll.y = std::min(y, panels->ScrollMax.y);
        draw();
        if (!has(name)) continue;
        click(name);
        return;
    }
    ADD_FAILURE() << name << " is not there";
}

PanelRequests PanelFrames::draw_once() {
    ImGui::NewFrame();
    clear_ui_probe();
    PanelRequests requests;
    PanelInput input{.state = state_,
                     .layout = layout_,
                     .drawn = drawn_,
                     .renderer = "llvmpipe (test)",
                     .loading = loading,
                     .progress = progress,
                     .is_drawing = is_drawing,
                     .capture = &capture_,
                     .captured = {},
                     .layout_note = {},
                     .effect_times = effect_times_,
                     .shaders = shaders_,
                     .comparison = &comparison_,
                     .accuracy = &accuracy_,
                     .previews = &previews_};
    space_ = draw_panels(input, are_open, requests);
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    state_.set_view({size.x - space_.left, size.y - space_.bottom});
    draw_status(input, requests);
    help_.draw();
    dialog_.draw(layout_.recent_files, &previews_, {});
    draw_waiting(input, {space_.left, 0.0F}, {size.x, size.y}, requests);
    ImGui::Render();
    return requests;
}

glm::vec2 PanelFrames::place(const std::string& name) const {
    const auto places = ui_probe_json();
    if (!places.contains(name)) {
        ADD_FAILURE() << name << " is not visible\n" << places.dump();
        return glm::vec2(0.0F);
    }
    return {places[name][0].get<float>(), places[name][1].get<float>()};
}

bool PanelFrames::has(const std::string& name) const {
    return ui_probe_json().contains(name);
}

float PanelFrames::excess_width() const {
    const ImGuiWindow* const panels = ImGui::FindWindowByName("Panels");
    return panels == nullptr ? 0.0F : panels->ContentSize.x - panels->ContentRegionRect.GetWidth();
}

PanelRequests PanelFrames::click(const glm::vec2& place) {
    ImGuiIO& io = ImGui::GetIO();
    io.MousePos = {place.x, place.y};
    draw_once();
    io.MouseDown[0] = true;
    draw_once();
    io.MouseDown[0] = false;
    PanelRequests requests = draw_once();
    draw_once();
    return requests;
}

void PanelFrames::type(const std::string& characters) {
    ImGui::GetIO().AddInputCharactersUTF8(characters.c_str());
    draw_once();
}

void PanelFrames::press(int key) {
    ImGui::GetIO().KeysDown[key] = true;
    draw_once();
    ImGui::GetIO().KeysDown[key] = false;
    draw_once();
}

}  // namespace relief::test
