// SPDX-License-Identifier: Apache-2.0
// The command `relief-mesh material`: images, textures and materials change, and nothing else does.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "relief/mesh/gltf_document.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::expect_refusals;
using test::ProgramResult;
using test::read_document;
using test::Workplace;
using testing::HasSubstr;

const std::string normal_map = test::bricks_map;
const std::string color_map = "data/bricks-diffuse.png";

class MaterialCommand : public testing::Test {
  protected:
    /// Runs the command, and returns the JSON of the written .gltf.
    json stored(const std::string& words) {
        const ProgramResult result = workplace_.run("relief-mesh material " + words);
        EXPECT_EQ(result.exit_code, 0) << result.error;
        out_ = result.out;
        return json::parse(workplace_.read("out/after.gltf"));
    }

    /// Writes a .gltf of the vase, changed by `edit`.
    template <typename Edit>
    void write_vase(const Edit& edit) {
        ASSERT_EQ(workplace_.run("relief-mesh process data/vase.obj out/vase.gltf").exit_code, 0);
        json root = json::parse(workplace_.read("out/vase.gltf"));
        edit(root);
        workplace_.write("out/vase.gltf", root.dump());
    }

    const Workplace workplace_;
    std::string out_;
};

TEST_F(MaterialCommand, StoresMapsAndTangentsOfAnyModel) {
    ASSERT_EQ(workplace_
                  .run("relief-mesh material data/vase.obj out/after.glb --scale 0.5 --normal " +
                       normal_map + " --base-color " + color_map + " --emissive " + color_map)
                  .exit_code,
              0);
    const GltfDocument document = read_document(workplace_ / "out/after.glb");
    const GltfView view = document.view();
    ASSERT_EQ(view.materials.size(), 1U);
    const GltfMaterial& material = view.materials[0];
    ASSERT_TRUE(material.normal_map && material.diffuse_texture && material.emission_texture);
    EXPECT_EQ(material.normal_map->scale, 0.5F);
    EXPECT_EQ(material.emission, glm::vec3(1.0F));
    // Each file is stored once, with its bytes.
    ASSERT_EQ(view.images.size(), 2U);
    EXPECT_EQ(material.diffuse_texture->image, material.emission_texture->image);
    const auto& bytes =
        std::get<std::vector<std::byte>>(view.images[material.normal_map->texture.image].source);
    const std::string original = workplace_.read(normal_map);
    ASSERT_EQ(bytes.size(), original.size());
    EXPECT_EQ(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()), original);
    EXPECT_FALSE(document.mesh({0, 0}).tangents.empty());
}

TEST_F(MaterialCommand, ReplacesOneImageAndKeepsTheRest) {
    // The vase has a base color map with a sampler, a transform and extras, which stay.
    write_vase([](json& root) {
        json& info = root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
        info["extensions"]["KHR_texture_transform"]["scale"] = {2, 2};
        root["extensionsUsed"] = {"KHR_texture_transform"};
        root["samplers"][0]["magFilter"] = 9728;
        root["textures"][0]["extras"] = "kept";
    });
    const json before = json::parse(workplace_.read("out/vase.gltf"));
    const json after = stored("out/vase.gltf out/after.gltf --embed --base-color " + normal_map);
    EXPECT_THAT(out_, HasSubstr("map with the KHR_texture_transform of the replaced one"));
    ASSERT_EQ(after["images"].size(), 1U);
    EXPECT_EQ(after["images"][0]["name"], "bricks-normal");
    EXPECT_EQ(after["textures"], before["textures"]);
    EXPECT_EQ(after["samplers"], before["samplers"]);
    EXPECT_EQ(after["materials"], before["materials"]);
    EXPECT_EQ(after["meshes"], before["meshes"]);
    EXPECT_EQ(after["accessors"].size(), before["accessors"].size());
    // The bytes of the old image are gone.
    const auto size_of = [&](const std::string& file) {
        return std::filesystem::file_size(workplace_ / file);
    };
    const std::uintmax_t meshes = size_of("out/vase.bin") - size_of(color_map);
    EXPECT_LE(size_of("out/after.bin"), meshes + size_of(normal_map) + 8);
}

TEST_F(MaterialCommand, KeepsATextureThatOthersUse) {
    write_vase([](json& root) { root["materials"][0]["emissiveTexture"] = {{"index", 0}}; });
    json after = stored("out/vase.gltf out/after.gltf --base-color " + normal_map);
    ASSERT_EQ(after["images"].size(), 2U);
    EXPECT_EQ(after["materials"][0]["emissiveTexture"]["index"], 0);
    const json& info = after["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
    EXPECT_EQ(info["index"], 1);
    EXPECT_EQ(after["textures"][1]["source"], 1);
    EXPECT_EQ(after["textures"][1]["sampler"], after["textures"][0]["sampler"]);
    // An extension that may use textures in another way has the same effect.
    write_vase([](json& root) {
        root["extensionsUsed"] = {"VRM"};
        root["extensions"]["VRM"]["meta"]["texture"] = 0;
    });
    after = stored("out/vase.gltf out/after.gltf --base-color " + normal_map);
    EXPECT_EQ(after["images"].size(), 2U);
}

TEST_F(MaterialCommand, ReplacesImagesOfTextureExtensions) {
    write_vase([](json& root) {
        root["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = 0;
        root["textures"][0].erase("source");
        root["extensionsUsed"] = {"EXT_texture_webp"};
        root["extensionsRequired"] = {"EXT_texture_webp"};
    });
    const json after = stored("out/vase.gltf out/after.gltf --base-color " + normal_map);
    EXPECT_FALSE(after.contains("extensionsRequired"));
    EXPECT_EQ(after["textures"][0]["source"], 0);
    EXPECT_FALSE(after["textures"][0].contains("extensions"));
    EXPECT_EQ(after["images"].size(), 1U);
}

TEST_F(MaterialCommand, WritesImagesNextToAGltf) {
    std::filesystem::create_directory(workplace_ / "maps");
    workplace_.write("maps/a.png", workplace_.read(normal_map));
    const json after = stored(
        "data/vase.obj out/after.gltf --normal maps/a.png --occlusion maps/a.png "
        "--metallic-roughness maps/a.png --no-tangents");
    EXPECT_EQ(workplace_.read("out/a.png"), workplace_.read(normal_map));
    EXPECT_EQ(after["images"][1], json({{"name", "a"}, {"uri", "a.png"}}));
    const json& material = after["materials"][0];
    const json texture = material["normalTexture"]["index"];
    EXPECT_EQ(material["occlusionTexture"]["index"], texture);
    EXPECT_EQ(material["pbrMetallicRoughness"]["metallicRoughnessTexture"]["index"], texture);
    EXPECT_FALSE(after["meshes"][0]["primitives"][0]["attributes"].contains("TANGENT"));
    // A .glb of it embeds them.
    ASSERT_EQ(workplace_.run("relief-mesh material out/after.gltf out/b.glb --normal out/a.png")
                  .exit_code,
              0);
    const GltfView view = read_document(workplace_ / "out/b.glb").view();
    for (const GltfImage& image : view.images)
        EXPECT_TRUE(std::holds_alternative<std::vector<std::byte>>(image.source)) << image.name;
}

TEST_F(MaterialCommand, GivesAMaterialToPrimitivesWithoutOne) {
    workplace_.write_square("square.obj");
    const json after = stored("square.obj out/after.gltf --material stone --normal " + normal_map);
    EXPECT_EQ(after["materials"][0]["name"], "stone");
    EXPECT_EQ(after["meshes"][0]["primitives"][0]["material"], 0);
    EXPECT_THAT(out_, HasSubstr("'stone', new"));
    EXPECT_THAT(out_, HasSubstr("mikktspace, added to 1 primitive"));
}

TEST_F(MaterialCommand, ReportsMapsThatCannotBeSeen) {
    write_vase([](json& root) {
        root["materials"][0]["extensions"]["KHR_materials_unlit"] = json::object();
        root["extensionsUsed"] = {"KHR_materials_unlit"};
    });
    stored("out/vase.gltf out/after.gltf --normal " + normal_map);
    EXPECT_THAT(out_, HasSubstr("map in a material with KHR_materials_unlit"));
}

TEST_F(MaterialCommand, RefusesAModelWithoutTextureCoordinates) {
    write_vase([](json& root) {
        for (json& primitive : root["meshes"][0]["primitives"])
            primitive["attributes"].erase("TEXCOORD_0");
    });
    const ProgramResult result =
        workplace_.run("relief-mesh material out/vase.gltf out/after.gltf --normal " + normal_map);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.error,
              "relief-mesh: error: out/vase.gltf: mesh 'vase' primitive 0: has no texture "
              "coordinates (unwrap the model first)\n");
    EXPECT_FALSE(std::filesystem::exists(workplace_ / "out/after.gltf"));
}

TEST_F(MaterialCommand, RefusesUnsupportedContent) {
    write_vase([](json& root) {
        root["materials"].push_back({{"name", "glass"}});
        root["materials"].push_back({{"name", "glass"}});
    });
    std::filesystem::rename(workplace_ / "out/vase.gltf", workplace_ / "vase.gltf");
    std::filesystem::rename(workplace_ / "out/vase.bin", workplace_ / "vase.bin");
    workplace_.write("text.png", "no image");
    std::filesystem::create_directory(workplace_ / "maps");
    workplace_.write("maps/bricks-normal.png", workplace_.read(color_map));
    const std::string normal = " --normal " + normal_map;
    const std::string vase = "relief-mesh material data/vase.obj out/old.glb";
    expect_refusals(
        workplace_, "relief-mesh", "old.glb",
        {{vase, 2, "no map (give --normal,"},
         {"relief-mesh material data/vase.obj out/old.ply" + normal, 2,
          "out/old.ply: cannot store materials of glTF (write a .glb or .gltf)"},
         {vase + " --scale 2 --base-color " + color_map, 2, "--scale"},
         {vase + " --embed --external" + normal, 2, "--embed and --external contradict"},
         {vase + " --external" + normal, 2, "--external: a .glb embeds its images"},
         {vase + " --normal missing.png", 1, "missing.png: "},
         {vase + " --normal text.png", 1, "text.png: "},
         {vase + " --normal data/vase.obj", 1, "data/vase.obj: "},
         {"relief-mesh material vase.gltf out/old.glb" + normal, 1,
          "vase.gltf: has 3 materials (choose one with --material: 'bricks', 'glass', 'glass')"},
         {"relief-mesh material vase.gltf out/old.glb --material wood" + normal, 1,
          "vase.gltf: has no material 'wood' (available: 'bricks', 'glass', 'glass')"},
         {"relief-mesh material vase.gltf out/old.glb --material glass" + normal, 1,
          "vase.gltf: has 2 materials 'glass' (rename them first)"},
         {"relief-mesh material vase.gltf out/new.gltf --material bricks" + normal +
              " --occlusion maps/bricks-normal.png",
          1, "maps/bricks-normal.png: has the name of another image"}});
}

}  // namespace
}  // namespace relief::tools
