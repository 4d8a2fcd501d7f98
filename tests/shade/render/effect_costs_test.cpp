// SPDX-License-Identifier: Apache-2.0
// What to drop, decided from numbers given by hand; and real measurements, of which only what no
// noise can change is asserted.
#include "relief/shade/effect_costs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "draw_test.h"
#include "relief/shade/effect_forcing.h"
#include "support/shapes.h"

namespace relief {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

EffectCost cost(const char* effect, double milliseconds, double flip) {
    return {effect, milliseconds, {0, 0, flip, 0}};
}

TEST(DropOrder, IsByWhatAnEyeSeesForTheTimeSaved) {
    const std::vector<EffectCost> costs = {
        cost("dear and plain", 4.0, 0.4),  // 0.1 for a millisecond
        cost("cheap and faint", 1.0, 0.02), cost("invisible", 0.5, 0.0),
        cost("dear and faint", 10.0, 0.1),  cost("free", 0.0, 0.0),
        cost("noise", -0.3, 0.0),
    };
    EXPECT_THAT(drop_order(costs, 0.1),
                ElementsAre("invisible", "dear and faint", "cheap and faint", "dear and plain"));
    EXPECT_THAT(drop_order(costs, 2.0), ElementsAre("dear and faint", "dear and plain"));
    EXPECT_THAT(drop_order({}, 0.0), IsEmpty());
}

TEST(DropOrder, KeepsTheGivenOrderWhereNothingTellsEffectsApart) {
    const std::vector<EffectCost> costs = {cost("b", 1.0, 0.0), cost("a", 2.0, 0.0)};
    EXPECT_THAT(drop_order(costs, 0.0), ElementsAre("b", "a"));
}

/// A frame of 20 ms of which each effect takes its share.
double table_time(const std::vector<std::string>& dropped) {
    const std::map<std::string, double> shares = {{"a", 5.0}, {"b", 3.0}, {"c", 2.0}};
    double time = 20.0;
    for (const std::string& effect : dropped)
        time -= shares.at(effect);
    return time;
}

TEST(FitToBudget, DropsNoMoreThanItTakes) {
    const BudgetChoice choice = fit_to_budget(12.0, {"a", "b", "c"}, table_time);
    EXPECT_THAT(choice.dropped, ElementsAre("a", "b"));
    EXPECT_EQ(choice.milliseconds, 12.0);
    EXPECT_TRUE(choice.fits);
    EXPECT_THAT(fit_to_budget(20.0, {"a", "b"}, table_time).dropped, IsEmpty());
}

TEST(FitToBudget, SaysWhereNothingMoreCanBeDropped) {
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

TEST_F(EffectCostsOf, EachEffectThatIsOnAreMeasuredWithWhatThePictureLoses) {
    const FramePlan plan = plan_effects(scene_, settings_);
    const EffectCosts costs = measure_effects(frame(), plan);
    ASSERT_EQ(costs.effects.size(), 3U);
    EXPECT_EQ(costs.effects[0].effect, "directional lights");
    EXPECT_EQ(costs.effects[1].effect, "diffuse");
    EXPECT_EQ(costs.effects[2].effect, "Blinn-Phong highlights");
    EXPECT_GT(costs.frame.median, 0.0);
    EXPECT_EQ(costs.frame.count, 9U);
    // Without the lamp all is black: the picture's brightest code is lost.
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
    // To prepare, two frames 3 + 1 times, and to compare.
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

TEST_F(EffectCostsOf, AForcedEffectThatIsNeutralIsNoChangeOfThePicture) {
    FramePlan plan = force_effects(scene_, settings_, plan_effects(scene_, settings_),
                                   {EffectBase::planned, {{"emission", true}}});
    const EffectCosts costs = measure_effects(frame(), plan);
    ASSERT_EQ(costs.effects.back().effect, "emission");
    EXPECT_EQ(costs.effects.back().change.max, 0.0);
    EXPECT_EQ(costs.effects.back().change.flip_max, 0.0);
}

TEST_F(EffectCostsOf, APlanWithinItsBudgetStaysWhole) {
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
