// SPDX-License-Identifier: Apache-2.0
// The toolbar, the panels in a column, the controls of the animation, the status line, the list of
// shortcuts and the file dialog. Tests: tests/tools/window/user_interface_test.cpp.
#include "window/panels.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <cfloat>
#include <string_view>

#include "common/text.h"
#include "window/controls.h"

namespace relief::tools {

namespace {

/// The parts of the status line, the most important one first.
std::vector<std::string> status_parts(const PanelInput& input) {
    if (!input.state.has_scene()) return {};
    const shade::FrameSettings& settings = input.drawn.settings;
    return {input.captured,
            counted(triangle_count(input.state.scene()), "triangle"),
            fmt::format("{} x {} pixels", settings.width, settings.height),
            fmt::format("{:.1f} ms per picture", input.drawn.times.draw),
            input.is_drawing ? "drawing" : "idle",
            input.renderer,
            fmt::format("picture {}", input.drawn.frames)};
}

/// Shows a line that fits; if a message is cut, its tooltip has all of it.
void draw_line(const std::vector<std::string>& parts, const ImVec4& color) {
    const auto width_of = [](const std::string& text) {
        return ImGui::CalcTextSize(text.c_str()).x;
    };
    const std::string line = fitting_line(parts, ImGui::GetContentRegionAvail().x, width_of);
    ImGui::TextColored(color, "%s", line.c_str());
    const bool is_cut = !parts.empty() && !line.starts_with(parts.front());
    if (is_cut && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", parts.front().c_str());
}

// In line heights.
constexpr float column_width = 27.0F;

struct Panel {
    const char* group;  ///< The caption above the first panel of each group.
    const char* name;
    bool is_open_at_first;
    void (*draw)(const PanelInput&, PanelRequests&);
};

/// A panel without requests to the window.
template <void (*draw)(const PanelInput&)>
void plain(const PanelInput& input, PanelRequests&) {
    draw(input);
}

constexpr std::array all_panels{
    Panel{"Contents", "Scene", true, draw_scene_panel},
    Panel{"Contents", "Lights", false, plain<draw_light_panel>},
    Panel{"Contents", "Materials", false, plain<draw_material_panel>},
    Panel{"Contents", "Environment", false, plain<draw_environment_panel>},
    Panel{"Image", "Picture", false, plain<draw_picture_panel>},
    Panel{"Image", "View", false, plain<draw_view_panel>},
    Panel{"Image", "Compare", false, plain<draw_compare_panel>},
    Panel{"Image", "Save", false, draw_capture_panel},
    Panel{"Analysis", "Effects", false, draw_effects_panel},
    Panel{"Analysis", "Accuracy", false, draw_accuracy_panel},
};

/// Draws a panel's header, which opens and closes the panel. The layout stores the state.
/// \return whether the panel is open
bool begins(const Panel& panel, WindowLayout& layout) {
    const auto remembered = layout.open_panels.find(panel.name);
    const bool was_open =
        remembered == layout.open_panels.end() ? panel.is_open_at_first : remembered->second;
    ImGui::SetNextItemOpen(was_open);
    const bool is_open = ImGui::CollapsingHeader(panel.name);
    probe_item(panel.name);
    if (is_open != was_open) layout.open_panels[panel.name] = is_open;
    return is_open;
}

/// Menu entries with the descriptions and keys of shortcuts.
void draw_menu(const char* name, std::initializer_list<Action> entries, PanelRequests& requests) {
    if (ImGui::Button(name)) ImGui::OpenPopup(name);
    probe_item(name);
    if (!ImGui::BeginPopup(name)) return;
    for (const Action action : entries) {
        const auto& all = shortcuts();
        const auto found = std::find_if(all.begin(), all.end(), [&](const Shortcut& shortcut) {
            return shortcut.action == action;
        });
        const std::string text(found->description);
        if (ImGui::MenuItem(text.c_str(), std::string(found->key).c_str()))
            requests.actions.push_back(action);
        probe_item(text);
    }
    ImGui::EndPopup();
}

/// Draws the buttons above the panels. \return their height in window units
float draw_toolbar(const ViewerState& state, float width, PanelRequests& requests) {
    const ImGuiStyle& style = ImGui::GetStyle();
    const float height = ImGui::GetFrameHeight() + 2.0F * style.WindowPadding.y;
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize({width, height});
    ImGui::Begin("Toolbar", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
    const auto button = [&](const char* name, Action action, const char* tooltip) {
        if (ImGui::Button(name)) requests.actions.push_back(action);
        probe_item(name);
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", tooltip);
        ImGui::SameLine();
    };
    button("Open...", Action::open, "Open a model or a scene (Ctrl+O)");
    draw_menu("Save as", {Action::save_picture, Action::save_scene, Action::save_model}, requests);
    ImGui::SameLine();
    draw_menu("Edit", {Action::undo, Action::redo, Action::copy_camera, Action::paste_camera},
              requests);
    ImGui::SameLine();
    draw_menu("Views",
              {Action::fit, Action::front, Action::back, Action::right, Action::left, Action::top,
               Action::bottom, Action::next_file, Action::previous_file, Action::theme,
               Action::larger_ui, Action::smaller_ui},
              requests);
    ImGui::SameLine();
    if (state.has_scene() && state.playback().has_motion()) {
        button(state.playback().is_playing() ? "Pause##toolbar" : "Play##toolbar", Action::play,
               "Play or pause the animation (P)");
    } else {
        button("Turn", Action::turntable, "Start or stop the turntable (Space)");
    }
    button("Help", Action::help, "Show all shortcuts (F1)");
    ImGui::End();
    return height;
}

}  // namespace

std::vector<std::string> panel_names() {
    std::vector<std::string> names;
    for (const Panel& panel : all_panels)
        names.emplace_back(panel.name);
    return names;
}

float draw_panels(const PanelInput& input, PanelRequests& requests) {
    const ImGuiIO& io = ImGui::GetIO();
    const float width = column_width * ImGui::GetFontSize();
    const float status_height = ImGui::GetFrameHeightWithSpacing();
    const float top = draw_toolbar(input.state, width, requests);
    ImGui::SetNextWindowPos({0, top});
    ImGui::SetNextWindowSize({width, io.DisplaySize.y - status_height - top});
    ImGui::Begin("Panels", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_AlwaysVerticalScrollbar);
    std::string_view group;
    for (const Panel& panel : all_panels) {
        if (group != panel.group) ImGui::TextDisabled("%s", panel.group);
        group = panel.group;
        if (begins(panel, input.layout)) panel.draw(input, requests);
    }
    ImGui::End();
    return width;
}

namespace {

constexpr std::array speeds{0.1F, 0.25F, 0.5F, 1.0F, 2.0F, 4.0F};

void choose_speed(ViewerState& state) {
    std::vector<std::string> names;
    std::size_t index = 0;
    for (const float speed : speeds) {
        if (speed == state.playback().speed()) index = names.size();
        names.push_back(fmt::format("{:g} x", speed));
    }
    ImGui::SetNextItemWidth(5.0F * ImGui::GetFontSize());
    if (choose_index("##Speed", index, names))
        state.change_playback([&](Playback& playback) { playback.set_speed(speeds[index]); });
}

void choose_clip(ViewerState& state) {
    const Playback& now = state.playback();
    std::vector<std::string> names = {"all"};
    names.insert(names.end(), now.clips().begin(), now.clips().end());
    std::size_t index = now.clip() ? *now.clip() + 1 : 0;
    ImGui::SetNextItemWidth(8.0F * ImGui::GetFontSize());
    if (!choose_index("##Clip", index, names)) return;
    state.change_playback([&](Playback& playback) {
        playback.set_clip(index == 0 ? std::nullopt : std::optional(index - 1));
    });
}

}  // namespace

float draw_playback(ViewerState& state, float left, float bottom) {
    const Playback& now = state.playback();
    if (!state.has_scene() || (!now.has_motion() && now.clips().size() < 2)) return 0.0F;
    const ImGuiIO& io = ImGui::GetIO();
    const float letter = ImGui::GetFontSize();
    const float width = io.DisplaySize.x - left;
    // Narrow windows show the clips below.
    const bool has_clips = now.clips().size() > 1;
    const bool is_narrow = has_clips && width < 32.0F * letter;
    const float height = ImGui::GetFrameHeight() + 0.6F * letter +
                         (is_narrow ? ImGui::GetFrameHeightWithSpacing() : 0.0F);
    ImGui::SetNextWindowPos({left, io.DisplaySize.y - bottom - height});
    ImGui::SetNextWindowSize({width, height});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.6F * letter, 0.3F * letter});
    ImGui::Begin("Playback", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
    if (ImGui::Button(now.is_playing() ? "Pause" : "Play", {4.5F * letter, 0.0F}))
        state.act(Action::play);
    probe_item("Play");
    ImGui::SameLine();
    const bool clips_are_beside = has_clips && !is_narrow;
    const float others =
        (clips_are_beside ? 13.0F : 5.0F) * letter + 3.0F * ImGui::GetStyle().ItemSpacing.x;
    ImGui::SetNextItemWidth(std::max(ImGui::GetContentRegionAvail().x - others, 4.0F * letter));
    auto time = static_cast<float>(now.time_in_clip());
    const auto end = static_cast<float>(now.duration());
    const std::string format = fmt::format("%.2f of {:.2f} s", end);
    if (slide("##time", time, {0.0F, end, format.c_str()})) {
        state.change_playback([&](Playback& playback) {
            playback.set_playing(false);
            playback.set_time(static_cast<double>(time));
        });
    }
    ImGui::SameLine();
    choose_speed(state);
    if (clips_are_beside) ImGui::SameLine();
    if (has_clips) choose_clip(state);
    ImGui::End();
    ImGui::PopStyleVar();
    return height;
}

void draw_status(const PanelInput& input, PanelRequests& requests) {
    const ImGuiIO& io = ImGui::GetIO();
    const float height = ImGui::GetFrameHeightWithSpacing();
    ImGui::SetNextWindowPos({0, io.DisplaySize.y - height});
    ImGui::SetNextWindowSize({io.DisplaySize.x, height});
    const float letter = ImGui::GetFontSize();
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.6F * letter, 0.15F * letter});
    ImGui::Begin("Status", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
    const std::string& error =
        input.state.error().empty() ? input.drawn.error : input.state.error();
    if (input.loading != nullptr) {
        const std::filesystem::path& model = input.loading->model;
        const bool is_shown = input.state.has_scene() && input.state.options().model == model;
        draw_progress((is_shown ? "Updating " : "Reading ") + model.filename().string(),
                      input.progress);
        ImGui::SameLine();
        ImGui::Text("%.1f s", input.loading_seconds);
        ImGui::SameLine();
        if (ImGui::SmallButton("Cancel")) requests.cancel_loading = true;
        probe_item("Cancel");
    } else if (!input.progress.stage.empty()) {
        draw_progress("Preparing", input.progress);
    } else if (!error.empty()) {
        if (input.state.has_refused_map()) {
            if (ImGui::SmallButton("Use it anyway"))
                requests.assume = input.state.use_refused_map();
            probe_item("Use it anyway");
            ImGui::SameLine();
        }
        const bool is_light = ImGui::GetStyleColorVec4(ImGuiCol_WindowBg).x > 0.5F;
        draw_line({error},
                  is_light ? ImVec4(0.7F, 0.1F, 0.0F, 1.0F) : ImVec4(1.0F, 0.5F, 0.4F, 1.0F));
    } else {
        draw_line(status_parts(input), ImGui::GetStyleColorVec4(ImGuiCol_Text));
    }
    ImGui::End();
    ImGui::PopStyleVar();
}

void draw_help(bool& is_open) {
    const ImGuiIO& io = ImGui::GetIO();
    ImGui::SetNextWindowPos({0.5F * io.DisplaySize.x, 0.5F * io.DisplaySize.y}, ImGuiCond_Always,
                            {0.5F, 0.5F});
    ImGui::Begin("Shortcuts", &is_open,
                 ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_AlwaysAutoResize);
    const auto row = [](std::string_view how, std::string_view what) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(how.data(), how.data() + how.size());
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(what.data(), what.data() + what.size());
    };
    if (ImGui::BeginTable("shortcuts", 2, ImGuiTableFlags_SizingFixedFit)) {
        for (const Gesture& gesture : gestures())
            row(gesture.input, gesture.description);
        for (const Shortcut& shortcut : shortcuts())
            row(shortcut.key, shortcut.description);
        ImGui::EndTable();
    }
    ImGui::End();
}

// The file dialog.

void FileDialog::open(const std::filesystem::path& folder) {
    is_open_ = true;
    listing_ = list_folder(folder);
}

std::optional<std::filesystem::path> FileDialog::draw(
    const std::vector<std::string>& recent_files) {
    if (!is_open_) return std::nullopt;
    constexpr const char* title = "Open a model, a scene or a map";
    if (!ImGui::IsPopupOpen(title)) ImGui::OpenPopup(title);
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({0.5F * screen.x, 0.5F * screen.y}, ImGuiCond_Always, {0.5F, 0.5F});
    ImGui::SetNextWindowSize({0.7F * screen.x, 0.8F * screen.y});
    std::optional<std::filesystem::path> selected;
    std::optional<std::filesystem::path> folder;
    if (!ImGui::BeginPopupModal(title, nullptr,
                                ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove))
        return std::nullopt;
    std::string path = listing_.folder.string();
    ImGui::SetNextItemWidth(-FLT_MIN);
    if (ImGui::InputText("##path", &path, ImGuiInputTextFlags_EnterReturnsTrue)) {
        std::error_code none;
        const std::filesystem::path typed = pasted_path(path);
        (std::filesystem::is_directory(typed, none) ? folder : selected) = typed;
    }
    probe_item("path");
    if (!listing_.error.empty()) ImGui::TextWrapped("%s", listing_.error.c_str());
    ImGui::BeginChild("files", {0.0F, -1.5F * ImGui::GetFrameHeightWithSpacing()}, true);
    for (const std::filesystem::path& inner : listing_.folders) {
        const std::string name = inner.filename().string() + "/";
        if (ImGui::Selectable(inner == listing_.folder.parent_path() ? "../" : name.c_str()))
            folder = inner;
        probe_item(name);
    }
    for (const std::filesystem::path& file : listing_.files) {
        const std::string name = file.filename().string();
        if (ImGui::Selectable(name.c_str())) selected = file;
        probe_item(name);
    }
    ImGui::EndChild();
    if (!recent_files.empty()) {
        if (ImGui::BeginCombo("##recent", "Recent files", ImGuiComboFlags_NoArrowButton)) {
            for (const std::string& file : recent_files) {
                if (ImGui::Selectable(file.c_str())) selected = file;
            }
            ImGui::EndCombo();
        }
        ImGui::SameLine();
    }
    const bool is_cancelled =
        ImGui::Button("Cancel##dialog") ||
        (!ImGui::IsAnyItemActive() && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape)));
    probe_item("Cancel the dialog");
    if (folder) listing_ = list_folder(*folder);
    if (selected || is_cancelled) {
        is_open_ = false;
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
    return selected;
}

}  // namespace relief::tools
