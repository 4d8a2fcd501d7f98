// SPDX-License-Identifier: Apache-2.0
// A view that is copied from the real window, drawn without one, and pasted again.
#include <gtest/gtest.h>

#include "relief/mesh/image_file.h"
#include "relief/shade/image_compare.h"
#include "tools/window/viewer_window.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::ViewerWindow;
using test::Workplace;

TEST(ViewText, DrawsTheSamePixelsWithoutAWindow) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    display->act("mousemove 5 795");  // The pointer is on the screen, and not in the file.
    ViewerWindow window(*display, workplace, "data/vase.obj");
    window.wait_for_rest();
    window.drag(700, 300, 90, 35);
    window.drag(800, 400, 40, -25, 2);
    window.key("bracketleft");
    display->act("mousemove 900 200 click 4 click 4 mousemove 5 795");
    const json moved = window.wait_for("all moves", [](const json& now) {
        return now["camera"]["fov"] < 35.0 && now["camera"]["distance"] < 3.0;
    });
    window.wait_for("the whole picture", [](const json& now) { return now["drawn"]["whole"]; });
    const auto text = moved["command_line"].get<std::string>();
    const test::ProgramResult result =
        workplace.run("relief-view data/vase.obj --output again.png " + text);
    ASSERT_EQ(result.exit_code, 0) << result.error;
    const Image again = read_image(workplace / "again.png", ImageUse::color);
    const Image shown = test::view_on(display->resting_picture(), moved["view"]);
    EXPECT_EQ(compare(again, shown).differing_pixels, 0U) << text;
}

TEST(ViewText, IsCopiedAndPastedByKeys) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    ViewerWindow window(*display, workplace, "data/vase.obj");
    const json before = window.wait_for_rest();
    window.drag(700, 300, 90, 35);
    const json turned = window.wait_for("turned", [&](const json& now) {
        return now["camera"]["elevation"] != before["camera"]["elevation"];
    });
    window.key("ctrl+c");
    window.key("1");
    window.wait_for("front", [](const json& now) { return now["camera"]["azimuth"] == 0.0; });
    window.key("ctrl+v");
    const json again =
        window.wait_for("pasted", [](const json& now) { return now["camera"]["azimuth"] != 0.0; });
    EXPECT_EQ(again["camera"], turned["camera"]);
    EXPECT_EQ(again["error"], "");
}

}  // namespace
}  // namespace relief::tools
