// SPDX-License-Identifier: Apache-2.0
// Prices measured in a context of their own, without a window. What is asserted is what no noise
// can change.
#include "window/effect_prices.h"

#include <gtest/gtest.h>

#include "support/gl_environment.h"
#include "support/shapes.h"

namespace relief::tools {
namespace {

class Prices : public testing::Test {
  protected:
    void SetUp() override {
        if (!test::is_installed(Backend::osmesa)) GTEST_SKIP() << "needs OSMesa";
        context_ = std::make_unique<Context>(Backend::osmesa);
        Scene scene;
        Mesh sphere = test::sphere(24, 12);
        sphere.material_ranges = {{0, static_cast<std::uint32_t>(sphere.triangles.size()), 0}};
        scene.meshes.emplace_back(std::move(sphere));
        scene.instances.push_back({});
        scene.materials.emplace_back();
        scene.materials[0].specular = glm::vec3(0.4F);
        scene.directional_lights = {{{1, -1, -2}, {0.9F, 0.8F, 0.7F}}};
        wish_.scene = std::make_shared<const Scene>(std::move(scene));
        wish_.settings = {48, 32, 1};
        wish_.camera.world_from_view[3] = {0, 0, 3, 1};
    }

    /// Does the work until it ends.
    void run(const DrawTask& task) {
        RenderCache cache(*context_);
        while (task(*context_, cache)) {
        }
    }
    [[nodiscard]] FramePlan plan() const { return plan_effects(*wish_.scene, wish_.settings); }

    std::unique_ptr<Context> context_;
    DrawWish wish_;
    EffectPrices prices_;
};

TEST_F(Prices, AreThoseOfAllEffectsOfTheFrame) {
    EXPECT_EQ(json_of(prices_.state()), nullptr);
    const DrawTask task = prices_.start(wish_);
    EXPECT_TRUE(prices_.state().is_going_on);
    EXPECT_FALSE(prices_.price("diffuse"));
    run(task);
    const EffectPrices::State state = prices_.state();
    EXPECT_FALSE(state.is_going_on);
    EXPECT_EQ(state.error, "");
    EXPECT_EQ(state.count, 3U);
    EXPECT_GT(state.costs.frame.median, 0.0);
    EXPECT_TRUE(prices_.price("diffuse"));
    EXPECT_FALSE(prices_.price("emission"));
    const nlohmann::ordered_json said = json_of(state);
    EXPECT_EQ(said["done"], 3);
    EXPECT_EQ(said["size"], nlohmann::json({48, 32}));
    EXPECT_TRUE(said["effects"].contains("directional lights"));
}

TEST_F(Prices, HoldForTheirPlanAndSize) {
    run(prices_.start(wish_));
    prices_.keep_for(plan(), wish_);
    EXPECT_TRUE(prices_.price("diffuse"));
    FramePlan other = plan();
    other.draws[0].features.diffuse = false;
    prices_.keep_for(other, wish_);
    EXPECT_FALSE(prices_.price("diffuse"));

    run(prices_.start(wish_));
    DrawWish larger = wish_;
    larger.settings.width = 49;
    prices_.keep_for(plan(), larger);
    EXPECT_EQ(prices_.state().width, 0);
}

TEST_F(Prices, WhatIsCancelledEndsAtTheNextStep) {
    const DrawTask task = prices_.start(wish_);
    prices_.cancel();
    RenderCache cache(*context_);
    EXPECT_FALSE(task(*context_, cache));
    EXPECT_EQ(cache.contents().programs, 0U) << "nothing was drawn";
    EXPECT_EQ(prices_.state().count, 0U);
}

TEST_F(Prices, AnErrorEndsIt) {
    wish_.effects.forced.push_back({"no such effect", true});
    run(prices_.start(wish_));
    EXPECT_FALSE(prices_.state().is_going_on);
    EXPECT_NE(prices_.state().error.find("no such effect"), std::string::npos);
}

}  // namespace
}  // namespace relief::tools
