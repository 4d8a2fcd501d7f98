// SPDX-License-Identifier: Apache-2.0
// The tables of shortcuts and gestures, and their text for the help.
// Tests: tests/tools/window/user_interface_test.cpp.
#include "window/shortcuts.h"

#include <fmt/format.h>

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
        {"Click, while pixels are explained", "Pin the pixel, or follow the pointer again"},
        {"Double click", "Set the orbit center to this point"},
        {"Drop a file", "Show a model, or apply a map"},
    };
    return all;
}

std::string shortcuts_text() {
    std::string text;
    for (const Shortcut& shortcut : shortcuts())
        text += fmt::format("{:<32}{}\n", shortcut.key, shortcut.description);
    for (const Gesture& gesture : gestures())
        text += fmt::format("{:<32}{}\n", gesture.input, gesture.description);
    return text;
}

}  // namespace relief::tools
