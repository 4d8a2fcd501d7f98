// SPDX-License-Identifier: Apache-2.0
// What a plan feeds to the GPU, by hand, and for every pair of effects against the program's own
// interface.
#include "relief/shade/planned_inputs.h"

#include <gtest/gtest.h>

#include "../effects/all_features.h"
#include "../effects/scene_calling_for.h"

namespace relief {
namespace {

test::CallingScene normal_mapped() {
    Features f;
    f.directional_lights = 1;
    f.diffuse = true;
    f.detail = NormalDetail::normal_map;
    return test::scene_calling_for(f);
}

TEST(PlannedInputs, NameStreamsAndImagesWithTheirReasons) {
    const test::CallingScene calling = normal_mapped();
    const FramePlan plan = plan_effects(calling.scene, calling.settings);
    const DrawInputs inputs = planned_inputs(calling.scene, plan.draws[0]);
    ASSERT_EQ(inputs.attributes.size(), 4U);
    EXPECT_EQ(inputs.attributes[1].name, "normal_object");
    EXPECT_TRUE(inputs.attributes[1].stored);
    EXPECT_EQ(inputs.attributes[2].name, "tangent_object");
    EXPECT_FALSE(inputs.attributes[2].stored) << "computed";
    EXPECT_EQ(inputs.attributes[2].reason, "a map lies in the mesh's tangent frame");
    ASSERT_EQ(inputs.textures.size(), 1U);
    EXPECT_EQ(inputs.textures[0].sampler, "normal_texture");
    EXPECT_EQ(inputs.textures[0].image, "normal");
    EXPECT_TRUE(inputs.textures[0].mip_chain);
    EXPECT_EQ(inputs.textures[0].reason, "material 'm' has it");
}

TEST(PlannedInputs, AreThoseOfTheProgramForEveryPairOfEffects) {
    for (const Features& features : test::covering_features()) {
        const test::CallingScene calling = test::scene_calling_for(features);
        const FramePlan plan = plan_effects(calling.scene, calling.settings);
        const DrawPlan& draw = plan.draws[0];
        const PlannedInterface planned = planned_interface(draw.features);
        const DrawInputs inputs = planned_inputs(calling.scene, draw);
        EXPECT_EQ(inputs.attributes.size(), planned.attributes.size());
        EXPECT_EQ(inputs.textures.size(), planned.samplers.size());
        for (const PlannedTexture& texture : inputs.textures)
            EXPECT_NE(texture.reason, "") << texture.sampler;
    }
}

TEST(PlannedPasses, AreInTheOrderInWhichTheyAreDrawn) {
    test::CallingScene calling = normal_mapped();
    calling.scene.environment = Environment{};
    FrameSettings settings = calling.settings;
    settings.samples = 4;
    const std::vector<PlannedPass> passes = planned_passes(plan_effects(calling.scene, settings));
    ASSERT_EQ(passes.size(), 3U);
    EXPECT_EQ(passes[0].name, "surfaces");
    EXPECT_EQ(passes[1].name, "skybox");
    EXPECT_EQ(passes[2].name, "finishing");
    EXPECT_EQ(passes[2].reason, "4 samples a pixel are averaged in linear light");
    EXPECT_EQ(planned_passes(plan_effects(normal_mapped().scene, calling.settings)).size(), 1U);
}

}  // namespace
}  // namespace relief
