// SPDX-License-Identifier: Apache-2.0
// The effects panel of the real window: what effects cost, and the shaders that draw them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/window/viewer_window.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::ViewerWindow;
using test::Workplace;

TEST(EffectsWindow, MeasuresWhatEachEffectCostsUntilThePlanChanges) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    workplace.write_square("square.obj");
    ViewerWindow window(*display, workplace, "square.obj --samples 1");
    const json before = window.wait_for_rest();
    EXPECT_TRUE(before["costs"].is_null());
    window.click_on("Measure what they cost");
    const json measured = window.wait_for("costs", [](const json& now) {
        return !now["costs"].is_null() && now["costs"]["going_on"] == false;
    });
    EXPECT_EQ(measured["costs"]["error"], "");
    EXPECT_EQ(measured["costs"]["size"], measured["view"]);
    EXPECT_EQ(measured["costs"]["effects"].size(), before["effects"].size());
    EXPECT_GT(measured["costs"]["frame"], 0.0);
    EXPECT_EQ(measured["camera"], before["camera"]);
    window.key("1");  // Another view, the same plan.
    const json turned = window.wait_for(
        "the front", [](const json& now) { return now["camera"]["azimuth"] == 0.0; });
    EXPECT_EQ(turned["costs"], measured["costs"]);
    window.key("v");  // No picture any more.
    window.wait_for("no costs", [](const json& now) { return now["costs"].is_null(); });
}

TEST(EffectsWindow, MeasuringCanBeStopped) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    // So that it takes long enough to be stopped.
    ViewerWindow window(*display, workplace,
                        "data/vase.obj --environment data/sky --reflectivity 0.3 --height-map "
                        "data/bricks-height.png",
                        "LP_NUM_THREADS=0 MESA_SHADER_CACHE_DISABLE=true");
    window.wait_for_rest();
    window.click_on("Measure what they cost");
    window.click_on("Stop");
    window.wait_for("no costs", [](const json& now) { return now["costs"].is_null(); });
}

TEST(EffectsWindow, ShowsShadersWithLineNumbers) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    workplace.write_square("square.obj");
    ViewerWindow window(*display, workplace, "square.obj");
    window.wait_for_rest();
    window.click_on("Shaders");
    window.click_on("Program 1");
    const auto has_source = [](const json& now) {
        return now["places"].contains("Vertex shader") &&
               now["places"].contains("Copy without numbers");
    };
    window.wait_for("the source", has_source);
    window.click_on("Vertex shader");
    window.wait_for("the other one", has_source);
}

}  // namespace
}  // namespace relief::tools
