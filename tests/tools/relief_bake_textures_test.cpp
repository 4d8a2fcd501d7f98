// SPDX-License-Identifier: Apache-2.0
// Runs relief-bake textures, and the other commands of relief-bake with textures of all kinds of
// maps as output.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "relief/mesh/image.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/map_description.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/texture_file.h"
#include "support/shared_data.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::expect_refusals;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;

ProgramResult run_bake(const Workplace& workplace, const std::string& words) {
    ProgramResult result = workplace.run("relief-bake " + words);
    EXPECT_EQ(result.exit_code, 0) << words << "\n" << result.error;
    return result;
}

/// Writes an image of 16 x 8 texels of one value in each channel.
void write_map(const Workplace& workplace, const std::string& name,
               const std::vector<std::uint8_t>& texel, int width = 16) {
    const int channels = static_cast<int>(texel.size());
    Image image = make_image(width, 8, channels, 8, ColorSpace::data);
    const auto samples = image.as<std::uint8_t>();
    for (std::size_t i = 0; i < samples.size(); ++i)
        samples[i] = texel[i % texel.size()];
    write_image(workplace / name, image);
}

/// The samples of the first texel of the largest level.
std::vector<int> first_texel(const std::filesystem::path& file) {
    const GpuTexture texture = read_texture(file);
    const Image image = decode_texture_level(texture, 0);
    std::vector<int> texel;
    for (int c = 0; c < image.channels; ++c) {
        const Image channel = channel_of(image, c);
        texel.push_back(static_cast<int>(channel.as<float>()[0] * 255.0F + 0.5F));
    }
    return texel;
}

/// A set of maps of one material in the folder maps/.
void write_set(const Workplace& workplace) {
    std::filesystem::create_directory(workplace / "maps");
    write_map(workplace, "maps/rock_albedo.png", {200, 100, 50});
    write_map(workplace, "maps/rock_normal.png", {128, 188, 240});
    write_map(workplace, "maps/rock_ao.png", {255});
    write_map(workplace, "maps/rock_rough.png", {51});
    write_map(workplace, "maps/rock_metal.png", {0});
    write_map(workplace, "maps/rock_emission.png", {10, 20, 30});
    write_map(workplace, "maps/rock_height.png", {77});
}

TEST(TexturesCommand, FolderBecomesTheSetOfAnEngine) {
    const Workplace workplace;
    write_set(workplace);
    const ProgramResult unreal = run_bake(
        workplace, "textures maps -o out --for unreal --input-green up --report out/r.json");
    EXPECT_EQ(workplace.outputs(),
              "r.json rock_D.ktx2 rock_E.ktx2 rock_H.ktx2 rock_N.ktx2 rock_ORM.ktx2");
    EXPECT_THAT(unreal.out, HasSubstr("unreal: 5 textures of 1 set"));
    const GpuTexture color = read_texture(workplace / "out/rock_D.ktx2");
    EXPECT_EQ(color.format, TextureFormat::bc7);
    EXPECT_TRUE(color.is_srgb);
    EXPECT_EQ(color.levels.size(), 5U);
    EXPECT_EQ(first_texel(workplace / "out/rock_ORM.ktx2"), (std::vector<int>{255, 51, 0, 255}));
    EXPECT_FALSE(read_texture(workplace / "out/rock_ORM.ktx2").is_srgb);
    EXPECT_EQ(read_texture(workplace / "out/rock_H.ktx2").format, TextureFormat::bc4);
    // Green up of the map becomes green down of the engine.
    const GpuTexture normals = read_texture(workplace / "out/rock_N.ktx2");
    EXPECT_EQ(normals.metadata.at("relief:green"), "down");
    EXPECT_LT(first_texel(workplace / "out/rock_N.ktx2")[1], 80);
    const json report = json::parse(workplace.read("out/r.json"));
    ASSERT_EQ(report["textures"].size(), 5U);
    EXPECT_EQ(report["textures"][0]["kind"], "color");
    EXPECT_TRUE(report["textures"][0]["levels"][0].contains("p99"));
    EXPECT_EQ(report["textures"][0]["sources"][0], "rock_albedo.png (by its name)");
}

TEST(TexturesCommand, UnityPacksSmoothnessInAlpha) {
    const Workplace workplace;
    write_set(workplace);
    run_bake(workplace, "textures maps -o out --for unity --input-green up --container dds");
    EXPECT_EQ(workplace.outputs(),
              "rock_BaseMap.dds rock_Emission.dds rock_Height.dds rock_MaskMap.dds "
              "rock_Normal.dds");
    EXPECT_EQ(first_texel(workplace / "out/rock_MaskMap.dds"), (std::vector<int>{0, 255, 0, 204}));
    EXPECT_TRUE(read_texture(workplace / "out/rock_BaseMap.dds").is_srgb);
}

TEST(TexturesCommand, UncertainFilesInFoldersAreReported) {
    const Workplace workplace;
    write_set(workplace);
    write_map(workplace, "maps/rock_depth.png", {9});
    const std::string line = "textures maps -o out --input-green up";
    const ProgramResult result = run_bake(workplace, line);
    EXPECT_THAT(result.out, HasSubstr("file rock_depth.png: the word 'depth' may be heights"));
    EXPECT_EQ(workplace.run("relief-bake " + line + " --strict").exit_code, 3);
    expect_refusals(
        workplace, "relief-bake", "rock_normal.ktx2",
        {{"textures maps/rock_depth.png -o out", 1,
          "maps/rock_depth.png: the word 'depth' may be heights or the opposite of heights (give "
          "its kind with --kind FILE=KIND)"},
         {"textures maps -o out --kind rock_depth.png=height", 2,
          "maps/rock_depth.png and maps/rock_height.png: both are a height map of 'rock'"},
         {"textures maps -o out --kind other.png=height", 2,
          "--kind other.png: no input has this name"},
         {"textures maps -o out --container dds --zstd 3", 2,
          "--zstd: compresses .ktx2 files only"},
         {"textures maps -o out --kind rock_depth.png=curvature", 2,
          "--kind rock_depth.png=curvature: not one of normal"}});
}

TEST(TexturesCommand, InputsAreNotReplaced) {
    const Workplace workplace;
    std::filesystem::create_directory(workplace / "maps");
    write_map(workplace, "rock_albedo.png", {200, 100, 50});
    run_bake(workplace, "textures rock_albedo.png -o maps --for godot");
    EXPECT_TRUE(exists(workplace / "maps/rock_albedo.ktx2"));
    const ProgramResult again =
        workplace.run("relief-bake textures maps/rock_albedo.ktx2 -o maps --for godot");
    EXPECT_EQ(again.exit_code, 2);
    EXPECT_THAT(again.error, HasSubstr("would be replaced (choose another output folder)"));
}

TEST(TexturesCommand, SizesAreLimitedAndOddOnesReported) {
    const Workplace workplace;
    write_map(workplace, "wall_d.png", {1, 2, 3});
    write_map(workplace, "floor_d.png", {1, 2, 3}, 12);
    run_bake(workplace, "textures wall_d.png -o out --max-size 4");
    const GpuTexture wall = read_texture(workplace / "out/wall_baseColor.ktx2");
    EXPECT_EQ(wall.width, 4);
    EXPECT_EQ(wall.height, 2);
    EXPECT_EQ(wall.levels.size(), 3U);
    EXPECT_THAT(run_bake(workplace, "textures floor_d.png -o out").out,
                HasSubstr("size 12 x 8 that is no power of two"));
}

TEST(TexturesCommand, OfTwoNormalMapsTheOneForTheEngineIsUsed) {
    const Workplace workplace;
    std::filesystem::create_directory(workplace / "maps");
    write_map(workplace, "maps/a_NormalGL.png", {128, 188, 240});
    write_map(workplace, "maps/a_NormalDX.png", {128, 67, 240});
    EXPECT_THAT(run_bake(workplace, "textures maps -o out --for unreal").out,
                HasSubstr("normal map a_NormalGL.png with the other direction of green"));
    EXPECT_LT(first_texel(workplace / "out/a_N.ktx2")[1], 80);
}

TEST(TexturesCommand, MaterialsOfAModelSayTheKinds) {
    const Workplace workplace;
    write_map(workplace, "one.png", {255, 51, 0});
    write_map(workplace, "two.png", {10, 20, 30, 200});
    workplace.write("m.gltf", R"({"asset":{"version":"2.0"},
      "images":[{"uri":"one.png"},{"uri":"two.png"}],
      "textures":[{"source":0},{"source":1}],
      "materials":[{"name":"stone","alphaMode":"MASK","pbrMetallicRoughness":{
        "metallicRoughnessTexture":{"index":0},"baseColorTexture":{"index":1}},
        "occlusionTexture":{"index":0}}]})");
    run_bake(workplace, "textures one.png two.png -o out --model m.gltf");
    EXPECT_EQ(workplace.outputs(), "stone_baseColor.ktx2 stone_orm.ktx2");
    EXPECT_EQ(first_texel(workplace / "out/stone_orm.ktx2"), (std::vector<int>{255, 51, 0, 255}));
    EXPECT_EQ(first_texel(workplace / "out/stone_baseColor.ktx2")[3], 200);
}

TEST(TexturesCommand, RealMaterialsBecomeSets) {
    RELIEF_NEEDS_SHARED(folder, "textures/cheese_godot");
    const Workplace workplace;
    const ProgramResult result =
        run_bake(workplace, "textures '" + folder.string() +
                                "' -o out --for unreal --max-size 256 --report out/r.json");
    EXPECT_THAT(result.out, HasSubstr("file texture_cheese_depth.png: the word 'depth'"));
    const json report = json::parse(workplace.read("out/r.json"));
    EXPECT_EQ(report["textures"].size(), 2U) << result.out;
    for (const json& texture : report["textures"]) {
        const json& level = texture["levels"][0];
        if (texture["kind"] == "color") {
            EXPECT_GT(level["psnr"], 30.0);
        } else {
            EXPECT_LT(level["rms"], 4.0);
        }
    }
}

// Other commands.

TEST(MapTextures, ConvertWritesEveryKind) {
    const Workplace workplace;
    write_map(workplace, "gray.png", {128});
    write_map(workplace, "color.png", {200, 100, 50});
    for (const char* kind : {"occlusion", "roughness", "metalness", "height", "curvature"}) {
        const std::string file = std::string("out/") + kind + ".ktx2";
        run_bake(workplace, "convert gray.png " + file + " --mips --kind " + kind);
        const GpuTexture texture = read_texture(workplace / file);
        EXPECT_EQ(texture.format, TextureFormat::bc4) << kind;
        EXPECT_EQ(texture.levels.size(), 5U) << kind;
        EXPECT_EQ(enum_name(*read_description(texture.metadata).kind), std::string(kind));
        EXPECT_NEAR(first_texel(workplace / file)[0], 128, 1) << kind;
    }
    for (const char* kind : {"color", "emission"}) {
        const std::string file = std::string("out/") + kind + ".dds";
        run_bake(workplace, "convert color.png " + file + " --mips --format bc1 --kind " + kind);
        EXPECT_TRUE(read_texture(workplace / file).is_srgb) << kind;
        EXPECT_NEAR(first_texel(workplace / file)[0], 200, 3) << kind;
    }
    const ProgramResult red = run_bake(
        workplace, "convert color.png out/red.ktx2 --kind height --input-channel r --format r16");
    EXPECT_EQ(first_texel(workplace / "out/red.ktx2")[0], 200);
    EXPECT_THAT(red.out, HasSubstr("error 0.00 codes of 8 bits RMS"));
    // The texture states its kind, so that it need not be given again.
    run_bake(workplace, "convert out/height.ktx2 out/again.dds");
    EXPECT_EQ(read_texture(workplace / "out/again.dds").format, TextureFormat::bc4);
}

TEST(MapTextures, AssumedNormalsAreNotConvertedAsTheirStatedKind) {
    const Workplace workplace;
    Image normals = make_image(8, 8, 3, 8, ColorSpace::data);
    const auto samples = normals.as<std::uint8_t>();
    for (std::size_t i = 0; i < samples.size(); ++i)
        samples[i] = i % 3 == 2 ? 255 : 128;
    write_image(workplace / "colors.png", normals,
                write_description({.kind = MapKind::color, .color_space = ColorSpace::srgb}, 8));
    run_bake(workplace, "convert colors.png out/color.ktx2");
    EXPECT_TRUE(read_texture(workplace / "out/color.ktx2").is_srgb);
    run_bake(workplace, "convert colors.png out/normal.ktx2 --assume normal");
    EXPECT_EQ(read_texture(workplace / "out/normal.ktx2").format, TextureFormat::bc5);
}

TEST(MapTextures, WrongUseOfConvertIsRefused) {
    const Workplace workplace;
    write_map(workplace, "color.png", {200, 100, 50});
    write_map(workplace, "cut.png", {200, 100, 50, 99});
    expect_refusals(
        workplace, "relief-bake", "o.ktx2",
        {{"convert color.png out/o.png --kind color", 2, "--kind: has no effect on images"},
         {"convert color.png out/o.ktx2 --kind color --flip green", 2,
          "--flip: is for normal maps, not for --kind color"},
         {"convert color.png out/o.ktx2 --kind color --format bc5", 2,
          "--format bc5: a color map is not stored in it (choose one of bc7, bc1, bc1a, bc3, "
          "rgba8)"},
         {"convert color.png out/o.ktx2 --format bc1", 2,
          "--format bc1: does not store normals (give --kind"},
         {"convert color.png out/o.ktx2 --kind roughness", 1,
          "color.png: is not gray (name the channel: color.png:g)"},
         {"convert cut.png out/o.ktx2 --kind color --format bc1", 2,
          "--format bc1: stores no alpha, which the map has (give --alpha drop"},
         {"convert cut.png out/o.ktx2 --kind color --alpha-cutoff 0.5", 2,
          "--alpha-cutoff: has no effect without --mips"}});
}

TEST(MapTextures, PackBumpAndMeshWriteTextures) {
    const Workplace workplace;
    run_bake(
        workplace,
        "pack out/orm.ktx2 --occlusion data/bricks-height.png --assume occlusion --roughness 0.5");
    const GpuTexture packed = read_texture(workplace / "out/orm.ktx2");
    EXPECT_EQ(packed.format, TextureFormat::bc7);
    EXPECT_GT(packed.levels.size(), 5U);
    workplace.write_bricks("bricks.png");
    run_bake(workplace, "bump bricks.png out/bricks.ktx2 --kernel central3 --for unreal");
    const GpuTexture normals = read_texture(workplace / "out/bricks.ktx2");
    EXPECT_EQ(normals.format, TextureFormat::bc5);
    EXPECT_EQ(normals.levels.size(), 9U);
    EXPECT_EQ(normals.metadata.at("relief:green"), "down");
    workplace.write_square("low.obj");
    run_bake(workplace,
             "mesh low.obj low.obj out/n.dds --size 16 --occlusion-map out/ao.ktx2 --height-map "
             "out/h.ktx2 --height-range 1");
    EXPECT_EQ(read_texture(workplace / "out/n.dds").format, TextureFormat::bc5);
    EXPECT_EQ(read_texture(workplace / "out/ao.ktx2").format, TextureFormat::bc4);
    EXPECT_NEAR(first_texel(workplace / "out/h.ktx2")[0], 128, 1);
    expect_refusals(
        workplace, "relief-bake", "o.ktx2",
        {{"bump bricks.png out/o.ktx2 --bits 8", 2,
          "--bits, --zero-code, --dither: have no effect on textures"},
         {"bump bricks.png out/o.ktx2 --xy", 2, "--xy, --alpha: have no effect on textures"},
         {"bump bricks.png out/o.ktx2 --fast", 2, "--fast, --small: have no effect on textures"}});
}

}  // namespace
}  // namespace relief::tools
