// SPDX-License-Identifier: Apache-2.0
#include "window/dropped_files.h"

#include <gtest/gtest.h>

namespace relief::tools {
namespace {

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
    const ViewOptions with_height = with_dropped(options, "b-height.png");
    EXPECT_EQ(with_height.height_map, "b-height.png");
    EXPECT_FALSE(with_height.normal_map);
    EXPECT_EQ(with_height.model, "a.obj");
    const ViewOptions with_normals = with_dropped(with_height, "c-normal.png");
    EXPECT_FALSE(with_normals.height_map);
    EXPECT_EQ(with_normals.normal_map, "c-normal.png");
    EXPECT_EQ(with_dropped(options, "b.glb").model, "b.glb");
}

}  // namespace
}  // namespace relief::tools
