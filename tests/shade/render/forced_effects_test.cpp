// SPDX-License-Identifier: Apache-2.0
// Forcing an effect on that the plan left out changes no pixel: not one bit, in sRGB codes and in
// linear float, one by one and all together. So leaving it out was right. Which effects are choices
// of the scene instead, effect_forcing.h says.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "../effects/all_features.h"
#include "../effects/scene_calling_for.h"
#include "draw_test.h"
#include "relief/mesh/error.h"
#include "relief/shade/effect_forcing.h"
#include "relief/shade/framing.h"
#include "relief/shade/scene_file.h"
#include "support/shapes.h"
#include "support/shared_data.h"

namespace relief {
namespace {

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
    bare.meshes[0].edit().texcoords.clear();
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

/// What the neutral plan has and the other has not.
std::vector<std::string> added_effects(const FramePlan& plan, const FramePlan& neutral) {
    const std::vector<std::string> before = effects_in(plan);
    std::vector<std::string> added;
    for (const std::string& name : effects_in(neutral)) {
        if (std::find(before.begin(), before.end(), name) == before.end()) added.push_back(name);
    }
    return added;
}

class ForcedEffects : public test::DrawTest {
  protected:
    [[nodiscard]] Image forced(const Scene& scene, const FrameSettings& settings,
                               const EffectRequest& requests) const {
        const FramePlan plan = plan_effects(scene, settings);
        return render(scene, force_effects(scene, settings, plan, requests), settings).image;
    }

    /// Everything neutral at once; if that shows, one by one, to say which.
    /// \return how many effects were forced on
    std::size_t expect_no_change(const Scene& scene, const FrameSettings& settings) const {
        const FramePlan plan = plan_effects(scene, settings);
        const EffectRequest all{EffectBase::all_neutral, {}};
        const FramePlan neutral = force_effects(scene, settings, plan, all);
        const Image as_planned = render(scene, plan, settings).image;
        const std::vector<std::string> added = added_effects(plan, neutral);
        if (test::same_bits(render(scene, neutral, settings).image, as_planned)) {
            return added.size();
        }
        ADD_FAILURE() << "all neutral effects at once show";
        for (const std::string& effect : added) {
            EffectRequest without = all;
            without.forced = {{effect, false}};
            if (test::same_bits(forced(scene, settings, without), as_planned)) {
                ADD_FAILURE() << "not without '" << effect << "'";
            }
        }
        return added.size();
    }

    /// Each effect by itself, as far as any draw can have it.
    std::set<std::string> expect_no_change_one_by_one(const Scene& scene,
                                                      const FrameSettings& settings) const {
        const FramePlan plan = plan_effects(scene, settings);
        const Image as_planned = render(scene, plan, settings).image;
        std::set<std::string> shown;
        for (const Effect& effect : effects()) {
            if (effect.on(plan.draws.at(0).features)) continue;
            const EffectRequest one{EffectBase::planned, {{effect.name, true}}};
            try {
                EXPECT_TRUE(test::same_bits(forced(scene, settings, one), as_planned))
                    << effect.name;
                shown.insert(effect.name);
            } catch (const InvalidInput&) {  // A choice, or nothing here could show it.
            }
        }
        return shown;
    }
};

TEST_F(ForcedEffects, ChangeNoBitOneByOne) {
    std::set<std::string> forced;
    for (const auto& [name, scene] : scenes()) {
        SCOPED_TRACE(name);
        forced.merge(expect_no_change_one_by_one(scene, {32, 32, 1, OutputCoding::linear}));
    }
    // Every effect that is no choice of the scene and needs no other forced beside it; exposure
    // belongs to sRGB.
    for (const char* effect : {"diffuse texture",   "vertex colours",
                               "alpha mask",        "normal map",
                               "bump map",          "double-sided normals",
                               "ambient",           "point lights",
                               "spot lights",       "mixed falloff",
                               "light ranges",      "highlight colours",
                               "light buffer",      "environment light",
                               "Phong highlights",  "Blinn-Phong highlights",
                               "specular texture",  "emission",
                               "emission texture",  "mirror reflection",
                               "glossy reflection", "refraction"}) {
        EXPECT_TRUE(forced.contains(effect)) << effect;
    }
}

TEST_F(ForcedEffects, ThatNeedOthersChangeNoBitWithThem) {
    const std::vector<std::vector<ForcedEffect>> sets = {
        {{"mirror reflection"}, {"dielectric Fresnel"}},
        {{"mirror reflection"}, {"conductor Fresnel"}},
        {{"glossy reflection"}, {"Schlick's Fresnel"}, {"refraction"}},
        {{"normal map"}, {"specular antialiasing"}, {"Phong highlights"}},
        {{"spot lights"}, {"no falloff"}},
        {{"mirror reflection"}, {"Schlick's Fresnel"}},
        {{"alpha mask"}, {"opacity texture"}},
    };
    const Scene scene = base_scene();
    const FrameSettings settings{48, 48, 1, OutputCoding::linear};
    const Image as_planned = forced(scene, settings, {});
    for (const std::vector<ForcedEffect>& set : sets) {
        const EffectRequest requests{EffectBase::planned, set};
        EXPECT_TRUE(test::same_bits(forced(scene, settings, requests), as_planned))
            << set[0].name << ", " << set[1].name;
    }
}

TEST_F(ForcedEffects, ChangeNoBitAllTogetherInScenesWhereEveryPairOfEffectsMeets) {
    std::size_t scenes = 0;
    std::size_t added = 0;
    for (const Features& features : test::covering_features()) {
        SCOPED_TRACE(describe(features));
        const test::CallingScene calling = test::scene_calling_for(features);
        added += expect_no_change(calling.scene, calling.settings);
        ++scenes;
    }
    EXPECT_GT(added, 8 * scenes) << "effects forced on in each";
}

/// Every model and scene file in data/; models under one light.
std::vector<std::pair<std::string, Scene>> scenes_in_data() {
    std::vector<std::pair<std::string, Scene>> all;
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(test::source_directory() / "data")) {
        const std::string extension = entry.path().extension().string();
        if (extension != ".obj" && extension != ".glb" && extension != ".json") continue;
        Report report;
        Scene scene = load_scene(entry.path(), report);
        if (extension != ".json") {
            scene.directional_lights = {{{-0.5F, -1.0F, -0.8F}, glm::vec3(0.8F)}};
        }
        if (!scene.camera) scene.camera = framed(scene, 0.5F, 0.35F, 0.6F, 1.0F);
        all.emplace_back(entry.path().filename().string(), scene);
    }
    return all;
}

/// The same with every other map that data/ has, in its sky.
Scene under_the_sky(Scene scene) {
    const std::filesystem::path data = test::source_directory() / "data";
    CubeFaces faces;
    for (std::size_t i = 0; i < 6; ++i) {
        constexpr std::array names{"posx", "negx", "posy", "negy", "posz", "negz"};
        faces.faces[i] = {names[i], data / "sky" / (std::string(names[i]) + ".jpg")};
    }
    scene.environment = Environment{faces, 1.0F, true, true};
    scene.images.push_back({"bricks", data / "bricks-diffuse.png"});
    scene.images.push_back({"heights", data / "bricks-height.png"});
    for (Material& material : scene.materials) {
        material.reflectivity = glm::vec3(0.3F);
        material.diffuse_texture = Texture{scene.images.size() - 2};
        if (!material.normal_map) material.bump_map = BumpMap{{scene.images.size() - 1}, 8.0F};
    }
    return scene;
}

TEST_F(ForcedEffects, ChangeNoBitOfTheScenesInData) {
    const auto all = scenes_in_data();
    EXPECT_GE(all.size(), 2U);
    for (const auto& [name, scene] : all) {
        SCOPED_TRACE(name);
        EXPECT_GT(expect_no_change(scene, {64, 64, 1, OutputCoding::srgb}), 3U);
    }
    const auto vase = std::find_if(all.begin(), all.end(),
                                   [](const auto& entry) { return entry.first == "vase.obj"; });
    ASSERT_NE(vase, all.end());
    const Scene in_the_sky = under_the_sky(vase->second);
    for (const int samples : {1, 4})
        expect_no_change(in_the_sky, {96, 96, samples, OutputCoding::srgb});
}

TEST_F(ForcedEffects, ThatAreTakenAwayDoChangeThePicture) {
    const Scene scene = base_scene();
    const FrameSettings settings{48, 48, 1, OutputCoding::srgb};
    const Image whole = forced(scene, settings, {});
    EXPECT_FALSE(test::same_bits(
        forced(scene, settings, {EffectBase::planned, {{"diffuse", false}}}), whole));
    EXPECT_FALSE(test::same_bits(forced(scene, settings, {EffectBase::nothing, {}}), whole));
    EXPECT_TRUE(test::same_bits(
        forced(scene, settings,
               {EffectBase::nothing, {{"diffuse", true}, {"directional lights", true}}}),
        whole));
}

TEST_F(ForcedEffects, VertexColoursAreExactlyWhiteBetweenWhiteVertices) {
    // A mask that only full coverage passes, over a mesh with one transparent corner on the far
    // side.
    Scene scene = test::scene_of(test::sphere(24, 12), test::black_material());
    scene.materials[0].emission = glm::vec3(1.0F);
    scene.materials[0].alpha_mode = AlphaMode::mask;
    scene.materials[0].alpha_cutoff = 1.0F;
    const Image whole = render(scene, {48, 48, 1, OutputCoding::srgb}).image;
    Mesh& mesh = scene.meshes[0].edit();
    mesh.colors.assign(mesh.positions.size(), glm::vec4(1.0F));
    const auto hidden =
        std::min_element(mesh.positions.begin(), mesh.positions.end(),
                         [](const glm::vec3& a, const glm::vec3& b) { return a.z < b.z; });
    mesh.colors[static_cast<std::size_t>(hidden - mesh.positions.begin())].a = 0.0F;
    EXPECT_TRUE(plan_effects(scene, {}).draws[0].features.vertex_colors);
    EXPECT_TRUE(test::same_bits(render(scene, {48, 48, 1, OutputCoding::srgb}).image, whole));
}

}  // namespace
}  // namespace relief
