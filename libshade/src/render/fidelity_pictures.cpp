// SPDX-License-Identifier: Apache-2.0
// Draws the pictures of fidelity.h. Each view is drawn with more samples than pixels; the samples
// of a pixel are averaged here, so that other sample positions (the noise floor) cover the same
// pixels. Tests: tests/shade/render/fidelity_test.cpp.
#include "render/fidelity_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>

#include "relief/shade/environment.h"

namespace relief::shade::detail {
namespace {

/// White surfaces stay below the largest value of a picture.
constexpr float studio_intensity = 0.75F;

/// Sine and cosine of 75 degrees.
constexpr float sin_grazing = 0.965925826F;
constexpr float cos_grazing = 0.258819045F;

/// Beyond this distance, the depths of a model lose their resolution.
constexpr double max_reach = 100.0;

/// Calls visit(position) for every finite vertex in world space.
template <typename Visit>
void for_each_vertex(const Scene& scene, const Visit& visit) {
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const glm::dmat4 world_from_object(scene.instances[i].world_from_object);
        const Shared<Mesh> mesh = deformed_mesh(scene, i);
        for (const glm::vec3& position : mesh->positions) {
            const glm::dvec3 world(world_from_object * glm::dvec4(glm::dvec3(position), 1.0));
            if (std::isfinite(world.x + world.y + world.z)) visit(world);
        }
    }
}

double radius_around(const Scene& scene, const glm::dvec3& center) {
    double squared = 0.0;
    for_each_vertex(scene, [&](const glm::dvec3& position) {
        const glm::dvec3 offset = position - center;
        squared = std::max(squared, glm::dot(offset, offset));
    });
    return std::sqrt(squared);
}

bool is_default(const Material& material) {
    return material.name == default_material().name && !material.metallic_roughness &&
           !material.diffuse_texture && material.diffuse == default_material().diffuse;
}

/// Keeps normals, opacity and, for FidelityMaterials::colored, base colors.
Material matte(const Material& material, FidelityMaterials materials) {
    Material result;
    result.name = material.name;
    result.interpolation = material.interpolation;
    result.normal_map = material.normal_map;
    result.bump_map = material.bump_map;
    result.height_map = material.height_map;
    result.tangent_frame = material.tangent_frame;
    result.opacity_texture = material.opacity_texture;
    result.alpha_mode = material.alpha_mode;
    result.opacity = material.opacity;
    result.alpha_cutoff = material.alpha_cutoff;
    result.double_sided = material.double_sided;
    if (materials == FidelityMaterials::colored) {
        const auto& model = material.metallic_roughness;
        result.diffuse = model                  ? model->base_color
                         : is_default(material) ? glm::vec3(1.0F)
                                                : material.diffuse;
    }
    if (materials == FidelityMaterials::colored || material.alpha_mode != AlphaMode::opaque)
        result.diffuse_texture = material.diffuse_texture;
    return result;
}

/// \param back  the direction to the camera
glm::mat3 axes_of(const glm::vec3& back) {
    const glm::vec3 across = glm::cross(glm::vec3(0, 1, 0), back);
    const bool is_vertical = glm::dot(across, across) < 1e-12F;
    const glm::vec3 right = is_vertical ? glm::vec3(1, 0, 0) : glm::normalize(across);
    return {right, glm::cross(back, right), back};
}

/// \param reach  the radius of the scene around the origin
Camera camera_of(const glm::vec3& from, double reach) {
    const glm::mat3 axes = axes_of(from);
    const auto distance = static_cast<float>(1.5 * reach);
    Camera camera;
    camera.world_from_view = glm::mat4(axes);
    camera.world_from_view[3] = glm::vec4(axes[2] * distance, 1.0F);
    camera.near = static_cast<float>(0.45 * reach);
    camera.far = static_cast<float>(2.55 * reach);
    camera.orthographic_height = static_cast<float>(2.0 / fidelity_sphere_share);
    return camera;
}

DirectionalLight grazing_light(const glm::vec3& from) {
    const glm::mat3 axes = axes_of(from);
    const float side = sin_grazing * std::sqrt(0.5F);
    const glm::vec3 to_light = side * (axes[1] - axes[0]) + cos_grazing * axes[2];
    return {-to_light, glm::vec3(1.0F)};
}

Scene lit(Scene scene, FidelityLight light) {
    switch (light) {
        case FidelityLight::studio:
            scene.environment = studio_environment();
            scene.environment->intensity = studio_intensity;
            break;
        case FidelityLight::grazing:
            scene.directional_lights = {grazing_light(fidelity_view(0))};
            break;
        case FidelityLight::base_color:
            for (Material& material : scene.materials)
                material.unlit = true;
            break;
    }
    return scene;
}

/// Calls add(pixel, sample) for every sample of a drawn image.
template <typename Add>
void for_each_sample(const Image& drawn, int per_side, const Add& add) {
    const std::span<const float> samples = drawn.as<float>();
    const int size = drawn.width / per_side;
    for (int y = 0; y < drawn.height; ++y) {
        for (int x = 0; x < drawn.width; ++x) {
            const auto i = static_cast<std::size_t>(y * drawn.width + x);
            const auto pixel = static_cast<std::size_t>(y / per_side * size + x / per_side);
            add(pixel, glm::vec4(samples[4 * i], samples[4 * i + 1], samples[4 * i + 2],
                                 samples[4 * i + 3]));
        }
    }
}

ColorPicture averaged_colors(const Image& drawn, int per_side) {
    const int size = drawn.width / per_side;
    std::vector<glm::vec4> sums(static_cast<std::size_t>(size * size), glm::vec4(0.0F));
    for_each_sample(drawn, per_side, [&](std::size_t pixel, const glm::vec4& sample) {
        sums[pixel] += glm::vec4(glm::vec3(sample) * sample.a, sample.a);
    });
    constexpr float largest = 65535.0F;
    const float scale = largest / static_cast<float>(per_side * per_side);
    ColorPicture picture(sums.size());
    for (std::size_t i = 0; i < sums.size(); ++i)
        picture[i] = glm::u16vec4(glm::clamp(sums[i] * scale, 0.0F, largest) + 0.5F);
    return picture;
}

NormalPicture averaged_normals(const Image& drawn, int per_side) {
    const int size = drawn.width / per_side;
    const auto pixels = static_cast<std::size_t>(size * size);
    NormalPicture picture{std::vector<glm::vec3>(pixels, glm::vec3(0.0F)),
                          std::vector<float>(pixels, 0.0F)};
    const float share = 1.0F / static_cast<float>(per_side * per_side);
    for_each_sample(drawn, per_side, [&](std::size_t pixel, const glm::vec4& sample) {
        if (!(sample.a > 0.5F)) return;
        picture.normals[pixel] += 2.0F * glm::vec3(sample) - 1.0F;
        picture.coverage[pixel] += share;
    });
    return picture;
}

/// Returns the color of all surfaces if they have the same one.
std::optional<glm::vec3> only_color(const Scene& scene) {
    const auto has_colors = [&](const Instance& one) {
        return !scene.meshes[one.mesh]->colors.empty();
    };
    if (scene.materials.empty() ||
        std::any_of(scene.instances.begin(), scene.instances.end(), has_colors))
        return std::nullopt;
    const glm::vec3 color = scene.materials.front().diffuse;
    const bool is_same =
        std::all_of(scene.materials.begin(), scene.materials.end(), [&](const Material& one) {
            return !one.metallic_roughness && !one.diffuse_texture && one.diffuse == color &&
                   one.alpha_mode == AlphaMode::opaque;
        });
    return is_same ? std::optional(glm::min(color, 1.0F)) : std::nullopt;
}

/// Returns the picture of surfaces of one color without light.
ColorPicture one_color_picture(const glm::vec3& color, const NormalPicture& covered) {
    constexpr float largest = 65535.0F;
    ColorPicture picture(covered.coverage.size());
    for (std::size_t i = 0; i < picture.size(); ++i) {
        const float coverage = std::min(covered.coverage[i], 1.0F);
        picture[i] = glm::u16vec4(glm::vec4(color * coverage, coverage) * largest + 0.5F);
    }
    return picture;
}

}  // namespace

bool has_triangles(const Scene& scene) {
    return std::any_of(scene.instances.begin(), scene.instances.end(), [&](const Instance& one) {
        return !scene.meshes[one.mesh]->triangles.empty();
    });
}

FidelitySphere fidelity_sphere(const Scene& source) {
    const Bounds bounds = world_bounds(source);
    if (!has_triangles(source) || bounds.empty())
        throw InvalidInput("the source has no triangle, so nothing can be compared with it");
    FidelitySphere sphere;
    sphere.center = (glm::dvec3(bounds.min) + glm::dvec3(bounds.max)) / 2.0;
    sphere.radius = radius_around(source, sphere.center);
    constexpr double min_radius = 1e-12, max_radius = 1e12;
    if (!(sphere.radius >= min_radius && sphere.radius <= max_radius)) {
        throw InvalidInput(fmt::format(
            "the radius of the source is {:g}, but must be within [1e-12, 1e12]", sphere.radius));
    }
    return sphere;
}

FidelityMaterials fidelity_materials(const Scene& source) {
    if (!std::all_of(source.materials.begin(), source.materials.end(), is_default))
        return FidelityMaterials::as_authored;
    const bool has_colors =
        std::any_of(source.instances.begin(), source.instances.end(),
                    [&](const Instance& one) { return !source.meshes[one.mesh]->colors.empty(); });
    return has_colors ? FidelityMaterials::colored : FidelityMaterials::gray;
}

Scene normalized_scene(Scene scene, const FidelitySphere& sphere, FidelityMaterials materials) {
    const double scale = 1.0 / sphere.radius;
    glm::dmat4 unit_from_world(1.0);
    for (int axis = 0; axis < 3; ++axis) {
        unit_from_world[axis][axis] = scale;
        unit_from_world[3][axis] = -sphere.center[axis] * scale;
    }
    for (Instance& instance : scene.instances) {
        instance.world_from_object =
            glm::mat4(unit_from_world * glm::dmat4(instance.world_from_object));
        instance.open_shares = {};
    }
    for (Material& material : scene.materials) {
        if (material.metallic_roughness && material.metallic_roughness->attenuation_distance)
            *material.metallic_roughness->attenuation_distance *= static_cast<float>(scale);
    }
    Scene surfaces;
    surfaces.meshes = std::move(scene.meshes);
    surfaces.materials = std::move(scene.materials);
    surfaces.images = std::move(scene.images);
    surfaces.instances = std::move(scene.instances);
    name_default_material(surfaces);
    if (materials != FidelityMaterials::as_authored) {
        for (Material& material : surfaces.materials)
            material = matte(material, materials);
    }
    return surfaces;
}

DrawnScene::DrawnScene(RenderCache& cache, const Context& context, const Scene& scene, int size,
                       int per_side, Report& report)
    : reach_(std::clamp(radius_around(scene, glm::dvec3(0.0)), 1.0, max_reach)),
      per_side_(per_side),
      color_(only_color(scene)),
      grazing_(lit(scene, FidelityLight::grazing)) {
    FrameSettings settings{.width = size * per_side,
                           .height = size * per_side,
                           .samples = 1,
                           .output = OutputCoding::clamped};
    for (std::size_t i = 0; i < fidelity_light_count; ++i) {
        const auto light = static_cast<FidelityLight>(i);
        if (light == FidelityLight::base_color && color_) continue;
        const Scene with_light = lit(scene, light);
        lights_[i].emplace(cache, context, with_light, plan_effects(with_light, settings), settings,
                           i == 0 ? report : IgnoredReport());
    }
    settings.output = OutputCoding::linear;
    settings.view = DebugView::shading_normal;
    normals_.emplace(cache, context, scene, plan_effects(scene, settings), settings,
                     IgnoredReport());
}

ColorPicture DrawnScene::draw_light(FidelityLight light, const glm::vec3& from) {
    Renderer& renderer = *lights_[static_cast<std::size_t>(light)];
    if (light == FidelityLight::grazing) {
        grazing_.directional_lights = {grazing_light(from)};
        renderer.move(grazing_);
    }
    return averaged_colors(renderer.draw(camera_of(from, reach_)).image, per_side_);
}

NormalPicture DrawnScene::draw_normals(const glm::vec3& from) {
    return averaged_normals(normals_->draw(camera_of(from, reach_)).image, per_side_);
}

ViewPictures DrawnScene::draw(const glm::vec3& from) {
    ViewPictures pictures;
    pictures.normals = draw_normals(from);
    for (std::size_t i = 0; i < fidelity_light_count; ++i) {
        const auto light = static_cast<FidelityLight>(i);
        pictures.colors[i] = light == FidelityLight::base_color && color_
                                 ? one_color_picture(*color_, pictures.normals)
                                 : draw_light(light, from);
    }
    return pictures;
}

ViewPictures empty_view(int size) {
    const auto pixels = static_cast<std::size_t>(size * size);
    ViewPictures pictures;
    pictures.colors.fill(ColorPicture(pixels, glm::u16vec4(0)));
    pictures.normals = {std::vector<glm::vec3>(pixels, glm::vec3(0.0F)),
                        std::vector<float>(pixels, 0.0F)};
    return pictures;
}

}  // namespace relief::shade::detail
