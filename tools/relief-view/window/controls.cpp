// SPDX-License-Identifier: Apache-2.0
#include "window/controls.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>  // For the end of the rendered part of a label.
#include <imgui_stdlib.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstdint>
#include <glm/trigonometric.hpp>
#include <utility>

namespace relief::tools {

namespace {

/// The positions of the controls of this frame, by name.
struct UiProbe {
    bool is_enabled = false;
    nlohmann::ordered_json positions = nlohmann::ordered_json::object();
};

UiProbe& ui_probe() {
    static UiProbe probe;
    return probe;
}

}  // namespace

void enable_ui_probe() {
    ui_probe().is_enabled = true;
}

void clear_ui_probe() {
    ui_probe().positions = nlohmann::ordered_json::object();
}

void probe_item(const std::string& name) {
    if (!ui_probe().is_enabled || !ImGui::IsItemVisible()) return;
    const ImVec2 min = ImGui::GetItemRectMin();
    const ImVec2 max = ImGui::GetItemRectMax();
    ui_probe().positions[name] = {std::round(0.5F * (min.x + max.x)),
                                  std::round(0.5F * (min.y + max.y))};
}

nlohmann::ordered_json ui_probe_json() {
    return ui_probe().positions;
}

namespace {

// In line heights. The labels have space for the longest one, "Metallic-roughness map".
constexpr float label_width = 12.5F;

}  // namespace

std::string begin_row(const char* label) {
    const std::string text(label, ImGui::FindRenderedTextEnd(label));
    if (text.empty()) return label;
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(text.c_str());
    ImGui::SameLine(label_width * ImGui::GetFontSize());
    ImGui::SetNextItemWidth(-FLT_MIN);
    return std::string("##") + label;
}

bool check(const char* label, bool& value) {
    const bool changed = ImGui::Checkbox(begin_row(label).c_str(), &value);
    probe_item(label);
    return changed;
}

bool pick_color(const char* label, glm::vec3& color, bool has_limit) {
    const ImGuiColorEditFlags flags =
        ImGuiColorEditFlags_Float |
        (has_limit ? ImGuiColorEditFlags_None : ImGuiColorEditFlags_HDR);
    const bool changed = ImGui::ColorEdit3(begin_row(label).c_str(), &color.x, flags);
    probe_item(label);
    return changed;
}

bool choose_index(const char* label, std::size_t& index, std::span<const std::string> names) {
    const bool is_open = ImGui::BeginCombo(begin_row(label).c_str(), names[index].c_str());
    probe_item(label);
    if (!is_open) return false;
    const std::size_t before = index;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (ImGui::Selectable(names[i].c_str(), i == before)) index = i;
        probe_item(std::string(label) + ": " + names[i]);
    }
    ImGui::EndCombo();
    return index != before;
}

bool slide(const char* label, float& value, const Slider& slider) {
    const ImGuiSliderFlags flags =
        ImGuiSliderFlags_AlwaysClamp |
        (slider.is_logarithmic ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None);
    const std::string id = begin_row(label);
    bool changed =
        ImGui::SliderFloat(id.c_str(), &value, slider.min, slider.max, slider.format, flags);
    probe_item(label);
    if (slider.default_value && value != *slider.default_value && ImGui::IsItemHovered()) {
        ImGui::SetTooltip("Right click: %s",
                          fmt::format("reset to {:g}", *slider.default_value).c_str());
        if (ImGui::IsMouseClicked(ImGuiMouseButton_Right)) {
            value = *slider.default_value;
            changed = true;
        }
    }
    return changed;
}

bool slide_angle(const char* label, float& radians, const Slider& degrees) {
    float value = glm::degrees(radians);
    const bool changed = slide(label, value, degrees);
    if (changed) radians = glm::radians(value);
    return changed;
}

bool drag_up(const char* label, float& value, float step) {
    constexpr float max = 1e6F;
    const bool changed = ImGui::DragFloat(begin_row(label).c_str(), &value, step, 0.0F, max, "%.3g",
                                          ImGuiSliderFlags_AlwaysClamp);
    probe_item(label);
    return changed;
}

namespace {

const char* format_of(FieldUnit unit, float max) {
    switch (unit) {
        case FieldUnit::radians:
            return "%.0f deg";
        case FieldUnit::texels:
            return "%.1f texels";
        case FieldUnit::nanometers:
            return "%.0f nm";
        default:
            return max < 100.0F ? "%.3f" : "%.0f";
    }
}

}  // namespace

bool edit_number(const char* label, float& value, FieldRange range, FieldUnit unit,
                 float default_value) {
    constexpr float widest = 1e4F;
    if (range.max > widest) return drag_up(label, value);
    Slider slider{.min = range.min,
                  .max = range.max,
                  .format = format_of(unit, range.max),
                  // Exponents, whose ratios count.
                  .is_logarithmic = unit == FieldUnit::none && range.max >= 1000.0F,
                  .default_value = default_value};
    if (unit != FieldUnit::radians) return slide(label, value, slider);
    slider.min = glm::degrees(range.min);
    slider.max = glm::degrees(range.max);
    slider.default_value = glm::degrees(default_value);
    return slide_angle(label, value, slider);
}

bool edit_optional(const char* label, std::optional<float>& value) {
    float number = value.value_or(0.0F);
    const bool changed = drag_up(label, number);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("0: none");
    if (changed) value = number > 0.0F ? std::optional(number) : std::nullopt;
    return changed;
}

std::filesystem::path pasted_path(std::string text) {
    const auto is_around = [](char c) { return c == ' ' || c == '\'' || c == '"' || c == '\n'; };
    while (!text.empty() && is_around(text.back()))
        text.pop_back();
    while (!text.empty() && is_around(text.front()))
        text.erase(text.begin());
    const std::string scheme = "file://";
    return text.starts_with(scheme) ? text.substr(scheme.size()) : text;
}

namespace {

/// Draws a thumbnail as high as a text field; a tooltip shows it larger.
void draw(const Thumbnail& thumbnail) {
    const auto id = reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(thumbnail.texture));
    const ImVec2 min(thumbnail.min.x, thumbnail.min.y);
    const ImVec2 max(thumbnail.max.x, thumbnail.max.y);
    const float height = ImGui::GetFrameHeight();
    const glm::vec2 size =
        glm::vec2(thumbnail.size) *
        (height / static_cast<float>(std::max(thumbnail.size.x, thumbnail.size.y)));
    ImGui::Image(id, {size.x, size.y}, min, max);
    if (!ImGui::IsItemHovered()) return;
    ImGui::BeginTooltip();
    const glm::vec2 large = 6.0F * size;
    ImGui::Image(id, {large.x, large.y}, min, max);
    ImGui::Text("%d x %d", thumbnail.image_size.x, thumbnail.image_size.y);
    ImGui::EndTooltip();
}

/// A text field. While nobody types, it shows the end of a text that is too long, since paths end
/// with the name of the file.
bool edit_path(std::string& text) {
    ImGuiStorage* const storage = ImGui::GetStateStorage();
    const ImGuiID id = ImGui::GetID("##path");
    const float width = ImGui::CalcItemWidth() - 2.0F * ImGui::GetStyle().FramePadding.x;
    const auto width_of = [](const std::string& part) {
        return ImGui::CalcTextSize(part.c_str()).x;
    };
    const std::string end = fitting_end(text, width, width_of);
    const bool is_replaced = end != text && !storage->GetBool(id);
    const ImU32 color = ImGui::GetColorU32(ImGuiCol_Text);
    if (is_replaced) ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(0.0F, 0.0F, 0.0F, 0.0F));
    const bool is_entered = ImGui::InputTextWithHint(
        "##path", "path of a file", &text,
        ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    if (is_replaced) ImGui::PopStyleColor();
    storage->SetBool(id, ImGui::IsItemActive());
    if (is_replaced && !ImGui::IsItemActive()) {
        const ImVec2 corner = ImGui::GetItemRectMin();
        const ImVec2& padding = ImGui::GetStyle().FramePadding;
        ImGui::GetWindowDrawList()->AddText({corner.x + padding.x, corner.y + padding.y}, color,
                                            end.c_str());
    }
    return is_entered;
}

}  // namespace

FileChoice file_field(const char* label, const std::optional<std::string>& shown,
                      const std::optional<Thumbnail>& thumbnail) {
    FileChoice choice;
    begin_row(label);
    ImGui::PushID(label);
    if (thumbnail) {
        draw(*thumbnail);
        probe_item(std::string("thumbnail of ") + label);
        ImGui::SameLine(0.0F, ImGui::GetStyle().ItemInnerSpacing.x);
        ImGui::SetNextItemWidth(-1.0F);
    }
    const float button = ImGui::GetFrameHeight();
    if (shown) ImGui::SetNextItemWidth(-button - ImGui::GetStyle().ItemInnerSpacing.x);
    std::string text = shown.value_or("");
    // Dear ImGui keeps the text while it is edited.
    if (edit_path(text)) {
        const std::filesystem::path file = pasted_path(text);
        if (file.empty()) {
            choice.is_cleared = shown.has_value();
        } else if (text != shown) {
            choice.file = file;
        }
    }
    probe_item(label);
    if (shown && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", shown->c_str());
    if (shown) {
        ImGui::SameLine(0.0F, ImGui::GetStyle().ItemInnerSpacing.x);
        if (ImGui::Button("x", {button, 0.0F})) choice.is_cleared = true;
        probe_item(std::string("clear ") + label);
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("Remove");
    }
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

std::string fitting_end(const std::string& text, float width,
                        const std::function<float(const std::string&)>& width_of) {
    if (width_of(text) <= width) return text;
    const auto continues = [&](std::size_t i) {  // A character of UTF-8 is not divided.
        return i < text.size() && (static_cast<unsigned char>(text[i]) & 0xC0U) == 0x80U;
    };
    for (std::size_t begin = 1; begin < text.size(); ++begin) {
        const std::string end = "..." + text.substr(begin);
        if (!continues(begin) && width_of(end) <= width) return end;
    }
    return "...";
}

std::string fitting_line(const std::vector<std::string>& parts, float width,
                         const std::function<float(const std::string&)>& width_of) {
    const std::string gap = "   ";
    std::string line;
    for (const std::string& part : parts) {
        if (part.empty()) continue;
        const std::string longer = line.empty() ? part : line + gap + part;
        if (width_of(longer) <= width) {
            line = longer;
            continue;
        }
        if (!line.empty()) return line;
        const auto continues = [&](std::size_t i) {  // A character of UTF-8 is not divided.
            return (static_cast<unsigned char>(part[i]) & 0xC0U) == 0x80U;
        };
        for (std::size_t kept = part.size() - 1; kept > 1; --kept) {
            std::size_t end = kept / 2;
            std::size_t begin = part.size() - (kept - end);
            while (end > 0 && continues(end))
                --end;
            while (begin + 1 < part.size() && continues(begin))
                ++begin;
            line = part.substr(0, end) + "..." + part.substr(begin);
            if (width_of(line) <= width) break;
        }
        return line;
    }
    return line;
}

}  // namespace relief::tools
