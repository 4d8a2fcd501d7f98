// SPDX-License-Identifier: Apache-2.0
// The toolbar, the panels in a column, the controls of the animation, and the status line.
// Tests: tests/tools/window/user_interface_test.cpp.
#include "window/panels.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cfloat>
#include <span>
#include <string_view>

#include "common/text.h"
#include "window/controls.h"

namespace relief::tools {
using shade::debug_view_info;
using shade::DebugView;

namespace {

/// Returns the activity of the window in a few words.
std::string activity(const PanelInput& input) {
    const glm::ivec2& view = input.state.view();
    const shade::FrameSettings& settings = input.drawn.settings;
    if (!input.is_drawing) return "Ready";
    const bool is_preview = settings.width < view.x || settings.height < view.y;
    return is_preview ? "Preview while moving" : "Drawing";
}

/// The parts of the status line, the most important one first.
std::vector<std::string> status_parts(const PanelInput& input) {
    if (!input.state.has_scene()) return {input.captured, "No model"};
    const DebugView view = input.state.debug().view;
    return {input.captured, activity(input),
            counted(triangle_count(input.state.scene()), "triangle"),
            fmt::format("{} x {} pixels", input.state.view().x, input.state.view().y),
            view == DebugView::picture ? "" : fmt::format("Shows {}", debug_view_info(view).name)};
}

/// Figures for the tooltip of the status line.
std::string status_details(const PanelInput& input) {
    if (input.drawn.frames == 0) return fmt::format("Drawn by {}", input.renderer);
    return fmt::format("{:.1f} ms for the last of {}\nDrawn by {}", input.drawn.times.draw,
                       counted(input.drawn.frames, "picture"), input.renderer);
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
    Panel{"Contents", "Materials", false, draw_material_panel},
    Panel{"Contents", "Environment", false, draw_environment_panel},
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

/// A menu entry with the description and key of a shortcut.
void draw_entry(Action action, PanelRequests& requests) {
    const auto& all = shortcuts();
    const auto found = std::find_if(all.begin(), all.end(), [&](const Shortcut& shortcut) {
        return shortcut.action == action;
    });
    const std::string text(found->description);
    if (ImGui::MenuItem(text.c_str(), std::string(found->key).c_str()))
        requests.actions.push_back(action);
    probe_item(text);
}

void draw_menu(const char* name, std::span<const Action> entries, PanelRequests& requests) {
    if (ImGui::Button(name)) ImGui::OpenPopup(name);
    probe_item(name);
    if (!ImGui::BeginPopup(name)) return;
    for (const Action action : entries)
        draw_entry(action, requests);
    ImGui::EndPopup();
}

constexpr std::array save_entries{Action::save_picture, Action::save_scene, Action::save_model};
constexpr std::array edit_entries{Action::undo, Action::redo, Action::copy_camera,
                                  Action::paste_camera};
constexpr std::array view_entries{Action::fit,    Action::front,     Action::back,
                                  Action::right,  Action::left,      Action::top,
                                  Action::bottom, Action::next_file, Action::previous_file,
                                  Action::theme,  Action::larger_ui, Action::smaller_ui};

/// The button of the toolbar that starts motion.
struct MotionButton {
    const char* name;
    Action action;
    const char* tooltip;
};
MotionButton motion_button(const ViewerState& state) {
    if (!state.has_scene() || !state.playback().has_motion())
        return {"Turn", Action::turntable, "Start or stop the turntable (Space)"};
    return {state.playback().is_playing() ? "Pause##toolbar" : "Play##toolbar", Action::play,
            "Play or pause the animation (P)"};
}

void draw_button(const char* name, Action action, const char* tooltip, PanelRequests& requests) {
    if (ImGui::Button(name)) requests.actions.push_back(action);
    probe_item(name);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", tooltip);
}

/// Draws all buttons beside each other.
void draw_wide_toolbar(const ViewerState& state, PanelRequests& requests) {
    draw_button("Open...", Action::open, "Open a model or a scene (Ctrl+O)", requests);
    ImGui::SameLine();
    draw_menu("Save as", save_entries, requests);
    ImGui::SameLine();
    draw_menu("Edit", edit_entries, requests);
    ImGui::SameLine();
    draw_menu("Views", view_entries, requests);
    ImGui::SameLine();
    const MotionButton motion = motion_button(state);
    draw_button(motion.name, motion.action, motion.tooltip, requests);
    ImGui::SameLine();
    draw_button("Help", Action::help, "Show all shortcuts (F1)", requests);
}

/// Draws one menu instead of all buttons.
void draw_narrow_toolbar(const ViewerState& state, PanelRequests& requests) {
    if (ImGui::Button("Menu")) ImGui::OpenPopup("all");
    probe_item("Menu");
    if (!ImGui::BeginPopup("all")) return;
    draw_entry(Action::open, requests);
    for (const Action action : save_entries)
        draw_entry(action, requests);
    ImGui::Separator();
    for (const Action action : edit_entries)
        draw_entry(action, requests);
    ImGui::Separator();
    draw_entry(motion_button(state).action, requests);
    for (const Action action : view_entries)
        draw_entry(action, requests);
    ImGui::Separator();
    draw_entry(Action::help, requests);
    ImGui::EndPopup();
}

/// The width of the buttons of the wide toolbar, with that of folded panels.
float wide_toolbar_width(const ViewerState& state) {
    const ImGuiStyle& style = ImGui::GetStyle();
    float width = 2.0F * style.WindowPadding.x - style.ItemSpacing.x;
    for (const char* name :
         {"Panels", "Open...", "Save as", "Edit", "Views", motion_button(state).name, "Help"}) {
        width += ImGui::CalcTextSize(name, nullptr, true).x + 2.0F * style.FramePadding.x +
                 style.ItemSpacing.x;
    }
    return width;
}

/// Draws the buttons above the panels, or above the picture. \return the size in window units
glm::vec2 draw_toolbar(const ViewerState& state, const PanelArrangement& place, bool are_open,
                       PanelRequests& requests) {
    const ImGuiStyle& style = ImGui::GetStyle();
    const float height = ImGui::GetFrameHeight() + 2.0F * style.WindowPadding.y;
    const bool is_wide = wide_toolbar_width(state) <= ImGui::GetIO().DisplaySize.x;
    ImGuiWindowFlags flags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove;
    if (place.is_folded) flags |= ImGuiWindowFlags_AlwaysAutoResize;
    ImGui::SetNextWindowPos({0, 0});
    if (!place.is_folded) ImGui::SetNextWindowSize({place.width, height});
    ImGui::Begin("Toolbar", nullptr, flags);
    if (place.is_folded) {
        draw_button("Panels", Action::panels,
                    are_open ? "Fold the panels (Tab)" : "Show the panels (Tab)", requests);
        ImGui::SameLine();
    }
    is_wide ? draw_wide_toolbar(state, requests) : draw_narrow_toolbar(state, requests);
    const ImVec2 size = ImGui::GetWindowSize();
    ImGui::End();
    return {size.x, size.y};
}

}  // namespace

std::vector<std::string> panel_names() {
    std::vector<std::string> names;
    for (const Panel& panel : all_panels)
        names.emplace_back(panel.name);
    return names;
}

PanelArrangement arrange_panels(const glm::vec2& window, float letter) {
    // In line heights. The toolbar fits into the narrowest column.
    constexpr float narrowest = 23.0F;
    constexpr float widest = 27.0F;
    constexpr float share = 0.45F;  // Of the window, for panels beside the picture.
    constexpr float portrait = 1.2F;
    PanelArrangement place;
    place.is_folded = window.x * 0.5F < narrowest * letter;
    place.width =
        std::clamp(share * window.x, narrowest * letter, std::max(widest, narrowest) * letter);
    if (!place.is_folded) return place;
    place.is_below = window.y > portrait * window.x;
    if (place.is_below) {
        place.width = window.x;
        place.height = share * window.y;
    } else {
        place.width = std::min(narrowest * letter, 0.6F * window.x);
    }
    return place;
}

PanelSpace draw_panels(const PanelInput& input, bool are_open, PanelRequests& requests) {
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    const PanelArrangement place = arrange_panels({window.x, window.y}, ImGui::GetFontSize());
    const float bottom = window.y - ImGui::GetFrameHeightWithSpacing();
    PanelSpace space;
    const glm::vec2 toolbar = draw_toolbar(input.state, place, are_open, requests);
    if (place.is_folded) space.toolbar = toolbar;
    if (place.is_folded && !are_open) return space;
    (place.is_below ? space.bottom : space.left) = place.is_below ? place.height : place.width;
    const float top = place.is_below ? bottom - place.height : toolbar.y;
    ImGui::SetNextWindowPos({0, top});
    ImGui::SetNextWindowSize({place.width, bottom - top});
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
    return space;
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
    // Narrow windows show the clips, or the speed, too, below.
    const bool has_clips = now.clips().size() > 1;
    const bool is_speed_below = width < 21.0F * letter;
    const bool is_narrow = is_speed_below || (has_clips && width < 32.0F * letter);
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
    float others = 0.0F;  // The width of the lists on the same line.
    if (!is_speed_below) {
        others =
            (clips_are_beside ? 13.0F : 5.0F) * letter + 3.0F * ImGui::GetStyle().ItemSpacing.x;
    }
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
    if (!is_speed_below) ImGui::SameLine();
    choose_speed(state);
    if (clips_are_beside || is_speed_below) ImGui::SameLine();
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
        draw_progress("Drawing", input.progress);
        ImGui::SameLine();
        if (ImGui::SmallButton("Cancel")) requests.cancel_loading = true;
        probe_item("Cancel");
    } else if (!error.empty()) {
        if (input.drawn.is_cancelled) {
            if (ImGui::SmallButton("Draw it")) requests.redraw = true;
            probe_item("Draw it");
            ImGui::SameLine();
        }
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
        probe_item("status");
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", status_details(input).c_str());
    }
    ImGui::End();
    ImGui::PopStyleVar();
}

}  // namespace relief::tools
