// SPDX-License-Identifier: Apache-2.0
// The block decoder against that of OpenGL (Mesa) on random blocks of BC1, BC3, BC4, BC5 and all
// modes of BC6H and BC7.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "gl/api.h"
#include "gl/resources.h"
#include "relief/mesh/block_compression.h"
#include "support/gl_environment.h"

namespace relief::shade::gl {
namespace {

constexpr int texels_across = 256;  ///< 4096 blocks.
// GL_COMPRESSED_RGBA_BPTC_UNORM, RGB_BPTC_SIGNED_FLOAT and RGB_BPTC_UNSIGNED_FLOAT, of OpenGL 4.2.
constexpr GLenum bptc_unorm = 0x8E8C;
constexpr GLenum bptc_signed_float = 0x8E8E;
constexpr GLenum bptc_unsigned_float = 0x8E8F;

/// The numbers of the modes of BC6H, of 2 or 5 bits, and of the reserved modes.
constexpr std::array<unsigned, 18> bc6h_modes = {0x00, 0x01, 0x02, 0x06, 0x0A, 0x0E,
                                                 0x12, 0x16, 0x1A, 0x1E, 0x03, 0x07,
                                                 0x0B, 0x0F, 0x13, 0x17, 0x1B, 0x1F};

/// Random blocks; those of BC6H and BC7 have all modes equally often.
std::vector<std::byte> random_blocks(BlockFormat format) {
    std::vector<std::byte> blocks(block_data_size(format, texels_across, texels_across));
    std::uint32_t state = 1;
    for (std::byte& byte : blocks) {
        state = 1664525U * state + 1013904223U;
        byte = static_cast<std::byte>(state >> 24U);
    }
    for (std::size_t i = 0; format == BlockFormat::bc7 && i < blocks.size(); i += 16) {
        const unsigned mode = static_cast<unsigned>(i / 16 % 8);
        const auto kept = std::to_integer<unsigned>(blocks[i]) & (0xFFU << (mode + 1));
        blocks[i] = static_cast<std::byte>((kept | 1U << mode) & 0xFFU);
    }
    const bool is_bc6h = format == BlockFormat::bc6h || format == BlockFormat::bc6h_sfloat;
    for (std::size_t i = 0; is_bc6h && i < blocks.size(); i += 16) {
        const unsigned mode = bc6h_modes[i / 16 % bc6h_modes.size()];
        const auto kept = std::to_integer<unsigned>(blocks[i]) & (mode < 2 ? 0xFCU : 0xE0U);
        blocks[i] = static_cast<std::byte>(kept | mode);
    }
    return blocks;
}

/// The index of a texel in a block of one channel.
unsigned index_of(const std::byte* block, std::size_t texel) {
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < 8; ++i)
        bits |= std::to_integer<std::uint64_t>(block[i]) << (8 * i);
    return static_cast<unsigned>(bits >> (16 + 3 * texel) & 7U);
}

class BlockDecoding : public test::GlTest {
  protected:
    /// Uploads blocks, and reads the decoded texels back.
    std::vector<float> decoded_by_gl(const std::vector<std::byte>& blocks, GLenum internal,
                                     GLenum channels, std::size_t count) const {
        const Texture texture(api());
        api()->BindTexture(GL_TEXTURE_2D, texture.name());
        api()->CompressedTexImage2D(GL_TEXTURE_2D, 0, internal, texels_across, texels_across, 0,
                                    static_cast<GLsizei>(blocks.size()), blocks.data());
        std::vector<float> texels(static_cast<std::size_t>(texels_across) * texels_across * count);
        api()->GetTexImage(GL_TEXTURE_2D, 0, channels, GL_FLOAT, texels.data());
        EXPECT_EQ(api()->GetError(), static_cast<GLenum>(GL_NO_ERROR));
        api()->BindTexture(GL_TEXTURE_2D, 0);
        return texels;
    }

    [[nodiscard]] bool has_extension(std::string_view wanted) const {
        GLint count = 0;
        api()->GetIntegerv(GL_NUM_EXTENSIONS, &count);
        for (GLint i = 0; i < count; ++i) {
            const auto* const name = reinterpret_cast<const char*>(
                api()->GetStringi(GL_EXTENSIONS, static_cast<GLuint>(i)));
            if (wanted == name) return true;
        }
        return false;
    }
};
RELIEF_ON_DEFAULT_BACKEND(BlockDecoding);

TEST_P(BlockDecoding, Bc4AndBc5) {
    struct Case {
        BlockFormat format;
        GLenum internal, channels;
    };
    for (const Case& each : {Case{BlockFormat::bc4, GL_COMPRESSED_RED_RGTC1, GL_RED},
                             Case{BlockFormat::bc4_snorm, GL_COMPRESSED_SIGNED_RED_RGTC1, GL_RED},
                             Case{BlockFormat::bc5, GL_COMPRESSED_RG_RGTC2, GL_RG},
                             Case{BlockFormat::bc5_snorm, GL_COMPRESSED_SIGNED_RG_RGTC2, GL_RG}}) {
        const auto blocks = random_blocks(each.format);
        const auto expected = decoded_by_gl(blocks, each.internal, each.channels,
                                            static_cast<std::size_t>(channels_of(each.format)));
        const Image image = decode_blocks(blocks, each.format, texels_across, texels_across);
        const auto samples = image.as<std::uint16_t>();
        ASSERT_EQ(samples.size(), expected.size());
        // The codes themselves are exact. Mesa computes values between them in integers of 8 bits,
        // by products instead of divisions: within two codes.
        const double code = is_signed(each.format) ? 1.0 / 127.0 : 1.0 / 255.0;
        const auto channels = static_cast<std::size_t>(channels_of(each.format));
        double worst = 0.0;
        double worst_of_codes = 0.0;
        double sum = 0.0;
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const double value =
                is_signed(each.format) ? (samples[i] - 32768.0) / 32767.0 : samples[i] / 65535.0;
            // -128 is another code for -1.
            const double error = std::abs(value - std::max(-1.0, static_cast<double>(expected[i])));
            const std::size_t x = i / channels % texels_across;
            const std::size_t y = i / channels / texels_across;
            const std::size_t block =
                (y / 4 * (texels_across / 4) + x / 4) * channels + i % channels;
            if (index_of(&blocks[8 * block], 4 * (y % 4) + x % 4) < 2)
                worst_of_codes = std::max(worst_of_codes, error);
            worst = std::max(worst, error);
            sum += error;
        }
        EXPECT_LT(worst_of_codes, 1e-4) << enum_name(each.format);
        EXPECT_LT(worst, 2.0 * code) << enum_name(each.format);
        EXPECT_LT(sum / static_cast<double>(samples.size()), 0.5 * code) << enum_name(each.format);
    }
}

TEST_P(BlockDecoding, Bc1AndBc3) {
    if (!has_extension("GL_EXT_texture_compression_s3tc"))
        GTEST_SKIP() << "this OpenGL does not decode BC1";
    struct Case {
        BlockFormat format;
        GLenum internal;
    };
    // GL_COMPRESSED_RGB_S3TC_DXT1_EXT, RGBA_S3TC_DXT1, RGBA_S3TC_DXT5.
    for (const Case& each : {Case{BlockFormat::bc1, 0x83F0}, Case{BlockFormat::bc1a, 0x83F1},
                             Case{BlockFormat::bc3, 0x83F3}}) {
        const auto blocks = random_blocks(each.format);
        const auto count = static_cast<std::size_t>(channels_of(each.format));
        const auto expected =
            decoded_by_gl(blocks, each.internal, count == 3 ? GL_RGB : GL_RGBA, count);
        const auto image = decode_blocks(blocks, each.format, texels_across, texels_across);
        const auto samples = image.as<std::uint8_t>();
        ASSERT_EQ(samples.size(), expected.size());
        // Decoders round the colors between the endpoints differently.
        double worst = 0.0;
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const double code = 255.0 * static_cast<double>(expected[i]);
            worst = std::max(worst, std::abs(code - static_cast<double>(samples[i])));
        }
        EXPECT_LT(worst, 2.01) << enum_name(each.format);
    }
}

TEST_P(BlockDecoding, Bc7) {
    if (!has_extension("GL_ARB_texture_compression_bptc"))
        GTEST_SKIP() << "this OpenGL does not decode BC7";
    const auto blocks = random_blocks(BlockFormat::bc7);
    const auto expected = decoded_by_gl(blocks, bptc_unorm, GL_RGBA, 4);
    const Image image = decode_blocks(blocks, BlockFormat::bc7, texels_across, texels_across);
    const auto samples = image.as<std::uint8_t>();
    std::array<std::size_t, 8> different{};
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const std::size_t texel = i / 4;
        const std::size_t block =
            texel / texels_across / 4 * (texels_across / 4) + texel % texels_across / 4;
        const float code = expected[i] * 255.0F;
        different[block % 8] += std::abs(code - static_cast<float>(samples[i])) > 0.01F ? 1 : 0;
    }
    EXPECT_THAT(different, testing::Each(0U)) << "by mode";
}

TEST_P(BlockDecoding, Bc6h) {
    if (!has_extension("GL_ARB_texture_compression_bptc"))
        GTEST_SKIP() << "this OpenGL does not decode BC6H";
    struct Case {
        BlockFormat format;
        GLenum internal;
    };
    for (const Case& each : {Case{BlockFormat::bc6h, bptc_unsigned_float},
                             Case{BlockFormat::bc6h_sfloat, bptc_signed_float}}) {
        const auto blocks = random_blocks(each.format);
        const auto expected = decoded_by_gl(blocks, each.internal, GL_RGB, 3);
        const Image image = decode_blocks(blocks, each.format, texels_across, texels_across);
        const auto samples = image.as<float>();
        ASSERT_EQ(samples.size(), expected.size());
        std::array<std::size_t, bc6h_modes.size()> different{};
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const std::size_t texel = i / 3;
            const std::size_t block =
                texel / texels_across / 4 * (texels_across / 4) + texel % texels_across / 4;
            different[block % bc6h_modes.size()] += samples[i] != expected[i] ? 1 : 0;
        }
        EXPECT_THAT(different, testing::Each(0U)) << enum_name(each.format) << ", by mode";
    }
}

}  // namespace
}  // namespace relief::shade::gl
