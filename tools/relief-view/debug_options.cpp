// SPDX-License-Identifier: Apache-2.0
#include "debug_options.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "common/text.h"

namespace relief::tools {
namespace {

Choices<DebugView> view_choices() {
    Choices<DebugView> words;
    for (const DebugViewInfo& info : debug_views())
        words.emplace_back(info.name, info.view);
    return words;
}

const Choices<HealthChoice>& health_choices() {
    static const Choices<HealthChoice> words = {{"trouble", HealthChoice::problem},
                                                {"all", HealthChoice::all}};
    return words;
}

std::string hex_color(const glm::vec3& srgb) {
    const auto code = [](float value) { return std::lround(255.0F * value); };
    return fmt::format("#{:02x}{:02x}{:02x}", code(srgb.r), code(srgb.g), code(srgb.b));
}

std::string remedy_for(DebugView view) {
    switch (view) {
        case DebugView::height:
            return "give --height-map with --height-as bump_map";
        case DebugView::normal_map:
            return "give --normal-map or --height-map";
        case DebugView::tangent:
        case DebugView::bitangent:
        case DebugView::handedness:
        case DebugView::texcoords:
            return "unwrap the model first";
        default:
            return "--explain-effects says what the scene calls for";
    }
}

}  // namespace

void add_debug_options(CLI::App& app, ViewOptions& options) {
    const std::string group = "Debug views";
    DebugChoices& choices = options.debug;
    add_choice(app, "--show", choices.view, view_choices(),
               "Show a property of the surfaces instead of the picture: directions in world space "
               "as 0.5 v + 0.5, or one term of the lighting. docs/debug-views.md describes the "
               "coding. Default: picture.")
        .group(group);
    add_switch(app, "--wireframe", choices.wireframe,
               "Draw the edges of all triangles over the picture.")
        .group(group);
    add_switch(app, "--vertex-frames", choices.vertex_frames,
               "Draw the tangent (red), bitangent (green) and normal (blue) of each vertex over "
               "the picture.")
        .group(group);
    add_number(
        app, "--frame-length", "R", choices.frame_length, {1e-6, 10, ""},
        "Set the length of the lines of --vertex-frames, times the scene's size. Default: 0.01.")
        .group(group);
    add_choice(app, "--health-markers", choices.health_markers, health_choices(),
               "Mark the problems that relief-mesh check finds with colored discs, or all its "
               "findings. The summary lists the colors.")
        .group(group);
}

void check_debug_options(ViewOptions& options) {
    const DebugChoices& choices = options.debug;
    refuse(choices.frame_length && !choices.vertex_frames, "--frame-length",
           "needs --vertex-frames", "add --vertex-frames, or leave it out");
    const bool overlaid = choices.wireframe || choices.vertex_frames || choices.health_markers;
    const bool draws =
        options.output || options.reference || options.effects.measures() || options.wants_window();
    refuse(overlaid && !draws,
           choices.wireframe       ? "--wireframe"
           : choices.vertex_frames ? "--vertex-frames"
                                   : "--health-markers",
           "there is no --output", "add one");
    if (choices.view == DebugView::picture) return;
    refuse(options.explain_effects, "--show",
           "contradicts --explain-effects, which needs all effects", "leave one of them out");
    refuse(options.effects.budget.has_value(), "--show",
           "contradicts --budget, which drops effects of the picture", "leave one of them out");
    if (!is_data(choices.view)) return;
    refuse(options.exposure || options.tone_mapping,
           options.exposure ? "--exposure" : "--tone-mapping",
           fmt::format("does not apply to data, which --show {} shows",
                       debug_view_info(choices.view).name),
           "leave it out");
    if (!options.wants_window()) options.samples = 1;
}

HealthMarkers chosen_markers(const DebugChoices& choices, const Scene& scene) {
    if (!choices.health_markers) return {};
    return choices.health_markers == HealthChoice::all ? health_markers(scene, std::nullopt)
                                                       : health_markers(scene);
}

Overlays overlays_of(const DebugChoices& choices, const HealthMarkers& markers) {
    Overlays overlays;
    overlays.wireframe = choices.wireframe;
    if (choices.vertex_frames)
        overlays.vertex_frames = choices.frame_length.value_or(default_frame_length);
    overlays.markers = markers.markers;
    return overlays;
}

FramePlan viewed_plan(const ViewOptions& options, const Scene& scene, const FrameSettings& settings,
                      FramePlan plan, Report& report) {
    try {
        return plan_view(scene, settings, std::move(plan), report);
    } catch (const InvalidInput& error) {
        throw failure(options.model, error.what(), remedy_for(options.debug.view));
    }
}

std::vector<std::string> legend(const HealthMarkers& markers) {
    std::vector<std::string> lines;
    for (const MarkedCondition& marked : markers.conditions) {
        const std::string_view word = condition_info(marked.condition).word;
        std::string line =
            fmt::format("{} {}: {}", hex_color(marked.color_srgb), word, marked.count);
        if (marked.marked < marked.count) line += fmt::format(", {} marked", marked.marked);
        lines.push_back(std::move(line));
    }
    if (lines.empty()) lines.emplace_back("none");
    return lines;
}

nlohmann::ordered_json legend_json(const HealthMarkers& markers) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const MarkedCondition& marked : markers.conditions) {
        list.push_back({{"kind", condition_info(marked.condition).word},
                        {"count", marked.count},
                        {"marked", marked.marked},
                        {"color", hex_color(marked.color_srgb)}});
    }
    return list;
}

nlohmann::ordered_json overlays_json(const DebugChoices& choices, const HealthMarkers& markers) {
    return {{"wireframe", choices.wireframe},
            {"vertex_frames", choices.vertex_frames},
            {"health_markers",
             choices.health_markers ? legend_json(markers) : nlohmann::ordered_json(nullptr)}};
}

std::string command_line_of(const DebugChoices& choices) {
    std::string text;
    if (choices.view != DebugView::picture)
        text += fmt::format(" --show {}", debug_view_info(choices.view).name);
    if (choices.wireframe) text += " --wireframe";
    if (choices.vertex_frames) text += " --vertex-frames";
    if (choices.vertex_frames && choices.frame_length)
        text += fmt::format(" --frame-length {}", *choices.frame_length);
    if (choices.health_markers)
        text += " --health-markers " + name_of(*choices.health_markers, health_choices());
    return text;
}

}  // namespace relief::tools
