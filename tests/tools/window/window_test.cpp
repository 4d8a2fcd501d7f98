// SPDX-License-Identifier: Apache-2.0
// The real window on a virtual display, controlled by xdotool. The tests check the pixels of the
// screen and the state that the window reports.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>

#include "relief/mesh/image_file.h"
#include "relief/shade/image_compare.h"
#include "support/labels.h"
#include "tools/window/viewer_window.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

FILE_LABELS(window);

using nlohmann::json;
using relief::Image;
using test::changed_picture;
using test::Display;
using test::eventually;
using test::has_effect;
using test::processor_seconds;
using test::ViewerWindow;
using test::Workplace;
using testing::HasSubstr;
using testing::Not;

/// A viewer on the display of the process. The steps of a test are its methods.
class Window : public testing::Test {
  protected:
    /// \return false if there is no display; then the test is skipped
    bool open(const std::string& words, const std::string& environment = "") {
        display_ = Display::of_process();
        if (display_ == nullptr) return false;
        window_ = std::make_unique<ViewerWindow>(*display_, workplace_, words, environment);
        return true;
    }

    void expect_changed(const Image& picture, double share) {
        EXPECT_TRUE(
            eventually([&] { return changed_picture(picture, display().picture()) > share; }));
    }
    void expect_same(const Image& picture) {
        EXPECT_TRUE(
            eventually([&] { return changed_picture(picture, display().picture()) == 0.0; }));
    }
    void quit() {
        window().key("ctrl+q");
        EXPECT_EQ(window().process().wait_for_end(100.0), 0) << window().error_output();
        EXPECT_THAT(window().error_output(), Not(HasSubstr("relief-view:")));
        EXPECT_FALSE(std::filesystem::exists(workplace() / "imgui.ini")) << "of Dear ImGui";
    }

    const Display& display() { return *display_; }
    ViewerWindow& window() { return *window_; }
    Workplace& workplace() { return workplace_; }

  private:
    Workplace workplace_;
    const Display* display_ = nullptr;
    std::unique_ptr<ViewerWindow> window_;
};

#define RELIEF_NEEDS_WINDOW(...) \
    if (!open(__VA_ARGS__)) GTEST_SKIP() << "needs Xvfb and xdotool"

class MovedWindow : public Window {
  protected:
    /// A drag over the height of the view rotates by 180 degrees. \return the state after it
    json drag_turns_camera() {
        const json before = window().wait_for_rest();
        EXPECT_NEAR(before["camera"]["azimuth"].get<double>(), 30.0, 1e-3);
        const Image picture = display().resting_picture();
        const double height = before["view"][1].get<double>();
        window().drag(700, 300, 100, 40);
        const json moved = window().wait_for("turned", [&](const json& now) {
            const double turned =
                before["camera"]["azimuth"].get<double>() - now["camera"]["azimuth"].get<double>();
            const double raised = now["camera"]["elevation"].get<double>() -
                                  before["camera"]["elevation"].get<double>();
            return std::abs(turned - 180.0 * 100.0 / height) < 1e-3 &&
                   std::abs(raised - 180.0 * 40.0 / height) < 1e-3;
        });
        expect_changed(picture, 0.05);
        EXPECT_EQ(moved["camera"]["distance"], before["camera"]["distance"]);
        return moved;
    }

    void double_click_aims_at_surface() {
        const json before = window().wait_for_rest();
        // On a busy machine, two clicks may be too far apart in time.
        const auto is_aimed = [&] {
            return window().state()["camera"]["target"] != before["camera"]["target"];
        };
        EXPECT_TRUE(eventually([&] {
            display().act("mousemove 850 300 click --repeat 2 --delay 40 1");
            return eventually(is_aimed, 5.0);
        }));
        const json aimed = window().wait_for_rest();
        EXPECT_EQ(aimed["camera"]["azimuth"], before["camera"]["azimuth"]);
        EXPECT_LT(aimed["camera"]["distance"], before["camera"]["distance"])
            << "the front, not the axis";
        // The point is in the center now, so a second double click must not change anything.
        const int middle = 1280 - aimed["view"][0].get<int>() / 2;
        window().point_at(middle, aimed["view"][1].get<int>() / 2);
        display().act("sleep 0.5 click --repeat 2 --delay 40 1");  // Not a third and fourth click.
        const json again = window().wait_for_rest();
        for (std::size_t i = 0; i < 3; ++i) {
            EXPECT_NEAR(again["camera"]["target"][i].get<double>(),
                        aimed["camera"]["target"][i].get<double>(), 0.02);
        }
    }

    void keys_and_wheel_move_camera() {
        const json before = window().wait_for_rest();
        const Image picture = display().resting_picture();
        const double distance = before["camera"]["distance"].get<double>();
        window().key("7");
        window().wait_for("above", [](const json& now) {
            return std::abs(now["camera"]["elevation"].get<double>() - 90.0) < 1e-3;
        });
        expect_changed(picture, 0.05);
        window().key("ctrl+3");
        window().wait_for("left", [](const json& now) {
            return std::abs(now["camera"]["azimuth"].get<double>() + 90.0) < 1e-3;
        });
        display().act("mousemove 800 400 click 4 click 4 click 5 click 4");
        window().wait_for("nearer by two steps", [&](const json& now) {
            return std::abs(now["camera"]["distance"].get<double>() / distance - 0.81) < 1e-4;
        });
        window().drag(800, 400, 50, 0, 2);
        window().wait_for("panned", [&](const json& now) {
            return now["camera"]["target"][2] != before["camera"]["target"][2];
        });
        // With Shift, the wheel or two fingers pan instead of zooming.
        const json panned = window().wait_for_rest();
        display().act("mousemove 800 400 keydown shift click 4 click 6 keyup shift");
        const json scrolled = window().wait_for("scrolled", [&](const json& now) {
            return now["camera"]["target"] != panned["camera"]["target"];
        });
        EXPECT_EQ(scrolled["camera"]["distance"], panned["camera"]["distance"]);
        window().key("f");
        window().wait_for("fitted", [&](const json& now) {
            return std::abs(now["camera"]["target"][2].get<double>()) < 1e-3 &&
                   now["camera"]["distance"].get<double>() > 0.9 * distance;
        });
    }

    void rest_takes_no_time() {
        const json before = window().wait_for_rest();
        EXPECT_GT(before["files"], 0) << "which are watched meanwhile";
        // The last frames of the panels are drawn after the state was written.
        EXPECT_TRUE(eventually([&] { return used_in(0.5) < 0.005; }));
        EXPECT_GT(processor_seconds(window().process().pid()), 0.01) << "it has drawn before";
        EXPECT_LT(used_in(2.0), 0.02) << "under 1% of a core";
        EXPECT_EQ(window().state(), before) << "not one picture more";
    }

  private:
    /// Processor time of the viewer during an interval.
    double used_in(double seconds) {
        const pid_t viewer = window().process().pid();
        const double before = processor_seconds(viewer);
        test::wait_seconds(seconds);
        return processor_seconds(viewer) - before;
    }
};

TEST_F(MovedWindow, InputMovesTheViewAndIdleDrawsNoFrame) {
    RELIEF_NEEDS_WINDOW("data/vase.obj --camera 30,20");
    const json turned = drag_turns_camera();
    window().key("ctrl+c");
    // Keys take effect in order, so the view is copied when the help page is seen.
    window().key("h");
    window().wait_for("help", [](const json& now) { return now["help"] == true; });
    window().key("Escape");
    window().wait_for("no help", [](const json& now) { return now["help"] == false; });
    double_click_aims_at_surface();
    window().key("1");
    window().wait_for("front", [](const json& now) { return now["camera"]["azimuth"] == 0.0; });
    window().key("ctrl+v");
    const json again = window().wait_for(
        "pasted", [](const json& now) { return now["camera"]["azimuth"] != 0.0; });
    EXPECT_EQ(again["camera"], turned["camera"]);
    EXPECT_EQ(again["error"], "");
    keys_and_wheel_move_camera();
    rest_takes_no_time();
    quit();
}

class PanelsOfWindow : public Window {
  protected:
    void help_comes_and_goes() {
        const json before = window().wait_for_rest();
        const Image picture = display().resting_picture();
        window().key("h");
        window().wait_for("help", [](const json& now) { return now["help"] == true; });
        expect_changed(picture, 0.2);
        window().key("h");
        window().wait_for("no help", [](const json& now) { return now["help"] == false; });
        expect_same(picture);
        window().key("Tab");
        window().wait_for("a wider view", [&](const json& now) { return now["view"][0] == 1280; });
        window().key("Tab");
        window().wait_for("panels", [&](const json& now) { return now["view"] == before["view"]; });
    }

    void shaders_are_shown() {
        window().click_on("Effects");
        window().click_on("Shaders");
        scroll_until([](const json& now) { return now["places"].contains("Program 1"); });
        window().click_on("Program 1");
        const auto has_source = [](const json& now) {
            return now["places"].contains("Vertex shader") &&
                   now["places"].contains("Copy without numbers");
        };
        scroll_until(has_source);
        window().wait_for("the source", has_source);
        window().click_on("Vertex shader");
        window().wait_for("the other one", has_source);
        display().act("mousemove 150 60 click --repeat 100 4");
        window().click_on("Shaders");
    }

    /// Turns the wheel over the panels, below which the programs are.
    void scroll_until(const std::function<bool(const json&)>& holds) {
        constexpr int most = 30;
        for (int i = 0; i < most && !holds(window().wait_for_rest()); ++i)
            display().act("mousemove 150 60 click --repeat 3 5");
    }

    void costs_are_measured_until_the_plan_changes() {
        const json before = window().wait_for_rest();
        EXPECT_TRUE(before["costs"].is_null());
        window().click_on("Measure times");
        const json measured = window().wait_for("costs", [](const json& now) {
            return !now["costs"].is_null() && now["costs"]["going_on"] == false;
        });
        EXPECT_EQ(measured["costs"]["error"], "");
        EXPECT_EQ(measured["costs"]["size"], measured["view"]);
        EXPECT_EQ(measured["costs"]["effects"].size(), before["effects"].size());
        EXPECT_GT(measured["costs"]["frame"], 0.0);
        EXPECT_EQ(measured["camera"], before["camera"]);
        window().key("1");  // Another view, the same plan.
        const json turned = window().wait_for(
            "the front", [](const json& now) { return now["camera"]["azimuth"] == 0.0; });
        EXPECT_EQ(turned["costs"], measured["costs"]);
        window().key("v");  // No picture any more.
        window().wait_for("no costs", [](const json& now) { return now["costs"].is_null(); });
    }
};

TEST_LABELS(slow);
TEST_F(PanelsOfWindow, ShowHelpCostsAndShaders) {
    workplace().write_square("square.obj");
    RELIEF_NEEDS_WINDOW("square.obj --samples 1");
    help_comes_and_goes();
    shaders_are_shown();
    costs_are_measured_until_the_plan_changes();
}

TEST_F(Window, WithoutAModelTakesDroppedFiles) {
    Image screen;
    if (const Display* const display = Display::of_process()) screen = display->resting_picture();
    RELIEF_NEEDS_WINDOW("");
    workplace().write_square("square.obj");
    window().wait_for("nothing", [](const json& now) { return !now.contains("triangles"); });
    EXPECT_TRUE(eventually([&] { return changed_picture(screen, display().picture()) == 1.0; }))
        << "all of it: the screen may be seen while it is drawn";
    const Image empty = display().resting_picture();
    window().key("h");
    expect_changed(empty, 0.1);
    window().key("h");
    expect_same(empty);

    const auto drop = [&](const char* file) {
        ASSERT_TRUE(test::drop_files(display().name(), {workplace() / file}, 700, 400)) << file;
    };
    drop("square.obj");
    const json model = window().wait_for(
        "the model", [](const json& now) { return now.value("triangles", 0) == 2; });
    window().wait_for_rest();
    expect_changed(empty, 0.5);

    const Image plain = display().resting_picture();
    drop("data/bricks-height.png");
    const json mapped = window().wait_for("the height map as a normal map", [](const json& now) {
        return has_effect(now, "normal map");
    });
    expect_changed(plain, 0.05);
    EXPECT_EQ(mapped["camera"], model["camera"]) << "the view is kept";

    drop("data/sky");
    window().wait_for("the sky", [](const json& now) { return has_effect(now, "skybox"); });
    workplace().write("broken.glb", "this is no model");
    drop("broken.glb");
    const json broken =
        window().wait_for("an error", [](const json& now) { return now["error"] != ""; });
    EXPECT_THAT(broken["error"].get<std::string>(), HasSubstr("broken.glb"));
    EXPECT_EQ(broken["triangles"], 2) << "the old one stays";
}

TEST_F(Window, SlowPicturesAreReducedDuringMotionAndMeasuringCanBeStopped) {
    // With one thread of software OpenGL, all effects take far longer than 60 ms on any CI machine.
    // Without the shader cache, the measurement takes long enough to be stopped.
    RELIEF_NEEDS_WINDOW(
        "data/vase.obj --environment data/sky --reflectivity 0.3 --height-map "
        "data/bricks-height.png",
        "LP_NUM_THREADS=0 MESA_SHADER_CACHE_DISABLE=true");
    // While the model loads, the panels change their height, and a click could miss its item.
    const json before = window().wait_for_rest();
    window().click_on("Effects");
    window().click_on("Measure times");
    window().click_on("Stop");
    window().wait_for("no costs", [](const json& now) { return now["costs"].is_null(); });

    if (before["drawn"]["milliseconds"] < 80.0) GTEST_SKIP() << "too quick a machine";
    window().key("space");
    ASSERT_TRUE(eventually([&] { return window().state()["drawn"]["whole"] == false; }));
    const json moving = window().state();
    EXPECT_GE(3 * moving["drawn"]["size"][0].get<int>() + 3, moving["view"][0].get<int>())
        << "never less than a third";
    window().key("space");
    const json after = window().wait_for("rest", [](const json& now) { return !now["turntable"]; });
    EXPECT_EQ(after["drawn"]["whole"], true);
    EXPECT_EQ(after["drawn"]["size"], after["view"]);
    EXPECT_EQ(after["drawn"]["samples"], 4);
    EXPECT_GT(after["reduced"], 0);
    // Resolution.FullPictureIsThereAFifthOfASecondAfterMotion limits it; here the machine may be
    // busy.
    EXPECT_GE(after["drawn"]["seconds_to_full"].get<double>(),
              1e-3 * after["drawn"]["milliseconds"].get<double>())
        << "the picture is drawn after the last step of the turntable";
}

constexpr const char* saved_text = "vase.obj --height-map data/bricks-height.png";

class SavingWindow : public Window {
  protected:
    void open_beside_saved_files() {
        workplace().write("vase.obj", workplace().read("data/vase.obj"));
        workplace().write("vase-scene-1.json", "mine");
    }

    /// The picture of the view as soon as it is stable.
    Image shown(const json& state) {
        window().wait_for("the whole picture",
                          [](const json& now) { return now["drawn"]["whole"]; });
        return test::view_on(display().resting_picture(), state["view"]);
    }

    void expect_drawn(const std::string& words, const Image& expected) {
        const test::ProgramResult result =
            workplace().run("relief-view " + words + " --output again.png");
        ASSERT_EQ(result.exit_code, 0) << words << "\n" << result.error;
        expect_equal("again.png", expected);
    }
    void expect_equal(const std::string& file, const Image& expected) {
        const Image image = read_image(workplace() / file, ImageUse::color);
        EXPECT_EQ(compare(image, expected).differing_pixels, 0U) << file;
    }

    json move_in_all_ways() {
        window().drag(700, 300, 90, 35);
        window().drag(800, 400, 40, -25, 2);
        window().key("bracketleft");
        display().act("mousemove 900 200 click 4 click 4 mousemove 5 795");
        return window().wait_for("all moves", [](const json& now) {
            return now["camera"]["fov"] < 35.0 && now["camera"]["distance"] < 3.0;
        });
    }
};

TEST_LABELS(slow);
TEST_F(SavingWindow, PictureSceneModelAndTextDrawWhatIsShown) {
    open_beside_saved_files();
    RELIEF_NEEDS_WINDOW(saved_text);
    const json before = window().wait_for_rest();
    window().key("s");
    const json picture =
        window().wait_for("a file", [](const json& now) { return now["saved"]["done"] == 1; });
    EXPECT_EQ(picture["saved"]["file"], "vase-1.png");
    expect_equal("vase-1.png", shown(before));

    const json moved = move_in_all_ways();
    expect_drawn(saved_text + (" " + moved["command_line"].get<std::string>()), shown(moved));

    window().key("ctrl+s");
    const json scene = window().wait_for("a scene", [](const json& now) {
        return now["saved_files"]["file"] == "vase-scene-2.json";
    });
    EXPECT_EQ(scene["saved_files"]["error"], "");
    EXPECT_EQ(workplace().read("vase-scene-1.json"), "mine");
    expect_drawn("vase-scene-2.json", shown(scene));

    window().key("ctrl+e");
    window().wait_for("a model", [](const json& now) {
        return now["saved_files"]["file"] == "vase-model-1.glb";
    });
    EXPECT_EQ(workplace().run("relief-view vase-model-1.glb --output model.png").exit_code, 0);
}

TEST(OldDriver, IsReportedInsteadOfAWindow) {
    const Display* const display = Display::of_process();
    if (display == nullptr) GTEST_SKIP() << "needs Xvfb and xdotool";
    const Workplace workplace;
    const test::ProgramResult result = workplace.run(
        "DISPLAY=" + display->name() + " MESA_GL_VERSION_OVERRIDE=2.1 relief-view data/vase.obj");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.error, HasSubstr("no window with OpenGL 3.3 can be opened"));
    EXPECT_THAT(result.error, HasSubstr("--output FILE.png"));
    EXPECT_EQ(result.out, "");
}

}  // namespace
}  // namespace relief::tools
