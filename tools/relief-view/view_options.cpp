// SPDX-License-Identifier: Apache-2.0
#include "view_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/text.h"
#include "compare_options.h"
#include "debug_options.h"
#include "effect_options.h"
#include "environment_options.h"
#include "field_options.h"
#include "map_options.h"
#include "material_options.h"
#include "picture_reference.h"
#include "save_files.h"
#include "sequence_options.h"
#include "window/interface_scale.h"

namespace relief::tools {
namespace {

/// In double, so that what degrees_text() says (orbit_camera.h) comes back bit for bit.
float radians_from(double degrees) {
    return static_cast<float>(glm::radians(degrees));
}

void add_output_options(CLI::App& app, ViewOptions& options) {
    const std::string group = "Output";
    add_path(app, "--output", options.output,
             "Picture to write: .png (8 bit, sRGB), .exr (linear float) or .apng (animated).")
        .group(group);
    add_value(
        app, "--size", "WxH",
        "Width and height in pixels; of the view, where a window opens. Default: as the scene "
        "says, else 1024x1024.",
        [&](const std::string& subject, const std::string& text) {
            options.size = parse_size(subject, text);
            options.size_given = true;
        })
        .group(group);
    add_choice(app, "--samples", options.samples, Choices<int>{{"1", 1}, {"4", 4}},
               "Samples per pixel; 4 smooth the edges of triangles. Default: 4.")
        .group(group);
    add_value(app, "--background", "#RRGGBB|transparent",
              "Colour behind the model where no environment shows. Default: #1e2126.",
              [&](const std::string& subject, const std::string& text) {
                  options.background = text == "transparent"
                                           ? glm::vec4(0.0F)
                                           : glm::vec4(parse_color(subject, text), 1.0F);
              })
        .group(group);
    add_value(app, "--exposure", "STOPS",
              "Doubles the light for every stop, halves it for every stop below 0. Default: as the "
              "scene says, else 0.",
              [&](const std::string& subject, const std::string& text) {
                  const Range range{-30, 30, "stops"};
                  options.exposure =
                      static_cast<float>(std::exp2(parse_number(subject, text, range)));
              })
        .group(group);
    add_choice(app, "--tone-mapping", options.tone_mapping, enum_choices<ToneMapping>(),
               "How light brighter than white is shown: as white, or brought down by a curve. "
               "Default: as the scene says, else none.")
        .group(group);
    add_switch(
        app, "--explain-effects", options.explain_effects,
        "Print which effects the scene calls for and which not, with the reason, and with an "
        "--output or --benchmark also what each costs and what the picture would lose. "
        "Alone, it needs no OpenGL.")
        .group(group);
    add_switch(app, "--json", options.json, "Print the summary as one JSON object.").group(group);
    add_switch(
        app, "--strict", options.strict,
        "Exit with 3 if anything was found wrong in the model, such as a missing texture; the "
        "picture is written all the same.")
        .group(group);
}

void add_window_options(CLI::App& app, ViewOptions& options) {
    const std::string group = "Window";
    add_switch(app, "--list-bindings", options.list_bindings,
               "Print what keys and the mouse do in the window.")
        .group(group);
    add_number(app, "--ui-scale", "S", options.ui_scale,
               {least_interface_scale, most_interface_scale, ""},
               "How large letters and panels are: 1 as on an ordinary screen, 2 twice as large. "
               "Default: as chosen in the window the last time (Ctrl++, Ctrl+-), else as the "
               "screen says.")
        .group(group);
    add_switch(app, "--no-state", options.no_state,
               "Neither read nor write where the window was and which panels were open "
               "($XDG_STATE_HOME/relief, else ~/.local/state/relief).")
        .group(group);
    add_path(app, "--dump-state", options.dump_state,
             "Keep what the window shows in FILE, as JSON, for tests and scripts.")
        .group(group);
}

void add_light_options(CLI::App& app, ViewOptions& options) {
    const std::string group = "Light and camera";
    add_repeatable(app, "--light", "LIGHT",
                   "A light, instead of the model's own; may be given many times. "
                   "directional:azimuth,elevation[,intensity[,#rrggbb]] comes from there, in "
                   "degrees; point:x,y,z[,intensity[,#rrggbb]] stands in the model's space; "
                   "spot:x,y,z,tx,ty,tz[,angle[,intensity[,#rrggbb]]] shines from x,y,z towards "
                   "tx,ty,tz in a cone of 30 or angle degrees from its axis; none means no light. "
                   "Intensity 1 makes a white surface white, at distance 1 for point and spot. "
                   "Default: the model's lights, else a key and a fill light.",
                   [&](const std::string& subject, const std::string& text) {
                       options.lights.push_back(parse_light(subject, text));
                   })
        .group(group);
    add_number(app, "--ambient", "A", options.ambient, {0, 1000, ""},
               "Light from everywhere. Default: 0, or 0.08 with the key and fill light.")
        .group(group);
    add_number(app, "--light-markers", "R", options.light_markers, {1e-6, 1, ""},
               "Show point and spot lights as small spheres, of R times the scene's size.")
        .group(group);
    add_value(app, "--camera", "AZIMUTH,ELEVATION[,FACTOR|@X,Y,Z,DISTANCE]",
              "From where the camera looks, in degrees from +z towards +x and above the horizon, "
              "and how far away it is as a factor of the distance that shows all; or, as the "
              "window copies it, what it looks at and how far away that is, which moves no light. "
              "Default: the model's camera, else 30,20,1.",
              [&](const std::string& subject, const std::string& text) {
                  options.camera = parse_camera(subject, text);
              })
        .group(group);
    add_value(app, "--fov", "DEGREES",
              "Vertical field of view. Default: the model's camera's, else 35.",
              [&](const std::string& subject, const std::string& text) {
                  options.vertical_fov = parse_fov(subject, text);
              })
        .group(group);
}

void check_output(const ViewOptions& options) {
    refuse(options.dump_state && !options.wants_window(), "--dump-state",
           "is what a window shows, and none is opened", "leave --output and the like out");
    refuse(options.wants_window() && options.backend != Backend::automatic, "--backend",
           "is for pictures without a window, which brings its own OpenGL",
           "name a picture with --output, or leave it out");
    refuse(options.ui_scale && !options.wants_window(), "--ui-scale",
           "is of a window, and none is opened", "leave it out");
    refuse(options.no_state && !options.wants_window(), "--no-state",
           "is of a window, and none is opened", "leave it out");
    refuse(options.wants_window() && options.json, "--json", "is a summary, and a window has none",
           "name a picture with --output");
    refuse(options.wants_window() && options.strict, "--strict",
           "is about the exit code of a picture, and a window shows its findings",
           "name a picture with --output");
    refuse(is_linear_output(options) && (options.exposure || options.tone_mapping),
           options.exposure ? "--exposure" : "--tone-mapping",
           "belongs to display colours, and this picture holds linear radiance",
           "write a .png, or leave it out");
    if (!options.output) return;
    const std::string extension = extension_of(*options.output);
    refuse(extension != ".png" && extension != ".exr" && extension != ".apng",
           "--output " + options.output->string(), "no format to write a picture in",
           "use .png, .exr or .apng");
    refuse(*options.output == options.model, "--output", "would overwrite the model", "");
    require_folder_of(*options.output);
}

void check_lights(const ViewOptions& options) {
    const bool has_none = std::any_of(
        options.lights.begin(), options.lights.end(),
        [](const LightOption& light) { return std::holds_alternative<NoLight>(light); });
    refuse(has_none && options.lights.size() > 1, "--light none", "contradicts the other lights",
           "");
}

/// The environment takes one or six files, so it may have eaten the model that follows it.
void give_back_model(ViewOptions& options) {
    if (!options.model.empty()) return;
    if (options.environment.size() != 2 && options.environment.size() != 7) return;
    options.model = options.environment.back();
    options.environment.pop_back();
}

}  // namespace

void refuse(bool useless, const std::string& option, const std::string& because,
            const std::string& remedy) {
    if (useless) throw UsageError(option + ": " + because, remedy);
}

CameraOption parse_camera(const std::string& subject, const std::string& text) {
    const std::size_t at = text.find('@');
    const bool has_place = at != std::string::npos;
    std::vector<std::string> fields = split(text.substr(0, at), ',');
    if (fields.size() < 2 || fields.size() > (has_place ? 2 : 3)) {
        throw UsageError(subject +
                         ": not azimuth,elevation or azimuth,elevation,factor or "
                         "azimuth,elevation@x,y,z,distance");
    }
    const auto number = [&](std::size_t i, const Range& range) {
        const std::string field = subject + ": '" + fields[i] + "'";
        return parse_number(field, fields[i], range);
    };
    CameraOption camera{.azimuth = radians_from(number(0, {-360, 360, "degrees"})),
                        .elevation = radians_from(number(1, {-90, 90, "degrees"}))};
    if (fields.size() == 3)
        camera.distance_factor = static_cast<float>(number(2, {0.01, 1000, ""}));
    if (!has_place) return camera;
    fields = split(text.substr(at + 1), ',');
    if (fields.size() != 4)
        throw UsageError(subject + ": what follows the @ is not x,y,z,distance");
    const auto coordinate = [&](std::size_t i) {
        return static_cast<float>(number(i, {-1e30, 1e30, ""}));
    };
    camera.place = {{coordinate(0), coordinate(1), coordinate(2)},
                    static_cast<float>(number(3, {1e-30, 1e30, ""}))};
    return camera;
}

float parse_fov(const std::string& subject, const std::string& text) {
    return radians_from(parse_number(subject, text, {1, 170, "degrees"}));
}

void add_view_options(CLI::App& app, ViewOptions& options) {
    // Not required in CLI11's eyes: settle() looks for it behind --environment.
    add_path(
        app, "MODEL", options.model,
        "Model to show: .glb .gltf .obj .ply .stl .off, or a scene: .json. Without --output, in "
        "a window");
    add_output_options(app, options);
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
    add_debug_options(app, options);
    const Choices<Backend> backends = {
        {"auto", Backend::automatic}, {"osmesa", Backend::osmesa}, {"egl", Backend::egl}};
    add_choice(app, "--backend", options.backend, backends,
               "What gives the OpenGL context of pictures; neither needs a display. Default: auto, "
               "which takes "
               "a GPU through EGL where there is one, else OSMesa, else EGL in software.");
    add_general_options(app, options.general);
}

void settle(ViewOptions& options) {
    give_back_model(options);
    if (options.model.empty() && !options.wants_window() && !options.list_bindings)
        throw UsageError("MODEL is missing");
    check_output(options);
    check_save_options(options);
    check_sequence(options);
    check_reference(options);
    check_compare_options(options);
    check_maps(options);
    check_materials(options);
    check_environment(options);
    check_lights(options);
    check_debug_options(options);
}

bool is_linear_output(const ViewOptions& options) {
    const std::optional<std::filesystem::path>& file =
        options.output ? options.output : options.reference;
    return file && (extension_of(*file) == ".exr" || extension_of(*file) == ".hdr");
}

}  // namespace relief::tools
