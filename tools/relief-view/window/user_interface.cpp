// SPDX-License-Identifier: Apache-2.0
// Draws a frame of the user interface, and turns keys, mouse gestures and drops into actions.
// Tests: tests/tools/window/window_test.cpp, user_interface_test.cpp.
#define GLFW_INCLUDE_NONE
#include "window/user_interface.h"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include "window/comparison.h"
#include "window/controls.h"
#include "window/interface_style.h"
#include "window/orbit_camera.h"
#include "window/viewer_state.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

constexpr ImU32 line_color = IM_COL32(255, 255, 255, 255);
constexpr ImU32 label_color = IM_COL32(255, 255, 255, 255);
constexpr ImU32 label_back = IM_COL32(20, 22, 26, 200);
constexpr float label_margin = 8.0F;
constexpr float label_padding = 4.0F;

ImVec2 vec(const glm::vec2& v) {
    return {v.x, v.y};
}

/// Draws a range of columns of a picture, as fractions of the width.
void draw_part(unsigned texture, const ViewPlace& place, float from, float to) {
    if (!(from < to)) return;
    const float width = place.max.x - place.min.x;
    // Row 0 of the texture is at the bottom.
    ImGui::GetBackgroundDrawList()->AddImage(
        reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture)),
        {place.min.x + from * width, place.min.y}, {place.min.x + to * width, place.max.y},
        {from, 1.0F}, {to, 0.0F});
}

/// \param align  0: `place` is the left end; 1: `place` is the right end
void draw_label(const std::string& text, const glm::vec2& place, float align) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    const glm::vec2 min(std::round(place.x - align * size.x), place.y);
    const glm::vec2 max = min + glm::vec2(size.x, size.y);
    list.AddRectFilled(vec(min - label_padding), vec(max + label_padding), label_back);
    list.AddText(vec(min), label_color, text.c_str());
}

void draw_picture(const PictureExchange::Shown& picture, const ViewPlace& place) {
    draw_part(picture.texture, place, 0.0F, 1.0F);
}

float draw_sides(const PictureExchange::Shown& picture, const ViewPlace& place,
                 const Comparison& comparison) {
    const float width = place.max.x - place.min.x;
    // The line is on a whole pixel, so that both textures are sampled at texel centers.
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

void draw_difference(const PictureExchange::Shown& picture, const ViewPlace& place,
                     const Comparison& comparison) {
    draw_picture(picture, place);
    const std::string kind = comparison.shown() == ComparisonView::flip
                                 ? "perceived difference (FLIP)"
                                 : "largest channel difference";
    draw_label(kind + ": " + comparison.left_label() + " | " + comparison.right_label(),
               place.min + label_margin + label_padding, 0.0F);
}

/// Shows the most important gestures, until the mouse moves the picture for the first time.
void draw_hint(const ViewPlace& place) {
    const std::array<const char*, 4> gestures{"Drag: orbit", "Shift+drag: pan", "Wheel: zoom",
                                              "F1: all shortcuts"};
    std::string text = fmt::format("{}", fmt::join(gestures, "    "));
    ImVec2 size = ImGui::CalcTextSize(text.c_str());
    if (size.x + 2.0F * label_margin > place.max.x - place.min.x) {  // A narrow window.
        text = fmt::format("{}", fmt::join(gestures, "\n"));
        size = ImGui::CalcTextSize(text.c_str());
    }
    const float x = 0.5F * (place.min.x + place.max.x - size.x);
    draw_label(text, {x, place.max.y - 2.0F * ImGui::GetFontSize() - size.y}, 0.0F);
}

constexpr ImU32 backdrop = IM_COL32(24, 26, 30, 255);
constexpr double double_click_seconds = 0.35;
constexpr float double_click_reach = 6.0F;  // In window units.
constexpr float click_reach = 3.0F;         // A longer way is a drag.
constexpr float handle_reach = 11.0F;       // For axes and lights, at the interface scale 1.
constexpr float line_reach = 6.0F;          // For the line between two pictures.
constexpr float drag_zoom = 0.02F;          // Wheel steps per pixel of a right drag.
constexpr float wheel_pan = 40.0F;          // Window units per wheel step.

/// The GLFW code of a key name.
int key_code(std::string_view name) {
    static constexpr std::array<std::pair<std::string_view, int>, 12> named{{
        {"F1", GLFW_KEY_F1},
        {"?", GLFW_KEY_SLASH},
        {"PageDown", GLFW_KEY_PAGE_DOWN},
        {"PageUp", GLFW_KEY_PAGE_UP},
        {"Left", GLFW_KEY_LEFT},
        {"Right", GLFW_KEY_RIGHT},
        {"Up", GLFW_KEY_UP},
        {"Down", GLFW_KEY_DOWN},
        {"Space", GLFW_KEY_SPACE},
        {"Tab", GLFW_KEY_TAB},
        {"+", GLFW_KEY_KP_ADD},
        {"Escape", GLFW_KEY_ESCAPE},
    }};
    for (const auto& [known, code] : named) {
        if (known == name) return code;
    }
    return name.empty() ? GLFW_KEY_UNKNOWN : static_cast<int>(name.back());
}

/// Removes a prefix of a name, if it has it. \return whether it had it
bool takes_prefix(std::string_view& name, std::string_view prefix) {
    if (!name.starts_with(prefix)) return false;
    name.remove_prefix(prefix.size());
    return true;
}

/// Returns whether a shortcut names this key with these modifiers. Shift counts for letters with
/// Ctrl; other keys may need it on some keyboards.
bool is_named(std::string_view name, int key, int modifiers) {
    const bool needs_control = takes_prefix(name, "Ctrl+");
    const bool needs_shift = takes_prefix(name, "Shift+");
    const bool has_control = (modifiers & GLFW_MOD_CONTROL) != 0;
    const bool has_shift = (modifiers & GLFW_MOD_SHIFT) != 0;
    const bool shift_counts = has_control && key >= GLFW_KEY_A && key <= GLFW_KEY_Z;
    if (shift_counts && has_shift != needs_shift) return false;
    return has_control == needs_control && key == key_code(name);
}

/// The user interface of a window.
UserInterface& interface_of(GLFWwindow* window) {
    auto& interface = *static_cast<UserInterface*>(glfwGetWindowUserPointer(window));
    interface.on_input();
    return interface;
}

/// Dear ImGui installs its own callbacks later, which call these.
void install_callbacks(GLFWwindow* window) {
    glfwSetDropCallback(window, [](GLFWwindow* where, int count, const char** names) {
        for (int i = 0; i < count; ++i)
            interface_of(where).on_drop(names[i]);
    });
    glfwSetKeyCallback(window, [](GLFWwindow* where, int key, int, int action, int modifiers) {
        if (action != GLFW_RELEASE)
            interface_of(where).on_key(key, modifiers, action == GLFW_REPEAT);
    });
    glfwSetMouseButtonCallback(window, [](GLFWwindow* where, int button, int action, int mods) {
        interface_of(where).on_button(button, action == GLFW_PRESS, mods);
    });
    glfwSetCursorPosCallback(window, [](GLFWwindow* where, double x, double y) {
        interface_of(where).on_move(glm::vec2(x, y));
    });
    glfwSetScrollCallback(window, [](GLFWwindow* where, double x, double y) {
        const bool has_shift = glfwGetKey(where, GLFW_KEY_LEFT_SHIFT) == GLFW_PRESS ||
                               glfwGetKey(where, GLFW_KEY_RIGHT_SHIFT) == GLFW_PRESS;
        interface_of(where).on_wheel(glm::vec2(x, y), has_shift);
    });
}

/// Returns whether the action repeats while its key is held.
bool is_repeating(Action action) {
    switch (action) {
        case Action::narrow_fov:
        case Action::widen_fov:
        case Action::zoom_in:
        case Action::zoom_out:
        case Action::orbit_left:
        case Action::orbit_right:
        case Action::orbit_up:
        case Action::orbit_down:
        case Action::step_back:
        case Action::step_forward:
        case Action::undo:
        case Action::redo:
            return true;
        default:
            return false;
    }
}

glm::vec2 vec(const ImVec2& v) {
    return {v.x, v.y};
}

}  // namespace

UserInterface::UserInterface(const WindowSystem& system) : system_(system) {
    GLFWwindow* window = system.window();
    glfwSetWindowUserPointer(window, this);
    install_callbacks(window);
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    ImGui_ImplGlfw_InitForOpenGL(window, true);
    ImGui_ImplOpenGL3_Init("#version 330 core");
}

UserInterface::~UserInterface() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

void UserInterface::apply_scale() {
    if (scale_ == wanted_scale_ && has_light_theme_ == wants_light_theme_) return;
    scale_ = wanted_scale_;
    has_light_theme_ = wants_light_theme_;
    apply_interface_style(scale_, has_light_theme_);
    ImGui_ImplOpenGL3_DestroyFontsTexture();
    ImGui_ImplOpenGL3_CreateFontsTexture();
}

void UserInterface::toggle_panels(WindowLayout& layout) {
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    const bool is_folded = arrange_panels(vec(window), ImGui::GetFontSize()).is_folded;
    bool& is_on = is_folded && layout.has_panels ? are_folded_panels_open_ : layout.has_panels;
    is_on = !is_on;
}

bool UserInterface::is_typing() {
    return ImGui::GetIO().WantTextInput;
}

std::optional<glm::ivec2> UserInterface::pointer() {
    const ImVec2 position = ImGui::GetIO().MousePos;
    if (!ImGui::IsMousePosValid(&position)) return std::nullopt;
    return glm::ivec2(position.x, position.y);
}

void UserInterface::on_key(int key, int modifiers, bool is_held) {
    if (is_typing() || dialog_.is_open()) return;
    const bool has_control = (modifiers & GLFW_MOD_CONTROL) != 0;
    if (help_.is_open() && has_control && key == GLFW_KEY_F) help_.focus_search();
    if (help_.is_open() && key == GLFW_KEY_ESCAPE) return help_.close();
    for (const Shortcut& shortcut : shortcuts()) {
        if (is_named(shortcut.key, key, modifiers) && (!is_held || is_repeating(shortcut.action)))
            pressed_.push_back(shortcut.action);
    }
}

bool UserInterface::is_on_picture() const {
    int width = 0, height = 0;
    glfwGetWindowSize(system_.window(), &width, &height);
    const bool is_over = pointer_.x >= left_ && pointer_.x < static_cast<float>(width) &&
                         pointer_.y >= 0.0F && pointer_.y < static_cast<float>(height) - bottom_;
    const bool is_over_toolbar = pointer_.x < toolbar_.x && pointer_.y < toolbar_.y;
    return is_over && !covered_.contains(pointer_) && !is_over_toolbar && !help_.is_open() &&
           !ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup);
}

bool UserInterface::is_on_line() const {
    return line_ && std::abs(pointer_.x - *line_) <= line_reach;
}

/// Detects double clicks. A third click counts as a first one.
bool UserInterface::is_second_click() {
    const double now = glfwGetTime();
    const bool is_second = now - clicked_at_ < double_click_seconds &&
                           glm::distance(pointer_, clicked_) < double_click_reach;
    clicked_ = pointer_;
    clicked_at_ = is_second ? -1e9 : now;
    return is_second;
}

void UserInterface::on_button(int button, bool is_down, int modifiers) {
    has_drag_end_ |= !is_down;
    drag_ = Drag::none;
    has_release_ |= !is_down;
    if (!is_down && pressed_at_ && glm::distance(*pressed_at_, pointer_) < click_reach)
        released_ = pointer_;
    pressed_at_.reset();
    if (!is_down || !is_on_picture()) return;
    if (button == GLFW_MOUSE_BUTTON_LEFT && is_on_line()) {
        drag_ = Drag::line;
        return;
    }
    const Handle* const handle = handle_at(pointer_);
    if (button == GLFW_MOUSE_BUTTON_LEFT && modifiers == 0 && handle != nullptr) {
        if (handle->axis) return pressed_.push_back(*handle->axis);
        drag_ = Drag::light;
        dragged_light_ = handle->light;
        light_drag_.reset();
        moves_.push_back({Drag::light, {}, 0.0F, pointer_});
        return;
    }
    if (button == GLFW_MOUSE_BUTTON_LEFT && modifiers == 0) pressed_at_ = pointer_;
    if (button == GLFW_MOUSE_BUTTON_LEFT && modifiers == 0 && is_second_click())
        moves_.push_back({Drag::aim, {}, 0.0F, pointer_});
    if (button == GLFW_MOUSE_BUTTON_RIGHT) {
        drag_ = Drag::zoom;
        return;
    }
    const bool has_shift = (modifiers & GLFW_MOD_SHIFT) != 0;
    const bool has_control = (modifiers & GLFW_MOD_CONTROL) != 0;
    if (button == GLFW_MOUSE_BUTTON_MIDDLE)
        drag_ = Drag::pan;
    else if (has_control)
        drag_ = has_shift ? Drag::environment : Drag::lights;
    else
        drag_ = has_shift ? Drag::pan : Drag::orbit;
}

void UserInterface::on_move(const glm::vec2& place) {
    const glm::vec2 moved = place - pointer_;
    pointer_ = place;
    if (drag_ != Drag::none) moves_.push_back({drag_, moved, 0.0F, place});
}

/// The wheel zooms. With Shift it pans.
void UserInterface::on_wheel(const glm::vec2& steps, bool has_shift) {
    if (!is_on_picture()) return;
    if (has_shift) {
        moves_.push_back({Drag::pan, wheel_pan * steps, 0.0F, pointer_});
    } else {
        moves_.push_back({Drag::none, {}, steps.y, pointer_});
    }
}

/// The position relative to the center of the view, in halves of its height, y up.
glm::vec2 UserInterface::on_view(const glm::vec2& place, const ViewerState& state) const {
    const ImGuiIO& io = ImGui::GetIO();
    const glm::vec2 middle(0.5F * (left_ + io.DisplaySize.x), 0.5F * (io.DisplaySize.y - bottom_));
    const glm::vec2 offset = (place - middle) * vec(io.DisplayFramebufferScale);
    return glm::vec2(offset.x, -offset.y) /
           (0.5F * static_cast<float>(std::max(state.view().y, 1)));
}

/// The pixel of the picture at a place of the window; none beside the picture.
std::optional<glm::ivec2> UserInterface::pixel_at(const glm::vec2& place,
                                                  const ViewerState& state) const {
    const glm::vec2 offset = place - glm::vec2(left_, 0.0F);
    const glm::ivec2 pixel(glm::floor(offset * vec(ImGui::GetIO().DisplayFramebufferScale)));
    const bool is_inside = pixel.x >= 0 && pixel.y >= 0 && pixel.x < state.view().x &&
                           pixel.y < state.view().y && !covered_.contains(place);
    return is_inside ? std::optional(pixel) : std::nullopt;
}

void UserInterface::apply(const Move& move, ViewerState& state) {
    const ImGuiIO& io = ImGui::GetIO();
    const glm::vec2 scale = vec(io.DisplayFramebufferScale);
    const glm::vec2 moved = move.pixels * scale;
    const int height = state.view().y;
    if (move.drag == Drag::orbit) return orbit_by(state.camera(), moved, height);
    if (move.drag == Drag::pan) return pan_by(state.camera(), moved, height);
    if (move.drag == Drag::light) return drag_light(state, on_view(move.place, state));
    if (move.drag == Drag::lights) return state.orbit_lights(moved);
    if (move.drag == Drag::environment) return state.turn_environment(moved.x);
    if (move.drag == Drag::aim) return state.aim(on_view(move.place, state));
    const bool is_drag = move.drag == Drag::zoom;
    const glm::vec2 pointer = is_drag ? glm::vec2(0.0F) : on_view(move.place, state);
    zoom_by(state.camera(), is_drag ? -drag_zoom * moved.y : move.steps, pointer, state.sphere());
}

const UserInterface::Handle* UserInterface::handle_at(const glm::vec2& place) const {
    const float reach = handle_reach * scale_.layout;
    const Handle* nearest = nullptr;
    float smallest = reach;
    for (const Handle& handle : handles_) {
        const float distance = glm::distance(place, handle.place);
        if (distance > smallest) continue;
        smallest = distance;
        nearest = &handle;
    }
    return nearest;
}

void UserInterface::drag_light(ViewerState& state, const glm::vec2& pointer) {
    std::vector<LightRow> rows = state.light_rows();
    const auto row = std::find_if(rows.begin(), rows.end(),
                                  [&](const LightRow& one) { return one.id == dragged_light_; });
    if (row == rows.end()) return;
    const Camera camera = camera_of(state.camera(), state.sphere());
    if (!light_drag_) {  // The press, which moves nothing.
        light_drag_.emplace(row->light, camera, state.sphere(), pointer);
        return;
    }
    row->light = light_drag_->moved(row->light, camera, state.sphere(), pointer);
    state.set_light_rows(std::move(rows));
}

/// Draws the axes of the world in the upper right corner.
void UserInterface::draw_axes(const PanelInput& input, const ViewPlace& place) {
    const float unit = scale_.layout;
    const glm::vec2 size = place.max - place.min;
    constexpr float smallest_view = 160.0F;
    if (!input.layout.has_axes || !input.state.has_scene()) return;
    if (std::min(size.x, size.y) < smallest_view * unit) return;
    const float length = 30.0F * unit;
    const float radius = 8.0F * unit;
    const glm::vec2 center(place.max.x - 2.0F * length + 8.0F * unit,
                           place.min.y + 2.0F * length - 8.0F * unit +
                               (toolbar_.x + 4.0F * length > size.x ? toolbar_.y : 0.0F));
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    static constexpr std::array<ImU32, 3> colors{
        IM_COL32(228, 80, 80, 255), IM_COL32(120, 190, 60, 255), IM_COL32(80, 140, 240, 255)};
    const auto is_hovered = [&](Action action) {
        return pointed_ && pointed_->axis && *pointed_->axis == action;
    };
    for (const AxisEnd& end : axis_ends(input.state.camera())) {
        const glm::vec2 at = center + length * glm::vec2(end.direction.x, -end.direction.y);
        const bool is_positive = end.name[0] == '+';
        const ImU32 color = colors.at(static_cast<std::size_t>(end.name[1] - 'x'));
        const ImU32 dark = IM_COL32(24, 26, 30, 210);
        if (is_positive) list.AddLine(vec(center), vec(at), color, 2.0F * unit);
        list.AddCircleFilled(vec(at), radius, is_positive ? color : dark);
        list.AddCircle(vec(at), radius, is_hovered(end.action) ? label_color : color, 0,
                       is_hovered(end.action) ? 2.0F * unit : 1.5F * unit);
        if (is_positive || is_hovered(end.action)) {
            const std::string text(end.name + (is_positive ? 1 : 0));
            const ImVec2 extent = ImGui::CalcTextSize(text.c_str());
            list.AddText({at.x - 0.5F * extent.x, at.y - 0.5F * extent.y},
                         is_positive ? IM_COL32(10, 10, 10, 255) : label_color, text.c_str());
        }
        handles_.push_back({at, end.action, 0});
        probe_place(std::string("axis ") + end.name, at);
    }
}

/// Draws a handle for each light while the panel Lights or the light markers are open.
void UserInterface::draw_lights(const PanelInput& input, const ViewPlace& place) {
    ViewerState& state = input.state;
    const auto open = input.layout.open_panels.find("Lights");
    const bool has_panel =
        has_open_panels_ && open != input.layout.open_panels.end() && open->second;
    if (!state.has_scene() || (!has_panel && !state.has_light_markers())) return;
    const float unit = scale_.layout;
    const Camera camera = camera_of(state.camera(), state.sphere());
    const glm::vec2 middle = 0.5F * (place.min + place.max);
    const auto on_window = [&](const glm::vec2& on_view) {
        const float half = 0.5F * (place.max.y - place.min.y);
        return middle + half * glm::vec2(on_view.x, -on_view.y);
    };
    const auto center = projected(camera, state.sphere().center);
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    list.PushClipRect(vec(place.min), vec(place.max));
    const std::vector<LightRow> rows = state.light_rows();
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const auto on_view = projected(camera, handle_of(rows[i].light, state.sphere()));
        if (!on_view) continue;
        const glm::vec2 at = on_window(*on_view);
        const bool is_active = (drag_ == Drag::light && dragged_light_ == rows[i].id) ||
                               (pointed_ && pointed_->light == rows[i].id);
        const ImU32 color = is_active ? IM_COL32(255, 240, 160, 255) : IM_COL32(255, 205, 80, 255);
        const bool is_directional = type_of(rows[i].light) == LightType::directional;
        if (is_directional && center)
            list.AddLine(vec(at), vec(on_window(*center)), IM_COL32(255, 205, 80, 110), unit);
        list.AddCircleFilled(vec(at), 6.0F * unit, color);
        list.AddCircle(vec(at), 9.0F * unit, IM_COL32(20, 22, 26, 200), 0, 2.0F * unit);
        if (is_active) {
            draw_label(fmt::format("Light {}", i + 1),
                       at + glm::vec2(14.0F * unit, -0.5F * ImGui::GetFontSize()), 0.0F);
        }
        handles_.push_back({at, std::nullopt, rows[i].id});
        probe_place(fmt::format("light handle {}", i + 1), at);
    }
    list.PopClipRect();
    if (pointed_) ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
}

/// Draws one picture, two pictures, or their difference.
void UserInterface::draw_view(const PanelInput& input, const PictureExchange::Shown& picture,
                              const ViewPlace& place) {
    line_.reset();
    if (picture.texture == 0) return;
    if (input.drawn.is_difference) {
        draw_difference(picture, place, *input.comparison);
    } else if (picture.beside != 0) {
        line_ = draw_sides(picture, place, *input.comparison);
        const bool is_caught = drag_ == Drag::line || (is_on_line() && is_on_picture());
        if (is_caught) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    } else {
        draw_picture(picture, place);
    }
}

/// Draws the file dialog, and uses the file that was selected.
void UserInterface::draw_dialog(const PanelInput& input, Events& events) {
    using Kind = BrowseTarget::Kind;
    if (events.panels.browse) dialog_.open(std::move(*events.panels.browse));
    if (!dialog_.is_open()) return;
    const bool is_input = dialog_.request()->target.kind == Kind::input;
    const std::vector<std::string>& recent =
        is_input ? input.layout.recent_files : input.layout.recent_images;
    const std::optional<BrowseResult> selected =
        dialog_.draw(recent, input.previews, input.preview_texture);
    if (!selected) return;
    if (is_input) return events.dropped.push_back(selected->file);
    if (selected->target.kind == Kind::map) {
        input.state.set_map(selected->target.material, selected->target.slot, selected->file);
    } else {
        input.state.set_environment(selected->file);
    }
    if (input.state.error().empty()) remember_image(input.layout, selected->file);
}

UserInterface::Events UserInterface::draw(const PanelInput& input,
                                          const PictureExchange::Shown& picture) {
    ImGui_ImplOpenGL3_NewFrame();
    apply_scale();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    clear_ui_probe();
    Events events;
    events.dropped = std::exchange(dropped_, {});
    events.has_input = std::exchange(has_input_, false);
    // Moves of this frame come first.
    events.has_released = moves_.empty() && std::exchange(has_drag_end_, false);
    // Dear ImGui overlooks a release that is followed by another press in the same frame.
    if (std::exchange(has_release_, false) && moves_.empty()) input.state.end_edit_step();
    const PanelSpace space = input.layout.has_panels
                                 ? draw_panels(input, are_folded_panels_open_, events.panels)
                                 : PanelSpace{};
    left_ = space.left;
    has_open_panels_ = space.left > 0.0F || space.bottom > 0.0F;
    toolbar_ = space.toolbar;
    bottom_ = ImGui::GetFrameHeightWithSpacing() + space.bottom;
    bottom_ += draw_playback(input.state, left_, bottom_);
    draw_status(input, events.panels);
    help_.draw();
    draw_dialog(input, events);
    if (events.panels.open) events.dropped.push_back(*events.panels.open);
    input.layout.has_seen_hint |= !moves_.empty();

    const ImGuiIO& io = ImGui::GetIO();
    const glm::vec2 size(io.DisplaySize.x - left_, io.DisplaySize.y - bottom_);
    const glm::vec2 pixels = size * vec(io.DisplayFramebufferScale);
    input.state.set_view(glm::ivec2(glm::max(pixels, glm::vec2(1.0F))));
    // The background of transparent pictures; nothing else clears the window.
    ImGui::GetBackgroundDrawList()->AddRectFilled({0.0F, 0.0F}, io.DisplaySize, backdrop);
    const ViewPlace place{{left_, 0.0F}, {io.DisplaySize.x, io.DisplaySize.y - bottom_}};
    draw_view(input, picture, place);
    const Handle* const handle = is_on_picture() ? handle_at(pointer_) : nullptr;
    pointed_ = handle != nullptr ? std::optional(*handle) : std::nullopt;
    handles_.clear();
    if (picture.texture != 0) {
        draw_lights(input, place);
        draw_axes(input, place);
    } else {
        draw_waiting(input, place.min, place.max, events.panels);
    }
    if (picture.texture != 0 && !input.layout.has_seen_hint) draw_hint(place);
    events.pixel = pixel_at(pointer_, input.state);
    if (released_) events.clicked = pixel_at(*released_, input.state);
    released_.reset();
    covered_ = input.probe == nullptr
                   ? WindowArea{}
                   : input.probe->draw(place, input.thumbnails, input.thumbnail_texture);
    for (const Move& move : std::exchange(moves_, {})) {
        if (move.drag == Drag::line)
            input.comparison->set_split((move.place.x - left_) / std::max(size.x, 1.0F));
        else
            apply(move, input.state);
    }
    // The edits of one drag are one step.
    if (!ImGui::IsAnyItemActive() && !ImGui::IsAnyMouseDown()) input.state.end_edit_step();
    events.actions = std::exchange(pressed_, {});
    events.actions.insert(events.actions.end(), events.panels.actions.begin(),
                          events.panels.actions.end());
    ImGui::Render();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    system_.swap();
    return events;
}

}  // namespace relief::tools
