// SPDX-License-Identifier: Apache-2.0
// From a glTF document to a scene: primitives become meshes (one for each, however often placed),
// metallic-roughness becomes Phong (phong.cpp), light units become irradiance over pi. World space
// is glTF's. What cannot be drawn as meant is counted in the report; see scene_file.h for the list.
// Tests: tests/shade/scene/scene_file_test.cpp.
#include "scene/gltf_scene.h"

#include <algorithm>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "parallel.h"
#include "relief/mesh/error.h"
#include "relief/mesh/frames.h"
#include "relief/shade/scene_file.h"
#include "scene/image_source.h"
#include "scene/texture_means.h"

namespace relief {

namespace {

/// A texture as the scene has it, or nothing where it cannot be placed.
std::optional<Texture> texture_from(const std::optional<GltfTexture>& texture, std::size_t material,
                                    Report& report) {
    if (!texture) return std::nullopt;
    if (texture->texcoord_set != 0) {
        report.add("texture on a further texture coordinate set", "material", material, "left out");
        return std::nullopt;
    }
    if (texture->has_transform) {
        report.add("texture transform", "material", material, "drawn without it");
    }
    return Texture{texture->image, texture->wrap_u, texture->wrap_v, texture->filter};
}

/// The mean of a texture's image, or nothing where it cannot be read. A colour image is kept
/// decoded if no other use needs its bytes, so that drawing need not decode it again.
std::optional<glm::vec3> mean_of(ImageSource& image, ImageUse use, bool keep) {
    try {
        Image decoded = decode(image, use);
        const glm::vec3 mean = mean_color(decoded);
        if (keep) image.source = std::move(decoded);
        return mean;
    } catch (const Error&) {
        return std::nullopt;
    }
}

/// The means of one kind of texture over all materials that want it, each image decoded once, on
/// all threads.
class MeansOfImages {
  public:
    MeansOfImages(std::vector<ImageSource>& images, ImageUse use, const std::vector<bool>& keep)
        : images_(images), use_(use), keep_(keep) {}

    void want(std::size_t image) { means_.try_emplace(image, std::nullopt); }

    void decode_all() {
        std::vector<std::size_t> wanted;
        for (const auto& [image, mean] : means_)
            wanted.push_back(image);
        std::vector<std::optional<glm::vec3>> results(wanted.size());
        parallel_for(wanted.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                results[i] = mean_of(images_[wanted[i]], use_, keep_[wanted[i]]);
            }
        });
        for (std::size_t i = 0; i < wanted.size(); ++i)
            means_[wanted[i]] = results[i];
    }

    /// The mean, or 1 and an entry in the report where the image could not be read.
    glm::vec3 mean(std::size_t image, std::size_t material, Report& report) const {
        const std::optional<glm::vec3>& found = means_.at(image);
        if (found) return *found;
        report.add("unreadable texture", "material", material,
                   "its mean counts as 1 in the material's Phong equivalent");
        return glm::vec3(1.0F);
    }

  private:
    std::vector<ImageSource>& images_;
    ImageUse use_;
    const std::vector<bool>& keep_;
    std::map<std::size_t, std::optional<glm::vec3>> means_;
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
        const glm::vec3 mean =
            surfaces.mean(view.materials[i].metallic_roughness_texture->image, i, report);
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
        means[i].base_color = colors.mean(view.materials[i].base_color_texture->image, i, report);
    }
    return means;
}

Material material_from(const GltfMaterial& material, const TextureMeans& means, std::size_t index,
                       Report& report) {
    Material phong = phong_from_metallic_roughness(material, means);
    phong.diffuse_texture = texture_from(material.base_color_texture, index, report);
    phong.emission_texture = texture_from(material.emission_texture, index, report);
    if (const auto normal = texture_from(material.normal_texture, index, report)) {
        phong.normal_map = NormalMap{*normal, material.normal_scale, Green::up, std::nullopt};
    }
    if (material.alpha_mode == GltfMaterial::AlphaMode::blend) {
        report.add("blended alpha", "material", index, "drawn opaque");
    } else if (material.alpha_mode == GltfMaterial::AlphaMode::mask) {
        report.add("masked alpha", "material", index, "drawn opaque");
    }
    return phong;
}

/// Meshes and their places; a primitive that stands in several places is read once.
void add_instances(const GltfDocument& document, const GltfView& view, Scene& scene,
                   Report& report) {
    // Without normals, glTF asks for flat ones and says that tangents given do not count; new ones
    // are left to the effect plan.
    FrameOptions options;
    options.if_missing = NormalMode::flat;
    options.tangents = TangentMode::none;
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> mesh_of;
    for (const auto& placed : view.primitives) {
        const auto key = std::pair(placed.what.mesh, placed.what.primitive);
        const auto [entry, is_new] = mesh_of.try_emplace(key, scene.meshes.size());
        if (is_new) {
            Mesh mesh = document.mesh(placed.what);
            if (mesh.normals.empty()) mesh = with_frames(std::move(mesh), options, report).mesh;
            scene.meshes.push_back(std::move(mesh));
        }
        scene.instances.push_back({entry->second, placed.world_from_object, placed.name});
    }
}

void add_lights(const GltfView& view, Scene& scene) {
    for (const auto& placed : view.lights) {
        const GltfLight& light = placed.what;
        const glm::vec3 direction(-placed.world_from_object[2]);
        const glm::vec3 position(placed.world_from_object[3]);
        const glm::vec3 power = light.color * light.intensity * std::numbers::inv_pi_v<float>;
        const PointLight point{position, power, light.range};
        switch (light.type) {
            case GltfLight::Type::directional:
                scene.directional_lights.push_back({direction, power});
                break;
            case GltfLight::Type::point:
                scene.point_lights.push_back(point);
                break;
            case GltfLight::Type::spot:
                scene.spot_lights.push_back({point, direction, light.inner_cone, light.outer_cone});
                break;
        }
    }
}

/// The first camera, its matrix reduced to rotation and translation; one without depth reaches to
/// the farthest corner of the scene.
void add_camera(const GltfView& view, Scene& scene, Report& report) {
    if (view.cameras.empty()) return;
    const auto& placed = view.cameras.front();
    const glm::vec3 eye(placed.world_from_object[3]);
    const glm::vec3 back = glm::normalize(glm::vec3(placed.world_from_object[2]));
    const glm::vec3 right =
        glm::normalize(glm::cross(glm::vec3(placed.world_from_object[1]), back));
    if (!(glm::length(right) > 0.5F && glm::length(back) > 0.5F)) {
        report.add("camera without a direction", "camera", 0, "left out");
        return;
    }
    Camera camera;
    camera.world_from_view =
        glm::mat4(glm::vec4(right, 0.0F), glm::vec4(glm::cross(back, right), 0.0F),
                  glm::vec4(back, 0.0F), glm::vec4(eye, 1.0F));
    camera.vertical_fov = placed.what.vertical_fov;
    camera.near = placed.what.near;
    if (placed.what.far) {
        camera.far = *placed.what.far;
    } else {
        const Bounds bounds = world_bounds(scene);
        const float reach =
            bounds.empty()
                ? 0.0F
                : glm::length(glm::max(glm::abs(bounds.min - eye), glm::abs(bounds.max - eye)));
        camera.far = std::max(2.0F * camera.near, 1.01F * reach);
    }
    scene.camera = camera;
}

}  // namespace

Scene scene_from(const GltfDocument& document, Report& report) {
    const GltfView view = document.view();
    Scene scene;
    for (const GltfImage& image : view.images) {
        ImageSource source;
        source.name = image.name;
        std::visit([&](const auto& encoded) { source.source = encoded; }, image.source);
        scene.images.push_back(std::move(source));
    }
    const std::vector<TextureMeans> means = texture_means(view, scene.images, report);
    for (std::size_t i = 0; i < view.materials.size(); ++i) {
        scene.materials.push_back(material_from(view.materials[i], means[i], i, report));
    }
    add_instances(document, view, scene, report);
    add_lights(view, scene);
    add_camera(view, scene, report);
    return scene;
}

}  // namespace relief
