// SPDX-License-Identifier: Apache-2.0
// The maps and factors of an asset, from materials with factors and textures.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "relief/make/asset.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/image.h"
#include "support/shapes.h"
#include "tools/workplace.h"

namespace relief::make {
namespace {

constexpr int side = 32;

/// A square whose texture coordinates are kept, so that texels have known places. Its left half has
/// material 0, its right half material 1.
AssetSource square_of(const HighMaterial& left, const HighMaterial& right) {
    AssetSource source;
    source.name = "square";
    source.mesh = test::grid(8);
    source.materials = {left, right};
    const auto is_left = [&](const glm::uvec3& triangle) {
        const std::vector<glm::vec3>& at = source.mesh.positions;
        return at[triangle.x].x + at[triangle.y].x + at[triangle.z].x < 1.5F;
    };
    std::vector<glm::uvec3>& triangles = source.mesh.triangles;
    const auto middle = std::stable_partition(triangles.begin(), triangles.end(), is_left);
    const auto count = static_cast<std::uint32_t>(triangles.end() - middle);
    source.mesh.material_ranges = {{0, count, 0U}, {count, count, 1U}};
    return source;
}

AssetOptions options_without_occlusion() {
    AssetOptions options;
    options.triangles = 500;
    options.size = {side, side};
    options.padding = 0;
    options.keep_texcoords = true;
    options.occlusion = false;
    return options;
}

/// Returns the codes of a texel.
std::vector<int> texel(const Image& image, int x, int y) {
    const auto channels = static_cast<std::size_t>(image.channels);
    const std::size_t at = channels * static_cast<std::size_t>(y * image.width + x);
    const auto samples = image.as<std::uint8_t>().subspan(at, channels);
    return {samples.begin(), samples.end()};
}

SurfaceTexture one_texel(std::vector<std::uint8_t> codes, ColorSpace space) {
    const int channels = static_cast<int>(codes.size());
    return {.image = std::make_shared<const Image>(Image{1, 1, channels, space, std::move(codes)})};
}

/// A metal and a matte plastic that glows.
AssetSource metal_and_plastic() {
    HighMaterial metal, plastic;
    metal.metallic = 1.0F;
    metal.roughness = 0.2F;
    plastic.roughness = 0.8F;
    plastic.emission = {4.0F, 2.0F, 0.0F};
    return square_of(metal, plastic);
}

using testing::ElementsAre;

TEST(AssetMaps, HaveTheFactorsOfEachMaterial) {
    const Asset asset = make_asset(metal_and_plastic(), options_without_occlusion());
    EXPECT_FALSE(asset.color_map) << "both are white";
    EXPECT_FALSE(asset.occlusion_map);
    ASSERT_TRUE(asset.surface_map && asset.emission_map);
    EXPECT_THAT(texel(*asset.surface_map, 4, 16), ElementsAre(255, 51, 255));
    EXPECT_THAT(texel(*asset.surface_map, 28, 16), ElementsAre(255, 204, 0));
    EXPECT_THAT(texel(*asset.emission_map, 4, 16), ElementsAre(0, 0, 0));
    EXPECT_THAT(texel(*asset.emission_map, 28, 16), ElementsAre(255, 188, 0));
    EXPECT_EQ(asset.emission_map->color_space, ColorSpace::srgb);
    EXPECT_EQ(asset.material.emission_strength, 4.0F);
    EXPECT_EQ(asset.material.emission_factor, glm::vec3(1.0F));
    EXPECT_EQ(asset.material.metallic_roughness->roughness, 1.0F);
    EXPECT_EQ(asset.material.metallic_roughness->metallic, 1.0F);
}

TEST(AssetMaps, AreReadBackFromTheFile) {
    const Asset asset = make_asset(metal_and_plastic(), options_without_occlusion());
    const test::TemporaryDirectory folder;
    Report report;
    write_asset(folder / "a.glb", asset, 0, report);
    EXPECT_TRUE(report.empty());
    EXPECT_TRUE(verify_asset(folder / "a.glb", asset).empty());
    const GltfView view = test::read_document(folder / "a.glb").view();
    const GltfMaterial& material = view.materials.front();
    const Texture* surface = find_texture(material, TextureSlot::metallic_roughness);
    ASSERT_NE(surface, nullptr);
    EXPECT_EQ(view.images[surface->image].name, "a_orm");
    const Texture* emission = find_texture(material, TextureSlot::emission);
    ASSERT_NE(emission, nullptr);
    EXPECT_EQ(view.images[emission->image].name, "a_emission");
    EXPECT_EQ(find_texture(material, TextureSlot::occlusion), nullptr);
    EXPECT_EQ(find_texture(material, TextureSlot::base_color), nullptr);
    EXPECT_EQ(material.emission, glm::vec3(4.0F));
    EXPECT_EQ(material.metallic_roughness->metallic, 1.0F);

    Asset other = asset;
    other.material.metallic_roughness->roughness = 0.5F;
    EXPECT_EQ(verify_asset(folder / "a.glb", other).count("another roughness"), 1U);
    other = asset;
    other.material.emission_strength = 3.0F;
    EXPECT_EQ(verify_asset(folder / "a.glb", other).count("another emission"), 1U);
    other = asset;
    other.surface_map->as<std::uint8_t>()[1] ^= 1U;
    EXPECT_EQ(verify_asset(folder / "a.glb", other).count("map with other texels"), 1U);
}

TEST(AssetMaps, AreTheSameForAnyNumberOfThreads) {
    AssetOptions options = options_without_occlusion();
    options.occlusion = true;
    options.layers = {LayerKind::height,      LayerKind::curvature, LayerKind::position,
                      LayerKind::bent_normal, LayerKind::thickness, LayerKind::id};
    options.execution.threads = 1;
    const Asset one = make_asset(metal_and_plastic(), options);
    options.execution.threads = 3;
    const Asset three = make_asset(metal_and_plastic(), options);
    const std::vector<AssetMap> maps = maps_of(one), same = maps_of(three);
    ASSERT_EQ(maps.size(), 9U);
    for (std::size_t i = 0; i < maps.size(); ++i)
        EXPECT_EQ(maps[i].image->samples, same[i].image->samples) << maps[i].name;
}

TEST(AssetMaps, DoNotExistForPropertiesThatAreTheSameEverywhere) {
    HighMaterial material;
    material.color = {0.5F, 0.25F, 0.125F};
    material.opacity = 0.5F;
    material.metallic = 0.75F;
    material.roughness = 0.0F;
    material.emission = {0.5F, 6.0F, 3.0F};
    AssetSource source = square_of(material, material);
    source.shared.alpha_mode = AlphaMode::blend;
    source.shared.double_sided = true;
    source.shared.metallic_roughness->clearcoat = 0.25F;
    const Asset asset = make_asset(source, options_without_occlusion());
    ASSERT_EQ(maps_of(asset).size(), 1U) << "normals";
    const test::TemporaryDirectory folder;
    write_asset(folder / "a.gltf", asset, 0);
    EXPECT_TRUE(verify_asset(folder / "a.gltf", asset).empty());
    const GltfView view = test::read_document(folder / "a.gltf").view();
    const GltfMaterial& written = view.materials.front();
    const MetallicRoughness& surface = *written.metallic_roughness;
    EXPECT_EQ(surface.base_color, material.color);
    EXPECT_EQ(surface.metallic, 0.75F);
    EXPECT_EQ(surface.roughness, 0.0F);
    EXPECT_EQ(surface.clearcoat, 0.25F);
    EXPECT_EQ(written.opacity, 0.5F);
    EXPECT_EQ(written.alpha_mode, AlphaMode::blend);
    EXPECT_TRUE(written.double_sided);
    EXPECT_EQ(written.emission, material.emission);
    EXPECT_EQ(written.emission_strength, 6.0F);
}

TEST(AssetMaps, DoNotExistForTexturesOfOneColor) {
    HighMaterial material;
    material.color_texture = one_texel({255, 0, 255}, ColorSpace::srgb);
    material.surface_texture = one_texel({0, 51, 102}, ColorSpace::data);
    material.metallic = 0.5F;
    material.emission = glm::vec3(2.0F);
    material.emission_texture = one_texel({255, 255, 0}, ColorSpace::srgb);
    const Asset asset = make_asset(square_of(material, material), options_without_occlusion());
    ASSERT_EQ(maps_of(asset).size(), 1U) << "normals";
    const MetallicRoughness& surface = *asset.material.metallic_roughness;
    EXPECT_EQ(surface.base_color, glm::vec3(1.0F, 0.0F, 1.0F));
    EXPECT_NEAR(surface.roughness, 0.2F, 1e-6F);
    EXPECT_NEAR(surface.metallic, 0.2F, 1e-6F);
    EXPECT_EQ(asset.material.emission_strength, 2.0F);
    EXPECT_EQ(asset.material.emission_factor, glm::vec3(1.0F, 1.0F, 0.0F));
}

TEST(AssetMaps, HaveNoAlphaIfTheSourceIsOpaqueEverywhere) {
    HighMaterial red, green;
    red.color = {1.0F, 0.0F, 0.0F};
    green.color = {0.0F, 1.0F, 0.0F};
    red.opacity = green.opacity = 1.0F;
    AssetSource source = square_of(red, green);
    source.shared.alpha_mode = AlphaMode::blend;
    const Asset opaque = make_asset(source, options_without_occlusion());
    ASSERT_TRUE(opaque.color_map);
    EXPECT_EQ(opaque.color_map->channels, 3);
    EXPECT_EQ(opaque.material.alpha_mode, AlphaMode::opaque);
    EXPECT_EQ(opaque.reports.back().report.count("transparent source that is opaque everywhere"),
              1U);
    source.materials[1].opacity = 0.25F;
    const Asset clear = make_asset(source, options_without_occlusion());
    EXPECT_EQ(clear.material.alpha_mode, AlphaMode::blend);
    EXPECT_THAT(texel(*clear.color_map, 4, 16), ElementsAre(255, 0, 0, 255));
    EXPECT_THAT(texel(*clear.color_map, 28, 16), ElementsAre(0, 255, 0, 64));
    // Masked beside blended: cut before the bake.
    source.materials[1].alpha_cutoff = 0.5F;
    const Asset cut = make_asset(source, options_without_occlusion());
    EXPECT_THAT(texel(*cut.color_map, 28, 16), ElementsAre(0, 255, 0, 0));
}

TEST(AssetMaps, CombineOcclusionTexturesWithOcclusionByRays) {
    HighMaterial dark, plain;
    dark.occlusion_texture = one_texel({101, 0, 0}, ColorSpace::data);
    dark.occlusion_strength = 0.5F;
    AssetSource source = square_of(dark, plain);
    // The open square is not occluded by itself.
    AssetOptions options = options_without_occlusion();
    options.occlusion = true;
    options.occlusion_rays = 4;
    const Asset asset = make_asset(source, options);
    ASSERT_TRUE(asset.occlusion_map);
    EXPECT_FALSE(asset.surface_map);
    EXPECT_EQ(asset.occlusion_map->width, side);
    // 1 + 0.5 (101 / 255 - 1)
    EXPECT_THAT(texel(*asset.occlusion_map, 4, 16), ElementsAre(178));
    EXPECT_THAT(texel(*asset.occlusion_map, 28, 16), ElementsAre(255));
    // With different roughness, one image has all.
    source.materials[1].roughness = 0.2F;
    const Asset packed = make_asset(source, options);
    EXPECT_FALSE(packed.occlusion_map);
    ASSERT_TRUE(packed.surface_map && packed.surface_has_occlusion);
    EXPECT_THAT(texel(*packed.surface_map, 4, 16), ElementsAre(178, 255, 0));
    EXPECT_THAT(texel(*packed.surface_map, 28, 16), ElementsAre(255, 51, 0));
    const test::TemporaryDirectory folder;
    write_asset(folder / "a.glb", packed, 0);
    EXPECT_TRUE(verify_asset(folder / "a.glb", packed).empty());
    const GltfView view = test::read_document(folder / "a.glb").view();
    EXPECT_EQ(find_texture(view.materials.front(), TextureSlot::occlusion)->image,
              find_texture(view.materials.front(), TextureSlot::metallic_roughness)->image);
}

TEST(AssetMaps, HaveTheOcclusionOfRaysInTheSameImage) {
    // A wall beside the floor, with another roughness.
    HighMaterial floor, wall;
    wall.roughness = 0.5F;
    AssetSource source = square_of(floor, wall);
    for (glm::vec3& position : source.mesh.positions) {
        const float beyond = std::max(position.x - 0.5F, 0.0F);
        position = {std::min(position.x, 0.5F), position.y, beyond};
    }
    source.mesh.normals.clear();
    AssetOptions options = options_without_occlusion();
    options.occlusion = true;
    options.occlusion_rays = 64;
    const Asset asset = make_asset(source, options);
    ASSERT_TRUE(asset.surface_map);
    const int far = texel(*asset.surface_map, 1, 16)[0];
    const int near = texel(*asset.surface_map, 14, 16)[0];
    EXPECT_GT(far, 200);
    EXPECT_LT(near, far - 30) << "beside the wall";
}

TEST(AssetLayers, HaveHeightsCurvatureAndPositions) {
    AssetSource source = square_of({}, {});
    source.origin = {10.0, 0.0, 0.0};
    AssetOptions options = options_without_occlusion();
    options.layers = {LayerKind::position, LayerKind::height};
    const Asset asset = make_asset(source, options);
    ASSERT_EQ(asset.layers.size(), 2U);
    const LayerCoding& coding = asset.layers[0].coding;
    EXPECT_EQ(coding.kind, LayerKind::position);
    const auto positions = asset.layers[0].image.as<std::uint16_t>();
    const std::size_t at = 3 * (16 * side + 8);
    EXPECT_NEAR(coding.range * (positions[at] - 32768) / 32767.0, 10.0 + 8.5 / side, 1e-3);
    EXPECT_NEAR(coding.range * (positions[at + 1] - 32768) / 32767.0, 1.0 - 16.5 / side, 1e-3);
    for (const std::uint16_t height : asset.layers[1].image.as<std::uint16_t>())
        EXPECT_NEAR(height, 32768, 1) << "the source is in the plane of the asset";
    const std::vector<AssetMap> maps = maps_of(asset);
    EXPECT_EQ(maps.back().name, "height");
    EXPECT_EQ(maps.back().metadata.at("relief:content"), "height map");
    EXPECT_TRUE(maps.back().slots.empty());
}

TEST(AssetLayers, HaveIdsWithTheNamesOfMaterials) {
    AssetSource source = square_of({}, {});
    source.material_names = {"left", "right"};
    AssetOptions options = options_without_occlusion();
    options.layers = {LayerKind::id};
    const Asset asset = make_asset(source, options);
    const AssetLayer& layer = asset.layers.at(0);
    EXPECT_EQ(layer.coding.ids, surface_ids({"left", "right"}));
    EXPECT_EQ(asset.bake.occlusion_rays + asset.bake.thickness_rays, 0U);
    for (const auto& [column, id] : {std::pair(2, 0U), {29, 1U}}) {
        const glm::u8vec3 color = layer.coding.ids.at(id).color;
        EXPECT_EQ(texel(layer.image, column, 16), (std::vector<int>{color.r, color.g, color.b}));
    }
    EXPECT_EQ(maps_of(asset).back().name, "ids");
}

TEST(AssetLayers, HaveBentNormalsAndThicknessOfAQuarterOfTheSize) {
    // The floor beside the wall of AssetMaps.OcclusionIsThatOfTheRays: bent normals lean away.
    AssetSource source = square_of({}, {});
    for (glm::vec3& position : source.mesh.positions) {
        const float beyond = std::max(position.x - 0.5F, 0.0F);
        position = {std::min(position.x, 0.5F), position.y, beyond};
    }
    source.mesh.normals.clear();
    AssetOptions options = options_without_occlusion();
    options.occlusion_rays = 0;
    options.layers = {LayerKind::thickness, LayerKind::bent_normal};
    const Asset asset = make_asset(source, options);
    EXPECT_FALSE(asset.occlusion_map);
    const Image& bent = asset.layers.at(1).image;
    EXPECT_EQ(bent.width, side / 4);
    EXPECT_EQ(bent.bits(), 16);
    EXPECT_EQ(asset.layers[0].image.channels, 1);
    // 32 rays without occlusion, for both.
    EXPECT_EQ(asset.bake.occlusion_rays, asset.bake.thickness_rays);
    EXPECT_GT(asset.bake.occlusion_rays, 0U);
    const auto codes = bent.as<std::uint16_t>();
    const std::size_t near = 3 * (std::size_t{4} * static_cast<std::size_t>(bent.width) + 3);
    EXPECT_LT(codes[near], 30000) << "x, away from the wall";
    EXPECT_GT(codes[near + 2], 40000);
    // The sheet has no other side: everything is as thick as the rays are long.
    EXPECT_DOUBLE_EQ(asset.layers[0].coding.range, 1.0);
    std::size_t open = 0;
    for (const StageReport& stage : asset.reports)
        open += stage.report.count("texel without a surface behind it");
    EXPECT_GT(open, 10U);
}

TEST(AssetLayers, AreThoseThatAreNotPartOfTheMaterial) {
    AssetOptions options = options_without_occlusion();
    options.layers = {LayerKind::color};
    EXPECT_THROW(make_asset(square_of({}, {}), options), InvalidInput);
    options.layers = {LayerKind::height, LayerKind::height};
    EXPECT_THROW(make_asset(square_of({}, {}), options), InvalidInput);
}

}  // namespace
}  // namespace relief::make
