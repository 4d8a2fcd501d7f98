// SPDX-License-Identifier: Apache-2.0
#include "window/map_slots.h"

#include <gtest/gtest.h>

#include <string>

#include "relief/mesh/error.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using test::Workplace;

const MapSlot& slot_named(const std::string& name) {
    for (const MapSlot& slot : map_slots()) {
        if (slot.name == name) return slot;
    }
    throw std::runtime_error("no slot " + name);
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
    Scene& scene() { return scene_; }
    Workplace& workplace() { return workplace_; }

  private:
    Workplace workplace_;
    Scene scene_;
};

TEST_F(MapSlots, EachTakesAFileAndIsCleared) {
    Material& material = scene().materials[0];
    material.metallic_roughness.emplace();
    for (const MapSlot& slot : map_slots()) {
        EXPECT_FALSE(map_name(scene(), 0, slot)) << slot.name;
        set_map(scene(), 0, slot, colors());
        EXPECT_EQ(map_name(scene(), 0, slot), colors().string()) << slot.name;
        EXPECT_FALSE(map_name(scene(), 1, slot)) << slot.name << " of the other one";
        slot.set(material, std::nullopt);
        EXPECT_FALSE(map_name(scene(), 0, slot)) << slot.name;
    }
    EXPECT_EQ(scene().images.size(), 1U) << "one file is one image";
    EXPECT_NO_THROW(validate(scene()));
}

TEST_F(MapSlots, AMaterialHasANormalMapOrABumpMap) {
    Material& material = scene().materials[0];
    set_map(scene(), 0, slot_named("Bump map"), heights());
    material.bump_map->strength = 5.0F;
    set_map(scene(), 0, slot_named("Bump map"), colors());
    EXPECT_EQ(material.bump_map->strength, 5.0F) << "another image as strong";
    set_map(scene(), 0, slot_named("Normal map"), colors());
    EXPECT_FALSE(material.bump_map);
    material.normal_map->scale = 2.0F;
    material.normal_map->flat = FlatCode::middle;
    set_map(scene(), 0, slot_named("Normal map"), heights());
    EXPECT_EQ(material.normal_map->scale, 2.0F);
    EXPECT_FALSE(material.normal_map->flat) << "told by the image again";
    set_map(scene(), 0, slot_named("Bump map"), heights());
    EXPECT_FALSE(material.normal_map);
    EXPECT_NO_THROW(validate(scene()));
}

TEST_F(MapSlots, KeepHowTheImageIsWrapped) {
    const MapSlot& slot = slot_named("Diffuse map");
    set_map(scene(), 0, slot, colors());
    scene().materials[0].diffuse_texture->wrap_u = TextureWrap::clamp;
    set_map(scene(), 0, slot, heights());
    EXPECT_EQ(scene().materials[0].diffuse_texture->wrap_u, TextureWrap::clamp);
    EXPECT_EQ(scene().materials[0].diffuse_texture->wrap_v, TextureWrap::repeat);
}

TEST_F(MapSlots, RefuseWhatIsNoImageAndStayAsTheyWere) {
    workplace().write("words.png", "no image");
    const MapSlot& slot = slot_named("Diffuse map");
    set_map(scene(), 0, slot, colors());
    EXPECT_THROW(set_map(scene(), 0, slot, workplace() / "words.png"), FileError);
    EXPECT_THROW(set_map(scene(), 0, slot, workplace() / "absent.png"), FileError);
    EXPECT_EQ(map_name(scene(), 0, slot), colors().string());
}

TEST_F(MapSlots, AreOfferedWhereTheModelUsesThem) {
    Material phong;
    Material metallic;
    metallic.metallic_roughness.emplace();
    Material unlit;
    unlit.unlit = true;
    EXPECT_TRUE(slot_named("Specular map").is_used(phong));
    EXPECT_FALSE(slot_named("Specular map").is_used(metallic));
    EXPECT_TRUE(slot_named("Metallic and roughness map").is_used(metallic));
    EXPECT_FALSE(slot_named("Metallic and roughness map").is_used(phong));
    EXPECT_FALSE(slot_named("Normal map").is_used(unlit));
    EXPECT_TRUE(slot_named("Diffuse map").is_used(unlit));
}

}  // namespace
}  // namespace relief::tools
