// SPDX-License-Identifier: Apache-2.0
// The shader panel of the real window: a part is edited by keys, an exercise is solved, and the
// steps of the picture are shown.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/labels.h"
#include "tools/window/viewer_window.h"

namespace relief::tools {
namespace {

FILE_LABELS(window, slow);

using nlohmann::json;
using relief::Image;
using test::changed_picture;
using test::Display;
using test::eventually;
using test::ViewerWindow;
using test::Workplace;

/// Opens the panel.
void open_shaders(ViewerWindow& window) {
    window.wait_for_rest();
    window.click_on("Scene");
    window.click_on("Effects");
    window.click_on("Shaders");
    window.wait_for("the editor", [](const json& now) { return now["places"].contains("code"); });
}

TEST(ShaderWindow, EditsAnExerciseAndSavesIt) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    ViewerWindow window(*display, workplace,
                        "--exercise data/exercises/phong-by-reflection.json --samples 1",
                        "RELIEF_SHADER_DIR=mine");
    open_shaders(window);
    const json start = window.wait_for("a result", [](const json& now) {
        return now["shaders"]["exercise"].is_object() &&
               now["shaders"]["part"] == "phong.glsl#phong";
    });
    EXPECT_EQ(start["shaders"]["exercise"]["solved"], false);
    EXPECT_EQ(start["shaders"]["edited"], json({"phong.glsl#phong"}));
    const Image hole = display->resting_picture();

    // A letter at the beginning of the part breaks its first line.
    window.click_on("code");
    window.key("ctrl+Home");
    window.key("x");
    const json broken = window.wait_for("an error", [](const json& now) {
        return now["error"] != "" && now["shaders"]["pending"] == false;
    });
    EXPECT_GE(broken["shaders"]["messages"].size(), 0U);
    EXPECT_TRUE(broken["shaders"]["exercise"].is_null());
    window.key("BackSpace");
    window.wait_for("no error", [](const json& now) { return now["error"] == ""; });

    window.click_on("Reset part");
    const json solved = window.wait_for("the solution", [](const json& now) {
        return now["shaders"]["exercise"].is_object() &&
               now["shaders"]["exercise"]["solved"] == true;
    });
    EXPECT_EQ(solved["shaders"]["edited"], json::array());
    EXPECT_TRUE(eventually([&] { return changed_picture(hole, display->picture()) > 0.001; }));
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

}  // namespace
}  // namespace relief::tools
