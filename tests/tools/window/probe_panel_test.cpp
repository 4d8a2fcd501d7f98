// SPDX-License-Identifier: Apache-2.0
// The probe of the window without a window: which pixel it explains, and its figure.
#include "window/probe_panel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "shade/render/draw_support.h"
#include "support/labels.h"
#include "tools/window/display.h"
#include "tools/window/viewer_window.h"
#include "tools/workplace.h"
#include "window/probe_figure.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

using test::eventually;
using testing::IsEmpty;

/// A shiny square in front of the camera, under a light from the upper right.
Scene shiny_square(SpecularModel model) {
    Material material = test::black_material();
    material.diffuse = glm::vec3(0.5F);
    material.specular = glm::vec3(0.5F);
    material.specular_model = model;
    material.shininess = 8.0F;
    Scene scene = test::square_scene(material);
    scene.directional_lights = {{{-3, -0.0F, -4}, {1, 1, 1}}};
    return scene;
}

DrawRequest request_of(const Scene& scene, std::uint64_t revision = 1) {
    DrawRequest request;
    request.scene = std::make_shared<const Scene>(scene);
    request.revision = revision;
    request.settings.width = 33;
    request.settings.height = 33;
    request.camera = *scene.camera;
    return request;
}

/// Waits for the explanation of a pixel.
void wait_for(ProbePanel& panel, const DrawRequest& request,
              const std::optional<glm::ivec2>& pointer, const glm::ivec2& expected) {
    ASSERT_TRUE(eventually([&] {
        (void)panel.follow(request, pointer);
        return panel.result() != nullptr && panel.result()->probe.x == expected.x &&
               panel.result()->probe.y == expected.y;
    })) << expected.x
        << "," << expected.y;
}

TEST(ProbePanel, ExplainsNothingUntilItIsOn) {
    ProbePanel panel([] {});
    EXPECT_FALSE(panel.follow(request_of(shiny_square(SpecularModel::phong)), glm::ivec2(3, 3)));
    EXPECT_FALSE(panel.is_working());
    EXPECT_EQ(panel.result(), nullptr);
    panel.click({3, 3});
    EXPECT_TRUE(panel.json()["pinned"].is_null());
}

TEST(ProbePanel, FollowsThePointerUntilAClickPinsAPixel) {
    const DrawRequest request = request_of(shiny_square(SpecularModel::phong));
    ProbePanel panel([] {});
    panel.toggle();
    wait_for(panel, request, glm::ivec2(16, 16), {16, 16});
    EXPECT_GT(panel.result()->probe.radiance.r, 0.0);
    EXPECT_FALSE(panel.result()->shader);
    wait_for(panel, request, glm::ivec2(10, 12), {10, 12});
    panel.click({10, 12});
    EXPECT_TRUE(panel.follow(request, glm::ivec2(20, 20))) << "the shader's value is to be drawn";
    wait_for(panel, request, glm::ivec2(20, 20), {10, 12});
    panel.click({20, 20});
    wait_for(panel, request, glm::ivec2(20, 20), {20, 20});
    EXPECT_FALSE(panel.follow(request, std::nullopt)) << "the pointer left the picture";
    panel.toggle();
    EXPECT_EQ(panel.result(), nullptr);
}

TEST(ProbePanel, ExplainsThePixelAgainAfterAnEdit) {
    Scene scene = shiny_square(SpecularModel::phong);
    ProbePanel panel([] {});
    panel.toggle();
    wait_for(panel, request_of(scene, 1), glm::ivec2(16, 16), {16, 16});
    const double before = panel.result()->probe.radiance.r;
    scene.materials[0].diffuse = glm::vec3(1.0F);
    const DrawRequest edited = request_of(scene, 2);
    ASSERT_TRUE(eventually([&] {
        (void)panel.follow(edited, glm::ivec2(16, 16));
        return panel.result()->probe.radiance.r > before;
    }));
}

class ProbeOnTheDrawingThread : public test::DrawTest {};

TEST_F(ProbeOnTheDrawingThread, ComparesAPinnedPixelWithTheShader) {
    const DrawRequest request = request_of(shiny_square(SpecularModel::blinn_phong));
    ProbePanel panel([] {});
    panel.toggle();
    panel.click({16, 16});
    const std::optional<DrawTask> task = panel.follow(request, std::nullopt);
    ASSERT_TRUE(task);
    EXPECT_TRUE(panel.is_working());
    RenderCache cache(context());
    EXPECT_FALSE((*task)(context(), cache));
    ASSERT_TRUE(eventually([&] {
        (void)panel.follow(request, std::nullopt);
        return !panel.is_working();
    }));
    ASSERT_TRUE(panel.result()->shader);
    for (int i = 0; i < 3; ++i) {
        // Rounding to codes.
        EXPECT_NEAR(panel.result()->shader->codes[i], panel.result()->reference.codes[i], 0.51);
        EXPECT_NEAR(panel.result()->shader->linear[i], panel.result()->reference.linear[i], 1e-5);
    }
}

TEST(ProbeFigure, HasTheVectorsOfTheSurface) {
    const Scene scene = shiny_square(SpecularModel::phong);
    const Probe probe = Prober(scene, {33, 33}).at(16, 16);
    const ProbeFigure figure = figure_of(probe, *scene.camera, 1.0);
    const auto arrow = [&](const std::string& label) {
        const auto found =
            std::find_if(figure.arrows.begin(), figure.arrows.end(),
                         [&](const ProbeArrow& each) { return each.label == label; });
        EXPECT_NE(found, figure.arrows.end()) << label;
        return found == figure.arrows.end() ? ProbeArrow{} : *found;
    };
    // The middle of the picture; t points right, b up, a fifth of the height.
    constexpr float rounding = 1e-4F;
    EXPECT_NEAR(arrow("n").from.x, 0.5F, rounding);
    EXPECT_NEAR(arrow("t").to.x, 0.7F, rounding);
    EXPECT_NEAR(arrow("t").to.y, 0.5F, rounding);
    EXPECT_NEAR(arrow("b").to.y, 0.3F, rounding);
    EXPECT_GT(arrow("l").to.x, 0.55F);
    EXPECT_LT(arrow("r").to.x, 0.45F);
    EXPECT_NEAR(glm::distance(arrow("v").from, arrow("v").to), 0.0F, rounding);
    EXPECT_FALSE(figure.lobe.empty());
    for (const ProbeFacet& facet : figure.lobe) {
        for (const glm::vec2& corner : facet.corners)
            EXPECT_LT(glm::distance(corner, {0.5F, 0.5F}), 0.3F);
    }
}

TEST(ProbeFigure, OfTheBackgroundIsEmpty) {
    Scene scene = shiny_square(SpecularModel::phong);
    scene.meshes[0] = Mesh{};
    const ProbeFigure figure = figure_of(Prober(scene, {33, 33}).at(16, 16), *scene.camera, 1.0);
    EXPECT_THAT(figure.arrows, IsEmpty());
    EXPECT_THAT(figure.lobe, IsEmpty());
}

/// At the eye's direction, the lobe is the highlight's factor over its peak.
TEST(ProbeFigure, HasTheLobeOfTheHighlight) {
    for (const SpecularModel model : {SpecularModel::phong, SpecularModel::blinn_phong}) {
        const Scene scene = shiny_square(model);
        const Probe probe = Prober(scene, {33, 33}).at(16, 16);
        const auto term = std::find_if(
            probe.terms.begin(), probe.terms.end(),
            [](const ProbeTerm& each) { return each.kind == ProbeTermKind::highlight; });
        ASSERT_NE(term, probe.terms.end());
        const auto lobe = HighlightLobe::of(probe.layers[0], *term);
        ASSERT_TRUE(lobe);
        // r.v = 0.8 and n.h = sqrt(0.9).
        const double expected = model == SpecularModel::phong ? std::pow(0.8, 8) : std::pow(0.9, 4);
        EXPECT_NEAR(lobe->at({0, 0, 1}), expected, 1e-6);
        EXPECT_NEAR(lobe->at({-0.6, 0, 0.8}), 1.0, 1e-6);
        EXPECT_EQ(lobe->at({0, 0, -1}), 0.0);
    }
}

TEST(ProbeFigure, OutlinesTheFootprint) {
    ProbeLookup lookup;
    lookup.size = {100, 50};
    lookup.texel = {40, 20};
    EXPECT_THAT(footprint_outline(lookup), IsEmpty());
    lookup.texels_right = glm::dvec2(8, 0);
    lookup.texels_down = glm::dvec2(0, 4);
    float right = 0.0F, bottom = 0.0F;
    for (const glm::vec2& point : footprint_outline(lookup)) {
        right = std::max(right, point.x);
        bottom = std::max(bottom, point.y);
    }
    EXPECT_NEAR(right, 0.44F, 1e-6F);
    EXPECT_NEAR(bottom, 0.44F, 1e-6F);
}

/// The real window: the key, the pointer, a click, and the same values as --probe prints.
TEST_LABELS(window, slow);
TEST(ProbeWindow, ExplainsThePixelUnderThePointer) {
    const test::Display* const display = test::Display::of_process();
    if (display == nullptr) GTEST_SKIP() << "needs Xvfb and xdotool";
    const test::Workplace workplace;
    // Default lights would depend on the camera.
    const std::string scene = "data/vase.obj --light directional:-60,20";
    test::ViewerWindow window(*display, workplace, scene + " --camera 20,10,1.2");
    nlohmann::json state = window.wait_for_rest();
    const Image before = display->resting_picture();
    const int left = before.width - state["view"][0].get<int>();
    // On the vase, left of the panel, which covers the right half of the picture.
    const int x = left + 2 * state["view"][0].get<int>() / 5;
    constexpr int y = 330;
    EXPECT_FALSE(state["probe"]["on"].get<bool>());
    window.point_at(x, y);
    window.key("i");
    state = window.wait_for("an explained pixel", [](const nlohmann::json& now) {
        return now["probe"]["probe"].is_object();
    });
    EXPECT_TRUE(state["probe"]["pinned"].is_null());
    EXPECT_FALSE(state["probe"]["probe"]["compared"].contains("shader"));
    window.click(x, y);
    state = window.wait_for("the shader's value", [](const nlohmann::json& now) {
        return now["probe"]["probe"].is_object() &&
               now["probe"]["probe"]["compared"].contains("shader");
    });
    const nlohmann::json pinned = state["probe"]["pinned"];
    EXPECT_EQ(pinned[0], x - left);
    EXPECT_EQ(pinned[1], y);
    EXPECT_GT(test::changed_share(before, display->picture(), x - 100, y - 100, 200, 200), 0.02)
        << "no arrows";
    const test::ProgramResult printed = workplace.run(
        "relief-view " + scene + " --json --probe " + std::to_string(pinned[0].get<int>()) + "," +
        std::to_string(pinned[1].get<int>()) + " " + state["command_line"].get<std::string>());
    ASSERT_EQ(printed.exit_code, 0) << printed.error;
    const nlohmann::json expected = nlohmann::json::parse(printed.out)["probe"];
    EXPECT_EQ(state["probe"]["probe"]["terms"], expected["terms"]);
    EXPECT_EQ(state["probe"]["probe"]["compared"]["shader"], expected["compared"]["shader"]);
    window.key("i");
    window.wait_for("the end of the probe",
                    [](const nlohmann::json& now) { return !now["probe"]["on"].get<bool>(); });
}

}  // namespace
}  // namespace relief::tools
