// SPDX-License-Identifier: Apache-2.0
// Scenes from features: one coarse sphere, textures of noise with a fixed seed, numbers that show.
#include "scene_calling_for.h"

#include <random>

#include "relief/shade/framing.h"
#include "support/shapes.h"

namespace relief::test {
namespace {

/// Texels of noise between two codes, alpha included.
Image noise(std::uint32_t seed, int channels, int low, int high, ColorSpace space) {
    std::mt19937 random(seed);
    Image image = make_image(4, 4, channels, 8, space);
    for (std::uint8_t& sample : image.as<std::uint8_t>()) {
        sample = static_cast<std::uint8_t>(
            low + static_cast<int>(random() % static_cast<unsigned>(high - low)));
    }
    return image;
}

Texture add_image(Scene& scene, const char* name, Image image) {
    scene.images.push_back({name, std::move(image)});
    return {scene.images.size() - 1};
}

void add_textures(Scene& scene, Material& m, const Features& f) {
    const auto color = [&](const char* name, std::uint32_t seed) {
        return add_image(scene, name, noise(seed, 4, 40, 256, ColorSpace::srgb));
    };
    const auto data = [&](const char* name, std::uint32_t seed, int low) {
        return add_image(scene, name, noise(seed, 3, low, 256, ColorSpace::data));
    };
    if (f.diffuse_texture) m.diffuse_texture = color("diffuse", 1);
    if (f.specular_texture) m.specular_texture = color("specular", 2);
    if (f.emission_texture) m.emission_texture = color("emission", 3);
    if (f.occlusion_texture) m.occlusion_texture = data("occlusion", 4, 40);
    m.occlusion_strength = 0.7F;
    if (f.opacity_texture) m.opacity_texture = data("opacity", 5, 100);
    if (f.metallic_roughness_texture) {
        m.metallic_roughness->texture = data("metallic and roughness", 6, 40);
    }
    if (f.detail == NormalDetail::normal_map || f.detail == NormalDetail::object_normal_map) {
        m.normal_map = NormalMap{data("normal", 7, 90)};
        if (f.detail == NormalDetail::object_normal_map) m.normal_map->space = NormalSpace::object;
    }
    if (f.detail == NormalDetail::bump_map) m.bump_map = BumpMap{data("bump", 8, 0), 2.0F};
}

Material material_calling_for(const Features& f) {
    Material m;
    m.name = "m";
    m.unlit = f.unlit;
    m.interpolation = f.interpolation;
    m.tangent_frame = f.frame;
    m.specular_antialiasing = f.specular_antialiasing;
    m.double_sided = f.double_sided;
    m.alpha_mode = f.alpha;
    if (f.alpha != AlphaMode::opaque) m.opacity = 0.8F;
    m.alpha_cutoff = 0.3F;
    const bool scatters = f.diffuse || f.environment_diffuse || f.unlit;
    m.diffuse = scatters ? glm::vec3(0.6F, 0.5F, 0.4F) : glm::vec3(0.0F);
    m.ambient = glm::vec3(0.3F, 0.2F, 0.4F);
    if (f.metallic_roughness) m.metallic_roughness = {{0.7F, 0.5F, 0.3F}, 0.4F, 0.5F, {}};
    if (f.specular != SpecularTerm::none) m.specular = glm::vec3(0.5F, 0.4F, 0.3F);
    m.shininess = 12.0F;
    if (f.specular == SpecularTerm::phong) m.specular_model = SpecularModel::phong;
    if (f.emission) m.emission = glm::vec3(0.1F, 0.05F, 0.02F);
    if (f.reflection != ReflectionTerm::none) m.reflectivity = glm::vec3(0.4F, 0.5F, 0.6F);
    if (f.reflection == ReflectionTerm::glossy) m.reflection_roughness = 0.4F;
    if (f.fresnel == FresnelTerm::constant) m.grazing_reflectivity = m.reflectivity;
    if (f.fresnel == FresnelTerm::dielectric) m.fresnel = FresnelModel::dielectric;
    if (f.fresnel == FresnelTerm::conductor) m.fresnel = FresnelModel::conductor;
    if (f.refraction) m.transmission = 0.5F;
    return m;
}

void add_lamps(Scene& scene, const Features& f) {
    const auto shift = [](std::uint32_t i) { return 0.5F * static_cast<float>(i); };
    for (std::uint32_t i = 0; i < f.directional_lights; ++i) {
        scene.directional_lights.push_back({{1.0F - shift(i), -1, -2}, {0.5F, 0.4F, 0.3F}});
    }
    const auto point = [&](std::uint32_t i) {
        PointLight light{{1.0F + shift(i), 1, 2}, glm::vec3(1.5F)};
        const bool falls = f.falloff == FalloffTerm::inverse_square ||
                           (f.falloff == FalloffTerm::mixed && i % 2 == 0);
        light.falloff = falls ? Falloff::inverse_square : Falloff::none;
        if (f.light_ranges) light.range = 5.0F;
        if (f.highlight_colors) light.highlight_intensity = glm::vec3(0.5F, 1.0F, 0.2F);
        return light;
    };
    for (std::uint32_t i = 0; i < f.point_lights; ++i)
        scene.point_lights.push_back(point(i));
    for (std::uint32_t i = 0; i < f.spot_lights; ++i) {
        scene.spot_lights.push_back({point(f.point_lights + i), {-0.5F, -0.4F, -1}, 0.2F, 0.7F});
    }
    if (!f.highlight_colors) return;
    for (DirectionalLight& light : scene.directional_lights)
        light.highlight_irradiance = glm::vec3(0.1F, 0.3F, 0.5F);
}

void add_surroundings(Scene& scene, const Features& f) {
    if (f.ambient) scene.ambient = glm::vec3(0.2F, 0.3F, 0.1F);
    if (!f.environment_diffuse && f.reflection == ReflectionTerm::none) return;
    CubeFaces faces;
    for (std::uint32_t i = 0; i < 6; ++i)
        faces.faces[i] = {"face", noise(20 + i, 3, 0, 256, ColorSpace::srgb)};
    scene.environment = Environment{faces, 1.5F, !f.double_sided, f.environment_diffuse};
}

/// Features that a scene calls for, as near to these as can be.
Features attainable(Features f) {
    f.lights_in_buffer = false;
    const bool lamps = f.directional_lights + f.point_lights + f.spot_lights > 0;
    const bool environment = f.environment_diffuse || f.reflection != ReflectionTerm::none;
    if (f.falloff == FalloffTerm::mixed && f.point_lights + f.spot_lights == 1) {
        f.falloff = FalloffTerm::inverse_square;
    }
    if (f.metallic_roughness && environment) f.reflection = ReflectionTerm::glossy;
    if (lamps && f.environment_diffuse) f.diffuse = true;
    if (f.output == OutputCoding::half) f.output = OutputCoding::srgb;
    if (f.alpha == AlphaMode::blend && f.output != OutputCoding::linear) {
        f.output = OutputCoding::half;
    }
    return f;
}

}  // namespace

CallingScene scene_calling_for(const Features& features) {
    CallingScene result;
    Scene& scene = result.scene;
    Mesh mesh = sphere(24, 12);
    mesh.name = "sphere";
    if (features.vertex_colors) {
        for (const glm::vec3& p : mesh.positions) {
            mesh.colors.emplace_back(0.5F + 0.5F * p.x, 0.9F, 0.5F - 0.5F * p.y, 0.9F);
        }
    }
    mesh.material_ranges = {{0, static_cast<std::uint32_t>(mesh.triangles.size()), 0}};
    scene.meshes = {std::move(mesh)};
    scene.instances = {{0, glm::mat4(1.3F), "i"}};
    scene.instances[0].world_from_object[1] = glm::vec4(0.3F, 1.0F, 0.1F, 0.0F);
    scene.instances[0].world_from_object[3] = glm::vec4(0.1F, 0.2F, 0.0F, 1.0F);
    scene.materials = {material_calling_for(features)};
    add_textures(scene, scene.materials[0], features);
    add_lamps(scene, features);
    add_surroundings(scene, features);
    if (features.exposure) scene.exposure = 1.5F;
    scene.tone_mapping = features.tone_mapping;
    scene.background = {0.1F, 0.2F, 0.3F, 1.0F};
    scene.camera = framed(scene, 0.4F, 0.3F, 0.6F, 1.0F);
    result.expected = canonical(attainable(features));
    result.settings = {32, 32, 1, features.output};
    if (features.output == OutputCoding::half) result.settings.output = OutputCoding::srgb;
    return result;
}

}  // namespace relief::test
