// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/compare_window_test.cpp.
#include "window/compare_view.h"

#include <imgui.h>

#include <cmath>

namespace relief::tools {
namespace {

constexpr ImU32 line_color = IM_COL32(255, 255, 255, 255);
constexpr ImU32 label_color = IM_COL32(255, 255, 255, 255);
constexpr ImU32 label_back = IM_COL32(20, 22, 26, 200);
constexpr float label_margin = 8.0F;
constexpr float label_padding = 4.0F;

ImVec2 vec(const glm::vec2& v) {
    return {v.x, v.y};
}

/// The columns of a picture from one share of the view's width to another.
void draw_part(unsigned texture, const ViewPlace& place, float from, float to) {
    if (!(from < to)) return;
    const float width = place.max.x - place.min.x;
    // Row 0 of the texture is at the bottom.
    ImGui::GetBackgroundDrawList()->AddImage(
        reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture)),
        {place.min.x + from * width, place.min.y}, {place.min.x + to * width, place.max.y},
        {from, 1.0F}, {to, 0.0F});
}

/// \param align  0: its left end is there; 1: its right end
void draw_label(const std::string& text, const glm::vec2& place, float align) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    const glm::vec2 min(std::round(place.x - align * size.x), place.y);
    const glm::vec2 max = min + glm::vec2(size.x, size.y);
    list.AddRectFilled(vec(min - label_padding), vec(max + label_padding), label_back);
    list.AddText(vec(min), label_color, text.c_str());
}

}  // namespace

void draw_picture(const Handover::Shown& picture, const ViewPlace& place) {
    draw_part(picture.texture, place, 0.0F, 1.0F);
}

float draw_sides(const Handover::Shown& picture, const ViewPlace& place,
                 const Comparison& comparison) {
    const float width = place.max.x - place.min.x;
    // On a whole pixel, where both textures are hit in their texels' middles.
    const float x = std::round(place.min.x + comparison.split() * width);
    const float split = (x - place.min.x) / width;
    const bool swapped = comparison.is_swapped();
    draw_part(swapped ? picture.beside : picture.texture, place, 0.0F, split);
    draw_part(swapped ? picture.texture : picture.beside, place, split, 1.0F);
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    list.AddRectFilled({x - 1.0F, place.min.y}, {x + 1.0F, place.max.y}, line_color);
    draw_label(comparison.left_label(), {x - 2.0F * label_margin, place.min.y + label_margin},
               1.0F);
    draw_label(comparison.right_label(), {x + 2.0F * label_margin, place.min.y + label_margin},
               0.0F);
    return x;
}

void draw_difference(const Handover::Shown& picture, const ViewPlace& place,
                     const Comparison& comparison) {
    draw_picture(picture, place);
    const std::string kind = comparison.shown() == SidesShown::flip
                                 ? "difference to the eye (FLIP)"
                                 : "largest difference of a channel";
    draw_label(kind + ": " + comparison.left_label() + " | " + comparison.right_label(),
               place.min + label_margin + label_padding, 0.0F);
}

}  // namespace relief::tools
