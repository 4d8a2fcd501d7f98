// SPDX-License-Identifier: Apache-2.0
/// \file
/// Where the window is and how its panels stand: what is remembered from one time to the next, and
/// the file that remembers it. No window and no OpenGL.
/// Tests: tests/tools/window/window_layout_test.cpp.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <map>
#include <optional>
#include <string>

namespace relief::tools {

struct WindowLayout {
    std::optional<glm::ivec2> size =
        std::nullopt;  ///< In the window's units; absent: the usual one.
    std::optional<glm::ivec2> position = std::nullopt;  ///< Absent: as the system likes.
    bool is_maximized = false;
    bool has_panels = true;
    std::map<std::string, bool> open_panels = {};  ///< By name; one that is not there is as usual.
    std::optional<float> ui_scale = std::nullopt;  ///< Absent: as the screen says.

    friend bool operator==(const WindowLayout&, const WindowLayout&) = default;
};

/// The part of a screen that is free for windows.
struct ScreenArea {
    glm::ivec2 corner{0};
    glm::ivec2 size{0};
};

/// No larger than the screen, and all of it there: screens come and go. An area without a size, as
/// some systems report, changes nothing.
WindowLayout within(WindowLayout layout, const ScreenArea& screen);

/// $XDG_STATE_HOME/relief/relief-view.json, or ~/.local/state/relief/relief-view.json where that is
/// not set (or not absolute, as its specification wants); nothing where there is no home either.
std::optional<std::filesystem::path> usual_layout_file();

/// A layout that is read once and written when the window closes, if it became another one.
class RememberedLayout {
  public:
    /// Nothing is read or written.
    RememberedLayout() = default;

    /// A file that is absent is none; one that cannot be read, or says what cannot be, is as none,
    /// with a note; so is one of a later version, which is then left alone.
    explicit RememberedLayout(std::filesystem::path file);

    [[nodiscard]] const WindowLayout& layout() const { return layout_; }
    /// For the reader; empty: all is well.
    [[nodiscard]] const std::string& note() const { return note_; }

    /// Writes the file beside and renames it, with the folders that it needs, unless it is the same
    /// as was read. \return what went wrong; empty: nothing
    std::string remember(const WindowLayout& layout);

  private:
    std::optional<std::filesystem::path> file_;
    WindowLayout layout_;
    std::string note_;
};

}  // namespace relief::tools
