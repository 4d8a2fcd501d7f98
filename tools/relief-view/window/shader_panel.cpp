// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/shader_panel_test.cpp.
#include "window/shader_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <sstream>
#include <utility>

#include "window/places.h"

namespace relief::tools {

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
    } catch (const std::exception& error) {  // A file of RELIEF_SHADER_DIR that is being edited.
        error_ = error.what();
    }
}

void ShaderPanel::draw_stage(const char* name, const std::string& source, std::string& numbered) {
    if (!ImGui::BeginTabItem(name)) return mark_place(name);
    mark_place(name);
    // Read only: the text is not written to.
    ImGui::InputTextMultiline("##source", numbered.data(), numbered.size() + 1,
                              {-1.0F, 24.0F * ImGui::GetTextLineHeight()},
                              ImGuiInputTextFlags_ReadOnly);
    if (ImGui::Button("Copy without numbers")) ImGui::SetClipboardText(source.c_str());
    mark_place("Copy without numbers");
    ImGui::EndTabItem();
}

void ShaderPanel::draw(const std::shared_ptr<const FramePlan>& plan) {
    if (plan_ != plan) assemble(*plan);
    plan_ = plan;
    if (!error_.empty()) ImGui::TextWrapped("%s", error_.c_str());
    for (std::size_t i = 0; i < programs_.size(); ++i) {
        Program& program = programs_[i];
        const bool is_open = ImGui::TreeNode(fmt::format("{}##{}", program.name, i).c_str());
        mark_place(fmt::format("Program {}", i + 1));
        if (!is_open) continue;
        if (ImGui::BeginTabBar("stages")) {
            draw_stage("Fragment shader", program.listing.fragment, program.fragment);
            draw_stage("Vertex shader", program.listing.vertex, program.vertex);
            ImGui::EndTabBar();
        }
        ImGui::TreePop();
    }
}

}  // namespace relief::tools
