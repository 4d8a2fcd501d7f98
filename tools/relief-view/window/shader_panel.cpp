// SPDX-License-Identifier: Apache-2.0
#include "window/shader_panel.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <set>
#include <sstream>
#include <utility>

#include "window/controls.h"
#include "window/panels.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

constexpr int visible_lines = 22;  // Of the editor.
const ImVec4 error_color{0.85F, 0.2F, 0.15F, 1.0F};
const ImVec4 solved_color{0.25F, 0.65F, 0.3F, 1.0F};

int line_count(const std::string& text) {
    return static_cast<int>(std::count(text.begin(), text.end(), '\n')) + 1;
}

/// Stores the line of the cursor.
int note_cursor(ImGuiInputTextCallbackData* data) {
    auto& line = *static_cast<int*>(data->UserData);
    line = static_cast<int>(std::count(data->Buf, data->Buf + data->CursorPos, '\n'));
    return 0;
}

/// The width of the longest line.
float width_of(const std::string& text) {
    return ImGui::CalcTextSize(text.c_str()).x + 4.0F * ImGui::GetFontSize();
}

/// Scrolls so that the line of the cursor is visible.
void show_line(int line) {
    const float height = ImGui::GetTextLineHeight();
    const float top = static_cast<float>(line) * height;
    const float view = ImGui::GetWindowHeight() - 3.0F * height;
    if (top < ImGui::GetScrollY()) ImGui::SetScrollY(top);
    if (top > ImGui::GetScrollY() + view) ImGui::SetScrollY(top - view);
}

/// Draws the numbers of the lines on the left of the editor, those with messages in red.
void draw_numbers(int count, const std::vector<LineMessage>& messages, const ImVec2& at) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float height = ImGui::GetTextLineHeight();
    for (int i = 0; i < count; ++i) {
        const bool has_message =
            std::any_of(messages.begin(), messages.end(),
                        [&](const LineMessage& message) { return message.line == i + 1; });
        const ImVec2 place{at.x, at.y + static_cast<float>(i) * height};
        if (has_message) {
            list.AddRectFilled(
                place, {place.x + ImGui::GetWindowWidth(), place.y + height},
                ImGui::GetColorU32({error_color.x, error_color.y, error_color.z, 0.35F}));
        }
        const std::string number = fmt::format("{:3}", i + 1);
        list.AddText(place, ImGui::GetColorU32(has_message ? ImGuiCol_Text : ImGuiCol_TextDisabled),
                     number.c_str());
    }
}

}  // namespace

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

// The assembled programs.

void ShaderPanel::assemble(const FramePlan& plan) {
    programs_.clear();
    error_.clear();
    try {
        const ShaderTexts texts = edits_.texts() ? *edits_.texts() : ShaderTexts{};
        for (ShaderListing& listing : shader_listings(plan, texts)) {
            Program program{describe(listing.features), std::move(listing), "", ""};
            program.vertex = numbered_lines(program.listing.vertex);
            program.fragment = numbered_lines(program.listing.fragment);
            programs_.push_back(std::move(program));
        }
    } catch (const std::exception& error) {  // A file or a text may be incomplete.
        error_ = error.what();
        return;
    }
    std::set<std::string> parts;
    for (const Program& program : programs_)
        parts.insert(program.listing.files.begin(), program.listing.files.end());
    parts_.assign(parts.begin(), parts.end());
    if (part_.empty() && !parts_.empty()) select(parts_.front());
}

void ShaderPanel::draw_stage(const char* name, const std::string& source, std::string& numbered) {
    if (!ImGui::BeginTabItem(name)) return probe_item(name);
    probe_item(name);
    if (ImGui::Button("Copy without numbers")) ImGui::SetClipboardText(source.c_str());
    probe_item("Copy without numbers");
    // The field is read-only, so the text does not change.
    ImGui::InputTextMultiline("##source", numbered.data(), numbered.size() + 1,
                              {-1.0F, 24.0F * ImGui::GetTextLineHeight()},
                              ImGuiInputTextFlags_ReadOnly);
    ImGui::EndTabItem();
}

void ShaderPanel::draw_programs() {
    for (std::size_t i = 0; i < programs_.size(); ++i) {
        Program& program = programs_[i];
        const bool is_open = ImGui::TreeNode(fmt::format("{}##{}", program.name, i).c_str());
        probe_item(fmt::format("Program {}", i + 1));
        if (!is_open) continue;
        if (ImGui::BeginTabBar("stages")) {
            draw_stage("Fragment shader", program.listing.fragment, program.fragment);
            draw_stage("Vertex shader", program.listing.vertex, program.vertex);
            ImGui::EndTabBar();
        }
        ImGui::TreePop();
    }
}

// The exercise and the steps.

void ShaderPanel::follow(const std::shared_ptr<const Exercise>& exercise, double now) {
    now_ = now;
    if (exercise_ != exercise) {
        exercise_ = exercise;
        if (exercise_) {
            edits_.begin(*exercise_);
            select(exercise_->part);
        }
    }
    edits_.apply(now);
}

void ShaderPanel::draw_exercise() {
    if (!exercise_) return;
    ImGui::TextWrapped("%s", exercise_->title.c_str());
    ImGui::TextWrapped("%s", exercise_->task.c_str());
    for (std::size_t i = 0; i < exercise_->hints.size(); ++i) {
        const std::string name = fmt::format("Hint {}", i + 1);
        const bool is_open = ImGui::TreeNode(name.c_str());
        probe_item(name);
        if (!is_open) continue;
        ImGui::TextWrapped("%s", exercise_->hints[i].c_str());
        ImGui::TreePop();
    }
    if (const std::optional<ExerciseResult> result = check_.result()) {
        ImGui::PushStyleColor(ImGuiCol_Text, result->is_solved() ? solved_color : error_color);
        ImGui::TextWrapped("%s", result_text(*result).c_str());
        ImGui::PopStyleColor();
    }
    ImGui::Separator();
}

void ShaderPanel::draw_steps(const PanelInput& input) {
    steps_.follow(input.state.shared_scene(), input.drawn.settings);
    const std::vector<PictureStep>& steps = steps_.steps();
    if (steps.size() < 2) return;
    const PictureStep& step = steps[steps_.shown()];
    auto number = static_cast<int>(steps_.shown()) + 1;
    const auto last = static_cast<int>(steps.size());
    const std::string name = fmt::format("%d of {}: {}", last, step.name);
    if (ImGui::SliderInt(begin_row("Step").c_str(), &number, 1, last, name.c_str()))
        steps_.show(static_cast<std::size_t>(std::clamp(number, 1, last) - 1));
    probe_item("Step");
    if (ImGui::Button("Step back") && number > 1) steps_.show(static_cast<std::size_t>(number) - 2);
    probe_item("Step back");
    ImGui::SameLine();
    if (ImGui::Button("Next step") && number < last) steps_.show(static_cast<std::size_t>(number));
    probe_item("Next step");
    ImGui::TextWrapped("%s", step.what.c_str());
}

/// A combo box of mistakes, what the chosen one is, and its cost.
void ShaderPanel::draw_mistakes(const PanelInput& input) {
    const Mistake* const chosen = mistakes_.chosen();
    const std::string name = chosen == nullptr ? "none" : std::string(chosen->name);
    if (ImGui::BeginCombo(begin_row("Mistake").c_str(), name.c_str(),
                          ImGuiComboFlags_HeightLarge)) {
        const auto entry = [&](const std::string& text, const Mistake* mistake) {
            if (ImGui::Selectable(text.c_str(), mistake == chosen)) mistakes_.choose(mistake);
            probe_item("mistake " + text);
        };
        entry("none", nullptr);
        for (const Mistake& mistake : shade::mistakes())
            entry(std::string(mistake.name), &mistake);
        ImGui::EndCombo();
    }
    probe_item("Mistake");
    if (chosen == nullptr) return;
    ImGui::TextWrapped("%s.", std::string(chosen->what).c_str());
    for (const WrongCode& code : chosen->code) {
        if (!input.drawn.plan || std::find(parts_.begin(), parts_.end(), code.part) == parts_.end())
            continue;
        ImGui::TextDisabled("%s", std::string(code.part).c_str());
        ImGui::TextColored(solved_color, "%s", std::string(code.right).c_str());
        ImGui::TextColored(error_color, "%s", std::string(code.wrong).c_str());
    }
    if (const std::optional<DrawnMistake> cost = mistakes_.cost())
        ImGui::TextWrapped("%s", cost_text(*cost).c_str());
}

// The editor.

void ShaderPanel::select(const std::string& part) {
    part_ = part;
    messages_.clear();
    try {
        text_ = edits_.text(part);
    } catch (const std::exception& error) {
        text_.clear();
        error_ = error.what();
    }
}

/// A combo box with all parts, those of the step first.
void ShaderPanel::draw_choice() {
    const auto entry = [&](const std::string& part) {
        const std::string name = part + (edits_.is_edited(part) ? " *" : "");
        if (ImGui::Selectable(name.c_str(), part == part_)) select(part);
        probe_item("part " + part);
    };
    if (!ImGui::BeginCombo(begin_row("Part").c_str(), part_.c_str())) return probe_item("Part");
    if (steps_.shown() < steps_.steps().size()) {
        const PictureStep& step = steps_.steps()[steps_.shown()];
        if (!step.parts.empty()) ImGui::TextDisabled("%s", step.name.c_str());
        ImGui::PushID("step");
        for (const std::string& part : step.parts)
            entry(part);
        ImGui::PopID();
        ImGui::TextDisabled("all parts");
    }
    for (const std::string& part : parts_)
        entry(part);
    ImGui::EndCombo();
}

/// The code, as high as its lines, in a view that scrolls.
void ShaderPanel::draw_code(const std::vector<LineMessage>& messages) {
    const float height = ImGui::GetTextLineHeight();
    const int count = line_count(text_);
    const int rows = std::max(count, visible_lines - 3);  // All of the view takes clicks.
    ImGui::BeginChild("code", {0.0F, static_cast<float>(visible_lines) * height}, true,
                      ImGuiWindowFlags_HorizontalScrollbar);
    const ImVec2 padding = ImGui::GetStyle().FramePadding;
    ImVec2 at = ImGui::GetCursorScreenPos();
    at.y += padding.y;
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + ImGui::CalcTextSize("0000").x);
    const float width = std::max(ImGui::GetContentRegionAvail().x, width_of(text_));
    ImGui::PushStyleColor(ImGuiCol_FrameBg, {0.0F, 0.0F, 0.0F, 0.0F});
    const int line_before = cursor_line_;
    const bool is_changed = ImGui::InputTextMultiline(
        "##code", &text_, {width, static_cast<float>(rows) * height + 2.0F * padding.y},
        ImGuiInputTextFlags_AllowTabInput | ImGuiInputTextFlags_CallbackAlways, note_cursor,
        &cursor_line_);
    ImGui::PopStyleColor();
    draw_numbers(count, messages, at);
    if (cursor_line_ != line_before) show_line(cursor_line_);
    ImGui::EndChild();
    probe_item("code");
    if (is_changed) edits_.set(part_, text_, now_);
}

void ShaderPanel::draw_files() {
    ImGui::InputText(begin_row("Folder").c_str(), &folder_);
    probe_item("Folder");
    if (ImGui::Button("Save edits") && edits_.has_edits()) {
        try {
            saved_ = fmt::format("saved {} in {}", fmt::join(edits_.save(folder_), ", "), folder_);
        } catch (const std::exception& error) {
            saved_ = error.what();
        }
    }
    probe_item("Save edits");
    if (!saved_.empty()) ImGui::TextWrapped("%s", saved_.c_str());
}

void ShaderPanel::draw_editor(const std::string& error) {
    draw_choice();
    if (part_.empty()) return;
    messages_ = edits_.messages(part_, error);
    draw_code(messages_);
    for (const LineMessage& message : messages_) {
        ImGui::PushStyleColor(ImGuiCol_Text, error_color);
        ImGui::TextWrapped("line %d: %s", message.line, message.text.c_str());
        ImGui::PopStyleColor();
    }
    if (messages_.empty() && !error.empty()) ImGui::TextWrapped("%s", error.c_str());
    if (ImGui::Button("Reset part")) {
        edits_.reset(part_);
        select(part_);
    }
    probe_item("Reset part");
    ImGui::SameLine();
    check("Difference", shows_difference_);
    if (shows_difference_) {
        for (const std::string& line : line_difference(ShaderEdits::original(part_), text_)) {
            if (line.starts_with("  ")) continue;
            ImGui::TextColored(line.starts_with("+") ? solved_color : error_color, "%s",
                               line.c_str());
        }
    }
    draw_files();
}

void ShaderPanel::draw(const PanelInput& input) {
    if (plan_ != input.drawn.plan || assembled_texts_ != edits_.texts())
        assemble(*input.drawn.plan);
    plan_ = input.drawn.plan;
    assembled_texts_ = edits_.texts();
    draw_exercise();
    draw_steps(input);
    draw_mistakes(input);
    draw_editor(error_.empty() ? input.drawn.error : error_);
    draw_programs();
}

nlohmann::ordered_json ShaderPanel::json() const {
    nlohmann::ordered_json json = edits_.json();
    json["part"] = part_;
    json["messages"] = nlohmann::ordered_json::array();
    for (const LineMessage& message : messages_)
        json["messages"].push_back({message.line, message.text});
    json["saved"] = saved_;
    json["steps"] = steps_.json();
    json["mistake"] = mistakes_.json();
    json["exercise"] = exercise_ ? check_.json() : nullptr;
    return json;
}

}  // namespace relief::tools
