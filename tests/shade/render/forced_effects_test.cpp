// SPDX-License-Identifier: Apache-2.0
// Forcing an effect on that the plan left out changes no pixel: not one bit, in sRGB codes and in
// linear float. So leaving it out was right. One exception, in linear float: white vertex colours
// are interpolated, and a rasteriser's interpolation of 1 may be 1 - 6e-8.
#include <gtest/gtest.h>

#include <functional>

#include "draw_test.h"
#include "relief/shade/image_compare.h"
#include "support/shapes.h"

namespace relief {
namespace {

struct Forced {
    const char* name;
    std::function<void(DrawPlan&)> on;
};

const std::vector<Forced>& forced_effects() {
    static const std::vector<Forced> all = {
        {"diffuse texture", [](DrawPlan& d) { d.features.diffuse_texture = true; }},
        {"vertex colours", [](DrawPlan& d) { d.features.vertex_colors = true; }},
        {"normal map", [](DrawPlan& d) { d.features.detail = NormalDetail::normal_map; }},
        {"double-sided normals", [](DrawPlan& d) { d.features.double_sided = true; }},
        {"ambient", [](DrawPlan& d) { d.features.ambient = true; }},
        {"directional light", [](DrawPlan& d) { d.features.directional_lights += 1; }},
        {"point lights", [](DrawPlan& d) { d.features.point_lights += 2; }},
        {"spot light", [](DrawPlan& d) { d.features.spot_lights += 1; }},
        {"diffuse", [](DrawPlan& d) { d.features.diffuse = true; }},
        {"highlights",
         [](DrawPlan& d) {
             if (d.features.specular == SpecularTerm::none) {
                 d.features.specular = SpecularTerm::blinn_phong;
             }
         }},
        {"light ranges", [](DrawPlan& d) { d.features.light_ranges = true; }},
        {"light buffer", [](DrawPlan& d) { d.features.lights_in_buffer = true; }},
        {"emission", [](DrawPlan& d) { d.features.emission = true; }},
        {"emission texture", [](DrawPlan& d) { d.features.emission_texture = true; }},
        {"reflection", [](DrawPlan& d) { d.features.reflection = ReflectionTerm::mirror; }},
    };
    return all;
}

/// A sphere of a few facets, so that interpolation matters, and single-sided.
Scene base_scene() {
    Material material;
    material.name = "base";
    material.diffuse = {0.7F, 0.5F, 0.3F};
    Scene scene = test::scene_of(test::sphere(24, 12), material);
    scene.instances[0].world_from_object = glm::mat4(1.5F);
    scene.instances[0].world_from_object[1] = glm::vec4(0.3F, 1.0F, 0.1F, 0.0F);
    scene.instances[0].world_from_object[3] = glm::vec4(0.1F, 0.2F, 0.0F, 1.0F);
    scene.directional_lights = {{{1, -1, -2}, {0.9F, 0.8F, 0.7F}}};
    return scene;
}

std::vector<std::pair<const char*, Scene>> scenes() {
    std::vector<std::pair<const char*, Scene>> all;
    all.emplace_back("diffuse", base_scene());

    Scene shiny = base_scene();
    shiny.materials[0].specular = {0.4F, 0.4F, 0.4F};
    shiny.point_lights = {{{1, 1, 2}, {1, 1, 1}, std::nullopt}};
    all.emplace_back("shiny under two lights", shiny);

    Scene mirror = base_scene();
    mirror.materials[0].reflectivity = {0.5F, 0.4F, 0.3F};
    mirror.environment = test::constant_environment({0.3F, 0.6F, 0.9F}, true);
    mirror.ambient = {0.1F, 0.1F, 0.1F};
    all.emplace_back("mirror", mirror);

    Scene textured = base_scene();
    textured.images = {
        {"normal", test::constant_image({0.6F, 0.4F, 0.9F, 1}, 3, 8, ColorSpace::data)}};
    textured.materials[0].normal_map = NormalMap{Texture{0}, 1.0F, Green::up, FlatCode::middle};
    textured.materials[0].emission = {0.05F, 0.0F, 0.1F};
    all.emplace_back("normal-mapped and glowing", textured);

    Scene bare = base_scene();  // No texture coordinates: textures that exist cannot show.
    bare.meshes[0].texcoords.clear();
    bare.images = textured.images;
    bare.materials[0].normal_map = textured.materials[0].normal_map;
    bare.materials[0].diffuse_texture = Texture{0};
    all.emplace_back("without texture coordinates", bare);

    Scene dark = base_scene();
    dark.directional_lights.clear();
    dark.ambient = {0.2F, 0.3F, 0.4F};
    all.emplace_back("ambient only", dark);
    return all;
}

class ForcedEffects : public test::DrawTest {
  protected:
    /// \param tolerance  relative to 1, in linear pictures that vertex colours are forced on
    void expect_no_change(const Scene& scene, OutputCoding output, double tolerance) const {
        const FrameSettings settings{48, 48, 1, output};
        const FramePlan plan = plan_effects(scene, {.samples = 1, .output = output});
        const Image as_planned = render(scene, plan, settings).image;
        FramePlan all_forced = plan;
        for (const Forced& forced : forced_effects()) {
            SCOPED_TRACE(forced.name);
            FramePlan one_forced = plan;
            forced.on(one_forced.draws[0]);
            if (canonical(one_forced.draws[0].features) == plan.draws[0].features) continue;
            const Image image = render(scene, one_forced, settings).image;
            if (one_forced.draws[0].features.vertex_colors) {
                EXPECT_LE(compare(image, as_planned).max, tolerance);
            } else {
                EXPECT_TRUE(test::same_bits(image, as_planned));
                forced.on(all_forced.draws[0]);
            }
        }
        const Image image = render(scene, all_forced, settings).image;
        EXPECT_TRUE(test::same_bits(image, as_planned)) << "all effects at once";
    }
};

TEST_F(ForcedEffects, ChangeNoBitOfAnSrgbPicture) {
    for (const auto& [name, scene] : scenes()) {
        SCOPED_TRACE(name);
        expect_no_change(scene, OutputCoding::srgb, 0.0);
    }
}

TEST_F(ForcedEffects, ChangeNoBitOfALinearPicture) {
    for (const auto& [name, scene] : scenes()) {
        SCOPED_TRACE(name);
        expect_no_change(scene, OutputCoding::linear, 2.4e-7);  // Two steps of a float below 1.
    }
}

TEST_F(ForcedEffects, ThatAreTakenAwayDoChangeThePicture) {
    const Scene scene = base_scene();
    FramePlan plan = plan_effects(scene, {.samples = 1});
    const FrameSettings settings{48, 48, 1, OutputCoding::srgb};
    const Image whole = render(scene, plan, settings).image;
    plan.draws[0].features.diffuse = false;
    EXPECT_FALSE(test::same_bits(render(scene, plan, settings).image, whole));
}

}  // namespace
}  // namespace relief
