// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/panels_test.cpp.
#include "window/file_field.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include "window/places.h"

namespace relief::tools {
namespace {

/// As it comes from a terminal or a file manager: quotes and file:// are not part of the path.
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
    // While it is edited, Dear ImGui keeps what was typed itself.
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
    mark_place(label);
    if (shown && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", shown->c_str());
    ImGui::SameLine(0.0F, ImGui::GetStyle().ItemInnerSpacing.x);
    if (shown) {
        if (ImGui::SmallButton("x")) choice.is_cleared = true;
        mark_place(std::string("clear ") + label);
        ImGui::SameLine(0.0F, ImGui::GetStyle().ItemInnerSpacing.x);
    }
    ImGui::TextUnformatted(label);
    ImGui::PopID();
    return choice;
}

}  // namespace relief::tools
