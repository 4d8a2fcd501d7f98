// SPDX-License-Identifier: Apache-2.0
#include "window/dropped_files.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace relief::tools {
namespace {

using Files = std::vector<std::filesystem::path>;

TEST(DroppedFiles, AreTakenForWhatTheirNamesSay) {
    EXPECT_EQ(dropped_as("a/Helmet.GLB"), DroppedAs::model);
    EXPECT_EQ(dropped_as("scene.json"), DroppedAs::model);
    EXPECT_EQ(dropped_as("bricks_Normal-ogl.png"), DroppedAs::normal_map);
    EXPECT_EQ(dropped_as("bricks_n.png"), DroppedAs::normal_map);
    EXPECT_EQ(dropped_as("bricks-height.png"), DroppedAs::height_map);
    EXPECT_EQ(dropped_as("bricks_h.tif"), DroppedAs::height_map);
    EXPECT_EQ(dropped_as("Displacement.exr"), DroppedAs::height_map);
    EXPECT_EQ(dropped_as("studio.hdr"), DroppedAs::environment);
    EXPECT_EQ(dropped_as("sky.png"), DroppedAs::environment);
    EXPECT_EQ(dropped_as("bricks.png"), DroppedAs::diffuse_map);
    EXPECT_EQ(dropped_as("green.png"), DroppedAs::diffuse_map);
}

TEST(DroppedFiles, AMapTakesThePlaceOfItsKind) {
    ViewOptions options;
    options.model = "a.obj";
    options.normal_map = "old.png";
    const ViewOptions with_height = with_dropped(options, {"b-height.png"});
    EXPECT_EQ(with_height.height_map, "b-height.png");
    EXPECT_FALSE(with_height.normal_map);
    EXPECT_EQ(with_height.model, "a.obj");
    const ViewOptions with_normals = with_dropped(with_height, {"c-normal.png"});
    EXPECT_FALSE(with_normals.height_map);
    EXPECT_EQ(with_normals.normal_map, "c-normal.png");
    EXPECT_EQ(with_dropped(options, {"b.glb"}).model, "b.glb");
}

TEST(DroppedFiles, TogetherTheyAllShow) {
    const ViewOptions all = with_dropped({}, {"b.glb", "b_n.png", "b.png", "studio.hdr"});
    EXPECT_EQ(all.model, "b.glb");
    EXPECT_EQ(all.normal_map, "b_n.png");
    EXPECT_EQ(all.diffuse_map, "b.png");
    EXPECT_EQ(all.environment, Files{"studio.hdr"});
}

TEST(DroppedFiles, SixImagesAreACube) {
    const Files faces{"s_posx.png", "s_negx.png", "s_posy.png",
                      "s_negy.png", "s_posz.png", "s_negz.png"};
    Files sorted = faces;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(with_dropped({}, sorted).environment, faces);
    EXPECT_EQ(with_dropped(
                  {}, {"Back.png", "Bottom.png", "Front.png", "Left.png", "Right.png", "Top.png"})
                  .environment,
              (Files{"Right.png", "Left.png", "Top.png", "Bottom.png", "Front.png", "Back.png"}));
    EXPECT_EQ(with_dropped({}, {"6.png", "2.png", "3.png", "4.png", "5.png", "1.png"}).environment,
              (Files{"1.png", "2.png", "3.png", "4.png", "5.png", "6.png"}));
}

}  // namespace
}  // namespace relief::tools
