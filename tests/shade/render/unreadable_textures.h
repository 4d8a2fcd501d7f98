// SPDX-License-Identifier: Apache-2.0
/// \file
/// Textures that cannot be read, for the tests of the renderer and of the CPU reference.
#pragma once

#include <vector>

#include "draw_test.h"
#include "relief/shade/scene.h"
#include "support/shapes.h"

namespace relief::test {

/// A material's texture that cannot be read, and the material that draws the same.
struct UnreadableTexture {
    const char* effect;
    void (*set)(Material& material, const Texture& texture);
    void (*make_equal)(Material& material) = [](Material&) {};
};

inline std::vector<UnreadableTexture> unreadable_textures() {
    using M = Material&;
    using T = const Texture&;
    return {{"diffuse texture", [](M m, T t) { m.diffuse_texture = t; }},
            {"specular texture", [](M m, T t) { m.specular_texture = t; }},
            {"emission texture", [](M m, T t) { m.emission_texture = t; },
             [](M m) { m.emission = glm::vec3(0.0F); }},
            {"occlusion texture", [](M m, T t) { m.occlusion_texture = t; }},
            {"opacity texture", [](M m, T t) { m.opacity_texture = t; }},
            {"metallic-roughness texture",
             [](M m, T t) {
                 m.metallic_roughness = MetallicRoughness{{1, 1, 1}, 0.5F, 0.5F, t};
             },
             [](M m) {
                 m.metallic_roughness = MetallicRoughness{{1, 1, 1}, 0.5F, 0.5F, {}};
             }},
            {"normal map", [](M m, T t) { m.normal_map = NormalMap{t}; }},
            {"object-space normal map",
             [](M m, T t) {
                 m.normal_map = NormalMap{t, 1.0F, Green::up, std::nullopt, NormalSpace::object};
             }},
            {"bump map", [](M m, T t) { m.bump_map = BumpMap{t}; }}};
}

/// All of a material's terms show.
inline Scene scene_for_unreadable_textures() {
    Material material;
    material.name = "wall";
    material.specular = {0.5F, 0.5F, 0.5F};
    material.emission = {0.2F, 0.1F, 0.0F};
    material.alpha_mode = AlphaMode::blend;
    material.opacity = 0.75F;
    Scene scene = scene_of(sphere(16, 8), material);
    scene.ambient = {0.3F, 0.3F, 0.3F};
    scene.directional_lights = {{{1, -0.5F, -1}, {0.8F, 0.8F, 0.8F}}};
    return scene;
}

}  // namespace relief::test
