// SPDX-License-Identifier: Apache-2.0
/// \file
/// Tests that draw whole scenes, on OSMesa or, if it is not installed, on EGL.
#pragma once

#include "shade/render/draw_support.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "relief/mesh/image.h"
#include "relief/shade/renderer.h"
#include "relief/shade/scene.h"
#include "support/gl_environment.h"
#include "support/shapes.h"

namespace relief::test {

/// The tests of a suite share a context and are skipped if no backend is installed. A test that
/// does not restore the context (expect_clean_context()) fails.
class DrawTest : public ::testing::Test {
  protected:
    static void TearDownTestSuite() { release_shared_context(); }
    void SetUp() override;
    void TearDown() override;

    [[nodiscard]] const shade::Context& context() const { return *context_; }

    /// Renders the scene with its own camera and discards findings.
    [[nodiscard]] shade::Frame render(const shade::Scene& scene,
                                      const shade::FrameSettings& settings) const;
    [[nodiscard]] shade::Frame render(const shade::Scene& scene, const shade::FramePlan& plan,
                                      const shade::FrameSettings& settings) const;

    /// Renders in linear float with 1 sample per pixel: the exact radiance at each pixel center.
    [[nodiscard]] Image radiance(const shade::Scene& scene, int width, int height) const;

  private:
    const shade::Context* context_ = nullptr;
};

/// Returns the color of a pixel, counted from the upper left. 8-bit samples are codes.
glm::dvec4 pixel(const Image& image, int x, int y);

/// A camera at (0,0,3) that looks at the origin along -z. It sees 2 units up and down there.
shade::Camera front_camera();

/// A material without visible effects. Tests switch on the effect under test.
Material black_material();

/// A scene with only this mesh and material at the origin, and front_camera().
shade::Scene scene_of(Mesh mesh, const Material& material);

/// A square of 4 x 4 around the origin that faces +z, with an upright texture.
Mesh facing_square();

/// scene_of(facing_square(), material).
shade::Scene square_scene(const Material& material);

/// An image of one color.
Image constant_image(const glm::vec4& color, int channels, int bits, ColorSpace space);

/// An environment of constant radiance.
shade::Environment constant_environment(const glm::vec3& radiance, bool skybox);

/// Returns whether two images hold the same bits.
bool same_bits(const Image& a, const Image& b);

/// An unreadable texture of a material, and the material with the same picture.
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

/// A scene in which all terms of a material show.
inline shade::Scene scene_for_unreadable_textures() {
    Material material;
    material.name = "wall";
    material.specular = {0.5F, 0.5F, 0.5F};
    material.emission = {0.2F, 0.1F, 0.0F};
    material.alpha_mode = AlphaMode::blend;
    material.opacity = 0.75F;
    shade::Scene scene = scene_of(sphere(16, 8), material);
    scene.ambient = {0.3F, 0.3F, 0.3F};
    scene.directional_lights = {{{1, -0.5F, -1}, {0.8F, 0.8F, 0.8F}}};
    return scene;
}

}  // namespace relief::test
