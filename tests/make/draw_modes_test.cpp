// SPDX-License-Identifier: Apache-2.0
// Opaque, masked and blended materials of a source stay apart in its asset.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "relief/make/asset.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/image.h"
#include "support/shapes.h"
#include "tools/workplace.h"

namespace relief::make {
namespace {

using testing::ElementsAre;

/// A square whose left half has material 0 and whose right half has material 1. Its texture
/// coordinates can be kept, so that texels have known places.
AssetSource square() {
    AssetSource source;
    source.name = "square";
    source.mesh = test::grid(8);
    const auto is_left = [&](const glm::uvec3& triangle) {
        const std::vector<glm::vec3>& at = source.mesh.positions;
        return at[triangle.x].x + at[triangle.y].x + at[triangle.z].x < 1.5F;
    };
    std::vector<glm::uvec3>& triangles = source.mesh.triangles;
    const auto middle = std::stable_partition(triangles.begin(), triangles.end(), is_left);
    const auto count = static_cast<std::uint32_t>(triangles.end() - middle);
    source.mesh.material_ranges = {{0, count, 0U}, {count, count, 1U}};
    source.materials.resize(2);
    source.materials[0].color = {1.0F, 0.0F, 0.0F};
    source.materials[1].color = {0.0F, 1.0F, 0.0F};
    source.draw_modes.resize(2);
    return source;
}

void set_alpha(AssetSource& source, std::size_t material, DrawMode mode, float opacity) {
    source.draw_modes[material] = mode;
    source.materials[material].opacity = opacity;
}

AssetOptions kept_coordinates() {
    AssetOptions options;
    options.triangles = 20;
    options.size = {32, 32};
    options.padding = 0;
    options.keep_texcoords = true;
    options.occlusion = false;
    return options;
}

std::vector<int> values_at(const Image& image, int x, int y) {
    const auto channels = static_cast<std::size_t>(image.channels);
    const std::size_t at = channels * static_cast<std::size_t>(y * image.width + x);
    const auto samples = image.as<std::uint8_t>().subspan(at, channels);
    return {samples.begin(), samples.end()};
}

const Report& bake_report(const Asset& asset) {
    return asset.reports.back().report;
}

TEST(DrawModes, StayApart) {
    AssetSource source = square();
    set_alpha(source, 1, {AlphaMode::blend, 0.5F, true}, 0.25F);
    const Asset asset = make_asset(source, kept_coordinates());
    EXPECT_THAT(asset.draw_modes, ElementsAre(DrawMode{}, DrawMode{AlphaMode::blend, 0.5F, true}));
    EXPECT_TRUE(bake_report(asset).empty());
    EXPECT_THAT(values_at(*asset.color_map, 4, 16), ElementsAre(255, 0, 0, 255));
    EXPECT_THAT(values_at(*asset.color_map, 28, 16), ElementsAre(0, 255, 0, 64));
    EXPECT_LE(asset.mesh.triangles.size(), 20U);
    // The border between both halves stays.
    double opaque_area = 0.0;
    for (const MaterialRange& range : asset.mesh.material_ranges) {
        for (std::uint32_t i = 0; i < range.triangle_count; ++i) {
            const glm::uvec3& t = asset.mesh.triangles[range.first_triangle + i];
            const std::vector<glm::vec3>& at = asset.mesh.positions;
            const glm::vec3 area = glm::cross(at[t.y] - at[t.x], at[t.z] - at[t.x]);
            if (range.material == 0U) opaque_area += 0.5 * glm::length(glm::dvec3(area));
        }
    }
    EXPECT_NEAR(opaque_area, 0.5, 1e-6);

    const test::TemporaryDirectory folder;
    write_asset(folder / "a.glb", asset, 1);
    EXPECT_TRUE(verify_asset(folder / "a.glb", asset).empty());
    const GltfDocument document = test::read_document(folder / "a.glb");
    const GltfView view = document.view();
    ASSERT_EQ(view.materials.size(), 2U);
    EXPECT_EQ(view.materials[0].alpha_mode, AlphaMode::opaque);
    EXPECT_FALSE(view.materials[0].double_sided);
    EXPECT_EQ(view.materials[1].name, "square_blend");
    EXPECT_EQ(view.materials[1].alpha_mode, AlphaMode::blend);
    EXPECT_TRUE(view.materials[1].double_sided);
    EXPECT_EQ(view.images.size(), 2U) << "both have the same maps";
    EXPECT_EQ(document.triangle_primitives().size(), 4U) << "two for each level";

    Asset other = asset;
    other.draw_modes[1].alpha_mode = AlphaMode::mask;
    EXPECT_EQ(verify_asset(folder / "a.glb", other).count("another alpha mode"), 1U);
    other = asset;
    other.draw_modes.pop_back();
    EXPECT_EQ(verify_asset(folder / "a.glb", other).count("another number of materials than 1"),
              1U);
}

/// A blended sheet a little above an opaque square: a cornea and an iris.
AssetSource iris_and_cornea() {
    AssetSource source;
    source.name = "eye";
    const Mesh iris = test::grid(8);
    std::vector<glm::vec3> positions = iris.positions;
    std::vector<glm::uvec3> triangles = iris.triangles;
    const auto first = static_cast<std::uint32_t>(positions.size());
    for (const glm::vec3& position : iris.positions)
        positions.push_back(position + glm::vec3(0.0F, 0.0F, 0.002F));
    for (const glm::uvec3& triangle : iris.triangles)
        triangles.push_back(triangle + first);
    const auto count = static_cast<std::uint32_t>(iris.triangles.size());
    source.mesh = test::mesh_from(positions, triangles);
    source.mesh.material_ranges = {{0, count, 0U}, {count, count, 1U}};
    source.materials.resize(2);
    source.materials[0].color = {1.0F, 0.0F, 0.0F};
    source.draw_modes = {{}, {AlphaMode::blend}};
    source.materials[1].opacity = 0.25F;
    return source;
}

TEST(DrawModes, SeeOnlyTheirOwnSurface) {
    AssetOptions options;
    options.triangles = 100;
    options.size = {64, 64};
    options.padding = 2;
    options.occlusion = false;
    options.remesh = Remeshing::never;
    const auto transparent_share = [&](const Asset& asset) {
        // These texels are at the centers of the opaque triangles.
        int all = 0, transparent = 0;
        for (const MaterialRange& range : asset.mesh.material_ranges) {
            for (std::uint32_t i = 0; range.material == 0U && i < range.triangle_count; ++i) {
                const glm::uvec3& t = asset.mesh.triangles[range.first_triangle + i];
                const std::vector<glm::vec2>& at = asset.mesh.texcoords;
                const glm::vec2 uv = 64.0F * (at[t.x] + at[t.y] + at[t.z]) / 3.0F;
                ++all;
                transparent += values_at(*asset.color_map, static_cast<int>(uv.x),
                                         static_cast<int>(uv.y))[3] < 255
                                   ? 1
                                   : 0;
            }
        }
        EXPECT_GT(all, 1);
        return static_cast<double>(transparent) / all;
    };
    const Asset asset = make_asset(iris_and_cornea(), options);
    ASSERT_EQ(asset.draw_modes.size(), 2U);
    EXPECT_EQ(transparent_share(asset), 0.0);
    options.match = PartMatching::all;
    EXPECT_EQ(transparent_share(make_asset(iris_and_cornea(), options)), 1.0);
}

TEST(DrawModes, StayOnAClosedSurface) {
    // A ball with a blended cap, which shares vertices with the rest.
    AssetSource source;
    source.name = "ball";
    source.mesh = test::sphere(48, 24);
    source.mesh.normals.clear();
    source.mesh.texcoords.clear();
    source.mesh.tangents.clear();
    const auto is_opaque = [&](const glm::uvec3& t) {
        const std::vector<glm::vec3>& at = source.mesh.positions;
        return at[t.x].y + at[t.y].y + at[t.z].y < 2.4F;
    };
    std::vector<glm::uvec3>& triangles = source.mesh.triangles;
    const auto middle = std::stable_partition(triangles.begin(), triangles.end(), is_opaque);
    const auto first = static_cast<std::uint32_t>(middle - triangles.begin());
    const auto count = static_cast<std::uint32_t>(triangles.size());
    source.mesh.material_ranges = {{0, first, 0U}, {first, count - first, 1U}};
    source.materials.resize(2);
    source.draw_modes = {{}, {AlphaMode::blend}};
    source.materials[1].opacity = 0.25F;
    AssetOptions options;
    options.triangles = 300;
    options.size = {64, 64};
    options.padding = 2;
    options.occlusion = false;
    options.remesh = Remeshing::always;
    options.resolution = 24;
    const Asset asset = make_asset(source, options);
    ASSERT_EQ(asset.draw_modes.size(), 2U);
    double blended_height = 0.0;
    std::size_t blended = 0;
    for (const MaterialRange& range : asset.mesh.material_ranges) {
        for (std::uint32_t i = 0; range.material == 1U && i < range.triangle_count; ++i) {
            const glm::uvec3& t = asset.mesh.triangles[range.first_triangle + i];
            const std::vector<glm::vec3>& at = asset.mesh.positions;
            blended_height += (at[t.x].y + at[t.y].y + at[t.z].y) / 3.0;
            ++blended;
        }
    }
    ASSERT_GT(blended, 5U);
    EXPECT_GT(blended_height / static_cast<double>(blended), 0.8);
    // The few blended triangles have the tangents of the whole mesh.
    const test::TemporaryDirectory folder;
    write_asset(folder / "a.glb", asset, 0);
    const Report problems = verify_asset(folder / "a.glb", asset);
    EXPECT_EQ(problems.count("tangents that are not MikkTSpace's"), 0U);
}

TEST(DrawModes, HaveOneLimitForMaskedMaterials) {
    AssetSource source = square();
    set_alpha(source, 0, {AlphaMode::mask, 0.25F}, 0.375F);
    set_alpha(source, 1, {AlphaMode::mask, 0.25F}, 0.125F);
    Asset asset = make_asset(source, kept_coordinates());
    EXPECT_TRUE(asset.draw_modes.empty());
    EXPECT_EQ(asset.material.alpha_mode, AlphaMode::mask);
    EXPECT_EQ(asset.material.alpha_cutoff, 0.25F);
    EXPECT_THAT(values_at(*asset.color_map, 28, 16), ElementsAre(0, 255, 0, 32));
    source.draw_modes[0].alpha_cutoff = 0.5F;
    asset = make_asset(source, kept_coordinates());
    EXPECT_EQ(asset.material.alpha_cutoff, 0.5F);
    EXPECT_THAT(values_at(*asset.color_map, 4, 16), ElementsAre(255, 0, 0, 0));
    EXPECT_THAT(values_at(*asset.color_map, 28, 16), ElementsAre(0, 255, 0, 0));
    EXPECT_EQ(bake_report(asset).count("masked materials with different alpha cutoffs"), 2U);
}

TEST(DrawModes, AreOpaqueIfAllTexelsAre) {
    AssetSource source = square();
    set_alpha(source, 0, {AlphaMode::blend}, 1.0F);
    set_alpha(source, 1, {AlphaMode::blend}, 0.5F);
    const Asset asset = make_asset(source, kept_coordinates());
    ASSERT_EQ(asset.draw_modes.size(), 2U);
    EXPECT_EQ(asset.draw_modes[0].alpha_mode, AlphaMode::opaque);
    EXPECT_EQ(asset.reports.front().report.count("transparent material that is opaque everywhere"),
              1U);
    // A texture with alpha that no material uses is no reason to blend, but one that is used is.
    source.materials[0].color_texture = SurfaceTexture{
        .image = std::make_shared<const Image>(
            Image{1, 1, 4, ColorSpace::srgb, std::vector<std::uint8_t>{255, 255, 255, 254}})};
    EXPECT_TRUE(make_asset(source, kept_coordinates()).draw_modes.empty());
}

TEST(DrawModes, AreOneIfTheStartDoesNotHaveThem) {
    AssetSource source = square();
    set_alpha(source, 1, {AlphaMode::blend}, 0.25F);
    AssetOptions options = kept_coordinates();
    std::vector<AlphaMode> alpha_modes;
    AssetStart start;
    options.take_mesh = [&](std::string_view stage, const StageMesh& after) {
        if (stage != "decimate") return;
        start = {.stage = "frames", .mesh = after.mesh};
        alpha_modes = after.alpha_modes;
    };
    const Asset whole = make_asset(source, options);
    options.take_mesh = nullptr;
    options.start = start;
    const Asset merged = make_asset(source, options);
    EXPECT_TRUE(merged.draw_modes.empty());
    EXPECT_EQ(merged.material.alpha_mode, AlphaMode::blend);
    EXPECT_EQ(bake_report(merged).count("opaque material beside blended ones"), 1U);
    options.start->alpha_modes = alpha_modes;
    const Asset same = make_asset(source, options);
    EXPECT_EQ(same.draw_modes, whole.draw_modes);
    EXPECT_EQ(same.mesh.positions, whole.mesh.positions);
    EXPECT_EQ(same.color_map->samples, whole.color_map->samples);
}

}  // namespace
}  // namespace relief::make
