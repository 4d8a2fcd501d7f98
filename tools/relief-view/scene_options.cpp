// SPDX-License-Identifier: Apache-2.0
// Adds the options of materials and the environment, and composes the scene and the camera.
// Tests: tests/tools/scene_options_test.cpp.
#include "scene_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <numbers>
#include <set>

#include "common/command.h"
#include "common/model_file.h"
#include "common/options.h"
#include "common/text.h"
#include "environment_options.h"
#include "light_options.h"
#include "material_options.h"
#include "near_names.h"
#include "relief/shade/reference.h"
#include "relief/shade/scene.h"
#include "relief/shade/scene_file.h"
#include "relief/shade/scene_graph.h"
#include "window/orbit_camera.h"

namespace relief::tools {
using namespace relief::detail;
using namespace relief::shade;

// The model.

namespace {

constexpr const char* model_group = "Model";

/// Returns up to three models of a folder, for a message.
std::string models_in(const std::filesystem::path& folder) {
    constexpr std::size_t shown = 3;
    std::set<std::string> names;
    std::error_code problem;
    for (const auto& entry : std::filesystem::directory_iterator(folder, problem)) {
        if (has_model_extension(entry.path()) || extension_of(entry.path()) == ".json")
            names.insert(entry.path().filename().string());
    }
    if (names.empty()) return "it contains no model";
    const std::size_t count = names.size();
    while (names.size() > shown)
        names.erase(std::prev(names.end()));
    return fmt::format("name a file in it: {}{}", fmt::join(names, ", "),
                       count > shown ? ", ..." : "");
}

}  // namespace

void add_model_options(CLI::App& app, ViewOptions& options) {
    add_choice(app, "--up", options.up, enum_choices<UpAxis>(),
               "Set the axis of the model that points up. auto is z for STL files and y for "
               "others. Default: auto.")
        .group(model_group);
    add_value(app, "--material-variant", "NAME|N",
              "Draw the material variant of this name or number of a glTF file "
              "(KHR_materials_variants). Default: the materials without a variant.",
              [&](const std::string&, const std::string& text) { options.material_variant = text; })
        .group(model_group);
    add_choice(app, "--normals", options.normals, enum_choices<NormalMode>(),
               "The source of normals, as in relief-mesh process: the file (keep), one per "
               "triangle (flat), or an average around each vertex. Default: keep; glTF without "
               "normals gets flat ones, and other files angle.")
        .group(model_group);
    add_number(app, "--crease", "DEG", options.crease_degrees, {0.0, 180.0, "degrees"},
               "Edges sharper than this angle in degrees are hard, where normals are computed. "
               "Default: 30 for STL files; others have hard edges only between the smoothing "
               "groups of an OBJ file.")
        .group(model_group);
}

SceneOptions scene_options(const ViewOptions& options) {
    using Model = SceneOptions::MaterialModel;
    SceneOptions read;
    read.model = reason_for_phong(options).empty() ? Model::as_authored : Model::phong;
    read.normals = options.normals.value_or(read.normals);
    if (options.crease_degrees)
        read.crease_angle = *options.crease_degrees * std::numbers::pi / 180.0;
    read.up = options.up.value_or(read.up);
    read.material_variant = options.material_variant;
    return read;
}

namespace {

bool has_place(const ViewOptions& options) {
    return options.camera && options.camera->place;
}

/// The camera for which the default lights are placed. An explicit camera position does not affect
/// it, so that a view that was copied from the window has the same lighting.
Camera default_camera(const Scene& scene, const ViewOptions& options) {
    const bool has_direction = options.camera && !has_place(options);
    if (scene.camera && !has_direction) {
        Camera camera = *scene.camera;
        camera.vertical_fov = options.vertical_fov.value_or(camera.vertical_fov);
        return camera;
    }
    const CameraOption view =
        has_direction ? *options.camera
                      : CameraOption{.azimuth = default_azimuth, .elevation = default_elevation};
    const float aspect = static_cast<float>(options.size.x) / static_cast<float>(options.size.y);
    return framed(scene, view.azimuth, view.elevation,
                  options.vertical_fov.value_or(default_vertical_fov), aspect,
                  view.distance_factor);
}

/// Makes the camera orthographic, so that it shows the whole model, enlarged by the factor of
/// --camera. A camera that follows the scene keeps this height.
void make_orthographic(ComposedScene& composed, const ViewOptions& options) {
    Scene& scene = composed.scene();
    const float aspect = static_cast<float>(options.size.x) / static_cast<float>(options.size.y);
    if (composed.camera_follows_scene) {
        scene.camera = orthographic(scene, composed.camera, aspect);
        composed.camera = *scene.camera;
        return;
    }
    const CameraOption view = options.camera.value_or(
        CameraOption{.azimuth = default_azimuth, .elevation = default_elevation});
    const Camera whole =
        framed(scene, view.azimuth, view.elevation, composed.camera.vertical_fov, aspect);
    composed.camera = orthographic(scene, whole, aspect);
    *composed.camera.orthographic_height *= view.distance_factor;
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
            "the model has no light, so only the environment lights the scene");
    } else if (light_count(scene) == 0) {
        add_default_lights(scene, composed.camera);
        composed.notes.emplace_back(
            "the model has no light, so a key light and a fill light were added");
    }
    options.scene_fields.apply(scene);
    if (options.scene_fields.has(&Scene::shadow) && light_count(scene) == 0) {
        throw UsageError("--shadow: there is no light that could cast one",
                         "add one with --light, or leave it out");
    }
}

/// Shows point lights and spotlights as spheres, relative to the size of the scene.
void mark_lights(ComposedScene& composed, float share) {
    const Bounds bounds = world_bounds(composed.scene());
    const float size = bounds.empty() ? 1.0F : glm::length(bounds.max - bounds.min);
    if (composed.scene().point_lights.empty() && composed.scene().spot_lights.empty()) {
        throw UsageError("--light-markers: there is no point or spot light to show",
                         "add one with --light, or leave it out");
    }
    add_light_markers(composed.graph, share * std::max(size, std::numeric_limits<float>::min()));
}

/// Returns the index of a thing of the file that an option names or numbers from 1.
/// \param thing  for messages, for example "animation"
std::size_t named_index(const std::string& option, const std::string& thing,
                        const std::vector<std::string>& names, const std::string& text) {
    if (names.empty()) {
        throw UsageError(fmt::format("{}: the model has no {} of its own to choose", option, thing),
                         "leave it out");
    }
    const auto found = std::find(names.begin(), names.end(), text);
    if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (text == fmt::format("{}", i + 1)) return i;
    }
    throw UsageError(
        fmt::format("{} {}: no such {}{}", option, text, thing, did_you_mean(text, names)),
        fmt::format("there are {}", fmt::join(names, ", ")));
}

/// Selects what --animation, --model-camera and --time name, and moves the scene accordingly.
void select_pose(SceneGraph& graph, const ViewOptions& options) {
    if (options.animation) {
        graph.clip.reset();
        if (*options.animation != "all")
            graph.clip =
                named_index("--animation", "animation", clip_names(graph), *options.animation);
    }
    if (options.model_camera)
        choose_camera(graph, named_index("--model-camera", "camera", camera_names(graph),
                                         *options.model_camera));
    if (options.time || options.animation || options.model_camera)
        pose(graph, options.time.value_or(0.0));
}

}  // namespace

ComposedScene compose_scene(ViewOptions& options, Stages& stages, Report& report) {
    if (std::filesystem::is_directory(options.model))
        throw failure(options.model, "is a folder, not a model", models_in(options.model));
    ComposedScene composed;
    composed.graph = stages.run("read", [&] {
        return about(options.model, [&] {
            return load_scene_graph(options.model, scene_options(options), report);
        });
    });
    if (is_scene_file(options))
        stages.run("check maps", [&] { check_scene_maps(composed.scene(), options); });
    if (!options.size_given) options.size = composed.graph.picture_size.value_or(options.size);
    select_pose(composed.graph, options);
    Scene& scene = composed.scene();
    if (scene.instances.empty()) throw FileError(options.model, "contains no triangles");
    if (options.frames && duration(composed.graph) == 0.0 && !options.seconds)
        throw UsageError("--frames: the scene has no animation", "use --turntable");
    override_materials(scene, options, stages, report, composed.notes);
    set_environment(scene, options, composed.notes);
    // Only scene files have a background.
    if (!is_scene_file(options)) scene.background = default_background;
    composed.camera_follows_scene = scene.camera && !options.camera;
    composed.camera = default_camera(scene, options);
    set_lights(composed, options);
    if (scene.ambient_occlusion)
        stages.run("ambient occlusion", [&] { add_ambient_occlusion(scene); });
    const Bounds bounds = world_bounds(scene);
    if (!bounds.empty()) composed.middle = 0.5F * (bounds.min + bounds.max);
    for (const Instance& instance : scene.instances)
        composed.at_rest.push_back(instance.world_from_object);
    if (options.light_markers) mark_lights(composed, *options.light_markers);
    if (has_place(options)) {
        const OrbitCamera orbit = orbit_of(*options.camera, *options.camera->place,
                                           composed.camera.vertical_fov, options.orthographic);
        composed.camera = camera_of(orbit, bounding_sphere(world_bounds(scene)));
    } else if (options.orthographic) {
        make_orthographic(composed, options);
    }
    return composed;
}

std::size_t triangle_count(const Scene& scene) {
    std::size_t count = 0;
    for (const Instance& instance : scene.instances)
        count += scene.meshes[instance.mesh]->triangles.size();
    return count;
}

}  // namespace relief::tools
