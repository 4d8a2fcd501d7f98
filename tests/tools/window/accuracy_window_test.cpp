// SPDX-License-Identifier: Apache-2.0
// The accuracy panel in the real window: measured on demand, a click takes a method.
#include <gtest/gtest.h>

#include "tools/window/viewer_window.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::changed_share;
using test::eventually;
using test::view_on;
using test::ViewerWindow;
using test::Workplace;

bool is_used(const json& state, const std::string& use) {
    for (const json& topic : state["accuracy"]["topics"]) {
        for (const json& method : topic["methods"]) {
            if (method["use"] == use) return method["used"];
        }
    }
    return false;
}

TEST(AccuracyWindow, AClickOnAMethodTakesItAndThePictureFollows) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    ViewerWindow window(*display, workplace,
                        "data/vase.obj --height-map data/bricks-height.png --strength 24");
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
    const auto picture = [&] { return view_on(display->picture(), window.state()["view"]); };
    const Image before = view_on(display->resting_picture(), window.state()["view"]);

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

}  // namespace
}  // namespace relief::tools
