// SPDX-License-Identifier: Apache-2.0
// Textures and normal maps of high meshes, with hand-computed lookups and in whole bakes.
#include "relief/mesh/bake.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "bake/high_surface.h"
#include "mesh/bake/bake_support.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"
#include "support/invariants.h"

namespace relief {
using namespace relief::detail;

namespace {

using test::bake;
using test::BakedImage;
using test::sized;

Image gray(int width, int height, std::vector<float> samples) {
    return {width, height, 1, ColorSpace::linear, std::move(samples)};
}

TEST(SurfaceTexture, InterpolatesAndWraps) {
    const Image image = gray(4, 1, {0.0F, 0.25F, 0.5F, 1.0F});
    SurfaceTexture texture;
    texture.image = std::make_shared<const Image>(image);
    const auto red = [&](double u) { return color_at(texture, {u, 0.5}).x; };
    EXPECT_DOUBLE_EQ(red(0.125), 0.0);
    EXPECT_DOUBLE_EQ(red(0.25), 0.125);
    EXPECT_DOUBLE_EQ(red(0.75), 0.75);
    // The middle between the last texel and the first.
    EXPECT_DOUBLE_EQ(red(1.0), 0.5);
    EXPECT_DOUBLE_EQ(red(-3.0), 0.5);
    EXPECT_DOUBLE_EQ(red(1.375), 0.25);
    texture.wrap_u = Wrap::clamp;
    EXPECT_DOUBLE_EQ(red(1.0), 1.0);
    EXPECT_DOUBLE_EQ(red(7.0), 1.0);
    EXPECT_DOUBLE_EQ(red(-1e30), 0.0);
    texture.wrap_u = Wrap::mirror;
    EXPECT_DOUBLE_EQ(red(1.375), 0.5);
    EXPECT_DOUBLE_EQ(red(-0.375), 0.25);
    texture.wrap_u = Wrap::repeat;
    texture.filter = TextureFilter::nearest;
    EXPECT_DOUBLE_EQ(red(0.49), 0.25);
    EXPECT_DOUBLE_EQ(red(0.51), 0.5);
    texture.transform.offset = {0.5F, 0.0F};
    EXPECT_DOUBLE_EQ(red(0.125), 0.5);
    EXPECT_DOUBLE_EQ(red(std::nan("")), 0.0);
}

TEST(SurfaceTexture, DecodesBeforeItFilters) {
    const Image bytes{2, 1, 3, ColorSpace::srgb,
                      std::vector<std::uint8_t>{0, 188, 255, 255, 0, 255}};
    SurfaceTexture texture;
    texture.image = std::make_shared<const Image>(bytes);
    const glm::dvec3 mean = color_at(texture, {0.5, 0.5});
    EXPECT_NEAR(mean.x, 0.5, 1e-7);
    EXPECT_NEAR(mean.y, 0.5 * 0.50288646, 1e-6);
    EXPECT_NEAR(mean.z, 1.0, 1e-7);
    const Image words{1, 1, 2, ColorSpace::srgb, std::vector<std::uint16_t>{48316, 1}};
    texture.image = std::make_shared<const Image>(words);
    EXPECT_NEAR(color_at(texture, {0.5, 0.5}).z, 0.50288646, 1e-6);
    const Image data{1, 1, 1, ColorSpace::linear, std::vector<std::uint8_t>{51}};
    texture.image = std::make_shared<const Image>(data);
    EXPECT_DOUBLE_EQ(color_at(texture, {0.5, 0.5}).z, 0.2);
}

TEST(HighMaterials, ColorIsFactorTimesTextureTimesVertex) {
    Mesh high = make_quad();
    high.colors.assign(4, {0.5F, 0.25F, 1.0F, 1.0F});
    const Image image = gray(2, 1, {0.25F, 0.75F});
    BakeOptions options = sized(2, 2);
    options.map.layers.colors = true;
    HighMaterials& detail = options.materials.emplace_back();
    detail.mesh = &high;
    detail.materials.resize(2);
    detail.materials[0].color = {1.0F, 0.5F, 0.25F};
    detail.materials[0].color_texture =
        SurfaceTexture{.image = std::make_shared<const Image>(image)};
    detail.materials[0].color_texture->filter = TextureFilter::nearest;
    const auto colors = [&] {
        return bake({}, make_quad(), options).colors;  // There is no high mesh, so the detail has
                                                       // no effect.
    };
    EXPECT_EQ(colors(), std::vector<float>(12, 0.0F));
    const std::vector<Mesh> meshes = {high};
    detail.mesh = &meshes[0];
    std::vector<float> found = bake(meshes, make_quad(), options).colors;
    EXPECT_EQ(found, (std::vector<float>{0.125F, 0.03125F, 0.0625F, 0.375F, 0.09375F, 0.1875F,
                                         0.125F, 0.03125F, 0.0625F, 0.375F, 0.09375F, 0.1875F}));
    // The detail has its own texture coordinates, all in the right half.
    detail.color_texcoords.assign(4, {0.9F, 0.5F});
    found = bake(meshes, make_quad(), options).colors;
    EXPECT_EQ(found[0], 0.375F);
    detail.color_texcoords.pop_back();
    EXPECT_EQ(test::message_of<InvalidInput>([&] { bake(meshes, make_quad(), options); }),
              "3 texture coordinates for 4 vertices");
}

TEST(HighMaterials, OpacityIsFactorTimesTextureTimesVertexUnlessOpaque) {
    std::vector<Mesh> meshes = {make_quad()};
    meshes[0].colors.assign(4, {1.0F, 1.0F, 1.0F, 0.5F});
    Image image = make_image(1, 1, 4, 8, ColorSpace::srgb);
    image.as<std::uint8_t>()[3] = 51;
    BakeOptions options = sized(2, 2);
    options.map.layers.opacity = true;
    HighMaterials& detail = options.materials.emplace_back();
    detail.mesh = meshes.data();
    detail.materials.resize(1);
    HighMaterial& material = detail.materials[0];
    material.color_texture = SurfaceTexture{.image = std::make_shared<const Image>(image)};
    const auto opacity = [&] { return bake(meshes, make_quad(), options).opacity; };
    EXPECT_EQ(opacity(), std::vector<float>(4, 1.0F));
    material.opacity = 0.5F;
    EXPECT_EQ(opacity(), std::vector<float>(4, 0.05F));
    material.color_texture.reset();
    EXPECT_EQ(opacity(), std::vector<float>(4, 0.25F));
    // Gray with alpha.
    Image two = make_image(1, 1, 2, 8, ColorSpace::srgb);
    two.as<std::uint8_t>()[1] = 255;
    material.color_texture = SurfaceTexture{.image = std::make_shared<const Image>(two)};
    EXPECT_EQ(opacity(), std::vector<float>(4, 0.25F));
    options.materials.clear();
    EXPECT_EQ(opacity(), std::vector<float>(4, 1.0F));
}

TEST(HighMaterials, AlphaIsCutAfterTheFactorsAndTheTexture) {
    const std::vector<Mesh> meshes = {make_quad()};
    BakeOptions options = sized(2, 2);
    options.map.layers.opacity = true;
    HighMaterials& detail = options.materials.emplace_back();
    detail.mesh = meshes.data();
    HighMaterial& material = detail.materials.emplace_back();
    const auto opacity = [&] { return bake(meshes, make_quad(), options).opacity.front(); };
    material.opacity = 0.5F;
    material.alpha_cutoff = 0.5F;
    EXPECT_EQ(opacity(), 1.0F);
    material.alpha_cutoff = 0.51F;
    EXPECT_EQ(opacity(), 0.0F);
    material.opacity.reset();
    EXPECT_EQ(opacity(), 1.0F) << "opaque";
}

TEST(HighMaterials, SurfaceIsFactorTimesTexture) {
    const std::vector<Mesh> meshes = {make_quad()};
    BakeOptions options = sized(2, 2);
    options.map.layers.surface = true;
    const auto surface = [&] {
        const std::vector<float> values = bake(meshes, make_quad(), options).surface;
        return std::vector<float>(values.begin(), values.begin() + 3);
    };
    EXPECT_EQ(surface(), (std::vector<float>{1.0F, 1.0F, 0.0F})) << "without a material";
    HighMaterials& detail = options.materials.emplace_back();
    detail.mesh = meshes.data();
    HighMaterial& material = detail.materials.emplace_back();
    material.roughness = 0.5F;
    material.metallic = 0.25F;
    EXPECT_EQ(surface(), (std::vector<float>{1.0F, 0.5F, 0.25F}));
    Image image = make_image(1, 1, 3, 32, ColorSpace::data);
    std::ranges::copy(std::vector<float>{0.125F, 0.5F, 0.75F}, image.as<float>().begin());
    material.surface_texture = SurfaceTexture{.image = std::make_shared<const Image>(image)};
    EXPECT_EQ(surface(), (std::vector<float>{1.0F, 0.25F, 0.1875F}));
    material.occlusion_texture = material.surface_texture;
    material.occlusion_strength = 0.5F;
    EXPECT_EQ(surface(), (std::vector<float>{0.5625F, 0.25F, 0.1875F}));
}

TEST(HighMaterials, EmissionIsFactorTimesTextureAndHasABound) {
    const std::vector<Mesh> meshes = {make_quad()};
    BakeOptions options = sized(2, 2);
    options.map.layers.emission = true;
    const auto emission = [&] {
        const std::vector<float> values = bake(meshes, make_quad(), options).emission;
        return std::vector<float>(values.begin(), values.begin() + 3);
    };
    const auto bound = [&] {
        return Baker(meshes, make_quad(), options).bounds(options.map.layers).emission;
    };
    EXPECT_EQ(emission(), (std::vector<float>{0.0F, 0.0F, 0.0F})) << "without a material";
    EXPECT_EQ(bound(), 0.0);
    HighMaterials& detail = options.materials.emplace_back();
    detail.mesh = meshes.data();
    HighMaterial& material = detail.materials.emplace_back();
    material.emission = {4.0F, 2.0F, 0.0F};
    EXPECT_EQ(emission(), (std::vector<float>{4.0F, 2.0F, 0.0F}));
    EXPECT_EQ(bound(), 4.0);
    Image image = make_image(1, 1, 3, 32, ColorSpace::linear);
    std::ranges::copy(std::vector<float>{0.25F, 0.5F, 0.125F}, image.as<float>().begin());
    material.emission_texture = SurfaceTexture{.image = std::make_shared<const Image>(image)};
    EXPECT_EQ(emission(), (std::vector<float>{1.0F, 1.0F, 0.0F}));
    EXPECT_EQ(bound(), 2.0) << "the largest factor times the largest texel";
}

TEST(HighMaterials, EmissionOfFilesHasAUnit) {
    const std::vector<float> values = {4.0F, 2.0F, 0.0F, 8.0F, 0.0F, 0.0F};
    const std::vector<TexelState> states(2, TexelState::baked);
    const LayerCoding coding{LayerKind::emission, 8, 4.0};
    Report report;
    const std::vector<std::byte> codes = encode_layer(values, states, coding, false, 0, report);
    EXPECT_EQ(codes[0], std::byte{255});
    EXPECT_EQ(codes[1], std::byte{188});
    EXPECT_EQ(codes[2], std::byte{0});
    EXPECT_EQ(codes[3], std::byte{255});
    EXPECT_EQ(report.count("emission outside the range of its file"), 1U);
    EXPECT_EQ(layer_metadata(coding).at("relief:range"), "4");
}

TEST(HighMaterials, MaterialsAreByTriangle) {
    std::vector<Mesh> meshes = {make_quad()};
    meshes[0].material_ranges = {{0, 1, 1U}, {1, 1, std::nullopt}};
    HighMaterials detail{meshes.data(), std::vector<HighMaterial>(2), {}};
    detail.materials[1].color = {0.5F, 0.0F, 0.0F};
    BakeOptions options = sized(64, 64);
    options.map.layers.colors = true;
    options.materials = {detail};
    const BakedImage image = bake(meshes, make_quad(), options);
    std::size_t red = 0, white = 0;
    for (std::size_t i = 0; i < 64UL * 64UL; ++i) {
        red += image.colors[3 * i] == 0.5F ? 1 : 0;
        white += image.colors[3 * i + 2] == 1.0F ? 1 : 0;
    }
    EXPECT_EQ(red + white, 64UL * 64UL);
    EXPECT_NEAR(static_cast<double>(red), 2048.0, 64.0);
    meshes[0].material_ranges[1].material = 2;
    EXPECT_EQ(test::message_of<InvalidInput>([&] { bake(meshes, make_quad(), options); }),
              "a high mesh names material 2, but there are only 2");
}

/// A map of this size with smooth slopes.
Image slopes(int width, int height) {
    Image normals = make_image(width, height, 3, 32, ColorSpace::data);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const auto first = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                    static_cast<std::size_t>(x));
            normals.as<float>()[first] = 0.5F * std::sin(0.3F * static_cast<float>(x));
            normals.as<float>()[first + 1] = 0.4F * std::cos(0.2F * static_cast<float>(y));
            normals.as<float>()[first + 2] = 1.0F;
        }
    }
    return normals;
}

TEST(HighMaterials, NormalMapsComeThroughOntoTheSameMesh) {
    Report report;
    for (const FlatCode flat : {FlatCode::middle, FlatCode::half}) {
        for (const Green green : {Green::up, Green::down}) {
            NormalMapFormat format;
            format.flat = flat;
            format.green = green;
            const Image map = encode_normal_map(slopes(64, 48), format, report);
            const Image reference = decode_normal_map(map, green, flat, report);
            for (const Mesh& mesh : {make_quad(), make_torus()}) {
                const std::vector<Mesh> high = {mesh};
                HighMaterials detail{high.data(), std::vector<HighMaterial>(1), {}};
                detail.materials[0].normal_map = SurfaceNormalMap{
                    {.image = std::make_shared<const Image>(map)}, 1.0F, green, flat};
                BakeOptions options = sized(64, 48);
                options.materials = {detail};
                const BakedImage image = bake(high, mesh, options);
                double worst = 0.0;
                for (std::size_t i = 0; i < image.states.size(); ++i) {
                    const std::span<const float> n = reference.as<float>();
                    worst = std::max(
                        worst,
                        degrees_between(image.normal(i), {n[3 * i], n[3 * i + 1], n[3 * i + 2]}));
                }
                // The error of a bilinear lookup near a texel center.
                EXPECT_LT(worst, 0.01);
            }
        }
    }
}

TEST(HighMaterials, NormalMapsAreScaledTransformedOrReported) {
    // Slopes of 3/4 to the right.
    const Image map{1, 1, 3, ColorSpace::data, std::vector<float>{0.8F, 0.5F, 0.9F}};
    std::vector<Mesh> high = {make_quad()};
    BakeOptions options = sized(2, 2);
    options.materials = {{high.data(), std::vector<HighMaterial>(1), {}}};
    SurfaceNormalMap& normal_map = options.materials[0].materials[0].normal_map.emplace();
    normal_map.texture.image = std::make_shared<const Image>(map);
    const auto baked = [&] { return bake(high, make_quad(), options).normal(0); };
    EXPECT_LT(degrees_between(baked(), {0.6, 0, 0.8}), 1e-5);
    normal_map.scale = 2.0F;
    EXPECT_LT(degrees_between(baked(), {1.2, 0, 0.8}), 1e-5);
    normal_map.scale = 0.0F;
    EXPECT_LT(degrees_between(baked(), {0, 0, 1}), 1e-5);
    normal_map.scale = 1.0F;
    // The image rotates clockwise by 90 degrees: a slope to the right becomes a slope downwards.
    normal_map.texture.transform.rotation = std::numbers::pi_v<float> / 2.0F;
    EXPECT_LT(degrees_between(baked(), {0, -0.6, 0.8}), 1e-4);
    normal_map.texture.transform = {};
    // Without a layer of normals, nothing reads the map.
    options.map.layers.normals = false;
    EXPECT_TRUE(bake(high, make_quad(), options).report.empty());
    options.map.layers.normals = true;
    high[0].texcoords.clear();
    const BakedImage bare = bake(high, make_quad(), options);
    EXPECT_LT(degrees_between(bare.normal(0), {0, 0, 1}), 1e-5);
    EXPECT_EQ(bare.report.count("normal map without texture coordinates"), 1U);
    const Image narrow = gray(1, 1, {0.5F});
    normal_map.texture.image = std::make_shared<const Image>(narrow);
    EXPECT_EQ(test::message_of<InvalidInput>([&] { bake(high, make_quad(), options); }),
              "a normal map of 1 channels, not 3");
}

TEST(HighMaterials, NormalMapsHaveNoSayInOcclusion) {
    const Image map{1, 1, 3, ColorSpace::data, std::vector<float>{0.8F, 0.5F, 0.9F}};
    const std::vector<Mesh> high = {make_torus()};
    HighMaterials detail{high.data(), std::vector<HighMaterial>(1), {}};
    detail.materials[0].normal_map =
        SurfaceNormalMap{.texture = {.image = std::make_shared<const Image>(map)}};
    BakeOptions options = sized(32, 32);
    options.map.layers.occlusion = OcclusionOptions{};
    const BakedImage plain = bake(high, make_torus(), options);
    options.materials = {detail};
    const BakedImage mapped = bake(high, make_torus(), options);
    EXPECT_EQ(mapped.occlusion, plain.occlusion);
    EXPECT_NE(mapped.normals, plain.normals);
}

}  // namespace
}  // namespace relief
