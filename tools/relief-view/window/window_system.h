// SPDX-License-Identifier: Apache-2.0
/// \file
/// The window and its place on the screen: GLFW with two OpenGL contexts, the saved layout, and the
/// scale of the user interface. Tests: tests/tools/window/window_layout_test.cpp.
#pragma once

#include <filesystem>
#include <functional>
#include <glm/vec2.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "relief/mesh/report.h"
#include "relief/shade/renderer.h"

struct GLFWwindow;

namespace relief::tools {

inline constexpr float min_ui_scale = 0.5F;
inline constexpr float max_ui_scale = 4.0F;

/// Scales for the layout and the glyphs of Dear ImGui.
struct UiScale {
    float layout = 1.0F;  ///< Scale of sizes in window units.
    /// Scale of glyphs in pixels. Glyphs stay sharp if a unit is several pixels.
    float glyphs = 1.0F;

    friend bool operator==(const UiScale&, const UiScale&) = default;
};

/// Scale of the user interface.
/// \param wanted  the scale from an option or key; if absent, the screen decides
/// \param content_scale  the scale that the screen asks for, in pixels
/// \param pixels_to_unit  pixels per window unit; always 1 on some systems
UiScale ui_scale_for(std::optional<float> wanted, float content_scale, float pixels_to_unit);

/// The next step up or down in 0.5, 0.75, 1, 1.25, 1.5, 1.75, 2, 2.5, 3, 3.5, 4.
float next_ui_scale(float scale, bool is_larger);

/// The part of the window state that is saved between sessions.
struct WindowLayout {
    std::optional<glm::ivec2> size = std::nullopt;      ///< In window units.
    std::optional<glm::ivec2> position = std::nullopt;  ///< If absent, the system chooses.
    bool is_maximized = false;
    bool has_panels = true;
    /// By panel name. Other panels use their default.
    std::map<std::string, bool> open_panels = {};
    std::optional<float> ui_scale = std::nullopt;  ///< If absent, the screen decides.
    bool has_light_theme = false;
    bool has_seen_hint = false;  ///< The window no longer shows the mouse gestures on the picture.
    bool has_axes = true;        ///< The axes are shown in the corner of the picture.
    /// Absolute paths of models and scenes, the last one first.
    std::vector<std::string> recent_files = {};
    /// The same of images: maps and environments.
    std::vector<std::string> recent_images = {};

    friend bool operator==(const WindowLayout&, const WindowLayout&) = default;
};

/// Moves a file to the front of the recent files, which are at most 10.
void remember_file(WindowLayout& layout, const std::filesystem::path& file);
/// The same for the recent images.
void remember_image(WindowLayout& layout, const std::filesystem::path& file);

/// A proportional font of the system, if there is one: DejaVu Sans.
std::optional<std::filesystem::path> interface_font();

/// The part of a screen that is free for windows.
struct ScreenArea {
    glm::ivec2 corner{0};
    glm::ivec2 size{0};
};

/// Shrinks and moves the window so that the screen contains it. Some systems report an area without
/// a size; then nothing changes.
WindowLayout fitted_to_screen(WindowLayout layout, const ScreenArea& screen);

/// $XDG_STATE_HOME/relief/relief-view.json, or ~/.local/state/relief/relief-view.json if the
/// variable is not set or not an absolute path. Empty if HOME is not set either.
std::optional<std::filesystem::path> default_layout_file();

/// A layout that is read once, and written when the window closes if it changed.
class SavedLayout {
  public:
    /// This layout is neither read nor written.
    SavedLayout() = default;

    /// Reads the layout. If the file does not exist, the layout is the default. If it is invalid,
    /// the layout is the default and note() reports the problem. A file of a newer version is never
    /// overwritten.
    explicit SavedLayout(std::filesystem::path file);

    [[nodiscard]] const WindowLayout& layout() const { return layout_; }
    /// Returns whether the layout is read from a file and written to it.
    [[nodiscard]] bool has_file() const { return file_.has_value(); }
    /// A message for the user; empty if there was no problem.
    [[nodiscard]] const std::string& note() const { return note_; }

    /// Writes the file and its folders, unless the layout is unchanged. The file is replaced by
    /// renaming.
    /// \return the error message, or an empty string
    std::string save(const WindowLayout& layout);

  private:
    std::optional<std::filesystem::path> file_;
    WindowLayout layout_;
    std::string note_;
};

/// A window cannot be opened: there is no display, or no driver for it. The exit code is 1.
class WindowError : public Error {
  public:
    explicit WindowError(const std::string& problem)
        : Error(problem + " (pictures need no display: --output FILE.png)") {}
};

/// A window with an OpenGL context, and a second context that shares its textures for a drawing
/// thread.
class WindowSystem {
  public:
    /// Opens the window with the saved layout, or else in the default size, scaled as the screen
    /// requires.
    /// \throws WindowError which names what is missing (a display, a driver with OpenGL 3.3) and
    ///                 the option --output, which needs neither
    WindowSystem(const std::string& title, const WindowLayout& layout);
    ~WindowSystem();
    WindowSystem(const WindowSystem&) = delete;
    WindowSystem& operator=(const WindowSystem&) = delete;

    [[nodiscard]] GLFWwindow* window() const { return window_; }

    /// Makes the second context current on the calling thread.
    void use_worker_context() const;
    void release_worker_context() const;
    static shade::GlLoader loader();

    /// Makes wait() return. Any thread may call it.
    static void wake();

    /// Waits for an event, at most for this time. 0 or less: without a limit.
    static void wait(double seconds);

    /// The scale that the screen asks for, in pixels.
    [[nodiscard]] float content_scale() const;
    /// Pixels per window unit: more than 1 on high-density screens of some systems.
    [[nodiscard]] float pixels_to_unit() const;
    /// Stores the size and position in a layout. If the window is maximized, the layout keeps the
    /// size and position from before.
    void store_geometry(WindowLayout& layout) const;
    [[nodiscard]] bool is_closing() const;
    [[nodiscard]] bool is_visible() const;  ///< The window is not minimized.
    void close() const;
    void hide() const;
    /// Changes the window's size by this many pixels, as far as the window manager permits.
    void grow(const glm::ivec2& pixels) const;
    void swap() const;
    void set_title(const std::string& title) const;

  private:
    GLFWwindow* window_ = nullptr;
    GLFWwindow* worker_ = nullptr;
};

}  // namespace relief::tools
