// SPDX-License-Identifier: Apache-2.0
#include "material_overrides.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/text.h"
#include "environment_options.h"
#include "material_options.h"
#include "near_names.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/image_file.h"
#include "relief/shade/name_materials.h"

namespace relief::tools {
namespace {

/// Highlights of a material that has none, where the command line asks for highlights.
constexpr glm::vec3 plain_specular{0.25F};

bool overrides_anything(const ViewOptions& o) {
    return o.diffuse_map || o.normal_map || o.height_map || o.normal_scale || o.tangent_frame ||
           o.specular_antialiasing || o.interpolation || o.material || o.metallic_roughness ||
           o.specular || o.shininess || o.reflectivity || o.reflection_roughness || o.fresnel ||
           o.no_fresnel || o.transmission;
}

/// A map needs texture coordinates somewhere; where only some meshes have them, says so.
void require_texcoords(const Scene& scene, const ViewOptions& options, const std::string& option,
                       std::vector<std::string>& notes) {
    const auto bare = std::count_if(scene.meshes.begin(), scene.meshes.end(),
                                    [](const Mesh& mesh) { return mesh.texcoords.empty(); });
    const auto all = static_cast<std::ptrdiff_t>(scene.meshes.size());
    if (bare == all) {
        throw failure(options.model, "no texture coordinates, which " + option + " needs",
                      "unwrap the model first, or leave " + option + " out");
    }
    if (bare > 0) {
        notes.push_back(
            fmt::format("{} of {} meshes have no texture coordinates: {} does not "
                        "show on them",
                        bare, all, option));
    }
}

/// An image that an option names: unlike those of models, it has to be readable.
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

void set_bump_map(Scene& scene, const ViewOptions& options) {
    BumpMap map;
    map.texture = add_texture(scene, {options.height_map->string(), *options.height_map});
    map.strength = static_cast<float>(options.strength.value_or(BumpOptions{}.strength));
    for (Material& material : scene.materials) {
        material.bump_map = map;
        material.normal_map.reset();
    }
}

/// The height map as a normal map of 16 bits, which is more than the eye can tell apart.
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
            material.specular = plain_specular;
            ++added;
        }
        material.specular_model = options.specular.value_or(material.specular_model);
        material.shininess = options.shininess.value_or(material.shininess);
    }
    if (added != 0) {
        notes.push_back(fmt::format("{} had no specular colour and got a grey one of {:g}",
                                    counted(added, "material"), plain_specular.r));
    }
}

/// \throws UsageError naming near ones if there is no material of that name
Material named_material(const std::string& name) {
    if (const std::optional<Material> material = material_by_name(name)) return *material;
    throw UsageError(fmt::format("--material {}: there is no such material{}", name,
                                 did_you_mean(name, material_names())),
                     fmt::format("there are {}", fmt::join(material_names(), ", ")));
}

/// Colours and highlights of a named material; what the model's own have beside that stays.
void set_named_material(Scene& scene, const std::string& name) {
    const Material named = named_material(name);
    for (Material& material : scene.materials) {
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
        set_reflection(material, options);
    }
}

/// The format of maps that are made of heights here.
constexpr NormalMapFormat converted_format{
    .bits = 16, .green = Green::up, .flat = FlatCode::middle};

}  // namespace

Image converted_heights(const Image& image, const BumpOptions& bump, int bits, Report& report) {
    NormalMapFormat format = converted_format;
    format.bits = bits;
    return encode_normal_map(normals_from_height(height_field(image), bump, report), format,
                             report);
}

std::optional<Kernel> kernel_shown(const ViewOptions& options) {
    if (options.kernel || !options.height_map) return options.kernel;
    BumpOptions bump;
    bump.strength = options.strength.value_or(bump.strength);
    bump = settled_options(height_field(read_image(*options.height_map, ImageUse::data)), bump);
    if (bump.kernel == Kernel::gaussian && bump.gaussian_radius != BumpOptions{}.gaussian_radius)
        return std::nullopt;
    return bump.kernel;
}

NormalMap converted_map(const Texture& texture) {
    return {.texture = texture, .green = converted_format.green, .flat = converted_format.flat};
}

void override_materials(Scene& scene, const ViewOptions& options, Stages& stages, Report& report,
                        std::vector<std::string>& notes) {
    if (!overrides_anything(options)) return;
    name_default_material(scene);
    // Whatever of glTF's model is still there gives way to what only Phong's has.
    if (!reason_for_phong(options).empty()) {
        for (Material& material : scene.materials)
            material.metallic_roughness.reset();
    }
    if (options.material) set_named_material(scene, *options.material);
    if (options.metallic_roughness) set_metallic_roughness(scene, *options.metallic_roughness);
    if (options.diffuse_map) {
        require_texcoords(scene, options, "--diffuse-map", notes);
        set_diffuse_map(scene, *options.diffuse_map);
    }
    if (options.normal_map) {
        require_texcoords(scene, options, "--normal-map", notes);
        const std::filesystem::path& file = *options.normal_map;
        NormalMap map;
        map.texture = add_texture(scene, {file.string(), file});
        map.green = options.green.value_or(map.green);
        map.space = options.normal_space.value_or(map.space);
        set_normal_map(scene, map);
    }
    if (options.height_map) {
        require_texcoords(scene, options, "--height-map", notes);
        if (options.height_as == HeightUse::bump_map) {
            set_bump_map(scene, options);
        } else {
            set_normal_map(scene, normal_map_of_heights(scene, options, stages, report));
        }
    }
    if (options.normal_scale) set_normal_scale(scene, *options.normal_scale);
    if (options.specular || options.shininess) set_highlights(scene, options, notes);
    set_shading(scene, options);
}

}  // namespace relief::tools
