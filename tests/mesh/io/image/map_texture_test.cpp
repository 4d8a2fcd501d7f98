// SPDX-License-Identifier: Apache-2.0
// Maps of all kinds as textures: formats, color spaces, filters of mip levels, errors, refusals.
#include "relief/mesh/map_texture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include "relief/mesh/image_file.h"
#include "support/images.h"
#include "support/invariants.h"

namespace relief {
namespace {

using test::image_of;
using test::message_of;
using test::samples_of;
using testing::HasSubstr;

/// A map of 8 x 8 texels with values from 0 to 1 in each channel.
Image values_for(int channels, int bits, ColorSpace space = ColorSpace::data) {
    Image image = make_image(8, 8, channels, bits, space);
    std::visit(
        [&]<typename Sample>(std::vector<Sample>& samples) {
            for (std::size_t i = 0; i < samples.size(); ++i) {
                const double value = static_cast<double>(i % 61) / 61.0;
                const double largest = bits == 32 ? 1.0 : bits == 8 ? 255.0 : 65535.0;
                samples[i] = static_cast<Sample>(value * largest);
            }
        },
        image.samples);
    return image;
}

Image values_for(const MapTextureKind& kind) {
    if (kind.filter != MipFilter::normals) return values_for(kind.channels, 8);
    Image normals = make_image(8, 8, 3, 32, ColorSpace::data);
    for (std::size_t i = 0; i < 64; ++i) {
        float* const normal = normals.as<float>().data() + 3 * i;
        const float x = 0.04F * static_cast<float>(i % 8);
        normal[0] = x;
        normal[1] = 0.1F;
        normal[2] = std::sqrt(0.99F - x * x);
    }
    return normals;
}

TEST(MapTexture, EveryKindHasAllItsFormatsWithAllLevels) {
    for (const MapTextureKind& kind : map_texture_kinds()) {
        for (const TextureFormat format : kind.formats) {
            MapTextureOptions options;
            options.kind = kind.kind;
            options.format = format;
            const MapTexture encoded = encode_map_texture(values_for(kind), options);
            const std::string name = std::string(enum_name(kind.kind)) + " in " + enum_name(format);
            EXPECT_EQ(encoded.texture.levels.size(), 4U) << name;
            EXPECT_EQ(encoded.texture.is_srgb, kind.is_color && has_srgb_variant(format)) << name;
            EXPECT_EQ(read_description(encoded.texture.metadata).kind, kind.kind) << name;
            ASSERT_EQ(encoded.levels.size(), 4U) << name;
            EXPECT_EQ(encoded.levels[1].width, 4) << name;
            const bool are_normals = kind.filter == MipFilter::normals;
            EXPECT_LT(encoded.levels[0].error.rms, are_normals ? 2.0 : 40.0) << name;
            const auto file = std::filesystem::path(testing::TempDir()) / "map.ktx2";
            write_texture(file, encoded.texture);
            EXPECT_EQ(read_texture(file).levels, encoded.texture.levels) << name;
        }
    }
}

TEST(MapTexture, ColorsAreAveragedInLinearLight) {
    const Image map = image_of<std::uint8_t>(2, 1, 3, ColorSpace::srgb, {0, 0, 0, 255, 255, 255});
    MapTextureOptions options;
    options.format = TextureFormat::rgba8;
    const MapTexture encoded = encode_map_texture(map, options);
    // The sRGB code of half the light is 188; the mean of the codes would be 128.
    EXPECT_EQ(std::to_integer<int>(encoded.texture.levels[1][0]), 188);
    EXPECT_TRUE(encoded.texture.is_srgb);
}

TEST(MapTexture, LinearFormatsOfEmissionStoreLight) {
    // The sRGB code 188 is half of the light, and 0 and 255 have a mean of a half.
    const Image coded = image_of<std::uint8_t>(2, 1, 3, ColorSpace::srgb, {0, 0, 0, 255, 255, 255});
    const Image light =
        image_of<float>(2, 1, 3, ColorSpace::linear, {0.0F, 0.0F, 0.0F, 1.0F, 1.0F, 1.0F});
    for (const TextureFormat format : {TextureFormat::rgba16f, TextureFormat::bc6h}) {
        MapTextureOptions options;
        options.kind = MapKind::emission;
        options.format = format;
        for (const Image* map : {&coded, &light}) {
            const MapTexture encoded = encode_map_texture(*map, options);
            EXPECT_FALSE(encoded.texture.is_srgb);
            const Image level = decode_texture_level(encoded.texture, 1);
            EXPECT_FLOAT_EQ(level.as<float>()[0], 0.5F) << enum_name(format);
            EXPECT_LT(encoded.levels[1].error.rms, 0.01) << enum_name(format);
        }
        const Image gray = image_of<std::uint8_t>(1, 1, 3, ColorSpace::srgb, {188, 188, 188});
        const Image level = decode_texture_level(encode_map_texture(gray, options).texture, 0);
        EXPECT_NEAR(level.as<float>()[0], 0.503F, 0.001F) << enum_name(format);
    }
}

TEST(MapTexture, ErrorsOfLightAreMeasuredSrgbCodedAlsoAboveOne) {
    const Image map = image_of<float>(2, 1, 3, ColorSpace::linear,
                                      {16.0F, 16.0F, 16.0F, 16.003F, 16.003F, 16.003F});
    MapTextureOptions options;
    options.kind = MapKind::emission;
    options.format = TextureFormat::rgba16f;
    options.has_mips = false;
    // 16.003 becomes 16: 0.003 of the light is 0.003 / 16 / 2.4 * 3.35 * 255 codes.
    const double expected = 0.003 / 16.0 / 2.4 * 3.35 * 255.0 / std::sqrt(2.0);
    EXPECT_NEAR(encode_map_texture(map, options).levels[0].error.rms, expected, 0.1 * expected);
}

TEST(MapTexture, HeightsInBc6hHaveSmallerErrorsThanInBc4) {
    Image map = make_image(64, 64, 1, 32, ColorSpace::data);
    for (std::size_t i = 0; i < 64 * 64; ++i) {
        const auto x = static_cast<float>(i % 64);
        const auto y = static_cast<float>(i / 64);
        map.as<float>()[i] = 0.5F + 0.3F * std::sin(0.3F * x) * std::cos(0.25F * y);
    }
    const auto error = [&](TextureFormat format) {
        MapTextureOptions options;
        options.kind = MapKind::height;
        options.format = format;
        const MapTexture encoded = encode_map_texture(map, options);
        return encoded.levels[0].error.rms;
    };
    // 16 values on the line of a block in place of 8.
    EXPECT_LT(error(TextureFormat::bc6h), 0.6 * error(TextureFormat::bc4));
    EXPECT_LT(error(TextureFormat::bc6h_sfloat), 0.6 * error(TextureFormat::bc4));
    for (float& height : map.as<float>())
        height -= 0.5F;
    // Half of the codes up to 0.3 are below 0.004, so that slopes through 0 are no lines of codes.
    EXPECT_LT(error(TextureFormat::bc6h_sfloat), 4.0);
}

TEST(MapTexture, ValuesAreAveragedAsTheyAre) {
    const Image map = image_of<std::uint8_t>(2, 1, 1, ColorSpace::data, {0, 200});
    MapTextureOptions options;
    options.kind = MapKind::occlusion;
    options.format = TextureFormat::r8;
    EXPECT_EQ(std::to_integer<int>(encode_map_texture(map, options).texture.levels[1][0]), 100);
}

/// The roughness of the level of one texel.
double smallest_roughness(const Image& map, MapKind kind, const Image* normals,
                          bool is_smoothness = false) {
    MapTextureOptions options;
    options.kind = kind;
    options.is_smoothness = is_smoothness;
    const Image level = map_mip_levels(map, options, normals).back();
    return static_cast<double>(
        samples_of<float>(channel_of(level, kind == MapKind::packed ? 1 : 0))[0]);
}

TEST(MapTexture, RoughnessIsAveragedAsTheVarianceOfSlopes) {
    const Image map = image_of<float>(2, 1, 1, ColorSpace::data, {0.2F, 0.8F});
    const double expected = std::pow((std::pow(0.2, 4) + std::pow(0.8, 4)) / 2.0, 0.25);
    EXPECT_NEAR(smallest_roughness(map, MapKind::roughness, nullptr), expected, 1e-6);
    const Image smooth = image_of<float>(2, 1, 1, ColorSpace::data, {0.8F, 0.2F});
    EXPECT_NEAR(smallest_roughness(smooth, MapKind::roughness, nullptr, true), 1.0 - expected,
                1e-6);
}

TEST(MapTexture, NormalsMakeSmallerLevelsRougher) {
    // Two normals of slopes +-0.5: the variance of the slopes along x is 0.25, and the mean of both
    // axes 0.125.
    const float size = std::sqrt(1.25F);
    const Image normals =
        image_of<float>(2, 1, 3, ColorSpace::data,
                        {0.5F / size, 0.0F, 1.0F / size, -0.5F / size, 0.0F, 1.0F / size});
    const Image map = image_of<float>(2, 1, 1, ColorSpace::data, {0.5F, 0.5F});
    const double expected = std::pow(std::pow(0.5, 4) + 2.0 * 0.125, 0.25);
    EXPECT_NEAR(smallest_roughness(map, MapKind::roughness, &normals), expected, 1e-5);
    const Image packed =
        image_of<float>(2, 1, 3, ColorSpace::data, {1.0F, 0.5F, 0.0F, 1.0F, 0.5F, 0.0F});
    EXPECT_NEAR(smallest_roughness(packed, MapKind::packed, &normals), expected, 1e-5);
}

TEST(MapTexture, NormalsOfAnotherSizeAreReported) {
    const Image map = image_of<float>(2, 1, 1, ColorSpace::data, {0.5F, 0.5F});
    const Image normals = image_of<float>(1, 1, 3, ColorSpace::data, {0.0F, 0.0F, 1.0F});
    MapTextureOptions options;
    options.kind = MapKind::roughness;
    Report report;
    map_mip_levels(map, options, &normals, report);
    ASSERT_EQ(report.findings().size(), 1U);
    EXPECT_THAT(report.findings()[0].kind, HasSubstr("another size"));
}

TEST(MapTexture, CutoutsKeepTheirCoverage) {
    // Thin lines: a quarter of the texels, whose alpha vanishes in means.
    Image map = make_image(64, 64, 4, 8, ColorSpace::srgb);
    const auto samples = map.as<std::uint8_t>();
    for (std::size_t i = 0; i < 64 * 64; ++i) {
        const bool is_inside = i % 64 % 8 < 1 || i / 64 % 8 == 3;
        samples[4 * i + 3] = is_inside ? 255 : 0;
    }
    const auto coverage = [](const Image& image) {
        const Image alpha = channel_of(image, 3);
        const auto values = alpha.as<float>();
        return static_cast<double>(std::count_if(values.begin(), values.end(),
                                                 [](float value) { return value >= 0.5F; })) /
               static_cast<double>(values.size());
    };
    MapTextureOptions options;
    const double exact = coverage(map);
    EXPECT_NEAR(coverage(map_mip_levels(map, options)[2]), 0.0, 0.01);
    options.alpha_cutoff = 0.5F;
    const std::vector<Image> levels = map_mip_levels(map, options);
    EXPECT_GE(coverage(levels[0]), exact - 0.01);
    EXPECT_GE(coverage(levels[2]), exact - 0.02);
}

TEST(MapTexture, SampledErrorsAreCloseToAllErrors) {
    const Image map = test::rough(256, 256);
    MapTextureOptions options;
    options.kind = MapKind::height;
    const double all = encode_map_texture(map, options).levels[0].error.rms;
    options.measured_texels = 1 << 13;
    const MapTexture sampled = encode_map_texture(map, options);
    EXPECT_EQ(sampled.levels[0].error.count, 8192U);
    EXPECT_NEAR(sampled.levels[0].error.rms, all, 0.05 * all);
    ASSERT_TRUE(sampled.levels[0].confidence);
    EXPECT_NEAR(sampled.levels[0].error.rms, all, sampled.levels[0].confidence->rms_margin);
    EXPECT_LT(sampled.levels[0].confidence->rms_margin, 0.1 * all);
    options.measured_texels = 0;
    EXPECT_EQ(encode_map_texture(map, options).levels[0].error.count, 0U);
}

TEST(MapTexture, OtherInputIsRefused) {
    const auto message = [](const Image& map, MapKind kind, std::optional<TextureFormat> format) {
        return message_of<InvalidInput>([&] {
            MapTextureOptions options;
            options.kind = kind;
            options.format = format;
            encode_map_texture(map, options);
        });
    };
    EXPECT_EQ(message(values_for(3, 8), MapKind::position, {}),
              "a map of positions is not stored in textures");
    EXPECT_EQ(message(values_for(1, 8), MapKind::roughness, TextureFormat::bc7),
              "a roughness map is not stored in bc7: its formats are bc4, r8, r16, r16f");
    EXPECT_EQ(message(values_for(3, 8), MapKind::roughness, {}),
              "a roughness map has 1 channels, not 3");
    EXPECT_EQ(message(values_for(3, 8), MapKind::normal, {}),
              "normals have float samples, not 8 bits");
    EXPECT_EQ(message(values_for(4, 8), MapKind::color, TextureFormat::bc1),
              "the map has alpha, but bc1 stores none");
}

TEST(MapTexture, ImagesAreWrittenAsTexturesOfTheirStatedKind) {
    const auto file = std::filesystem::path(testing::TempDir()) / "written.ktx2";
    const auto entries = write_description({.kind = MapKind::packed, .detail = "unity"}, 8);
    write_image(file, values_for(4, 8), entries);
    const GpuTexture texture = read_texture(file);
    EXPECT_EQ(texture.format, TextureFormat::bc7);
    EXPECT_FALSE(texture.is_srgb);
    EXPECT_EQ(texture.levels.size(), 4U);
    EXPECT_EQ(read_description(texture.metadata).detail, "unity");
    EXPECT_EQ(message_of<InvalidInput>([&] { write_image(file, values_for(4, 8)); }),
              "a texture needs the kind of its map (relief:content)");
    EXPECT_EQ(message_of<InvalidInput>([&] {
                  write_image(file, values_for(3, 8),
                              write_description({.kind = MapKind::height}, 8));
              }),
              "a texture of a height map has 1 channels, not 3");
}

TEST(MapTexture, NormalsInImagesAreEncodedFromExactFloats) {
    const auto file = std::filesystem::path(testing::TempDir()) / "normals.dds";
    const Image normals = values_for(*find_map_texture_kind(MapKind::normal));
    const NormalMapFormat format{.bits = 32, .green = Green::down};
    Report report;
    write_image(file, encode_normal_map(normals, format), normal_map_metadata(format), {}, report);
    ASSERT_FALSE(report.findings().empty());
    EXPECT_THAT(report.findings()[0].kind, HasSubstr("metadata that DDS cannot hold"));
    const GpuTexture texture = read_texture(file);
    ASSERT_EQ(texture.format, TextureFormat::bc5);
    const Image decoded =
        decode_xy_map(decode_texture_level(texture, 0), {0, 1}, Green::down, FlatCode::half);
    for (std::size_t i = 0; i < 64; ++i) {
        const auto at = [&](const Image& image) {
            const float* const normal = image.as<float>().data() + 3 * i;
            return glm::dvec3(normal[0], normal[1], normal[2]);
        };
        EXPECT_LT(degrees_between(at(normals), at(decoded)), 1.0);
    }
}

}  // namespace
}  // namespace relief
