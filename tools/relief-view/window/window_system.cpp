// SPDX-License-Identifier: Apache-2.0
#include "window/window_system.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <glm/common.hpp>
#include <glm/glm.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "common/command.h"
#include "file_replacement.h"
#include "files.h"
#include "json_cursor.h"

namespace relief::tools {
using namespace relief::detail;

namespace {

constexpr std::array scale_steps{0.5F, 0.75F, 1.0F, 1.25F, 1.5F, 1.75F,
                                 2.0F, 2.5F,  3.0F, 3.5F,  4.0F};
static_assert(scale_steps.front() == min_ui_scale && scale_steps.back() == max_ui_scale);

/// Limits a scale to its range. Invalid scales become 1.
float clamped_scale(float scale) {
    if (!std::isfinite(scale) || scale <= 0.0F) return 1.0F;
    return std::clamp(scale, min_ui_scale, max_ui_scale);
}

}  // namespace

UiScale ui_scale_for(std::optional<float> wanted, float content_scale, float pixels_to_unit) {
    const float glyphs = clamped_scale(wanted.value_or(content_scale));
    const bool has_ratio = std::isfinite(pixels_to_unit) && pixels_to_unit > 0.0F;
    return {.layout = glyphs / (has_ratio ? pixels_to_unit : 1.0F), .glyphs = glyphs};
}

float next_ui_scale(float scale, bool is_larger) {
    if (is_larger) {
        const auto* const next = std::upper_bound(scale_steps.begin(), scale_steps.end(), scale);
        return next == scale_steps.end() ? scale_steps.back() : *next;
    }
    const auto* const next = std::lower_bound(scale_steps.begin(), scale_steps.end(), scale);
    return next == scale_steps.begin() ? scale_steps.front() : *(next - 1);
}

namespace {

using nlohmann::ordered_json;

constexpr int layout_version = 1;
constexpr int largest_window_side = 16384;
constexpr std::size_t max_recent_files = 10;
constexpr glm::ivec2 smallest{320, 240};

/// The file has a newer version. The file itself is valid.
class NewerVersion : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

int any_int(const JsonCursor& value) {
    return value.whole_number(std::numeric_limits<int>::min(), std::numeric_limits<int>::max());
}

glm::ivec2 pair_of(const JsonCursor& value) {
    const std::vector<JsonCursor> pair = value.elements();
    if (pair.size() != 2) value.fail("must be two numbers");
    const glm::ivec2 limit(largest_window_side);
    return glm::clamp(glm::ivec2(any_int(pair[0]), any_int(pair[1])), -limit, limit);
}

WindowLayout layout_of(const JsonCursor& document) {
    const int found = any_int(document.at("version"));
    if (found > layout_version) throw NewerVersion(fmt::format("of version {}", found));
    WindowLayout layout;
    if (const auto window = document.find("window")) {
        if (const auto size = window->find("size"))
            layout.size = glm::max(pair_of(*size), smallest);
        if (const auto position = window->find("position")) layout.position = pair_of(*position);
        if (const auto maximized = window->find("maximized"))
            layout.is_maximized = maximized->boolean();
    }
    if (const auto panels = document.find("panels")) {
        if (const auto shown = panels->find("shown")) layout.has_panels = shown->boolean();
        if (const auto open = panels->find("open")) {
            for (const auto& [name, is_open] : open->members())
                layout.open_panels[name] = is_open.boolean();
        }
    }
    if (const auto scale = document.find("scale"))
        layout.ui_scale = std::clamp(scale->number(), min_ui_scale, max_ui_scale);
    if (const auto theme = document.find("theme"))
        layout.has_light_theme = theme->text() == "light";
    if (const auto seen = document.find("hint_seen")) layout.has_seen_hint = seen->boolean();
    if (const auto axes = document.find("axes")) layout.has_axes = axes->boolean();
    const auto read_files = [&](const char* key, std::vector<std::string>& list) {
        const auto files = document.find(key);
        if (!files) return;
        for (const JsonCursor& file : files->elements()) {
            if (list.size() < max_recent_files) list.push_back(file.text());
        }
    };
    read_files("recent_files", layout.recent_files);
    read_files("recent_images", layout.recent_images);
    return layout;
}

/// \throws FileError if the file cannot be read or holds no layout, NewerVersion
WindowLayout read_layout(const std::filesystem::path& file) {
    try {
        return layout_of(JsonCursor::parse(read_file(file)));
    } catch (const InvalidInput& error) {
        throw FileError(file, error.what());
    }
}

ordered_json json_of(const WindowLayout& layout) {
    ordered_json window = ordered_json::object();
    if (layout.size) window["size"] = {layout.size->x, layout.size->y};
    if (layout.position) window["position"] = {layout.position->x, layout.position->y};
    window["maximized"] = layout.is_maximized;
    ordered_json document = {
        {"version", layout_version},
        {"window", std::move(window)},
        {"panels", {{"shown", layout.has_panels}, {"open", layout.open_panels}}}};
    if (layout.ui_scale) document["scale"] = *layout.ui_scale;
    if (layout.has_light_theme) document["theme"] = "light";
    document["hint_seen"] = layout.has_seen_hint;
    if (!layout.has_axes) document["axes"] = false;
    const auto write_files = [&](const char* key, const std::vector<std::string>& files) {
        document[key] = ordered_json::array();
        for (const std::string& file : files) {
            if (is_utf8(file)) document[key].push_back(file);  // JSON cannot hold other names.
        }
    };
    write_files("recent_files", layout.recent_files);
    if (!layout.recent_images.empty()) write_files("recent_images", layout.recent_images);
    return document;
}

/// The value of an environment variable, if it is an absolute path.
std::optional<std::filesystem::path> absolute_path_variable(const char* variable) {
    const char* text = std::getenv(variable);
    if (text == nullptr || !std::filesystem::path(text).is_absolute()) return std::nullopt;
    return text;
}

}  // namespace

namespace {

void remember(std::vector<std::string>& files, const std::filesystem::path& file) {
    std::error_code failed;
    const std::string path = std::filesystem::absolute(file, failed).lexically_normal().string();
    if (failed) return;
    std::erase(files, path);
    files.insert(files.begin(), path);
    if (files.size() > max_recent_files) files.resize(max_recent_files);
}

}  // namespace

void remember_file(WindowLayout& layout, const std::filesystem::path& file) {
    remember(layout.recent_files, file);
}

void remember_image(WindowLayout& layout, const std::filesystem::path& file) {
    remember(layout.recent_images, file);
}

std::optional<std::filesystem::path> interface_font() {
    for (const char* const folder :
         {"/usr/share/fonts/truetype/dejavu", "/usr/share/fonts/TTF", "/usr/share/fonts/dejavu",
          "/usr/share/fonts/dejavu-sans-fonts"}) {
        const std::filesystem::path file = std::filesystem::path(folder) / "DejaVuSans.ttf";
        std::error_code none;
        if (std::filesystem::is_regular_file(file, none)) return file;
    }
    return std::nullopt;
}

WindowLayout fitted_to_screen(WindowLayout layout, const ScreenArea& screen) {
    if (screen.size.x <= 0 || screen.size.y <= 0) return layout;
    if (layout.size) layout.size = glm::min(*layout.size, screen.size);
    if (layout.position) {
        const glm::ivec2 room = screen.size - layout.size.value_or(smallest);
        layout.position = glm::clamp(*layout.position, screen.corner,
                                     screen.corner + glm::max(room, glm::ivec2(0)));
    }
    return layout;
}

std::optional<std::filesystem::path> default_layout_file() {
    std::optional<std::filesystem::path> folder = absolute_path_variable("XDG_STATE_HOME");
    if (!folder) {
        folder = absolute_path_variable("HOME");
        if (!folder) return std::nullopt;
        *folder /= ".local/state";
    }
    return *folder / "relief" / "relief-view.json";
}

SavedLayout::SavedLayout(std::filesystem::path file) : file_(std::move(file)) {
    std::error_code none;
    if (!std::filesystem::exists(*file_, none)) return;
    try {
        layout_ = read_layout(*file_);
    } catch (const NewerVersion& later) {
        note_ = fmt::format(
            "{} is {}, and this program supports {}: the default layout is used and not saved",
            file_->string(), later.what(), layout_version);
        file_.reset();
    } catch (const std::exception& error) {
        note_ = fmt::format("{}: the default layout is used", error.what());
    }
}

std::string SavedLayout::save(const WindowLayout& layout) {
    if (!file_ || layout == layout_) return "";
    try {
        make_folder(file_->parent_path());
        const std::string text = json_of(layout).dump(2) + "\n";
        replace_file(*file_, std::as_bytes(std::span(text)));
    } catch (const std::exception& error) {
        return fmt::format("the layout is not saved: {}", error.what());
    }
    layout_ = layout;
    return "";
}

namespace {

/// The last error message of GLFW.
std::string& last_glfw_error() {
    static std::string text;
    return text;
}

[[noreturn]] void fail(const std::string& problem) {
    const std::string details =
        last_glfw_error().empty() ? "" : fmt::format(": {}", last_glfw_error());
    throw WindowError(problem + details);
}

constexpr glm::ivec2 default_size{1280, 800};

ScreenArea area_of(GLFWmonitor* monitor) {
    ScreenArea area;
    if (monitor != nullptr) {
        glfwGetMonitorWorkarea(monitor, &area.corner.x, &area.corner.y, &area.size.x, &area.size.y);
    }
    return area;
}

/// The work area of the monitor that contains a position, or else of the primary monitor.
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
    glfwSetErrorCallback([](int, const char* text) { last_glfw_error() = text; });
    if (glfwInit() != GLFW_TRUE) fail("no window can be opened");
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    const WindowLayout fitting = fitted_to_screen(layout, area_around(layout.position));
    // A saved size is already in the units of this screen.
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, fitting.size ? GLFW_FALSE : GLFW_TRUE);
    glfwWindowHint(GLFW_MAXIMIZED, fitting.is_maximized ? GLFW_TRUE : GLFW_FALSE);
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    glfwWindowHint(GLFW_DEPTH_BITS, 0);
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
    const WindowLayout default_layout =
        fitted_to_screen({.size = default_size}, area_around(std::nullopt));
    const glm::ivec2 size = fitting.size.value_or(*default_layout.size);
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

shade::GlLoader WindowSystem::loader() {
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

void WindowSystem::store_geometry(WindowLayout& layout) const {
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

void WindowSystem::hide() const {
    glfwHideWindow(window_);
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
