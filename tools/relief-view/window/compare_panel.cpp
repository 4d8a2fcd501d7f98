// SPDX-License-Identifier: Apache-2.0
// What the scene is compared with, what is shown of it, and the difference in numbers.
// Tests: tests/tools/window/compare_window_test.cpp.
#include <imgui.h>

#include <array>

#include "window/comparison.h"
#include "window/panels.h"
#include "window/places.h"

namespace relief::tools {
namespace {

const VariantTopic& topic_of(const Variant& variant) {
    return variant_topics().at(variant.index());
}

/// \return whether another one was chosen
template <typename Named, typename Name>
const Named* choose_one(const char* label, const std::string& now, const std::vector<Named>& all,
                        const Name& name) {
    const Named* chosen = nullptr;
    if (ImGui::BeginCombo(label, now.c_str())) {
        for (const Named& one : all) {
            if (ImGui::Selectable(name(one).c_str(), name(one) == now)) chosen = &one;
            mark_place(name(one));
        }
        ImGui::EndCombo();
    } else {
        mark_place(label);
    }
    return chosen;
}

void choose_variant(Comparison& comparison) {
    const std::optional<Variant>& variant = comparison.choices().variant;
    const std::string name = variant ? topic_of(*variant).name : "";
    const VariantTopic* topic =
        choose_one("Change", name, variant_topics(), [](const VariantTopic& t) { return t.name; });
    if (topic != nullptr) comparison.choose(topic->choices.front().second);
    if (!variant || topic != nullptr) return;
    const std::string text = to_text(*variant);
    const auto* choice =
        choose_one("To", text.substr(text.find('=') + 1), topic_of(*variant).choices,
                   [](const auto& c) { return c.first; });
    ImGui::TextWrapped("%s", topic_of(*variant).what.c_str());
    if (choice != nullptr) comparison.choose(choice->second);
}

void choose_file(Comparison& comparison) {
    static std::array<char, 4096> name{};
    const bool entered =
        ImGui::InputTextWithHint("Or a file", "model or scene, then Enter", name.data(),
                                 name.size(), ImGuiInputTextFlags_EnterReturnsTrue);
    mark_place("Or a file");
    if (entered && name.front() != '\0') comparison.choose(std::filesystem::path(name.data()));
}

void tell_numbers(const Comparison& comparison) {
    const std::optional<SideNumbers>& numbers = comparison.numbers();
    if (!numbers) return;
    if (!numbers->error.empty()) return ImGui::TextWrapped("%s", numbers->error.c_str());
    ImGui::TextWrapped("%s", in_words(numbers->comparison).c_str());
}

}  // namespace

void draw_compare_panel(const PanelInput& input) {
    if (!input.state.has_scene() || input.comparison == nullptr) return;
    Comparison& comparison = *input.comparison;
    bool is_on = comparison.is_on();
    if (ImGui::Checkbox("Compare with##two", &is_on)) comparison.toggle();
    mark_place("Compare two");
    choose_variant(comparison);
    choose_file(comparison);
    if (!comparison.is_on()) return;
    if (!comparison.error().empty())
        ImGui::TextColored({1.0F, 0.5F, 0.4F, 1.0F}, "%s", comparison.error().c_str());
    if (ImGui::Button("Swap sides")) comparison.swap();
    mark_place("Swap sides");
    int shown = static_cast<int>(comparison.shown());
    if (ImGui::Combo("Show##sides", &shown,
                     "Both sides\0Difference to the eye\0Largest difference\0"))
        comparison.show(static_cast<SidesShown>(shown));
    if (ImGui::Button("Numbers")) comparison.ask_for_numbers();
    mark_place("Numbers");
    if (comparison.is_working()) {
        ImGui::SameLine();
        ImGui::TextUnformatted("working");
    }
    tell_numbers(comparison);
}

}  // namespace relief::tools
