// SPDX-License-Identifier: Apache-2.0
/// \file
/// Keyboard shortcuts and mouse gestures: one table, which the window, its help (F1) and
/// --list-bindings use. Tests: tests/tools/window/user_interface_test.cpp.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace relief::tools {

/// An action of a shortcut or of a panel.
enum class Action {
    fit,
    front,
    back,
    left,
    right,
    top,
    bottom,
    narrow_fov,
    widen_fov,
    orthographic,
    brighter,
    darker,
    turntable,
    play,
    step_back,
    step_forward,
    zoom_in,
    zoom_out,
    orbit_left,
    orbit_right,
    orbit_up,
    orbit_down,
    next_view,
    previous_view,
    picture_view,
    wireframe,
    vertex_frames,
    grid,
    health_markers,
    light_markers,
    compare,
    swap_sides,
    show_difference,
    pixel_probe,
    undo,
    redo,
    copy_camera,
    paste_camera,
    save_picture,
    save_scene,
    save_model,
    open,
    next_file,
    previous_file,
    panels,
    theme,
    larger_ui,
    smaller_ui,
    reset_ui_scale,
    help,
    axis_gizmo,
    cancel,
    quit,
};

struct Shortcut {
    Action action;
    std::string_view key;  ///< For example "F", "Ctrl+C", "Left".
    std::string_view description;
};

/// All shortcuts. Some actions have two.
const std::vector<Shortcut>& shortcuts();

/// The group of an action in lists: "Camera", "Picture", "Motion", "Comparison", "Editing", "Files"
/// or "Window".
std::string_view shortcut_group(Action action);
/// All groups, in the order of lists. The last one is that of the gestures.
std::vector<std::string_view> shortcut_groups();
inline constexpr std::string_view gesture_group = "Mouse";

/// Returns whether every word of a search is in one of the texts. Upper and lower case are equal.
bool matches_search(std::string_view search, std::initializer_list<std::string_view> texts);

/// A mouse gesture, for example "Shift+drag", and its description.
struct Gesture {
    std::string_view input;
    std::string_view description;
};
const std::vector<Gesture>& gestures();

/// Both lists by group, one entry per line.
std::string shortcuts_text();

}  // namespace relief::tools
