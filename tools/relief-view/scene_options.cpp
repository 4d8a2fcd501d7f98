// SPDX-License-Identifier: Apache-2.0
// Adds the options of materials and the environment, and composes the scene and the camera.
// Tests: tests/tools/scene_options_test.cpp.
#include "scene_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <set>
#include <string_view>
#include <utility>

#include "common/command.h"
#include "common/options.h"
#include "common/text.h"
#include "near_names.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/map_description.h"
#include "relief/shade/reference.h"
#include "relief/shade/scene.h"
#include "relief/shade/scene_file.h"
#include "window/orbit_camera.h"

namespace relief::tools {

// The model.

namespace {

constexpr const char* model_group = "Model";

/// Returns up to three models of a folder, for a message.
std::string models_in(const std::filesystem::path& folder) {
    constexpr std::array<std::string_view, 7> extensions = {".glb", ".gltf", ".obj", ".ply",
                                                            ".stl", ".off",  ".json"};
    constexpr std::size_t shown = 3;
    std::set<std::string> names;
    std::error_code problem;
    for (const auto& entry : std::filesystem::directory_iterator(folder, problem)) {
        const std::string extension = extension_of(entry.path());
        if (std::find(extensions.begin(), extensions.end(), extension) != extensions.end())
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

void check_model(const ViewOptions& options) {
    const bool is_scene = extension_of(options.model) == ".json";
    const auto refuse_for_scene = [&](bool given, const char* option, const char* remedy) {
        refuse(given && is_scene, option, "applies to model files, not to scene files", remedy);
    };
    refuse_for_scene(options.up.has_value(), "--up", "rotate the nodes of the scene");
    refuse_for_scene(options.normals.has_value(), "--normals",
                     "set 'normals' beside 'model' in the scene");
    refuse_for_scene(options.crease_degrees.has_value(), "--crease",
                     "set 'crease' beside 'model' in the scene");
    refuse(options.crease_degrees && options.normals == NormalMode::flat, "--crease",
           "contradicts --normals flat, which makes all edges hard", "leave one of them out");
    const std::string extension = extension_of(options.model);
    const bool is_gltf = extension == ".gltf" || extension == ".glb";
    refuse(options.material_variant && !is_gltf, "--material-variant",
           "only glTF files have material variants", "leave it out");
    refuse(options.model_camera && !is_gltf, "--model-camera", "only glTF files have cameras",
           "use --camera");
    refuse(options.model_camera && options.camera, "--model-camera", "contradicts --camera",
           "leave one of them out");
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

// Maps and materials.

namespace {

constexpr const char* maps_group = "Maps for all materials (the model needs texture coordinates)";

void add_normal_options(CLI::App& app, ViewOptions& options) {
    add_path(app, "--normal-map", options.normal_map, "Read a normal map from FILE.")
        .group(maps_group);
    add_choice(app, "--green", options.green, enum_choices<Green>(),
               "Set the direction of the normal map's green channel: up (OpenGL, glTF) or down "
               "(DirectX). Default: from the file's metadata, else up.")
        .group(maps_group);
    add_choice(app, "--normal-space", options.normal_space, enum_choices<NormalSpace>(),
               "Set the space of the normal map's vectors. Default: from the file's metadata, else "
               "tangent.")
        .group(maps_group);
    add_assume_option(app, options.assumed, {MapKind::normal, MapKind::height, MapKind::color})
        .group(maps_group);
    add_number(app, "--normal-scale", "S", options.normal_scale, {-100, 100, ""},
               "Multiply the slopes of normal maps, including those of the model. Default: the "
               "model's value, else 1.")
        .group(maps_group);
    add_choice(
        app, "--tangent-frame", options.tangent_frame, enum_choices<TangentFrame>(),
        "Choose the tangent frame of normal and bump maps: the mesh's tangents (MikkTSpace if it "
        "has none), or screen-space derivatives of the texture coordinates. Default: stored.")
        .group(maps_group);
    add_choice(app, "--specular-antialiasing", options.specular_antialiasing,
               Choices<bool>{{"on", true}, {"off", false}},
               "Widen highlights where a normal map has more detail than the pixels show, so that "
               "they do not flicker. Default: off.")
        .group(maps_group);
}

void add_height_options(CLI::App& app, ViewOptions& options) {
    add_path(app, "--height-map", options.height_map,
             "Read a height map from FILE. It is converted to a normal map or drawn as a bump map.")
        .group(maps_group);
    add_choice(app, "--height-as", options.height_as,
               Choices<HeightUse>{{"normal_map", HeightUse::normal_map},
                                  {"bump_map", HeightUse::bump_map}},
               "Convert the height map to a normal map once, or compute its slopes in the shader "
               "at each pixel. Default: normal_map.")
        .group(maps_group);
    add_number(app, "--strength", "S", options.strength, {},
               "Set the height in texels of the height map value 1.0. Default: 16.")
        .group(maps_group);
    add_choice(app, "--kernel", options.kernel, kernel_or_auto_choices(),
               "Choose the derivative kernel for the height map. auto selects the most accurate "
               "one for this map, as relief-bake bump does. Default: auto.")
        .group(maps_group);
}

}  // namespace

void add_map_options(CLI::App& app, ViewOptions& options) {
    add_path(app, "--diffuse-map", options.diffuse_map,
             "Replace the diffuse color of all materials by the color image FILE.")
        .group(maps_group);
    add_normal_options(app, options);
    add_height_options(app, options);
}

void check_maps(const ViewOptions& options) {
    const char* const give_height = "add --height-map, or leave it out";
    const char* const give_normal = "add --normal-map, or leave it out";
    refuse(options.normal_map && options.height_map, "--height-map",
           "contradicts --normal-map, because both set the normals", "leave one of them out");
    refuse(options.green && !options.normal_map, "--green", "needs --normal-map", give_normal);
    refuse(options.normal_space && !options.normal_map, "--normal-space", "needs --normal-map",
           give_normal);
    refuse(options.strength && !options.height_map, "--strength", "needs --height-map",
           give_height);
    refuse(options.kernel && !options.height_map, "--kernel", "needs --height-map", give_height);
    refuse(options.height_as && !options.height_map, "--height-as", "needs --height-map",
           give_height);
    const bool bump = options.height_as == HeightUse::bump_map;
    refuse(bump && options.kernel, "--kernel", "applies to converted height maps, not to bump maps",
           "leave it out");
    refuse(bump && options.normal_scale, "--normal-scale",
           "applies to normal maps, not to bump maps", "use --strength");
    const bool has_one_normal =
        options.interpolation.value_or(Interpolation::per_pixel) != Interpolation::per_pixel;
    refuse(has_one_normal && (options.normal_map || options.height_map),
           options.normal_map ? "--normal-map" : "--height-map",
           "does not show with --interpolation gouraud or flat, which do not shade each pixel",
           "leave one of them out");
    refuse(options.tangent_frame && options.normal_space == NormalSpace::object, "--tangent-frame",
           "object-space normal maps need no tangent frame", "leave it out");
}

namespace {

constexpr const char* materials_group = "Properties of all materials";

MetallicOption parse_metallic(const std::string& subject, const std::string& text) {
    const std::vector<double> numbers = parse_numbers(subject, text);
    if (numbers.size() != 2) throw UsageError(subject + ": not metallic,roughness");
    for (const double number : numbers) {
        if (number < 0 || number > 1)
            throw UsageError(subject + ": both numbers must be between 0 and 1");
    }
    return {static_cast<float>(numbers[0]), static_cast<float>(numbers[1])};
}

void add_shading_options(CLI::App& app, ViewOptions& options) {
    using Model = SceneOptions::MaterialModel;
    add_choice(app, "--shading", options.shading,
               Choices<Model>{{"as_authored", Model::as_authored}, {"phong", Model::phong}},
               "Shade glTF materials with their metallic-roughness model, or convert them to the "
               "Phong model. Default: as_authored, unless an option needs the Phong model.")
        .group(materials_group);
    add_choice(app, "--interpolation", options.interpolation, enum_choices<Interpolation>(),
               "Compute the lighting per pixel, per vertex (only with the Phong model), or with "
               "the face normals. Default: the value in the scene file, else per_pixel.")
        .group(materials_group);
    add_value(app, "--material", "NAME",
              "Use a classic material instead of the model's colors and their textures: gold, "
              "chrome, emerald, \"red plastic\", ... An unknown name lists similar names.",
              [&](const std::string&, const std::string& text) { options.material = text; })
        .group(materials_group);
    add_value(app, "--metallic-roughness", "METALLIC,ROUGHNESS",
              "Use the glTF material model with these values and the material's color.",
              [&](const std::string& subject, const std::string& text) {
                  options.metallic_roughness = parse_metallic(subject, text);
              })
        .group(materials_group);
}

}  // namespace

void add_material_options(CLI::App& app, ViewOptions& options) {
    add_shading_options(app, options);
    add_choice(app, "--specular", options.specular, enum_choices<SpecularModel>(),
               "Choose the model of highlights. The normalized model preserves their energy for "
               "every shininess. Materials without a specular color get gray 0.25. Default: the "
               "model's value, else blinn_phong.")
        .group(materials_group);
    add_number(
        app, "--shininess", "N", options.shininess, field_limits(&Material::shininess),
        "Set the exponent of highlights; larger values make them smaller and sharper. Materials "
        "without a specular color get gray 0.25. Default: the model's value, else 32.")
        .group(materials_group);
    add_switch(app, "--highlight-fresnel", options.highlight_fresnel,
               "Make highlights brighter at grazing angles, by Schlick's approximation. Materials "
               "without a specular color get gray 0.25.")
        .group(materials_group);
}

void check_materials(const ViewOptions& options) {
    const std::string phong = reason_for_phong(options);
    refuse(options.shading == SceneOptions::MaterialModel::as_authored && !phong.empty(), phong,
           "needs the Phong model, and --shading as_authored keeps the glTF model",
           "leave one of them out");
    refuse(options.metallic_roughness && !phong.empty(), "--metallic-roughness",
           "needs the glTF model, and " + phong + " needs the Phong model",
           "leave one of them out");
    refuse(options.metallic_roughness && options.material, "--metallic-roughness",
           "contradicts --material", "leave one of them out");
}

std::string reason_for_phong(const ViewOptions& options) {
    const std::array<std::pair<bool, const char*>, 12> reasons{{
        {options.shading == SceneOptions::MaterialModel::phong, "--shading phong"},
        {options.interpolation == Interpolation::gouraud, "--interpolation gouraud"},
        {options.specular.has_value(), "--specular"},
        {options.shininess.has_value(), "--shininess"},
        {options.highlight_fresnel, "--highlight-fresnel"},
        {options.reflectivity.has_value(), "--reflectivity"},
        {options.reflection_roughness.has_value(), "--reflection-roughness"},
        {options.fresnel.has_value() || options.no_fresnel, "--fresnel"},
        {options.transmission.has_value(), "--transmission"},
        {options.environment_tint, "--environment-tint"},
        {options.clamp_terms, "--clamp-terms"},
        {options.material.has_value(), "--material"},
    }};
    for (const auto& [given, name] : reasons) {
        if (given) return name;
    }
    return "";
}

namespace {

/// The specular color of materials without one, if an option sets highlights.
constexpr glm::vec3 default_specular{0.25F};

bool has_overrides(const ViewOptions& o) {
    return o.diffuse_map || o.normal_map || o.height_map || o.normal_scale || o.tangent_frame ||
           o.specular_antialiasing || o.interpolation || o.material || o.metallic_roughness ||
           o.specular || o.shininess || o.highlight_fresnel || o.reflectivity ||
           o.reflection_roughness || o.fresnel || o.no_fresnel || o.transmission ||
           o.environment_tint || o.clamp_terms;
}

/// A map requires that at least one mesh has texture coordinates. Meshes without them are noted.
void require_texcoords(const Scene& scene, const ViewOptions& options, const std::string& option,
                       std::vector<std::string>& notes) {
    const auto bare = std::count_if(scene.meshes.begin(), scene.meshes.end(),
                                    [](const Mesh& mesh) { return mesh.texcoords.empty(); });
    const auto all = static_cast<std::ptrdiff_t>(scene.meshes.size());
    if (bare == all) {
        throw failure(options.model, "no texture coordinates for " + option,
                      "unwrap the model first, or leave " + option + " out");
    }
    if (bare > 0) {
        notes.push_back(
            fmt::format("{} of {} meshes have no texture coordinates, so {} has no effect on them",
                        bare, all, option));
    }
}

/// Images that an option names must be readable, unlike the images of models.
Texture add_texture(Scene& scene, ImageSource image) {
    image.is_required = true;
    scene.images.push_back(std::move(image));
    return {.image = scene.images.size() - 1};
}

void set_diffuse_map(Scene& scene, const std::filesystem::path& file) {
    const Texture texture = add_texture(scene, {file.string(), file});
    for (Material& material : scene.materials) {
        material.diffuse = glm::vec3(1.0F);
        material.ambient = glm::vec3(1.0F);
        if (material.metallic_roughness) material.metallic_roughness->base_color = glm::vec3(1.0F);
        material.diffuse_texture = texture;
    }
}

void set_normal_map(Scene& scene, const NormalMap& map) {
    for (Material& material : scene.materials) {
        material.normal_map = map;
        material.bump_map.reset();
    }
}

/// Checks the kind of a map. Whether a file is missing shows when it is drawn.
/// \return what the file states
MapDescription checked_map(const std::filesystem::path& file, const std::vector<MapKind>& accepted,
                           const ViewOptions& options) {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) return {};
    return read_description(check_kind(file, accepted, options.assumed));
}

/// Returns a normal map with the conventions of the options, else of its metadata.
NormalMap normal_map_of_file(Scene& scene, const std::filesystem::path& file,
                             const ViewOptions& options) {
    const MapDescription stated =
        checked_map(file, {MapKind::normal, MapKind::object_normal}, options);
    NormalMap map;
    map.texture = add_texture(scene, {file.string(), file});
    map.green = options.green.value_or(stated.green.value_or(map.green));
    map.space = options.normal_space.value_or(
        stated.kind == MapKind::object_normal ? NormalSpace::object : map.space);
    return map;
}

void set_bump_map(Scene& scene, const ViewOptions& options) {
    BumpMap map;
    map.texture = add_texture(scene, {options.height_map->string(), *options.height_map});
    map.strength = static_cast<float>(options.strength.value_or(BumpOptions{}.strength));
    for (Material& material : scene.materials) {
        material.bump_map = map;
        material.normal_map.reset();
    }
}

/// Converts the height map to a normal map with 16 bits.
NormalMap normal_map_of_heights(Scene& scene, const ViewOptions& options, Stages& stages,
                                Report& report) {
    const std::filesystem::path& file = *options.height_map;
    BumpOptions bump;
    bump.strength = options.strength.value_or(bump.strength);
    bump.kernel = options.kernel;
    Image map = stages.run("height map", [&] {
        return about(file, [&] {
            return converted_heights(read_image(file, ImageUse::data), bump, 16, report);
        });
    });
    return converted_map(add_texture(scene, {file.string(), std::move(map)}));
}

void set_normal_scale(Scene& scene, float scale) {
    bool any = false;
    for (Material& material : scene.materials) {
        if (!material.normal_map) continue;
        material.normal_map->scale = scale;
        any = true;
    }
    if (!any) {
        throw UsageError("--normal-scale: the model has no normal map to scale",
                         "give one with --normal-map or --height-map");
    }
}

void set_highlights(Scene& scene, const ViewOptions& options, std::vector<std::string>& notes) {
    std::size_t added = 0;
    for (Material& material : scene.materials) {
        if (material.specular == glm::vec3(0.0F)) {
            material.specular = default_specular;
            ++added;
        }
        material.specular_model = options.specular.value_or(material.specular_model);
        material.shininess = options.shininess.value_or(material.shininess);
        material.highlight_fresnel |= options.highlight_fresnel;
    }
    if (added != 0) {
        notes.push_back(fmt::format("{} without a specular color got gray {:g}",
                                    counted(added, "material"), default_specular.r));
    }
}

/// \throws UsageError with similar names, if the material is unknown
Material named_material(const std::string& name) {
    if (const std::optional<Material> material = material_by_name(name)) return *material;
    throw UsageError(fmt::format("--material {}: unknown material{}", name,
                                 did_you_mean(name, material_names())),
                     fmt::format("there are {}", fmt::join(material_names(), ", ")));
}

/// Sets the colors and highlights of a named material, in place of the model's colors and their
/// textures. Other properties stay.
void set_named_material(Scene& scene, const std::string& name) {
    const Material named = named_material(name);
    for (Material& material : scene.materials) {
        // The alpha of the diffuse texture cuts holes, so a material with holes keeps it.
        if (material.alpha_mode == AlphaMode::opaque) material.diffuse_texture.reset();
        material.specular_texture.reset();
        material.ambient = named.ambient;
        material.diffuse = named.diffuse;
        material.specular = named.specular;
        material.shininess = named.shininess;
        material.specular_model = named.specular_model;
        material.metallic_roughness.reset();
    }
}

void set_metallic_roughness(Scene& scene, const MetallicOption& option) {
    for (Material& material : scene.materials) {
        MetallicRoughness model;
        const glm::vec3 color = material.metallic_roughness
                                    ? material.metallic_roughness->base_color
                                    : material.diffuse;
        model.base_color = glm::min(color, glm::vec3(1.0F));
        model.metallic = option.metallic;
        model.roughness = option.roughness;
        material.metallic_roughness = model;
        material.transmission = 0.0F;
    }
}

void set_shading(Scene& scene, const ViewOptions& options) {
    for (Material& material : scene.materials) {
        material.interpolation = options.interpolation.value_or(material.interpolation);
        material.tangent_frame = options.tangent_frame.value_or(material.tangent_frame);
        material.specular_antialiasing =
            options.specular_antialiasing.value_or(material.specular_antialiasing);
        material.environment_tint |= options.environment_tint;
        set_reflection(material, options);
    }
    scene.clamp_terms |= options.clamp_terms;
}

/// Notes materials whose normal or bump map cannot show.
void note_hidden_maps(const Scene& scene, std::vector<std::string>& notes) {
    const auto count = static_cast<std::size_t>(
        std::count_if(scene.materials.begin(), scene.materials.end(), [](const Material& material) {
            return (material.normal_map || material.bump_map) && !material.unlit &&
                   material.interpolation != Interpolation::per_pixel;
        }));
    if (count == 0) return;
    notes.push_back(fmt::format(
        "the normal or bump map of {} does not show, because Gouraud and flat shading do not shade "
        "each pixel",
        counted(count, "material")));
}

}  // namespace

SceneHeights scene_heights(const ViewOptions& options) {
    return {.file = options.height_map,
            .is_bump_map = options.height_as == HeightUse::bump_map,
            .strength = options.strength,
            .kernel = options.kernel};
}

void override_materials(Scene& scene, const ViewOptions& options, Stages& stages, Report& report,
                        std::vector<std::string>& notes) {
    if (!has_overrides(options)) return;
    name_default_material(scene);
    // Options for the Phong model replace metallic-roughness materials.
    if (!reason_for_phong(options).empty()) {
        for (Material& material : scene.materials)
            material.metallic_roughness.reset();
    }
    if (options.material) set_named_material(scene, *options.material);
    if (options.metallic_roughness) set_metallic_roughness(scene, *options.metallic_roughness);
    if (options.diffuse_map) {
        require_texcoords(scene, options, "--diffuse-map", notes);
        checked_map(*options.diffuse_map, {MapKind::color}, options);
        set_diffuse_map(scene, *options.diffuse_map);
    }
    if (options.normal_map) {
        require_texcoords(scene, options, "--normal-map", notes);
        const std::filesystem::path& file = *options.normal_map;
        set_normal_map(scene, normal_map_of_file(scene, file, options));
    }
    if (options.height_map) {
        require_texcoords(scene, options, "--height-map", notes);
        checked_map(*options.height_map, {MapKind::height}, options);
        if (options.height_as == HeightUse::bump_map) {
            set_bump_map(scene, options);
        } else {
            set_normal_map(scene, normal_map_of_heights(scene, options, stages, report));
        }
    }
    if (options.normal_scale) set_normal_scale(scene, *options.normal_scale);
    if (options.specular || options.shininess || options.highlight_fresnel)
        set_highlights(scene, options, notes);
    set_shading(scene, options);
    note_hidden_maps(scene, notes);
}

// The environment, the lights and the camera.

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
    add_number(app, "--environment-intensity", "I", options.environment_intensity,
               field_limits(&Environment::intensity),
               "Multiply the environment's light. Default: 1.")
        .group(environment_group);
    add_number(app, "--environment-rotation", "DEG", options.environment_rotation,
               {-360, 360, "degrees"},
               "Rotate the environment about the y axis, counterclockwise from above. Default: 0.")
        .group(environment_group);
    add_number(app, "--background-blur", "B", options.background_blur,
               field_limits(&Environment::skybox_blur),
               "Blur the visible environment: 1 as a mirror of roughness 1 shows it. Default: 0.")
        .group(environment_group);
    add_choice(
        app, "--environment-light", options.environment_light,
        Choices<bool>{{"on", true}, {"off", false}},
        "Light surfaces with the environment. Default: on if a material is metallic-roughness.")
        .group(environment_group);
    add_switch(app, "--no-skybox", options.no_skybox,
               "Do not show the environment behind the model.")
        .group(environment_group);
}

void add_reflection_options(CLI::App& app, ViewOptions& options) {
    add_number(
        app, "--reflectivity", "R", options.reflectivity, field_limits(&Material::reflectivity),
        "Set the reflectivity of materials at normal incidence. It increases at grazing angles. "
        "With an exact --fresnel model, it is a factor. Default: the model's value, else 0.")
        .group(environment_group);
    add_number(app, "--reflection-roughness", "R", options.reflection_roughness,
               field_limits(&Material::reflection_roughness),
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
                  if (chosen >= 0) options.fresnel = static_cast<FresnelModel>(chosen);
              })
        .group(environment_group);
    add_number(app, "--refractive-index", "N", options.refractive_index,
               field_limits(&Material::refractive_index),
               "Set the refractive index for --fresnel dielectric and --transmission. Default: "
               "1.5, glass.")
        .group(environment_group);
    add_switch(app, "--environment-tint", options.environment_tint,
               "Multiply ambient, diffuse and specular light by the environment along the normal.")
        .group(environment_group);
    add_number(app, "--transmission", "T", options.transmission,
               field_limits(&Material::transmission),
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

bool uses_studio(const ViewOptions& options) {
    return is_word(options, "studio");
}

bool uses_none(const ViewOptions& options) {
    return is_word(options, "none");
}

bool is_scene_file(const ViewOptions& options) {
    return extension_of(options.model) == ".json";
}

}  // namespace

void add_environment_options(CLI::App& app, ViewOptions& options) {
    add_image_options(app, options);
    add_reflection_options(app, options);
}

void check_environment(const ViewOptions& options) {
    const std::size_t files = uses_none(options) ? 0 : options.environment.size();
    const char* const give = "give one, or leave it out";
    refuse(files != 0 && files != 1 && files != 6, "--environment",
           fmt::format("takes one file, six files or a folder, not {} files", files), "");
    // A scene file may have its own environment, which is not known yet.
    const bool none = files == 0 && (uses_none(options) || !is_scene_file(options));
    refuse(options.no_skybox && none, "--no-skybox", "there is no --environment", "");
    const auto need_environment = [&](bool given, const char* option) {
        refuse(given && none, option, "there is no --environment", give);
    };
    need_environment(options.reflectivity.has_value(), "--reflectivity");
    need_environment(options.reflection_roughness.has_value(), "--reflection-roughness");
    need_environment(options.fresnel.has_value() || options.no_fresnel, "--fresnel");
    need_environment(options.transmission.has_value(), "--transmission");
    need_environment(options.environment_tint, "--environment-tint");
    const auto describe_environment = [&](bool given, const char* option) {
        refuse(given && none, option, "there is no --environment", give);
    };
    describe_environment(options.environment_light.has_value(), "--environment-light");
    describe_environment(options.environment_intensity.has_value(), "--environment-intensity");
    describe_environment(options.environment_rotation.has_value(), "--environment-rotation");
    describe_environment(options.background_blur.has_value(), "--background-blur");
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
    refuse(options.environment_layout && (!one || uses_studio(options)), "--environment-layout",
           "applies to one image, not to six or to the studio", "leave it out");
    refuse(options.no_skybox && uses_studio(options), "--no-skybox",
           "the studio is not visible behind the model", "leave it out");
    refuse(options.background_blur && (options.no_skybox || uses_studio(options)),
           "--background-blur", "the environment is not visible behind the model", "leave it out");
    refuse(options.left_handed_environment && one, "--left-handed", "applies to six images",
           "leave it out");
    refuse(options.background && files != 0 && !options.no_skybox && !uses_studio(options),
           "--background", "the environment hides it", "add --no-skybox, or leave one of them out");
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
    environment.intensity = options.environment_intensity.value_or(1.0F);
    environment.rotation = glm::radians(options.environment_rotation.value_or(0.0F));
    environment.skybox &= !options.no_skybox;
    environment.skybox_blur = options.background_blur.value_or(0.0F);
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
        // Metals do not scatter light.
        if (*options.fresnel == FresnelModel::conductor)
            material.diffuse = material.ambient = glm::vec3(0.0F);
        const bool exact = *options.fresnel != FresnelModel::schlick;
        if (exact && !options.reflectivity) material.reflectivity = glm::vec3(1.0F);
    }
    if (options.reflection_roughness) material.reflection_roughness = *options.reflection_roughness;
    if (options.refractive_index) material.refractive_index = *options.refractive_index;
    if (options.transmission) {
        material.transmission = *options.transmission;
        // Transmission needs a reflectivity. The default is that of glass.
        if (material.reflectivity == glm::vec3(0.0F)) material.reflectivity = glm::vec3(0.04F);
    }
}

namespace {

bool is_physical(const Material& material) {
    return material.metallic_roughness.has_value() && !material.unlit;
}

/// Applies options to the environment of a scene file.
void override_scene_environment(Scene& scene, const ViewOptions& options) {
    if (!scene.environment) {
        const bool has_options =
            options.no_skybox || options.environment_light || options.environment_intensity ||
            options.environment_rotation || options.background_blur || options.reflectivity ||
            options.reflection_roughness || options.fresnel || options.no_fresnel ||
            options.transmission || options.environment_tint;
        if (!has_options) return;
        throw UsageError("the scene has no environment for these options",
                         "add --environment, or leave the options out");
    }
    if (options.no_skybox) scene.environment->skybox = false;
    scene.environment->lights = options.environment_light.value_or(scene.environment->lights);
    scene.environment->intensity =
        options.environment_intensity.value_or(scene.environment->intensity);
    if (options.environment_rotation)
        scene.environment->rotation = glm::radians(*options.environment_rotation);
    scene.environment->skybox_blur =
        options.background_blur.value_or(scene.environment->skybox_blur);
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

void set_environment(Scene& scene, const ViewOptions& options, std::vector<std::string>& notes) {
    if (uses_none(options)) return scene.environment.reset();
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
    scene.environment->lights =
        options.environment_light.value_or(physical || scene.environment->lights);
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
    if (options.ambient) scene.ambient = glm::vec3(*options.ambient);
    if (!options.shadow_size) return;
    if (light_count(scene) == 0) {
        throw UsageError("--shadow: there is no light that could cast one",
                         "add one with --light, or leave it out");
    }
    scene.shadow = Shadow{glm::radians(*options.shadow_size)};
}

/// Computes ambient occlusion if the options or the scene request it.
void occlude(Scene& scene, const ViewOptions& options, Stages& stages) {
    if (options.ambient_occlusion) {
        scene.ambient_occlusion.reset();
        if (*options.ambient_occlusion > 0.0F)
            scene.ambient_occlusion = AmbientOcclusion{*options.ambient_occlusion};
    }
    if (scene.ambient_occlusion)
        stages.run("ambient occlusion", [&] { add_ambient_occlusion(scene); });
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
    if (!options.size_given) options.size = composed.graph.picture_size.value_or(options.size);
    select_pose(composed.graph, options);
    Scene& scene = composed.scene();
    if (scene.instances.empty()) throw FileError(options.model, "contains no triangles");
    if (options.frames && duration(composed.graph) == 0.0 && !options.seconds)
        throw UsageError("--frames: the scene has no animation", "use --turntable");
    override_materials(scene, options, stages, report, composed.notes);
    set_environment(scene, options, composed.notes);
    // Only scene files have a background.
    scene.background =
        options.background.value_or(is_scene_file(options) ? scene.background : default_background);
    scene.exposure = options.exposure.value_or(scene.exposure);
    scene.tone_mapping = options.tone_mapping.value_or(scene.tone_mapping);
    composed.camera_follows_scene = scene.camera && !options.camera;
    composed.camera = default_camera(scene, options);
    set_lights(composed, options);
    occlude(scene, options, stages);
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
