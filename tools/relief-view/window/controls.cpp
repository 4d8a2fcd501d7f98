// SPDX-License-Identifier: Apache-2.0
#include "window/controls.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <cmath>
#include <string>

namespace relief::tools {
namespace {

struct Places {
    bool is_wanted = false;
    nlohmann::ordered_json marked = nlohmann::ordered_json::object();
};

Places& places() {
    static Places all;
    return all;
}

}  // namespace

void enable_ui_probe() {
    places().is_wanted = true;
}

void clear_ui_probe() {
    places().marked = nlohmann::ordered_json::object();
}

void probe_item(const std::string& name) {
    if (!places().is_wanted || !ImGui::IsItemVisible()) return;
    const ImVec2 min = ImGui::GetItemRectMin();
    const ImVec2 max = ImGui::GetItemRectMax();
    places().marked[name] = {std::round(0.5F * (min.x + max.x)),
                             std::round(0.5F * (min.y + max.y))};
}

nlohmann::ordered_json ui_probe_json() {
    return places().marked;
}

bool choose_index(const char* label, int& index, std::initializer_list<const char*> names) {
    const bool is_open = ImGui::BeginCombo(label, names.begin()[index]);
    probe_item(label);
    if (!is_open) return false;
    const int before = index;
    for (int i = 0; i < static_cast<int>(names.size()); ++i) {
        if (ImGui::Selectable(names.begin()[i], i == before)) index = i;
        probe_item(std::string(label) + ": " + names.begin()[i]);
    }
    ImGui::EndCombo();
    return index != before;
}

bool slide(const char* label, float& value, const Slider& slider) {
    const ImGuiSliderFlags flags =
        ImGuiSliderFlags_AlwaysClamp |
        (slider.is_logarithmic ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None);
    const bool changed =
        ImGui::SliderFloat(label, &value, slider.min, slider.max, slider.format, flags);
    probe_item(label);
    return changed;
}

bool drag_up(const char* label, float& value, float step) {
    constexpr float max = 1e6F;
    const bool changed =
        ImGui::DragFloat(label, &value, step, 0.0F, max, "%.3g", ImGuiSliderFlags_AlwaysClamp);
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

FileChoice file_field(const char* label, const std::optional<std::string>& shown) {
    FileChoice choice;
    ImGui::PushID(label);
    std::string text = shown.value_or("");
    // Dear ImGui keeps the text while it is edited.
    if (ImGui::InputTextWithHint(
            "##path", "path of a file", &text,
            ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll)) {
        const std::filesystem::path file = path_of(text);
        if (file.empty()) {
            choice.is_cleared = shown.has_value();
        } else if (text != shown) {
            choice.file = file;
        }
    }
    probe_item(label);
    if (shown && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", shown->c_str());
    ImGui::SameLine(0.0F, ImGui::GetStyle().ItemInnerSpacing.x);
    if (shown) {
        if (ImGui::SmallButton("x")) choice.is_cleared = true;
        probe_item(std::string("clear ") + label);
        ImGui::SameLine(0.0F, ImGui::GetStyle().ItemInnerSpacing.x);
    }
    ImGui::TextUnformatted(label);
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

}  // namespace relief::tools
