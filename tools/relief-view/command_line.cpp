// SPDX-License-Identifier: Apache-2.0
#include "command_line.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <numbers>
#include <optional>
#include <vector>

#include "common/file_jobs.h"
#include "common/options.h"
#include "common/text.h"
#include "effect_options.h"
#include "environment_options.h"
#include "exercise.h"
#include "light_options.h"
#include "material_options.h"
#include "mistake_pictures.h"
#include "option_conflicts.h"
#include "page_command.h"
#include "picture_comparison.h"
#include "picture_sequence.h"
#include "picture_sink.h"
#include "pixel_probe.h"
#include "portable_math.h"
#include "saved_files.h"
#include "scene_options.h"
#include "step_pictures.h"
#include "window/window_system.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

void add_output_options(CLI::App& app, ViewOptions& options) {
    const std::string group = "Output";
    add_path(
        app, "--output", options.output,
        "Write the picture to FILE: .png (8 bit, sRGB), .exr (linear float), .apng (animated), or "
        ".mp4 or .webm (videos, by the program ffmpeg). .html is a page that draws it in a "
        "browser.")
        .group(group);
    add_value(app, "--size", "WxH",
              "Set the width and height in pixels; in a window, those of the view. Default: the "
              "size in the scene file, else 1024x1024.",
              [&](const std::string& subject, const std::string& text) {
                  options.size = parse_size(subject, text);
                  options.size_given = true;
              })
        .group(group);
    add_choice(app, "--samples", options.samples, Choices<int>{{"1", 1}, {"4", 4}},
               "Set the number of samples per pixel; 4 smooth the edges of triangles. Default: 4.")
        .group(group);
    add_value(app, "--background", "#RRGGBB|transparent",
              "Set the color behind the model where no environment is visible. Default: #1e2126.",
              [&](const std::string& subject, const std::string& text) {
                  options.scene_fields.set(&Scene::background,
                                           text == "transparent"
                                               ? glm::vec4(0.0F)
                                               : glm::vec4(parse_color(subject, text), 1.0F));
              })
        .group(group);
    add_value(app, "--exposure", "STOPS",
              "Double the brightness for each stop; negative stops halve it. Default: the value in "
              "the scene file, else 0.",
              [&](const std::string& subject, const std::string& text) {
                  const Range range{-30, 30, "stops"};
                  const double stops = parse_number(subject, text, range);
                  options.scene_fields.set(
                      &Scene::exposure,
                      static_cast<float>(relief::detail::portable::exp(std::numbers::ln2 * stops)));
              })
        .group(group);
    add_field(app, options.scene_fields, "--tone-mapping", &Scene::tone_mapping,
              "Choose the curve for light brighter than white; none clips it. Default: the curve "
              "in the scene file, else none.")
        .group(group);
    add_switch(app, "--explain-effects", options.explain_effects,
               "Print which effects the scene needs, which it does not need, and why. With "
               "--output or --benchmark, also print the cost of each effect and the change of the "
               "picture without it. Alone, this option needs no OpenGL.")
        .group(group);
    add_switch(app, "--json", options.json, "Print the summary as one JSON object.").group(group);
    add_switch(app, "--strict", options.strict,
               "Exit with 3 if the model has a problem, such as a missing texture. The picture is "
               "still written.")
        .group(group);
}

void add_window_options(CLI::App& app, ViewOptions& options) {
    const std::string group = "Window";
    add_switch(app, "--list-bindings", options.list_bindings,
               "Print the keyboard shortcuts and mouse gestures of the window.")
        .group(group);
    add_number(app, "--ui-scale", "S", options.ui_scale, {min_ui_scale, max_ui_scale, ""},
               "Scale the text and panels of the window: 1 is the normal size, 2 is twice as "
               "large. Default: the last scale that was set in the window (Ctrl++, Ctrl+-), else "
               "the scale of the screen.")
        .group(group);
    add_switch(app, "--no-state", options.no_state,
               "Do not read or write the position of the window and its open panels "
               "($XDG_STATE_HOME/relief, else ~/.local/state/relief).")
        .group(group);
    // A hook for tests and scripts, which --help does not list.
    add_path(app, "--dump-state", options.dump_state,
             "Write the state of the window to FILE as JSON.")
        .group("");
}

void check_output(const ViewOptions& options) {
    if (!options.output) return;
    refuse(is_animation(*options.output) && !is_sequence(options),
           "--output " + options.output->string(), "an animation needs several pictures",
           "add --turntable or --frames, or write a .png");
    const std::string extension = extension_of(*options.output);
    constexpr std::array formats = {".png", ".exr", ".apng", ".mp4", ".webm", ".html"};
    refuse(std::find(formats.begin(), formats.end(), extension) == formats.end(),
           "--output " + options.output->string(), "unsupported format",
           "use .png, .exr, .apng, .mp4, .webm or .html");
    require_folder_of(*options.output);
}

/// --environment takes one or six files, so it may have taken the model that follows it.
void recover_model(ViewOptions& options) {
    if (!options.model.empty()) return;
    if (options.environment.size() != 2 && options.environment.size() != 7) return;
    options.model = options.environment.back();
    options.environment.pop_back();
}

}  // namespace

void add_view_options(CLI::App& app, ViewOptions& options) {
    // Not marked as required, because settle() may find the model after --environment.
    add_path(app, "MODEL", options.model,
             "The model to show: .glb .gltf .obj .ply .stl .off, or a scene: .json. Without "
             "--output, a window opens.");
    add_output_options(app, options);
    add_model_options(app, options);
    add_save_options(app, options);
    add_window_options(app, options);
    add_map_options(app, options);
    add_material_options(app, options);
    add_environment_options(app, options);
    add_light_options(app, options);
    add_sequence_options(app, options);
    add_reference_options(app, options);
    add_compare_options(app, options);
    add_effect_options(app, options);
    add_step_options(app, options);
    add_mistake_options(app, options);
    add_exercise_options(app, options);
    add_debug_options(app, options);
    add_probe_options(app, options);
    add_page_options(app, options);
    const Choices<Backend> backends = {
        {"auto", Backend::automatic}, {"osmesa", Backend::osmesa}, {"egl", Backend::egl}};
    add_choice(app, "--backend", options.backend, backends,
               "Choose the OpenGL context for pictures. No backend needs a display. auto prefers a "
               "GPU with EGL, then OSMesa, then EGL in software. Default: auto.");
    add_general_options(app, options.general);
}

void check_written_files(const ViewOptions& options, std::vector<std::filesystem::path> others) {
    others.insert(others.end(), options.environment.begin(), options.environment.end());
    for (const auto& file :
         {std::optional(options.model), options.compare.file, options.reference, options.normal_map,
          options.height_map, options.diffuse_map, options.exercise_file}) {
        if (file && !file->empty()) others.push_back(*file);
    }
    const auto check = [&](const char* option, const std::optional<std::filesystem::path>& file) {
        if (!file) return;
        check_distinct(option, *file, others);
        others.push_back(*file);
    };
    check("--output", options.output);
    check("--save-scene", options.save_scene);
    check("--save-model", options.save_model);
    check("--difference-map", options.difference_map);
}

void settle(ViewOptions& options) {
    recover_model(options);
    settle_exercise(options);
    if (options.model.empty() && !options.wants_window() && !options.list_bindings)
        throw UsageError("MODEL is missing");
    check_conflicts(options);
    check_output(options);
    check_written_files(options, {});
    check_save_options(options);
    check_reference(options);
    check_compare_options(options);
    check_materials(options);
    check_environment(options);
    check_debug_options(options);
    check_probed_view(options);
}

}  // namespace relief::tools
