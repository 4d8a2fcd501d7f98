// SPDX-License-Identifier: Apache-2.0
// Files dropped on the real window as a file manager does it. What it shows then is held against
// the picture that the same options give without a window.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "relief/mesh/image_file.h"
#include "tools/window/drag_and_drop.h"
#include "tools/window/viewer_window.h"

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

/// What `relief-view WORDS --output` draws of the same view.
Image expected_view(const Workplace& workplace, const json& state, const std::string& words) {
    const test::ProgramResult drawn =
        workplace.run("relief-view " + words + " --output out/expected.png " +
                      state["command_line"].get<std::string>());
    EXPECT_EQ(drawn.exit_code, 0) << drawn.error;
    return read_image(workplace / "out/expected.png", ImageUse::color);
}

/// The share of the window's picture that differs from this one.
double share_unlike(const Display& display, const json& state, const Image& expected) {
    const Image view = test::view_on(display.picture(), state["view"]);
    return changed_share(expected, view, 0, 0, view.width, view.height);
}

/// A height map on a model is its relief at once.
void drop_height_map(ViewerWindow& window, const Display& display, const Workplace& workplace) {
    const json before = window.wait_for_rest();
    ASSERT_TRUE(test::drop_files(display.name(), {workplace / "data/bricks-height.png"}, 700, 400));
    const json after = window.wait_for(
        "the relief", [](const json& now) { return has_effect(now, "normal map"); });
    EXPECT_EQ(after["camera"], before["camera"]);
    const Image expected =
        expected_view(workplace, after, "data/vase.obj --height-map data/bricks-height.png");
    EXPECT_TRUE(eventually([&] { return share_unlike(display, after, expected) < 0.002; }));
    EXPECT_GT(share_unlike(display, after, expected_view(workplace, after, "data/vase.obj")), 0.05)
        << "and that differs from the plain model";
}

/// Six images are the faces of one sky.
void drop_faces(ViewerWindow& window, const Display& display, const Workplace& workplace) {
    std::vector<std::filesystem::path> faces;
    for (const char* name : {"posy", "negz", "posx", "negx", "posz", "negy"})  // In no order.
        faces.push_back(workplace / "data/sky" / (std::string(name) + ".jpg"));
    ASSERT_TRUE(test::drop_files(display.name(), faces, 700, 400));
    const json after =
        window.wait_for("the sky", [](const json& now) { return has_effect(now, "skybox"); });
    const Image expected =
        expected_view(workplace, after,
                      "data/vase.obj --height-map data/bricks-height.png --environment data/sky");
    EXPECT_TRUE(eventually([&] { return share_unlike(display, after, expected) < 0.002; }));
}

/// A scene file replaces the model and brings its own camera.
void drop_scene(ViewerWindow& window, const Display& display, const Workplace& workplace,
                const std::string& name) {
    const Image before = display.resting_picture();
    ASSERT_TRUE(test::drop_files(display.name(), {workplace / "data/scenes" / name}, 700, 400));
    const json after = window.wait_for("the scene", [&](const json& now) {
        return now["model"].get<std::string>().ends_with(name);
    });
    const json file = json::parse(workplace.read("data/scenes/" + name));
    EXPECT_EQ(after["error"], "");
    EXPECT_EQ(after["lights"].size(), file["lights"].size());
    EXPECT_NEAR(after["camera"]["fov"].get<double>(), file["camera"]["fov"].get<double>(), 1e-3);
    EXPECT_TRUE(eventually(
        [&] { return changed_share(before, display.picture(), 310, 10, 960, 760) > 0.1; }));
}

/// What is hidden in the scene's tree is not drawn.
void hide_and_show(ViewerWindow& window, const Display& display) {
    window.click_on("Effects");  // Closed, to make room.
    const json state = window.wait_for_rest();
    EXPECT_EQ(state["shown"], json({3, 3}));
    window.click_on("tree");
    const auto click = [&](int shown) {
        const Image before = display.resting_picture();
        window.click_on("show normal map");
        const json now = window.wait_for("other things", [&](const json& seen) {
            return seen["shown"] == json({shown, 3});
        });
        EXPECT_TRUE(eventually([&] {
            return changed_share(before, display.picture(), 310, 10, 960, 760, 2) > 0.005;
        }));
        return now;
    };
    EXPECT_FALSE(has_effect(click(2), "normal map")) << "what it alone needs is not there either";
    EXPECT_EQ(click(3)["effects"], state["effects"]);
}

TEST(Drops, ScenesModelsMapsAndFacesAreShown) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    ViewerWindow window(*display, workplace, "data/vase.obj");
    window.wait_for_rest();
    drop_scene(window, *display, workplace, "shading-lights.json");
    drop_scene(window, *display, workplace, "shading-bump.json");
    hide_and_show(window, *display);
    ASSERT_TRUE(test::drop_files(display->name(), {workplace / "data/vase.obj"}, 700, 400));
    window.wait_for("the model", [](const json& now) {
        return now["model"].get<std::string>().ends_with("vase.obj");
    });
    drop_height_map(window, *display, workplace);
    drop_faces(window, *display, workplace);
}

}  // namespace
}  // namespace relief::tools
