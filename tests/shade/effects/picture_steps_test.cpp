// SPDX-License-Identifier: Apache-2.0
// Steps of a picture: which there are, what they add, and that the last one is the picture.
#include "relief/shade/picture_steps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "relief/shade/scene_file.h"
#include "shade/effects/feature_sets.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::shade;

namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::Not;

std::vector<std::string> names_of(const std::vector<PictureStep>& steps) {
    std::vector<std::string> names;
    for (const PictureStep& step : steps)
        names.push_back(step.name);
    return names;
}

FramePlan plan_of(const Scene& scene, const PictureStep& step) {
    return plan_of_step(scene_of_step(scene, step), {}, step);
}

Scene course_scene(const char* name) {
    return load_scene(test::source_directory() / "data/scenes" / name);
}

TEST(PictureSteps, AreThoseThatTheSceneHas) {
    Scene scene = test::lit_scene(test::gray());
    EXPECT_THAT(names_of(picture_steps(scene, {})), ElementsAre("diffuse"));
    scene.ambient = glm::vec3(0.2F);
    scene.materials[0].specular = glm::vec3(0.4F);
    scene.materials[0].emission = glm::vec3(0.1F);
    scene.tone_mapping = ToneMapping::reinhard;
    EXPECT_THAT(names_of(picture_steps(scene, {})),
                ElementsAre("ambient", "diffuse", "highlights", "emission", "tone curve"));
    EXPECT_THAT(names_of(picture_steps(scene, {.output = OutputCoding::linear})),
                ElementsAre("ambient", "diffuse", "highlights", "emission"));
    scene.materials[0].unlit = true;
    scene.tone_mapping = ToneMapping::none;
    EXPECT_THAT(names_of(picture_steps(scene, {})), ElementsAre("picture"));
}

TEST(PictureSteps, AddTheirEffectsAndParts) {
    const Scene scene = course_scene("environment-mapping.json");
    const std::vector<PictureStep> steps = picture_steps(scene, {});
    EXPECT_THAT(names_of(steps), ElementsAre("ambient", "diffuse", "highlights", "maps",
                                             "reflection", "Fresnel", "emission"));
    EXPECT_THAT(steps[2].effects, ElementsAre("Blinn-Phong highlights"));
    EXPECT_THAT(steps[2].parts, Contains("phong.glsl#blinn_phong"));
    EXPECT_THAT(steps[4].parts, Contains("reflection.glsl#mirror"));
    EXPECT_THAT(steps[5].parts, Contains("fresnel.glsl#schlick"));
    EXPECT_THAT(effects_in(plan_of(scene, steps[1])), Not(Contains("Blinn-Phong highlights")));
    EXPECT_THAT(effects_in(plan_of(scene, steps[2])), Contains("Blinn-Phong highlights"));
    EXPECT_THAT(effects_in(plan_of(scene, steps[4])), Not(Contains("Schlick's Fresnel")));
}

TEST(PictureSteps, NameTheEffectsOfReliefs) {
    Scene scene = course_scene("relief-mapping.json");
    scene.shadow.emplace();
    for (Material& material : scene.materials) {
        if (material.height_map) material.height_map->write_depth = true;
    }
    const std::vector<PictureStep> steps = picture_steps(scene, {});
    const auto maps = std::find_if(steps.begin(), steps.end(),
                                   [](const PictureStep& step) { return step.name == "maps"; });
    ASSERT_NE(maps, steps.end());
    EXPECT_THAT(maps->effects, Contains("written depth"));
    EXPECT_THAT(maps->effects, Contains("displaced shadow"));
}

TEST(PictureSteps, EndWithThePicture) {
    for (const char* name :
         {"environment-mapping.json", "lighting-and-environment.json", "illumination.json",
          "shading-bump.json", "shading-reflection.json", "shading-lights.json"}) {
        Scene scene = course_scene(name);
        scene.exposure = 2.0F;
        const std::vector<PictureStep> steps = picture_steps(scene, {});
        const FramePlan last = plan_of(scene, steps.back());
        const FramePlan whole = plan_effects(scene, {});
        ASSERT_EQ(last.draws.size(), whole.draws.size()) << name;
        for (std::size_t i = 0; i < last.draws.size(); ++i)
            EXPECT_EQ(last.draws[i].features, whole.draws[i].features) << name;
        EXPECT_EQ(scene_of_step(scene, steps.back()).exposure, 2.0F);
        EXPECT_EQ(scene_of_step(scene, steps.front()).exposure, 1.0F);
    }
}

}  // namespace
}  // namespace relief
