// SPDX-License-Identifier: Apache-2.0
// Two settings beside each other in the real window: the line, the sides, the numbers; and the
// methods of the accuracy panel.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "relief/mesh/image_file.h"
#include "relief/shade/image_compare.h"
#include "tools/window/viewer_window.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::changed_share;
using test::Display;
using test::eventually;
using test::view_on;
using test::ViewerWindow;
using test::Workplace;

constexpr const char* bricks = "data/vase.obj --height-map data/bricks-height.png ";
constexpr int middle_of_line = 789;  // Of a view of 981 pixels that ends at 1280.

/// Waits for two sides on the screen.
json both_sides(ViewerWindow& window) {
    return window.wait_for("two sides", [](const json& now) {
        return now["compare"]["on"] == true && now["drawn"]["beside"] != 0 &&
               now["drawn"]["beside"] == now["compare"]["revision"] && now["drawn"]["whole"];
    });
}

bool is_used(const json& state, const std::string& use) {
    for (const json& topic : state["accuracy"]["topics"]) {
        for (const json& method : topic["methods"]) {
            if (method["use"] == use) return method["used"];
        }
    }
    return false;
}

/// More of one side shows, and no scene is drawn.
void drag_line(ViewerWindow& window, const Display& display) {
    const json before = both_sides(window);
    ASSERT_EQ(before["view"][0], 981);
    window.point_at(640, 790);
    window.wait_for_rest();
    const Image split = display.resting_picture();
    window.drag(middle_of_line, 700, 160, 0);
    const json after = window.wait_for("a moved line", [](const json& now) {
        return std::abs(now["compare"]["split"].get<double>() - (0.5 + 160.0 / 981.0)) < 2e-3;
    });
    window.point_at(640, 790);
    EXPECT_EQ(after["camera"], before["camera"]) << "a drag of the line is none of the camera";
    EXPECT_EQ(after["drawn"]["frames"], before["drawn"]["frames"]);
    Image moved;
    EXPECT_TRUE(eventually([&] {  // The state is told before the frame is on the screen.
        moved = display.picture();
        return changed_share(split, moved, middle_of_line + 4, 200, 150, 400) > 0.15 &&
               changed_share(split, moved, middle_of_line + 159, 200, 2, 400) == 1.0;
    }));
    EXPECT_EQ(changed_share(split, moved, 320, 60, middle_of_line - 330, 700, 0), 0.0);
    EXPECT_EQ(changed_share(split, moved, middle_of_line + 170, 60, 300, 700, 0), 0.0);
}

/// The numbers are those of the library.
void show_difference(ViewerWindow& window, const Display& display, const Workplace& workplace) {
    window.wait_for_rest();
    const Image sides = display.resting_picture();
    window.key("d");
    const json after = window.wait_for("the difference", [](const json& now) {
        return now["drawn"]["difference"] == true && !now["compare"]["numbers"].is_null();
    });
    EXPECT_TRUE(eventually(
        [&] { return changed_share(sides, display.picture(), 600, 200, 400, 400) > 0.5; }));
    const std::string view = after["command_line"].get<std::string>();
    const std::string plain = view.substr(0, view.find(" --compare"));
    ASSERT_EQ(
        workplace.run("relief-view " + std::string(bricks) + "--output a.png " + plain).exit_code,
        0);
    ASSERT_EQ(workplace.run("relief-view data/vase.obj --output b.png " + plain).exit_code, 0);
    const Image a = read_image(workplace / "a.png", ImageUse::color);
    const Image b = read_image(workplace / "b.png", ImageUse::color);
    const json& numbers = after["compare"]["numbers"];
    EXPECT_EQ(numbers["max"], compare(a, b).max);
    EXPECT_EQ(numbers["differing_pixels"], compare(a, b).differing_pixels);
    EXPECT_NEAR(numbers["flip_mean"].get<double>(), flip_difference(a, b).mean, 1e-9);
    window.key("d");
    window.wait_for("both sides", [](const json& now) { return !now["drawn"]["difference"]; });
    EXPECT_TRUE(eventually(
        [&] { return changed_share(sides, display.picture(), 600, 200, 180, 400) == 0.0; }));
}

TEST(CompareWindow, TheLineIsDraggedAndTheDifferenceIsMeasured) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    ViewerWindow window(*display, workplace, std::string(bricks) + "--compare map=none");
    drag_line(window, *display);
    show_difference(window, *display, workplace);
}

TEST(CompareWindow, BothSidesAreThePicturesThatTheirCommandLinesDraw) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    ViewerWindow window(*display, workplace,
                        std::string(bricks) + "--compare kernel=central5 --split 0.25");
    const json shown = both_sides(window);
    window.wait_for_rest();
    const auto text = shown["command_line"].get<std::string>();
    const test::ProgramResult result =
        workplace.run("relief-view " + std::string(bricks) + "--output again.png " + text);
    ASSERT_EQ(result.exit_code, 0) << result.error;
    const Image again = read_image(workplace / "again.png", ImageUse::color);
    const Image view = test::view_on(display->resting_picture(), shown["view"]);
    // But for labels at the top, and the line.
    const int line = static_cast<int>(std::lround(0.25 * view.width));
    EXPECT_EQ(changed_share(again, view, 0, 60, line - 3, view.height - 60, 0), 0.0);
    EXPECT_EQ(changed_share(again, view, line + 3, 60, view.width - line - 3, view.height - 60, 0),
              0.0);
}

/// A click on a method of the accuracy panel uses it, and the picture follows.
void choose_method(ViewerWindow& window, const Display& display) {
    const json at_first = window.wait_for_rest();
    EXPECT_TRUE(at_first["accuracy"]["topics"].empty()) << "nothing is measured unasked";
    window.click_on("Scene");  // Closed, to make room.
    window.click_on("Effects");
    window.click_on("Accuracy");
    window.click_on("Measure methods");
    const json measured = window.wait_for("figures", [](const json& now) {
        return now["accuracy"]["topics"].size() >= 2 && !now["accuracy"]["measuring"];
    });
    EXPECT_TRUE(is_used(measured, "kernel=central7"));
    window.wait_for_rest();
    const auto picture = [&] { return view_on(display.picture(), window.state()["view"]); };
    const Image before = view_on(display.resting_picture(), window.state()["view"]);

    window.click_on("method normals=uniform");
    window.wait_for("other normals", [&](const json& now) {
        return is_used(now, "normals=uniform") && !now["accuracy"]["working"] && !now["busy"] &&
               now["drawn"]["revision"] == now["revision"] &&
               now["revision"] > measured["revision"];
    });
    // On a mesh as fine as this, by a code here and there.
    EXPECT_TRUE(eventually([&] {
        const Image after = picture();
        return changed_share(before, after, 0, 0, after.width, after.height, 0) > 0.01;
    })) << "the picture shows it";
}

/// Keys and the panel choose the sides, swap them and end the comparison.
void choose_sides(ViewerWindow& window, const Display& display) {
    window.wait_for_rest();
    EXPECT_EQ(window.state()["drawn"]["beside"], 0) << "what is not compared is not drawn";
    window.key("k");
    both_sides(window);
    const Image before = display.resting_picture();
    window.key("x");
    const json swapped = window.wait_for(
        "swapped", [](const json& now) { return now["compare"]["right"] == "as it is"; });
    EXPECT_EQ(swapped["compare"]["left"], "interpolation=flat");
    EXPECT_TRUE(eventually(
        [&] { return changed_share(before, display.picture(), 600, 200, 150, 400) > 0.05; }));
    window.click_on("Accuracy");  // Closed, to make room.
    window.click_on("Compare");
    window.click_on("Change");
    window.click_on("kernel");
    window.wait_for("a kernel", [](const json& now) {
        return now["compare"]["left"] == "kernel=forward" && now["drawn"]["beside"] != 0;
    });
    window.click_on("Compare two");
    const json off =
        window.wait_for("one picture", [](const json& now) { return now["drawn"]["beside"] == 0; });
    EXPECT_EQ(off["compare"]["on"], false);
}

TEST(CompareWindow, MethodsAndSidesAreChosenInPanels) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    ViewerWindow window(*display, workplace, std::string(bricks) + "--strength 24");
    choose_method(window, *display);
    choose_sides(window, *display);
}

}  // namespace
}  // namespace relief::tools
