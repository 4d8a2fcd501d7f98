// SPDX-License-Identifier: Apache-2.0
// The layout of the panels at several window sizes and interface scales, and input to them, in Dear
// ImGui without a window.
#include <gtest/gtest.h>
#include <imgui.h>

#include <memory>
#include <set>

#include "relief/shade/effects.h"
#include "support/shapes.h"
#include "tools/window/panel_frames.h"
#include "window/panels.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

using test::PanelFrames;

/// A scene with all kinds of lights and materials.
Scene rich_scene() {
    Scene scene;
    scene.meshes.push_back(test::cube());
    scene.instances.push_back({});
    scene.directional_lights.emplace_back();
    scene.directional_lights[0].highlight_irradiance = glm::vec3(1.0F);
    scene.point_lights.emplace_back();
    scene.spot_lights.emplace_back();
    scene.spot_lights[0].point.highlight_intensity = glm::vec3(2.0F);
    scene.spot_lights[0].point.position_world = {-12.345F, 0.5F, 100.0F};
    scene.images.push_back({"wood.png", make_image(2, 2, 3, 8, ColorSpace::srgb)});
    scene.materials.emplace_back().metallic_roughness.emplace();
    return scene;
}

/// A material of glTF all of whose groups have an effect.
Material metallic_material() {
    Material material;
    material.normal_map.emplace();
    material.occlusion_texture.emplace();
    material.emission = glm::vec3(12.5F);
    material.alpha_mode = AlphaMode::mask;
    MetallicRoughness& model = material.metallic_roughness.emplace();
    model.refractive_index = 1.4F;
    model.specular = 0.5F;
    model.clearcoat = model.anisotropy = model.iridescence = 0.5F;
    model.sheen_color = glm::vec3(0.5F);
    model.transmission = model.thickness = model.dispersion = 0.5F;
    model.attenuation_distance = 2.0F;
    return material;
}

Material phong_material() {
    Material material;
    material.specular = material.reflectivity = material.emission = glm::vec3(0.5F);
    material.bump_map.emplace();
    material.alpha_mode = AlphaMode::mask;
    return material;
}

void open_all(WindowLayout& layout) {
    for (const std::string& panel : panel_names())
        layout.open_panels[panel] = true;
}

bool overlap(const UiRectangle& a, const UiRectangle& b) {
    return a.min.x < b.max.x && b.min.x < a.max.x && a.min.y < b.max.y && b.min.y < a.max.y;
}

struct Size {
    glm::ivec2 window;
    float scale;
};

class EverySize : public testing::TestWithParam<Size> {};

/// Checks the rows of the last frame. \return their names
std::set<std::string> expect_whole_rows(float scale) {
    std::set<std::string> seen;
    for (const ProbedRow& row : probed_rows()) {
        SCOPED_TRACE(row.name);
        seen.insert(row.name);
        EXPECT_LE(row.label.max.x, row.panel.max.x + 0.5F) << "the label is cut";
        EXPECT_GE(row.label.min.x, row.panel.min.x - 0.5F);
        if (row.control.max.x == row.control.min.x) continue;  // It reports no place.
        EXPECT_FALSE(overlap(row.label, row.control)) << "the control covers the label";
        EXPECT_LE(row.control.max.x, row.panel.max.x + 0.5F) << "the control is cut";
        EXPECT_GE(row.control.max.x - row.control.min.x, 15.0F * scale);
        if (row.number_width == 0.0F) continue;
        EXPECT_FALSE(overlap(row.number, row.control)) << "the handle may cover the number";
        constexpr float rounding = 0.01F;  // Of the difference of two positions.
        EXPECT_LE(row.number_width, row.number.max.x - row.number.min.x + rounding)
            << "the number is cut";
        EXPECT_LE(row.number.max.x, row.panel.max.x + 0.5F);
        EXPECT_GT(row.control.max.x - row.control.min.x, 40.0F * scale);
    }
    return seen;
}

TEST_P(EverySize, ShowsWholeLabelsAndNumbers) {
    PanelFrames frames;
    Scene scene = rich_scene();
    scene.materials = {metallic_material()};
    frames.show(scene);
    open_all(frames.layout());
    frames.drawn().plan =
        std::make_shared<const FramePlan>(plan_effects(frames.state().scene(), FrameSettings{}));
    frames.set_size(GetParam().window, GetParam().scale);
    frames.draw();
    for (const char* light : {"Light 1", "Light 2", "Light 3"})
        frames.open_tree(light);
    frames.draw();
    std::set<std::string> seen = expect_whole_rows(GetParam().scale);
    EXPECT_LE(frames.excess_width(), 0.5F) << "something is wider than the panels";
    scene.materials = {phong_material()};
    frames.show(scene);
    frames.draw();
    seen.merge(expect_whole_rows(GetParam().scale));
    EXPECT_LE(frames.excess_width(), 0.5F);
    for (const char* name : {"Exposure", "Outer cone", "Film thickness", "Minimum film thickness",
                             "Position", "Metallic-roughness map", "Highlight color",
                             "Fresnel on highlights", "Bump map strength"})
        EXPECT_TRUE(seen.contains(name)) << name;
}

std::string size_name(const testing::TestParamInfo<Size>& info) {
    return "W" + std::to_string(info.param.window.x) + "H" + std::to_string(info.param.window.y) +
           "S" + std::to_string(static_cast<int>(100.0F * info.param.scale));
}

INSTANTIATE_TEST_SUITE_P(Layout, EverySize,
                         testing::Values(Size{{1280, 800}, 1.0F}, Size{{1280, 800}, 1.5F},
                                         Size{{1280, 800}, 2.0F}, Size{{2560, 1440}, 3.0F},
                                         Size{{840, 560}, 1.0F}, Size{{660, 500}, 1.0F},
                                         Size{{660, 500}, 1.25F}, Size{{500, 300}, 1.0F},
                                         Size{{390, 844}, 1.0F}, Size{{390, 844}, 1.5F}),
                         size_name);

TEST(PanelArrangementTest, SmallWindowsBelongToThePicture) {
    constexpr float letter = 14.0F;
    const PanelArrangement wide = arrange_panels({1280.0F, 800.0F}, letter);
    EXPECT_FALSE(wide.is_folded);
    EXPECT_EQ(wide.width, 27.0F * letter);
    EXPECT_FALSE(arrange_panels({660.0F, 500.0F}, letter).is_folded);
    EXPECT_TRUE(arrange_panels({640.0F, 500.0F}, letter).is_folded);
    const PanelArrangement small = arrange_panels({500.0F, 300.0F}, letter);
    EXPECT_TRUE(small.is_folded);
    EXPECT_FALSE(small.is_below);
    EXPECT_LE(small.width, 300.0F);
    const PanelArrangement high = arrange_panels({390.0F, 844.0F}, letter);
    EXPECT_TRUE(high.is_folded);
    EXPECT_TRUE(high.is_below);
    EXPECT_EQ(high.width, 390.0F);
    EXPECT_LT(high.height, 0.5F * 844.0F);
    EXPECT_TRUE(arrange_panels({1280.0F, 800.0F}, 2.0F * letter).is_folded) << "at twice the scale";
}

TEST(SmallWindow, LeavesMostOfItselfToThePictureUntilPanelsAreOpened) {
    PanelFrames frames;
    frames.show(rich_scene());
    for (const glm::ivec2 size : {glm::ivec2(500, 300), glm::ivec2(390, 844)}) {
        SCOPED_TRACE(size.x);
        frames.set_size(size);
        frames.are_open = false;
        frames.draw();
        EXPECT_EQ(frames.space().left, 0.0F);
        EXPECT_EQ(frames.space().bottom, 0.0F);
        EXPECT_LT(frames.space().toolbar.y, 0.15F * static_cast<float>(size.y));
        EXPECT_LE(frames.space().toolbar.x, static_cast<float>(size.x));
        EXPECT_FALSE(frames.has("Lights"));
        const PanelRequests requests = frames.click("Panels");
        ASSERT_EQ(requests.actions.size(), 1U);
        EXPECT_EQ(requests.actions[0], Action::panels);
        frames.are_open = true;
        frames.draw();
        EXPECT_TRUE(frames.has("Lights"));
        EXPECT_LE(frames.space().left, 0.6F * static_cast<float>(size.x));
        EXPECT_LE(frames.space().bottom, 0.45F * static_cast<float>(size.y));
    }
}

TEST(SmallWindow, HasAMenuIfTheButtonsDoNotFit) {
    PanelFrames frames;
    frames.set_size({390, 844}, 2.0F);
    frames.are_open = false;
    frames.draw();
    EXPECT_FALSE(frames.has("Open..."));
    EXPECT_LE(frames.space().toolbar.x, 390.0F);
    frames.click("Menu");
    const PanelRequests requests = frames.click("Open a model, a scene or a map");
    ASSERT_EQ(requests.actions.size(), 1U);
    EXPECT_EQ(requests.actions[0], Action::open);
}

TEST(SliderNumber, IsTypedAfterAClickOnIt) {
    PanelFrames frames;
    frames.show(rich_scene());
    frames.layout().open_panels = {{"Scene", false}, {"Picture", true}};
    frames.draw();
    const auto row_of = [](const std::string& name) {
        for (const ProbedRow& row : probed_rows()) {
            if (row.name == name) return row;
        }
        ADD_FAILURE() << "no row " << name;
        return ProbedRow{};
    };
    const UiRectangle number = row_of("Exposure").number;
    EXPECT_EQ(frames.state().scene().exposure, 1.0F);
    frames.click(0.5F * (number.min + number.max));
    frames.draw();
    EXPECT_TRUE(ImGui::GetIO().WantTextInput);
    frames.type("2");
    frames.press(ImGuiKey_Enter);
    EXPECT_FLOAT_EQ(frames.state().scene().exposure, 4.0F) << "two stops";
}

TEST(LightRowsOfPanel, HaveDifferentNames) {
    Scene scene = rich_scene();
    scene.directional_lights.clear();
    scene.point_lights.clear();
    PanelFrames frames;
    frames.show(scene);
    frames.layout().open_panels = {{"Scene", false}, {"Lights", true}};
    frames.draw();
    frames.open_tree("Light 1");
    frames.draw();
    std::set<std::string> names;
    bool is_in_light = false;
    for (const ProbedRow& row : probed_rows()) {
        is_in_light |= row.name == "Kind";
        if (!is_in_light) continue;
        EXPECT_TRUE(names.insert(row.name).second) << row.name;
    }
    EXPECT_TRUE(names.contains("Highlight intensity"));
    EXPECT_TRUE(names.contains("Intensity"));
}

TEST(MaterialGroupsOfPanel, WithoutEffectAreFoldedAndSaySo) {
    Scene scene = rich_scene();
    PanelFrames frames;
    frames.set_size({1280, 1600});
    frames.show(scene);
    frames.layout().open_panels = {{"Scene", false}, {"Materials", true}};
    frames.draw();
    EXPECT_LE(probed_rows().size(), 10U) << "there were 28";
    for (const char* group :
         {"Relief", "Occlusion", "Emission", "Transparency", "Refraction", "Specular", "Clearcoat",
          "Sheen", "Anisotropy", "Iridescence", "Transmission", "Volume", "Dispersion"})
        EXPECT_TRUE(frames.has(std::string("group ") + group + " has no effect")) << group;
    const std::size_t rows = probed_rows().size();
    frames.click("group Clearcoat");
    frames.draw();
    EXPECT_TRUE(frames.has("Clearcoat roughness"));
    EXPECT_TRUE(frames.has("browse Clearcoat normal map"));
    EXPECT_EQ(probed_rows().size(), rows + 5);
    scene.materials[0].metallic_roughness->clearcoat = 0.5F;
    frames.show(scene);
    frames.draw();
    EXPECT_TRUE(frames.has("Clearcoat roughness")) << "it starts open";
    EXPECT_FALSE(frames.has("group Clearcoat has no effect"));
    EXPECT_TRUE(frames.has("group Sheen has no effect"));
}

TEST(Waiting, ShowsTheStageAndCanBeCancelled) {
    PanelFrames frames;
    ViewOptions options;
    options.model = "far/away/castle.glb";
    frames.loading = &options;
    frames.progress = {"images", 0.25};
    frames.draw();
    EXPECT_TRUE(frames.has("waiting"));
    EXPECT_EQ(stage_title("images"), "reading images");
    EXPECT_TRUE(frames.click("Cancel waiting").cancel_loading);
    frames.loading = nullptr;
    frames.is_drawing = true;
    frames.progress = {"programs", {}};
    frames.draw();
    EXPECT_TRUE(frames.has("waiting"));
    EXPECT_EQ(stage_title("programs"), "compiling shaders");
    frames.is_drawing = false;
    frames.draw();
    EXPECT_FALSE(frames.has("waiting"));
}

TEST(HelpWindowTest, ListsGroupsAndSearches) {
    PanelFrames frames;
    frames.help().toggle();
    frames.draw();
    for (const char* group : {"group Camera", "group Picture", "group Editing", "group Files"})
        EXPECT_TRUE(frames.has(group)) << group;
    EXPECT_TRUE(frames.has("shortcut Left"));
    frames.help().focus_search();
    frames.draw();
    frames.type("EXPOSURE");
    frames.draw();
    EXPECT_TRUE(frames.has("shortcut Ctrl+Up"));
    EXPECT_TRUE(frames.has("group Picture"));
    EXPECT_FALSE(frames.has("shortcut Left"));
    EXPECT_FALSE(frames.has("group Camera"));
}

TEST(HelpWindowTest, FitsIntoSmallWindows) {
    PanelFrames frames;
    frames.help().toggle();
    for (const glm::ivec2 size : {glm::ivec2(500, 300), glm::ivec2(390, 844)}) {
        frames.set_size(size);
        frames.draw();
        const glm::vec2 first = frames.place("shortcut F");
        EXPECT_GT(first.x, 0.0F);
        EXPECT_LT(first.x, static_cast<float>(size.x));
    }
}

}  // namespace
}  // namespace relief::tools
