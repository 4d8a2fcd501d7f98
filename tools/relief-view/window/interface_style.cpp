// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/panel_layout_test.cpp.
#include "window/interface_style.h"

#include <imgui.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <tuple>

namespace relief::tools {

namespace {

/// The characters of the font: Latin, Greek, Cyrillic and punctuation.
constexpr std::array<ImWchar, 9> font_glyphs{0x20,  0x17F,  0x370,  0x3FF, 0x400,
                                             0x4FF, 0x2010, 0x2044, 0};

/// Sizes and colors of the panels.
ImGuiStyle style_of(bool is_light) {
    ImGuiStyle style;
    style.WindowRounding = 0.0F;
    style.FrameRounding = 3.0F;
    style.GrabRounding = 3.0F;
    style.PopupRounding = 4.0F;
    style.ScrollbarRounding = 3.0F;
    style.ScrollbarSize = 12.0F;
    style.ItemSpacing = {8.0F, 5.0F};
    style.WindowBorderSize = 0.0F;
    is_light ? ImGui::StyleColorsLight(&style) : ImGui::StyleColorsDark(&style);
    const auto gray = [](float value) { return ImVec4(value, value, value * 1.02F, 1.0F); };
    const ImVec4 accent =
        is_light ? ImVec4(0.13F, 0.42F, 0.72F, 1.0F) : ImVec4(0.38F, 0.64F, 0.90F, 1.0F);
    // The dark and the light gray of each part.
    const std::array<std::tuple<ImGuiCol, float, float>, 19> grays{{
        {ImGuiCol_Text, 0.88F, 0.12F},
        {ImGuiCol_TextDisabled, 0.56F, 0.42F},
        {ImGuiCol_WindowBg, 0.13F, 0.94F},
        {ImGuiCol_PopupBg, 0.15F, 0.97F},
        {ImGuiCol_Border, 0.27F, 0.78F},
        {ImGuiCol_FrameBg, 0.19F, 0.98F},
        {ImGuiCol_FrameBgHovered, 0.24F, 0.91F},
        {ImGuiCol_FrameBgActive, 0.28F, 0.87F},
        {ImGuiCol_TitleBg, 0.15F, 0.88F},
        {ImGuiCol_TitleBgActive, 0.18F, 0.84F},
        {ImGuiCol_Button, 0.25F, 0.86F},
        {ImGuiCol_ButtonHovered, 0.31F, 0.80F},
        {ImGuiCol_ButtonActive, 0.36F, 0.74F},
        {ImGuiCol_Header, 0.19F, 0.88F},
        {ImGuiCol_HeaderHovered, 0.25F, 0.83F},
        {ImGuiCol_HeaderActive, 0.29F, 0.78F},
        {ImGuiCol_Tab, 0.19F, 0.88F},
        {ImGuiCol_TabActive, 0.29F, 0.97F},
        {ImGuiCol_ScrollbarBg, 0.13F, 0.94F},
    }};
    for (const auto& [part, dark, light] : grays)
        style.Colors[part] = gray(is_light ? light : dark);
    for (const ImGuiCol part : {ImGuiCol_CheckMark, ImGuiCol_PlotHistogram, ImGuiCol_TabHovered})
        style.Colors[part] = accent;
    // The number of a slider is beside it, so the handle may be opaque.
    style.Colors[ImGuiCol_SliderGrab] = ImVec4(accent.x, accent.y, accent.z, 0.7F);
    style.Colors[ImGuiCol_SliderGrabActive] = accent;
    return style;
}

}  // namespace

void apply_interface_style(const UiScale& scale, bool is_light) {
    ImGuiIO& io = ImGui::GetIO();
    io.Fonts->Clear();
    if (const std::optional<std::filesystem::path> file = interface_font()) {
        io.Fonts->AddFontFromFileTTF(file->c_str(), std::round(14.0F * scale.glyphs), nullptr,
                                     font_glyphs.data());
    } else {
        ImFontConfig font;
        font.SizePixels = std::round(13.0F * scale.glyphs);
        io.Fonts->AddFontDefault(&font);
    }
    io.FontGlobalScale = scale.layout / scale.glyphs;
    ImGui::GetStyle() = style_of(is_light);
    ImGui::GetStyle().ScaleAllSizes(scale.layout);
}

}  // namespace relief::tools
