// SPDX-License-Identifier: Apache-2.0
// Effect times are measured without a window. The tests check only properties that do not depend on
// timing noise.
#include "window/effects_panel.h"

#include <gtest/gtest.h>

#include "support/gl_environment.h"
#include "support/shapes.h"
#include "window/background_jobs.h"
#include "window/shader_panel.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

TEST(ShaderPanel, NumbersLinesInAColumn) {
    EXPECT_EQ(numbered_lines("#version 330 core\n\nvoid main() {}\n"),
              "1  #version 330 core\n2  \n3  void main() {}\n");
    std::string ten;
    for (int i = 0; i < 10; ++i)
        ten += "x\n";
    EXPECT_EQ(numbered_lines(ten).substr(0, 10), " 1  x\n 2  ");
    EXPECT_EQ(numbered_lines(ten).substr(54), "10  x\n");
    EXPECT_EQ(numbered_lines("no end"), "1  no end\n");
    EXPECT_EQ(numbered_lines(""), "");
}

TEST(EffectsPanel, ForcesOneEffectAndKeepsTheOthers) {
    EffectRequest requests = with_forced_choice({}, "shadow", 1);
    requests = with_forced_choice(requests, "sheen", 2);
    EXPECT_EQ(forced_choice(requests, "shadow"), 1);
    EXPECT_EQ(forced_choice(requests, "sheen"), 2);
    EXPECT_EQ(forced_choice(requests, "clearcoat"), 0);
    requests = with_forced_choice(requests, "shadow", 2);
    EXPECT_EQ(forced_choice(requests, "shadow"), 2);
    EXPECT_EQ(forced_choice(requests, "sheen"), 2);
    requests = with_forced_choice(requests, "shadow", 0);
    ASSERT_EQ(requests.forced.size(), 1U) << "an automatic effect has no entry";
    EXPECT_EQ(requests.forced[0].name, "sheen");
    EXPECT_FALSE(requests.forced[0].on);
}

class EffectTimesTest : public testing::Test {
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
        request_.scene = std::make_shared<const Scene>(std::move(scene));
        request_.settings = {48, 32, 1};
        request_.camera.world_from_view[3] = {0, 0, 3, 1};
    }

    /// Runs the task to its end.
    void run(const DrawTask& task) {
        RenderCache cache(*context_);
        while (task(*context_, cache)) {
        }
    }
    [[nodiscard]] FramePlan plan() const {
        return plan_effects(*request_.scene, request_.settings);
    }

    std::unique_ptr<Context> context_;
    DrawRequest request_;
    EffectTimes effect_times_;
};

TEST_F(EffectTimesTest, CoverAllEffectsOfTheFrame) {
    EXPECT_EQ(json_of(effect_times_.state()), nullptr);
    const DrawTask task = effect_times_.start(request_);
    EXPECT_TRUE(effect_times_.state().is_running);
    EXPECT_EQ(effect_times_.text("diffuse"), "");
    run(task);
    const EffectTimes::State state = effect_times_.state();
    EXPECT_FALSE(state.is_running);
    EXPECT_EQ(state.error, "");
    EXPECT_EQ(state.count, 3U);
    EXPECT_GT(state.costs.frame.median, 0.0);
    EXPECT_NE(effect_times_.text("diffuse"), "");
    EXPECT_EQ(effect_times_.text("emission"), "");
    const nlohmann::ordered_json described = json_of(state);
    EXPECT_EQ(described["done"], 3);
    EXPECT_EQ(described["size"], nlohmann::ordered_json({48, 32}));
    EXPECT_TRUE(described["effects"].contains("directional lights"));
}

TEST_F(EffectTimesTest, AreValidForOnePlanAndSize) {
    run(effect_times_.start(request_));
    effect_times_.discard_unless_valid_for(plan(), request_);
    EXPECT_NE(effect_times_.text("diffuse"), "");
    FramePlan other = plan();
    other.draws[0].features.diffuse = false;
    effect_times_.discard_unless_valid_for(other, request_);
    EXPECT_EQ(effect_times_.text("diffuse"), "");

    run(effect_times_.start(request_));
    DrawRequest larger = request_;
    larger.settings.width = 49;
    effect_times_.discard_unless_valid_for(plan(), larger);
    EXPECT_EQ(effect_times_.state().width, 0);
}

TEST_F(EffectTimesTest, CancelledMeasurementEndsAtTheNextStep) {
    const DrawTask task = effect_times_.start(request_);
    effect_times_.cancel();
    RenderCache cache(*context_);
    EXPECT_FALSE(task(*context_, cache));
    EXPECT_EQ(cache.contents().programs, 0U) << "nothing was drawn";
    EXPECT_EQ(effect_times_.state().count, 0U);
}

TEST_F(EffectTimesTest, AnErrorEndsIt) {
    request_.effects.forced.push_back({"no such effect", true});
    run(effect_times_.start(request_));
    EXPECT_FALSE(effect_times_.state().is_running);
    EXPECT_NE(effect_times_.state().error.find("no such effect"), std::string::npos);
}

}  // namespace
}  // namespace relief::tools
