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

}  // namespace

WindowSystem::WindowSystem(const std::string& title, const glm::ivec2& size) {
    glfwSetErrorCallback([](int, const char* text) { complaint() = text; });
    if (glfwInit() != GLFW_TRUE) fail("no window can be opened");
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    glfwWindowHint(GLFW_DEPTH_BITS, 0);
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
    window_ = glfwCreateWindow(size.x, size.y, title.c_str(), nullptr, nullptr);
    if (window_ != nullptr) {
        glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
        worker_ = glfwCreateWindow(16, 16, "relief-view, drawing", nullptr, window_);
    }
    if (worker_ == nullptr) {
        glfwTerminate();
        fail("no window with OpenGL 3.3 can be opened");
    }
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

glm::ivec2 WindowSystem::framebuffer_size() const {
    glm::ivec2 size(0);
    glfwGetFramebufferSize(window_, &size.x, &size.y);
    return size;
}

float WindowSystem::content_scale() const {
    float x = 1.0F, y = 1.0F;
    glfwGetWindowContentScale(window_, &x, &y);
    return x;
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
    const glm::dvec2 unit = glm::dvec2(size) / glm::dvec2(glm::max(framebuffer_size(), 1));
    const glm::ivec2 larger = size + glm::ivec2(glm::round(glm::dvec2(pixels) * unit));
    glfwSetWindowSize(window_, std::max(larger.x, 1), std::max(larger.y, 1));
}

void WindowSystem::swap() const {
    glfwSwapBuffers(window_);
}

void WindowSystem::set_title(const std::string& title) const {
    glfwSetWindowTitle(window_, title.c_str());
}

}  // namespace relief::tools
