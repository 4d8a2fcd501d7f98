// SPDX-License-Identifier: Apache-2.0
// Checks every index and number of a scene that drawing relies on, and names the first offence as
// thing, value and limit. Nothing is repaired. Tests: tests/shade/scene/scene_test.cpp.
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>

#include "relief/mesh/error.h"
#include "relief/shade/labels.h"
#include "relief/shade/scene.h"

namespace relief {

namespace {

std::string text(const glm::vec3& v) {
    return fmt::format("({}, {}, {})", v.x, v.y, v.z);
}

void check_range(const std::string& thing, float value, float low, float high) {
    if (!(value >= low && value <= high)) {
        throw InvalidInput(
            fmt::format("{} is {}, but must be within [{}, {}]", thing, value, low, high));
    }
}

void check_color(const std::string& thing, const glm::vec3& value, float limit) {
    for (int i = 0; i < 3; ++i) {
        if (!(value[i] >= 0.0F && value[i] <= limit)) {
            throw InvalidInput(fmt::format("{} is {}, but every channel must be within [0, {}]",
                                           thing, text(value), limit));
        }
    }
}

void check_finite(const std::string& thing, const glm::vec3& value) {
    for (int i = 0; i < 3; ++i) {
        if (!std::isfinite(value[i])) {
            throw InvalidInput(fmt::format("{} is {}, but must be finite", thing, text(value)));
        }
    }
}

void check_direction(const std::string& thing, const glm::vec3& value) {
    check_finite(thing, value);
    if (value == glm::vec3(0.0F)) {
        throw InvalidInput(fmt::format("{} is {}, but must have a length", thing, text(value)));
    }
}

void check_finite(const std::string& thing, const glm::mat4& matrix) {
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            if (!std::isfinite(matrix[column][row])) {
                throw InvalidInput(fmt::format("{}: row {}, column {} is {}, but must be finite",
                                               thing, row, column, matrix[column][row]));
            }
        }
    }
}

void check_index(const std::string& thing, const char* names, std::size_t index, std::size_t size) {
    if (index >= size) {
        throw InvalidInput(
            fmt::format("{} names {} {}, but there are only {}", thing, names, index, size));
    }
}

void validate_textures(const std::string& thing, const Material& material,
                       std::size_t image_count) {
    const auto check = [&](const char* name, const std::optional<Texture>& texture) {
        if (texture) check_index(thing + name, "image", texture->image, image_count);
    };
    check("diffuse texture", material.diffuse_texture);
    check("specular texture", material.specular_texture);
    check("emission texture", material.emission_texture);
    check("occlusion texture", material.occlusion_texture);
    check("opacity texture", material.opacity_texture);
    if (material.normal_map) {
        check("normal map", material.normal_map->texture);
        check_range(thing + "normal map scale", material.normal_map->scale, -1e6F, 1e6F);
    }
    if (material.bump_map) {
        check("bump map", material.bump_map->texture);
        check_range(thing + "bump map strength", material.bump_map->strength, -1e6F, 1e6F);
        if (material.normal_map) {
            throw InvalidInput(thing + "has a normal map and a bump map, but one normal");
        }
    }
    if (material.metallic_roughness) {
        check("metallic-roughness texture", material.metallic_roughness->texture);
    }
}

void validate_reflection(const std::string& thing, const Material& material) {
    check_color(thing + "reflectivity", material.reflectivity, 1.0F);
    check_color(thing + "grazing reflectivity", material.grazing_reflectivity, 1.0F);
    check_range(thing + "refractive index", material.refractive_index, 1.0F, 1e3F);
    check_color(thing + "conductor index", material.conductor_index, 1e3F);
    check_color(thing + "conductor absorption", material.conductor_absorption, 1e3F);
    check_range(thing + "reflection roughness", material.reflection_roughness, 0.0F, 1.0F);
    check_range(thing + "transmission", material.transmission, 0.0F, 1.0F);
}

/// What only Phong's model has is refused beside metallic-roughness.
void validate_metallic_roughness(const std::string& thing, const Material& material) {
    const MetallicRoughness& model = *material.metallic_roughness;
    check_color(thing + "base colour", model.base_color, 1.0F);
    check_range(thing + "metallic", model.metallic, 0.0F, 1.0F);
    check_range(thing + "roughness", model.roughness, 0.0F, 1.0F);
    if (material.interpolation == Interpolation::gouraud) {
        throw InvalidInput(thing +
                           "is metallic-roughness, which varies by pixel, and asks for Gouraud "
                           "shading, which does not");
    }
    if (material.transmission > 0.0F) {
        throw InvalidInput(thing +
                           "is metallic-roughness and transmits, which only Phong's model does");
    }
}

void validate_material(const Scene& scene, std::size_t index) {
    const Material& material = scene.materials[index];
    const std::string thing = material_label(scene, index) + ": ";
    check_color(thing + "ambient", material.ambient, max_reflectance);
    check_color(thing + "diffuse", material.diffuse, max_reflectance);
    check_color(thing + "specular", material.specular, max_reflectance);
    check_color(thing + "emission", material.emission, max_reflectance);
    check_range(thing + "shininess", material.shininess, 0.0F, 1e6F);
    check_range(thing + "occlusion strength", material.occlusion_strength, 0.0F, 1.0F);
    check_range(thing + "opacity", material.opacity, 0.0F, 1.0F);
    check_range(thing + "alpha cutoff", material.alpha_cutoff, 0.0F, max_reflectance);
    validate_reflection(thing, material);
    validate_textures(thing, material, scene.images.size());
    if (material.metallic_roughness) validate_metallic_roughness(thing, material);
}

void validate_point(const std::string& thing, const PointLight& light) {
    check_finite(thing + " position", light.position_world);
    check_color(thing + " intensity", light.intensity, max_light);
    if (light.highlight_intensity) {
        check_color(thing + " highlight intensity", *light.highlight_intensity, max_light);
    }
    if (light.range && !(*light.range > 0.0F && std::isfinite(*light.range))) {
        throw InvalidInput(
            fmt::format("{} range is {}, but must be positive and finite", thing, *light.range));
    }
}

void validate_spot(const std::string& thing, const SpotLight& light) {
    validate_point(thing, light.point);
    check_direction(thing + " direction", light.direction_world);
    check_range(thing + " outer cone", light.outer_cone, 0.0F, std::numbers::pi_v<float> * 0.5F);
    if (!(light.inner_cone >= 0.0F && light.inner_cone < light.outer_cone)) {
        throw InvalidInput(
            fmt::format("{} inner cone is {}, but must be at least 0 and below its outer cone {}",
                        thing, light.inner_cone, light.outer_cone));
    }
}

void validate_lights(const Scene& scene) {
    check_color("ambient light", scene.ambient, max_light);
    for (std::size_t i = 0; i < scene.directional_lights.size(); ++i) {
        const std::string thing = fmt::format("directional light {}", i);
        check_direction(thing + " direction", scene.directional_lights[i].direction_world);
        check_color(thing + " irradiance", scene.directional_lights[i].irradiance, max_light);
        if (const auto& highlights = scene.directional_lights[i].highlight_irradiance) {
            check_color(thing + " highlight irradiance", *highlights, max_light);
        }
    }
    for (std::size_t i = 0; i < scene.point_lights.size(); ++i) {
        validate_point(fmt::format("point light {}", i), scene.point_lights[i]);
    }
    for (std::size_t i = 0; i < scene.spot_lights.size(); ++i) {
        validate_spot(fmt::format("spot light {}", i), scene.spot_lights[i]);
    }
}

void validate_instance(const Scene& scene, std::size_t index) {
    const Instance& instance = scene.instances[index];
    const std::string thing = instance_label(scene, index);
    check_index(thing, "mesh", instance.mesh, scene.meshes.size());
    check_finite(thing + " matrix", instance.world_from_object);
    for (const MaterialRange& range : scene.meshes[instance.mesh]->material_ranges) {
        if (range.material) {
            check_index(thing, "material", *range.material, scene.materials.size());
        }
    }
}

}  // namespace

void validate(const Camera& camera) {
    check_finite("camera matrix", camera.world_from_view);
    if (!(camera.vertical_fov > 0.0F && camera.vertical_fov < std::numbers::pi_v<float>)) {
        throw InvalidInput(
            fmt::format("camera: vertical field of view is {}, but must be within "
                        "(0, pi)",
                        camera.vertical_fov));
    }
    if (!(camera.near > 0.0F && camera.near < camera.far && std::isfinite(camera.far))) {
        throw InvalidInput(
            fmt::format("camera: near is {} and far is {}, but must be 0 < near < "
                        "far and finite",
                        camera.near, camera.far));
    }
}

void validate_places(const Scene& scene) {
    for (std::size_t i = 0; i < scene.instances.size(); ++i)
        validate_instance(scene, i);
    validate_lights(scene);
}

void validate(const Scene& scene) {
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
        try {
            validate(scene.meshes[i]);
        } catch (const InvalidInput& error) {
            throw InvalidInput(fmt::format("{}: {}", mesh_label(scene, i), error.what()));
        }
    }
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        validate_material(scene, i);
    validate_places(scene);
    if (scene.environment) {
        check_range("environment intensity", scene.environment->intensity, 0.0F, max_reflectance);
    }
    if (scene.camera) validate(*scene.camera);
    check_color("background", glm::vec3(scene.background), max_light);
    check_range("background alpha", scene.background.a, 0.0F, 1.0F);
    check_range("exposure", scene.exposure, 0.0F, max_reflectance);
}

}  // namespace relief
