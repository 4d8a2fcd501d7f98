// SPDX-License-Identifier: Apache-2.0
// Every effect, on or off and why, with a switch that forces it.
// Tests: tests/tools/window/window_test.cpp.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "common/text.h"
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

void draw_reasons(const PanelInput& input, const std::vector<EffectReason>& reasons) {
    for (const EffectReason& reason : reasons) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        draw_switch(input.state, reason.effect);
        // Before the names, the longest of which reach beyond the panel.
        ImGui::TableNextColumn();
        if (const std::optional<double> price = input.prices.price(reason.effect))
            ImGui::Text("%.2f ms", *price);
        ImGui::TableNextColumn();
        const ImVec4 color =
            ImGui::GetStyleColorVec4(reason.on ? ImGuiCol_Text : ImGuiCol_TextDisabled);
        ImGui::TextColored(color, "%s", reason.effect.c_str());
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", reason.reason.c_str());
    }
}

/// What they cost, how it was measured, and a button that does it.
void draw_prices(const PanelInput& input, PanelWishes& wishes) {
    const EffectPrices::State prices = input.prices.state();
    if (prices.is_going_on) {
        const std::size_t done = prices.costs.effects.size();
        const std::string text = fmt::format("effect {} of {}", done + 1, prices.count);
        ImGui::ProgressBar(
            prices.count == 0 ? 0.0F : static_cast<float>(done) / static_cast<float>(prices.count),
            {0.5F * ImGui::GetContentRegionAvail().x, 0.0F}, text.c_str());
        ImGui::SameLine();
        if (ImGui::Button("Stop")) wishes.stop_measuring = true;
        mark_place("Stop");
        return;
    }
    if (ImGui::Button("Measure what they cost")) wishes.measure_effects = true;
    mark_place("Measure what they cost");
    if (!prices.error.empty()) return ImGui::TextWrapped("%s", prices.error.c_str());
    if (prices.costs.effects.empty())
        return ImGui::TextWrapped("Each by itself: a frame with it less one without it.");
    const Spread& frame = prices.costs.frame;
    ImGui::TextWrapped("A frame: %.2f ms (%.2f to %.2f), %d x %d pixels, %s", frame.median,
                       frame.p10, frame.p90, prices.width, prices.height,
                       counted(static_cast<std::size_t>(prices.samples), "sample").c_str());
}

}  // namespace

void draw_effects_panel(const PanelInput& input, PanelWishes& wishes) {
    if (!input.drawn.plan) return;
    const FramePlan& plan = *input.drawn.plan;
    // Debug views have no effects of their own.
    if (input.state.debug().view == DebugView::picture) draw_prices(input, wishes);
    const bool is_open = ImGui::TreeNode("Shaders");
    mark_place("Shaders");
    if (is_open) {
        input.shaders.draw(input.drawn.plan);
        ImGui::TreePop();
    }
    if (ImGui::BeginTable("effects", 3, ImGuiTableFlags_SizingFixedFit)) {
        draw_reasons(input, plan.reasons);
        if (!plan.draws.empty()) draw_reasons(input, plan.draws.front().reasons);
        ImGui::EndTable();
    }
}

}  // namespace relief::tools
