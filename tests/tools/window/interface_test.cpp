// SPDX-License-Identifier: Apache-2.0
// The real window's interface: how large it is, and what of it is remembered.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tools/window/viewer_window.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using relief::Image;
using test::eventually;
using test::ViewerWindow;
using test::Workplace;
using testing::HasSubstr;

TEST(Interface, TwiceTheScaleIsTwiceAsLargeAndHearsClicks) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    workplace.write_square("square.obj");
    const auto panel_width = [](const json& now) { return 1280 - now["view"][0].get<int>(); };
    int usual_width = 0;
    json usual_place;
    {
        ViewerWindow usual(*display, workplace, "square.obj");
        const json state = usual.wait_for_rest();
        EXPECT_EQ(state["layout"]["scale"], 1.0);
        usual_width = panel_width(state);
        usual_place = state["places"]["Scene"];
    }
    ViewerWindow window(*display, workplace, "square.obj --ui-scale 2");
    const json state = window.wait_for_rest();
    EXPECT_EQ(state["layout"]["scale"], 2.0);
    EXPECT_EQ(panel_width(state), 2 * usual_width);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_NEAR(state["places"]["Scene"][i].get<double>(), 2.0 * usual_place[i].get<double>(),
                    2.0);
    }
    window.click_on("Lights");
    window.wait_for("the panel", [](const json& now) {
        return now["layout"]["open"].value("Lights", false) &&
               now["places"].contains("Add directional");
    });
    window.key("ctrl+minus");
    window.wait_for("a smaller one",
                    [](const json& now) { return now["layout"]["scale"] == 1.75; });
    window.key("ctrl+0");
    window.wait_for("the screen's", [&](const json& now) {
        return now["layout"]["scale"] == 1.0 && panel_width(now) == usual_width;
    });
}

TEST(Interface, IsRememberedFromOneTimeToTheNext) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    workplace.write_square("square.obj");
    const std::string home = "XDG_STATE_HOME=" + (workplace / "state").string();
    const auto close = [](ViewerWindow& window) {
        window.key("ctrl+q");
        EXPECT_EQ(window.process().wait_for_end(100.0), 0);
        EXPECT_EQ(window.said(), "");
    };
    {
        ViewerWindow window(*display, workplace, "square.obj", home);
        window.wait_for_rest();
        window.click_on("Lights");
        window.click_on("Scene");
        window.key("ctrl+equal");
        window.wait_for("larger letters",
                        [](const json& now) { return now["layout"]["scale"] == 1.25; });
        display->act(
            "search --onlyvisible --name relief-view windowsize 1000 700 windowmove 40 20");
        window.wait_for("another size", [](const json& now) { return now["view"][1] < 690; });
        close(window);
    }
    {
        ViewerWindow window(*display, workplace, "square.obj", home);
        const json state = window.wait_for("the same again", [](const json& now) {
            return now["layout"]["scale"] == 1.25 && now["revision"] > 0;
        });
        EXPECT_EQ(state["layout"]["open"], json({{"Lights", true}, {"Scene", false}}));
        EXPECT_TRUE(state["places"].contains("Add directional"));
        const json written = json::parse(workplace.read("state/relief/relief-view.json"));
        EXPECT_EQ(written["window"]["size"], json({1000, 700}));
        EXPECT_EQ(written["window"]["position"], json({40, 20}));
        EXPECT_LT(state["view"][1], 690);
        close(window);
    }
    workplace.write("state/relief/relief-view.json", R"({"version": 9})");
    ViewerWindow window(*display, workplace, "square.obj", home);
    const json state = window.wait_for_rest();
    EXPECT_EQ(state["layout"]["scale"], 1.0);
    EXPECT_THAT(state["layout"]["note"].get<std::string>(), HasSubstr("of version 9"));
    window.key("Tab");
    window.wait_for("no panels", [](const json& now) { return now["view"][0] == 1280; });
    close(window);
    EXPECT_EQ(workplace.read("state/relief/relief-view.json"), R"({"version": 9})");
}

TEST(Interface, NoStateTouchesNoFile) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    workplace.write_square("square.obj");
    ViewerWindow window(*display, workplace, "square.obj --no-state",
                        "XDG_STATE_HOME=" + (workplace / "state").string());
    window.wait_for_rest();
    window.click_on("Lights");
    window.wait_for("an open panel",
                    [](const json& now) { return now["layout"]["open"].contains("Lights"); });
    window.key("ctrl+q");
    EXPECT_EQ(window.process().wait_for_end(100.0), 0);
    EXPECT_FALSE(std::filesystem::exists(workplace / "state"));
}

}  // namespace
}  // namespace relief::tools
