// SPDX-License-Identifier: Apache-2.0
// An effect that the plan left out changes no bit of the picture when it is forced on, alone or
// with others. Effect costs: the choice of effects to drop from given and from measured times.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "relief/mesh/report.h"
#include "relief/shade/effect_costs.h"
#include "relief/shade/effects.h"
#include "relief/shade/scene.h"
#include "relief/shade/scene_file.h"
#include "shade/effects/feature_sets.h"
#include "shade/render/draw_support.h"
#include "support/labels.h"
#include "support/shapes.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::shade;

namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// A single-sided sphere with few facets, so that interpolation matters.
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

    Scene physical = base_scene();
    physical.materials[0].metallic_roughness = {{0.8F, 0.5F, 0.3F}, 0.4F, 0.3F, std::nullopt};
    physical.environment = test::constant_environment({0.3F, 0.6F, 0.9F}, true);
    physical.environment->lights = true;
    physical.ambient = {0.1F, 0.1F, 0.1F};
    all.emplace_back("metallic-roughness", physical);

    Scene layered = physical;
    MetallicRoughness& model = *layered.materials[0].metallic_roughness;
    model.refractive_index = 1.8F;
    model.specular_color = {0.7F, 0.9F, 0.4F};
    model.sheen_color = {0.3F, 0.6F, 0.1F};
    model.clearcoat = 0.7F;
    model.clearcoat_roughness = 0.3F;
    model.anisotropy = 0.6F;
    model.anisotropy_rotation = 0.5F;
    model.iridescence = 0.8F;
    all.emplace_back("layers of metallic-roughness", layered);

    Scene smooth = physical;  // A dielectric whose facets lose next to nothing.
    smooth.materials[0].metallic_roughness = {{0.8F, 0.5F, 0.3F}, 0.0F, 0.05F, std::nullopt};
    all.emplace_back("smooth dielectric", smooth);

    Scene bare = base_scene();  // Without texture coordinates, textures cannot show.
    bare.meshes[0].edit().texcoords.clear();
    bare.images = textured.images;
    bare.materials[0].normal_map = textured.materials[0].normal_map;
    bare.materials[0].diffuse_texture = Texture{0};
    all.emplace_back("without texture coordinates", bare);

    Scene at_rest = textured;  // With joints and morph targets that do not deform it.
    at_rest.instances[0].pose = test::pose_calling_for(at_rest.meshes[0], {});
    at_rest.instances[0].pose->joint_matrices.assign(2, glm::mat4(1.0F));
    at_rest.instances[0].pose->weights.assign(2, 0.0F);
    all.emplace_back("deformable, at rest", at_rest);

    Scene dark = base_scene();
    dark.directional_lights.clear();
    dark.ambient = {0.2F, 0.3F, 0.4F};
    all.emplace_back("ambient only", dark);
    return all;
}

/// Returns the effects of the neutral plan that the other plan does not have.
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

    /// Forces all neutral effects at once. If the picture changes, it forces them one by one to
    /// find the cause.
    /// \return the number of forced effects
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

    /// Forces each effect, in every draw that can have it: several at a time, since compiling their
    /// program costs more than drawing. If the picture changes, it forces them one by one.
    /// \return the effects that were forced
    std::set<std::string> expect_no_change_in_groups(const Scene& scene,
                                                     const FrameSettings& settings) const {
        constexpr std::size_t group_size = 8;
        const FramePlan plan = plan_effects(scene, settings);
        const Image as_planned = render(scene, plan, settings).image;
        std::set<std::string> shown;
        std::vector<ForcedEffect> group;
        const auto draw_group = [&] {
            if (group.empty()) return;
            if (!test::same_bits(forced(scene, settings, {EffectBase::planned, group}),
                                 as_planned)) {
                for (const ForcedEffect& one : group) {
                    if (!test::same_bits(forced(scene, settings, {EffectBase::planned, {one}}),
                                         as_planned))
                        ADD_FAILURE() << one.name;
                }
                ADD_FAILURE() << group.size() << " effects from '" << group[0].name << "' on show";
            }
            group.clear();
        };
        for (const Effect& effect : effects()) {
            if (effect.on(plan.draws.at(0).features)) continue;
            if (!can_be_forced(scene, settings, plan, {{effect.name, true}})) continue;
            group.push_back({effect.name, true});
            if (group.size() > group_size || !can_be_forced(scene, settings, plan, group)) {
                group.pop_back();
                draw_group();
                group.push_back({effect.name, true});
            }
            shown.insert(effect.name);
        }
        draw_group();
        return shown;
    }

  private:
    /// Returns false if an effect is a choice of the scene, cannot apply here, or excludes another.
    static bool can_be_forced(const Scene& scene, const FrameSettings& settings,
                              const FramePlan& plan, const std::vector<ForcedEffect>& requested) {
        try {
            const FramePlan with =
                force_effects(scene, settings, plan, {EffectBase::planned, requested});
            const std::vector<std::string> all = effects_in(with);
            return std::all_of(requested.begin(), requested.end(), [&](const ForcedEffect& effect) {
                return std::find(all.begin(), all.end(), effect.name) != all.end();
            });
        } catch (const InvalidInput&) {
            return false;
        }
    }
};

TEST_LABELS(not_sanitized);
TEST_F(ForcedEffects, ChangeNoBitInGroups) {
    std::set<std::string> forced;
    for (const auto& [name, scene] : scenes()) {
        SCOPED_TRACE(name);
        forced.merge(expect_no_change_in_groups(scene, {32, 32, 1, OutputCoding::linear}));
    }
    // Every effect that is not a choice of the scene and can be forced alone. Exposure belongs to
    // sRGB.
    for (const char* effect : {"diffuse texture",
                               "vertex colors",
                               "alpha mask",
                               "morphing",
                               "skinning",
                               "normal map",
                               "bump map",
                               "double-sided normals",
                               "ambient",
                               "point lights",
                               "spot lights",
                               "mixed falloff",
                               "light ranges",
                               "highlight colors",
                               "light buffer",
                               "environment light",
                               "Phong highlights",
                               "Blinn-Phong highlights",
                               "specular texture",
                               "highlight Fresnel",
                               "emission",
                               "emission texture",
                               "mirror reflection",
                               "glossy reflection",
                               "refraction",
                               "environment rotation",
                               "vertex occlusion",
                               "dielectric reflectance",
                               "energy compensation",
                               "sheen",
                               "clearcoat",
                               "anisotropy",
                               "iridescence",
                               "specular weight texture",
                               "specular color texture",
                               "sheen color texture",
                               "sheen roughness texture",
                               "clearcoat texture",
                               "clearcoat roughness texture",
                               "clearcoat normal map",
                               "anisotropy texture",
                               "iridescence texture",
                               "film thickness texture"}) {
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

class ForcedEffectsInPairs : public ForcedEffects,
                             public testing::WithParamInterface<std::size_t> {};

constexpr std::size_t parts_of_pairs = 12;

TEST_LABELS(slow, sweep);
TEST_P(ForcedEffectsInPairs, ChangeNoBitInScenesThatCoverThem) {
    const std::vector<Features> covering = test::covering_features();
    std::size_t scenes = 0;
    std::size_t added = 0;
    for (std::size_t at = GetParam(); at < covering.size(); at += parts_of_pairs) {
        const Features& features = covering[at];
        SCOPED_TRACE(describe(features));
        const test::CallingScene calling = test::scene_calling_for(features);
        added += expect_no_change(calling.scene, calling.settings);
        ++scenes;
    }
    EXPECT_GT(scenes, 0u);
    EXPECT_GT(added, 8 * scenes) << "effects forced on in each";
}

INSTANTIATE_TEST_SUITE_P(Parts, ForcedEffectsInPairs,
                         testing::Range(std::size_t{0}, parts_of_pairs));

/// Every model and scene file in data/. Models have one light.
std::vector<std::pair<std::string, Scene>> scenes_in_data() {
    std::vector<std::pair<std::string, Scene>> all;
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(test::source_directory() / "data")) {
        const std::string extension = entry.path().extension().string();
        if (extension != ".obj" && extension != ".glb" && extension != ".json") continue;
        if (extension == ".json" && entry.path().parent_path().filename() != "scenes") continue;
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

/// Returns the same scene with every other map of data/, in the sky of data/.
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

TEST_LABELS(slow);
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

TEST_F(ForcedEffects, VertexColorsAreExactlyWhiteBetweenWhiteVertices) {
    // A mask that accepts only full coverage, on a mesh with one transparent corner on the far
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

EffectCost cost(const char* effect, double milliseconds, double flip) {
    return {effect, milliseconds, {0, 0, flip, 0}};
}

TEST(DropOrder, IsByVisibleChangePerSavedTime) {
    const std::vector<EffectCost> costs = {
        cost("dear and plain", 4.0, 0.4),  // 0.1 per millisecond.
        cost("cheap and faint", 1.0, 0.02), cost("invisible", 0.5, 0.0),
        cost("dear and faint", 10.0, 0.1),  cost("free", 0.0, 0.0),
        cost("noise", -0.3, 0.0),
    };
    EXPECT_THAT(drop_order(costs, 0.1),
                ElementsAre("invisible", "dear and faint", "cheap and faint", "dear and plain"));
    EXPECT_THAT(drop_order(costs, 2.0), ElementsAre("dear and faint", "dear and plain"));
    EXPECT_THAT(drop_order({}, 0.0), IsEmpty());
}

TEST(DropOrder, KeepsTheOrderOfTies) {
    const std::vector<EffectCost> costs = {cost("b", 1.0, 0.0), cost("a", 2.0, 0.0)};
    EXPECT_THAT(drop_order(costs, 0.0), ElementsAre("b", "a"));
}

/// Returns the time of a frame of 20 ms without the share of each dropped effect.
double table_time(const std::vector<std::string>& dropped) {
    const std::map<std::string, double> shares = {{"a", 5.0}, {"b", 3.0}, {"c", 2.0}};
    double time = 20.0;
    for (const std::string& effect : dropped)
        time -= shares.at(effect);
    return time;
}

TEST(FitToBudget, DropsTheMinimum) {
    const BudgetChoice choice = fit_to_budget(12.0, {"a", "b", "c"}, table_time);
    EXPECT_THAT(choice.dropped, ElementsAre("a", "b"));
    EXPECT_EQ(choice.milliseconds, 12.0);
    EXPECT_TRUE(choice.fits);
    EXPECT_THAT(fit_to_budget(20.0, {"a", "b"}, table_time).dropped, IsEmpty());
}

TEST(FitToBudget, ReportsAnUnreachableBudget) {
    const BudgetChoice choice = fit_to_budget(9.0, {"a", "b", "c"}, table_time);
    EXPECT_THAT(choice.dropped, ElementsAre("a", "b", "c"));
    EXPECT_EQ(choice.milliseconds, 10.0);
    EXPECT_FALSE(choice.fits);
}

class EffectCostsOf : public test::DrawTest {
  protected:
    EffectCostsOf() {
        Material material;
        material.name = "m";
        material.specular = glm::vec3(0.4F);
        scene_ = test::scene_of(test::sphere(24, 12), material);
        scene_.directional_lights = {{{1, -1, -2}, {0.9F, 0.8F, 0.7F}}};
    }

    [[nodiscard]] MeasuredFrame frame() const {
        return {context(), scene_, settings_, *scene_.camera, {.counted = 3, .warm_up = 1}};
    }

    Scene scene_;
    FrameSettings settings_{48, 48, 1, OutputCoding::srgb};
};

TEST_F(EffectCostsOf, EnabledEffectsIncludeTheChangeOfThePicture) {
    const FramePlan plan = plan_effects(scene_, settings_);
    const EffectCosts costs = measure_effects(frame(), plan);
    ASSERT_EQ(costs.effects.size(), 3U);
    EXPECT_EQ(costs.effects[0].effect, "directional lights");
    EXPECT_EQ(costs.effects[1].effect, "diffuse");
    EXPECT_EQ(costs.effects[2].effect, "Blinn-Phong highlights");
    EXPECT_GT(costs.frame.median, 0.0);
    EXPECT_EQ(costs.frame.count, 9U);
    // Without the light, everything is black, so the brightest code of the picture changes.
    EXPECT_GT(costs.effects[0].change.max, 150.0);
    EXPECT_GT(costs.effects[0].change.flip_mean, costs.effects[2].change.flip_mean);
    EXPECT_GT(costs.effects[2].change.flip_mean, 0.0);
}

TEST_F(EffectCostsOf, StepsLeaveRoomForOtherDrawings) {
    const FramePlan plan = plan_effects(scene_, settings_);
    RenderCache cache(context());
    MeasuredFrame cached = frame();
    cached.cache = &cache;
    EffectCostMeasurement pricing(cached, plan);
    EXPECT_EQ(pricing.count(), 3U);
    EXPECT_THAT(pricing.costs().effects, IsEmpty());
    Report report;
    Scene other = scene_;
    other.directional_lights.clear();
    Renderer beside(context(), other, settings_, report);
    std::size_t steps = 1;
    for (; pricing.step(); ++steps)
        beside.draw(*scene_.camera);
    // The steps are preparation, two frames 3 + 1 times, and comparison.
    EXPECT_EQ(steps, 3U * 6U);
    const EffectCosts at_once = measure_effects(frame(), plan);
    const EffectCosts costs = pricing.costs();
    ASSERT_EQ(costs.effects.size(), at_once.effects.size());
    for (std::size_t i = 0; i < costs.effects.size(); ++i) {
        EXPECT_EQ(costs.effects[i].effect, at_once.effects[i].effect);
        EXPECT_EQ(costs.effects[i].change.mean, at_once.effects[i].change.mean);
    }
    EXPECT_EQ(costs.frame.count, 9U);
    EXPECT_FALSE(pricing.step());
}

TEST_F(EffectCostsOf, NeutralEffectDoesNotChangeThePicture) {
    FramePlan plan = force_effects(scene_, settings_, plan_effects(scene_, settings_),
                                   {EffectBase::planned, {{"emission", true}}});
    const EffectCosts costs = measure_effects(frame(), plan);
    ASSERT_EQ(costs.effects.back().effect, "emission");
    EXPECT_EQ(costs.effects.back().change.max, 0.0);
    EXPECT_EQ(costs.effects.back().change.flip_max, 0.0);
}

TEST_F(EffectCostsOf, PlanWithinItsBudgetIsUnchanged) {
    const FramePlan plan = plan_effects(scene_, settings_);
    const BudgetedPlan kept = plan_within_budget(frame(), plan, 1e6);
    EXPECT_TRUE(kept.choice.fits);
    EXPECT_THAT(kept.choice.dropped, IsEmpty());
    EXPECT_EQ(kept.plan.draws[0].features, plan.draws[0].features);
    EXPECT_EQ(kept.change.max, 0.0);
    const BudgetedPlan impossible = plan_within_budget(frame(), plan, 1e-6);
    EXPECT_FALSE(impossible.choice.fits);
    EXPECT_GT(impossible.milliseconds_before, 0.0);
}

}  // namespace
}  // namespace relief
