// SPDX-License-Identifier: Apache-2.0
// The list of shortcuts, and the progress in a view without a picture.
// Tests: tests/tools/window/user_interface_test.cpp, panel_layout_test.cpp.
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cfloat>

#include "window/controls.h"
#include "window/panels.h"

namespace relief::tools {

namespace {

/// A line of the list.
struct Line {
    std::string_view input;
    std::string_view description;
};

struct Group {
    std::string_view name;
    std::vector<Line> lines;
};

/// The groups with the lines that a search keeps; empty groups are left out.
std::vector<Group> groups_with(const std::string& search) {
    std::vector<Group> groups;
    for (const std::string_view name : shortcut_groups()) {
        Group group{name, {}};
        const auto add = [&](std::string_view input, std::string_view description) {
            if (matches_search(search, {name, input, description}))
                group.lines.push_back({input, description});
        };
        for (const Shortcut& shortcut : shortcuts()) {
            if (shortcut_group(shortcut.action) == name) add(shortcut.key, shortcut.description);
        }
        if (name == gesture_group) {
            for (const Gesture& gesture : gestures())
                add(gesture.input, gesture.description);
        }
        if (!group.lines.empty()) groups.push_back(std::move(group));
    }
    return groups;
}

void draw_group(const Group& group, float key_width) {
    ImGui::TextDisabled("%s", std::string(group.name).c_str());
    probe_item(fmt::format("group {}", group.name));
    for (const Line& line : group.lines) {
        const float begin = ImGui::GetCursorPosX();
        ImGui::PushTextWrapPos(begin + key_width);
        ImGui::TextUnformatted(line.input.data(), line.input.data() + line.input.size());
        ImGui::PopTextWrapPos();
        ImGui::SameLine();
        ImGui::SetCursorPosX(begin + key_width + ImGui::GetStyle().ItemSpacing.x);
        ImGui::PushTextWrapPos(0.0F);
        ImGui::TextUnformatted(line.description.data(),
                               line.description.data() + line.description.size());
        ImGui::PopTextWrapPos();
        probe_item(fmt::format("shortcut {}", line.input));
    }
    ImGui::Spacing();
}

/// Draws the groups in columns of about the same length.
void draw_groups(const std::vector<Group>& groups, int columns, float key_width) {
    std::size_t total = 0;
    for (const Group& group : groups)
        total += group.lines.size() + 2;
    if (!ImGui::BeginTable("groups", columns)) return;
    ImGui::TableNextRow();
    std::size_t before = 0;
    int column = -1;
    for (const Group& group : groups) {
        const auto wanted = static_cast<int>(static_cast<std::size_t>(columns) * before /
                                             std::max<std::size_t>(total, 1));
        if (wanted > column) {
            ImGui::TableNextColumn();
            ++column;
        }
        draw_group(group, key_width);
        before += group.lines.size() + 2;
    }
    ImGui::EndTable();
}

}  // namespace

void HelpWindow::draw() {
    if (!is_open_) return;
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const float letter = ImGui::GetFontSize();
    constexpr float column_width = 34.0F;  // In line heights.
    const float width = std::min(0.96F * screen.x, 2.0F * column_width * letter);
    const int columns = width >= 1.6F * column_width * letter ? 2 : 1;
    ImGui::SetNextWindowPos({0.5F * screen.x, 0.5F * screen.y}, ImGuiCond_Always, {0.5F, 0.5F});
    ImGui::SetNextWindowSize({width, std::min(0.94F * screen.y, 46.0F * letter)});
    ImGui::Begin("Shortcuts", &is_open_,
                 ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove);
    if (wants_focus_) ImGui::SetKeyboardFocusHere();
    wants_focus_ = false;
    ImGui::SetNextItemWidth(-FLT_MIN);
    ImGui::InputTextWithHint("##search", "Search (Ctrl+F)", &search_);
    probe_item("search");
    ImGui::BeginChild("list");
    const std::vector<Group> groups = groups_with(search_);
    if (groups.empty()) ImGui::TextDisabled("No shortcut has these words.");
    const float list = ImGui::GetContentRegionAvail().x / static_cast<float>(columns);
    draw_groups(groups, columns, std::min(11.0F * letter, 0.42F * list));
    ImGui::EndChild();
    ImGui::End();
}

void draw_waiting(const PanelInput& input, const glm::vec2& min, const glm::vec2& max,
                  PanelRequests& requests) {
    const bool is_reading = input.loading != nullptr;
    if (!is_reading && !input.is_drawing) return;
    const float letter = ImGui::GetFontSize();
    const float width = std::min(26.0F * letter, max.x - min.x);
    const glm::vec2 middle = 0.5F * (min + max);
    ImGui::SetNextWindowPos({middle.x, middle.y}, ImGuiCond_Always, {0.5F, 0.5F});
    ImGui::SetNextWindowSize({width, 0.0F});
    ImGui::Begin("Waiting", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoFocusOnAppearing);
    const std::string name =
        is_reading ? input.loading->model.filename().string() : std::string("the first picture");
    ImGui::TextWrapped("%s %s", is_reading ? "Reading" : "Drawing", name.c_str());
    ImGui::ProgressBar(
        static_cast<float>(input.progress.part.value_or(0.0)), {-FLT_MIN, 0.0F},
        input.progress.part ? fmt::format("{:.0f} %", 100.0 * *input.progress.part).c_str() : "");
    ImGui::TextDisabled("%s", stage_title(input.progress.stage).c_str());
    probe_item("waiting");
    if (ImGui::Button("Cancel##waiting")) requests.cancel_loading = true;
    probe_item("Cancel waiting");
    ImGui::SameLine();
    ImGui::TextDisabled("Esc");
    ImGui::End();
}

}  // namespace relief::tools
