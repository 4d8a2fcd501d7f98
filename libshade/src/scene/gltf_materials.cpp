// SPDX-License-Identifier: Apache-2.0
// glTF's metallic-roughness as it is, or as Phong's model (phong.cpp) with the means of the
// textures that Phong has no place for. Colours linear. Factors that glTF forbids count as the
// nearest allowed; what cannot be drawn as meant is counted in the report.
// Source: glTF 2.0, section 3.9. Tests: tests/shade/scene/scene_file_test.cpp.
#include "scene/gltf_materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <variant>

#include "parallel.h"
#include "progress_stage.h"
#include "relief/mesh/error.h"
#include "relief/shade/image_source.h"
#include "scene/texture_means.h"
#include "scene/usable_numbers.h"

namespace relief {

namespace {

/// A texture as the scene has it, or nothing where its mesh has no coordinates for it.
std::optional<Texture> texture_from(const std::optional<GltfTexture>& texture,
                                    const TexcoordSource& source, std::size_t material,
                                    Report& report) {
    if (!texture) return std::nullopt;
    if (texture->texcoord_set != source.set) {
        report.add("texture on a further texture coordinate set", "material", material, "left out");
        return std::nullopt;
    }
    if (texture->transform != source.transform) {
        report.add("texture transform of its own", "material", material,
                   "drawn with that of the material's first texture");
    }
    return Texture{texture->image, texture->wrap_u, texture->wrap_v, texture->filter};
}

/// The mean of an image's texels, or what is wrong with the image.
using MeanOrFault = std::variant<glm::vec3, std::string>;

/// A color image is kept decoded if no other use needs its bytes, so that drawing need not decode
/// it again.
MeanOrFault mean_of(ImageSource& image, ImageUse use, bool keep) {
    try {
        Image decoded = decode(image, use);
        const glm::vec3 mean = mean_color(decoded);
        if (keep) image.source = std::move(decoded);
        return mean;
    } catch (const Cancelled&) {
        throw;
    } catch (const Error& error) {
        return error.what();
    }
}

/// The means of one kind of texture over all materials that want it, each image decoded once, on
/// all threads.
class MeansOfImages {
  public:
    MeansOfImages(std::vector<ImageSource>& images, ImageUse use, const std::vector<bool>& keep)
        : images_(images), use_(use), keep_(keep) {}

    void want(std::size_t image) { means_.try_emplace(image); }

    void decode_all() {
        std::vector<std::size_t> wanted;
        for (const auto& [image, mean] : means_)
            wanted.push_back(image);
        std::vector<MeanOrFault> results(wanted.size());
        ProgressStage stage("images", wanted.size());
        parallel_for(wanted.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                results[i] = mean_of(images_[wanted[i]], use_, keep_[wanted[i]]);
                stage.advance(1);
            }
        });
        for (std::size_t i = 0; i < wanted.size(); ++i)
            means_[wanted[i]] = results[i];
    }

    /// The mean; or 1 where the image could not be read, which is reported.
    glm::vec3 mean(std::size_t image, const char* texture, const std::string& material,
                   Report& report) const {
        const MeanOrFault& result = means_.at(image);
        if (const auto* mean = std::get_if<glm::vec3>(&result)) return *mean;
        report.add(fmt::format("unreadable {} of {} for its mean", texture, material), "image",
                   image,
                   "counts as 1 in the material's Phong equivalent: " +
                       with_origin(images_[image], std::get<std::string>(result)));
        return glm::vec3(1.0F);
    }

  private:
    std::vector<ImageSource>& images_;
    ImageUse use_;
    const std::vector<bool>& keep_;
    std::map<std::size_t, MeanOrFault> means_;
};

/// Which images nothing but a colour texture uses.
std::vector<bool> color_only(const GltfView& view) {
    std::vector<bool> result(view.images.size(), true);
    for (const GltfMaterial& material : view.materials) {
        if (material.normal_texture) result[material.normal_texture->image] = false;
        if (material.metallic_roughness_texture) {
            result[material.metallic_roughness_texture->image] = false;
        }
    }
    return result;
}

std::string label(const GltfView& view, std::size_t material) {
    const std::string& name = view.materials[material].name;
    return name.empty() ? fmt::format("material {}", material) : fmt::format("material '{}'", name);
}

std::vector<TextureMeans> texture_means(const GltfView& view, std::vector<ImageSource>& images,
                                        Report& report) {
    const std::size_t count = view.materials.size();
    std::vector<TextureMeans> means(count);

    const std::vector<bool> keep_none(images.size(), false);
    MeansOfImages surfaces(images, ImageUse::data, keep_none);
    const auto has_surface = [&](const GltfMaterial& material) {
        return material.metallic_roughness_texture && !material.unlit &&
               (material.metallic > 0.0F || material.roughness > 0.0F);
    };
    for (const GltfMaterial& material : view.materials) {
        if (has_surface(material)) surfaces.want(material.metallic_roughness_texture->image);
    }
    surfaces.decode_all();
    for (std::size_t i = 0; i < count; ++i) {
        if (!has_surface(view.materials[i])) continue;
        const glm::vec3 mean = surfaces.mean(view.materials[i].metallic_roughness_texture->image,
                                             "metallic-roughness texture", label(view, i), report);
        means[i].roughness = mean.y;
        means[i].metallic = mean.z;
    }

    // A base colour's mean tints reflections, and only those of metals.
    const std::vector<bool> keep = color_only(view);
    MeansOfImages colors(images, ImageUse::color, keep);
    const auto is_textured_metal = [&](std::size_t i) {
        const GltfMaterial& material = view.materials[i];
        return material.base_color_texture && !material.unlit &&
               material.metallic * means[i].metallic > 0.0F;
    };
    for (std::size_t i = 0; i < count; ++i) {
        if (is_textured_metal(i)) colors.want(view.materials[i].base_color_texture->image);
    }
    colors.decode_all();
    for (std::size_t i = 0; i < count; ++i) {
        if (!is_textured_metal(i)) continue;
        means[i].base_color = colors.mean(view.materials[i].base_color_texture->image,
                                          "diffuse texture", label(view, i), report);
    }
    return means;
}

AlphaMode alpha_mode_from(GltfMaterial::AlphaMode mode) {
    switch (mode) {
        case GltfMaterial::AlphaMode::mask:
            return AlphaMode::mask;
        case GltfMaterial::AlphaMode::blend:
            return AlphaMode::blend;
        case GltfMaterial::AlphaMode::opaque:
            break;
    }
    return AlphaMode::opaque;
}

/// Textures, sides and alpha: the same in both models.
void add_textures(Material& result, const GltfMaterial& material, std::size_t index,
                  Report& report) {
    const TexcoordSource source = texcoord_source(material);
    const auto texture = [&](const std::optional<GltfTexture>& own) {
        return texture_from(own, source, index, report);
    };
    result.diffuse_texture = texture(material.base_color_texture);
    if (result.metallic_roughness) {
        result.metallic_roughness->texture = texture(material.metallic_roughness_texture);
    }
    result.emission_texture = texture(material.emission_texture);
    result.occlusion_texture = texture(material.occlusion_texture);
    result.occlusion_strength = usable(material.occlusion_strength, 1.0F);
    if (const auto normal = texture(material.normal_texture)) {
        result.normal_map = NormalMap{*normal, material.normal_scale, Green::up, std::nullopt};
    }
    result.alpha_mode = alpha_mode_from(material.alpha_mode);
    result.opacity = usable(material.base_color.a, 1.0F);
    result.alpha_cutoff = usable(material.alpha_cutoff, max_reflectance);
}

}  // namespace

TexcoordSource texcoord_source(const GltfMaterial& material) {
    for (const std::optional<GltfTexture>* texture :
         {&material.base_color_texture, &material.normal_texture,
          &material.metallic_roughness_texture, &material.occlusion_texture,
          &material.emission_texture}) {
        if (*texture) return {(*texture)->texcoord_set, (*texture)->transform};
    }
    return {};
}

std::vector<Material> materials_from(const GltfView& view, const SceneOptions& options,
                                     std::vector<ImageSource>& images, Report& report) {
    const bool phong = options.model == SceneOptions::MaterialModel::phong;
    std::vector<TextureMeans> means(view.materials.size());
    if (phong) means = texture_means(view, images, report);
    std::vector<Material> materials;
    for (std::size_t i = 0; i < view.materials.size(); ++i) {
        const GltfMaterial& material = view.materials[i];
        Material& result =
            materials.emplace_back(phong_from_metallic_roughness(material, means[i]));
        if (!phong && !material.unlit) {
            result.metallic_roughness = MetallicRoughness{
                usable(glm::vec3(material.base_color), 1.0F), usable(material.metallic, 1.0F),
                usable(material.roughness, 1.0F), std::nullopt};
        }
        add_textures(result, material, i, report);
    }
    return materials;
}

}  // namespace relief
