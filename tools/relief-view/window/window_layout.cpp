// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/window_layout_test.cpp.
#include "window/window_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <glm/common.hpp>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <utility>

#include "common/command.h"
#include "file_replacement.h"
#include "window/interface_scale.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr int layout_version = 1;
constexpr int largest_window_side = 16384;
constexpr glm::ivec2 smallest{320, 240};

/// A file of a later version: nothing is wrong with it.
class LaterVersion : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

glm::ivec2 pair_of(const json& value) {
    const auto pair = value.get<std::array<int, 2>>();
    const glm::ivec2 limit(largest_window_side);
    return glm::clamp(glm::ivec2(pair[0], pair[1]), -limit, limit);
}

WindowLayout layout_of(const json& document) {
    const int found = document.at("version").get<int>();
    if (found > layout_version) throw LaterVersion(fmt::format("of version {}", found));
    WindowLayout layout;
    const json window = document.value("window", json::object());
    if (window.contains("size")) layout.size = glm::max(pair_of(window["size"]), smallest);
    if (window.contains("position")) layout.position = pair_of(window["position"]);
    layout.is_maximized = window.value("maximized", false);
    const json panels = document.value("panels", json::object());
    layout.has_panels = panels.value("shown", true);
    layout.open_panels = panels.value("open", std::map<std::string, bool>{});
    if (document.contains("scale")) {
        layout.ui_scale =
            std::clamp(document["scale"].get<float>(), least_interface_scale, most_interface_scale);
    }
    return layout;
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
    return document;
}

/// An environment variable that names an absolute path.
std::optional<std::filesystem::path> path_in(const char* variable) {
    const char* text = std::getenv(variable);
    if (text == nullptr || !std::filesystem::path(text).is_absolute()) return std::nullopt;
    return text;
}

}  // namespace

WindowLayout within(WindowLayout layout, const ScreenArea& screen) {
    if (screen.size.x <= 0 || screen.size.y <= 0) return layout;
    if (layout.size) layout.size = glm::min(*layout.size, screen.size);
    if (layout.position) {
        const glm::ivec2 room = screen.size - layout.size.value_or(smallest);
        layout.position = glm::clamp(*layout.position, screen.corner,
                                     screen.corner + glm::max(room, glm::ivec2(0)));
    }
    return layout;
}

std::optional<std::filesystem::path> usual_layout_file() {
    std::optional<std::filesystem::path> folder = path_in("XDG_STATE_HOME");
    if (!folder) {
        folder = path_in("HOME");
        if (!folder) return std::nullopt;
        *folder /= ".local/state";
    }
    return *folder / "relief" / "relief-view.json";
}

RememberedLayout::RememberedLayout(std::filesystem::path file) : file_(std::move(file)) {
    std::error_code none;
    if (!std::filesystem::exists(*file_, none)) return;
    try {
        std::ifstream stream(*file_, std::ios::binary);
        if (!stream) throw std::runtime_error("cannot be read");
        layout_ = layout_of(json::parse(stream));
    } catch (const LaterVersion& later) {
        note_ = fmt::format(
            "{} is {}, later than this program's {}: the window is as usual, and "
            "is not remembered",
            file_->string(), later.what(), layout_version);
        file_.reset();
    } catch (const std::exception& error) {
        note_ = fmt::format("{}: {}: the window is as usual", file_->string(), error.what());
    }
}

std::string RememberedLayout::remember(const WindowLayout& layout) {
    if (!file_ || layout == layout_) return "";
    try {
        make_folder(file_->parent_path());
        const std::string text = json_of(layout).dump(2) + "\n";
        replace_file(*file_, std::as_bytes(std::span(text)));
    } catch (const std::exception& error) {
        return fmt::format("the window is not remembered: {}", error.what());
    }
    layout_ = layout;
    return "";
}

}  // namespace relief::tools
