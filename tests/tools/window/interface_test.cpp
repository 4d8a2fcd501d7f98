// SPDX-License-Identifier: Apache-2.0
// The real window's interface: how large it is, and what of it is remembered.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tools/window/viewer_window.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::Display;
using test::ViewerWindow;
using test::Workplace;
using testing::HasSubstr;

class Interface : public testing::Test {
  protected:
    std::unique_ptr<ViewerWindow> open(const std::string& words, const std::string& state_folder) {
        return std::make_unique<ViewerWindow>(
            *display_, workplace_, "square.obj" + words,
            "XDG_STATE_HOME=" + (workplace_ / state_folder).string());
    }
    static void close(ViewerWindow& window) {
        window.key("ctrl+q");
        EXPECT_EQ(window.process().wait_for_end(100.0), 0);
        EXPECT_EQ(window.said(), "");
    }
    static int panel_width(const json& now) { return 1280 - now["view"][0].get<int>(); }

    /// \return the first window's state
    json leave_a_changed_window() {
        const auto window = open("", "state");
        json first = window->wait_for_rest();
        EXPECT_EQ(first["layout"]["scale"], 1.0);
        window->click_on("Lights");
        window->click_on("Scene");
        window->key("ctrl+equal");
        window->wait_for("larger letters",
                         [](const json& now) { return now["layout"]["scale"] == 1.25; });
        display_->act(
            "search --onlyvisible --name relief-view windowsize 1000 700 windowmove 40 20");
        window->wait_for("another size", [](const json& now) { return now["view"][1] < 690; });
        close(*window);
        return first;
    }

    void expect_remembered() {
        const auto window = open("", "state");
        const json state = window->wait_for("the same again", [](const json& now) {
            return now["layout"]["scale"] == 1.25 && now["revision"] > 0;
        });
        EXPECT_EQ(state["layout"]["open"], json({{"Lights", true}, {"Scene", false}}));
        EXPECT_TRUE(state["places"].contains("Add directional"));
        const json written = json::parse(workplace_.read("state/relief/relief-view.json"));
        EXPECT_EQ(written["window"]["size"], json({1000, 700}));
        EXPECT_EQ(written["window"]["position"], json({40, 20}));
        EXPECT_LT(state["view"][1], 690);
        close(*window);
    }

    void expect_that_a_newer_file_is_kept() {
        workplace_.write("state/relief/relief-view.json", R"({"version": 9})");
        const auto window = open("", "state");
        const json state = window->wait_for_rest();
        EXPECT_EQ(state["layout"]["scale"], 1.0);
        EXPECT_THAT(state["layout"]["note"].get<std::string>(), HasSubstr("of version 9"));
        window->key("Tab");
        window->wait_for("no panels", [](const json& now) { return now["view"][0] == 1280; });
        close(*window);
        EXPECT_EQ(workplace_.read("state/relief/relief-view.json"), R"({"version": 9})");
    }

    void expect_twice_the_size_without_a_file(const json& usual) {
        const auto window = open(" --ui-scale 2 --no-state", "untouched");
        const json state = window->wait_for_rest();
        EXPECT_EQ(state["layout"]["scale"], 2.0);
        EXPECT_EQ(panel_width(state), 2 * panel_width(usual));
        for (std::size_t i = 0; i < 2; ++i) {
            EXPECT_NEAR(state["places"]["Scene"][i].get<double>(),
                        2.0 * usual["places"]["Scene"][i].get<double>(), 2.0);
        }
        window->click_on("Lights");
        window->wait_for("the panel", [](const json& now) {
            return now["layout"]["open"].value("Lights", false) &&
                   now["places"].contains("Add directional");
        });
        window->key("ctrl+minus");
        window->wait_for("a smaller one",
                         [](const json& now) { return now["layout"]["scale"] == 1.75; });
        window->key("ctrl+0");
        window->wait_for("the screen's", [&](const json& now) {
            return now["layout"]["scale"] == 1.0 && panel_width(now) == panel_width(usual);
        });
        close(*window);
        EXPECT_FALSE(std::filesystem::exists(workplace_ / "untouched"));
    }

    const Display* display_ = Display::of_process();
    Workplace workplace_;
};

TEST_F(Interface, IsRememberedAndScaledAndWithoutStateTouchesNoFile) {
    if (display_ == nullptr) GTEST_SKIP() << "needs Xvfb and xdotool";
    workplace_.write_square("square.obj");
    const json usual = leave_a_changed_window();
    expect_remembered();
    expect_that_a_newer_file_is_kept();
    expect_twice_the_size_without_a_file(usual);
}

}  // namespace
}  // namespace relief::tools
