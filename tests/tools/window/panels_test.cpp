// SPDX-License-Identifier: Apache-2.0
// The panels of the real window, clicked on: each change is judged by what the program says of its
// scene and by the picture.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "relief/mesh/image_file.h"
#include "tools/window/viewer_window.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using relief::Image;
using test::changed_share;
using test::Display;
using test::eventually;
using test::ViewerWindow;
using test::Workplace;
using testing::HasSubstr;

/// A window with one panel open, so that all of it is in sight.
class Panel : public testing::Test {
  protected:
    /// \return false: there is no display, and the test is to be skipped
    bool open(const std::string& words, const std::string& panel) {
        display_ = Display::open();
        if (!display_) return false;
        window_ = std::make_unique<ViewerWindow>(*display_, workplace_, words);
        window_->wait_for_rest();
        set_open("Effects", false);
        set_open("Scene", false);
        set_open(panel, true);
        state_ = window_->wait_for_rest();
        return true;
    }

    /// By its header; what is below it moves, so that its place is awaited.
    void set_open(const std::string& panel, bool is_open) {
        window_->click_on(panel);
        window_->wait_for(panel, [&](const json& now) {
            return now["layout"]["open"].value(panel, !is_open) == is_open;
        });
    }

    /// Clicks, and waits for what comes of it in words and on the screen.
    json click(const std::string& name, const ViewerWindow::Condition& holds) {
        const Image before = display_->picture();
        window_->click_on(name);
        json now = window_->wait_for(name, holds);
        EXPECT_TRUE(eventually([&] {
            return changed_share(before, display_->picture(), 310, 10, 960, 760, 2) > 0.005;
        })) << "the picture is the same after "
            << name;
        return now;
    }

    /// Into a field, of which a click selects all.
    void enter(const std::string& field, const std::string& text) {
        window_->click_on(field);
        window_->wait_for("a field", [](const json& now) { return now["typing"] == true; });
        display_->act("type --delay 50 " + text);
        // Down and up within one frame of a busy machine would not be seen.
        display_->act("keydown Return sleep 0.4 keyup Return");
    }

    Display& display() { return *display_; }
    ViewerWindow& window() { return *window_; }
    Workplace& workplace() { return workplace_; }
    const json& state() { return state_; }

  private:
    Workplace workplace_;
    std::unique_ptr<Display> display_;
    std::unique_ptr<ViewerWindow> window_;
    json state_;
};

#define RELIEF_NEEDS_PANEL(words, panel) \
    if (!open(words, panel)) GTEST_SKIP() << "needs Xvfb and xdotool"

TEST_F(Panel, ALightComesBecomesAnotherKindGoesRoundAndGoes) {
    RELIEF_NEEDS_PANEL("data/vase.obj --light directional:40,30", "Lights");
    ASSERT_EQ(state()["lights"], json::parse(R"([{"kind":"directional","speed":0.0}])"));
    click("Add spot", [](const json& now) { return now["lights"].size() == 2; });
    window().click_on("Light 1");
    window().click_on("Kind");
    window().click_on("Kind: Point");
    window().wait_for("a point light",
                      [](const json& now) { return now["lights"][0]["kind"] == "point"; });
    const std::uint64_t revision = window().state()["revision"];
    const auto moves = [&] { return window().state()["revision"] > revision + 12; };
    EXPECT_TRUE(eventually([&] {
        const json slider = window().state()["places"]["Goes round"];
        display().act("mousemove " + std::to_string(slider[0].get<int>() + 10) + " " +
                      std::to_string(slider[1].get<int>()) +
                      " sleep 0.3 mousedown 1 sleep 0.5 mouseup 1");
        return eventually(moves, 5.0);
    })) << "it moves by itself";
    EXPECT_GT(window().state()["lights"][0]["speed"], 10.0);
    click("Remove", [](const json& now) {
        return now["lights"].size() == 1 && now["drawn"]["whole"] == true;
    });
    EXPECT_EQ(window().state()["lights"][0]["kind"], "spot");
}

TEST_F(Panel, AMaterialTakesAMapAndShowsIt) {
    RELIEF_NEEDS_PANEL("data/vase.obj", "Materials");
    window().click_on("material 'bricks'");
    const auto has = [](const char* effect) {
        return [effect](const json& now) {
            const json& effects = now["effects"];
            return std::find(effects.begin(), effects.end(), effect) != effects.end();
        };
    };
    enter("Bump map", "data/bricks-height.png");
    window().wait_for("the map", has("bump map"));
    EXPECT_EQ(window().state()["error"], "");
    click("clear Bump map", [&](const json& now) { return !has("bump map")(now); });
    click("clear Diffuse map", [&](const json& now) { return !has("diffuse texture")(now); });
}

TEST_F(Panel, AllMaterialsChangeTheirModelAtOnce) {
    RELIEF_NEEDS_PANEL("data/vase.obj", "Materials");
    const auto has = [](const json& now, const char* effect) {
        const json& effects = now["effects"];
        return std::find(effects.begin(), effects.end(), effect) != effects.end();
    };
    window().click_on("Shading of all");
    click("Shading of all: Flat", [&](const json& now) { return has(now, "flat"); });
    window().click_on("Model of all");
    click("Model of all: Unlit", [&](const json& now) { return !has(now, "diffuse"); });
}

TEST_F(Panel, WhatIsHiddenIsNotDrawn) {
    RELIEF_NEEDS_PANEL("data/scenes/shading-bump.json", "Scene");
    EXPECT_EQ(state()["shown"], json({3, 3}));
    window().click_on("tree");
    click("show normal map", [](const json& now) { return now["shown"] == json({2, 3}); });
    const json effects = window().state()["effects"];
    EXPECT_EQ(std::count(effects.begin(), effects.end(), "normal map"), 0)
        << "and what it alone needed is not there";
    click("show normal map", [](const json& now) { return now["shown"] == json({3, 3}); });
    EXPECT_EQ(window().state()["effects"], state()["effects"]);
}

TEST_F(Panel, SurroundingsComeFromAFolderAndGo) {
    RELIEF_NEEDS_PANEL("data/vase.obj", "Environment");
    enter("Image or folder", "data/nothing.hdr");
    window().wait_for("an error", [](const json& now) {
        return now["error"].get<std::string>().find("nothing.hdr") != std::string::npos;
    });
    enter("Image or folder", "data/sky");
    const auto has_skybox = [](const json& now) {
        const json& effects = now["effects"];
        return std::find(effects.begin(), effects.end(), "skybox") != effects.end();
    };
    const json with = window().wait_for("the sky", has_skybox);
    EXPECT_EQ(with["error"], "");
    click("Shown behind", [&](const json& now) { return !has_skybox(now); });
    click("Shown behind", has_skybox);
    click("clear Image or folder", [&](const json& now) { return !has_skybox(now); });
}

TEST_F(Panel, TheToneCurveIsChosenFromAList) {
    RELIEF_NEEDS_PANEL("data/vase.obj --exposure 1", "Picture");
    window().click_on("Tone curve");
    const std::uint64_t revision = window().state()["revision"];
    click("Tone curve: ACES", [&](const json& now) { return now["revision"] > revision; });
}

}  // namespace
}  // namespace relief::tools
