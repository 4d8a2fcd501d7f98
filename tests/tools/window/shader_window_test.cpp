// SPDX-License-Identifier: Apache-2.0
// The shader panel of the real window: the steps of the picture are shown.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/labels.h"
#include "tools/window/viewer_window.h"

namespace relief::tools {
namespace {

FILE_LABELS(window, slow);

using nlohmann::json;
using test::ViewerWindow;
using test::Workplace;

/// Opens the panel.
void open_shaders(ViewerWindow& window) {
    window.wait_for_rest();
    window.click_on("Scene");
    window.click_on("Effects");
    window.click_on("Shaders");
    window.wait_for("the parts", [](const json& now) { return now["places"].contains("Part"); });
}

TEST(ShaderWindow, ShowsTheStepsOfThePicture) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    ViewerWindow window(*display, workplace,
                        "data/scenes/environment-mapping.json --samples 1 --time 0");
    open_shaders(window);
    const json whole = window.wait_for(
        "the steps", [](const json& now) { return now["shaders"]["steps"]["names"].size() == 7; });
    EXPECT_EQ(whole["shaders"]["steps"]["shown"], 6);
    EXPECT_TRUE(test::has_effect(whole, "mirror reflection"));
    for (int i = 0; i < 4; ++i)
        window.click_on("Step back");
    const json highlights = window.wait_for("the highlights", [](const json& now) {
        return now["shaders"]["steps"]["shown"] == 2 && now["drawn"]["revision"] == now["revision"];
    });
    EXPECT_TRUE(test::has_effect(highlights, "Blinn-Phong highlights"));
    EXPECT_FALSE(test::has_effect(highlights, "mirror reflection"));
    window.click_on("Step back");
    window.wait_for("no highlights", [](const json& now) {
        return now["drawn"]["revision"] == now["revision"] &&
               !test::has_effect(now, "Blinn-Phong highlights");
    });
}

TEST(ShaderWindow, ShowsAMistakeAndItsCost) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    ViewerWindow window(*display, workplace, "data/scenes/mistakes.json --samples 1");
    open_shaders(window);
    window.click_on("Mistake");
    window.click_on("mistake back-faces");
    const json wrong = window.wait_for("the cost", [](const json& now) {
        const json& mistake = now["shaders"]["mistake"];
        return mistake["chosen"] == "back-faces" && !mistake["cost"].is_null() &&
               now["drawn"]["revision"] == now["revision"];
    });
    EXPECT_THAT(wrong["shaders"]["mistake"]["cost"].get<std::string>(),
                testing::HasSubstr("largest 180), on 1 of 4 surfaces"));
}

}  // namespace
}  // namespace relief::tools
