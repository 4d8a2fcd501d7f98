// SPDX-License-Identifier: Apache-2.0
// Edits of a scene that is read again, possibly with changes.
#include "window/edit_rebase.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace relief::tools {
using namespace relief::shade;

namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Material named(const std::string& name) {
    Material material;
    material.name = name;
    return material;
}

ImageSource image(const std::string& file) {
    return {file, std::filesystem::path(file)};
}

/// Two materials, the first with a normal map, and lights of each kind.
Scene as_read() {
    Scene scene;
    scene.images = {image("a.png"), image("b.png")};
    scene.materials = {named("paint"), named("metal")};
    scene.materials[0].normal_map = NormalMap{{0}, 1.0F};
    scene.materials[1].metallic_roughness.emplace();
    scene.directional_lights.resize(2);
    scene.point_lights.resize(1);
    scene.spot_lights.resize(1);
    return scene;
}

TEST(RebasedEdits, EditsStayAndOtherValuesFollowTheFile) {
    const Scene read = as_read();
    Scene edited = read;
    edited.materials[0].diffuse = {1, 0, 0};
    edited.materials[0].normal_map->scale = 2.0F;
    edited.materials[1].metallic_roughness->roughness = 0.25F;
    edited.exposure = 4.0F;
    edited.directional_lights[1].irradiance = {3, 3, 3};
    edited.spot_lights[0].point.intensity = {5, 5, 5};
    Scene fresh = read;
    // If the file and the user change a value, the edit wins.
    fresh.materials[0].diffuse = {0, 1, 0};
    fresh.materials[0].specular = {0.5F, 0.5F, 0.5F};
    fresh.materials[1].metallic_roughness->metallic = 0.0F;
    fresh.background = {0, 0, 1, 1};
    fresh.spot_lights[0].outer_cone = 0.5F;
    const RebasedEdits kept = rebase_edits(read, edited, fresh);
    EXPECT_THAT(kept.lost, IsEmpty());
    EXPECT_EQ(kept.kept, 6U);
    EXPECT_EQ(fresh.materials[0].diffuse, glm::vec3(1, 0, 0));
    EXPECT_EQ(fresh.materials[0].specular, glm::vec3(0.5F));
    EXPECT_EQ(fresh.materials[0].normal_map->scale, 2.0F);
    EXPECT_EQ(fresh.materials[1].metallic_roughness->roughness, 0.25F);
    EXPECT_EQ(fresh.materials[1].metallic_roughness->metallic, 0.0F);
    EXPECT_EQ(fresh.exposure, 4.0F);
    EXPECT_EQ(fresh.background, glm::vec4(0, 0, 1, 1));
    EXPECT_EQ(fresh.directional_lights[1].irradiance, glm::vec3(3.0F));
    EXPECT_EQ(fresh.spot_lights[0].point.intensity, glm::vec3(5.0F));
    EXPECT_EQ(fresh.spot_lights[0].outer_cone, 0.5F);
}

TEST(RebasedEdits, WithoutEditsTheFreshSceneIsUnchanged) {
    const Scene read = as_read();
    Scene fresh = read;
    fresh.materials.pop_back();
    fresh.point_lights.clear();
    fresh.exposure = 2.0F;
    const RebasedEdits kept = rebase_edits(read, read, fresh);
    EXPECT_EQ(kept.kept, 0U);
    EXPECT_THAT(kept.lost, IsEmpty());
    EXPECT_EQ(fresh.materials.size(), 1U);
    EXPECT_TRUE(fresh.point_lights.empty());
    EXPECT_EQ(fresh.exposure, 2.0F);
}

TEST(RebasedEdits, MaterialsAreFoundByName) {
    const Scene read = as_read();
    Scene edited = read;
    edited.materials[0].diffuse = {1, 0, 0};
    edited.materials[1].emission = {1, 1, 1};
    Scene fresh = read;
    fresh.materials = {named("new"), named("paint"), named("old")};
    const RebasedEdits kept = rebase_edits(read, edited, fresh);
    EXPECT_EQ(fresh.materials[1].diffuse, glm::vec3(1, 0, 0));
    EXPECT_EQ(fresh.materials[0].diffuse, glm::vec3(0.8F));
    EXPECT_EQ(fresh.materials[2].emission, glm::vec3(0.0F));
    EXPECT_THAT(kept.lost, ElementsAre(HasSubstr("material 'metal'")));
}

TEST(RebasedEdits, MaterialsWithoutANameAreFoundByTheirIndex) {
    Scene read = as_read();
    for (Material& material : read.materials)
        material.name.clear();
    Scene edited = read;
    edited.materials[1].opacity = 0.5F;
    Scene fresh = read;
    EXPECT_THAT(rebase_edits(read, edited, fresh).lost, IsEmpty());
    EXPECT_EQ(fresh.materials[1].opacity, 0.5F);
    fresh = read;
    fresh.materials.push_back({});
    EXPECT_THAT(rebase_edits(read, edited, fresh).lost, ElementsAre(HasSubstr("material 1")));
    EXPECT_EQ(fresh.materials[1].opacity, 1.0F) << "it may be another one";
}

TEST(RebasedEdits, AddedAndRemovedLightsStay) {
    const Scene read = as_read();
    Scene edited = read;
    edited.directional_lights.erase(edited.directional_lights.begin());
    edited.point_lights.push_back({.position_world = {1, 2, 3}});
    Scene fresh = read;
    EXPECT_THAT(rebase_edits(read, edited, fresh).lost, IsEmpty());
    EXPECT_EQ(fresh.directional_lights.size(), 1U);
    ASSERT_EQ(fresh.point_lights.size(), 2U);
    EXPECT_EQ(fresh.point_lights[1].position_world, glm::vec3(1, 2, 3));

    fresh = read;  // The file has other lights now, so the removed light is unknown.
    fresh.directional_lights[0].irradiance = glm::vec3(9.0F);
    fresh.point_lights.resize(3);
    const RebasedEdits kept = rebase_edits(read, edited, fresh);
    EXPECT_EQ(fresh.directional_lights.size(), 2U);
    EXPECT_EQ(fresh.point_lights.size(), 4U) << "added to whatever is there";
    EXPECT_THAT(kept.lost, ElementsAre(HasSubstr("directional lights")));
}

TEST(RebasedEdits, AddedAndRemovedMapsFollowTheirImages) {
    const Scene read = as_read();
    Scene edited = read;
    edited.materials[0].normal_map.reset();
    edited.images.push_back(image("c.png"));
    edited.materials[0].diffuse_texture = Texture{2};
    edited.materials[1].bump_map = BumpMap{{1}, 8.0F};
    Scene fresh = read;
    fresh.images = {image("b.png"), image("a.png")};  // Another order.
    fresh.materials[0].normal_map->texture.image = 1;
    EXPECT_THAT(rebase_edits(read, edited, fresh).lost, IsEmpty());
    EXPECT_FALSE(fresh.materials[0].normal_map);
    ASSERT_TRUE(fresh.materials[0].diffuse_texture);
    EXPECT_EQ(fresh.images.at(fresh.materials[0].diffuse_texture->image).name, "c.png");
    EXPECT_EQ(fresh.images.at(fresh.materials[1].bump_map->texture.image).name, "b.png");
}

TEST(RebasedEdits, AMapThatTheFileChangedIsShown) {
    const Scene read = as_read();
    Scene edited = read;
    edited.materials[0].normal_map.reset();
    Scene fresh = read;
    fresh.images[0] = image("dropped.png");
    rebase_edits(read, edited, fresh);
    ASSERT_TRUE(fresh.materials[0].normal_map);

    edited = read;
    edited.materials[0].normal_map->scale = 3.0F;
    fresh = read;
    fresh.materials[0].normal_map.reset();
    EXPECT_THAT(rebase_edits(read, edited, fresh).lost, ElementsAre(HasSubstr("material 'paint'")));
}

TEST(RebasedEdits, EnvironmentKeepsItsIntensity) {
    Scene read = as_read();
    read.environment = Environment{.source = Equirectangular{image("sky.hdr")}};
    Scene edited = read;
    edited.environment->intensity = 2.0F;
    edited.environment->skybox = false;
    Scene fresh = read;
    fresh.environment->source = Equirectangular{image("dusk.hdr")};
    EXPECT_THAT(rebase_edits(read, edited, fresh).lost, IsEmpty());
    EXPECT_EQ(fresh.environment->intensity, 2.0F);
    EXPECT_FALSE(fresh.environment->skybox);
    EXPECT_EQ(std::get<Equirectangular>(fresh.environment->source).image.name, "dusk.hdr");
    fresh.environment.reset();
    EXPECT_THAT(rebase_edits(read, edited, fresh).lost, ElementsAre(HasSubstr("the scene")));
}

}  // namespace
}  // namespace relief::tools
