// SPDX-License-Identifier: Apache-2.0
// Files dropped on the real window as a file manager does it. What it shows then is held against
// the picture that the same options give without a window.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

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
using test::ViewerWindow;
using test::Workplace;

bool has_effect(const json& now, const char* effect) {
    const json effects = now.value("effects", json::array());
    return std::find(effects.begin(), effects.end(), effect) != effects.end();
}

/// The share of the window's picture that is not as `relief-view WORDS --output` draws it from the
/// same camera.
double share_unlike(const Display& display, const Workplace& workplace, const json& state,
                    const std::string& words) {
    const int width = state["view"][0];
    const int height = state["view"][1];
    const test::ProgramResult drawn =
        workplace.run("relief-view " + words + " --camera 30,20 --size " + std::to_string(width) +
                      "x" + std::to_string(height) + " --output out/expected.png");
    EXPECT_EQ(drawn.exit_code, 0) << drawn.error;
    const Image expected = read_image(workplace / "out/expected.png", ImageUse::color);
    const Image screen = display.picture();
    Image view = make_image(width, height, 3, 8, ColorSpace::srgb);
    const std::span<std::uint8_t> to = view.as<std::uint8_t>();
    const std::span<const std::uint8_t> from = screen.as<std::uint8_t>();
    const int left = screen.width - width;  // The view ends at the right and begins at the top.
    for (int y = 0; y < height; ++y) {
        const auto row = static_cast<std::ptrdiff_t>(3) * (y * screen.width + left);
        std::copy_n(from.begin() + row, 3 * width, to.begin() + 3 * y * width);
    }
    return changed_share(expected, view, 0, 0, width, height);
}

TEST(Drops, AHeightMapOnAModelIsItsReliefAtOnce) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    display->act("mousemove 5 795");
    ViewerWindow window(*display, workplace, "data/vase.obj --camera 30,20");
    const json before = window.wait_for_rest();
    ASSERT_TRUE(
        test::drop_files(display->name(), {workplace / "data/bricks-height.png"}, 700, 400));
    const json after = window.wait_for(
        "the relief", [](const json& now) { return has_effect(now, "normal map"); });
    EXPECT_EQ(after["camera"], before["camera"]);
    const double as_wished = share_unlike(*display, workplace, after,
                                          "data/vase.obj --height-map data/bricks-height.png");
    EXPECT_TRUE(eventually([&] {
        return share_unlike(*display, workplace, after,
                            "data/vase.obj --height-map data/bricks-height.png") < 0.002;
    })) << as_wished;
    EXPECT_GT(share_unlike(*display, workplace, after, "data/vase.obj"), 0.05)
        << "and that differs from the plain model";
}

TEST(Drops, SixImagesAreTheFacesOfOneSky) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    display->act("mousemove 5 795");
    ViewerWindow window(*display, workplace, "data/vase.obj --camera 30,20");
    window.wait_for_rest();
    std::vector<std::filesystem::path> faces;
    for (const char* name : {"posy", "negz", "posx", "negx", "posz", "negy"})  // In no order.
        faces.push_back(workplace / "data/sky" / (std::string(name) + ".jpg"));
    ASSERT_TRUE(test::drop_files(display->name(), faces, 700, 400));
    const json after =
        window.wait_for("the sky", [](const json& now) { return has_effect(now, "skybox"); });
    EXPECT_TRUE(eventually([&] {
        return share_unlike(*display, workplace, after, "data/vase.obj --environment data/sky") <
               0.002;
    }));
}

TEST(Drops, ASceneFileTakesTheModelsPlaceWithItsOwnCamera) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    ViewerWindow window(*display, workplace, "data/vase.obj");
    window.wait_for_rest();
    const Image before = display->resting_picture();
    ASSERT_TRUE(test::drop_files(display->name(), {workplace / "data/scenes/shading-lights.json"},
                                 700, 400));
    const json after = window.wait_for("the scene", [](const json& now) {
        return now["model"].get<std::string>().ends_with("shading-lights.json");
    });
    const json file = json::parse(workplace.read("data/scenes/shading-lights.json"));
    EXPECT_EQ(after["error"], "");
    EXPECT_EQ(after["lights"].size(), file["lights"].size());
    EXPECT_NEAR(after["camera"]["fov"].get<double>(), file["camera"]["fov"].get<double>(), 1e-3);
    EXPECT_TRUE(eventually(
        [&] { return changed_share(before, display->picture(), 310, 10, 960, 760) > 0.1; }));
}

}  // namespace
}  // namespace relief::tools
