// SPDX-License-Identifier: Apache-2.0
#include "scene_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "common/text.h"
#include "environment_options.h"
#include "material_options.h"
#include "material_overrides.h"
#include "relief/shade/default_view.h"
#include "relief/shade/framing.h"
#include "relief/shade/scene_file.h"
#include "window/orbit_camera.h"

namespace relief::tools {
namespace {

bool is_physical(const Material& material) {
    return material.metallic_roughness.has_value() && !material.unlit;
}

/// What the options say of the surroundings that a scene file brings.
void change_own_environment(Scene& scene, const ViewOptions& options) {
    if (!scene.environment) {
        const bool asked = options.no_skybox || options.environment_light ||
                           options.environment_intensity || options.reflectivity ||
                           options.reflection_roughness || options.fresnel || options.no_fresnel ||
                           options.transmission;
        if (!asked) return;
        throw UsageError("the scene has no environment, which one of the options is about",
                         "give one with --environment, or leave the option out");
    }
    if (options.no_skybox) scene.environment->skybox = false;
    scene.environment->lights = options.environment_light.value_or(scene.environment->lights);
    scene.environment->intensity =
        options.environment_intensity.value_or(scene.environment->intensity);
}

void set_environment(Scene& scene, const ViewOptions& options) {
    if (options.environment.empty()) {
        change_own_environment(scene, options);
        return;
    }
    scene.environment = environment_of(options);
    const bool physical = std::any_of(scene.materials.begin(), scene.materials.end(), is_physical);
    scene.environment->lights = options.environment_light.value_or(physical);
    const bool reflected = std::any_of(
        scene.materials.begin(), scene.materials.end(),
        [](const Material& material) { return material.reflectivity != glm::vec3(0.0F); });
    if (!reflected && !physical && !scene.environment->lights && options.no_skybox) {
        throw UsageError(
            "--environment: would show nowhere, as no material reflects it and "
            "--no-skybox hides it",
            "add --reflectivity or --environment-light on, or leave --no-skybox out");
    }
}

bool has_place(const ViewOptions& options) {
    return options.camera && options.camera->place;
}

/// The view for which lamps are set up: what an option says of its place moves no lamp, so that a
/// view that was copied from the window shows the same light.
Camera usual_camera(const Scene& scene, const ViewOptions& options) {
    const bool is_told = options.camera && !has_place(options);
    if (scene.camera && !is_told) {
        Camera camera = *scene.camera;
        camera.vertical_fov = options.vertical_fov.value_or(camera.vertical_fov);
        return camera;
    }
    const CameraOption view =
        is_told ? *options.camera
                : CameraOption{.azimuth = default_azimuth, .elevation = default_elevation};
    const float aspect = static_cast<float>(options.size.x) / static_cast<float>(options.size.y);
    return framed(scene, view.azimuth, view.elevation,
                  options.vertical_fov.value_or(default_vertical_fov), aspect,
                  view.distance_factor);
}

std::size_t light_count(const Scene& scene) {
    return scene.directional_lights.size() + scene.point_lights.size() + scene.spot_lights.size();
}

void add_light(Scene& scene, const LightOption& option) {
    if (const auto* directional = std::get_if<DirectionalLight>(&option))
        scene.directional_lights.push_back(*directional);
    else if (const auto* point = std::get_if<PointLight>(&option))
        scene.point_lights.push_back(*point);
    else if (const auto* spot = std::get_if<SpotLight>(&option))
        scene.spot_lights.push_back(*spot);
}

void replace_lights(Scene& scene, const std::vector<LightOption>& lights,
                    std::vector<std::string>& notes) {
    if (const std::size_t own = light_count(scene); own != 0)
        notes.push_back(fmt::format("--light replaces {} of the model", counted(own, "light")));
    scene.directional_lights.clear();
    scene.point_lights.clear();
    scene.spot_lights.clear();
    for (const LightOption& light : lights)
        add_light(scene, light);
}

void set_lights(ComposedScene& composed, const ViewOptions& options) {
    Scene& scene = composed.scene();
    if (!options.lights.empty()) {
        replace_lights(scene, options.lights, composed.notes);
    } else if (light_count(scene) == 0 && scene.environment && scene.environment->lights) {
        composed.notes.emplace_back(
            "neither the model nor --light gives a light: the environment "
            "is the only one");
    } else if (light_count(scene) == 0) {
        add_default_lights(scene, composed.camera);
        composed.notes.emplace_back(
            "neither the model nor --light gives a light: a key and a fill light were added");
    }
    if (options.ambient) scene.ambient = glm::vec3(*options.ambient);
}

SceneOptions scene_options(const ViewOptions& options) {
    using Model = SceneOptions::MaterialModel;
    return {reason_for_phong(options).empty() ? Model::as_authored : Model::phong};
}

/// Scene files say what is behind the model; model files cannot.
bool has_own_background(const ViewOptions& options) {
    return extension_of(options.model) == ".json";
}

/// Shows lamps that have a place, of a size that follows the scene's.
void mark_lights(ComposedScene& composed, float share) {
    const Bounds bounds = world_bounds(composed.scene());
    const float size = bounds.empty() ? 1.0F : glm::length(bounds.max - bounds.min);
    if (composed.scene().point_lights.empty() && composed.scene().spot_lights.empty()) {
        throw UsageError("--light-markers: there is no point or spot light to show",
                         "add one with --light, or leave it out");
    }
    add_light_markers(composed.graph, share * std::max(size, std::numeric_limits<float>::min()));
}

}  // namespace

ComposedScene compose_scene(ViewOptions& options, Stages& stages, Report& report) {
    ComposedScene composed;
    composed.graph = stages.run("read", [&] {
        return about(options.model, [&] {
            return load_scene_graph(options.model, scene_options(options), report);
        });
    });
    if (!options.size_given) options.size = composed.graph.picture_size.value_or(options.size);
    if (options.time) pose(composed.graph, *options.time);
    Scene& scene = composed.scene();
    if (scene.instances.empty())
        throw FileError(options.model, "holds no triangles, so there is nothing to draw");
    if (options.frames && duration(composed.graph) == 0.0 && !options.seconds)
        throw UsageError("--frames: nothing moves in this scene", "use --turntable");
    override_materials(scene, options, stages, report, composed.notes);
    set_environment(scene, options);
    scene.background = options.background.value_or(
        has_own_background(options) ? scene.background : default_background);
    scene.exposure = options.exposure.value_or(scene.exposure);
    scene.tone_mapping = options.tone_mapping.value_or(scene.tone_mapping);
    composed.camera_follows_scene = scene.camera && !options.camera;
    composed.camera = usual_camera(scene, options);
    set_lights(composed, options);
    const Bounds bounds = world_bounds(scene);
    if (!bounds.empty()) composed.middle = 0.5F * (bounds.min + bounds.max);
    for (const Instance& instance : scene.instances)
        composed.at_rest.push_back(instance.world_from_object);
    if (options.light_markers) mark_lights(composed, *options.light_markers);
    if (has_place(options)) {
        const OrbitCamera orbit =
            orbit_of(*options.camera, *options.camera->place, composed.camera.vertical_fov);
        composed.camera = camera_of(orbit, ball_around(world_bounds(scene)));
    }
    return composed;
}

}  // namespace relief::tools
