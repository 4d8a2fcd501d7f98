// SPDX-License-Identifier: Apache-2.0
#include "window/edit_panels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "relief/mesh/image_file.h"
#include "relief/mesh/map_description.h"
#include "relief/mesh/report.h"
#include "relief/shade/scene_file.h"
#include "tools/workplace.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

using test::Workplace;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(MaterialModels, CanBeChangedToEachOther) {
    for (const ShadingModel from :
         {ShadingModel::phong, ShadingModel::metallic_roughness, ShadingModel::unlit}) {
        for (const ShadingModel to :
             {ShadingModel::phong, ShadingModel::metallic_roughness, ShadingModel::unlit}) {
            Material material;
            set_model(material, from);
            set_model(material, to);
            EXPECT_EQ(model_of(material), to);
        }
    }
}

TEST(MaterialModels, ShininessAndRoughnessAreInverse) {
    for (const float shininess : {2.0F, 32.0F, 500.0F}) {
        Material material;
        material.shininess = shininess;
        set_model(material, ShadingModel::metallic_roughness);
        GltfMaterial same;
        same.metallic_roughness->roughness = material.metallic_roughness->roughness;
        EXPECT_NEAR(phong_from_metallic_roughness(same, {}).shininess, shininess,
                    1e-3F * shininess);
    }
    Material sharp;
    sharp.shininess = 1e6F;
    set_model(sharp, ShadingModel::metallic_roughness);
    EXPECT_GE(sharp.metallic_roughness->roughness, 0.03F);
    EXPECT_LE(sharp.metallic_roughness->roughness, 0.05F);
}

TEST(MaterialModels, RoundTripKeepsTheMaterial) {
    Material material;
    material.diffuse = {0.2F, 0.4F, 0.6F};
    material.shininess = 77.0F;
    set_model(material, ShadingModel::metallic_roughness);
    EXPECT_EQ(material.metallic_roughness->base_color, material.diffuse);
    set_model(material, ShadingModel::phong);
    EXPECT_FALSE(material.metallic_roughness);
    EXPECT_EQ(material.diffuse, glm::vec3(0.2F, 0.4F, 0.6F));
    EXPECT_EQ(material.shininess, 77.0F);
}

TEST(MaterialModels, DefaultMaterialIsAddedIfItIsUsed) {
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

TextureSlot slot_named(const std::string& title) {
    for (const TextureSlotInfo& info : texture_slots) {
        if (map_title(info.slot) == title) return info.slot;
    }
    throw std::runtime_error("no map " + title);
}

class MapSlots : public testing::Test {
  protected:
    MapSlots() { scene_.materials.resize(2); }
    [[nodiscard]] std::filesystem::path heights() const {
        return workplace_ / "data/bricks-height.png";
    }
    [[nodiscard]] std::filesystem::path colors() const {
        return workplace_ / "data/bricks-diffuse.png";
    }
    [[nodiscard]] std::filesystem::path normals() const {
        return workplace_ / "data/scenes/bricks-normal.png";
    }
    /// A file of the kind that the slot accepts.
    [[nodiscard]] std::filesystem::path file_for(TextureSlot slot) const {
        const bool has_normals =
            slot == TextureSlot::normal || slot == TextureSlot::clearcoat_normal;
        return has_normals ? normals() : colors();
    }
    Scene& scene() { return scene_; }
    Workplace& workplace() { return workplace_; }

  private:
    Workplace workplace_;
    Scene scene_;
};

TEST_F(MapSlots, CanBeSetAndCleared) {
    Material& material = scene().materials[0];
    material.metallic_roughness.emplace();
    for (const TextureSlotInfo& info : texture_slots) {
        EXPECT_FALSE(map_name(scene(), 0, info.slot)) << info.name;
        if (info.slot == TextureSlot::cones) material.height_map.emplace();
        set_map(scene(), 0, info.slot, file_for(info.slot));
        EXPECT_EQ(map_name(scene(), 0, info.slot), file_for(info.slot).string()) << info.name;
        EXPECT_TRUE(is_map_used(material, info.slot) || info.slot == TextureSlot::specular);
        EXPECT_FALSE(map_name(scene(), 1, info.slot)) << info.name << " of the other one";
        remove_texture(material, info.slot);
        EXPECT_FALSE(map_name(scene(), 0, info.slot)) << info.name;
    }
    EXPECT_EQ(scene().images.size(), 2U) << "one file is one image";
    EXPECT_NO_THROW(validate(scene()));
}

TEST_F(MapSlots, NormalMapAndBumpMapReplaceEachOther) {
    Material& material = scene().materials[0];
    set_map(scene(), 0, slot_named("Bump map"), heights());
    material.bump_map->strength = 5.0F;
    set_map(scene(), 0, slot_named("Bump map"), colors());
    EXPECT_EQ(material.bump_map->strength, 5.0F) << "another image as strong";
    set_map(scene(), 0, slot_named("Normal map"), normals());
    EXPECT_FALSE(material.bump_map);
    material.normal_map->scale = 2.0F;
    material.normal_map->flat = FlatCode::middle;
    std::filesystem::copy_file(normals(), workplace() / "other.png");
    set_map(scene(), 0, slot_named("Normal map"), workplace() / "other.png");
    EXPECT_EQ(material.normal_map->scale, 2.0F);
    EXPECT_FALSE(material.normal_map->flat) << "told by the image again";
    set_map(scene(), 0, slot_named("Bump map"), heights());
    EXPECT_FALSE(material.normal_map);
    EXPECT_NO_THROW(validate(scene()));
}

TEST_F(MapSlots, RejectMapsOfAnotherKind) {
    Material& material = scene().materials[0];
    set_map(scene(), 0, slot_named("Normal map"), normals());
    EXPECT_THAT([&] { set_map(scene(), 0, slot_named("Normal map"), colors()); },
                ThrowsMessage<FileError>(HasSubstr("is not a normal map: its texels are colors")));
    EXPECT_EQ(map_name(scene(), 0, slot_named("Normal map")), normals().string());
    EXPECT_THAT([&] { set_map(scene(), 0, slot_named("Bump map"), normals()); },
                ThrowsMessage<FileError>(HasSubstr("normal map")));
    EXPECT_FALSE(material.bump_map);
    set_map(scene(), 0, slot_named("Bump map"), normals(), {MapKind::height});
    EXPECT_TRUE(material.bump_map) << "the kind is assumed";
    // The metadata of the file hold.
    const std::filesystem::path down = workplace() / "down.png";
    write_image(down, read_image(normals(), ImageUse::data),
                write_description({.kind = MapKind::object_normal, .green = Green::down}, 8));
    set_map(scene(), 0, slot_named("Normal map"), down);
    EXPECT_EQ(material.normal_map->green, Green::down);
    EXPECT_EQ(material.normal_map->space, NormalSpace::object);
    EXPECT_THROW(set_map(scene(), 0, slot_named("Diffuse map"), down), FileError);
}

TEST_F(MapSlots, KeepTheWrapMode) {
    const TextureSlot slot = slot_named("Diffuse map");
    set_map(scene(), 0, slot, colors());
    scene().materials[0].diffuse_texture->wrap_u = Wrap::clamp;
    std::filesystem::copy_file(colors(), workplace() / "other.png");
    set_map(scene(), 0, slot, workplace() / "other.png");
    EXPECT_EQ(scene().materials[0].diffuse_texture->wrap_u, Wrap::clamp);
    EXPECT_EQ(scene().materials[0].diffuse_texture->wrap_v, Wrap::repeat);
}

TEST_F(MapSlots, RejectInvalidImages) {
    workplace().write("words.png", "no image");
    const TextureSlot slot = slot_named("Diffuse map");
    set_map(scene(), 0, slot, colors());
    EXPECT_THROW(set_map(scene(), 0, slot, workplace() / "words.png"), FileError);
    EXPECT_THROW(set_map(scene(), 0, slot, workplace() / "absent.png"), FileError);
    EXPECT_EQ(map_name(scene(), 0, slot), colors().string());
    EXPECT_THAT([&] { set_map(scene(), 0, slot_named("Normal map"), heights()); },
                ThrowsMessage<InvalidInput>(HasSubstr(
                    "a normal map has 3 or 4 channels, not 1; a height map is a \"Bump map\"")));
    EXPECT_FALSE(scene().materials[0].normal_map);
}

TEST_F(MapSlots, DependOnTheMaterialModel) {
    Material phong;
    Material metallic;
    metallic.metallic_roughness.emplace();
    Material unlit;
    unlit.unlit = true;
    EXPECT_TRUE(is_map_used(phong, slot_named("Specular map")));
    EXPECT_FALSE(is_map_used(metallic, slot_named("Specular map")));
    EXPECT_TRUE(is_map_used(metallic, slot_named("Metallic-roughness map")));
    EXPECT_FALSE(is_map_used(phong, slot_named("Metallic-roughness map")));
    EXPECT_TRUE(is_map_used(metallic, slot_named("Clearcoat map")));
    EXPECT_FALSE(is_map_used(phong, slot_named("Clearcoat map")));
    EXPECT_FALSE(is_map_used(unlit, slot_named("Normal map")));
    EXPECT_TRUE(is_map_used(unlit, slot_named("Diffuse map")));
}

std::vector<std::string> titles_with_effect(const Material& material) {
    std::vector<std::string> titles;
    for (const MaterialGroup& group : material_groups(material)) {
        if (group.has_effect && !group.title.empty()) titles.push_back(group.title);
    }
    return titles;
}

TEST(MaterialGroups, OfAPlainMaterialHaveNoEffect) {
    Material metallic;
    metallic.metallic_roughness.emplace();
    Material unlit;
    unlit.unlit = true;
    for (const Material& material : {Material(), metallic, unlit})
        EXPECT_THAT(titles_with_effect(material), testing::IsEmpty());
    EXPECT_EQ(material_groups(metallic).size(), 14U) << "9 extensions, 4 others and the base";
    EXPECT_EQ(material_groups(unlit).size(), 2U);
}

TEST(MaterialGroups, HaveAnEffectIfTheirValuesChangeThePicture) {
    Material phong;
    phong.specular = glm::vec3(0.5F);
    phong.transmission = 0.1F;
    phong.bump_map.emplace();
    phong.emission = glm::vec3(1.0F);
    phong.alpha_mode = AlphaMode::blend;
    EXPECT_THAT(
        titles_with_effect(phong),
        testing::ElementsAre("Highlights", "Reflection", "Relief", "Emission", "Transparency"));
    Material metallic;
    MetallicRoughness& model = metallic.metallic_roughness.emplace();
    model.clearcoat_roughness = 0.5F;
    model.sheen_roughness = 0.5F;
    model.anisotropy_rotation = 1.0F;
    model.thickness = 1.0F;
    model.dispersion = 1.0F;
    EXPECT_THAT(titles_with_effect(metallic), testing::IsEmpty()) << "their weights are 0";
    model.refractive_index = 1.3F;
    model.specular_color_texture.emplace();
    model.clearcoat = 1.0F;
    model.transmission = 1.0F;
    EXPECT_THAT(titles_with_effect(metallic),
                testing::ElementsAre("Refraction", "Specular", "Clearcoat", "Transmission",
                                     "Volume", "Dispersion"));
}

TEST(MaterialGroups, ContainEveryMapOnce) {
    Material metallic;
    metallic.metallic_roughness.emplace();
    Material relief;
    relief.height_map.emplace();
    for (const Material& material : {Material(), metallic, relief}) {
        std::vector<TextureSlot> slots;
        for (const MaterialGroup& group : material_groups(material))
            slots.insert(slots.end(), group.slots.begin(), group.slots.end());
        for (const TextureSlotInfo& info : texture_slots) {
            EXPECT_EQ(std::count(slots.begin(), slots.end(), info.slot),
                      is_map_used(material, info.slot) ? 1 : 0)
                << info.name;
        }
    }
}

}  // namespace
}  // namespace relief::tools
