// SPDX-License-Identifier: Apache-2.0
/// \file
/// What keys and hands do in the window: one table, which the window acts by, H shows and
/// --list-bindings prints. Tests: tests/tools/window/bindings_test.cpp.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace relief::tools {

enum class Action {
    fit,
    front,
    back,
    left,
    right,
    top,
    bottom,
    narrower,
    wider,
    turntable,
    nearer,
    farther,
    orbit_left,
    orbit_right,
    orbit_up,
    orbit_down,
    next_view,
    previous_view,
    plain_view,
    wireframe,
    vertex_frames,
    health_markers,
    compare,
    swap_sides,
    show_difference,
    copy_camera,
    paste_camera,
    save_picture,
    save_scene,
    save_model,
    panels,
    larger_interface,
    smaller_interface,
    usual_interface,
    help,
    quit,
};

struct Binding {
    Action action;
    std::string_view key;  ///< "F", "Ctrl+C", "Left": letters, F1 to F12, names as on the keyboard.
    std::string_view what;
};

/// All keys; some actions have two.
const std::vector<Binding>& bindings();

/// What the mouse does: "drag", "Shift+drag", ...; and what it is for.
struct Gesture {
    std::string_view hand;
    std::string_view what;
};
const std::vector<Gesture>& gestures();

/// Both lists, a line each.
std::string bindings_text();

}  // namespace relief::tools
