// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/window_test.cpp.
#include "window/window_system.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <glm/glm.hpp>

#include "common/command.h"

namespace relief::tools {
namespace {

/// What GLFW said last.
std::string& complaint() {
    static std::string text;
    return text;
}

[[noreturn]] void fail(const std::string& problem) {
    const std::string said = complaint().empty() ? "" : fmt::format(": {}", complaint());
    throw WindowError(problem + said);
}

constexpr glm::ivec2 usual_size{1280, 800};

ScreenArea area_of(GLFWmonitor* monitor) {
    ScreenArea area;
    if (monitor != nullptr) {
        glfwGetMonitorWorkarea(monitor, &area.corner.x, &area.corner.y, &area.size.x, &area.size.y);
    }
    return area;
}

/// Of the monitor that a place is on; the first one's where it is on none.
ScreenArea area_around(const std::optional<glm::ivec2>& place) {
    int count = 0;
    GLFWmonitor** const monitors = glfwGetMonitors(&count);
    for (int i = 0; place && i < count; ++i) {
        const ScreenArea area = area_of(monitors[i]);
        const glm::ivec2 end = area.corner + area.size;
        if (place->x >= area.corner.x && place->y >= area.corner.y && place->x < end.x &&
            place->y < end.y)
            return area;
    }
    return area_of(glfwGetPrimaryMonitor());
}

}  // namespace

WindowSystem::WindowSystem(const std::string& title, const WindowLayout& layout) {
    glfwSetErrorCallback([](int, const char* text) { complaint() = text; });
    if (glfwInit() != GLFW_TRUE) fail("no window can be opened");
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    const WindowLayout fitting = within(layout, area_around(layout.position));
    // A size that was remembered is one of this screen already.
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, fitting.size ? GLFW_FALSE : GLFW_TRUE);
    glfwWindowHint(GLFW_MAXIMIZED, fitting.is_maximized ? GLFW_TRUE : GLFW_FALSE);
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    glfwWindowHint(GLFW_DEPTH_BITS, 0);
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
    const WindowLayout usual = within({.size = usual_size}, area_around(std::nullopt));
    const glm::ivec2 size = fitting.size.value_or(*usual.size);
    window_ = glfwCreateWindow(size.x, size.y, title.c_str(), nullptr, nullptr);
    if (window_ != nullptr) {
        glfwWindowHint(GLFW_MAXIMIZED, GLFW_FALSE);
        worker_ = glfwCreateWindow(16, 16, "relief-view, drawing", nullptr, window_);
    }
    if (worker_ == nullptr) {
        glfwTerminate();
        fail("no window with OpenGL 3.3 can be opened");
    }
    if (fitting.position) glfwSetWindowPos(window_, fitting.position->x, fitting.position->y);
    glfwShowWindow(window_);
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
}

WindowSystem::~WindowSystem() {
    glfwTerminate();
}

void WindowSystem::use_worker_context() const {
    glfwMakeContextCurrent(worker_);
}

void WindowSystem::release_worker_context() const {
    glfwMakeContextCurrent(nullptr);
}

GlLoader WindowSystem::loader() {
    return glfwGetProcAddress;
}

void WindowSystem::wake() {
    glfwPostEmptyEvent();
}

void WindowSystem::wait(double seconds) {
    if (seconds > 0.0) {
        glfwWaitEventsTimeout(seconds);
    } else {
        glfwWaitEvents();
    }
}

float WindowSystem::content_scale() const {
    float x = 1.0F, y = 1.0F;
    glfwGetWindowContentScale(window_, &x, &y);
    return x;
}

float WindowSystem::pixels_to_unit() const {
    glm::ivec2 pixels(0), units(0);
    glfwGetFramebufferSize(window_, &pixels.x, &pixels.y);
    glfwGetWindowSize(window_, &units.x, &units.y);
    return pixels.x > 0 && units.x > 0 ? static_cast<float>(pixels.x) / static_cast<float>(units.x)
                                       : 1.0F;
}

void WindowSystem::note_place(WindowLayout& layout) const {
    layout.is_maximized = glfwGetWindowAttrib(window_, GLFW_MAXIMIZED) == GLFW_TRUE;
    if (layout.is_maximized || !is_visible()) return;
    glm::ivec2 size(0), position(0);
    glfwGetWindowSize(window_, &size.x, &size.y);
    glfwGetWindowPos(window_, &position.x, &position.y);
    layout.size = size;
    layout.position = position;
}

bool WindowSystem::is_closing() const {
    return glfwWindowShouldClose(window_) == GLFW_TRUE;
}

bool WindowSystem::is_visible() const {
    return glfwGetWindowAttrib(window_, GLFW_ICONIFIED) == GLFW_FALSE;
}

void WindowSystem::close() const {
    glfwSetWindowShouldClose(window_, GLFW_TRUE);
}

void WindowSystem::grow(const glm::ivec2& pixels) const {
    glm::ivec2 size(0);
    glfwGetWindowSize(window_, &size.x, &size.y);
    const glm::ivec2 larger = size + glm::ivec2(glm::round(glm::vec2(pixels) / pixels_to_unit()));
    glfwSetWindowSize(window_, std::max(larger.x, 1), std::max(larger.y, 1));
}

void WindowSystem::swap() const {
    glfwSwapBuffers(window_);
}

void WindowSystem::set_title(const std::string& title) const {
    glfwSetWindowTitle(window_, title.c_str());
}

}  // namespace relief::tools
