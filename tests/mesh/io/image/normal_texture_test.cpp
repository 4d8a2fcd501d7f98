// SPDX-License-Identifier: Apache-2.0
// Textures of normals that are encoded by bands: bytes, errors and findings are those of the whole
// map and its mip levels.
#include "relief/mesh/normal_texture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "relief/mesh/normal_map.h"
#include "support/invariants.h"

namespace relief {
namespace {

using test::message_of;
using testing::HasSubstr;

/// Unit normals of waves whose length and height change from left to right. \param turned  the
/// number of texels that face back
Image growing_waves(int width, int height, int turned = 0) {
    Image slopes = make_image(width, height, 2, 32, ColorSpace::data);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            float* const slope = slopes.as<float>().data() + 2 * (y * width + x);
            const double size = 0.1 + 0.8 * x / width;
            slope[0] = static_cast<float>(size * std::sin(0.9 * x + 0.3 * y));
            slope[1] = static_cast<float>(size * std::cos(0.2 * x - 1.1 * y));
        }
    }
    Image normals = normals_from_slopes(slopes);
    for (int i = 0; i < turned; ++i)
        normals.as<float>()[static_cast<std::size_t>(3 * 7 * i + 2)] *= -1.0F;
    return normals;
}

Image rows_from(const Image& image, int first, int count) {
    return part_of(image, {0, first, image.width, count});
}

NormalTexture encoded_by_bands(const Image& normals, const Image* alpha, int rows,
                               const NormalTextureOptions& options, Report& report) {
    NormalTextureEncoder encoder(normals.width, normals.height, alpha != nullptr, options);
    for (int first = 0; first < normals.height; first += rows) {
        const int count = std::min(rows, normals.height - first);
        const Image part = alpha != nullptr ? rows_from(*alpha, first, count) : Image{};
        encoder.add(rows_from(normals, first, count), alpha != nullptr ? &part : nullptr);
    }
    return encoder.finish(report);
}

std::vector<std::string> outcome_texts(const Report& report) {
    std::vector<std::string> texts;
    for (const Finding& finding : report.findings())
        texts.push_back(to_string(finding));
    return texts;
}

TEST(NormalTexture, HasTheBytesOfTheWholeMapAndItsLevels) {
    for (const glm::ivec2 size : {glm::ivec2(37, 23), glm::ivec2(64, 32), glm::ivec2(1, 9)}) {
        const Image normals = growing_waves(size.x, size.y, size.x > 1 ? 5 : 0);
        Report expected_report;
        std::vector<std::vector<std::byte>> expected = {
            encode_normal_blocks(normals, {}, expected_report)};
        for (Image& level : normal_mip_levels(normals)) {
            split_lengths(level, expected_report);
            expected.push_back(encode_normal_blocks(level, {}, expected_report));
        }
        for (const int rows : {1, 3, 8, size.y}) {
            Report report;
            const NormalTexture encoded = encoded_by_bands(normals, nullptr, rows, {}, report);
            EXPECT_EQ(encoded.texture.levels, expected) << size.x << " by bands of " << rows;
            EXPECT_EQ(outcome_texts(report), outcome_texts(expected_report)) << rows;
            EXPECT_EQ(encoded.texture.swizzle, "rg01");
        }
    }
}

TEST(NormalTexture, IsTheSameForAnyBandsInEveryFormat) {
    const Image normals = growing_waves(30, 21);
    Image alpha = make_image(30, 21, 1, 32, ColorSpace::data);
    for (std::size_t i = 0; i < alpha.sample_count(); ++i)
        alpha.as<float>()[i] = static_cast<float>(i % 17) / 16.0F;
    for (const TextureFormat format : find_map_texture_kind(MapKind::normal)->formats) {
        const NormalTextureOptions options{.format = format, .roughness = 0.3};
        for (const Image* const of_texels :
             {static_cast<const Image*>(nullptr), static_cast<const Image*>(&alpha)}) {
            if (of_texels != nullptr && !stores_alpha(format)) continue;
            Report report;
            const NormalTexture whole = encoded_by_bands(normals, of_texels, 21, options, report);
            const NormalTexture bands = encoded_by_bands(normals, of_texels, 2, options, report);
            ASSERT_EQ(whole.levels.size(), 5U);
            EXPECT_EQ(bands.texture.levels, whole.texture.levels) << enum_name(format);
            EXPECT_EQ(bands.roughness->levels, whole.roughness->levels) << enum_name(format);
            for (std::size_t i = 0; i < whole.levels.size(); ++i) {
                EXPECT_EQ(bands.levels[i].error, whole.levels[i].error) << enum_name(format);
                EXPECT_EQ(bands.levels[i].mean_length, whole.levels[i].mean_length);
                EXPECT_EQ(bands.levels[i].mean_roughness, whole.levels[i].mean_roughness);
            }
            EXPECT_LT(whole.levels[1].mean_length, 0.999);
            EXPECT_GT(*whole.levels[3].mean_roughness, 0.35);
        }
    }
}

TEST(NormalTexture, TheMarginsOfSamplesContainTheErrorsOfAllTexels) {
    // Errors grow from left to right, so the choice of the blocks matters.
    const Image normals = growing_waves(512, 256);
    Report report;
    const auto error_of = [&](std::size_t texels) {
        return encoded_by_bands(normals, nullptr, 64,
                                {.has_mips = false, .measured_texels = texels}, report)
            .levels.front();
    };
    const NormalTextureLevel all = error_of(std::numeric_limits<std::size_t>::max());
    EXPECT_EQ(all.error->count, 512U * 256U);
    EXPECT_FALSE(all.confidence);
    for (const std::size_t texels : {1U << 9, 1U << 11, 1U << 13, 5000U, 30000U}) {
        const NormalTextureLevel sampled = error_of(texels);
        ASSERT_TRUE(sampled.confidence);
        EXPECT_LE(sampled.error->count, texels);
        EXPECT_GE(sampled.error->count, texels / 3);
        EXPECT_NEAR(sampled.error->mean, all.error->mean, sampled.confidence->mean_margin);
        EXPECT_NEAR(sampled.error->rms, all.error->rms, sampled.confidence->rms_margin);
        EXPECT_LT(sampled.confidence->mean_margin, 0.3 * all.error->mean);
        EXPECT_NEAR(sampled.confidence->share_above_max,
                    3.0 * 16.0 / static_cast<double>(sampled.error->count), 1e-3);
    }
    EXPECT_FALSE(error_of(0).error);
}

TEST(NormalTexture, OtherInputIsRefused) {
    const Image normals = growing_waves(8, 4);
    const auto refusal = [&](const auto& work) { return message_of<InvalidInput>(work); };
    EXPECT_THAT(refusal([] { NormalTextureEncoder(4, 4, false, {.format = TextureFormat::bc1}); }),
                HasSubstr("normals are not stored in bc1"));
    EXPECT_THAT(refusal([] { NormalTextureEncoder(4, 4, true, {}); }),
                HasSubstr("the map has alpha, but bc5 stores none"));
    EXPECT_THAT(refusal([] { NormalTextureEncoder(0, 4, false, {}); }),
                HasSubstr("the map has 0 x 4 texels"));
    EXPECT_THAT(refusal([&] { NormalTextureEncoder(4, 4, false, {}).add(normals); }),
                HasSubstr("8 x 4 texels do not continue a map of 4 x 4 texels after row 0"));
    EXPECT_THAT(refusal([&] {
                    NormalTextureEncoder encoder(8, 6, false, {});
                    encoder.add(normals);
                    encoder.add(normals);
                }),
                HasSubstr("after row 4"));
    EXPECT_THAT(refusal([&] {
                    NormalTextureEncoder encoder(8, 6, false, {});
                    encoder.add(normals);
                    encoder.finish();
                }),
                HasSubstr("4 of 6 rows were added"));
}

}  // namespace
}  // namespace relief
