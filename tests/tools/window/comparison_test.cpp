// SPDX-License-Identifier: Apache-2.0
// Comparisons without and with a window, and the methods of the accuracy panel.
#include "window/comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "relief/mesh/image_file.h"
#include "relief/shade/image_compare.h"
#include "support/labels.h"
#include "tools/window/display.h"
#include "tools/window/viewer_window.h"
#include "tools/workplace.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

using nlohmann::json;
using test::changed_share;
using test::Display;
using test::eventually;
using test::view_on;
using test::ViewerWindow;
using test::Workplace;
using testing::HasSubstr;

class Comparing : public testing::Test {
  protected:
    Comparing() {
        workplace_.write_square("square.obj");
        workplace_.write("other.obj", "v 0 0 0\nv 9 0 0\nv 0 9 0\nf 1 2 3\n");
        state_.set_view({400, 300});
        show("square.obj");
    }

    void show(const std::string& model) {
        Loaded loaded;
        loaded.options.model = workplace_ / model;
        loaded.options.height_map = workplace_ / "data/bricks-height.png";
        if (model == "other.obj") loaded.options.height_map.reset();
        Stages silent(true);
        loaded.composed = compose_scene(loaded.options, silent, loaded.findings);
        state_.take(std::move(loaded));
    }

    /// The request with its other side, after the preparation.
    DrawRequest settled() {
        EXPECT_TRUE(eventually([&] {
            comparison_.follow(state_);
            return !comparison_.is_working();
        }));
        DrawRequest request = *state_.request();
        comparison_.add_to(request);
        return request;
    }

    [[nodiscard]] const Workplace& workplace() const { return workplace_; }
    ViewerState& state() { return state_; }
    Comparison& comparison() { return comparison_; }

  private:
    Workplace workplace_;
    ViewerState state_{ViewOptions{}};
    Comparison comparison_{CompareChoices{}, [] {}};
};

TEST_F(Comparing, IsOffAtFirst) {
    EXPECT_FALSE(comparison().is_on());
    EXPECT_FALSE(settled().beside);
    EXPECT_EQ(comparison().command_line(), "");
    comparison().toggle();
    EXPECT_TRUE(comparison().is_on());
    EXPECT_TRUE(settled().beside) << "something to begin with";
    comparison().toggle();
    EXPECT_FALSE(settled().beside);
}

TEST_F(Comparing, ShowsTheVariantWithTheSameCamera) {
    comparison().choose(Variant(Kernel::central5));
    const DrawRequest request = settled();
    ASSERT_TRUE(request.beside);
    EXPECT_EQ(request.beside->camera.world_from_view, request.camera.world_from_view);
    EXPECT_NE(request.beside->scene, request.scene);
    EXPECT_EQ(comparison().command_line(), " --compare kernel=central5 --split 0.5");
    EXPECT_EQ(comparison().left_label(), "original");
    EXPECT_EQ(comparison().right_label(), "kernel=central5");
    comparison().swap();
    EXPECT_EQ(comparison().left_label(), "kernel=central5");
}

TEST_F(Comparing, EditsOfLightsNeedNoNewPreparation) {
    comparison().choose(Variant(Kernel::central5));
    const DrawRequest before = settled();
    state().edit([](Scene& scene) { scene.exposure = 4.0F; });
    comparison().follow(state());
    EXPECT_FALSE(comparison().is_working());
    DrawRequest after = *state().request();
    comparison().add_to(after);
    ASSERT_TRUE(after.beside);
    EXPECT_EQ(after.beside->scene->exposure, 4.0F);
    EXPECT_GT(after.beside->revision, before.beside->revision);
    const auto image_of = [](const DrawRequest& request) {
        return &*std::get<Shared<Image>>(request.beside->scene->images.back().source);
    };
    EXPECT_EQ(image_of(after), image_of(before)) << "the map is shared";
}

TEST_F(Comparing, AnotherModelIsPreparedAgainAndReportsErrors) {
    comparison().choose(Variant(Kernel::central5));
    EXPECT_TRUE(settled().beside);
    show("other.obj");
    EXPECT_FALSE(settled().beside);
    EXPECT_THAT(comparison().error(), HasSubstr("no height map"));
    comparison().choose(Variant(Interpolation::flat));
    EXPECT_EQ(comparison().error(), "");
    EXPECT_TRUE(settled().beside);
}

TEST_F(Comparing, FileHasTheSameCameraWithItsOwnDepthRange) {
    comparison().choose(std::filesystem::path("none.obj"));
    EXPECT_FALSE(settled().beside);
    EXPECT_THAT(comparison().error(), HasSubstr("none.obj"));
    show("other.obj");
    comparison().choose(workplace() / "square.obj");
    const DrawRequest request = settled();
    ASSERT_TRUE(request.beside) << comparison().error();
    EXPECT_EQ(request.beside->camera.world_from_view, request.camera.world_from_view);
    EXPECT_NE(request.beside->camera.far, request.camera.far);
    EXPECT_EQ(request.beside->scene->directional_lights.size(),
              request.scene->directional_lights.size());
    EXPECT_EQ(comparison().right_label(), "square.obj");
}

TEST_F(Comparing, NumbersAreComputedWhenTheViewIsStable) {
    comparison().choose(Variant(Kernel::central5));
    settled();
    comparison().show(ComparisonView::flip);
    DrawRequest request = *state().request();
    EXPECT_TRUE(comparison().add_to(request)) << "the same view as before";
    EXPECT_FALSE(comparison().add_to(request)) << "once";
    EXPECT_TRUE(comparison().is_working());
    EXPECT_FALSE(request.instead);
    EXPECT_EQ(comparison().json()["numbers"], nullptr);
}

constexpr const char* bricks = "data/vase.obj --height-map data/bricks-height.png ";
// The center of a view that ends at 1280.
constexpr int view_width = 902;
constexpr int middle_of_line = 829;

/// Waits until both sides are drawn.
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

/// Dragging the line must not draw the scene again.
void drag_line(ViewerWindow& window, const Display& display) {
    const json before = both_sides(window);
    ASSERT_EQ(before["view"][0], view_width);
    window.point_at(640, 790);
    window.wait_for_rest();
    const Image split = display.resting_picture();
    window.drag(middle_of_line, 700, 160, 0);
    const json after = window.wait_for("a moved line", [](const json& now) {
        return std::abs(now["compare"]["split"].get<double>() - (0.5 + 160.0 / view_width)) < 2e-3;
    });
    window.point_at(640, 790);
    EXPECT_EQ(after["camera"], before["camera"]) << "a drag of the line is none of the camera";
    EXPECT_EQ(after["drawn"]["frames"], before["drawn"]["frames"]);
    Image moved;
    EXPECT_TRUE(eventually([&] {  // The state is written before the frame is visible.
        moved = display.picture();
        return changed_share(split, moved, middle_of_line + 4, 200, 150, 400) > 0.15 &&
               changed_share(split, moved, middle_of_line + 159, 200, 2, 400) == 1.0;
    }));
    EXPECT_EQ(changed_share(split, moved, 400, 60, middle_of_line - 410, 700, 0), 0.0);
    EXPECT_EQ(changed_share(split, moved, middle_of_line + 170, 60, 270, 700, 0), 0.0);
}

/// The numbers must be those of the library.
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

TEST_LABELS(window, slow);
TEST(CompareWindow, TheLineIsDraggedAndTheDifferenceIsMeasured) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    ViewerWindow window(*display, workplace, std::string(bricks) + "--compare map=none");
    drag_line(window, *display);
    show_difference(window, *display, workplace);
}

TEST_LABELS(window, slow);
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
    // The labels at the top and the line are excluded.
    const int line = static_cast<int>(std::lround(0.25 * view.width));
    EXPECT_EQ(changed_share(again, view, 0, 60, line - 3, view.height - 60, 0), 0.0);
    EXPECT_EQ(changed_share(again, view, line + 3, 60, view.width - line - 3, view.height - 60, 0),
              0.0);
}

/// A click on a method of the accuracy panel applies it.
void choose_method(ViewerWindow& window, const Display& display) {
    const json at_first = window.wait_for_rest();
    EXPECT_TRUE(at_first["accuracy"]["topics"].empty()) << "nothing is measured unasked";
    window.click_on("Scene");  // Closed, to make room.
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
    // On a fine mesh, only some pixels differ, by one code.
    EXPECT_TRUE(eventually([&] {
        const Image after = picture();
        return changed_share(before, after, 0, 0, after.width, after.height, 0) > 0.01;
    })) << "the picture shows it";
}

/// Shortcuts and the panel select the sides, swap them and end the comparison.
void choose_sides(ViewerWindow& window, const Display& display) {
    window.wait_for_rest();
    EXPECT_EQ(window.state()["drawn"]["beside"], 0) << "what is not compared is not drawn";
    window.key("k");
    both_sides(window);
    const Image before = display.resting_picture();
    window.key("x");
    const json swapped = window.wait_for(
        "swapped", [](const json& now) { return now["compare"]["right"] == "original"; });
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

TEST_LABELS(window, slow);
TEST(CompareWindow, MethodsAndSidesAreChosenInPanels) {
    RELIEF_NEEDS_DISPLAY(display);
    const Workplace workplace;
    ViewerWindow window(*display, workplace, std::string(bricks) + "--strength 24");
    choose_method(window, *display);
    choose_sides(window, *display);
}

}  // namespace
}  // namespace relief::tools
