// SPDX-License-Identifier: Apache-2.0
#include "material_overrides.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/text.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/image_file.h"
#include "relief/shade/effects.h"

namespace relief::tools {
namespace {

/// Highlights of a material that has none, where the command line asks for highlights.
constexpr glm::vec3 plain_specular{0.25F};

bool overrides_anything(const ViewOptions& options) {
    return options.diffuse_map || options.normal_map || options.height_map ||
           options.normal_scale || options.specular || options.shininess || options.reflectivity;
}

/// Every triangle gets a material: the default one, added once, where it has none.
void name_all_materials(Scene& scene) {
    std::optional<std::uint32_t> added;
    const auto default_index = [&] {
        if (!added) {
            added = static_cast<std::uint32_t>(scene.materials.size());
            scene.materials.push_back(default_material());
        }
        return *added;
    };
    for (Mesh& mesh : scene.meshes) {
        if (mesh.material_ranges.empty() && !mesh.triangles.empty()) {
            mesh.material_ranges.push_back(
                {0, static_cast<std::uint32_t>(mesh.triangles.size()), std::nullopt});
        }
        for (MaterialRange& range : mesh.material_ranges) {
            if (!range.material) range.material = default_index();
        }
    }
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

Texture add_texture(Scene& scene, ImageSource image) {
    scene.images.push_back(std::move(image));
    return {.image = scene.images.size() - 1};
}

void set_diffuse_map(Scene& scene, const std::filesystem::path& file) {
    const Texture texture = add_texture(scene, {file.string(), file});
    for (Material& material : scene.materials) {
        material.diffuse = glm::vec3(1.0F);
        material.ambient = glm::vec3(1.0F);
        material.diffuse_texture = texture;
    }
}

void set_normal_map(Scene& scene, const NormalMap& map) {
    for (Material& material : scene.materials)
        material.normal_map = map;
}

/// The height map as a normal map of 16 bits, which is more than the eye can tell apart.
NormalMap converted_height_map(Scene& scene, const ViewOptions& options, Stages& stages,
                               Report& report) {
    const std::filesystem::path& file = *options.height_map;
    BumpOptions bump;
    bump.strength = options.strength.value_or(bump.strength);
    bump.kernel = options.kernel.value_or(bump.kernel);
    const NormalMapFormat format{.bits = 16, .green = Green::up, .flat = FlatCode::middle};
    Image map = stages.run("height map", [&] {
        return about(file, [&] {
            const Image height = height_field(read_image(file, ImageUse::data));
            return encode_normal_map(normals_from_height(height, bump, report), format, report);
        });
    });
    return {.texture = add_texture(scene, {file.string(), std::move(map)}),
            .green = format.green,
            .flat = format.flat};
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

void set_reflectivity(Scene& scene, float reflectivity) {
    for (Material& material : scene.materials) {
        material.reflectivity = glm::vec3(reflectivity);
        material.grazing_reflectivity = glm::vec3(1.0F);
    }
}

}  // namespace

void override_materials(Scene& scene, const ViewOptions& options, Stages& stages, Report& report,
                        std::vector<std::string>& notes) {
    if (!overrides_anything(options)) return;
    name_all_materials(scene);
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
        set_normal_map(scene, map);
    }
    if (options.height_map) {
        require_texcoords(scene, options, "--height-map", notes);
        set_normal_map(scene, converted_height_map(scene, options, stages, report));
    }
    if (options.normal_scale) set_normal_scale(scene, *options.normal_scale);
    if (options.specular || options.shininess) set_highlights(scene, options, notes);
    if (options.reflectivity) set_reflectivity(scene, *options.reflectivity);
}

}  // namespace relief::tools
