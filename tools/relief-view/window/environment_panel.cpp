// SPDX-License-Identifier: Apache-2.0
// The surroundings: from which files, how bright, shown behind the model or not, shedding light or
// not. Tests: tests/tools/window/panels_test.cpp.
#include <imgui.h>

#include <algorithm>
#include <type_traits>

#include "window/controls.h"
#include "window/file_field.h"
#include "window/panels.h"
#include "window/places.h"

namespace relief::tools {
namespace {

/// The image, or the first of six.
std::string name_of(const Environment& environment) {
    return std::visit(
        [](const auto& source) {
            if constexpr (std::is_same_v<std::decay_t<decltype(source)>, CubeFaces>) {
                return source.faces.front().name;
            } else {
                return source.image.name;
            }
        },
        environment.source);
}

const char* layout_of(const Environment& environment) {
    static constexpr const char* names[] = {"six images", "a cross of six faces",
                                            "a panorama by longitude and latitude",
                                            "a light probe by angle"};
    return names[environment.source.index()];
}

bool edit(Environment& environment) {
    ImGui::TextDisabled("%s", layout_of(environment));
    bool changed = drag_up("Brightness", environment.intensity);
    environment.intensity = std::clamp(environment.intensity, 0.0F, 1e6F);
    changed |= ImGui::Checkbox("Shown behind", &environment.skybox);
    mark_place("Shown behind");
    changed |= ImGui::Checkbox("Sheds light", &environment.lights);
    mark_place("Sheds light");
    return changed;
}

}  // namespace

void draw_environment_panel(const PanelInput& input) {
    ViewerState& state = input.state;
    if (!state.has_scene()) return;
    std::optional<std::string> name;
    if (state.scene().environment) name = name_of(*state.scene().environment);
    const FileChoice choice = file_field("Image or folder", name);
    if (choice.file) {
        state.set_environment(*choice.file);
    } else if (choice.is_cleared) {
        state.edit([](Scene& scene) { scene.environment.reset(); });
    }
    if (!state.scene().environment) return;
    Environment environment = *state.scene().environment;
    if (edit(environment)) state.edit([&](Scene& scene) { scene.environment = environment; });
}

}  // namespace relief::tools
