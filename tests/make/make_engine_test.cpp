// SPDX-License-Identifier: Apache-2.0
// The maps of an asset as files for engines.
#include "make_engine.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "relief/mesh/image_file.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using testing::ElementsAre;

Image one_texel(std::vector<std::uint8_t> codes, ColorSpace space) {
    const int channels = static_cast<int>(codes.size());
    return {1, 1, channels, space, std::move(codes)};
}

/// An asset of one texel.
make::Asset asset_of_one_texel() {
    make::Asset asset;
    asset.normal_map = one_texel({128, 200, 255}, ColorSpace::data);
    asset.color_map = one_texel({10, 20, 30}, ColorSpace::srgb);
    asset.surface_map = one_texel({90, 60, 30}, ColorSpace::data);
    asset.surface_has_occlusion = true;
    asset.emission_map = one_texel({1, 2, 3}, ColorSpace::srgb);
    return asset;
}

std::vector<std::uint8_t> codes_in(const std::filesystem::path& file) {
    const Image image = read_image(file, ImageUse::data);
    const auto codes = image.as<std::uint8_t>();
    return {codes.begin(), codes.end()};
}

std::vector<std::string> file_names(const std::vector<std::filesystem::path>& files) {
    std::vector<std::string> names;
    for (const std::filesystem::path& file : files)
        names.push_back(file.filename().string());
    return names;
}

TEST(EngineMaps, HaveTheChannelsOfUnity) {
    const test::TemporaryDirectory folder;
    const std::vector<std::filesystem::path> files =
        write_map_files(Engine::unity, folder / "rock.glb", asset_of_one_texel());
    EXPECT_THAT(file_names(files), ElementsAre("rock_Normal.png", "rock_MaskMap.png",
                                               "rock_BaseMap.png", "rock_Emission.png"));
    EXPECT_THAT(codes_in(folder / "rock_Normal.png"), ElementsAre(128, 200, 255));
    // Metalness, occlusion, 0, smoothness.
    EXPECT_THAT(codes_in(folder / "rock_MaskMap.png"), ElementsAre(30, 90, 0, 255 - 60));
    EXPECT_THAT(codes_in(folder / "rock_BaseMap.png"), ElementsAre(10, 20, 30));
    EXPECT_THAT(codes_in(folder / "rock_Emission.png"), ElementsAre(1, 2, 3));
}

TEST(EngineMaps, HaveTheFactorsOfPropertiesWithoutAMap) {
    make::Asset asset = asset_of_one_texel();
    asset.surface_map.reset();
    asset.emission_map.reset();
    asset.occlusion_map = one_texel({90}, ColorSpace::data);
    asset.material.metallic_roughness->roughness = 0.2F;
    asset.material.metallic_roughness->metallic = 1.0F;
    const test::TemporaryDirectory folder;
    const std::vector<std::filesystem::path> files =
        write_map_files(Engine::unreal, folder / "rock.glb", asset);
    EXPECT_THAT(file_names(files), ElementsAre("rock_N.png", "rock_ORM.png", "rock_D.png"));
    EXPECT_THAT(codes_in(folder / "rock_N.png"), ElementsAre(128, 55, 255)) << "green is down";
    EXPECT_THAT(codes_in(folder / "rock_ORM.png"), ElementsAre(90, 51, 255));
}

TEST(EngineMaps, AreOnlyFurtherLayersForGltf) {
    make::Asset asset = asset_of_one_texel();
    Image heights{1, 1, 1, ColorSpace::data, std::vector<std::uint16_t>{40000}};
    asset.layers.push_back({{LayerKind::height, 16, 0.5}, heights});
    make::AssetOptions options;
    options.layers = {LayerKind::height};
    const test::TemporaryDirectory folder;
    for (const Engine engine : {Engine::gltf, Engine::godot}) {
        const std::vector<std::filesystem::path> files =
            write_map_files(engine, folder / "rock.glb", asset);
        EXPECT_THAT(file_names(files), ElementsAre("rock_height.png"));
        EXPECT_EQ(files, map_files_of(engine, options, folder / "rock.glb"));
    }
    const ImageInfo info = read_image_info(folder / "rock_height.png");
    EXPECT_EQ(info.bits, 16);
    EXPECT_EQ(info.metadata.at("relief:range"), "0.5");
}

TEST(EngineMaps, TurnTheGreenOfBentNormals) {
    make::Asset asset = asset_of_one_texel();
    const Image bent{1, 1, 3, ColorSpace::data, std::vector<std::uint16_t>{32768, 50000, 60000}};
    asset.layers.push_back({{.kind = LayerKind::bent_normal, .bits = 16}, bent});
    const test::TemporaryDirectory folder;
    for (const auto& [engine, green, name] :
         {std::tuple(Engine::unreal, 15535, "down"), {Engine::unity, 50000, "up"}}) {
        write_map_files(engine, folder / "rock.glb", asset);
        const Image written = read_image(folder / "rock_bent.png", ImageUse::data);
        EXPECT_EQ(written.as<std::uint16_t>()[1], green);
        EXPECT_EQ(read_image_info(folder / "rock_bent.png").metadata.at("relief:green"), name);
    }
}

TEST(EngineMaps, AreAmongTheFilesThatAreAnnounced) {
    const test::TemporaryDirectory folder;
    for (const Engine engine : {Engine::gltf, Engine::godot, Engine::unity, Engine::unreal}) {
        const std::vector<std::filesystem::path> announced =
            map_files_of(engine, {}, folder / "rock.glb");
        for (const std::filesystem::path& file :
             write_map_files(engine, folder / "rock.glb", asset_of_one_texel()))
            EXPECT_EQ(std::ranges::count(announced, file), 1) << file;
    }
}

}  // namespace
}  // namespace relief::tools
