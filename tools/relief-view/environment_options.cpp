// SPDX-License-Identifier: Apache-2.0
#include "environment_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/command.h"
#include "common/options.h"
#include "relief/mesh/image_file.h"
#include "relief/shade/scene.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

constexpr const char* environment_group = "Environment";

ImageSource image_file(const std::filesystem::path& file) {
    return {file.string(), file};
}

void add_image_options(CLI::App& app, ViewOptions& options) {
    add_repeatable(
        app, "--environment", "FILE...",
        "Use an environment: one image, six square images in the order +x -x +y -y +z -z, or a "
        "folder with six images whose names end in posx, negx, posy, negy, posz, negz. studio is a "
        "built-in photo studio, which lights the model and is not visible behind it; none means no "
        "environment. Without this option, a scene file has its own one, and a model with a "
        "metallic, coated or transmissive material gets the studio.",
        [&](const std::string&, const std::string& text) {
            options.environment.emplace_back(text);
        })
        .group(environment_group)
        .takes(1, 7);
    add_choice(app, "--environment-layout", options.environment_layout,
               Choices<EnvironmentLayout>{{"auto", EnvironmentLayout::automatic},
                                          {"panorama", EnvironmentLayout::panorama},
                                          {"cross", EnvironmentLayout::cross},
                                          {"probe", EnvironmentLayout::probe}},
               "Set the layout of one image: a latitude-longitude panorama, a cross of six faces, "
               "or an angular light probe. Default: auto, by aspect ratio (2:1, 4:3 or 3:4, 1:1).")
        .group(environment_group);
    add_switch(app, "--left-handed", options.left_handed_environment,
               "Convert six images that were made for a left-handed coordinate system.")
        .group(environment_group);
    add_field(app, options.environment_fields, "--environment-intensity", "I",
              &Environment::intensity, "Multiply the environment's light. Default: 1.")
        .group(environment_group);
    add_value(app, "--environment-rotation", "DEG",
              "Rotate the environment about the y axis, counterclockwise from above. Default: 0.",
              [&](const std::string& subject, const std::string& text) {
                  const double degrees = parse_number(subject, text, {-360, 360, "degrees"});
                  options.environment_fields.set(&Environment::rotation,
                                                 glm::radians(static_cast<float>(degrees)));
              })
        .group(environment_group);
    add_field(app, options.environment_fields, "--background-blur", "B", &Environment::skybox_blur,
              "Blur the visible environment: 1 as a mirror of roughness 1 shows it. Default: 0.")
        .group(environment_group);
    add_field(
        app, options.environment_fields, "--environment-light", &Environment::lights,
        "Light surfaces with the environment. Default: on if a material is metallic-roughness.")
        .group(environment_group);
    add_switch(app, "--no-skybox", "Do not show the environment behind the model.", [&] {
        options.environment_fields.set(&Environment::skybox, false);
    }).group(environment_group);
}

void add_reflection_options(CLI::App& app, ViewOptions& options) {
    add_field(
        app, options.material_fields, "--reflectivity", "R", &Material::reflectivity,
        "Set the reflectivity of materials at normal incidence. It increases at grazing angles. "
        "With an exact --fresnel model, it is a factor. Default: the model's value, else 0.")
        .group(environment_group);
    add_field(app, options.material_fields, "--reflection-roughness", "R",
              &Material::reflection_roughness,
              "Blur reflections: 0 is a mirror, 1 is the maximum. Default: the model's value.")
        .group(environment_group);
    add_value(app, "--fresnel", "none|schlick|dielectric|conductor",
              "Choose the increase of reflections at grazing angles: none, Schlick's "
              "approximation, or the exact formula for a dielectric (glass) or a conductor (gold, "
              "without diffuse reflection). Default: schlick.",
              [&](const std::string& subject, const std::string& text) {
                  const Choices<int> names = {
                      {"none", -1}, {"schlick", 0}, {"dielectric", 1}, {"conductor", 2}};
                  const int chosen = parse_choice(subject, text, names);
                  options.no_fresnel = chosen < 0;
                  if (chosen >= 0)
                      options.material_fields.set(&Material::fresnel,
                                                  static_cast<FresnelModel>(chosen));
              })
        .group(environment_group);
    add_field(app, options.material_fields, "--refractive-index", "N", &Material::refractive_index,
              "Set the refractive index for --fresnel dielectric and --transmission. Default: "
              "1.5, glass.")
        .group(environment_group);
    add_switch(app, "--environment-tint",
               "Multiply ambient, diffuse and specular light by the environment along the normal.",
               [&] { options.material_fields.set(&Material::environment_tint, true); })
        .group(environment_group);
    add_field(app, options.material_fields, "--transmission", "T", &Material::transmission,
              "Set the fraction of the light that is not reflected and passes through the surface "
              "with one refraction. Default: the model's value, else 0.")
        .group(environment_group);
}

EnvironmentLayout layout_of(const std::filesystem::path& file) {
    const ImageInfo info = read_image_info(file);
    const double shape = static_cast<double>(info.width) / info.height;
    const auto is = [&](double expected) { return std::abs(shape / expected - 1.0) < 0.01; };
    if (is(2.0)) return EnvironmentLayout::panorama;
    if (is(4.0 / 3.0) || is(3.0 / 4.0)) return EnvironmentLayout::cross;
    if (is(1.0)) return EnvironmentLayout::probe;
    throw failure(file,
                  fmt::format("the aspect ratio of {} x {} fits no environment layout", info.width,
                              info.height),
                  "set --environment-layout");
}

decltype(Environment::source) one_image(const ViewOptions& options) {
    const std::filesystem::path& file = options.environment.front();
    EnvironmentLayout layout = options.environment_layout.value_or(EnvironmentLayout::automatic);
    if (layout == EnvironmentLayout::automatic) layout = layout_of(file);
    if (layout == EnvironmentLayout::cross) return CubeCross{image_file(file)};
    if (layout == EnvironmentLayout::probe) return AngularMap{image_file(file)};
    return Equirectangular{image_file(file)};
}

/// Tells whether the environment is a word. A file of this name can be given as ./studio.
bool is_word(const ViewOptions& options, const char* word) {
    return options.environment.size() == 1 && options.environment.front() == word;
}

}  // namespace

bool uses_studio(const ViewOptions& options) {
    return is_word(options, "studio");
}

bool uses_no_environment(const ViewOptions& options) {
    return is_word(options, "none");
}

void add_environment_options(CLI::App& app, ViewOptions& options) {
    add_image_options(app, options);
    add_reflection_options(app, options);
}

void check_environment(const ViewOptions& options) {
    const std::size_t files = uses_no_environment(options) ? 0 : options.environment.size();
    refuse(files != 0 && files != 1 && files != 6, "--environment",
           fmt::format("takes one file, six files or a folder, not {} files", files), "");
}

Environment environment_of(const ViewOptions& options) {
    const std::vector<std::filesystem::path>& files = options.environment;
    Environment environment;
    if (uses_studio(options)) {
        environment = studio_environment();
    } else if (files.size() == 6) {
        CubeFaces faces;
        std::transform(files.begin(), files.end(), faces.faces.begin(), image_file);
        environment.source = std::move(faces);
    } else if (std::filesystem::is_directory(files.front())) {
        environment.source = cube_faces_in(files.front());
    } else {
        environment.source = one_image(options);
    }
    if (auto* faces = std::get_if<CubeFaces>(&environment.source))
        faces->left_handed = options.left_handed_environment;
    options.environment_fields.apply(environment);
    return environment;
}

void complete_reflection(Material& material, const ViewOptions& options) {
    const FieldChanges<Material>& fields = options.material_fields;
    if (fields.has(&Material::reflectivity)) material.grazing_reflectivity = glm::vec3(1.0F);
    if (options.no_fresnel) material.grazing_reflectivity = material.reflectivity;
    if (fields.has(&Material::fresnel)) {
        // Gold at 611, 549 and 466 nm [Johnson and Christy 1972].
        material.conductor_index = {0.21F, 0.42F, 1.35F};
        material.conductor_absorption = {3.27F, 2.35F, 1.77F};
        // Metals do not scatter light.
        if (material.fresnel == FresnelModel::conductor)
            material.diffuse = material.ambient = glm::vec3(0.0F);
        const bool exact = material.fresnel != FresnelModel::schlick;
        if (exact && !fields.has(&Material::reflectivity)) material.reflectivity = glm::vec3(1.0F);
    }
    // Transmission needs a reflectivity. The default is that of glass.
    if (fields.has(&Material::transmission) && material.reflectivity == glm::vec3(0.0F))
        material.reflectivity = glm::vec3(0.04F);
}

namespace {

bool is_physical(const Material& material) {
    return material.metallic_roughness.has_value() && !material.unlit;
}

/// Applies options to the environment of a scene file.
void override_scene_environment(Scene& scene, const ViewOptions& options) {
    if (scene.environment) return options.environment_fields.apply(*scene.environment);
    const FieldChanges<Material>& fields = options.material_fields;
    const bool needs_environment =
        !options.environment_fields.empty() || options.no_fresnel ||
        fields.has(&Material::reflectivity) || fields.has(&Material::reflection_roughness) ||
        fields.has(&Material::fresnel) || fields.has(&Material::transmission) ||
        fields.has(&Material::environment_tint);
    if (!needs_environment) return;
    throw UsageError("the scene has no environment for these options",
                     "add --environment, or leave the options out");
}

/// Lights materials by the studio that would be nearly black without surroundings.
void light_by_studio(Scene& scene, std::vector<std::string>& notes) {
    const std::optional<std::string> material = add_default_environment(scene);
    if (!material) return;
    notes.push_back(fmt::format(
        "{} is metallic, coated or transmissive and needs an environment, so the built-in studio "
        "lights the model; --environment none leaves it out",
        *material));
}

}  // namespace

void set_environment(Scene& scene, const ViewOptions& options, std::vector<std::string>& notes) {
    if (uses_no_environment(options)) return scene.environment.reset();
    if (options.environment.empty() && !is_scene_file(options))
        return light_by_studio(scene, notes);
    if (options.environment.empty()) return override_scene_environment(scene, options);
    scene.environment = environment_of(options);
    const bool is_guessed = options.environment_layout.value_or(EnvironmentLayout::automatic) ==
                            EnvironmentLayout::automatic;
    if (is_guessed && std::holds_alternative<AngularMap>(scene.environment->source)) {
        notes.push_back(
            fmt::format("{} is square, so it counts as an angular light probe; "
                        "--environment-layout chooses another layout",
                        options.environment.front().string()));
    }
    const bool physical = std::any_of(scene.materials.begin(), scene.materials.end(), is_physical);
    if (!options.environment_fields.has(&Environment::lights))
        scene.environment->lights |= physical;
    const bool reflected =
        std::any_of(scene.materials.begin(), scene.materials.end(), [](const Material& material) {
            return material.reflectivity != glm::vec3(0.0F) || material.environment_tint;
        });
    if (!reflected && !physical && !scene.environment->lights && !scene.environment->skybox) {
        throw UsageError(
            "--environment: has no effect, because no material reflects it and --no-skybox hides "
            "it",
            "add --reflectivity or --environment-light on, or leave --no-skybox out");
    }
}

}  // namespace relief::tools
