// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/reload_window_test.cpp.
#include "window/progress_line.h"

#include <fmt/format.h>
#include <imgui.h>

namespace relief::tools {

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
