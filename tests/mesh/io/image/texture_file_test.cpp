// SPDX-License-Identifier: Apache-2.0
// KTX2 and DDS files: their bytes, round trips of all formats, and damaged files.
#include "relief/mesh/texture_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <utility>

#include "base/files.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/limits.h"
#include "relief/mesh/report.h"
#include "relief/version.h"
#include "support/images.h"
#include "support/invariants.h"

namespace relief {
using namespace relief::detail;

namespace {

using test::image_of;
using test::message_of;
using test::samples_of;
using testing::ElementsAre;
using testing::HasSubstr;

std::filesystem::path temporary(const std::string& name) {
    return std::filesystem::path(testing::TempDir()) / name;
}

std::vector<std::byte> bytes_of(const std::filesystem::path& file) {
    const std::string text = read_file(file);
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

std::uint32_t number(const std::vector<std::byte>& bytes, std::size_t offset) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
        value |= std::to_integer<std::uint32_t>(bytes.at(offset + i)) << (8 * i);
    return value;
}

void set_number(std::vector<std::byte>& bytes, std::size_t offset, std::uint32_t value) {
    for (std::size_t i = 0; i < 4; ++i)
        bytes.at(offset + i) = static_cast<std::byte>(value >> (8 * i) & 255U);
}

/// A texture of 6 x 3 texels with all levels, of random bytes.
GpuTexture texture_of(TextureFormat format) {
    GpuTexture texture{format, false, 6, 3, {}, {{"relief:green", "up"}}, ""};
    std::uint32_t state = 7;
    for (const auto& [width, height] : {std::pair{6, 3}, {3, 1}, {1, 1}}) {
        std::vector<std::byte> level(texture_level_size(format, width, height));
        for (std::byte& byte : level) {
            state = 1664525U * state + 1013904223U;
            // Below 0x70, so that no float is NaN.
            byte = static_cast<std::byte>((state >> 24U) % 0x70U);
        }
        texture.levels.push_back(std::move(level));
    }
    return texture;
}

TEST(TextureFile, EveryFormatIsReadAsItWasWritten) {
    for (const auto& [name, format, label] : enum_names<TextureFormat>) {
        const GpuTexture texture = texture_of(format);
        for (const char* file : {"texture.ktx2", "texture.dds"}) {
            write_texture(temporary(file), texture);
            const GpuTexture read = read_texture(temporary(file));
            EXPECT_EQ(read.format, format) << name;
            EXPECT_EQ(read.levels, texture.levels) << name;
            const Image image = read_image(temporary(file), ImageUse::data);
            EXPECT_EQ(image.samples, decode_texture_level(texture, 0).samples) << name;
            const ImageInfo info = read_image_info(temporary(file));
            EXPECT_EQ(info.bits, bits_of(format)) << name;
            EXPECT_EQ(info.channels, channels_of(format)) << name;
            EXPECT_EQ(info.width, 6);
            EXPECT_EQ(info.height, 3);
        }
    }
}

TEST(TextureFile, CompressedLevelsAreReadAsTheyWereWritten) {
    GpuTexture texture = texture_of(TextureFormat::bc5);
    texture.swizzle = "rg01";
    for (const int level : {1, 9, 19}) {
        write_texture(temporary("zstd.ktx2"), texture, {.zstd_level = level});
        const GpuTexture read = read_texture(temporary("zstd.ktx2"));
        EXPECT_EQ(read.levels, texture.levels);
        EXPECT_EQ(read.swizzle, "rg01");
        EXPECT_EQ(read.metadata.at("relief:green"), "up");
        EXPECT_EQ(read.metadata.at("KTXwriter"), "relief " RELIEF_VERSION);
        EXPECT_EQ(read.metadata.at("KTXorientation"), "rd");
    }
}

TEST(Ktx2File, TheBytesOfABc5File) {
    write_texture(temporary("bc5.ktx2"), texture_of(TextureFormat::bc5));
    const auto bytes = bytes_of(temporary("bc5.ktx2"));
    // VK_FORMAT_BC5_UNORM_BLOCK, type size, 6 x 3 x 0, no layers, one face, 3 levels, no
    // compression.
    const std::array<std::uint32_t, 9> header = {141, 1, 6, 3, 0, 0, 1, 3, 0};
    for (std::size_t i = 0; i < header.size(); ++i)
        EXPECT_EQ(number(bytes, 12 + 4 * i), header[i]) << i;
    // The descriptor follows the index of 3 levels: 4 + 24 + 2 * 16 bytes.
    EXPECT_EQ(number(bytes, 48), 80U + 3 * 24);
    EXPECT_EQ(number(bytes, 52), 60U);
    EXPECT_EQ(number(bytes, 56), 80U + 3 * 24 + 60);
    const std::array<std::uint32_t, 15> descriptor = {
        60, 0, 2 | 56 << 16,
        // KHR_DF_MODEL_BC5, BT.709, linear; blocks of 4 x 4 texels and 16 bytes.
        132 | 1 << 8 | 1 << 16, 0x0303, 16, 0,
        // Red: bits 0 to 63; green: bits 64 to 127.
        63U << 16U, 0, 0, 0xFFFFFFFF, 64 | 63 << 16 | 1 << 24, 0, 0, 0xFFFFFFFF};
    for (std::size_t i = 0; i < descriptor.size(); ++i)
        EXPECT_EQ(number(bytes, 152 + 4 * i), descriptor[i]) << i;
    // The smallest level comes first; all begin at multiples of 16.
    const std::uint32_t largest = number(bytes, 80);
    const std::uint32_t smallest = number(bytes, 80 + 48);
    EXPECT_LT(smallest, largest);
    EXPECT_EQ(smallest % 16, 0U);
    EXPECT_EQ(number(bytes, 88), 32U);
    EXPECT_EQ(number(bytes, 96), 32U);
    EXPECT_EQ(largest + 32, bytes.size());
}

TEST(Ktx2File, TheDescriptorsOfOtherFormats) {
    GpuTexture colors = texture_of(TextureFormat::rgba8);
    colors.is_srgb = true;
    write_texture(temporary("rgba8.ktx2"), colors);
    auto bytes = bytes_of(temporary("rgba8.ktx2"));
    EXPECT_EQ(number(bytes, 12), 43U);                          // VK_FORMAT_R8G8B8A8_SRGB
    EXPECT_EQ(number(bytes, 152 + 12), 1U | 1 << 8 | 2 << 16);  // RGBSDA, BT.709, sRGB.
    EXPECT_EQ(number(bytes, 152 + 16), 0U);
    EXPECT_EQ(number(bytes, 152 + 20), 4U);
    EXPECT_EQ(number(bytes, 152 + 28 + 48), 24U | 7 << 16 | 0x1FU << 24U);  // Alpha is linear.
    EXPECT_EQ(number(bytes, 152 + 28 + 60), 255U);
    EXPECT_TRUE(read_texture(temporary("rgba8.ktx2")).is_srgb);

    write_texture(temporary("rg16f.ktx2"), texture_of(TextureFormat::rg16f));
    bytes = bytes_of(temporary("rg16f.ktx2"));
    EXPECT_EQ(number(bytes, 12), 83U);
    EXPECT_EQ(number(bytes, 16), 2U);
    EXPECT_EQ(number(bytes, 152 + 28), 0U | 15 << 16 | 0xC0U << 24U);  // Signed float.
    EXPECT_EQ(number(bytes, 152 + 36), 0xBF800000U);
    EXPECT_EQ(number(bytes, 152 + 40), 0x3F800000U);

    write_texture(temporary("snorm.ktx2"), texture_of(TextureFormat::bc4_snorm));
    bytes = bytes_of(temporary("snorm.ktx2"));
    EXPECT_EQ(number(bytes, 152 + 12) & 255U, 131U);
    EXPECT_EQ(number(bytes, 152 + 28), 63U << 16U | 0x40U << 24U);
    EXPECT_EQ(number(bytes, 152 + 36), 0x80000000U);
    EXPECT_EQ(number(bytes, 152 + 40), 0x7FFFFFFFU);
}

TEST(Ktx2File, DescriptorsOfBc1AndBc3) {
    GpuTexture colors = texture_of(TextureFormat::bc3);
    colors.is_srgb = true;
    write_texture(temporary("bc3.ktx2"), colors);
    auto bytes = bytes_of(temporary("bc3.ktx2"));
    EXPECT_EQ(number(bytes, 12), 138U);                                   // BC3_SRGB_BLOCK
    EXPECT_EQ(number(bytes, 152 + 12), 130U | 1 << 8 | 2 << 16);          // BC3, BT.709, sRGB.
    EXPECT_EQ(number(bytes, 152 + 28), 0U | 63 << 16 | 0x1FU << 24U);     // Alpha is linear.
    EXPECT_EQ(number(bytes, 152 + 28 + 16), 64U | 63 << 16 | 0U << 24U);  // Color.

    write_texture(temporary("bc1.ktx2"), texture_of(TextureFormat::bc1));
    bytes = bytes_of(temporary("bc1.ktx2"));
    EXPECT_EQ(number(bytes, 12), 131U);  // BC1_RGB_UNORM_BLOCK
    EXPECT_EQ(number(bytes, 152 + 12), 128U | 1 << 8 | 1 << 16);
    EXPECT_EQ(number(bytes, 152 + 16), 0x0303U);
    EXPECT_EQ(number(bytes, 152 + 20), 8U);
    EXPECT_EQ(number(bytes, 152 + 28), 63U << 16U);

    write_texture(temporary("bc1a.ktx2"), texture_of(TextureFormat::bc1a));
    bytes = bytes_of(temporary("bc1a.ktx2"));
    EXPECT_EQ(number(bytes, 12), 133U);                          // BC1_RGBA_UNORM_BLOCK
    EXPECT_EQ(number(bytes, 152 + 28), 63U << 16U | 1U << 24U);  // With alpha.
}

TEST(Ktx2File, DescriptorsOfBc6h) {
    write_texture(temporary("bc6h.ktx2"), texture_of(TextureFormat::bc6h));
    auto bytes = bytes_of(temporary("bc6h.ktx2"));
    EXPECT_EQ(number(bytes, 12), 143U);  // BC6H_UFLOAT_BLOCK
    EXPECT_EQ(number(bytes, 16), 1U);
    EXPECT_EQ(number(bytes, 152 + 12), 133U | 1 << 8 | 1 << 16);
    EXPECT_EQ(number(bytes, 152 + 16), 0x0303U);
    EXPECT_EQ(number(bytes, 152 + 20), 16U);
    EXPECT_EQ(number(bytes, 152 + 28), 127U << 16U | 0x80U << 24U);  // Float.
    EXPECT_EQ(number(bytes, 152 + 36), 0U);
    EXPECT_EQ(number(bytes, 152 + 40), 0x3F800000U);

    write_texture(temporary("bc6h-sfloat.ktx2"), texture_of(TextureFormat::bc6h_sfloat));
    bytes = bytes_of(temporary("bc6h-sfloat.ktx2"));
    EXPECT_EQ(number(bytes, 12), 144U);                              // BC6H_SFLOAT_BLOCK
    EXPECT_EQ(number(bytes, 152 + 28), 127U << 16U | 0xC0U << 24U);  // Signed float.
    EXPECT_EQ(number(bytes, 152 + 36), 0xBF800000U);

    GpuTexture coded = texture_of(TextureFormat::bc6h);
    coded.is_srgb = true;
    EXPECT_EQ(message_of<InvalidInput>([&] { write_texture(temporary("a.ktx2"), coded); }),
              "there is no sRGB variant of bc6h");
}

TEST(Ktx2File, DescriptorOfBc3ThatContradictsTheFormatIsRefused) {
    GpuTexture colors = texture_of(TextureFormat::bc3);
    colors.is_srgb = true;
    write_texture(temporary("bc3.ktx2"), colors);
    auto bytes = bytes_of(temporary("bc3.ktx2"));
    const std::size_t descriptor = number(bytes, 48);
    const auto error = [&](std::size_t offset, unsigned char value) {
        auto changed = bytes;
        changed[offset] = static_cast<std::byte>(value);
        return message_of<FileError>(
            [&] { read_texture(std::span<const std::byte>(changed), "x.ktx2"); });
    };
    EXPECT_THAT(error(descriptor + 12, 128), HasSubstr("(BC3) by another color model"));
    EXPECT_THAT(error(descriptor + 14, 1), HasSubstr("(BC3) by another transfer function"));
    EXPECT_THAT(error(descriptor + 16, 0), HasSubstr("(BC3) by blocks of another size"));
    EXPECT_THAT(error(12, 132), HasSubstr("contradicts the Vulkan format 132 (BC1)"));
}

TEST(DdsFile, FormatsOfColors) {
    struct Case {
        TextureFormat format;
        bool is_srgb;
        std::uint32_t dxgi;
    };
    for (const Case& each :
         {Case{TextureFormat::bc1, false, 71}, Case{TextureFormat::bc1, true, 72},
          Case{TextureFormat::bc1a, true, 72}, Case{TextureFormat::bc3, true, 78},
          Case{TextureFormat::bc7, true, 99}, Case{TextureFormat::bc6h, false, 95},
          Case{TextureFormat::bc6h_sfloat, false, 96}}) {
        GpuTexture texture = texture_of(each.format);
        texture.is_srgb = each.is_srgb;
        write_texture(temporary("color.dds"), texture);
        EXPECT_EQ(number(bytes_of(temporary("color.dds")), 128), each.dxgi);
        const GpuTexture read = read_texture(temporary("color.dds"));
        EXPECT_EQ(read.format, each.format) << enum_name(each.format);
        EXPECT_EQ(read.is_srgb, each.is_srgb) << enum_name(each.format);
    }
}

TEST(Ktx2File, ADescriptorThatContradictsTheFormatIsRefused) {
    write_texture(temporary("bc5.ktx2"), texture_of(TextureFormat::bc5));
    const auto bytes = bytes_of(temporary("bc5.ktx2"));
    const std::size_t descriptor = number(bytes, 48);
    const auto error = [&](std::size_t offset, unsigned char value) {
        auto changed = bytes;
        changed[offset] = static_cast<std::byte>(value);
        try {
            read_image(std::span<const std::byte>(changed), "x.ktx2", ImageUse::data);
        } catch (const FileError& refusal) {
            return std::string(refusal.what());
        }
        return std::string("no error");
    };
    EXPECT_EQ(error(descriptor + 12, 131),
              "x.ktx2: its format descriptor contradicts the Vulkan format 141 by another color "
              "model");
    EXPECT_THAT(error(descriptor + 14, 2), HasSubstr("another transfer function"));
    EXPECT_THAT(error(descriptor + 16, 0), HasSubstr("blocks of another size"));
    EXPECT_THAT(error(descriptor + 10, 40), HasSubstr("another number of channels"));
    EXPECT_THAT(error(descriptor + 31, 4), HasSubstr("other channels"));
    EXPECT_THAT(error(52, 0), HasSubstr("has no format descriptor"));
    // Primaries, the sizes of planes and the ranges of samples are free.
    EXPECT_EQ(error(descriptor + 13, 0), "no error");
    EXPECT_EQ(error(descriptor + 20, 0), "no error");
    EXPECT_EQ(error(descriptor + 40, 0), "no error");
}

TEST(Ktx2File, SmallZstdFileMustNotExpandToGigabytes) {
    write_texture(temporary("bc5.ktx2"), texture_of(TextureFormat::bc5), {.zstd_level = 1});
    auto bytes = bytes_of(temporary("bc5.ktx2"));
    set_number(bytes, 20, 9000);
    set_number(bytes, 24, 9000);
    const auto error = [&] {
        return message_of<FileError>(
            [&] { read_image(std::span<const std::byte>(bytes), "x.ktx2", ImageUse::data); });
    };
    EXPECT_THAT(error(), HasSubstr("x.ktx2: announces 9000 x 9000 texels, which take 308 MiB of "
                                   "memory, but a file of "));
    EXPECT_THAT(error(), HasSubstr("may take only 256 (--max-memory or --max-pixels raises this "
                                   "limit)"));
    for (const InputLimits& limits :
         {InputLimits{.memory = 1U << 30}, InputLimits{.pixels = 81'000'000}}) {
        set_input_limits(limits);
        EXPECT_THAT(error(), HasSubstr("but its texels need 81000000")) << "the limit is higher";
    }
    set_input_limits({});
}

TEST(DdsFile, LosesMetadataWithAFinding) {
    GpuTexture texture = texture_of(TextureFormat::bc7);
    texture.metadata.clear();
    Report report;
    write_texture(temporary("plain.dds"), texture, {}, report);
    texture.metadata = {{"relief:content", "normal map, tangent space"}, {"relief:green", "down"}};
    write_texture(temporary("kept.ktx2"), texture, {}, report);
    EXPECT_TRUE(report.empty());
    write_texture(temporary("lost.dds"), texture, {}, report);
    ASSERT_EQ(report.findings().size(), 1U);
    EXPECT_EQ(to_string(report.findings()[0]),
              "1 x metadata that DDS cannot hold: relief:content 'normal map, tangent space', "
              "relief:green 'down' (file 0): are lost (write .ktx2 to keep them)");
}

TEST(DdsFile, TheBytesOfABc7File) {
    GpuTexture texture = texture_of(TextureFormat::bc7);
    texture.is_srgb = true;
    write_texture(temporary("bc7.dds"), texture);
    const auto bytes = bytes_of(temporary("bc7.dds"));
    EXPECT_EQ(number(bytes, 0), 0x20534444U);
    EXPECT_EQ(number(bytes, 4), 124U);
    EXPECT_EQ(number(bytes, 8), 0xA1007U);  // Caps, height, width, format, levels, linear size.
    EXPECT_EQ(number(bytes, 12), 3U);
    EXPECT_EQ(number(bytes, 16), 6U);
    EXPECT_EQ(number(bytes, 20), 32U);
    EXPECT_EQ(number(bytes, 28), 3U);
    EXPECT_EQ(number(bytes, 84), 0x30315844U);
    EXPECT_EQ(number(bytes, 108), 0x401008U);
    EXPECT_EQ(number(bytes, 128), 99U);  // DXGI_FORMAT_BC7_UNORM_SRGB
    EXPECT_EQ(number(bytes, 132), 3U);
    EXPECT_EQ(number(bytes, 140), 1U);
    EXPECT_EQ(bytes.size(), 148U + 32 + 16 + 16);
}

TEST(DdsFile, OlderFilesNameTheirFormatByFourLetters) {
    write_texture(temporary("old.dds"), texture_of(TextureFormat::bc5));
    auto bytes = bytes_of(temporary("old.dds"));
    bytes.erase(bytes.begin() + 128, bytes.begin() + 148);
    for (const auto& [letters, format] : {std::pair{0x32495441U, TextureFormat::bc5},  // ATI2
                                          {0x55354342U, TextureFormat::bc5},           // BC5U
                                          {0x53354342U, TextureFormat::bc5_snorm}}) {  // BC5S
        set_number(bytes, 84, letters);
        const GpuTexture texture = read_texture(bytes, "old.dds");
        EXPECT_EQ(texture.format, format);
        EXPECT_EQ(texture.levels, texture_of(TextureFormat::bc5).levels);
    }
}

TEST(TextureLevels, SamplesAreStoredAsTheyAre) {
    const Image image = image_of(3, std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6});
    const auto level = encode_texture_level(image, TextureFormat::rgba8);
    EXPECT_THAT(level, ElementsAre(std::byte{1}, std::byte{2}, std::byte{3}, std::byte{255},
                                   std::byte{4}, std::byte{5}, std::byte{6}, std::byte{255}));
    EXPECT_EQ(message_of<InvalidInput>([&] { encode_texture_level(image, TextureFormat::rg16); }),
              "rg16 has 2 channels of 16 bits, not 3 of 8");
}

TEST(TextureLevels, HalfFloats) {
    const float infinity = std::numeric_limits<float>::infinity();
    const float ulp = 1.0F / 1024.0F;
    // The last two: half of the smallest half rounds to even (0), and 1 + ulp / 2 to 1.
    const std::vector<float> values = {1.0F,     -2.0F,     65504.0F,          65519.0F,
                                       65520.0F, -infinity, 0x1p-24F,          0x1p-14F,
                                       0.1F,     0x1p-25F,  1.0F + ulp / 2.0F, 1.0F + 1.5F * ulp};
    Report report;
    GpuTexture texture{TextureFormat::r16f, false, 12, 1, {}, {}, ""};
    texture.levels.push_back(
        encode_texture_level(image_of(1, values), TextureFormat::r16f, BlockQuality::fast, report));
    EXPECT_EQ(report.count("texel beyond half's range"), 1U);
    EXPECT_THAT(samples_of<float>(decode_texture_level(texture, 0)),
                ElementsAre(1.0F, -2.0F, 65504.0F, 65504.0F, 65504.0F, -infinity, 0x1p-24F,
                            0x1p-14F, 0.0999755859375F, 0.0F, 1.0F, 1.0F + 2.0F * ulp));
    const Image nan = image_of(1, std::vector<float>{std::numeric_limits<float>::quiet_NaN()});
    texture.width = 1;
    texture.levels[0] = encode_texture_level(nan, TextureFormat::r16f);
    EXPECT_TRUE(std::isnan(samples_of<float>(decode_texture_level(texture, 0))[0]));
}

TEST(TextureFile, RefusesUnsupportedTextures) {
    GpuTexture texture = texture_of(TextureFormat::rg16);
    const auto message = [&](const std::string& name, const TextureWriteOptions& options = {}) {
        return message_of<Error>([&] { write_texture(temporary(name), texture, options); });
    };
    EXPECT_THAT(message("a.ktx"),
                HasSubstr("textures are written to .ktx2 and .dds, not to '.ktx'"));
    EXPECT_THAT(message("a.dds", {.zstd_level = 3}), HasSubstr("not of DDS files"));
    EXPECT_EQ(message("a.ktx2", {.zstd_level = 23}), "zstd has levels 1 to 22, not 23");
    texture.swizzle = "rgbx";
    EXPECT_EQ(message("a.ktx2"), "a swizzle has four letters of rgba01, not 'rgbx'");
    texture.swizzle = "";
    texture.is_srgb = true;
    EXPECT_EQ(message("a.ktx2"), "there is no sRGB variant of rg16");
    EXPECT_EQ(message("a.dds"), "DDS has no sRGB variant of rg16");
    texture.is_srgb = false;
    texture.levels[1].pop_back();
    EXPECT_EQ(message("a.ktx2"), "level 1 of the texture has 11 bytes, not 12");
    texture.levels.resize(4);
    EXPECT_EQ(message("a.ktx2"), "a texture of 6 x 3 texels has 1 to 3 levels, not 4");
}

/// The error of a file with changed numbers.
std::string damaged(std::vector<std::byte> bytes,
                    std::initializer_list<std::pair<std::size_t, std::uint32_t>> changes) {
    for (const auto& [offset, value] : changes)
        set_number(bytes, offset, value);
    return message_of<FileError>([&] { read_image(bytes, "x", ImageUse::data); });
}

TEST(DamagedTextures, Ktx2HeadersAreRefused) {
    write_texture(temporary("good.ktx2"), texture_of(TextureFormat::bc5), {.zstd_level = 3});
    const auto bytes = bytes_of(temporary("good.ktx2"));
    EXPECT_THAT(damaged(bytes, {{12, 135}}), HasSubstr("x: has the Vulkan format 135 (BC2); of"));
    EXPECT_THAT(damaged(bytes, {{12, 0}}), HasSubstr("the Vulkan format 0 (Basis Universal)"));
    EXPECT_EQ(damaged(bytes, {{20, 0}}), "x: announces 0 x 3 texels");
    EXPECT_EQ(damaged(bytes, {{20, 0x80000000}}), "x: announces 2147483648 x 3 texels");
    EXPECT_THAT(damaged(bytes, {{20, 65536}, {24, 65536}}), HasSubstr("relief reads up to"));
    EXPECT_EQ(damaged(bytes, {{20, 8192}, {24, 8192}}),
              "x: level 0 has 32 bytes, but its texels need 67108864");
    EXPECT_THAT(damaged(bytes, {{20, 8192}, {24, 8192}, {96, 67108864}}),
                HasSubstr("x: level 0 announces 67108864 bytes in"));
    EXPECT_EQ(damaged(bytes, {{24, 0}}), "x: is not a two-dimensional texture");
    EXPECT_EQ(damaged(bytes, {{28, 2}}), "x: is not a two-dimensional texture");
    EXPECT_EQ(damaged(bytes, {{32, 2}}),
              "x: is an array of 2 textures, but only single images are read");
    EXPECT_EQ(damaged(bytes, {{36, 6}}), "x: is a cube map, but only single images are read");
    EXPECT_EQ(damaged(bytes, {{40, 4}}), "x: announces 4 mip levels of 6 x 3 texels");
    EXPECT_EQ(damaged(bytes, {{40, 0xFFFFFFFF}}),
              "x: announces 4294967295 mip levels of 6 x 3 texels");
    EXPECT_EQ(damaged(bytes, {{44, 3}}),
              "x: has the supercompression 3, but only zstd (2) is read");
    EXPECT_THAT(damaged(bytes, {{80, 0xFFFFFFF0}}),
                HasSubstr("from byte 4294967280, but the file"));
    EXPECT_THAT(damaged(bytes, {{84, 0xFFFFFFFF}}), HasSubstr("but the file has only"));
    EXPECT_THAT(damaged(bytes, {{60, 0xFFFFFFFF}}),
                HasSubstr("x: has text entries beyond its end"));
    EXPECT_THAT(damaged(bytes, {{number(bytes, 56), 0xFFFFFFF0}}),
                HasSubstr("x: has a text entry that exceeds"));
    EXPECT_THAT(damaged(bytes, {{number(bytes, 80), 0}}),
                HasSubstr("x: level 0 cannot be decompressed: "));
}

TEST(DamagedTextures, DdsHeadersAreRefused) {
    write_texture(temporary("good.dds"), texture_of(TextureFormat::bc7));
    const auto bytes = bytes_of(temporary("good.dds"));
    EXPECT_EQ(damaged(bytes, {{4, 100}}), "x: has no DDS header of 124 bytes");
    EXPECT_EQ(damaged(bytes, {{16, 0}}), "x: announces 0 x 3 texels");
    EXPECT_THAT(damaged(bytes, {{16, 60}}), HasSubstr("x: is cut short: level 0 needs 240 bytes"));
    EXPECT_EQ(damaged(bytes, {{28, 31}}), "x: announces 31 mip levels of 6 x 3 texels");
    EXPECT_EQ(damaged(bytes, {{112, 0x200}}), "x: is a cube map, but only single images are read");
    EXPECT_EQ(damaged(bytes, {{136, 4}}), "x: is a cube map, but only single images are read");
    EXPECT_EQ(damaged(bytes, {{132, 4}}), "x: is not a two-dimensional texture");
    EXPECT_EQ(damaged(bytes, {{140, 6}}),
              "x: is an array of 6 textures, but only single images are read");
}

TEST(DamagedTextures, EveryTruncatedFileIsRefused) {
    for (const char* name : {"whole.ktx2", "whole.dds"}) {
        write_texture(temporary(name), texture_of(TextureFormat::bc4));
        const auto bytes = bytes_of(temporary(name));
        for (std::size_t length = 12; length < bytes.size(); ++length) {
            const auto part = std::span(bytes).first(length);
            EXPECT_NE(message_of<FileError>([&] { read_texture(part, "x"); }), "no error")
                << length;
        }
    }
}

}  // namespace
}  // namespace relief
