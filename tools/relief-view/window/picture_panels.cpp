// SPDX-License-Identifier: Apache-2.0
// The panels of the environment, of debug views and of the picture.
#include <imgui.h>

#include <cmath>
#include <string>
#include <type_traits>
#include <variant>

#include "relief/shade/frame_settings.h"
#include "relief/shade/scene_fields.h"
#include "window/controls.h"
#include "window/panels.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

/// The name of the image, or of the first of six.
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
                                            "a latitude-longitude panorama",
                                            "an angular light probe"};
    return names[environment.source.index()];
}

bool edit(Environment& environment) {
    ImGui::TextDisabled("%s", layout_of(environment));
    bool changed = edit_field(environment, &Environment::intensity);
    changed |= edit_field(environment, &Environment::rotation);
    changed |= check("Show as background", environment.skybox);
    if (environment.skybox) changed |= edit_field(environment, &Environment::skybox_blur);
    changed |= check("Environment light", environment.lights);
    return changed;
}

}  // namespace

void draw_environment_panel(const PanelInput& input, PanelRequests& requests) {
    ViewerState& state = input.state;
    if (!state.has_scene()) return;
    std::optional<std::string> name;
    if (state.scene().environment) name = name_of(*state.scene().environment);
    const FileChoice choice = file_field("Image or folder", name);
    if (!name && ImGui::Button("Photo studio")) state.set_environment("studio");
    if (!name) probe_item("Photo studio");
    if (choice.is_browsing) {
        requests.browse = BrowseRequest{.target = {.kind = BrowseTarget::Kind::environment},
                                        .title = "Environment: an image or a folder",
                                        .folder = folder_to_browse(name, state.options().model),
                                        .present = name};
    }
    if (choice.file) {
        state.set_environment(*choice.file);
    } else if (choice.is_cleared) {
        state.edit([](Scene& scene) { scene.environment.reset(); });
    }
    if (!state.scene().environment) return;
    Environment environment = *state.scene().environment;
    if (edit(environment)) state.edit([&](Scene& scene) { scene.environment = environment; });
}

namespace {

bool choose_view(DebugView& view) {
    bool changed = false;
    if (!ImGui::BeginCombo(begin_row("Show").c_str(), debug_view_info(view).name.data()))
        return false;
    for (const DebugViewInfo& info : debug_views()) {
        if (ImGui::Selectable(info.name.data(), info.view == view)) {
            view = info.view;
            changed = true;
        }
    }
    ImGui::EndCombo();
    return changed;
}

void draw_legend(const HealthMarkers& markers) {
    if (!markers.markers) return ImGui::TextUnformatted("Searching for problems");
    if (markers.conditions.empty()) ImGui::TextUnformatted("No problems found");
    for (const MarkedCondition& marked : markers.conditions) {
        const glm::vec3& color = marked.color_srgb;
        const std::string word(condition_info(marked.condition).word);
        ImGui::TextColored({color.r, color.g, color.b, 1.0F}, "%s: %zu", word.c_str(),
                           marked.count);
    }
}

}  // namespace

void draw_view_panel(const PanelInput& input) {
    DebugChoices choices = input.state.debug();
    bool changed = choose_view(choices.view);
    ImGui::TextWrapped("%s", debug_view_info(choices.view).what.data());
    changed |= check("Wireframe", choices.wireframe);
    changed |= check("Vertex frames", choices.vertex_frames);
    float length = choices.frame_length.value_or(default_frame_length);
    if (choices.vertex_frames &&
        slide("Length", length, {1e-3F, 0.2F, "%.3f", true, default_frame_length})) {
        choices.frame_length = length;
        changed = true;
    }
    changed |= check("Grid and axes", choices.grid);
    if (choices.grid && input.state.has_scene())
        ImGui::TextDisabled("A cell is %g wide.", input.state.grid().spacing);
    int marks = !choices.health_markers ? 0 : *choices.health_markers == HealthChoice::all ? 2 : 1;
    if (ImGui::Combo(begin_row("Health").c_str(), &marks,
                     "No markers\0Problems\0Problems and notes\0")) {
        choices.health_markers.reset();
        if (marks > 0)
            choices.health_markers = marks == 2 ? HealthChoice::all : HealthChoice::problem;
        changed = true;
    }
    if (choices.health_markers) draw_legend(input.state.markers());
    check("Axes in the corner", input.layout.has_axes);
    bool has_light_markers = input.state.has_light_markers();
    if (check("Light markers", has_light_markers)) input.state.act(Action::light_markers);
    if (changed) input.state.set_debug(choices);
}

void draw_picture_panel(const PanelInput& input) {
    if (!input.state.has_scene()) return;
    const Scene& scene = input.state.scene();
    float stops = std::log2(scene.exposure);
    ToneMapping tone = scene.tone_mapping;
    glm::vec3 background(scene.background);
    bool changed =
        slide("Exposure", stops,
              {std::log2(min_exposure), std::log2(max_exposure), "%.1f stops", false, 0.0F});
    changed |= choose("Tone curve", tone);
    changed |= pick_color("Background", background);
    if (!changed) return;
    input.state.edit([&](Scene& edited) {
        edited.exposure = std::exp2(stops);
        edited.tone_mapping = tone;
        edited.background = glm::vec4(background, edited.background.w);
    });
}

}  // namespace relief::tools
