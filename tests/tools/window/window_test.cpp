// SPDX-License-Identifier: Apache-2.0
// The real window, on a display of its own, driven by hands that xdotool moves. What it shows is
// judged by the pixels of the screen and by what it says of itself.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "relief/mesh/image_file.h"
#include "tools/window/drag_and_drop.h"
#include "tools/window/viewer_window.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using relief::Image;
using test::changed_picture;
using test::eventually;
using test::processor_seconds;
using test::ViewerWindow;
using test::Workplace;
using testing::HasSubstr;
using testing::Not;

TEST(Window, ADragTurnsTheCameraAndThePicture) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    ViewerWindow window(*display, workplace, "data/vase.obj");
    const json before = window.wait_for_rest();
    const Image picture = display->resting_picture();
    const double height = before["view"][1].get<double>();
    window.drag(700, 300, 100, 40);
    // A drag over the height of the view is half a turn.
    const json moved = window.wait_for("turned", [&](const json& now) {
        const double turned =
            before["camera"]["azimuth"].get<double>() - now["camera"]["azimuth"].get<double>();
        const double raised =
            now["camera"]["elevation"].get<double>() - before["camera"]["elevation"].get<double>();
        return std::abs(turned - 180.0 * 100.0 / height) < 1e-3 &&
               std::abs(raised - 180.0 * 40.0 / height) < 1e-3;
    });
    EXPECT_TRUE(eventually([&] { return changed_picture(picture, display->picture()) > 0.05; }));
    EXPECT_EQ(moved["camera"]["distance"], before["camera"]["distance"]);
}

TEST(Window, KeysAndTheWheelMoveTheCameraAndQuitEndsIt) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    ViewerWindow window(*display, workplace, "data/vase.obj --camera 30,20");
    const json before = window.wait_for_rest();
    const Image picture = display->resting_picture();
    EXPECT_NEAR(before["camera"]["azimuth"].get<double>(), 30.0, 1e-3);
    window.key("7");
    window.wait_for("above", [](const json& now) {
        return std::abs(now["camera"]["elevation"].get<double>() - 90.0) < 1e-3;
    });
    EXPECT_TRUE(eventually([&] { return changed_picture(picture, display->picture()) > 0.05; }));
    window.key("ctrl+3");
    window.wait_for("left", [](const json& now) {
        return std::abs(now["camera"]["azimuth"].get<double>() + 90.0) < 1e-3;
    });
    const double distance = before["camera"]["distance"].get<double>();
    display->act("mousemove 800 400 click 4 click 4 click 5 click 4");
    window.wait_for("nearer by two steps", [&](const json& now) {
        return std::abs(now["camera"]["distance"].get<double>() / distance - 0.81) < 1e-4;
    });
    window.drag(800, 400, 50, 0, 2);
    window.wait_for("panned", [&](const json& now) {
        const json& target = now["camera"]["target"];
        return target[2] != before["camera"]["target"][2];
    });
    // Two fingers, or the wheel, with Shift take the model along and come no nearer.
    const json panned = window.wait_for_rest();
    display->act("mousemove 800 400 keydown shift click 4 click 6 keyup shift");
    const json scrolled = window.wait_for("scrolled", [&](const json& now) {
        return now["camera"]["target"] != panned["camera"]["target"];
    });
    EXPECT_EQ(scrolled["camera"]["distance"], panned["camera"]["distance"]);
    window.key("f");
    window.wait_for("fitted", [&](const json& now) {
        const json& target = now["camera"]["target"];
        return std::abs(target[2].get<double>()) < 1e-3 &&
               now["camera"]["distance"].get<double>() > 0.9 * distance;
    });
    window.key("ctrl+q");
    EXPECT_EQ(window.process().wait_for_end(100.0), 0) << window.said();
    EXPECT_THAT(window.said(), Not(HasSubstr("relief-view:")));
}

TEST(Window, HelpComesAndGoesAndPanelsGiveTheirRoom) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    workplace.write_square("square.obj");
    ViewerWindow window(*display, workplace, "square.obj");
    const json before = window.wait_for_rest();
    const Image picture = display->resting_picture();
    window.key("h");
    window.wait_for("help", [](const json& now) { return now["help"] == true; });
    EXPECT_TRUE(eventually([&] { return changed_picture(picture, display->picture()) > 0.2; }));
    window.key("h");
    window.wait_for("no help", [](const json& now) { return now["help"] == false; });
    EXPECT_TRUE(eventually([&] { return changed_picture(picture, display->picture()) == 0.0; }))
        << "the same picture again";
    window.key("Tab");
    window.wait_for("a wider view", [&](const json& now) { return now["view"][0] == 1280; });
    window.key("Tab");
    window.wait_for("panels", [&](const json& now) { return now["view"] == before["view"]; });
}

TEST(Window, WithoutAPictureNothingStaysOfWhatWasThere) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    display->act("mousemove 5 795");  // The pointer is on the screen, too, and changes its shape.
    const Image screen = display->resting_picture();
    ViewerWindow window(*display, workplace, "");
    EXPECT_TRUE(eventually([&] { return changed_picture(screen, display->picture()) == 1.0; }))
        << "all of it: the screen may be seen while it is drawn";
    const Image picture = display->resting_picture();
    window.key("h");
    EXPECT_TRUE(eventually([&] { return changed_picture(picture, display->picture()) > 0.1; }));
    window.key("h");
    EXPECT_TRUE(eventually([&] { return changed_picture(picture, display->picture()) == 0.0; }));
}

TEST(Window, PanelsEditTheScene) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    ViewerWindow window(*display, workplace, "data/vase.obj");
    const json before = window.wait_for_rest();
    const Image picture = display->resting_picture();
    window.click_on("Lights");
    window.click_on("Add directional");
    const json lit = window.wait_for("one light more", [&](const json& now) {
        return now["directional_lights"].size() == before["directional_lights"].size() + 1;
    });
    EXPECT_EQ(lit["camera"], before["camera"]) << "a drag on a panel is none on the picture";
    EXPECT_GT(lit["revision"], before["revision"]);
    EXPECT_TRUE(eventually([&] { return changed_picture(picture, display->picture()) > 0.05; }));
}

TEST(Window, AtRestItDrawsNothingAndTakesNoTime) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    ViewerWindow window(*display, workplace, "data/vase.obj");
    display->act("mousemove 800 400");
    window.wait_for_rest();
    window.key("1");
    window.wait_for("the front", [](const json& now) { return now["camera"]["azimuth"] == 0.0; });
    const json before = window.wait_for_rest();
    EXPECT_GT(before["files"], 0) << "which are watched meanwhile";
    // The last frames of the panels are drawn after the state was written.
    double used = 0.0;
    const auto has_settled = [&] {
        const double last = used;
        std::this_thread::sleep_for(std::chrono::seconds(1));
        used = processor_seconds(window.process().pid());
        return used == last;
    };
    EXPECT_TRUE(eventually(has_settled));
    EXPECT_GT(used, 0.01) << "it has drawn, and that is counted";
    std::this_thread::sleep_for(std::chrono::seconds(10));
    const double more = processor_seconds(window.process().pid()) - used;
    EXPECT_LT(more, 0.1) << "under 1% of a core";
    EXPECT_EQ(window.state(), before) << "not one picture more";
}

TEST(Window, ABrokenModelIsSaidInTheWindow) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    workplace.write("broken.obj", "f 1 2 3\n");
    ViewerWindow window(*display, workplace, "broken.obj");
    const json state =
        window.wait_for("an error", [](const json& now) { return now["error"] != ""; });
    EXPECT_THAT(state["error"].get<std::string>(), HasSubstr("broken.obj"));
    EXPECT_EQ(state["drawn"]["frames"], 0);
    window.key("ctrl+q");
    EXPECT_EQ(window.process().wait_for_end(100.0), 0);
}

TEST(Window, AModelAHeightMapAndSurroundingsAreDroppedAndShown) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    workplace.write_square("square.obj");
    ViewerWindow window(*display, workplace, "");
    window.wait_for("nothing", [](const json& now) { return !now.contains("triangles"); });
    const Image empty = display->resting_picture();
    ASSERT_TRUE(test::drop_files(display->name(), {workplace / "square.obj"}, 700, 400));
    const json model = window.wait_for(
        "the model", [](const json& now) { return now.value("triangles", 0) == 2; });
    window.wait_for_rest();
    EXPECT_TRUE(eventually([&] { return changed_picture(empty, display->picture()) > 0.5; }));

    const Image plain = display->resting_picture();
    ASSERT_TRUE(
        test::drop_files(display->name(), {workplace / "data/bricks-height.png"}, 700, 400));
    const json mapped = window.wait_for("the height map as a normal map", [](const json& now) {
        const json& effects = now["effects"];
        return std::find(effects.begin(), effects.end(), "normal map") != effects.end();
    });
    EXPECT_TRUE(eventually([&] { return changed_picture(plain, display->picture()) > 0.05; }));
    EXPECT_EQ(mapped["camera"], model["camera"]) << "the view is kept";

    ASSERT_TRUE(test::drop_files(display->name(), {workplace / "data/sky"}, 700, 400));
    window.wait_for("the sky", [](const json& now) {
        const json& effects = now["effects"];
        return std::find(effects.begin(), effects.end(), "skybox") != effects.end();
    });
    workplace.write("broken.glb", "this is no model");
    ASSERT_TRUE(test::drop_files(display->name(), {workplace / "broken.glb"}, 700, 400));
    const json broken =
        window.wait_for("an error", [](const json& now) { return now["error"] != ""; });
    EXPECT_THAT(broken["error"].get<std::string>(), HasSubstr("broken.glb"));
    EXPECT_EQ(broken["triangles"], 2) << "the old one stays";
}

TEST(Window, ADoubleClickAimsAtTheSurface) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    ViewerWindow window(*display, workplace, "data/vase.obj");
    const json before = window.wait_for_rest();
    // On a busy machine two clicks may be seen too far apart.
    const auto is_aimed = [&] {
        return window.state()["camera"]["target"] != before["camera"]["target"];
    };
    EXPECT_TRUE(eventually([&] {
        display->act("mousemove 850 300 click --repeat 2 --delay 40 1");
        return eventually(is_aimed, 5.0);
    }));
    const json aimed = window.wait_for_rest();
    EXPECT_EQ(aimed["camera"]["azimuth"], before["camera"]["azimuth"]);
    EXPECT_LT(aimed["camera"]["distance"], before["camera"]["distance"])
        << "the front, not the axis";
    // What was there is in the middle now, as large: the same place once more changes nothing.
    window.wait_for_rest();
    const int middle = 1280 - aimed["view"][0].get<int>() / 2;
    display->act("sleep 0.5 mousemove " + std::to_string(middle) + " " +
                 std::to_string(aimed["view"][1].get<int>() / 2) +
                 " click --repeat 2 --delay 40 1");
    display->act("sleep 0.3");
    const json again = window.wait_for_rest();
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(again["camera"]["target"][i].get<double>(),
                    aimed["camera"]["target"][i].get<double>(), 0.02);
    }
}

TEST(Window, SlowPicturesAreSmallerWhileMovingAndWholeAtRest) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    // One thread of software OpenGL and all effects: far slower than 60 ms in any machine's CI.
    ViewerWindow window(*display, workplace,
                        "data/vase.obj --environment data/sky --reflectivity 0.3 --height-map "
                        "data/bricks-height.png",
                        "LP_NUM_THREADS=0");
    const json before = window.wait_for_rest();
    if (before["drawn"]["milliseconds"] < 80.0) GTEST_SKIP() << "too quick a machine";
    window.key("space");
    ASSERT_TRUE(eventually([&] { return window.state()["drawn"]["whole"] == false; }));
    const json moving = window.state();
    EXPECT_EQ(moving["drawn"]["samples"], 1);
    window.key("space");
    const json after = window.wait_for("rest", [](const json& now) { return !now["turntable"]; });
    EXPECT_EQ(after["drawn"]["whole"], true);
    EXPECT_EQ(after["drawn"]["size"], after["view"]);
    EXPECT_EQ(after["drawn"]["samples"], 4);
    EXPECT_GT(after["reduced"], 0);
}

TEST(Window, SavesThePictureThatItShows) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    workplace.write("vase.obj", workplace.read("data/vase.obj"));
    display->act("mousemove 5 795");  // The pointer is on the screen, and not in the file.
    ViewerWindow window(*display, workplace, "vase.obj");
    const json before = window.wait_for_rest();
    window.key("s");
    const json saved =
        window.wait_for("a file", [](const json& now) { return now["saved"]["done"] == 1; });
    EXPECT_EQ(saved["saved"]["file"], "vase-1.png");
    const Image image = read_image(workplace / "vase-1.png", ImageUse::color);
    const Image screen = display->resting_picture();
    ASSERT_EQ(json({image.width, image.height}), before["view"]);
    int differing = 0;  // The view ends at the right and begins at the top.
    const int left = screen.width - image.width;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < 3 * image.width; ++x) {
            const auto a =
                image.as<std::uint8_t>()[static_cast<std::size_t>(y * 3 * image.width + x)];
            const auto b = screen.as<std::uint8_t>()[static_cast<std::size_t>(
                3 * (y * screen.width + left) + x)];
            differing += a == b ? 0 : 1;
        }
    }
    EXPECT_EQ(differing, 0) << "codes";
}

TEST(Window, TheViewOpensInTheSizeThatIsAskedFor) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    ViewerWindow window(*display, workplace, "data/vase.obj --size 500x400");
    window.wait_for("the view", [](const json& now) {
        return now["view"] == json({500, 400}) && now["drawn"]["size"] == now["view"];
    });
}

TEST(Window, ADriverThatIsTooOldIsSaid) {
    RELIEF_NEEDS_DISPLAY(display);
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
