// SPDX-License-Identifier: Apache-2.0
// The tables of shortcuts and gestures, and their text for the help.
// Tests: tests/tools/window/user_interface_test.cpp.
#include "window/shortcuts.h"

#include <fmt/format.h>

#include <sstream>

namespace relief::tools {

const std::vector<Shortcut>& shortcuts() {
    static const std::vector<Shortcut> all = {
        {Action::fit, "F", "Fit the model to the view"},
        {Action::front, "1", "View from the front (+z)"},
        {Action::back, "Ctrl+1", "View from the back"},
        {Action::right, "3", "View from the right (+x)"},
        {Action::left, "Ctrl+3", "View from the left"},
        {Action::top, "7", "View from above (+y)"},
        {Action::bottom, "Ctrl+7", "View from below"},
        {Action::narrow_fov, "[", "Decrease the field of view"},
        {Action::widen_fov, "]", "Increase the field of view"},
        {Action::orthographic, "5", "Switch between perspective and orthographic camera"},
        {Action::brighter, "Ctrl+Up", "Increase the exposure by half a stop"},
        {Action::darker, "Ctrl+Down", "Decrease the exposure by half a stop"},
        {Action::turntable, "Space", "Start or stop the turntable"},
        {Action::play, "P", "Play or pause the animation"},
        {Action::step_back, ",", "Step back in the animation"},
        {Action::step_forward, ".", "Step forward in the animation"},
        {Action::zoom_in, "+", "Zoom in"},
        {Action::zoom_in, "=", "Zoom in"},
        {Action::zoom_out, "-", "Zoom out"},
        {Action::orbit_left, "Left", "Orbit left"},
        {Action::orbit_right, "Right", "Orbit right"},
        {Action::orbit_up, "Up", "Orbit up"},
        {Action::orbit_down, "Down", "Orbit down"},
        {Action::next_view, "V", "Show the next debug view"},
        {Action::previous_view, "B", "Show the previous debug view"},
        {Action::picture_view, "0", "Show the picture without overlays"},
        {Action::wireframe, "W", "Show or hide the wireframe"},
        {Action::vertex_frames, "N", "Show or hide tangents, bitangents and normals"},
        {Action::grid, "G", "Show or hide the grid and the axes"},
        {Action::health_markers, "M", "Show or hide markers for mesh problems"},
        {Action::light_markers, "L", "Show or hide markers at point lights and spotlights"},
        {Action::compare, "K", "Start or stop the comparison"},
        {Action::swap_sides, "X", "Swap the two sides"},
        {Action::show_difference, "D", "Show the difference or both sides"},
        {Action::pixel_probe, "I", "Explain the pixel under the pointer, or stop"},
        {Action::undo, "Ctrl+Z", "Undo the last edit"},
        {Action::redo, "Ctrl+Y", "Redo the edit that was undone"},
        {Action::redo, "Ctrl+Shift+Z", "Redo the edit that was undone"},
        {Action::copy_camera, "Ctrl+C", "Copy the camera as command-line options"},
        {Action::paste_camera, "Ctrl+V", "Paste a camera"},
        {Action::save_picture, "S", "Save a picture next to the model"},
        {Action::save_scene, "Ctrl+S", "Save the scene next to the model, as JSON"},
        {Action::save_model, "Ctrl+E", "Save the model with normals and tangents, as GLB"},
        {Action::open, "Ctrl+O", "Open a model, a scene or a map"},
        {Action::next_file, "PageDown", "Open the next model of the folder"},
        {Action::previous_file, "PageUp", "Open the previous model of the folder"},
        {Action::panels, "Tab", "Show or hide the panels"},
        {Action::theme, "T", "Change between the dark and the light theme"},
        {Action::larger_ui, "Ctrl++", "Enlarge the user interface"},
        {Action::larger_ui, "Ctrl+=", "Enlarge the user interface"},
        {Action::smaller_ui, "Ctrl+-", "Reduce the user interface"},
        {Action::reset_ui_scale, "Ctrl+0", "Reset the scale of the user interface"},
        {Action::help, "F1", "Show the shortcuts"},
        {Action::help, "H", "Show the shortcuts"},
        {Action::help, "?", "Show the shortcuts"},
        {Action::axis_gizmo, "A", "Show or hide the axes in the corner"},
        {Action::cancel, "Escape", "Cancel reading or drawing; close a list"},
        {Action::quit, "Ctrl+Q", "Close the window"},
    };
    return all;
}

const std::vector<Gesture>& gestures() {
    static const std::vector<Gesture> all = {
        {"Drag", "Orbit"},
        {"Shift+drag, middle drag", "Pan"},
        {"Shift+wheel, Shift+two fingers", "Pan up, down or sideways"},
        {"Wheel, two fingers, right drag", "Zoom towards the pointer"},
        {"Ctrl+drag", "Rotate the lights"},
        {"Ctrl+Shift+drag", "Rotate the environment"},
        {"Drag the line", "Move the line between two compared pictures"},
        {"Click (I: explain pixels)", "Pin the pixel, or follow the pointer again"},
        {"Double click", "Set the orbit center to this point"},
        {"Click an axis", "Look along this axis"},
        {"Drag a light", "Move this light; the panel Lights shows the lights"},
        {"Drop a file", "Show a model, or apply a map"},
    };
    return all;
}

std::string_view shortcut_group(Action action) {
    switch (action) {
        case Action::fit:
        case Action::front:
        case Action::back:
        case Action::left:
        case Action::right:
        case Action::top:
        case Action::bottom:
        case Action::narrow_fov:
        case Action::widen_fov:
        case Action::orthographic:
        case Action::zoom_in:
        case Action::zoom_out:
        case Action::orbit_left:
        case Action::orbit_right:
        case Action::orbit_up:
        case Action::orbit_down:
        case Action::copy_camera:
        case Action::paste_camera:
            return "Camera";
        case Action::brighter:
        case Action::darker:
        case Action::next_view:
        case Action::previous_view:
        case Action::picture_view:
        case Action::wireframe:
        case Action::vertex_frames:
        case Action::grid:
        case Action::health_markers:
        case Action::light_markers:
            return "Picture";
        case Action::turntable:
        case Action::play:
        case Action::step_back:
        case Action::step_forward:
            return "Motion";
        case Action::compare:
        case Action::swap_sides:
        case Action::show_difference:
            return "Comparison";
        case Action::undo:
        case Action::redo:
            return "Editing";
        case Action::save_picture:
        case Action::save_scene:
        case Action::save_model:
        case Action::open:
        case Action::next_file:
        case Action::previous_file:
            return "Files";
        default:
            return "Window";
    }
}

std::vector<std::string_view> shortcut_groups() {
    return {"Camera",  "Picture", "Motion", "Comparison",
            "Editing", "Files",   "Window", gesture_group};
}

bool matches_search(std::string_view search, std::initializer_list<std::string_view> texts) {
    const auto lower = [](std::string_view text) {
        std::string result(text);
        for (char& c : result) {
            if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
        }
        return result;
    };
    std::string all;
    for (const std::string_view text : texts)
        all += lower(text) + "\n";
    std::istringstream words(lower(search));
    for (std::string word; words >> word;) {
        if (all.find(word) == std::string::npos) return false;
    }
    return true;
}

std::string shortcuts_text() {
    std::string text;
    for (const std::string_view group : shortcut_groups()) {
        text += fmt::format("{}{}\n", text.empty() ? "" : "\n", group);
        for (const Shortcut& shortcut : shortcuts()) {
            if (shortcut_group(shortcut.action) == group)
                text += fmt::format("  {:<32}{}\n", shortcut.key, shortcut.description);
        }
        if (group != gesture_group) continue;
        for (const Gesture& gesture : gestures())
            text += fmt::format("  {:<32}{}\n", gesture.input, gesture.description);
    }
    return text;
}

}  // namespace relief::tools
