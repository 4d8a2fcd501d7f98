// SPDX-License-Identifier: Apache-2.0
// The effects panel: the reasons for each effect, measured times, and the shaders.
#include "window/effects_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <utility>

#include "common/text.h"
#include "window/controls.h"
#include "window/panels.h"
#include "window/shader_panel.h"

namespace relief::tools {
using namespace relief::shade;

int forced_choice(const EffectRequest& requests, const std::string& name) {
    for (const ForcedEffect& effect : requests.forced) {
        if (effect.name == name) return effect.on ? 1 : 2;
    }
    return 0;
}

EffectRequest with_forced_choice(EffectRequest requests, const std::string& name, int choice) {
    std::erase_if(requests.forced, [&](const ForcedEffect& effect) { return effect.name == name; });
    if (choice != 0) requests.forced.push_back({name, choice == 1});
    return requests;
}

namespace {

void draw_switch(ViewerState& state, const std::string& name) {
    int choice = forced_choice(state.effects(), name);
    ImGui::PushID(name.c_str());
    ImGui::SetNextItemWidth(4.5F * ImGui::GetFontSize());
    if (ImGui::Combo("##forced", &choice, "auto\0on\0off\0"))
        state.set_effects(with_forced_choice(state.effects(), name, choice));
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
        input.shaders.draw(input);
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

}  // namespace relief::tools
