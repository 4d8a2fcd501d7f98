// SPDX-License-Identifier: Apache-2.0
/// \file
/// Dear ImGui in a window, and hands on the picture behind it: drags, wheel, keys, dropped files.
/// Tests: tests/tools/window/window_test.cpp.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "window/compare_view.h"
#include "window/interface_scale.h"
#include "window/panels.h"
#include "window/window_system.h"

namespace relief::tools {

class UserInterface {
  public:
    explicit UserInterface(const WindowSystem& system);
    ~UserInterface();
    UserInterface(const UserInterface&) = delete;
    UserInterface& operator=(const UserInterface&) = delete;

    /// What came in since the last frame, beside what went into the state.
    struct Events {
        std::vector<Action> actions;  ///< In the order of their keys.
        std::vector<std::filesystem::path> dropped;
        PanelWishes panels;
        bool has_input = false;  ///< A key, the mouse or a drop: Dear ImGui needs frames to react.
    };

    /// One frame: panels, picture, hands. The view's size goes into the state.
    Events draw(const PanelInput& input, const Handover::Shown& picture);

    void show_help() { is_help_open_ = !is_help_open_; }
    [[nodiscard]] bool is_help_open() const { return is_help_open_; }

    /// Keys go into a field, and do nothing else.
    [[nodiscard]] static bool is_typing();
    /// Where the pointer is, in pixels of the window; none if it is outside or unknown.
    [[nodiscard]] static std::optional<glm::ivec2> pointer();

    /// Letters and panels become so large before the next frame.
    void set_scale(const InterfaceScale& scale) { wanted_scale_ = scale; }
    [[nodiscard]] const InterfaceScale& scale() const { return scale_; }

    // From GLFW, as it happens: two events between frames are still two.
    void on_key(int key, int modifiers, bool is_held);
    void on_button(int button, bool is_down, int modifiers);
    void on_move(const glm::vec2& place);
    void on_wheel(const glm::vec2& steps, bool has_shift);
    void on_drop(const std::filesystem::path& file) { dropped_.push_back(file); }
    void on_input() { has_input_ = true; }

  private:
    enum class Drag { none, orbit, pan, zoom, lights, aim, line };

    /// What hands did to the picture, in pixels.
    struct Move {
        Drag drag = Drag::none;  ///< None: the wheel; aim: a double click.
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
    void draw_view(const PanelInput& input, const Handover::Shown& picture, const ViewPlace& place);

    const WindowSystem& system_;
    std::vector<std::filesystem::path> dropped_;
    bool has_input_ = false;
    std::vector<Action> pressed_;
    std::vector<Move> moves_;
    Drag drag_ = Drag::none;
    glm::vec2 pointer_{0.0F};   ///< In the window's units.
    glm::vec2 clicked_{-1e6F};  ///< Where and when a button last went down.
    double clicked_at_ = -1e9;
    bool is_help_open_ = false;
    InterfaceScale scale_{.layout = 0.0F, .glyphs = 0.0F};  ///< None yet.
    InterfaceScale wanted_scale_;
    std::optional<float> line_;  ///< Between two pictures; in the interface's units.
    float left_ = 0.0F;          ///< Of the picture, in the interface's units.
    float bottom_ = 0.0F;        ///< What is below it.
};

}  // namespace relief::tools
