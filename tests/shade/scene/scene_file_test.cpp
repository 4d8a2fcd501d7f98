// SPDX-License-Identifier: Apache-2.0
// Scenes from files: OBJ with MTL written here, and real models where they are at hand.
#include "relief/shade/scene_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "relief/mesh/error.h"
#include "relief/mesh/image_file.h"
#include "support/shared_data.h"

namespace relief {
namespace {

using ::testing::HasSubstr;

void write_text(const std::filesystem::path& file, const std::string& text) {
    std::ofstream(file) << text;
}

constexpr const char* two_triangles =
    "mtllib paint.mtl\n"
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "usemtl paint\nf 1/1 2/2 3/3\nusemtl glow\nf 1/1 3/3 4/4\n";

TEST(LoadScene, ReadsObjWithItsMaterials) {
    const test::TemporaryDirectory folder;
    write_text(folder / "model.obj", two_triangles);
    write_text(folder / "paint.mtl",
               "newmtl paint\nKa 0.1 0.1 0.1\nKd 0.5 0.6 0.7\nKs 0.2 0.3 0.4\nNs 40\nillum 2\n"
               "map_Kd missing.png\nnorm missing_too.png\n"
               "newmtl glow\nKe 0 0 0\nmap_Ke glow.png\nmap_bump heights.png\nd 0.5\n");
    Report report;
    const Scene scene = load_scene(folder / "model.obj", report);
    ASSERT_EQ(scene.materials.size(), 2U);
    const Material& paint = scene.materials[0];
    EXPECT_EQ(paint.name, "paint");
    EXPECT_EQ(paint.diffuse, glm::vec3(0.5F, 0.6F, 0.7F));
    EXPECT_EQ(paint.shininess, 40.0F);
    ASSERT_TRUE(paint.diffuse_texture && paint.normal_map);
    // Missing images are nobody's trouble until something shows them.
    EXPECT_EQ(std::get<std::filesystem::path>(scene.images[paint.diffuse_texture->image].source),
              folder / "missing.png");
    EXPECT_EQ(paint.normal_map->green, Green::up);
    EXPECT_EQ(scene.materials[1].emission, glm::vec3(1.0F));  // The map as it is.
    EXPECT_EQ(report.count("bump map"), 1U);
    EXPECT_EQ(report.count("transparency"), 1U);
    ASSERT_EQ(scene.meshes.size(), 1U);
    EXPECT_EQ(scene.meshes[0].normals.size(), scene.meshes[0].positions.size());
    EXPECT_TRUE(scene.meshes[0].tangents.empty());
    EXPECT_FALSE(scene.camera);
    EXPECT_TRUE(scene.directional_lights.empty());
}

TEST(LoadScene, GivesSurfacesWithoutMaterialBothSides) {
    const test::TemporaryDirectory folder;
    write_text(folder / "model.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    Report report;
    const Scene scene = load_scene(folder / "model.obj", report);
    ASSERT_EQ(scene.materials.size(), 1U);
    EXPECT_TRUE(scene.materials[0].double_sided);
    EXPECT_EQ(scene.meshes[0].material_ranges,
              (std::vector<MaterialRange>{{0, 1, std::uint32_t{0}}}));
    EXPECT_EQ(scene.meshes[0].normals[0], glm::vec3(0, 0, 1));
}

TEST(LoadScene, NamesTheFileOfWhatItCannotRead) {
    Report report;
    for (const char* file : {"/nowhere/model.obj", "/nowhere/model.glb", "/nowhere/model.xyz"}) {
        try {
            (void)load_scene(file, report);
            FAIL() << file;
        } catch (const FileError& error) {
            EXPECT_THAT(error.what(), HasSubstr(file));
        }
    }
}

}  // namespace
}  // namespace relief
