// SPDX-License-Identifier: Apache-2.0
/// \file
/// The user interface of the window with Dear ImGui: panels, the picture behind them, keys, mouse
/// gestures and dropped files. Tests: tests/tools/window/window_test.cpp.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "relief/shade/renderer.h"
#include "window/panels.h"
#include "window/probe_panel.h"
#include "window/shortcuts.h"
#include "window/view_handles.h"
#include "window/window_system.h"

namespace relief::tools {

/// The rectangle of the view.
using ViewPlace = WindowArea;

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
        std::optional<glm::ivec2> pixel;    ///< Of the picture, under the pointer.
        std::optional<glm::ivec2> clicked;  ///< A pixel that was clicked without a drag.
        bool has_released = false;          ///< A drag on the picture has ended.
        bool has_input = false;  ///< A key, the mouse or a drop. Dear ImGui then needs more frames.
    };

    /// Draws one frame with panels and picture, and applies mouse gestures to the state.
    Events draw(const PanelInput& input, const shade::PictureExchange::Shown& picture);

    void show_help() { help_.toggle(); }
    /// Shows or hides the panels; in a small window, unfolds or folds them.
    void toggle_panels(WindowLayout& layout);
    [[nodiscard]] bool is_help_open() const { return help_.is_open(); }

    /// Returns whether a text field has the keyboard focus.
    [[nodiscard]] static bool is_typing();
    /// The pointer position in pixels, if the pointer is inside the window.
    [[nodiscard]] static std::optional<glm::ivec2> pointer();

    /// Sets the scale for the next frame.
    void set_scale(const UiScale& scale) { wanted_scale_ = scale; }
    /// Sets the theme for the next frame.
    void set_theme(bool is_light) { wants_light_theme_ = is_light; }
    void open_dialog(BrowseRequest request) { dialog_.open(std::move(request)); }
    [[nodiscard]] const UiScale& scale() const { return scale_; }

    // GLFW callbacks. Several events may arrive between two frames.
    void on_key(int key, int modifiers, bool is_held);
    void on_button(int button, bool is_down, int modifiers);
    void on_move(const glm::vec2& place);
    void on_wheel(const glm::vec2& steps, bool has_shift);
    void on_drop(const std::filesystem::path& file) { dropped_.push_back(file); }
    void on_input() { has_input_ = true; }

  private:
    enum class Drag { none, orbit, pan, zoom, lights, environment, aim, line, light };

    /// A mouse gesture on the picture, in pixels.
    struct Move {
        Drag drag = Drag::none;  ///< none: wheel; aim: double click.
        glm::vec2 pixels{0.0F};
        float steps = 0.0F;
        glm::vec2 place{0.0F};
    };

    /// A part of the picture that can be grabbed, in window units.
    struct Handle {
        glm::vec2 place{0.0F};
        std::optional<Action> axis;  ///< Looks along an axis.
        unsigned light = 0;          ///< LightRow::id; 0: none.
    };

    void apply_scale();
    void draw_dialog(const PanelInput& input, Events& events);
    void draw_axes(const PanelInput& input, const ViewPlace& place);
    void draw_lights(const PanelInput& input, const ViewPlace& place);
    void drag_light(ViewerState& state, const glm::vec2& pointer);
    [[nodiscard]] const Handle* handle_at(const glm::vec2& place) const;
    [[nodiscard]] bool is_on_picture() const;
    [[nodiscard]] bool is_second_click();
    [[nodiscard]] glm::vec2 on_view(const glm::vec2& place, const ViewerState& state) const;
    void apply(const Move& move, ViewerState& state);
    [[nodiscard]] bool is_on_line() const;
    [[nodiscard]] std::optional<glm::ivec2> pixel_at(const glm::vec2& place,
                                                     const ViewerState& state) const;
    void draw_view(const PanelInput& input, const shade::PictureExchange::Shown& picture,
                   const ViewPlace& place);

    const WindowSystem& system_;
    std::vector<std::filesystem::path> dropped_;
    bool has_input_ = false;
    bool has_release_ = false;  ///< Of a mouse button, since the last frame.
    bool has_drag_end_ = false;
    std::vector<Action> pressed_;
    std::vector<Move> moves_;
    Drag drag_ = Drag::none;
    glm::vec2 pointer_{0.0F};   ///< In window units.
    glm::vec2 clicked_{-1e6F};  ///< Position of the last click.
    double clicked_at_ = -1e9;
    std::optional<glm::vec2> pressed_at_;  ///< Where the left button went down on the picture.
    std::optional<glm::vec2> released_;    ///< Where it was released without a drag.
    WindowArea covered_;                   ///< The part of the picture under the probe's panel.
    HelpWindow help_;
    UiScale scale_{.layout = 0.0F, .glyphs = 0.0F};  ///< Not set yet.
    UiScale wanted_scale_;
    bool has_light_theme_ = false;
    bool wants_light_theme_ = false;
    FileDialog dialog_;
    std::vector<Handle> handles_;  ///< Those of the last frame.
    std::optional<Handle> pointed_;
    unsigned dragged_light_ = 0;  ///< The light of Drag::light.
    std::optional<LightDrag> light_drag_;
    std::optional<float> line_;  ///< The x of the line between two pictures, in interface units.
    float left_ = 0.0F;          ///< Left edge of the picture, in interface units.
    float bottom_ = 0.0F;        ///< Height of the area below the picture.
    glm::vec2 toolbar_{0.0F};    ///< The size of the toolbar above the picture, if it is there.
    bool are_folded_panels_open_ = false;
    bool has_open_panels_ = false;  ///< In the last frame.
};

}  // namespace relief::tools
