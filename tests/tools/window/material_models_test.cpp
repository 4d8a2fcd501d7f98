// SPDX-License-Identifier: Apache-2.0
#include "window/material_models.h"

#include <gtest/gtest.h>

#include "relief/shade/scene_file.h"

namespace relief::tools {
namespace {

TEST(MaterialModels, ArePhongMetallicRoughnessOrUnlitWhateverCameBefore) {
    for (const MaterialModel from :
         {MaterialModel::phong, MaterialModel::metallic_roughness, MaterialModel::unlit}) {
        for (const MaterialModel to :
             {MaterialModel::phong, MaterialModel::metallic_roughness, MaterialModel::unlit}) {
            Material material;
            set_model(material, from);
            set_model(material, to);
            EXPECT_EQ(model_of(material), to);
        }
    }
}

TEST(MaterialModels, ShininessAndRoughnessAreEachOthersInverse) {
    for (const float shininess : {2.0F, 32.0F, 500.0F}) {
        Material material;
        material.shininess = shininess;
        set_model(material, MaterialModel::metallic_roughness);
        GltfMaterial same;
        same.roughness = material.metallic_roughness->roughness;
        EXPECT_NEAR(phong_from_metallic_roughness(same, {}).shininess, shininess,
                    1e-3F * shininess);
    }
    Material sharp;
    sharp.shininess = 1e6F;
    set_model(sharp, MaterialModel::metallic_roughness);
    EXPECT_GE(sharp.metallic_roughness->roughness, 0.03F);
    EXPECT_LE(sharp.metallic_roughness->roughness, 0.05F);
}

TEST(MaterialModels, ThereAndBackIsTheSameMaterial) {
    Material material;
    material.diffuse = {0.2F, 0.4F, 0.6F};
    material.shininess = 77.0F;
    set_model(material, MaterialModel::metallic_roughness);
    EXPECT_EQ(material.metallic_roughness->base_color, material.diffuse);
    set_model(material, MaterialModel::phong);
    EXPECT_FALSE(material.metallic_roughness);
    EXPECT_EQ(material.diffuse, glm::vec3(0.2F, 0.4F, 0.6F));
    EXPECT_EQ(material.shininess, 77.0F);
}

TEST(MaterialModels, TheDefaultMaterialGetsAPlaceWhereItIsUsed) {
    Mesh bare;
    bare.triangles.resize(2);
    Mesh half;
    half.triangles.resize(3);
    half.material_ranges = {{0, 1, 0U}, {1, 2, std::nullopt}};
    Scene scene;
    scene.materials.resize(1);
    EXPECT_FALSE(uses_default_material(scene));
    name_default_material(scene);
    EXPECT_EQ(scene.materials.size(), 1U) << "nobody uses it";
    scene.meshes = {bare, half, Mesh{}};
    EXPECT_TRUE(uses_default_material(scene));
    const Scene before = scene;
    name_default_material(scene);
    EXPECT_FALSE(uses_default_material(scene));
    ASSERT_EQ(scene.materials.size(), 2U);
    EXPECT_EQ(scene.meshes[0]->material_ranges[0].material, 1U);
    EXPECT_EQ(scene.meshes[0]->material_ranges[0].triangle_count, 2U);
    EXPECT_EQ(scene.meshes[1]->material_ranges[0].material, 0U);
    EXPECT_EQ(scene.meshes[1]->material_ranges[1].material, 1U);
    EXPECT_TRUE(scene.meshes[2]->material_ranges.empty());
    EXPECT_TRUE(before.meshes[0]->material_ranges.empty()) << "the copy has what it had";
}

}  // namespace
}  // namespace relief::tools
