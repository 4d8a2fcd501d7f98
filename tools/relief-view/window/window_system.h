// SPDX-License-Identifier: Apache-2.0
/// \file
/// A window with an OpenGL context, and a second context that shares its textures, for a thread
/// that draws. The one home of GLFW. Tests: tests/tools/window/window_test.cpp.
#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <memory>
#include <string>

#include "relief/mesh/error.h"
#include "relief/shade/context.h"
#include "window/window_layout.h"

struct GLFWwindow;

namespace relief::tools {

/// No window: no display, or no driver for it. Exit code 1.
class WindowError : public Error {
  public:
    explicit WindowError(const std::string& problem)
        : Error(problem + " (pictures need no display: --output FILE.png)") {}
};

class WindowSystem {
  public:
    /// As it was, as far as the screen allows; else of the usual size, scaled as the screen wants.
    /// \throws WindowError saying what is missing (a display, a driver with OpenGL 3.3), and
    ///         that --output draws without either
    WindowSystem(const std::string& title, const WindowLayout& layout);
    ~WindowSystem();
    WindowSystem(const WindowSystem&) = delete;
    WindowSystem& operator=(const WindowSystem&) = delete;

    [[nodiscard]] GLFWwindow* window() const { return window_; }

    /// On the drawing thread: makes the second context current; to be given back there.
    void use_worker_context() const;
    void release_worker_context() const;
    static GlLoader loader();

    /// Lets wait() return, from any thread.
    static void wake();

    /// Until something happens, or so many seconds have passed; 0 or less: as long as it takes.
    static void wait(double seconds);

    /// How much larger than usual things are to be drawn, in pixels.
    [[nodiscard]] float content_scale() const;
    /// Pixels of one of the window's own units: more than 1 on the dense screens of some systems.
    [[nodiscard]] float pixels_to_unit() const;
    /// Size and place go into a layout; of a maximised window, those that it had before stay.
    void note_place(WindowLayout& layout) const;
    [[nodiscard]] bool is_closing() const;
    [[nodiscard]] bool is_visible() const;  ///< Not minimised.
    void close() const;
    /// Makes the window larger by so many pixels, or smaller; as far as the screen's manager lets
    /// it.
    void grow(const glm::ivec2& pixels) const;
    void swap() const;
    void set_title(const std::string& title) const;

  private:
    GLFWwindow* window_ = nullptr;
    GLFWwindow* worker_ = nullptr;
};

}  // namespace relief::tools
