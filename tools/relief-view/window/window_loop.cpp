// SPDX-License-Identifier: Apache-2.0
// The window: the user interface with Dear ImGui, mouse gestures, keys, dropped files and the
// picture behind the panels, and the main loop, which draws when something has changed and sleeps
// otherwise. Tests: tests/tools/window/window_test.cpp.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <glm/vec2.hpp>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "command_line.h"
#include "common/command.h"
#include "common/text.h"
#include "file_replacement.h"
#include "files.h"
#include "light_options.h"
#include "view_command.h"
#include "window/background_jobs.h"
#include "window/capture.h"
#include "window/comparison.h"
#include "window/input_files.h"
#include "window/orbit_camera.h"
#include "window/panels.h"
#include "window/scene_accuracy.h"
#include "window/window_system.h"

namespace relief::tools {

/// The rectangle of the view, in the units of the user interface.
struct ViewPlace {
    glm::vec2 min{0.0F};
    glm::vec2 max{0.0F};
};

class UserInterface {
  public:
    explicit UserInterface(const WindowSystem& system);
    ~UserInterface();
    UserInterface(const UserInterface&) = delete;
    UserInterface& operator=(const UserInterface&) = delete;

    /// Events since the last frame that the window handles.
    struct Events {
        std::vector<Action> actions;  ///< In the order of the key presses.
        std::vector<std::filesystem::path> dropped;
        PanelRequests panels;
        bool has_input = false;  ///< A key, the mouse or a drop. Dear ImGui then needs more frames.
    };

    /// Draws one frame with panels and picture, and applies mouse gestures to the state.
    Events draw(const PanelInput& input, const PictureExchange::Shown& picture);

    void show_help() { is_help_open_ = !is_help_open_; }
    [[nodiscard]] bool is_help_open() const { return is_help_open_; }

    /// Returns whether a text field has the keyboard focus.
    [[nodiscard]] static bool is_typing();
    /// The pointer position in pixels, if the pointer is inside the window.
    [[nodiscard]] static std::optional<glm::ivec2> pointer();

    /// Sets the scale for the next frame.
    void set_scale(const UiScale& scale) { wanted_scale_ = scale; }
    /// Sets the theme for the next frame.
    void set_theme(bool is_light) { wants_light_theme_ = is_light; }
    void open_dialog(const std::filesystem::path& folder) { dialog_.open(folder); }
    [[nodiscard]] const UiScale& scale() const { return scale_; }

    // GLFW callbacks. Several events may arrive between two frames.
    void on_key(int key, int modifiers, bool is_held);
    void on_button(int button, bool is_down, int modifiers);
    void on_move(const glm::vec2& place);
    void on_wheel(const glm::vec2& steps, bool has_shift);
    void on_drop(const std::filesystem::path& file) { dropped_.push_back(file); }
    void on_input() { has_input_ = true; }

  private:
    enum class Drag { none, orbit, pan, zoom, lights, environment, aim, line };

    /// A mouse gesture on the picture, in pixels.
    struct Move {
        Drag drag = Drag::none;  ///< none: wheel; aim: double click.
        glm::vec2 pixels{0.0F};
        float steps = 0.0F;
        glm::vec2 place{0.0F};
    };

    void apply_scale();
    [[nodiscard]] bool is_on_picture() const;
    [[nodiscard]] bool is_second_click();
    [[nodiscard]] glm::vec2 on_view(const glm::vec2& place, const ViewerState& state) const;
    void apply(const Move& move, ViewerState& state) const;
    [[nodiscard]] bool is_on_line() const;
    void draw_view(const PanelInput& input, const PictureExchange::Shown& picture,
                   const ViewPlace& place);

    const WindowSystem& system_;
    std::vector<std::filesystem::path> dropped_;
    bool has_input_ = false;
    bool has_release_ = false;  ///< Of a mouse button, since the last frame.
    std::vector<Action> pressed_;
    std::vector<Move> moves_;
    Drag drag_ = Drag::none;
    glm::vec2 pointer_{0.0F};   ///< In window units.
    glm::vec2 clicked_{-1e6F};  ///< Position of the last click.
    double clicked_at_ = -1e9;
    bool is_help_open_ = false;
    UiScale scale_{.layout = 0.0F, .glyphs = 0.0F};  ///< Not set yet.
    UiScale wanted_scale_;
    bool has_light_theme_ = false;
    bool wants_light_theme_ = false;
    FileDialog dialog_;
    std::optional<float> line_;  ///< The x of the line between two pictures, in interface units.
    float left_ = 0.0F;          ///< Left edge of the picture, in interface units.
    float bottom_ = 0.0F;        ///< Height of the area below the picture.
};

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
    // The number of a slider shows through its handle.
    style.Colors[ImGuiCol_SliderGrab] = ImVec4(accent.x, accent.y, accent.z, 0.45F);
    style.Colors[ImGuiCol_SliderGrabActive] = ImVec4(accent.x, accent.y, accent.z, 0.7F);
    return style;
}

constexpr ImU32 backdrop = IM_COL32(24, 26, 30, 255);
constexpr double double_click_seconds = 0.35;
constexpr float double_click_reach = 6.0F;  // In window units.
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

/// Glyphs are rasterized again in pixels. Other sizes are in window units.
void UserInterface::apply_scale() {
    if (scale_ == wanted_scale_ && has_light_theme_ == wants_light_theme_) return;
    scale_ = wanted_scale_;
    has_light_theme_ = wants_light_theme_;
    ImGuiIO& io = ImGui::GetIO();
    io.Fonts->Clear();
    if (const std::optional<std::filesystem::path> file = interface_font()) {
        io.Fonts->AddFontFromFileTTF(file->c_str(), std::round(14.0F * scale_.glyphs), nullptr,
                                     font_glyphs.data());
    } else {
        ImFontConfig font;
        font.SizePixels = std::round(13.0F * scale_.glyphs);
        io.Fonts->AddFontDefault(&font);
    }
    io.FontGlobalScale = scale_.layout / scale_.glyphs;
    ImGui::GetStyle() = style_of(has_light_theme_);
    ImGui::GetStyle().ScaleAllSizes(scale_.layout);
    ImGui_ImplOpenGL3_DestroyFontsTexture();
    ImGui_ImplOpenGL3_CreateFontsTexture();
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
    if (key == GLFW_KEY_ESCAPE) is_help_open_ = false;
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
    return is_over && !is_help_open_ && !ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup);
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
    drag_ = Drag::none;
    has_release_ |= !is_down;
    if (!is_down || !is_on_picture()) return;
    if (button == GLFW_MOUSE_BUTTON_LEFT && is_on_line()) {
        drag_ = Drag::line;
        return;
    }
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

void UserInterface::apply(const Move& move, ViewerState& state) const {
    const ImGuiIO& io = ImGui::GetIO();
    const glm::vec2 scale = vec(io.DisplayFramebufferScale);
    const glm::vec2 moved = move.pixels * scale;
    const int height = state.view().y;
    if (move.drag == Drag::orbit) return orbit_by(state.camera(), moved, height);
    if (move.drag == Drag::pan) return pan_by(state.camera(), moved, height);
    if (move.drag == Drag::lights) return state.orbit_lights(moved);
    if (move.drag == Drag::environment) return state.turn_environment(moved.x);
    if (move.drag == Drag::aim) return state.aim(on_view(move.place, state));
    const bool is_drag = move.drag == Drag::zoom;
    const glm::vec2 pointer = is_drag ? glm::vec2(0.0F) : on_view(move.place, state);
    zoom_by(state.camera(), is_drag ? -drag_zoom * moved.y : move.steps, pointer, state.sphere());
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
    // Dear ImGui overlooks a release that is followed by another press in the same frame.
    if (std::exchange(has_release_, false) && moves_.empty()) input.state.end_edit_step();
    left_ = input.layout.has_panels ? draw_panels(input, events.panels) : 0.0F;
    bottom_ = ImGui::GetFrameHeightWithSpacing();
    bottom_ += draw_playback(input.state, left_, bottom_);
    draw_status(input, events.panels);
    if (is_help_open_) draw_help(is_help_open_);
    if (const auto file = dialog_.draw(input.layout.recent_files)) events.dropped.push_back(*file);
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
    if (picture.texture != 0 && !input.layout.has_seen_hint) draw_hint(place);
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

// The main loop.

namespace {

constexpr int frames_to_settle = 3;  // Dear ImGui reacts to the previous frame.
constexpr double turning_step = 1.0 / 60.0;
constexpr double loading_step = 0.1;  // Seconds between progress updates.

/// {"stage", "part": 0 to 1, or null if it is unknown}
nlohmann::ordered_json json_of(const Progress::State& progress) {
    return {{"stage", progress.stage},
            {"part", progress.part ? nlohmann::ordered_json(*progress.part) : nullptr}};
}

SavedLayout saved_layout(const ViewOptions& options) {
    const std::optional<std::filesystem::path> file = default_layout_file();
    return options.no_state || !file ? SavedLayout() : SavedLayout(*file);
}

class WindowLoop {
  public:
    explicit WindowLoop(const ViewOptions& options)
        : saved_layout_(saved_layout(options)),
          layout_(saved_layout_.layout()),
          system_("relief-view", layout_),
          drawer_({[this] { system_.use_worker_context(); },
                   [this] { system_.release_worker_context(); }, WindowSystem::loader(),
                   WindowSystem::wake}),
          loader_(WindowSystem::wake),
          health_(WindowSystem::wake),
          thumbnails_(WindowSystem::wake),
          files_(WindowSystem::wake),
          interface_(system_),
          state_(options),
          comparison_(options.compare, WindowSystem::wake),
          accuracy_(WindowSystem::wake),
          saving_(WindowSystem::wake),
          loading_options_(options),
          ui_scale_(options.ui_scale),
          state_file_(options.dump_state) {
        if (state_file_) enable_ui_probe();
        layout_.has_seen_hint |= !saved_layout_.has_file();
        if (options.size_given) requested_view_size_ = options.size;
        if (!options.model.empty()) loader_.start(loading_options_);
    }

    void run() {
        while (!system_.is_closing()) {
            const bool was_working = is_working();
            wait();
            take_results();
            state_.advance(seconds_since_last());
            accuracy_.follow(state_);
            comparison_.follow(state_);
            saving_.follow();
            // Tables find their column widths after the first frame with the results.
            if (was_working && !is_working()) pending_frames_ = frames_to_settle;
            if (system_.is_visible()) draw();
        }
        // A size from the command line is not stored.
        if (!state_.options().size_given) system_.store_geometry(layout_);
        if (const std::string problem = saved_layout_.save(layout_); !problem.empty())
            fmt::print(err(), "relief-view: warning: {}\n", printable(problem));
    }

  private:
    /// Collects the results of other threads.
    void take_results() {
        if (std::optional<Loaded> loaded = loader_.take()) {
            files_.follow(*loaded);
            if (loaded->error.empty() && !loaded->options.model.empty())
                remember_file(layout_, loaded->options.model);
            state_.take(std::move(*loaded));
            pending_frames_ = frames_to_settle;
        }
        if (std::optional<HealthRequest> request = state_.take_health_request())
            health_.start(std::move(*request));
        if (std::optional<HealthResult> found = health_.take()) state_.take(std::move(*found));
        if (std::optional<Image> picture = thumbnails_.take())
            drawer_.put_thumbnails(std::move(*picture));
        take_changes(files_.take());
    }

    /// Reloads changed files. The camera and the edits stay.
    void take_changes(const WatchedFiles::Changed& changed) {
        if (changed.scene || changed.attempt) {
            // A model that is still being read is read again.
            if (!loader_.is_loading() && !changed.attempt) loading_options_ = state_.options();
            loader_.start(loading_options_);
        }
        if (changed.picture) state_.refresh();
        if (changed.shaders) {
            drawer_.relink();
            requested_.reset();
            ++relinked_;
        }
    }

    /// Sleeps until there is work.
    void wait() {
        if (pending_frames_ > 0) {
            --pending_frames_;
            glfwPollEvents();
            return;
        }
        if (state_.is_turning()) {
            WindowSystem::wait(turning_step);
        } else if (is_full_resolution_pending_ && system_.is_visible()) {
            WindowSystem::wait(0.5 * AdaptiveResolution::idle_seconds);
        } else {
            WindowSystem::wait(is_working() ? loading_step : 0.0);
            if (!is_working()) pending_frames_ = frames_to_settle - 1;
        }
    }

    /// While work is in progress, the window draws frames to show it.
    bool is_working() {
        return loader_.is_loading() || drawer_.is_busy() || accuracy_.is_measuring() ||
               effect_times_.state().is_running || captured_->state().is_running() ||
               saving_.is_running();
    }

    double seconds_since_last() {
        const auto now = std::chrono::steady_clock::now();
        const double seconds = std::chrono::duration<double>(now - last_).count();
        last_ = now;
        return std::min(seconds, 0.1);  // Limits the motion after a pause.
    }

    void draw() {
        // This must come first: if the thread is idle now, drawn() is the newest picture.
        const bool was_busy = drawer_.is_busy();
        const RenderedPicture drawn = drawer_.drawn();
        files_.follow(drawn);
        if (drawn.frames > 0 && !is_reduced(drawn.settings))
            resolution_.set_full_time(drawn.times.draw);
        interface_.set_scale(scale());
        interface_.set_theme(layout_.has_light_theme);
        const PanelInput input{state_,
                               layout_,
                               drawn,
                               drawer_.renderer_name(),
                               loader_.seconds_so_far(),
                               loader_.is_loading() ? &loading_options_ : nullptr,
                               loader_.is_loading() ? loader_.progress() : drawer_.progress(),
                               was_busy || is_full_resolution_pending_,
                               &capture_settings_,
                               notice_.empty() ? saved_text() : notice_,
                               saved_layout_.note(),
                               effect_times_,
                               shaders_,
                               &comparison_,
                               &accuracy_,
                               &thumbnails_,
                               drawer_.thumbnails()};
        const UserInterface::Events events = interface_.draw(input, drawer_.shown());
        if (state_.has_scene()) thumbnails_.update(state_.scene());
        // Input may arrive while the panels settle after earlier input.
        if (events.has_input) pending_frames_ = frames_to_settle;
        if (events.panels.cancel_loading) loader_.cancel();
        for (const Action action : events.actions)
            act(action);
        if (const auto view = std::exchange(requested_view_size_, std::nullopt))
            system_.grow(*view - state_.view());
        measure(drawn, events.panels);
        use_variant(events.panels.material_variant);
        use_occlusion(events.panels.ambient_occlusion);
        handle_accuracy_requests(events.panels);
        if (events.panels.save_picture) save(0);
        if (events.panels.save_scene) saving_.save_scene(state_);
        if (events.panels.save_model) saving_.save_model(state_);
        if (events.panels.save_turn) save(capture_settings_.pictures);
        if (!events.dropped.empty()) drop(events.dropped);
        const bool is_busy = request_picture() || was_busy || is_full_resolution_pending_ ||
                             health_.is_running() || thumbnails_.is_running();
        write_state(drawn, is_busy || accuracy_.is_working() || comparison_.is_working() ||
                               saving_.is_running());
    }

    void act(Action action) {
        notice_.clear();
        state_.act(action);
        if (action == Action::help) interface_.show_help();
        if (action == Action::open) open();
        if (action == Action::next_file) open_neighbor(true);
        if (action == Action::previous_file) open_neighbor(false);
        if (action == Action::theme) layout_.has_light_theme = !layout_.has_light_theme;
        if (action == Action::panels) layout_.has_panels = !layout_.has_panels;
        if (action == Action::larger_ui) rescale(next_ui_scale(interface_.scale().glyphs, true));
        if (action == Action::smaller_ui) rescale(next_ui_scale(interface_.scale().glyphs, false));
        if (action == Action::reset_ui_scale) rescale(std::nullopt);
        if (action == Action::quit) system_.close();
        if (action == Action::save_picture) save(0);
        if (action == Action::save_scene) saving_.save_scene(state_);
        if (action == Action::save_model) saving_.save_model(state_);
        if (action == Action::copy_camera)
            glfwSetClipboardString(system_.window(), command_line().c_str());
        if (action == Action::compare) comparison_.toggle();
        if (action == Action::swap_sides) comparison_.swap();
        if (action == Action::show_difference) comparison_.toggle_difference();
        if (action == Action::paste_camera) paste();
    }

    /// Shows the file dialog with the folder of the model.
    void open() {
        const std::filesystem::path& model = loading_options_.model;
        std::error_code none;
        interface_.open_dialog(model.has_parent_path() ? model.parent_path()
                                                       : std::filesystem::current_path(none));
    }

    void open_neighbor(bool is_next) {
        const auto file = neighbor_of(loading_options_.model, is_next);
        if (file) return drop({*file});
        if (!loading_options_.model.empty()) notice_ = "There is no other model in the folder";
    }

    [[nodiscard]] std::string command_line() const {
        return state_.command_line() + comparison_.command_line();
    }

    void paste() {
        const char* text = glfwGetClipboardString(system_.window());
        state_.apply_view_text(text == nullptr ? "" : text);
    }

    /// A scale that is set in the window is saved. It replaces the option.
    void rescale(std::optional<float> scale) {
        ui_scale_.reset();
        layout_.ui_scale = scale;
    }
    [[nodiscard]] UiScale scale() const {
        return ui_scale_for(ui_scale_ ? ui_scale_ : layout_.ui_scale, system_.content_scale(),
                            system_.pixels_to_unit());
    }

    /// Returns whether two requests show the same picture, in any resolution.
    static bool is_same(const DrawRequest& a, const DrawRequest& b) {
        return a.revision == b.revision && a.pose == b.pose && a.camera == b.camera &&
               a.instead == b.instead && a.beside.has_value() == b.beside.has_value() &&
               (!a.beside || a.beside->revision == b.beside->revision) &&
               a.settings.width == b.settings.width && a.settings.height == b.settings.height;
    }

    [[nodiscard]] bool is_reduced(const FrameSettings& settings) const {
        return settings.width < state_.view().x || settings.height < state_.view().y ||
               settings.samples < state_.options().samples;
    }

    void drop(const std::vector<std::filesystem::path>& files) {
        read_with([&](const ViewOptions& options) { return with_dropped(options, files); });
    }

    /// Reads the model with changed options. Invalid options are reported like read errors.
    template <typename Change>
    void read_with(const Change& change) {
        try {
            // Changes apply to the model that is being read, if there is one.
            ViewOptions options =
                change(loader_.is_loading() ? loading_options_ : state_.options());
            options.debug = {};  // The window has its own debug settings.
            settle(options);
            loading_options_ = options;
            loader_.start(options);
        } catch (const std::exception& error) {
            Loaded refused;
            refused.error = error.what();
            state_.take(std::move(refused));
        }
    }

    /// Reads the model with the materials of a variant.
    void use_variant(const std::optional<std::string>& variant) {
        if (!variant) return;
        read_with([&](ViewOptions options) {
            options.material_variant = variant->empty() ? std::nullopt : variant;
            return options;
        });
    }

    /// Reads the model with another distance of ambient occlusion.
    void use_occlusion(const std::optional<float>& distance) {
        if (!distance) return;
        read_with([&](ViewOptions options) {
            set_occlusion(options, *distance);
            return options;
        });
    }

    /// Starts measurements, and applies the chosen method. A kernel is an option of the height map,
    /// so the model is read again.
    void handle_accuracy_requests(const PanelRequests& requests) {
        if (requests.measure_accuracy) accuracy_.measure(state_);
        if (requests.stop_accuracy) accuracy_.stop();
        if (!requests.use_method) return;
        if (const Kernel* kernel = std::get_if<Kernel>(&*requests.use_method)) {
            read_with([&](ViewOptions options) {
                options.kernel = *kernel;
                return options;
            });
        } else {
            accuracy_.use(*requests.use_method);
        }
    }

    /// Starts and stops the measurement of effect times, and discards outdated ones.
    void measure(const RenderedPicture& drawn, const PanelRequests& requests) {
        const std::optional<DrawRequest> request = state_.request();
        if (!request || requests.stop_measuring) return effect_times_.cancel();
        if (requests.measure_effects) drawer_.add(effect_times_.start(*request));
        if (drawn.plan && drawn.revision == request->revision)
            effect_times_.discard_unless_valid_for(*drawn.plan, *request);
    }

    /// Saves one picture or a turntable, unless pictures are being saved.
    void save(int turntable) {
        const std::optional<DrawRequest> request = state_.request();
        if (!request || captured_->state().is_running()) return;
        CaptureRequest capture{.scene = request->scene,
                               .effects = request->effects,
                               .settings = request->settings,
                               .camera = request->camera,
                               .transparent = capture_settings_.transparent,
                               .turntable = turntable,
                               .middle = state_.sphere().center,
                               .file = free_file(state_.options().model, turntable)};
        if (capture_settings_.custom_size) {
            capture.settings.width = capture_settings_.width;
            capture.settings.height = capture_settings_.height;
        }
        drawer_.add(capture_task(std::move(capture), captured_));
    }

    /// The message about the last saved files.
    [[nodiscard]] std::string saved_text() const {
        const std::string pictures = text_of(captured_->state());
        return pictures.empty() || saving_.text().empty() ? pictures + saving_.text()
                                                          : pictures + "   " + saving_.text();
    }

    /// Requests a picture if it differs from the last request. \return whether it does
    bool request_picture() {
        std::optional<DrawRequest> request = state_.request();
        if (!request) return false;
        if (std::optional<DrawTask> task = comparison_.add_to(*request))
            drawer_.add(std::move(*task));
        const bool is_moved = !requested_ || !is_same(*requested_, *request);
        const double now = glfwGetTime();
        if (is_moved && requested_ && !request->instead) resolution_.note_motion(now);
        DrawRequest reduced = *request;
        reduced.settings = resolution_.settings_for(request->settings, now);
        is_full_resolution_pending_ = is_reduced(reduced.settings);
        const bool is_as_asked = requested_settings_.width == reduced.settings.width &&
                                 requested_settings_.height == reduced.settings.height &&
                                 requested_settings_.samples == reduced.settings.samples;
        if (!is_moved && is_as_asked) return false;
        if (is_full_resolution_pending_) ++reduced_;
        requested_ = request;
        requested_settings_ = reduced.settings;
        drawer_.request(std::move(reduced));
        return true;
    }

    /// Writes the state for tests and scripts (--dump-state).
    void write_state(const RenderedPicture& drawn, bool is_busy) {
        if (!state_file_) return;
        nlohmann::ordered_json state = state_.json(drawn);
        state["loading"] = loader_.is_loading();
        state["progress"] = loader_.is_loading() ? json_of(loader_.progress()) : nullptr;
        state["busy"] = is_busy;
        state["files"] = files_.count();
        state["relinked"] = relinked_;
        state["drawn"]["size"] = {drawn.settings.width, drawn.settings.height};
        state["drawn"]["samples"] = drawn.settings.samples;
        state["drawn"]["whole"] = !is_reduced(drawn.settings);
        state["reduced"] = reduced_;
        state["costs"] = json_of(effect_times_.state());
        state["command_line"] = command_line();
        state["compare"] = comparison_.json();
        state["accuracy"] = accuracy_.json(state_.options());
        state["drawn"]["beside"] = drawn.beside;
        state["drawn"]["difference"] = drawn.is_difference;
        state["saved"] = json_of(captured_->state());
        state["notice"] = notice_;
        state["saved_files"] = saving_.json();
        state["layout"] = {{"scale", interface_.scale().layout},
                           {"panels", panel_names()},
                           {"open", layout_.open_panels},
                           {"note", saved_layout_.note()}};
        state["typing"] = UserInterface::is_typing();
        const std::optional<glm::ivec2> pointer = UserInterface::pointer();
        state["pointer"] = pointer ? nlohmann::ordered_json{pointer->x, pointer->y} : nullptr;
        state["help"] = interface_.is_help_open();
        state["places"] = ui_probe_json();
        const std::string text = dumped(state);
        if (text == written_state_) return;
        written_state_ = text;
        replace_file(*state_file_, std::as_bytes(std::span(text)));
    }

    SavedLayout saved_layout_;
    WindowLayout layout_;
    WindowSystem system_;
    DrawThread drawer_;
    Loader loader_;
    HealthSearch health_;
    Thumbnails thumbnails_;
    WatchedFiles files_;
    UserInterface interface_;
    ViewerState state_;
    Comparison comparison_;
    SceneAccuracy accuracy_;
    Saving saving_;
    ViewOptions loading_options_;  ///< Options of the last read.
    /// The view size from the command line, until the first frame is drawn.
    std::optional<glm::ivec2> requested_view_size_;
    std::optional<float> ui_scale_;  ///< The scale from the command line, until another one is set.
    std::optional<std::filesystem::path> state_file_;
    std::string written_state_;
    CaptureSettings capture_settings_;
    std::shared_ptr<CaptureProgress> captured_ = std::make_shared<CaptureProgress>();
    EffectTimes effect_times_;
    ShaderPanel shaders_;
    std::optional<DrawRequest> requested_;
    AdaptiveResolution resolution_;
    FrameSettings requested_settings_;  ///< Settings of the last request.
    std::uint64_t reduced_ = 0;         ///< Number of requests with reduced resolution.
    std::uint64_t relinked_ = 0;        ///< How often the programs were linked again.
    bool is_full_resolution_pending_ =
        false;  ///< The picture at full resolution is still to be drawn.
    int pending_frames_ = frames_to_settle;
    std::string notice_;  ///< The status line shows it until the next action.
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace

ExitCode run_window(const ViewOptions& options) {
    WindowLoop(options).run();
    return ExitCode::done;
}

}  // namespace relief::tools
