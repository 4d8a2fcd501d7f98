// SPDX-License-Identifier: Apache-2.0
// Two settings beside each other in the real window: the line, the sides, the numbers.
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
using test::eventually;
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

TEST(CompareWindow, DraggingTheLineShowsMoreOfOneSideAndDrawsNoScene) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    ViewerWindow window(*display, workplace, std::string(bricks) + "--compare map=none");
    const json before = both_sides(window);
    ASSERT_EQ(before["view"][0], 981);
    display->act("mousemove 640 790");
    window.wait_for_rest();
    const Image split = display->resting_picture();
    window.drag(middle_of_line, 700, 160, 0);
    const json after = window.wait_for("a moved line", [](const json& now) {
        return std::abs(now["compare"]["split"].get<double>() - (0.5 + 160.0 / 981.0)) < 2e-3;
    });
    display->act("mousemove 640 790");
    EXPECT_EQ(after["camera"], before["camera"]) << "a drag of the line is none of the camera";
    EXPECT_EQ(after["drawn"]["frames"], before["drawn"]["frames"]);
    Image moved;
    EXPECT_TRUE(eventually([&] {  // The state is told before the frame is on the screen.
        moved = display->picture();
        return changed_share(split, moved, middle_of_line + 4, 200, 150, 400) > 0.15 &&
               changed_share(split, moved, middle_of_line + 159, 200, 2, 400) == 1.0;
    }));
    EXPECT_EQ(changed_share(split, moved, 320, 60, middle_of_line - 330, 700, 0), 0.0);
    EXPECT_EQ(changed_share(split, moved, middle_of_line + 170, 60, 300, 700, 0), 0.0);
}

TEST(CompareWindow, BothSidesAreThePicturesThatTheirCommandLinesDraw) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    display->act("mousemove 5 795");
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

TEST(CompareWindow, NumbersAreThoseOfTheLibraryAndTheDifferenceIsShown) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    ViewerWindow window(*display, workplace, std::string(bricks) + "--compare map=none");
    const json before = both_sides(window);
    window.wait_for_rest();
    const Image sides = display->resting_picture();
    window.key("d");
    const json after = window.wait_for("the difference", [](const json& now) {
        return now["drawn"]["difference"] == true && !now["compare"]["numbers"].is_null();
    });
    EXPECT_TRUE(eventually(
        [&] { return changed_share(sides, display->picture(), 600, 200, 400, 400) > 0.5; }));
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
        [&] { return changed_share(sides, display->picture(), 600, 200, 180, 400) == 0.0; }));
}

TEST(CompareWindow, KeysAndThePanelChooseSwapAndEndIt) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    ViewerWindow window(*display, workplace, bricks);
    window.wait_for_rest();
    EXPECT_EQ(window.state()["drawn"]["beside"], 0) << "what is not compared is not drawn";
    window.key("k");
    both_sides(window);
    const Image before = display->resting_picture();
    window.key("x");
    const json swapped = window.wait_for(
        "swapped", [](const json& now) { return now["compare"]["right"] == "as it is"; });
    EXPECT_EQ(swapped["compare"]["left"], "interpolation=flat");
    EXPECT_TRUE(eventually(
        [&] { return changed_share(before, display->picture(), 600, 200, 150, 400) > 0.05; }));
    window.click_on("Scene");
    window.click_on("Effects");
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

}  // namespace
}  // namespace relief::tools
