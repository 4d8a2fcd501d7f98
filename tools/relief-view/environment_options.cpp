// SPDX-License-Identifier: Apache-2.0
#include "environment_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/command.h"
#include "common/text.h"
#include "field_options.h"
#include "relief/mesh/image_file.h"
#include "relief/shade/environment_files.h"

namespace relief::tools {
namespace {

constexpr const char* environment_group = "Environment";

ImageSource image_file(const std::filesystem::path& file) {
    return {file.string(), file};
}

void add_image_options(CLI::App& app, ViewOptions& options) {
    add_repeatable(
        app, "--environment", "FILE...",
        "Surroundings: one image, six square images in the order +x -x +y -y +z -z, or "
        "a folder with six images whose names end in posx, negx, posy, negy, posz, negz.",
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
               "How one image is laid out: a panorama by longitude and latitude, a cross of six "
               "faces, or a light probe by angle. Default: auto, by its shape (2:1, 4:3 or 3:4, "
               "1:1).")
        .group(environment_group);
    add_switch(app, "--left-handed", options.left_handed_environment,
               "The six images are drawn for a left-handed world: turn them round.")
        .group(environment_group);
    add_number(app, "--environment-intensity", "I", options.environment_intensity, {0, 1e6, ""},
               "Multiplies the environment's light. Default: 1.")
        .group(environment_group);
    add_choice(app, "--environment-light", options.environment_light,
               Choices<bool>{{"on", true}, {"off", false}},
               "Whether surfaces scatter the environment's light. Default: on if a material is "
               "metallic-roughness.")
        .group(environment_group);
    add_switch(app, "--no-skybox", options.no_skybox,
               "Use the environment but do not show it behind the model.")
        .group(environment_group);
}

void add_reflection_options(CLI::App& app, ViewOptions& options) {
    add_number(app, "--reflectivity", "R", options.reflectivity,
               field_limits(&Material::reflectivity),
               "Share of the environment that materials reflect, seen head on; more at grazing "
               "angles. With an exact --fresnel it multiplies. Default: as the model says, else 0.")
        .group(environment_group);
    add_number(app, "--reflection-roughness", "R", options.reflection_roughness,
               field_limits(&Material::reflection_roughness),
               "How blurred reflections are, from 0, a mirror, to 1. Default: as the model says.")
        .group(environment_group);
    add_value(app, "--fresnel", "none|schlick|dielectric|conductor",
              "How reflections grow towards grazing angles: not at all, by Schlick's formula, or "
              "exactly, for glass or for a metal (gold, which scatters nothing). Default: schlick.",
              [&](const std::string& subject, const std::string& text) {
                  const Choices<int> names = {
                      {"none", -1}, {"schlick", 0}, {"dielectric", 1}, {"conductor", 2}};
                  const int chosen = parse_choice(subject, text, names);
                  options.no_fresnel = chosen < 0;
                  if (chosen >= 0) options.fresnel = static_cast<FresnelModel>(chosen);
              })
        .group(environment_group);
    add_number(app, "--refractive-index", "N", options.refractive_index,
               field_limits(&Material::refractive_index),
               "Of --fresnel dielectric and --transmission. Default: 1.5, glass.")
        .group(environment_group);
    add_number(app, "--transmission", "T", options.transmission,
               field_limits(&Material::transmission),
               "Share of what is not mirrored that shows the environment through the surface, bent "
               "once. Default: as the model says, else 0.")
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
                  fmt::format("an image of {} x {} is not shaped like any environment", info.width,
                              info.height),
                  "say which it is with --environment-layout");
}

decltype(Environment::source) one_image(const ViewOptions& options) {
    const std::filesystem::path& file = options.environment.front();
    EnvironmentLayout layout = options.environment_layout.value_or(EnvironmentLayout::automatic);
    if (layout == EnvironmentLayout::automatic) layout = layout_of(file);
    if (layout == EnvironmentLayout::cross) return CubeCross{image_file(file)};
    if (layout == EnvironmentLayout::probe) return AngularMap{image_file(file)};
    return Equirectangular{image_file(file)};
}

}  // namespace

void add_environment_options(CLI::App& app, ViewOptions& options) {
    add_image_options(app, options);
    add_reflection_options(app, options);
}

void check_environment(const ViewOptions& options) {
    const std::size_t files = options.environment.size();
    const char* const give = "give one, or leave it out";
    refuse(files != 0 && files != 1 && files != 6, "--environment",
           fmt::format("takes one file, six files or a folder, not {} files", files), "");
    // A scene file may bring its own; that is known once it is read.
    const bool none = files == 0 && extension_of(options.model) != ".json";
    refuse(options.no_skybox && none, "--no-skybox", "there is no --environment to hide", "");
    const auto need_environment = [&](bool given, const char* option) {
        refuse(given && none, option, "there is no --environment to reflect", give);
    };
    need_environment(options.reflectivity.has_value(), "--reflectivity");
    need_environment(options.reflection_roughness.has_value(), "--reflection-roughness");
    need_environment(options.fresnel.has_value() || options.no_fresnel, "--fresnel");
    need_environment(options.transmission.has_value(), "--transmission");
    const auto describe_environment = [&](bool given, const char* option) {
        refuse(given && none, option, "there is no --environment", give);
    };
    describe_environment(options.environment_light.has_value(), "--environment-light");
    describe_environment(options.environment_intensity.has_value(), "--environment-intensity");
    const auto describe_images = [&](bool given, const char* option) {
        refuse(given && files == 0, option, "there is no --environment", give);
    };
    describe_images(options.environment_layout.has_value(), "--environment-layout");
    describe_images(options.left_handed_environment, "--left-handed");
    refuse(options.refractive_index && options.fresnel != FresnelModel::dielectric &&
               !options.transmission,
           "--refractive-index", "neither --fresnel dielectric nor --transmission uses it",
           "give one of them, or leave it out");
    const bool one = files == 1 && !std::filesystem::is_directory(options.environment.front());
    refuse(options.environment_layout && !one, "--environment-layout",
           "says how one image is laid out, and there are six", "leave it out");
    refuse(options.left_handed_environment && one, "--left-handed", "is said of six images",
           "leave it out");
    refuse(options.background && files != 0 && !options.no_skybox, "--background",
           "the environment hides it", "add --no-skybox, or leave one of them out");
}

Environment environment_of(const ViewOptions& options) {
    const std::vector<std::filesystem::path>& files = options.environment;
    Environment environment;
    if (files.size() == 6) {
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
    environment.intensity = options.environment_intensity.value_or(1.0F);
    environment.skybox = !options.no_skybox;
    return environment;
}

void set_reflection(Material& material, const ViewOptions& options) {
    if (options.reflectivity) {
        material.reflectivity = glm::vec3(*options.reflectivity);
        material.grazing_reflectivity = glm::vec3(1.0F);
    }
    if (options.no_fresnel) material.grazing_reflectivity = material.reflectivity;
    if (options.fresnel) {
        material.fresnel = *options.fresnel;
        // Gold at 611, 549 and 466 nm [Johnson and Christy 1972].
        material.conductor_index = {0.21F, 0.42F, 1.35F};
        material.conductor_absorption = {3.27F, 2.35F, 1.77F};
        // Metals scatter nothing.
        if (*options.fresnel == FresnelModel::conductor)
            material.diffuse = material.ambient = glm::vec3(0.0F);
        const bool exact = *options.fresnel != FresnelModel::schlick;
        if (exact && !options.reflectivity) material.reflectivity = glm::vec3(1.0F);
    }
    if (options.reflection_roughness) material.reflection_roughness = *options.reflection_roughness;
    if (options.refractive_index) material.refractive_index = *options.refractive_index;
    if (options.transmission) {
        material.transmission = *options.transmission;
        // What nothing is mirrored of, nothing is bent into: glass mirrors a little.
        if (material.reflectivity == glm::vec3(0.0F)) material.reflectivity = glm::vec3(0.04F);
    }
}

}  // namespace relief::tools
