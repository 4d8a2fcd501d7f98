// SPDX-License-Identifier: Apache-2.0
// The real window: its handles in the picture, the list of files, and the progress before the first
// picture.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "support/labels.h"
#include "tools/window/viewer_window.h"

namespace relief::tools {
namespace {

FILE_LABELS(window, slow);

using nlohmann::json;
using relief::Image;
using test::Display;
using test::eventually;
using test::has_effect;
using test::ViewerWindow;
using test::Workplace;

TEST(Axes, AreClickedToLookAlongThem) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    ViewerWindow window(*display, workplace, "data/vase.obj --camera 30,20");
    window.wait_for_rest();
    EXPECT_FALSE(window.state()["places"].contains("axis +x")) << "the tests hide them";
    window.key("a");
    window.wait_for("the axes", [](const json& now) { return now["places"].contains("axis +x"); });
    window.click_on("axis +x");
    const json right = window.wait_for("the right", [](const json& now) {
        return std::abs(now["camera"]["azimuth"].get<double>() - 90.0) < 1e-3;
    });
    EXPECT_NEAR(right["camera"]["elevation"].get<double>(), 0.0, 1e-3);
    window.click_on("axis +y");
    window.wait_for("above", [](const json& now) {
        return std::abs(now["camera"]["elevation"].get<double>() - 90.0) < 1e-3;
    });
}

double distance(const json& a, const json& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < 3; ++i)
        sum += std::pow(a[i].get<double>() - b[i].get<double>(), 2.0);
    return std::sqrt(sum);
}

TEST(LightHandle, IsDraggedAsOneStepOfUndo) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    ViewerWindow window(*display, workplace, "data/vase.obj --light directional:40,30");
    const json before = window.wait_for_rest();
    EXPECT_FALSE(before["places"].contains("light handle 1"));
    window.click_on("Scene");
    window.click_on("Lights");
    const json open = window.wait_for(
        "a handle", [](const json& now) { return now["places"].contains("light handle 1"); });
    const json place = open["places"]["light handle 1"];
    window.drag(place[0].get<int>(), place[1].get<int>(), -80, 40);
    const json moved = window.wait_for("another direction", [&](const json& now) {
        return distance(now["directional_lights"][0], before["directional_lights"][0]) > 0.1 &&
               now["places"]["light handle 1"] ==
                   json({place[0].get<int>() - 80, place[1].get<int>() + 40});
    });
    EXPECT_EQ(moved["camera"], before["camera"]) << "the picture does not turn";
    EXPECT_EQ(moved["edits"]["undo"], 1) << "a drag is one step";
    window.key("ctrl+z");
    window.wait_for("the old direction", [&](const json& now) {
        return distance(now["directional_lights"][0], before["directional_lights"][0]) < 1e-6;
    });
}

TEST(Browsing, SetsAMapFromAFolderWithPreviews) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    ViewerWindow window(*display, workplace, "data/vase.obj");
    window.wait_for_rest();
    window.click_on("Scene");
    window.click_on("Materials");
    window.click_on("group Relief");
    window.click_on("browse Bump map");
    window.wait_for("the dialog", [](const json& now) { return now["places"].contains("path"); });
    const Image list = display->resting_picture();
    window.wait_for("previews", [](const json& now) { return now["busy"] == false; });
    window.click_on("bricks-height.png");
    const json mapped =
        window.wait_for("the map", [](const json& now) { return has_effect(now, "bump map"); });
    EXPECT_EQ(mapped["error"], "");
    EXPECT_EQ(mapped["edits"]["undo"], 1);
    window.click_on("browse Bump map");
    window.wait_for("the present image and the recent one", [](const json& now) {
        return now["places"].contains("present image") &&
               now["places"].contains("Cancel the dialog");
    });
    window.click_on("Cancel the dialog");
    window.wait_for("no dialog", [](const json& now) { return !now["places"].contains("path"); });
}

/// A model that takes seconds to read.
void write_large_model(const Workplace& workplace) {
    std::string text;
    constexpr int side = 1200;
    for (int y = 0; y <= side; ++y) {
        for (int x = 0; x <= side; ++x)
            text += "v " + std::to_string(x) + " " + std::to_string(y) + " 0\n";
    }
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const int a = y * (side + 1) + x + 1;
            text += "f " + std::to_string(a) + " " + std::to_string(a + 1) + " " +
                    std::to_string(a + side + 2) + " " + std::to_string(a + side + 1) + "\n";
        }
    }
    workplace.write("large.obj", text);
}

TEST(Reading, ShowsProgressAndIsCancelledByEscape) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    write_large_model(workplace);
    ViewerWindow window(*display, workplace, "large.obj");
    ASSERT_TRUE(eventually([&] { return window.state()["places"].contains("waiting"); }));
    EXPECT_EQ(window.state()["loading"], true);
    window.key("Escape");
    const json after =
        window.wait_for("no reading", [](const json& now) { return now["loading"] == false; });
    EXPECT_FALSE(after.contains("triangles"));
    EXPECT_EQ(after["notice"], "Reading large.obj was cancelled");
}

TEST(Reading, EndsSoonWhenTheWindowIsClosed) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    write_large_model(workplace);
    ViewerWindow window(*display, workplace, "large.obj");
    ASSERT_TRUE(eventually([&] { return window.state()["loading"] == true; }));
    const double begin = test::seconds_now();
    window.key("ctrl+q");  // As the close button; without a window manager there is none.
    EXPECT_EQ(window.process().wait_for_end(30.0), 0);
    EXPECT_LT(test::seconds_now() - begin, 5.0) << "reading takes longer";
    EXPECT_EQ(window.error_output(), "");
}

}  // namespace
}  // namespace relief::tools
