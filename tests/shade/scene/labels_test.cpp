// SPDX-License-Identifier: Apache-2.0
// Names where there are some, numbers where there are none.
#include "relief/shade/labels.h"

#include <gtest/gtest.h>

namespace relief {
namespace {

TEST(Labels, AreNamesOrElseNumbers) {
    Scene scene;
    scene.materials.resize(2);
    scene.materials[0].name = "paint";
    scene.meshes.resize(2);
    scene.meshes[0].edit().name = "Wheel";
    scene.instances = {{0, glm::mat4(1.0F), "left"}, {0, glm::mat4(1.0F), ""}, {1, {}, ""}};
    EXPECT_EQ(material_label(scene, 0), "material 'paint'");
    EXPECT_EQ(material_label(scene, 1), "material 1");
    EXPECT_EQ(material_label(scene, std::nullopt), "the default material");
    EXPECT_EQ(mesh_label(scene, 0), "mesh 'Wheel'");
    EXPECT_EQ(mesh_label(scene, 1), "mesh 1");
    EXPECT_EQ(instance_label(scene, 0), "instance 'left'");
    EXPECT_EQ(instance_label(scene, 1), "mesh 'Wheel'");
    EXPECT_EQ(instance_label(scene, 2), "instance 2");
}

TEST(Labels, OfWhatIsNotThereAreNumbers) {
    EXPECT_EQ(material_label(Scene{}, 7), "material 7");
    EXPECT_EQ(instance_label(Scene{}, 7), "instance 7");
    EXPECT_EQ(mesh_label(Scene{}, 7), "mesh 7");
}

}  // namespace
}  // namespace relief
