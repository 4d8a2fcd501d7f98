// SPDX-License-Identifier: Apache-2.0
#include "view_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <numbers>
#include <optional>
#include <string_view>
#include <vector>

#include "common/file_jobs.h"
#include "common/options.h"
#include "common/text.h"
#include "effect_options.h"
#include "picture_comparison.h"
#include "portable_math.h"
#include "relief/mesh/report.h"
#include "scene_options.h"
#include "view_command.h"
#include "window/window_system.h"

namespace relief::tools {
namespace {

const Range intensities{0, 1e9, ""};

/// The values after the colon of a light.
class Fields {
  public:
    Fields(std::string subject, std::string form, std::string_view text)
        : subject_(std::move(subject)), form_(std::move(form)), fields_(split(text, ',')) {}

    /// The next value, which is required.
    float number(const Range& range) {
        if (done()) throw UsageError(subject_ + ": too few values", form_);
        const std::string& field = fields_[used_++];
        return static_cast<float>(parse_number(subject_ + ": '" + field + "'", field, range));
    }

    /// The next value, or a default at the end of the text.
    float number_or(float otherwise, const Range& range) {
        return done() ? otherwise : number(range);
    }

    glm::vec3 position() {
        const float x = number({});
        const float y = number({});
        const float z = number({});
        return {x, y, z};
    }

    struct Power {
        glm::vec3 light{1.0F};
        glm::vec3 ambient{0.0F};
    };

    /// The common end of all lights: INTENSITY[,#RRGGBB[,AMBIENT]].
    Power power() {
        glm::vec3 light(number_or(1.0F, intensities));
        if (!done()) {
            const std::string& field = fields_[used_++];
            light *= parse_color(subject_ + ": '" + field + "'", field);
        }
        const float share = number_or(0.0F, {0, 1000, ""});
        if (!done()) throw UsageError(subject_ + ": too many values", form_);
        return {light, share * light};
    }

  private:
    [[nodiscard]] bool done() const { return used_ == fields_.size(); }

    std::string subject_;
    std::string form_;
    std::vector<std::string> fields_;
    std::size_t used_ = 0;
};

DirectionalLight directional(const std::string& subject, std::string_view text) {
    Fields fields(subject, "directional:azimuth,elevation[,intensity[,#rrggbb[,ambient]]]", text);
    const float azimuth = glm::radians(fields.number({-360, 360, "degrees"}));
    const float elevation = glm::radians(fields.number({-90, 90, "degrees"}));
    const Fields::Power power = fields.power();
    return {.direction_world = -towards(azimuth, elevation),
            .irradiance = power.light,
            .ambient = power.ambient};
}

PointLight point(const std::string& subject, std::string_view text) {
    Fields fields(subject, "point:x,y,z[,intensity[,#rrggbb[,ambient]]]", text);
    PointLight light;
    light.position_world = fields.position();
    const Fields::Power power = fields.power();
    light.intensity = power.light;
    light.ambient = power.ambient;
    return light;
}

SpotLight spot(const std::string& subject, std::string_view text) {
    Fields fields(subject, "spot:x,y,z,tx,ty,tz[,angle[,intensity[,#rrggbb[,ambient]]]]", text);
    // The ratio of the inner to the outer cone.
    constexpr float full_share = 0.75F;
    SpotLight light;
    light.point.position_world = fields.position();
    light.direction_world = fields.position() - light.point.position_world;
    if (light.direction_world == glm::vec3(0.0F))
        throw UsageError(subject + ": the position and the target of the spotlight are the same");
    light.outer_cone = glm::radians(fields.number_or(30.0F, {0.1, 90, "degrees"}));
    light.inner_cone = full_share * light.outer_cone;
    const Fields::Power power = fields.power();
    light.point.intensity = power.light;
    light.point.ambient = power.ambient;
    return light;
}

}  // namespace

glm::vec3 towards(float azimuth, float elevation) {
    const auto sine = [](float angle) {
        return static_cast<float>(portable::sin(static_cast<double>(angle)));
    };
    const auto cosine = [](float angle) {
        return static_cast<float>(portable::cos(static_cast<double>(angle)));
    };
    return {cosine(elevation) * sine(azimuth), sine(elevation),
            cosine(elevation) * cosine(azimuth)};
}

LightOption parse_light(const std::string& subject, const std::string& text) {
    if (text == "none") return NoLight{};
    const std::size_t colon = text.find(':');
    const std::string kind = text.substr(0, colon);
    const std::string_view rest =
        colon == std::string::npos ? "" : std::string_view(text).substr(colon + 1);
    if (kind == "directional") return directional(subject, rest);
    if (kind == "point") return point(subject, rest);
    if (kind == "spot") return spot(subject, rest);
    throw UsageError(subject + ": not a light",
                     "start with directional:, point: or spot:, or use none");
}

namespace {

/// Computes in double precision, so that degrees_text() (orbit_camera.h) is inverted exactly.
float radians_from(double degrees) {
    return static_cast<float>(glm::radians(degrees));
}

void add_output_options(CLI::App& app, ViewOptions& options) {
    const std::string group = "Output";
    add_path(
        app, "--output", options.output,
        "Write the picture to FILE: .png (8 bit, sRGB), .exr (linear float), .apng (animated), or "
        ".mp4 or .webm (videos, by the program ffmpeg).")
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
                  options.background = text == "transparent"
                                           ? glm::vec4(0.0F)
                                           : glm::vec4(parse_color(subject, text), 1.0F);
              })
        .group(group);
    add_value(app, "--exposure", "STOPS",
              "Double the brightness for each stop; negative stops halve it. Default: the value in "
              "the scene file, else 0.",
              [&](const std::string& subject, const std::string& text) {
                  const Range range{-30, 30, "stops"};
                  options.exposure = static_cast<float>(
                      portable::exp(std::numbers::ln2 * parse_number(subject, text, range)));
              })
        .group(group);
    add_choice(app, "--tone-mapping", options.tone_mapping, enum_choices<ToneMapping>(),
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

void add_light_options(CLI::App& app, ViewOptions& options) {
    const std::string group = "Lights and camera";
    add_repeatable(
        app, "--light", "LIGHT",
        "Replace the model's lights; may be given several times. "
        "directional:azimuth,elevation[,intensity[,#rrggbb[,ambient]]] shines from this direction, "
        "in degrees; point:x,y,z[,intensity[,#rrggbb[,ambient]]] is in world space, y up; "
        "spot:x,y,z,tx,ty,tz[,angle[,intensity[,#rrggbb[,ambient]]]] shines from x,y,z towards "
        "tx,ty,tz in a cone of 30 or angle degrees from its axis; none removes all lights. "
        "Intensity 1 makes a white surface white, at distance 1 for point and spot. ambient (0) is "
        "the fraction of the light that it adds as ambient light, everywhere. Default: the model's "
        "lights, else a key light and a fill light.",
        [&](const std::string& subject, const std::string& text) {
            options.lights.push_back(parse_light(subject, text));
        })
        .group(group);
    add_number(app, "--ambient", "A", options.ambient, {0, 1000, ""},
               "Set the ambient light of the scene, to which lights may add. Default: 0, or 0.08 "
               "with the key light and fill light.")
        .group(group);
    add_switch(app, "--clamp-terms", options.clamp_terms,
               "Clamp each term of the Phong model to 0 to 1 before the sum, for each light, as "
               "hardware with fixed functions did.")
        .group(group);
    add_number(app, "--shadow", "DEG", options.shadow_size, {0, 30, "degrees"},
               "Show the shadow of the first directional light, else of the first spot or point "
               "light. DEG is the size of the light as an angle: 0 gives hard edges, 2 soft ones. "
               "Default: that of the scene file, else no shadow.")
        .group(group);
    add_number(app, "--ambient-occlusion", "D", options.ambient_occlusion, {0, 100, ""},
               "Dim ambient light and the environment's light where surfaces within D times the "
               "scene's size hide it: 0.5 is usual, 0 is none. It is computed once for every "
               "vertex. Default: that of the scene file, else 0.")
        .group(group);
    add_number(
        app, "--light-markers", "R", options.light_markers, {1e-6, 1, ""},
        "Show point lights and spotlights as spheres with a radius of R times the scene's size.")
        .group(group);
    add_value(app, "--camera", "AZIMUTH,ELEVATION[,FACTOR|@X,Y,Z,DISTANCE]",
              "Set the direction of the camera in degrees, from +z towards +x and above the "
              "horizon, and its distance as a factor of the distance that shows the whole model. "
              "Alternatively, set the target and the distance from it, as the window copies them; "
              "then the default lights do not move. Default: the model's camera, else 30,20,1.",
              [&](const std::string& subject, const std::string& text) {
                  options.camera = parse_camera(subject, text);
              })
        .group(group);
    add_value(app, "--fov", "DEGREES",
              "Set the vertical field of view. Default: that of the model's camera, else 35.",
              [&](const std::string& subject, const std::string& text) {
                  options.vertical_fov = parse_fov(subject, text);
              })
        .group(group);
    add_switch(app, "--orthographic", options.orthographic,
               "Use parallel projection. The size of the model is that at the target of --camera, "
               "else the whole model is shown.")
        .group(group);
    add_value(app, "--model-camera", "NAME|N",
              "Look through the camera of this name or number of a glTF file. Default: the first "
              "camera.",
              [&](const std::string&, const std::string& text) { options.model_camera = text; })
        .group(group);
}

void check_output(const ViewOptions& options) {
    refuse(options.dump_state && !options.wants_window(), "--dump-state", "no window is opened",
           "leave --output out");
    refuse(options.wants_window() && options.backend != Backend::automatic, "--backend",
           "applies to pictures; the window uses the OpenGL of its display",
           "add --output, or leave it out");
    refuse(options.ui_scale && !options.wants_window(), "--ui-scale", "no window is opened",
           "leave it out");
    refuse(options.no_state && !options.wants_window(), "--no-state", "no window is opened",
           "leave it out");
    refuse(options.wants_window() && options.json, "--json", "the window prints no summary",
           "add --output");
    refuse(options.wants_window() && options.strict, "--strict",
           "the window shows the findings and has no exit code for them", "add --output");
    refuse(is_linear_output(options) && (options.exposure || options.tone_mapping),
           options.exposure ? "--exposure" : "--tone-mapping",
           "applies to display colors, not to linear radiance", "write a .png, or leave it out");
    if (!options.output) return;
    const std::string extension = extension_of(*options.output);
    constexpr std::array formats = {".png", ".exr", ".apng", ".mp4", ".webm"};
    refuse(std::find(formats.begin(), formats.end(), extension) == formats.end(),
           "--output " + options.output->string(), "unsupported format",
           "use .png, .exr, .apng, .mp4 or .webm");
    require_folder_of(*options.output);
}

void check_lights(const ViewOptions& options) {
    const bool has_none = std::any_of(
        options.lights.begin(), options.lights.end(),
        [](const LightOption& light) { return std::holds_alternative<NoLight>(light); });
    refuse(has_none && options.lights.size() > 1, "--light none", "contradicts the other lights",
           "");
}

/// --environment takes one or six files, so it may have taken the model that follows it.
void recover_model(ViewOptions& options) {
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
    if (fields.size() != 4) throw UsageError(subject + ": expected x,y,z,distance after the @");
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
    add_debug_options(app, options);
    const Choices<Backend> backends = {
        {"auto", Backend::automatic}, {"osmesa", Backend::osmesa}, {"egl", Backend::egl}};
    add_choice(app, "--backend", options.backend, backends,
               "Choose the OpenGL context for pictures. No backend needs a display. auto prefers a "
               "GPU with EGL, then OSMesa, then EGL in software. Default: auto.");
    add_general_options(app, options.general);
}

void check_written_files(const ViewOptions& options, std::vector<std::filesystem::path> others) {
    others.insert(others.end(), options.environment.begin(), options.environment.end());
    for (const auto& file : {std::optional(options.model), options.compare.file, options.reference,
                             options.normal_map, options.height_map, options.diffuse_map}) {
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
    if (options.model.empty() && !options.wants_window() && !options.list_bindings)
        throw UsageError("MODEL is missing");
    check_output(options);
    check_written_files(options, {});
    check_save_options(options);
    check_sequence(options);
    check_reference(options);
    check_compare_options(options);
    check_model(options);
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

namespace {

template <typename Value>
VariantTopic topic(const std::string& name, const std::string& what,
                   const Choices<Value>& choices) {
    VariantTopic result{name, what, {}};
    for (const auto& [word, value] : choices)
        result.choices.emplace_back(std::string(word), Variant(value));
    return result;
}

/// All modes except keeping the normals.
Choices<NormalMode> computed_normals() {
    Choices<NormalMode> choices = enum_choices<NormalMode>();
    std::erase_if(choices, [](const auto& choice) { return choice.second == NormalMode::keep; });
    return choices;
}

/// The mesh's tangents, computed ones, and none: the shader then derives frames.
Choices<TangentMethod> displayed_tangents() {
    Choices<TangentMethod> choices = {{"stored", TangentMethod::keep}};
    for (const auto& [name, method] : tangent_choices()) {
        if (computes_tangents(method)) choices.emplace_back(name, method);
    }
    choices.emplace_back("derivatives", TangentMethod::none);
    return choices;
}

std::string unknown(const VariantTopic& topic) {
    std::vector<std::string> words;
    for (const auto& [word, variant] : topic.choices)
        words.push_back(word);
    return fmt::format("{}: not one of {}", topic.name, fmt::join(words, ", "));
}

}  // namespace

const std::vector<VariantTopic>& variant_topics() {
    static const std::vector<VariantTopic> topics = {
        topic("interpolation", "Where the lighting is computed", enum_choices<Interpolation>()),
        topic("map", "The map that perturbs the normals",
              Choices<MapUse>{{"none", MapUse::none},
                              {"bump_map", MapUse::bump_map},
                              {"normal_map", MapUse::normal_map}}),
        topic("kernel", "The kernel that computes slopes from heights", enum_choices<Kernel>()),
        topic("tangents", "The tangent frames of the maps", displayed_tangents()),
        topic("bits", "Bits per channel of the normal map",
              Choices<MapBits>{{"8", MapBits::eight}, {"16", MapBits::sixteen}}),
        topic("normals", "The weights of vertex normals", computed_normals()),
    };
    return topics;
}

Variant parse_variant(const std::string& subject, const std::string& text) {
    const std::size_t equals = std::min(text.find('='), text.size());
    const std::string name = text.substr(0, equals);
    std::vector<std::string> names;
    for (const VariantTopic& topic : variant_topics()) {
        names.push_back(topic.name + "=");
        if (topic.name != name || equals == text.size()) continue;
        for (const auto& [word, variant] : topic.choices) {
            if (word == text.substr(equals + 1)) return variant;
        }
        throw UsageError(subject + ": " + unknown(topic));
    }
    throw UsageError(fmt::format("{}: not one of {}", subject, fmt::join(names, ", ")));
}

std::string to_text(const Variant& variant) {
    for (const VariantTopic& topic : variant_topics()) {
        for (const auto& [word, value] : topic.choices) {
            if (value == variant) return topic.name + "=" + word;
        }
    }
    return "";
}

PreparedVariant prepare(const Variant& variant, const Scene& scene, const ViewOptions& options,
                        Report& report) {
    using Lack = UnchangedScene::Lack;
    try {
        return prepare_variant(variant, scene, scene_heights(options), report);
    } catch (const UnchangedScene& error) {
        throw UsageError("--compare " + to_text(variant) + ": " + error.what(),
                         error.lack == Lack::nothing   ? "choose another one"
                         : error.lack == Lack::heights ? "give --height-map"
                                                       : "give --normal-map or --height-map");
    }
}

}  // namespace relief::tools
