// SPDX-License-Identifier: Apache-2.0
// Every effect, on or off and why, with a switch that forces it.
// Tests: tests/tools/window/window_test.cpp.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <vector>

#include "relief/shade/shader_listing.h"
#include "window/panels.h"
#include "window/places.h"

namespace relief::tools {
namespace {

/// What is forced about an effect: 0 nothing, 1 on, 2 off.
int forced(const EffectWishes& wishes, const std::string& name) {
    for (const ForcedEffect& effect : wishes.forced) {
        if (effect.name == name) return effect.on ? 1 : 2;
    }
    return 0;
}

void draw_switch(ViewerState& state, const std::string& name) {
    int choice = forced(state.effects(), name);
    ImGui::PushID(name.c_str());
    ImGui::SetNextItemWidth(4.5F * ImGui::GetFontSize());
    if (ImGui::Combo("##forced", &choice, "auto\0on\0off\0")) {
        EffectWishes wishes = state.effects();
        std::erase_if(wishes.forced,
                      [&](const ForcedEffect& effect) { return effect.name == name; });
        if (choice != 0) wishes.forced.push_back({name, choice == 1});
        state.set_effects(std::move(wishes));
    }
    mark_place("force " + name);
    ImGui::PopID();
}

void draw_reasons(ViewerState& state, const std::vector<EffectReason>& reasons) {
    for (const EffectReason& reason : reasons) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        draw_switch(state, reason.effect);
        ImGui::TableNextColumn();
        const ImVec4 color =
            ImGui::GetStyleColorVec4(reason.on ? ImGuiCol_Text : ImGuiCol_TextDisabled);
        ImGui::TextColored(color, "%s", reason.effect.c_str());
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", reason.reason.c_str());
    }
}

void draw_shaders(const FramePlan& plan) {
    std::vector<ShaderListing> listings;
    try {
        listings = shader_listings(plan);
    } catch (const std::exception& error) {  // A file of RELIEF_SHADER_DIR that is being edited.
        return ImGui::TextWrapped("%s", error.what());
    }
    for (std::size_t i = 0; i < listings.size(); ++i) {
        const std::string name = "shader: " + describe(listings[i].features);
        if (!ImGui::TreeNode(fmt::format("{}##{}", name, i).c_str())) continue;
        std::string text = listings[i].fragment;
        ImGui::InputTextMultiline("##fragment", text.data(), text.size() + 1, {-1.0F, 300.0F},
                                  ImGuiInputTextFlags_ReadOnly);
        ImGui::TreePop();
    }
}

}  // namespace

void draw_effects_panel(const PanelInput& input) {
    if (!input.drawn.plan) return;
    const FramePlan& plan = *input.drawn.plan;
    if (ImGui::BeginTable("effects", 2, ImGuiTableFlags_SizingFixedFit)) {
        draw_reasons(input.state, plan.reasons);
        if (!plan.draws.empty()) draw_reasons(input.state, plan.draws.front().reasons);
        ImGui::EndTable();
    }
    if (ImGui::TreeNode("Shaders")) {
        draw_shaders(plan);
        ImGui::TreePop();
    }
}

}  // namespace relief::tools
