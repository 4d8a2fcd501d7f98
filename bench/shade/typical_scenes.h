// SPDX-License-Identifier: Apache-2.0
/// \file
/// The six scenes of the frame benchmarks: a sphere of 99,856 triangles with materials from plain
/// to metallic-roughness.
#pragma once

#include <random>
#include <span>
#include <vector>

#include "relief/mesh/mesh.h"
#include "relief/shade/scene.h"

namespace relief::bench {

struct TypicalScene {
    const char* name;
    const char* minimal;            ///< Folder below bench/shade/minimal.
    std::vector<const char*> uses;  ///< Switches of the branching shader that are on.
    shade::Scene scene;
};

/// Random texels; for a normal map, near the flat color.
inline Image noise(std::uint32_t seed, int size, bool around_flat, ColorSpace space) {
    std::mt19937 random(seed);
    Image image = make_image(size, size, 3, 8, space);
    const std::span<std::uint8_t> samples = image.as<std::uint8_t>();
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const unsigned base = !around_flat ? 64 : (i % 3 == 2 ? 224 : 112);
        samples[i] = static_cast<std::uint8_t>(base + random() % (around_flat ? 32U : 160U));
    }
    return image;
}

inline shade::Scene diffuse_scene() {
    shade::Scene scene;
    Mesh mesh = make_sphere(316, 159);
    mesh.material_ranges = {{0, static_cast<std::uint32_t>(mesh.triangles.size()), 0}};
    scene.meshes = {std::move(mesh)};
    Material material;
    material.name = "sphere";
    material.diffuse = {0.7F, 0.6F, 0.5F};
    scene.materials = {material};
    scene.instances = {{0, glm::mat4(1.0F), "sphere"}};
    scene.directional_lights = {{{-0.4F, -0.5F, -1.0F}, glm::vec3(0.9F)}};
    shade::Camera camera;
    camera.world_from_view[3] = glm::vec4(0, 0, 3.0F, 1);
    scene.camera = camera;
    return scene;
}

inline Texture add_image(shade::Scene& scene, const char* name, Image image) {
    scene.images.push_back({name, std::move(image)});
    return {scene.images.size() - 1};
}

inline void add_normal_map(shade::Scene& scene) {
    scene.materials[0].normal_map =
        NormalMap{add_image(scene, "normal", noise(2, 1024, true, ColorSpace::data))};
}

inline std::vector<TypicalScene> typical_scenes() {
    shade::Scene scene = diffuse_scene();
    std::vector<TypicalScene> all;
    all.push_back({"diffuse", "diffuse", {}, scene});
    scene.materials[0].specular = glm::vec3(0.5F);
    all.push_back({"Blinn-Phong", "blinn_phong", {"highlights"}, scene});
    scene.materials[0].diffuse_texture =
        add_image(scene, "diffuse", noise(1, 1024, false, ColorSpace::srgb));
    all.push_back(
        {"+ diffuse texture", "diffuse_texture", {"highlights", "diffuse_texture"}, scene});
    add_normal_map(scene);
    all.push_back(
        {"+ normal map", "normal_map", {"highlights", "diffuse_texture", "normal_map"}, scene});
    shade::Scene physical = scene;
    shade::CubeFaces faces;
    for (std::uint32_t i = 0; i < 6; ++i)
        faces.faces[i] = {"face", noise(10 + i, 512, false, ColorSpace::srgb)};
    scene.environment = shade::Environment{faces, 1.0F, false};
    scene.materials[0].reflectivity = glm::vec3(0.3F);
    all.push_back({"+ reflection",
                   "reflection",
                   {"highlights", "diffuse_texture", "normal_map", "reflection"},
                   scene});
    Material& material = physical.materials[0];
    material.metallic_roughness = MetallicRoughness{};
    material.metallic_roughness->texture =
        add_image(physical, "metallic and roughness", noise(3, 1024, false, ColorSpace::data));
    all.push_back(
        {"metallic-roughness", "metallic_roughness", {"diffuse_texture", "normal_map"}, physical});
    return all;
}

}  // namespace relief::bench
