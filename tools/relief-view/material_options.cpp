// SPDX-License-Identifier: Apache-2.0
#include "material_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "common/command.h"
#include "common/options.h"
#include "common/text.h"
#include "environment_options.h"
#include "near_names.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/map_description.h"
#include "relief/mesh/map_kind_check.h"
#include "relief/shade/frame_settings.h"
#include "relief/shade/scene.h"
#include "relief/shade/scene_file.h"

namespace relief::tools {
using namespace relief::detail;
using namespace relief::shade;

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
    add_field(
        app, options.material_fields, "--tangent-frame", &Material::tangent_frame,
        "Choose the tangent frame of normal and bump maps: the mesh's tangents (MikkTSpace if it "
        "has none), or screen-space derivatives of the texture coordinates. Default: stored.")
        .group(maps_group);
    add_field(app, options.material_fields, "--specular-antialiasing",
              &Material::specular_antialiasing,
              "Widen highlights where a normal map has more detail than the pixels show, so that "
              "they do not flicker. Default: off.")
        .group(maps_group);
}

void add_height_options(CLI::App& app, ViewOptions& options) {
    add_path(app, "--height-map", options.height_map,
             "Read a height map from FILE. It is converted to a normal map or drawn as a bump map, "
             "and displaces textures with --height-depth or --height-method.")
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

void add_relief_options(CLI::App& app, ViewOptions& options) {
    FieldChanges<ReliefMap>& fields = options.relief_fields;
    add_field(app, fields, "--height-depth", "D", &ReliefMap::depth,
              "Look up all textures where the view meets the relief of --height-map, or of the "
              "scene's height maps. Black lies D texels below the surface of white. Default: the "
              "strength of the map.")
        .group(maps_group);
    add_field(app, fields, "--height-method", &ReliefMap::method,
              "Choose the method by which the view meets the relief: see docs/relief-mapping.md. "
              "Default: maximum_mipmaps.")
        .group(maps_group);
    add_field(app, fields, "--height-layers", "N", &ReliefMap::layers,
              "Set the layers of parallax occlusion and relief mapping, or the steps of relaxed "
              "cones, from 1 to 512. Default: 16.")
        .group(maps_group);
    add_field(app, fields, "--height-bisections", "N", &ReliefMap::bisections,
              "Set the bisections of relief mapping and relaxed cones, from 0 to 16. Default: 6.")
        .group(maps_group);
    add_field(app, fields, "--height-steps", "N", &ReliefMap::max_steps,
              "Set the steps after which maximum mipmaps and self-shadows end, from 1 to 1024. "
              "Default: 128.")
        .group(maps_group);
    add_field(app, fields, "--height-shadow", &ReliefMap::self_shadow,
              "Let the relief hide light from its own points. Default: off.")
        .group(maps_group);
    add_field(app, fields, "--height-silhouette", &ReliefMap::silhouette,
              "Choose what is drawn where the view leaves a height map that does not repeat: its "
              "border continues (none), or nothing (clip; curve: also where the view passes a "
              "relief that curves with the surface). Default: none.")
        .group(maps_group);
    add_field(app, fields, "--height-write-depth", &ReliefMap::write_depth,
              "Write the depth of the relief, so that other surfaces meet it where it is seen. "
              "Default: off.")
        .group(maps_group);
    add_field(
        app, fields, "--height-bound", "PIXELS", &ReliefMap::bound,
        "Leave out the displacement, its shadows, silhouette and depth where they change less "
        "than PIXELS of a single picture, from 0, which leaves out nothing. Default: 0.5.")
        .group(maps_group);
    add_path(app, "--cone-map", options.cone_map,
             "Read the cone map of the height map from FILE, which relaxed cones need.")
        .group(maps_group);
}

}  // namespace

void add_map_options(CLI::App& app, ViewOptions& options) {
    add_path(app, "--diffuse-map", options.diffuse_map,
             "Replace the diffuse color of all materials by the color image FILE.")
        .group(maps_group);
    add_normal_options(app, options);
    add_height_options(app, options);
    add_relief_options(app, options);
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
    add_field(app, options.material_fields, "--interpolation", &Material::interpolation,
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
    add_field(app, options.material_fields, "--specular", &Material::specular_model,
              "Choose the model of highlights. The normalized model preserves their energy for "
              "every shininess. Materials without a specular color get gray 0.25. Default: the "
              "model's value, else blinn_phong.")
        .group(materials_group);
    add_field(
        app, options.material_fields, "--shininess", "N", &Material::shininess,
        "Set the exponent of highlights; larger values make them smaller and sharper. Materials "
        "without a specular color get gray 0.25. Default: the model's value, else 32.")
        .group(materials_group);
    add_switch(app, "--highlight-fresnel",
               "Make highlights brighter at grazing angles, by Schlick's approximation. Materials "
               "without a specular color get gray 0.25.",
               [&] { options.material_fields.set(&Material::highlight_fresnel, true); })
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
}

std::string reason_for_phong(const ViewOptions& options) {
    const FieldChanges<Material>& fields = options.material_fields;
    const std::array<std::pair<bool, const char*>, 12> reasons{{
        {options.shading == SceneOptions::MaterialModel::phong, "--shading phong"},
        {fields.get(&Material::interpolation) == Interpolation::gouraud, "--interpolation gouraud"},
        {fields.has(&Material::specular_model), "--specular"},
        {fields.has(&Material::shininess), "--shininess"},
        {fields.has(&Material::highlight_fresnel), "--highlight-fresnel"},
        {fields.has(&Material::reflectivity), "--reflectivity"},
        {fields.has(&Material::reflection_roughness), "--reflection-roughness"},
        {fields.has(&Material::fresnel) || options.no_fresnel, "--fresnel"},
        {fields.has(&Material::transmission), "--transmission"},
        {fields.has(&Material::environment_tint), "--environment-tint"},
        {options.scene_fields.has(&Scene::clamp_terms), "--clamp-terms"},
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
    return o.diffuse_map || o.normal_map || o.height_map || o.normal_scale || o.material ||
           !o.relief_fields.empty() || o.cone_map || o.metallic_roughness || o.no_fresnel ||
           !o.material_fields.empty() || o.scene_fields.has(&Scene::clamp_terms);
}

/// Returns whether an option sets highlights, for which materials need a specular color.
bool sets_highlights(const ViewOptions& options) {
    const FieldChanges<Material>& fields = options.material_fields;
    return fields.has(&Material::specular_model) || fields.has(&Material::shininess) ||
           fields.has(&Material::highlight_fresnel);
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

/// Displaces the textures of all materials by the height map of the options, or changes the height
/// maps that materials have.
void set_relief(Scene& scene, const ViewOptions& options) {
    if (options.relief_fields.empty() && !options.cone_map) return;
    if (options.height_map) {
        ReliefMap map;
        map.texture = add_texture(scene, {options.height_map->string(), *options.height_map});
        map.depth =
            static_cast<float>(std::max(0.0, options.strength.value_or(BumpOptions{}.strength)));
        for (Material& material : scene.materials)
            material.height_map = map;
    }
    std::optional<Texture> cones;
    if (options.cone_map)
        cones = add_texture(scene, {options.cone_map->string(), *options.cone_map});
    bool any = false;
    for (Material& material : scene.materials) {
        if (!material.height_map) continue;
        any = true;
        options.relief_fields.apply(*material.height_map);
        if (cones) material.height_map->cones = cones;
        if (material.height_map->method == HeightMethod::relaxed_cones &&
            !material.height_map->cones)
            throw UsageError("--height-method relaxed_cones: there is no cone map",
                             "give one with --cone-map");
    }
    if (!any) {
        throw UsageError(
            "--height-depth, --height-method: the scene has no height map to displace by",
            "give one with --height-map");
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

void add_specular_colors(Scene& scene, std::vector<std::string>& notes) {
    std::size_t added = 0;
    for (Material& material : scene.materials) {
        if (material.specular != glm::vec3(0.0F)) continue;
        material.specular = default_specular;
        ++added;
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

void check_scene_maps(const Scene& scene, const ViewOptions& options) {
    std::set<std::pair<std::size_t, TextureSlot>> checked;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        for (const TextureSlotInfo& info : texture_slots) {
            const Texture* const texture = find_texture(scene.materials[i], info.slot);
            const std::vector<MapKind> accepted = accepted_kinds(info.slot);
            if (texture == nullptr || accepted.empty()) continue;
            const ImageSource& image = scene.images[texture->image];
            const auto* const file = std::get_if<std::filesystem::path>(&image.source);
            const bool is_named = file != nullptr && image.origin == options.model.string();
            if (!is_named || !checked.emplace(texture->image, info.slot).second) continue;
            try {
                check_kind(*file, accepted, options.assumed);
            } catch (const RefusedMap& error) {
                const std::string place =
                    fmt::format("{} of {}", info.effect, material_label(scene, i));
                throw RefusedMap(FileError(options.model, place + ": " + error.what()),
                                 error.wanted());
            } catch (const FileError&) {  // The renderer reports images that cannot be read.
            }
        }
    }
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
    set_relief(scene, options);
    if (options.normal_scale) set_normal_scale(scene, *options.normal_scale);
    if (sets_highlights(options)) add_specular_colors(scene, notes);
    for (Material& material : scene.materials) {
        options.material_fields.apply(material);
        complete_reflection(material, options);
    }
    note_hidden_maps(scene, notes);
}

}  // namespace relief::tools
