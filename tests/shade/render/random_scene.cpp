// SPDX-License-Identifier: Apache-2.0

#include "shade/render/random_scene.h"

#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <numbers>

#include "environment/environment_images.h"
#include "relief/mesh/mesh.h"
#include "shade/render/draw_support.h"
#include "support/shapes.h"

namespace relief::test {
using namespace relief::shade;
using namespace relief::shade::detail;

namespace {

template <typename T, std::size_t count>
T one_of(Dice& dice, const T (&choices)[count]) {
    return choices[dice.below(count)];
}

Texture random_texture(Dice& dice, std::size_t image) {
    constexpr Wrap wraps[] = {Wrap::repeat, Wrap::clamp, Wrap::mirror};
    Texture texture;
    texture.image = image;
    texture.wrap_u = one_of(dice, wraps);
    texture.wrap_v = one_of(dice, wraps);
    texture.filter = dice.chance(0.2) ? TextureFilter::nearest : TextureFilter::linear;
    return texture;
}

/// Adds an image to a scene and returns a texture of it for a material.
Texture added(Scene& scene, Dice& dice, Image image) {
    scene.images.push_back({"image", std::move(image)});
    return random_texture(dice, scene.images.size() - 1);
}

void add_detail(Scene& scene, Material& material, Dice& dice) {
    if (dice.chance(0.4)) material.tangent_frame = TangentFrame::derivatives;
    if (dice.chance(0.3)) {
        material.bump_map =
            BumpMap{added(scene, dice, random_heights(dice)), dice.between(-1.0F, 1.0F)};
    } else if (dice.chance(0.6)) {
        NormalMap map;
        map.texture = added(scene, dice, random_normals(dice));
        map.scale = dice.between(0.2F, 1.5F);
        map.green = dice.chance(0.5) ? Green::up : Green::down;
        map.flat = dice.chance(0.5) ? FlatCode::middle : FlatCode::half;
        map.space = dice.chance(0.25) ? NormalSpace::object : NormalSpace::tangent;
        material.normal_map = map;
    }
}

void add_reflection(Material& material, Dice& dice) {
    if (dice.chance(0.4)) return;
    material.reflectivity = dice.color();
    if (dice.chance(0.3)) material.grazing_reflectivity = material.reflectivity;
    material.fresnel =
        one_of(dice, {FresnelModel::schlick, FresnelModel::dielectric, FresnelModel::conductor});
    material.refractive_index = dice.between(1.05F, 2.5F);
    material.conductor_index = dice.color(0.05F, 3.0F);
    material.conductor_absorption = dice.color(0.0F, 5.0F);
    if (dice.chance(0.3)) material.transmission = dice.between(0.1F, 1.0F);
}

void add_textures(Scene& scene, Material& material, Dice& dice) {
    const auto color = [&] {
        return added(scene, dice, random_image(dice, 4, ColorSpace::linear));
    };
    const auto data = [&] { return added(scene, dice, random_image(dice, 3, ColorSpace::data)); };
    if (dice.chance(0.4)) material.diffuse_texture = color();
    if (dice.chance(0.3)) material.specular_texture = color();
    if (dice.chance(0.3)) material.emission_texture = color();
    if (dice.chance(0.3)) material.opacity_texture = data();
    if (dice.chance(0.3)) {
        material.occlusion_texture = data();
        material.occlusion_strength = dice.between(0.0F, 1.0F);
    }
    if (material.metallic_roughness && dice.chance(0.5)) {
        material.metallic_roughness->texture = data();
    }
}

Material random_material(Scene& scene, Dice& dice, bool physical) {
    Material material;
    material.name = "random";
    material.ambient = dice.color();
    material.diffuse = dice.color();
    if (dice.chance(0.7)) material.specular = dice.color();
    if (dice.chance(0.3)) material.emission = dice.color(0.0F, 0.3F);
    material.shininess = std::exp(dice.between(0.0F, 5.0F));
    material.specular_model = one_of(dice, {SpecularModel::phong, SpecularModel::blinn_phong,
                                            SpecularModel::blinn_phong_normalized});
    // It takes no random number of its own, so that the other values of a seed stay.
    material.highlight_fresnel = material.specular.r > 0.5F;
    if (physical && dice.chance(0.3)) {
        material.metallic_roughness = MetallicRoughness{dice.color(), dice.between(0.0F, 1.0F),
                                                        dice.between(0.1F, 1.0F), std::nullopt};
    } else {
        material.interpolation = one_of(dice, {Interpolation::per_pixel, Interpolation::per_pixel,
                                               Interpolation::gouraud, Interpolation::flat});
        add_reflection(material, dice);
    }
    if (dice.chance(0.7)) add_textures(scene, material, dice);
    if (dice.chance(0.5)) add_detail(scene, material, dice);
    material.double_sided = dice.chance(0.4);
    material.unlit = dice.chance(0.07);
    return material;
}

PointLight random_point_light(Dice& dice) {
    PointLight light;
    light.position_world = dice.direction() * dice.between(1.8F, 3.0F);
    light.intensity = dice.color(0.0F, 3.0F);
    if (dice.chance(0.3)) light.range = dice.between(2.0F, 6.0F);
    if (dice.chance(0.3)) {
        light.falloff = Falloff::none;
        light.intensity *= 0.2F;
    }
    if (dice.chance(0.3)) light.highlight_intensity = dice.color(0.0F, 3.0F);
    if (light.range) light.ambient = 0.05F * light.intensity;
    return light;
}

void add_lights(Scene& scene, Dice& dice) {
    if (dice.chance(0.7)) scene.ambient = dice.color(0.0F, 0.4F);
    for (std::size_t i = dice.below(3); i > 0; --i) {
        DirectionalLight light;
        light.direction_world = -dice.direction() * dice.between(0.1F, 10.0F);
        light.irradiance = dice.color(0.0F, 0.8F);
        if (dice.chance(0.3)) light.highlight_irradiance = dice.color();
        scene.directional_lights.push_back(light);
    }
    for (std::size_t i = dice.below(3); i > 0; --i)
        scene.point_lights.push_back(random_point_light(dice));
    for (std::size_t i = dice.below(2); i > 0; --i) {
        SpotLight light;
        light.point = random_point_light(dice);
        light.direction_world = -light.point.position_world;
        light.outer_cone = dice.between(0.2F, 1.2F);
        light.inner_cone = light.outer_cone * dice.between(0.0F, 0.9F);
        scene.spot_lights.push_back(light);
    }
}

/// A random rotation, stretch and translation, possibly with a mirror.
glm::mat4 random_place(Dice& dice) {
    const glm::vec3 offset(dice.between(-1.0F, 1.0F), dice.between(-1.0F, 1.0F),
                           dice.between(-1.0F, 0.5F));
    glm::mat4 place = glm::translate(glm::mat4(1.0F), offset);
    place = glm::rotate(place, dice.between(0.0F, 6.28F), dice.direction());
    glm::vec3 stretch = dice.color(0.4F, 1.1F);
    if (dice.chance(0.3)) stretch.x = -stretch.x;
    return glm::scale(place, stretch);
}

Mesh random_mesh(Dice& dice) {
    Mesh mesh = sphere(24, 16);
    if (dice.chance(0.3)) mesh = make_torus(0.4F, 32, 16);
    if (dice.chance(0.2)) mesh = cube();
    if (dice.chance(0.3)) {
        for (const glm::vec3& position : mesh.positions) {
            mesh.colors.emplace_back(glm::clamp(position * 0.4F + 0.5F, 0.0F, 1.0F),
                                     0.6F + 0.4F * std::sin(3.0F * position.y));
        }
    }
    if (dice.chance(0.1)) mesh.texcoords.clear();
    if (dice.chance(0.1)) mesh.normals.clear();
    return mesh;
}

/// Makes one side of a convex mesh transparent. Overlapping surfaces may have no order of whole
/// triangles.
void make_see_through(Mesh& mesh, Material& material, Dice& dice) {
    mesh = dice.chance(0.5) ? sphere(24, 16) : cube();
    material.alpha_mode = AlphaMode::blend;
    material.double_sided = false;
    material.opacity = dice.between(0.1F, 0.9F);
}

}  // namespace

glm::vec3 Dice::direction() {
    const float z = between(-1.0F, 1.0F);
    const float around = between(0.0F, 2.0F * std::numbers::pi_v<float>);
    const float ring = std::sqrt(1.0F - z * z);
    return {ring * std::cos(around), ring * std::sin(around), z};
}

Image random_image(Dice& dice, int channels, ColorSpace space) {
    const int width = 3 + static_cast<int>(dice.below(6));
    Image image = make_image(width, 3 + static_cast<int>(dice.below(6)), channels, 32, space);
    for (float& sample : image.as<float>())
        sample = dice.between(0.0F, 1.0F);
    return image;
}

Image random_heights(Dice& dice) {
    Image image = make_image(8, 8, 1, 32, ColorSpace::data);
    for (float& sample : image.as<float>())
        sample = dice.between(0.0F, 1.0F);
    return image;
}

Image random_normals(Dice& dice) {
    Image image = make_image(8, 8, 3, 16, ColorSpace::data);
    const auto samples = image.as<std::uint16_t>();
    const auto code = [](float component) {
        return static_cast<std::uint16_t>(std::lround(32768.0F + 32767.0F * component));
    };
    for (std::size_t i = 0; i < samples.size(); i += 3) {
        const glm::vec3 lean(dice.between(-0.6F, 0.6F), dice.between(-0.6F, 0.6F), 1.0F);
        const glm::vec3 unit = glm::normalize(lean);
        samples[i] = code(unit.x);
        samples[i + 1] = code(unit.y);
        samples[i + 2] = code(unit.z);
    }
    return image;
}

Environment random_environment(Dice& dice, int face_size) {
    // One wave through space for each channel.
    std::array<glm::vec3, 3> waves{};
    for (glm::vec3& wave : waves)
        wave = dice.direction() * dice.between(1.0F, 3.0F);
    CubeFaces faces;
    for (std::size_t face = 0; face < 6; ++face) {
        Image image = make_image(face_size, face_size, 3, 32, ColorSpace::linear);
        const auto samples = image.as<float>();
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const auto texel = static_cast<int>(i / 3);
            const glm::dvec3 way =
                face_direction(face, (2.0 * (texel % face_size) + 1.0) / face_size - 1.0,
                               (2.0 * (texel / face_size) + 1.0) / face_size - 1.0);
            samples[i] =
                0.4F + 0.35F * std::sin(glm::dot(glm::vec3(glm::normalize(way)), waves[i % 3]));
        }
        faces.faces[face] = {"face", image};
    }
    faces.left_handed = dice.chance(0.3);
    Environment environment{faces};
    environment.lights = dice.chance(0.5);
    environment.intensity = dice.between(0.3F, 1.2F);
    environment.skybox = dice.chance(0.5);
    // It takes no random number of its own, so that the other values of a seed stay.
    if (environment.lights) environment.rotation = 6.0F * (environment.intensity - 0.75F);
    return environment;
}

Scene random_scene(std::uint64_t seed) {
    Dice dice(seed);
    Scene scene;
    scene.camera = front_camera();
    add_lights(scene, dice);
    if (dice.chance(0.4)) scene.environment = random_environment(dice);
    // OpenGL blurs environments for metallic-roughness less finely, so the scene has no such
    // material.
    const bool physical = !scene.environment;
    const std::size_t count = 1 + dice.below(3);
    for (std::size_t i = 0; i < count; ++i) {
        Mesh mesh = random_mesh(dice);
        Material material = random_material(scene, dice, physical);
        // It takes no random number of its own, so that the other values of a seed stay.
        material.environment_tint = scene.environment && material.diffuse.r > 0.6F;
        if (i == 0 && dice.chance(0.3)) make_see_through(mesh, material, dice);
        if (i > 0 && dice.chance(0.2)) {
            material.alpha_mode = AlphaMode::mask;
            material.alpha_cutoff = 0.3F;
        }
        scene.materials.push_back(material);
        mesh.material_ranges = {
            {0, static_cast<std::uint32_t>(mesh.triangles.size()), static_cast<std::uint32_t>(i)}};
        scene.meshes.push_back(std::move(mesh));
        scene.instances.push_back({i, random_place(dice), "random"});
    }
    scene.background = glm::vec4(dice.color(), dice.between(0.0F, 1.0F));
    if (dice.chance(0.4)) scene.exposure = dice.between(0.5F, 2.0F);
    scene.clamp_terms = scene.exposure < 0.9F;
    scene.tone_mapping =
        one_of(dice, {ToneMapping::none, ToneMapping::none, ToneMapping::none,
                      ToneMapping::reinhard, ToneMapping::aces, ToneMapping::khronos_neutral,
                      ToneMapping::aces_hill, ToneMapping::aces_hill_boost});
    return scene;
}

}  // namespace relief::test
