// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/bindings_test.cpp.
#include "window/bindings.h"

#include <fmt/format.h>

namespace relief::tools {

const std::vector<Binding>& bindings() {
    static const std::vector<Binding> all = {
        {Action::fit, "F", "Show all of the model"},
        {Action::front, "1", "Look from the front (+z)"},
        {Action::back, "Ctrl+1", "Look from behind"},
        {Action::right, "3", "Look from the right (+x)"},
        {Action::left, "Ctrl+3", "Look from the left"},
        {Action::top, "7", "Look from above (+y)"},
        {Action::bottom, "Ctrl+7", "Look from below"},
        {Action::narrower, "[", "Narrower field of view"},
        {Action::wider, "]", "Wider field of view"},
        {Action::turntable, "Space", "Go round the model by itself, or stop"},
        {Action::nearer, "+", "Come nearer"},
        {Action::nearer, "=", "Come nearer"},
        {Action::farther, "-", "Go farther away"},
        {Action::orbit_left, "Left", "Go round to the left"},
        {Action::orbit_right, "Right", "Go round to the right"},
        {Action::orbit_up, "Up", "Go higher"},
        {Action::orbit_down, "Down", "Go lower"},
        {Action::next_view, "V", "Show the next debug view"},
        {Action::previous_view, "B", "Show the debug view before"},
        {Action::plain_view, "0", "Show the picture again, and nothing over it"},
        {Action::wireframe, "W", "Draw the edges of triangles, or not"},
        {Action::vertex_frames, "N", "Draw tangents, bitangents and normals, or not"},
        {Action::health_markers, "M", "Mark where the mesh has trouble, or not"},
        {Action::compare, "K", "Compare with a change or another file, or not"},
        {Action::swap_sides, "X", "Swap the two sides"},
        {Action::show_difference, "D", "Show the difference of the two sides, or both"},
        {Action::copy_camera, "Ctrl+C", "Copy the camera as the option that repeats it"},
        {Action::paste_camera, "Ctrl+V", "Look from where copied options say"},
        {Action::save_picture, "S", "Save a picture beside the model"},
        {Action::save_scene, "Ctrl+S", "Save the scene beside the model, as JSON"},
        {Action::save_model, "Ctrl+E", "Save the model with its normals and tangents, as GLB"},
        {Action::panels, "Tab", "Hide the panels, or show them"},
        {Action::larger_interface, "Ctrl++", "Larger letters and panels"},
        {Action::larger_interface, "Ctrl+=", "Larger letters and panels"},
        {Action::smaller_interface, "Ctrl+-", "Smaller letters and panels"},
        {Action::usual_interface, "Ctrl+0", "Letters and panels as large as the screen wants them"},
        {Action::help, "H", "Show these bindings"},
        {Action::quit, "Ctrl+Q", "Close the window"},
    };
    return all;
}

const std::vector<Gesture>& gestures() {
    static const std::vector<Gesture> all = {
        {"Drag", "Go round the model"},
        {"Shift+drag, middle drag", "Move the view"},
        {"Shift+wheel, Shift+two fingers", "Move the view, up and down or sideways"},
        {"Wheel, two fingers, right drag", "Come nearer or go farther, to where the pointer is"},
        {"Ctrl+drag", "Move the lights round the model"},
        {"Drag the line", "Show more of one side, where two are compared"},
        {"Double click", "Go round this point of the surface"},
        {"Drop a file", "Show this model, or put this map on it"},
    };
    return all;
}

std::string bindings_text() {
    std::string text;
    for (const Binding& binding : bindings())
        text += fmt::format("{:<32}{}\n", binding.key, binding.what);
    for (const Gesture& gesture : gestures())
        text += fmt::format("{:<32}{}\n", gesture.hand, gesture.what);
    return text;
}

}  // namespace relief::tools
