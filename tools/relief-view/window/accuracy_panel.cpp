// SPDX-License-Identifier: Apache-2.0
// Methods with what they err and take on this scene, and which of them are in use.
// Tests: tests/tools/window/accuracy_window_test.cpp.
#include <fmt/format.h>
#include <imgui.h>

#include "relief/accuracy/words.h"
#include "window/panels.h"
#include "window/places.h"
#include "window/progress_line.h"
#include "window/scene_accuracy.h"

namespace relief::tools {
namespace {

std::string time_text(const Measurement& one) {
    if (!one.cost.all_threads) return "-";
    return seconds_in_words(one.cost.all_threads->spread().median);
}

/// Without what all that are shown have in common.
std::string name_of(const Measurement& one) {
    std::string name = one.method;
    const std::string depth = ", 16 bit";
    if (const std::size_t place = name.find(depth); place != std::string::npos)
        name.erase(place, depth.size());
    return (one.is_efficient ? "* " : "  ") + name;
}

void draw_method(const PanelInput& input, const AccuracyTopic& topic, std::size_t row,
                 PanelWishes& wishes) {
    const Measurement& one = topic.own.experiment.measurements[row];
    const std::optional<Variant>& use = topic.uses[row];
    const bool is_used = use && input.accuracy->is_used(*use, input.state.options());
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    const ImGuiSelectableFlags flags =
        ImGuiSelectableFlags_SpanAllColumns | (use ? 0 : ImGuiSelectableFlags_Disabled);
    const bool is_clicked = ImGui::Selectable(name_of(one).c_str(), is_used, flags);
    if (is_clicked && use && !is_used) wishes.use_method = *use;
    if (use) mark_place("method " + to_text(*use));
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) {
        ImGui::SetTooltip("mean %.4g, 99 of 100 within %.4g, largest %.4g degrees%s%s",
                          one.error.mean, one.error.p99, one.error.max,
                          one.note.empty() ? "" : "\n", one.note.c_str());
    }
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(fmt::format("{:.3g}", one.error.rms).c_str());
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(time_text(one).c_str());
}

void draw_topic(const PanelInput& input, const AccuracyTopic& topic, PanelWishes& wishes) {
    const Experiment& experiment = topic.own.experiment;
    ImGui::TextUnformatted(experiment.title.c_str());
    ImGui::SameLine();
    ImGui::TextDisabled("(?)");
    if (ImGui::IsItemHovered()) {
        ImGui::BeginTooltip();
        ImGui::PushTextWrapPos(30.0F * ImGui::GetFontSize());
        ImGui::TextUnformatted((experiment.question + "\n" + experiment.input +
                                "\n\nErrors are from: " + experiment.truth + "\n\n" +
                                topic.own.recommendation.words)
                                   .c_str());
        ImGui::PopTextWrapPos();
        ImGui::EndTooltip();
    }
    constexpr ImGuiTableFlags flags = ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_RowBg;
    if (!ImGui::BeginTable(experiment.id.c_str(), 3, flags)) return;
    ImGui::TableSetupColumn("method", ImGuiTableColumnFlags_WidthStretch);
    ImGui::TableSetupColumn("degrees");
    ImGui::TableSetupColumn("time");
    ImGui::TableHeadersRow();
    for (const std::size_t row : topic.rows)
        draw_method(input, topic, row, wishes);
    ImGui::EndTable();
}

}  // namespace

void draw_accuracy_panel(const PanelInput& input, PanelWishes& wishes) {
    if (!input.state.has_scene() || input.accuracy == nullptr) return;
    if (input.accuracy->is_measuring()) {
        draw_progress("Measuring", input.accuracy->progress());
        if (ImGui::SmallButton("Stop measuring")) wishes.stop_accuracy = true;
        mark_place("Stop measuring");
        return;
    }
    if (ImGui::Button("Measure methods")) wishes.measure_accuracy = true;
    mark_place("Measure methods");
    const FoundAccuracy& found = input.accuracy->found();
    if (!found.error.empty()) ImGui::TextWrapped("%s", found.error.c_str());
    if (found.topics.empty()) {
        ImGui::TextWrapped(
            "What each method of normals, tangents and slopes errs on this model, RMS in degrees, "
            "and takes. A click takes the method; * marks those that nothing beats in both.");
        return;
    }
    for (const AccuracyTopic& topic : found.topics)
        draw_topic(input, topic, wishes);
}

}  // namespace relief::tools
