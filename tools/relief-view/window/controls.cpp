// SPDX-License-Identifier: Apache-2.0
#include "window/controls.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>  // For the end of the rendered part of a label.
#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <cstdint>
#include <glm/trigonometric.hpp>
#include <string_view>
#include <utility>

namespace relief::tools {

namespace {

/// The positions of the controls of this frame, by name.
struct UiProbe {
    bool is_enabled = false;
    nlohmann::ordered_json positions = nlohmann::ordered_json::object();
    std::vector<ProbedRow> rows;
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
    ui_probe().rows.clear();
}

namespace {

UiRectangle item_rectangle() {
    const ImVec2 min = ImGui::GetItemRectMin();
    const ImVec2 max = ImGui::GetItemRectMax();
    return {{min.x, min.y}, {max.x, max.y}};
}

/// Begins a row whose label is the last item.
void probe_label(const std::string& name) {
    if (!ui_probe().is_enabled) return;
    const ImRect& panel = ImGui::GetCurrentWindow()->InnerClipRect;
    ui_probe().rows.push_back({name,
                               item_rectangle(),
                               {},
                               {},
                               {{panel.Min.x, panel.Min.y}, {panel.Max.x, panel.Max.y}},
                               0.0F});
}

/// Stores the last item as the number of the last row.
void probe_number(float width) {
    if (!ui_probe().is_enabled || ui_probe().rows.empty()) return;
    ui_probe().rows.back().number = item_rectangle();
    ui_probe().rows.back().number_width = width;
}

}  // namespace

const std::vector<ProbedRow>& probed_rows() {
    return ui_probe().rows;
}

void probe_item(const std::string& name) {
    if (!ui_probe().is_enabled) return;
    std::vector<ProbedRow>& rows = ui_probe().rows;
    if (!rows.empty() && rows.back().name == name) rows.back().control = item_rectangle();
    if (!ImGui::IsItemVisible()) return;
    const ImVec2 min = ImGui::GetItemRectMin();
    const ImVec2 max = ImGui::GetItemRectMax();
    ui_probe().positions[name] = {std::round(0.5F * (min.x + max.x)),
                                  std::round(0.5F * (min.y + max.y))};
}

void probe_place(const std::string& name, const glm::vec2& place) {
    if (ui_probe().is_enabled)
        ui_probe().positions[name] = {std::round(place.x), std::round(place.y)};
}

nlohmann::ordered_json ui_probe_json() {
    return ui_probe().positions;
}

namespace {

// In line heights.
constexpr float label_width = 12.5F;
constexpr float label_share = 0.46F;  // Of a narrow panel.

}  // namespace

std::string begin_row(const char* label, float room) {
    const std::string text(label, ImGui::FindRenderedTextEnd(label));
    if (text.empty()) return label;
    const float letter = ImGui::GetFontSize();
    const float right = ImGui::GetContentRegionMax().x;
    const float column = std::min(label_width * letter, label_share * right);
    const float end = ImGui::GetCursorPosX() + ImGui::CalcTextSize(text.c_str()).x +
                      ImGui::GetStyle().ItemInnerSpacing.x;
    const float begin = std::max(column, end);
    if (begin + room * letter <= right) {
        ImGui::AlignTextToFramePadding();
        ImGui::TextUnformatted(text.c_str());
        probe_label(label);
        ImGui::SameLine(begin);
    } else {
        ImGui::PushTextWrapPos(0.0F);
        ImGui::TextUnformatted(text.c_str());
        ImGui::PopTextWrapPos();
        probe_label(label);
    }
    ImGui::SetNextItemWidth(-FLT_MIN);
    return std::string("##") + label;
}

bool check(const char* label, bool& value) {
    const bool changed = ImGui::Checkbox(begin_row(label, check_room).c_str(), &value);
    probe_item(label);
    return changed;
}

namespace {

/// The width of a color field whose three numbers are not cut.
float color_field_width(const glm::vec3& color) {
    const ImGuiStyle& style = ImGui::GetStyle();
    float number = 0.0F;
    for (int i = 0; i < 3; ++i)
        number = std::max(number, ImGui::CalcTextSize(fmt::format("{:.3f}", color[i]).c_str()).x);
    return 3.0F * (number + 2.0F * style.FramePadding.x + style.ItemInnerSpacing.x) +
           ImGui::GetFrameHeight();
}

}  // namespace

bool pick_color(const char* label, glm::vec3& color, bool has_limit) {
    ImGuiColorEditFlags flags = ImGuiColorEditFlags_Float |
                                (has_limit ? ImGuiColorEditFlags_None : ImGuiColorEditFlags_HDR);
    const float wanted = color_field_width(color);
    const std::string id = begin_row(label, wanted / ImGui::GetFontSize());
    // The numbers are also in the dialog that a click on the color opens.
    if (ImGui::CalcItemWidth() < wanted) flags |= ImGuiColorEditFlags_NoInputs;
    const bool changed = ImGui::ColorEdit3(id.c_str(), &color.x, flags);
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

namespace {

/// The number of a slider as text.
std::string number_text(float value, const char* format) {
    std::array<char, 64> text{};
    ImGui::DataTypeFormatString(text.data(), static_cast<int>(text.size()), ImGuiDataType_Float,
                                &value, format);
    return text.data();
}

/// The slider whose number was clicked; 0: none.
ImGuiID& clicked_number() {
    static ImGuiID id = 0;
    return id;
}

/// Draws the number beside the slider that was drawn last.
void draw_number(const std::string& text, ImGuiID slider, float width) {
    ImGui::SameLine(0.0F, ImGui::GetStyle().ItemInnerSpacing.x);
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    if (ImGui::InvisibleButton("number", {width, ImGui::GetFrameHeight()}))
        clicked_number() = slider;
    probe_number(ImGui::CalcTextSize(text.c_str()).x);
    if (ImGui::IsItemHovered()) {
        ImGui::SetMouseCursor(ImGuiMouseCursor_TextInput);
        ImGui::SetTooltip("Click to type a number");
    }
    ImGui::GetWindowDrawList()->AddText({corner.x, corner.y + ImGui::GetStyle().FramePadding.y},
                                        ImGui::GetColorU32(ImGuiCol_Text), text.c_str());
}

}  // namespace

bool slide(const char* label, float& value, const Slider& slider) {
    const ImGuiSliderFlags flags =
        ImGuiSliderFlags_AlwaysClamp |
        (slider.is_logarithmic ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None);
    const std::string id = begin_row(label, slider_room);
    const ImGuiID item = ImGui::GetID(id.c_str());
    constexpr float number_column = 3.6F;  // In line heights.
    const auto width_of = [&](float number) {
        return ImGui::CalcTextSize(number_text(number, slider.format).c_str()).x;
    };
    const float number = std::max({number_column * ImGui::GetFontSize(), width_of(slider.min),
                                   width_of(slider.max), width_of(value)});
    ImGui::SetNextItemWidth(
        std::max(ImGui::CalcItemWidth() - number - ImGui::GetStyle().ItemInnerSpacing.x, 1.0F));
    if (clicked_number() == item) {
        clicked_number() = 0;
        ImGui::SetKeyboardFocusHere();
    }
    // The text inside of the slider is drawn only while it is typed.
    const bool is_typed = ImGui::TempInputIsActive(item);
    if (!is_typed) ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(0.0F, 0.0F, 0.0F, 0.0F));
    bool changed =
        ImGui::SliderFloat(id.c_str(), &value, slider.min, slider.max, slider.format, flags);
    if (!is_typed) ImGui::PopStyleColor();
    probe_item(label);
    if (slider.default_value && value != *slider.default_value && ImGui::IsItemHovered()) {
        ImGui::SetTooltip("Right click: %s",
                          fmt::format("reset to {:g}", *slider.default_value).c_str());
        if (ImGui::IsMouseClicked(ImGuiMouseButton_Right)) {
            value = *slider.default_value;
            changed = true;
        }
    }
    ImGui::PushID(label);
    draw_number(number_text(value, slider.format), item, number);
    ImGui::PopID();
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
    const bool changed = ImGui::DragFloat(begin_row(label, drag_room).c_str(), &value, step, 0.0F,
                                          max, "%.3g", ImGuiSliderFlags_AlwaysClamp);
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
        case FieldUnit::pixels:
            return "%.2f pixels";
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
    begin_row(label, path_room);
    ImGui::PushID(label);
    if (thumbnail) {
        draw(*thumbnail);
        probe_item(std::string("thumbnail of ") + label);
        ImGui::SameLine(0.0F, ImGui::GetStyle().ItemInnerSpacing.x);
    }
    const float button = ImGui::GetFrameHeight();
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
    ImGui::SetNextItemWidth(-(shown ? 2.0F : 1.0F) * (button + gap));
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
    ImGui::SameLine(0.0F, gap);
    choice.is_browsing = ImGui::Button("...", {button, 0.0F});
    probe_item(std::string("browse ") + label);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Select a file");
    if (shown) {
        ImGui::SameLine(0.0F, gap);
        if (ImGui::Button("x", {button, 0.0F})) choice.is_cleared = true;
        probe_item(std::string("clear ") + label);
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("Remove");
    }
    ImGui::PopID();
    return choice;
}

std::string stage_title(const std::string& stage) {
    static constexpr std::array<std::array<std::string_view, 2>, 8> titles{{
        {"programs", "compiling shaders"},
        {"images", "reading images"},
        {"meshes", "reading meshes"},
        {"environment", "lighting from the environment"},
        {"uploading images", "handing images to the graphics card"},
        {"uploading meshes", "handing meshes to the graphics card"},
        {"strips", "reading strips"},
        {"faces", "reading faces"},
    }};
    for (const auto& [name, title] : titles) {
        if (name == stage) return std::string(title);
    }
    return stage;
}

void draw_progress(const std::string& what, const Progress::State& progress) {
    const std::string stage = progress.stage.empty() ? "" : ": " + stage_title(progress.stage);
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
