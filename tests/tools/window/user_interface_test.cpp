// SPDX-License-Identifier: Apache-2.0
// Shortcuts, the documentation of the panels, and the panels of the real window. Changes are
// checked in the state that the program reports and in the picture.
#include "window/viewer_state.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <regex>
#include <set>

#include "support/labels.h"
#include "support/shared_data.h"
#include "tools/window/display.h"
#include "tools/window/viewer_window.h"
#include "window/controls.h"
#include "window/panels.h"

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
using testing::HasSubstr;

TEST(Shortcuts, NoKeyHasTwoActions) {
    std::set<std::string_view> keys;
    for (const Shortcut& shortcut : shortcuts())
        EXPECT_TRUE(keys.insert(shortcut.key).second) << shortcut.key;
}

TEST(Shortcuts, EveryActionHasAKey) {
    std::set<Action> actions;
    for (const Shortcut& shortcut : shortcuts())
        actions.insert(shortcut.action);
    EXPECT_EQ(actions.size(), static_cast<std::size_t>(Action::quit) + 1);
}

TEST(Shortcuts, EveryGroupHasSome) {
    std::set<std::string_view> used = {gesture_group};
    for (const Shortcut& shortcut : shortcuts())
        used.insert(shortcut_group(shortcut.action));
    const std::vector<std::string_view> groups = shortcut_groups();
    EXPECT_EQ(used, std::set<std::string_view>(groups.begin(), groups.end()));
    EXPECT_EQ(shortcut_group(Action::wireframe), "Picture");
    EXPECT_EQ(shortcut_group(Action::cancel), "Window");
}

TEST(Shortcuts, AreSearchedByAllWords) {
    EXPECT_TRUE(matches_search("", {"anything"}));
    EXPECT_TRUE(matches_search("  ", {}));
    EXPECT_TRUE(matches_search("Camera FIT", {"camera", "F", "Fit the model"}));
    EXPECT_FALSE(matches_search("camera fox", {"Camera", "F", "Fit the model"}));
    EXPECT_FALSE(matches_search("ab", {"a", "b"})) << "a word is in one text";
}

TEST(Shortcuts, AreListedByGroupOnePerLine) {
    const std::string text = shortcuts_text();
    const auto lines = std::count(text.begin(), text.end(), '\n');
    // A heading and an empty line for each group.
    const std::size_t headings = 2 * shortcut_groups().size() - 1;
    EXPECT_EQ(static_cast<std::size_t>(lines), shortcuts().size() + gestures().size() + headings);
    EXPECT_THAT(text, testing::StartsWith(
                          "Camera\n  F                               Fit the model to the view\n"));
    EXPECT_THAT(text, HasSubstr("\n\nMouse\n  Drag  "));
}

TEST(StatusLine, ShowsWhatFitsFromTheFirstPartOn) {
    const auto width_of = [](const std::string& text) { return static_cast<float>(text.size()); };
    EXPECT_EQ(fitting_line({"", "one", "two", "three"}, 100.0F, width_of), "one   two   three");
    EXPECT_EQ(fitting_line({"one", "two", "three"}, 9.0F, width_of), "one   two");
    EXPECT_EQ(fitting_line({"one", "three", "2"}, 8.0F, width_of), "one") << "in their order";
    EXPECT_EQ(fitting_line({"Saved /far/away.png"}, 11.0F, width_of), "Save....png");
    EXPECT_EQ(fitting_line({}, 9.0F, width_of), "");
}

TEST(FittingEnd, KeepsTheNameOfTheFile) {
    const auto width_of = [](const std::string& text) { return static_cast<float>(text.size()); };
    EXPECT_EQ(fitting_end("bricks.png", 10.0F, width_of), "bricks.png");
    EXPECT_EQ(fitting_end("/far/away/bricks.png", 13.0F, width_of), "...bricks.png");
    EXPECT_EQ(fitting_end("/far/\u00e9cru.png", 11.0F, width_of), "...cru.png")
        << "whole characters";
    EXPECT_EQ(fitting_end("bricks.png", 2.0F, width_of), "...");
    EXPECT_EQ(fitting_end("", 2.0F, width_of), "");
}

std::string page() {
    return test::contents_of(test::source_directory() / "docs/window.md");
}

/// The section of a panel in docs/window.md.
std::string section_of(const std::string& panel) {
    const std::string text = page();
    const std::size_t begin = text.find("\n### " + panel + "\n");
    if (begin == std::string::npos) return "";
    return text.substr(begin, text.find("\n#", begin + 1) - begin);
}

TEST(WindowPage, ShowsEveryPanel) {
    ASSERT_FALSE(panel_names().empty());
    for (const std::string& panel : panel_names())
        EXPECT_THAT(section_of(panel), testing::HasSubstr("](images/window-")) << panel;
}

TEST(WindowPage, PicturesExistAndAreSmall) {
    const std::string text = page();
    const std::regex picture(R"(\]\((images/[^)]*)\))");
    int count = 0;
    for (std::sregex_iterator match(text.begin(), text.end(), picture), end; match != end;
         ++match, ++count) {
        const std::filesystem::path file = test::source_directory() / "docs" / (*match)[1].str();
        ASSERT_TRUE(std::filesystem::exists(file)) << file;
        EXPECT_LT(std::filesystem::file_size(file), 150'000U) << file;
    }
    EXPECT_GT(count, 8);
}

TEST(WindowPage, PicturesAreMadeByTheScript) {
    const std::string script =
        test::contents_of(test::source_directory() / "scripts/dev/window-pictures");
    const std::string text = page();
    const std::regex picture(R"(images/([^)]*)\.png)");
    for (std::sregex_iterator match(text.begin(), text.end(), picture), end; match != end; ++match)
        EXPECT_THAT(script, testing::HasSubstr("\"" + (*match)[1].str() + "\""));
}

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
        EXPECT_EQ(window.error_output(), "");
    }
    static int panel_width(const json& now) { return 1280 - now["view"][0].get<int>(); }

    /// \return the state of the first window
    json leave_a_changed_window() {
        const auto window = open("", "state");
        json first = window->wait_for_rest();
        EXPECT_EQ(first["layout"]["scale"], 1.0);
        window->click_on("Lights");
        window->wait_for("the open panel", [](const json& now) {
            return now["layout"]["open"].value("Lights", false);
        });
        window->click_on("Scene");
        window->wait_for("the closed panel", [](const json& now) {
            return !now["layout"]["open"].value("Scene", true);
        });
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

    void expect_a_larger_scale_without_a_file(const json& usual) {
        const auto window = open(" --ui-scale 1.5 --no-state", "untouched");
        const json state = window->wait_for_rest();
        EXPECT_EQ(state["layout"]["scale"], 1.5);
        EXPECT_EQ(panel_width(state), panel_width(usual) * 3 / 2);
        for (std::size_t i = 0; i < 2; ++i) {
            EXPECT_NEAR(state["places"]["Scene"][i].get<double>(),
                        1.5 * usual["places"]["Scene"][i].get<double>(), 2.0);
        }
        window->click_on("Lights");
        window->wait_for("the panel", [](const json& now) {
            return now["layout"]["open"].value("Lights", false) &&
                   now["places"].contains("Add directional");
        });
        window->key("ctrl+minus");
        window->wait_for("a smaller one",
                         [](const json& now) { return now["layout"]["scale"] == 1.25; });
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

TEST_LABELS(window, slow);
TEST_F(Interface, LayoutAndScaleAreSavedUnlessNoStateIsGiven) {
    if (display_ == nullptr) GTEST_SKIP() << "needs Xvfb and xdotool";
    workplace_.write_square("square.obj");
    const json usual = leave_a_changed_window();
    expect_remembered();
    expect_that_a_newer_file_is_kept();
    expect_a_larger_scale_without_a_file(usual);
}

/// A window with one open panel at a time, so that the whole panel is visible.
class Panel : public testing::Test {
  protected:
    /// \return false if there is no display; then the test is skipped
    bool open(const std::string& words) {
        if (display_ == nullptr) return false;
        window_ = std::make_unique<ViewerWindow>(*display_, workplace_, words);
        window_->wait_for_rest();
        set_open("Scene", false);
        return true;
    }

    /// \return the state after the panel is open
    json open_panel(const std::string& panel) {
        set_open(panel, true);
        return window_->wait_for_rest();
    }
    void close_panel(const std::string& panel) { set_open(panel, false); }

    /// Clicks, and waits until the state and the picture have changed.
    json click(const std::string& name, const ViewerWindow::Condition& holds) {
        const Image before = display_->picture();
        window_->click_on(name);
        json now = window_->wait_for(name, holds);
        EXPECT_TRUE(eventually([&] {
            return changed_share(before, display_->picture(), 390, 10, 880, 760, 2) > 0.005;
        })) << "the picture is the same after "
            << name;
        return now;
    }

    /// Types into a field. A click selects its text.
    void enter(const std::string& field, const std::string& text) {
        const auto is_typing = [](const json& now) { return now["typing"] == true; };
        window_->click_on(field);
        window_->wait_for("a field", is_typing);
        display_->act("type --delay 50 " + text);
        // A busy machine would miss a key press that lasts less than a frame.
        display_->act("keydown Return");
        window_->wait_for("the end of typing", [&](const json& now) { return !is_typing(now); });
        display_->act("keyup Return");
    }

    void change_lights();
    void change_environment();

    const Display& display() { return *display_; }
    ViewerWindow& window() { return *window_; }

  private:
    /// Clicks on the header. Items below it move, so their positions must become stable.
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

/// Adds a light, changes its kind, rotates it and removes it.
void Panel::change_lights() {
    const json before = open_panel("Lights");
    EXPECT_EQ(before["lights"], json::parse(R"([{"kind":"directional","speed":0.0}])"));
    click("Add spot", [](const json& now) { return now["lights"].size() == 2; });
    window().click_on("Light 1");
    window().click_on("Kind");
    window().click_on("Kind: Point");
    window().wait_for("a point light",
                      [](const json& now) { return now["lights"][0]["kind"] == "point"; });
    const std::uint64_t frames = window().state()["drawn"]["frames"];
    const auto moves = [&] { return window().state()["drawn"]["frames"] > frames + 4; };
    EXPECT_TRUE(eventually([&] {
        const json slider = window().state()["places"]["Rotation"];
        window().point_at(slider[0].get<int>() + 10, slider[1].get<int>());
        display().act("mousedown 1");
        if (eventually(moves, 5.0)) return true;
        display().act("mouseup 1");
        return false;
    })) << "it moves by itself";
    const json turning = window().state();
    EXPECT_GT(turning["lights"][0]["speed"], 10.0);
    const json slider = turning["places"]["Rotation"];
    display().act("mouseup 1 mousedown 1");  // Often in one frame.
    window().drag(slider[0].get<int>() + 10, slider[1].get<int>(), -25, 0);
    EXPECT_TRUE(eventually(
        [&] { return window().state()["lights"][0]["speed"] < turning["lights"][0]["speed"]; }));
    EXPECT_EQ(window().state()["edits"]["undo"], turning["edits"]["undo"].get<int>() + 1)
        << "a drag is one step";
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
    click("Show as background", has_none);
    click("Show as background", has_skybox);
    click("clear Image or folder", has_none);
    window().key("ctrl+z");
    window().wait_for("the sky again", has_skybox);
    window().key("ctrl+shift+z");
    window().wait_for("no sky again", has_none);
    close_panel("Environment");
}

TEST_LABELS(window, slow);
TEST_F(Panel, LightsEnvironmentAndToneCurveChangeThePicture) {
    RELIEF_NEEDS_PANELS("data/vase.obj --light directional:40,30 --exposure 1");
    change_lights();
    change_environment();
    open_panel("Picture");
    window().click_on("Tone curve");
    const std::uint64_t revision = window().state()["revision"];
    click("Tone curve: Khronos PBR Neutral",
          [&](const json& now) { return now["revision"] > revision; });
}

TEST_LABELS(window, slow);
TEST_F(Panel, MaterialsTakeMapsAndChangeTheirModel) {
    RELIEF_NEEDS_PANELS("data/vase.obj");
    open_panel("Materials");
    window().wait_for("the only material, unfolded",
                      [](const json& now) { return now["places"].contains("group Relief"); });
    EXPECT_FALSE(window().state()["places"].contains("Bump map")) << "the group has no effect";
    window().click_on("group Relief");
    const auto has = [](const char* effect) {
        return [effect](const json& now) { return has_effect(now, effect); };
    };
    const auto lacks = [](const char* effect) {
        return [effect](const json& now) { return !has_effect(now, effect); };
    };
    enter("Bump map", "data/bricks-height.png");
    window().wait_for("the map", has("bump map"));
    EXPECT_EQ(window().state()["error"], "");
    window().wait_for("the thumbnail", [](const json& now) {
        return now["places"].contains("thumbnail of Bump map");
    });
    click("clear Bump map", lacks("bump map"));
    enter("Normal map", "data/bricks-diffuse.png");
    window().wait_for("the refusal", [](const json& now) {
        return now["error"].get<std::string>().find("is not a normal map") != std::string::npos;
    });
    click("Use it anyway", has("normal map"));
    EXPECT_EQ(window().state()["error"], "");
    click("clear Normal map", lacks("normal map"));
    click("clear Diffuse map", lacks("diffuse texture"));

    window().click_on("Shading of all");
    click("Shading of all: Flat", has("flat"));
    window().click_on("Model of all");
    click("Model of all: Unlit", lacks("diffuse"));
}

}  // namespace
}  // namespace relief::tools
