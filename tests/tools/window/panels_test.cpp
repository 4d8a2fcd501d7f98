// SPDX-License-Identifier: Apache-2.0
// The panels of the real window, clicked on: each change is judged by the state that the program
// reports and by the picture.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/window/viewer_window.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using relief::Image;
using test::changed_share;
using test::Display;
using test::eventually;
using test::has_effect;
using test::ViewerWindow;
using test::Workplace;

/// A window of which one panel at a time is open, so that all of it is in sight.
class Panel : public testing::Test {
  protected:
    /// \return false if there is no display and the test is to be skipped
    bool open(const std::string& words) {
        if (display_ == nullptr) return false;
        window_ = std::make_unique<ViewerWindow>(*display_, workplace_, words);
        window_->wait_for_rest();
        set_open("Effects", false);
        set_open("Scene", false);
        return true;
    }

    /// \return the state once it is open
    json open_panel(const std::string& panel) {
        set_open(panel, true);
        return window_->wait_for_rest();
    }
    void close_panel(const std::string& panel) { set_open(panel, false); }

    /// Clicks, and waits for the state and for another picture.
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
        const auto is_typing = [](const json& now) { return now["typing"] == true; };
        window_->click_on(field);
        window_->wait_for("a field", is_typing);
        display_->act("type --delay 50 " + text);
        // Down and up within one frame of a busy machine would not be seen.
        display_->act("keydown Return");
        window_->wait_for("the end of typing", [&](const json& now) { return !is_typing(now); });
        display_->act("keyup Return");
    }

    void change_lights();
    void change_environment();

    const Display& display() { return *display_; }
    ViewerWindow& window() { return *window_; }

  private:
    /// By its header; what is below it moves, so that its place is awaited.
    void set_open(const std::string& panel, bool is_open) {
        window_->click_on(panel);
        window_->wait_for(panel, [&](const json& now) {
            return now["layout"]["open"].value(panel, !is_open) == is_open;
        });
    }

    Workplace workplace_;
    const Display* display_ = Display::of_process();
    std::unique_ptr<ViewerWindow> window_;
};

#define RELIEF_NEEDS_PANELS(words) \
    if (!open(words)) GTEST_SKIP() << "needs Xvfb and xdotool"

/// A light is added, becomes another kind, moves by itself and is removed.
void Panel::change_lights() {
    const json before = open_panel("Lights");
    EXPECT_EQ(before["lights"], json::parse(R"([{"kind":"directional","speed":0.0}])"));
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
        window().point_at(slider[0].get<int>() + 10, slider[1].get<int>());
        display().act("mousedown 1 sleep 0.5 mouseup 1");
        return eventually(moves, 5.0);
    })) << "it moves by itself";
    EXPECT_GT(window().state()["lights"][0]["speed"], 10.0);
    click("Remove", [](const json& now) {
        return now["lights"].size() == 1 && now["drawn"]["whole"] == true;
    });
    EXPECT_EQ(window().state()["lights"][0]["kind"], "spot");
    close_panel("Lights");
}

void Panel::change_environment() {
    open_panel("Environment");
    enter("Image or folder", "data/nothing.hdr");
    window().wait_for("an error", [](const json& now) {
        return now["error"].get<std::string>().find("nothing.hdr") != std::string::npos;
    });
    enter("Image or folder", "data/sky");
    const auto has_skybox = [](const json& now) { return has_effect(now, "skybox"); };
    const auto has_none = [](const json& now) { return !has_effect(now, "skybox"); };
    const json with = window().wait_for("the sky", has_skybox);
    EXPECT_EQ(with["error"], "");
    click("Shown behind", has_none);
    click("Shown behind", has_skybox);
    click("clear Image or folder", has_none);
    close_panel("Environment");
}

TEST_F(Panel, LightsEnvironmentAndToneCurveChangeThePicture) {
    RELIEF_NEEDS_PANELS("data/vase.obj --light directional:40,30 --exposure 1");
    change_lights();
    change_environment();
    open_panel("Picture");
    window().click_on("Tone curve");
    const std::uint64_t revision = window().state()["revision"];
    click("Tone curve: ACES", [&](const json& now) { return now["revision"] > revision; });
}

TEST_F(Panel, MaterialsTakeMapsAndChangeTheirModel) {
    RELIEF_NEEDS_PANELS("data/vase.obj");
    open_panel("Materials");
    window().click_on("material 'bricks'");
    const auto has = [](const char* effect) {
        return [effect](const json& now) { return has_effect(now, effect); };
    };
    const auto lacks = [](const char* effect) {
        return [effect](const json& now) { return !has_effect(now, effect); };
    };
    enter("Bump map", "data/bricks-height.png");
    window().wait_for("the map", has("bump map"));
    EXPECT_EQ(window().state()["error"], "");
    click("clear Bump map", lacks("bump map"));
    click("clear Diffuse map", lacks("diffuse texture"));

    window().click_on("Shading of all");
    click("Shading of all: Flat", has("flat"));
    window().click_on("Model of all");
    click("Model of all: Unlit", lacks("diffuse"));
}

}  // namespace
}  // namespace relief::tools
