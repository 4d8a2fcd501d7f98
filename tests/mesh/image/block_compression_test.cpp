// SPDX-License-Identifier: Apache-2.0
// BC4, BC5 and BC7: decoded blocks against hand-computed values, and properties of encoded ones.
// tests/shade/gl/block_decoding_test.cpp compares the decoder with OpenGL.
#include "relief/mesh/block_compression.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <initializer_list>
#include <limits>
#include <utility>

#include "image/bc7_format.h"
#include "mesh/image/block_fields.h"
#include "relief/mesh/normal_map.h"
#include "support/images.h"
#include "support/invariants.h"

namespace relief {
namespace {

using test::all_qualities;
using test::Bits;
using test::block_of;
using test::Blocks;
using test::image_of;
using test::message_of;
using test::samples_of;
using testing::Each;
using testing::ElementsAre;
using testing::ElementsAreArray;

constexpr float quiet_nan = std::numeric_limits<float>::quiet_NaN();

/// A block of BC4 whose texels have the indices 0 to 7 twice.
Blocks bc4_block(unsigned first, unsigned second) {
    std::vector<Bits> fields = {{first, 8}, {second, 8}};
    for (unsigned t = 0; t < 16; ++t)
        fields.push_back({t % 8, 3});
    return block_of(8, fields);
}

std::vector<std::uint16_t> first_eight(const Blocks& blocks, BlockFormat format) {
    const auto samples = samples_of<std::uint16_t>(decode_blocks(blocks, format, 4, 4));
    return {samples.begin(), samples.begin() + 8};
}

TEST(Bc4Decoder, SixValuesLieBetweenTheCodesIfTheFirstIsLarger) {
    // (6 * 200 + 1 * 60) / 7 = 180, and so on; a code of 8 bits is 257 codes of 16.
    EXPECT_THAT(first_eight(bc4_block(200, 60), BlockFormat::bc4),
                ElementsAre(257 * 200, 257 * 60, 257 * 180, 257 * 160, 257 * 140, 257 * 120,
                            257 * 100, 257 * 80));
}

TEST(Bc4Decoder, HasFourValuesAndTheEndsInTheOtherMode) {
    EXPECT_THAT(
        first_eight(bc4_block(60, 210), BlockFormat::bc4),
        ElementsAre(257 * 60, 257 * 210, 257 * 90, 257 * 120, 257 * 150, 257 * 180, 0, 65535));
}

TEST(Bc4Decoder, ValuesBetweenCodesAreNotRoundedToEightBits) {
    // (6 * 128 + 127) / 7 = 127.857...; times 257 is 32859.3.
    EXPECT_EQ(first_eight(bc4_block(128, 127), BlockFormat::bc4)[2], 32859);
    // (4 * 127 + 128) / 5 = 127.2; times 257 is 32690.4.
    EXPECT_EQ(first_eight(bc4_block(127, 128), BlockFormat::bc4)[2], 32690);
}

TEST(Bc4Decoder, SignedCodes) {
    // 127 is 1, and -127 (0x81) is -1; the values between are 5/7, 3/7, 1/7 and their opposites.
    const std::vector<std::uint16_t> expected = {65535, 1, 56173, 46811, 37449, 28087, 18725, 9363};
    EXPECT_EQ(first_eight(bc4_block(0x7F, 0x81), BlockFormat::bc4_snorm), expected);
    // -128 is -1 too.
    EXPECT_EQ(first_eight(bc4_block(0x7F, 0x80), BlockFormat::bc4_snorm), expected);
    // 0 <= 100: 0, 100/127, 20/127, 40/127, 60/127, 80/127, -1, 1.
    EXPECT_THAT(first_eight(bc4_block(0, 100), BlockFormat::bc4_snorm),
                ElementsAre(32768, 32768 + 25801, 32768 + 5160, 32768 + 10320, 32768 + 15480,
                            32768 + 20641, 1, 65535));
}

TEST(Bc5Decoder, TheSecondHalfOfABlockIsTheSecondChannel) {
    Blocks blocks = bc4_block(200, 60);
    const Blocks second = bc4_block(60, 210);
    blocks.insert(blocks.end(), second.begin(), second.end());
    const Image image = decode_blocks(blocks, BlockFormat::bc5, 4, 4);
    EXPECT_EQ(image.channels, 2);
    const auto samples = samples_of<std::uint16_t>(image);
    EXPECT_EQ(samples[2], 257 * 60);
    EXPECT_EQ(samples[3], 257 * 210);
}

TEST(BlockDecoder, ImagesThatEndInsideOfBlocks) {
    // Texel (4, 0) is the first one of the second block, (0, 1) is texel 4 of the first.
    Blocks blocks = bc4_block(200, 60);
    const Blocks second = bc4_block(60, 210);
    blocks.insert(blocks.end(), second.begin(), second.end());
    const auto samples = samples_of<std::uint16_t>(decode_blocks(blocks, BlockFormat::bc4, 5, 2));
    EXPECT_THAT(samples, ElementsAre(51400, 15420, 46260, 41120, 257 * 60, 35980, 30840, 25700,
                                     20560, 257 * 150));
}

TEST(BlockDecoder, RefusesAnotherNumberOfBytes) {
    EXPECT_EQ(message_of<InvalidInput>([] { decode_blocks(Blocks(8), BlockFormat::bc4, 5, 1); }),
              "5 x 1 texels of bc4 have 16 bytes, not 8");
    EXPECT_EQ(message_of<InvalidInput>([] { decode_blocks(Blocks(8), BlockFormat::bc7, 1, 1); }),
              "1 x 1 texels of bc7 have 16 bytes, not 8");
    EXPECT_EQ(message_of<InvalidInput>([] { decode_blocks({}, BlockFormat::bc4, 0, 1); }),
              "the image has 0 x 1 texels, but needs at least 1 x 1");
}

TEST(Bc4Encoder, EveryCodeOfEightBitsIsExactInAFlatBlock) {
    for (const BlockQuality quality : all_qualities) {
        std::vector<std::uint8_t> codes(256 * 4);
        for (std::size_t i = 0; i < codes.size(); ++i)
            codes[i] = static_cast<std::uint8_t>(i / 4);
        const Image image = image_of(1, codes);
        const auto decoded =
            samples_of<std::uint16_t>(decode_blocks(encode_blocks(image, BlockFormat::bc4, quality),
                                                    BlockFormat::bc4, image.width, image.height));
        for (std::size_t i = 0; i < codes.size(); ++i)
            ASSERT_EQ(decoded[i], 257 * codes[i]);
    }
}

TEST(Bc4Encoder, TwoCodesAndTheValuesBetweenThemAreExact) {
    for (const BlockQuality quality : all_qualities) {
        std::vector<std::uint8_t> codes(16);
        for (std::size_t i = 0; i < 16; ++i)
            codes[i] = static_cast<std::uint8_t>(60 + 20 * (i % 8));
        const Image image = image_of(4, 4, 1, ColorSpace::data, codes);
        const Blocks blocks = encode_blocks(image, BlockFormat::bc4, quality);
        EXPECT_EQ(blocks[0], std::byte{200});
        EXPECT_EQ(blocks[1], std::byte{60});
        const auto decoded =
            samples_of<std::uint16_t>(decode_blocks(blocks, BlockFormat::bc4, 4, 4));
        for (std::size_t i = 0; i < 16; ++i)
            EXPECT_EQ(decoded[i], 257 * codes[i]);
    }
}

TEST(Bc4Encoder, EndsOfTheRangeAreExact) {
    // Black, white, and values between 100 and 105: only the second order of codes has them all.
    std::vector<std::uint8_t> codes(16);
    for (std::size_t i = 0; i < 16; ++i)
        codes[i] = static_cast<std::uint8_t>(i < 6 ? 100 + i : (i % 2 == 0 ? 0 : 255));
    const Image image = image_of(4, 4, 1, ColorSpace::data, codes);
    for (const BlockQuality quality : {BlockQuality::normal, BlockQuality::best}) {
        const auto decoded = samples_of<std::uint16_t>(
            decode_blocks(encode_blocks(image, BlockFormat::bc4, quality), BlockFormat::bc4, 4, 4));
        for (std::size_t i = 0; i < 16; ++i)
            EXPECT_EQ(decoded[i], 257 * codes[i]);
    }
}

/// Sums of squared errors of the blocks of one channel, in codes of 8 bits.
std::vector<double> block_errors(const Image& image, const Image& decoded) {
    const auto values = to_float(image);
    const auto results = to_float(decoded);
    std::vector<double> sums(static_cast<std::size_t>(image.width / 4 * (image.height / 4)));
    for (std::size_t i = 0; i < values.sample_count(); ++i) {
        const std::size_t x = i % static_cast<std::size_t>(image.width);
        const std::size_t y = i / static_cast<std::size_t>(image.width);
        const double error =
            255.0 * static_cast<double>(values.as<float>()[i] - results.as<float>()[i]);
        sums[y / 4 * static_cast<std::size_t>(image.width / 4) + x / 4] += error * error;
    }
    return sums;
}

TEST(Bc4Encoder, ErrorsAreBoundedAndBetterQualitiesAreNotWorse) {
    // 68 blocks across exceed a group of blocks; noise of all ranges.
    Image image = test::rough(68 * 4, 8);
    for (std::size_t i = 0; i < image.sample_count(); ++i) {
        const auto block = static_cast<float>(i % 272 / 4);
        image.as<float>()[i] = 0.4F + (image.as<float>()[i] - 0.4F) * (block + 1.0F) / 68.0F;
    }
    std::vector<std::vector<double>> errors;
    for (const BlockQuality quality : all_qualities) {
        const Image decoded = decode_blocks(encode_blocks(image, BlockFormat::bc4, quality),
                                            BlockFormat::bc4, image.width, image.height);
        errors.push_back(block_errors(image, decoded));
    }
    const double rounding = 0.01;  // 16 bits of the decoder, and sums in float.
    for (std::size_t block = 0; block < errors[0].size(); ++block) {
        // A range of 1 to 255 codes, rounded outwards, has steps of at most 257 / 7 codes.
        const double half_step = (255.0 * static_cast<double>(block % 68 + 1) / 68.0 + 2.0) / 14.0;
        EXPECT_LE(errors[0][block], 16.0 * half_step * half_step);
        EXPECT_LE(errors[1][block], errors[0][block] + rounding);
        EXPECT_LE(errors[2][block], errors[1][block] + rounding);
    }
}

TEST(BlockEncoder, TheLastTexelsAreRepeatedToFillBlocks) {
    const Image small = test::rough(5, 3);
    Image padded = make_image(8, 4, 1, 32, ColorSpace::data);
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 8; ++x) {
            padded.as<float>()[static_cast<std::size_t>(8 * y + x)] =
                small.as<float>()[static_cast<std::size_t>(5 * std::min(y, 2) + std::min(x, 4))];
        }
    }
    for (const BlockQuality quality : all_qualities) {
        EXPECT_EQ(encode_blocks(small, BlockFormat::bc4, quality),
                  encode_blocks(padded, BlockFormat::bc4, quality));
    }
    EXPECT_EQ(encode_blocks(image_of(1, std::vector<std::uint8_t>{77}), BlockFormat::bc4,
                            BlockQuality::best)
                  .size(),
              8U);
}

TEST(BlockEncoder, SamplesThatAreNotFiniteAreCountedAndBecomeZero) {
    const float infinity = std::numeric_limits<float>::infinity();
    const Image image = image_of(1, std::vector<float>{0.5F, quiet_nan, -infinity});
    Report report;
    const auto blocks = encode_blocks(image, BlockFormat::bc4, BlockQuality::normal, report);
    EXPECT_EQ(report.count("sample that is not finite"), 2U);
    const auto decoded = samples_of<std::uint16_t>(decode_blocks(blocks, BlockFormat::bc4, 3, 1));
    EXPECT_EQ(decoded[1], 0);
    EXPECT_EQ(decoded[2], 0);
    EXPECT_THAT(report.findings()[0].first, ElementsAre(1, 2));
}

TEST(BlockEncoder, RefusesOtherChannels) {
    const Image image = make_image(4, 4, 2, 8, ColorSpace::data);
    EXPECT_EQ(message_of<InvalidInput>(
                  [&] { encode_blocks(image, BlockFormat::bc4, BlockQuality::fast); }),
              "bc4 has 1 channels, not 2");
    EXPECT_EQ(message_of<InvalidInput>(
                  [&] { encode_blocks(image, BlockFormat::bc7, BlockQuality::fast); }),
              "bc7 has 3 or 4 channels, not 2");
    EXPECT_EQ(message_of<InvalidInput>([&] {
                  const Image normals = make_image(4, 4, 3, 32, ColorSpace::data);
                  encode_normal_blocks(normals, {.format = BlockFormat::bc7});
              }),
              "normals are stored in bc5, not in bc7");
}

// Normals.

/// Normals of two waves: a map whose size is no multiple of 4.
Image wave_normals(int width, int height) {
    Image slopes = make_image(width, height, 2, 32, ColorSpace::data);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            float* const slope = slopes.as<float>().data() + 2 * (y * width + x);
            slope[0] = static_cast<float>(0.4 * std::cos(0.21 * x + 0.05 * y));
            slope[1] = static_cast<float>(0.4 * std::sin(0.17 * y - 0.1 * x));
        }
    }
    return normals_from_slopes(slopes);
}

FlatCode flat_of(BlockFormat format) {
    return is_signed(format) ? FlatCode::middle : FlatCode::half;
}

Image decoded_normals(const Blocks& blocks, BlockFormat format, FlatCode flat, int width,
                      int height) {
    return decode_xy_map(decode_blocks(blocks, format, width, height), {0, 1}, Green::up, flat);
}

/// The angle between two normals in degrees.
double angle_between(const float* a, const float* b) {
    const std::array<double, 3> p = {a[0], a[1], a[2]};
    const std::array<double, 3> q = {b[0], b[1], b[2]};
    const double x = p[1] * q[2] - p[2] * q[1];
    const double y = p[2] * q[0] - p[0] * q[2];
    const double z = p[0] * q[1] - p[1] * q[0];
    return 180.0 / std::acos(-1.0) *
           std::atan2(std::sqrt(x * x + y * y + z * z), p[0] * q[0] + p[1] * q[1] + p[2] * q[2]);
}

double mean_angle(const Image& normals, const Image& decoded) {
    double sum = 0.0;
    for (std::size_t i = 0; i < normals.sample_count(); i += 3)
        sum += angle_between(&normals.as<float>()[i], &decoded.as<float>()[i]);
    return 3.0 * sum / static_cast<double>(normals.sample_count());
}

TEST(NormalBlocks, BetterQualitiesHaveSmallerAngles) {
    const Image normals = wave_normals(123, 61);
    for (const BlockFormat format : {BlockFormat::bc5, BlockFormat::bc5_snorm}) {
        std::vector<double> means;
        for (const BlockQuality quality : all_qualities) {
            const auto blocks =
                encode_normal_blocks(normals, {.format = format, .quality = quality});
            means.push_back(
                mean_angle(normals, decoded_normals(blocks, format, flat_of(format), 123, 61)));
        }
        EXPECT_LT(means[0], 0.7);  // Blocks have a range of about 16 degrees, in steps of 2.3.
        EXPECT_LT(means[1], 0.9 * means[0]);
        EXPECT_LE(means[2], means[1]);
        EXPECT_GT(means[2], 0.1);
    }
}

TEST(NormalBlocks, FlatIsFlat) {
    Image normals = make_image(9, 5, 3, 32, ColorSpace::data);
    for (std::size_t i = 2; i < normals.sample_count(); i += 3)
        normals.as<float>()[i] = 1.0F;
    for (const BlockQuality quality : all_qualities) {
        const auto snorm =
            encode_normal_blocks(normals, {.format = BlockFormat::bc5_snorm, .quality = quality});
        EXPECT_EQ(decoded_normals(snorm, BlockFormat::bc5_snorm, FlatCode::middle, 9, 5).samples,
                  normals.samples);
        const auto half = encode_normal_blocks(normals, {.quality = quality});
        const Image decoded = decoded_normals(half, BlockFormat::bc5, FlatCode::half, 9, 5);
        EXPECT_LT(mean_angle(normals, decoded), 0.05);
    }
}

TEST(NormalBlocks, TheLengthOfNormalsDoesNotMatter) {
    Image normals = wave_normals(20, 4);
    const auto blocks = encode_normal_blocks(normals, {});
    for (float& component : normals.as<float>())
        component *= 1024.0F;
    EXPECT_EQ(encode_normal_blocks(normals, {}), blocks);
}

TEST(NormalBlocks, GreenDownIsTheMirroredMap) {
    Image normals = wave_normals(20, 4);
    const auto down = encode_normal_blocks(normals, {.green = Green::down});
    for (std::size_t i = 1; i < normals.sample_count(); i += 3)
        normals.as<float>()[i] = -normals.as<float>()[i];
    EXPECT_EQ(encode_normal_blocks(normals, {}), down);
}

TEST(NormalBlocks, OddNormalsAreCountedAndStoredAsStated) {
    // A whole block of each; the tiny and the huge one are normalized in double.
    const std::array<std::array<float, 3>, 6> kinds = {{{0.0F, 0.0F, 0.0F},
                                                        {quiet_nan, 0.0F, 1.0F},
                                                        {3.0F, 4.0F, -1.0F},
                                                        {0.0F, 0.0F, -1.0F},
                                                        {0.0F, 6e-30F, 8e-30F},
                                                        {6e30F, 0.0F, 8e30F}}};
    Image normals = make_image(24, 4, 3, 32, ColorSpace::data);
    for (std::size_t texel = 0; texel < 96; ++texel) {
        std::copy_n(kinds[texel % 24 / 4].data(), 3, &normals.as<float>()[3 * texel]);
    }
    Report report;
    const auto blocks = encode_normal_blocks(normals, {.format = BlockFormat::bc5_snorm}, report);
    EXPECT_EQ(report.count("normal without direction"), 32U);
    EXPECT_EQ(report.count("normal that faces back"), 32U);
    const auto samples =
        samples_of<std::uint16_t>(decode_blocks(blocks, BlockFormat::bc5_snorm, 24, 4));
    const std::array<std::array<double, 2>, 6> expected = {
        {{0.0, 0.0}, {0.0, 0.0}, {0.6, 0.8}, {0.0, 0.0}, {0.0, 0.6}, {0.6, 0.0}}};
    for (std::size_t block = 0; block < 6; ++block) {
        for (std::size_t c = 0; c < 2; ++c) {
            const double step = 1.0 / 7.0 / 127.0;
            EXPECT_NEAR((samples[8 * block + c] - 32768.0) / 32767.0, expected[block][c], step);
        }
    }
}

/// Bytes of all formats and qualities for integer data: a number of 64 bits.
std::uint64_t integer_fingerprint() {
    Image codes = make_image(71, 9, 2, 16, ColorSpace::data);
    std::uint32_t state = 1;
    for (std::size_t i = 0; i < codes.sample_count(); ++i) {
        state = 1664525U * state + 1013904223U;
        codes.as<std::uint16_t>()[i] =
            static_cast<std::uint16_t>(20000 + 90 * (i % 142) + (state >> 16U) % 6000);
    }
    const Image normals = decode_xy_map(codes, {0, 1}, Green::up, FlatCode::half);
    Image colors = make_image(71, 9, 4, 16, ColorSpace::data);
    for (std::size_t i = 0; i < colors.sample_count(); ++i)
        colors.as<std::uint16_t>()[i] =
            codes.as<std::uint16_t>()[(i / 2 + i % 2) % codes.sample_count()];
    std::uint64_t hash = 14695981039346656037ULL;
    const auto add = [&](const Blocks& blocks) { hash = test::hash_after(hash, blocks); };
    for (const BlockQuality quality : all_qualities) {
        for (const BlockFormat format : {BlockFormat::bc5, BlockFormat::bc5_snorm}) {
            add(encode_blocks(codes, format, quality));
            add(encode_normal_blocks(normals, {.format = format, .quality = quality}));
        }
        add(encode_blocks(colors, BlockFormat::bc7, quality));
    }
    return hash;
}

TEST(BlockEncoder, TheBytesAreTheSameForAnyThreadsProcessorAndCompiler) {
    constexpr std::uint64_t expected = 1608099463192973029ULL;
    test::expect_everywhere(integer_fingerprint, expected);
}

// BC7.

/// The fields of a block: endpoints of subset 0 are black and white, those of the others white and
/// black, so that texels of the others have the opposite color.
struct Bc7Fields {
    unsigned mode;
    std::vector<Bits> before_colors;  ///< Partition, rotation, selection.
    unsigned subsets, color_bits, alpha_bits;
    std::vector<Bits> parity;
    std::vector<unsigned> index_bits;  ///< Of each texel.
    unsigned index;
    std::vector<unsigned> second_index_bits{};
    unsigned second_index = 0;
};

Blocks bc7_block(const Bc7Fields& fields) {
    std::vector<Bits> bits = {{1U << fields.mode, fields.mode + 1}};
    bits.insert(bits.end(), fields.before_colors.begin(), fields.before_colors.end());
    for (unsigned channel = 0; channel < 4; ++channel) {
        const unsigned count = channel < 3 ? fields.color_bits : fields.alpha_bits;
        for (unsigned end = 0; end < 2 * fields.subsets && count > 0; ++end) {
            const bool is_white = (end % 2 == 1) == (end < 2);
            bits.push_back({is_white ? (1U << count) - 1 : 0, count});
        }
    }
    bits.insert(bits.end(), fields.parity.begin(), fields.parity.end());
    for (const unsigned count : fields.index_bits)
        bits.push_back({fields.index & ((1U << count) - 1), count});
    for (const unsigned count : fields.second_index_bits)
        bits.push_back({fields.second_index & ((1U << count) - 1), count});
    return block_of(16, bits);
}

/// 16 counts of bits, one less for the anchors.
std::vector<unsigned> index_counts(unsigned count, std::initializer_list<std::size_t> anchors) {
    std::vector<unsigned> counts(16, count);
    for (const std::size_t anchor : anchors)
        --counts[anchor];
    return counts;
}

std::array<std::uint8_t, 4> texel_of(const Blocks& block, std::size_t texel) {
    const auto samples = samples_of<std::uint8_t>(decode_blocks(block, BlockFormat::bc7, 4, 4));
    return {samples[4 * texel], samples[4 * texel + 1], samples[4 * texel + 2],
            samples[4 * texel + 3]};
}

TEST(Bc7Decoder, Mode0) {
    // Three subsets; partition 8: rows 0 and 1, row 2, row 3. Index 1 of 8 has the weight 9 of 64:
    // (9 * 255 + 32) / 64 = 36 from black.
    const Blocks block = bc7_block({0,
                                    {{8, 4}},
                                    3,
                                    4,
                                    0,
                                    {{0, 1}, {1, 1}, {1, 1}, {0, 1}, {1, 1}, {0, 1}},
                                    index_counts(3, {0, 8, 15}),
                                    1});
    EXPECT_THAT(texel_of(block, 0), ElementsAre(36, 36, 36, 255));
    EXPECT_THAT(texel_of(block, 7), ElementsAre(36, 36, 36, 255));
    EXPECT_THAT(texel_of(block, 8), ElementsAre(219, 219, 219, 255));
    EXPECT_THAT(texel_of(block, 15), ElementsAre(219, 219, 219, 255));
}

TEST(Bc7Decoder, Mode1) {
    // Two subsets; partition 13: the upper and the lower half. One parity for both ends: black is
    // (0, 1) of 7 bits, 1 << 1 | 1 >> 6 = 2. (55 * 2 + 9 * 255 + 32) / 64 = 38.
    const Blocks block =
        bc7_block({1, {{13, 6}}, 2, 6, 0, {{1, 1}, {1, 1}}, index_counts(3, {0, 15}), 1});
    EXPECT_THAT(texel_of(block, 0), ElementsAre(38, 38, 38, 255));
    EXPECT_THAT(texel_of(block, 8), ElementsAre(219, 219, 219, 255));
}

TEST(Bc7Decoder, Mode2) {
    // Three subsets, no parity, indices of 2 bits: weight 21 of 64 gives 84.
    const Blocks block = bc7_block({2, {{8, 6}}, 3, 5, 0, {}, index_counts(2, {0, 8, 15}), 1});
    EXPECT_THAT(texel_of(block, 4), ElementsAre(84, 84, 84, 255));
    EXPECT_THAT(texel_of(block, 11), ElementsAre(171, 171, 171, 255));
}

TEST(Bc7Decoder, Mode3) {
    const Blocks block = bc7_block(
        {3, {{13, 6}}, 2, 7, 0, {{0, 1}, {1, 1}, {1, 1}, {0, 1}}, index_counts(2, {0, 15}), 1});
    EXPECT_THAT(texel_of(block, 1), ElementsAre(84, 84, 84, 255));
    EXPECT_THAT(texel_of(block, 9), ElementsAre(171, 171, 171, 255));
}

TEST(Bc7Decoder, Mode4) {
    // The first indices (2 bits, 1: 84) are those of colors, the second (3 bits, 2: weight 18, 72)
    // those of alpha; the selection bit exchanges them; rotation 1 exchanges alpha and red.
    Bc7Fields fields{4, {{0, 2}, {0, 1}},     1, 5, 6, {}, index_counts(2, {0}),
                     1, index_counts(3, {0}), 2};
    EXPECT_THAT(texel_of(bc7_block(fields), 5), ElementsAre(84, 84, 84, 72));
    fields.before_colors = {{0, 2}, {1, 1}};
    EXPECT_THAT(texel_of(bc7_block(fields), 5), ElementsAre(72, 72, 72, 84));
    fields.before_colors = {{1, 2}, {0, 1}};
    EXPECT_THAT(texel_of(bc7_block(fields), 5), ElementsAre(72, 84, 84, 84));
}

TEST(Bc7Decoder, Mode5) {
    // Indices of 2 bits for both: 1 gives 84, 2 gives 171. Rotation 3 exchanges alpha and blue.
    const Blocks block =
        bc7_block({5, {{3, 2}}, 1, 7, 8, {}, index_counts(2, {0}), 1, index_counts(2, {0}), 2});
    EXPECT_THAT(texel_of(block, 6), ElementsAre(84, 84, 171, 84));
}

TEST(Bc7Decoder, Mode6) {
    // Index 5 of 16 has the weight 21: 84; alpha as the colors.
    const Blocks block = bc7_block({6, {}, 1, 7, 7, {{0, 1}, {1, 1}}, index_counts(4, {0}), 5});
    EXPECT_THAT(texel_of(block, 0), ElementsAre(84, 84, 84, 84));
    EXPECT_THAT(texel_of(block, 15), ElementsAre(84, 84, 84, 84));
}

TEST(Bc7Decoder, Mode7) {
    const Blocks block = bc7_block(
        {7, {{13, 6}}, 2, 5, 5, {{0, 1}, {1, 1}, {1, 1}, {0, 1}}, index_counts(2, {0, 15}), 1});
    EXPECT_THAT(texel_of(block, 2), ElementsAre(84, 84, 84, 84));
    EXPECT_THAT(texel_of(block, 14), ElementsAre(171, 171, 171, 171));
}

TEST(Bc7Decoder, TheReservedModeIsTransparentBlack) {
    EXPECT_THAT(samples_of<std::uint8_t>(decode_blocks(Blocks(16), BlockFormat::bc7, 4, 4)),
                Each(0));
}

/// The sum of squared errors in codes of 8 bits.
double squared_error(const Image& image, BlockQuality quality) {
    const Image decoded = decode_blocks(encode_blocks(image, BlockFormat::bc7, quality),
                                        BlockFormat::bc7, image.width, image.height);
    const Image exact = to_float(image);
    const auto channels = static_cast<std::size_t>(image.channels);
    double sum = 0.0;
    for (std::size_t i = 0; i < exact.sample_count(); ++i) {
        const double difference = 255.0 * static_cast<double>(exact.as<float>()[i]) -
                                  decoded.as<std::uint8_t>()[i / channels * 4 + i % channels];
        sum += difference * difference;
    }
    return sum;
}

TEST(Bc7Encoder, FlatBlocksOfEightBitsAreExact) {
    std::vector<std::uint8_t> codes;
    for (int i = 0; i < 256 * 4; ++i) {
        const int block = i / 4;
        for (const int factor : {1, 3, 7, 11})
            codes.push_back(static_cast<std::uint8_t>(factor * block));
    }
    for (const BlockQuality quality : all_qualities)
        EXPECT_LT(squared_error(image_of(4, codes), quality), 1e-6);  // Codes in float.
}

TEST(Bc7Encoder, AnAbsentAlphaIsOpaque) {
    Image image = make_image(7, 5, 3, 8, ColorSpace::data);
    for (std::size_t i = 0; i < image.sample_count(); ++i)
        image.as<std::uint8_t>()[i] = static_cast<std::uint8_t>(7 * i);
    const Image decoded = decode_blocks(encode_blocks(image, BlockFormat::bc7, BlockQuality::best),
                                        BlockFormat::bc7, 7, 5);
    for (std::size_t i = 3; i < decoded.sample_count(); i += 4)
        EXPECT_EQ(decoded.as<std::uint8_t>()[i], 255);
}

/// Rows of 128 blocks with colors of several kinds: noise; steps, and noise on one slope; and
/// two slopes in the subsets of a partition, which differs for each block.
Image mixed_colors(bool has_alpha) {
    Image image = make_image(4 * 128, 12, 4, 8, ColorSpace::data);
    const std::span<std::uint8_t> samples = image.as<std::uint8_t>();
    std::uint32_t state = 1;
    for (std::size_t y = 0; y < 12; ++y) {
        for (std::size_t x = 0; x < 4 * 128; ++x) {
            const std::size_t texel = 4 * (y % 4) + x % 4;
            const unsigned bits = detail::bptc_partitions_2[x / 4 % 64];
            const bool is_second = (bits >> texel & 1U) == 1;
            for (std::size_t c = 0; c < 4; ++c) {
                state = 1664525U * state + 1013904223U;
                const std::uint32_t noise = state >> 24U;
                const std::size_t slope =
                    is_second ? 250 - 3 * texel * (c + 1) : 10 + 9 * texel / (c + 1);
                const std::size_t steps = (is_second ? 200 : 30) + 2 * (texel % 4);
                std::size_t code = noise;
                if (y / 4 == 1) code = x < 256 ? steps : (c + 2) * texel + noise / 64;
                if (y / 4 == 2) code = slope;
                samples[(y * 4 * 128 + x) * 4 + c] =
                    c == 3 && !has_alpha ? std::uint8_t{255} : static_cast<std::uint8_t>(code);
            }
        }
    }
    return image;
}

/// The squared error that the search computes for a row of blocks.
std::vector<double> predicted_errors(const Image& image, std::size_t row, BlockQuality quality,
                                     std::array<int, 8>& modes) {
    std::vector<double> errors;
    for (std::size_t first = 0; first < 128; first += detail::bptc_lanes) {
        detail::Bc7Colors colors{};
        colors.count = detail::bptc_lanes;
        for (std::size_t lane = 0; lane < colors.count; ++lane) {
            for (std::size_t t = 0; t < 16; ++t) {
                const std::size_t texel = (4 * row + t / 4) * 512 + 4 * (first + lane) + t % 4;
                for (std::size_t c = 0; c < 4; ++c)
                    colors.channel[c][t][lane] = image.as<std::uint8_t>()[4 * texel + c];
            }
        }
        detail::Bc7Encodings encodings;
        detail::choose_bc7_encodings(colors, quality, encodings);
        for (const detail::Bc7Encoding& encoding : encodings) {
            errors.push_back(static_cast<double>(encoding.error));
            ++modes[encoding.mode];
        }
    }
    return errors;
}

TEST(Bc7Encoder, BlocksDecodeWithTheErrorThatTheSearchComputes) {
    for (const BlockQuality quality : all_qualities) {
        std::array<int, 8> modes{};
        for (const bool has_alpha : {false, true}) {
            const Image image = mixed_colors(has_alpha);
            const Image decoded = decode_blocks(encode_blocks(image, BlockFormat::bc7, quality),
                                                BlockFormat::bc7, image.width, image.height);
            for (std::size_t row = 0; row < 3; ++row) {
                const std::vector<double> predicted = predicted_errors(image, row, quality, modes);
                for (std::size_t block = 0; block < 128; ++block) {
                    int error = 0;
                    for (std::size_t i = 0; i < 64; ++i) {
                        const std::size_t texel = (4 * row + i / 16) * 512 + 4 * block + i / 4 % 4;
                        const int difference = image.as<std::uint8_t>()[4 * texel + i % 4] -
                                               decoded.as<std::uint8_t>()[4 * texel + i % 4];
                        error += difference * difference;
                    }
                    ASSERT_EQ(error, predicted[block]) << "row " << row << ", block " << block;
                }
            }
        }
        for (const std::size_t mode : {1U, 6U})
            EXPECT_GT(modes[mode], 0) << mode;
        for (const std::size_t mode : {3U, 5U, 7U})
            EXPECT_EQ(modes[mode] > 0, quality != BlockQuality::fast) << mode;
    }
}

TEST(Bc7Encoder, NoBlockHasALargerErrorWithABetterQuality) {
    std::array<int, 8> modes{};
    for (const bool has_alpha : {false, true}) {
        const Image image = mixed_colors(has_alpha);
        for (std::size_t row = 0; row < 3; ++row) {
            const auto fast = predicted_errors(image, row, BlockQuality::fast, modes);
            const auto normal = predicted_errors(image, row, BlockQuality::normal, modes);
            const auto best = predicted_errors(image, row, BlockQuality::best, modes);
            for (std::size_t block = 0; block < 128; ++block) {
                EXPECT_LE(normal[block], fast[block]) << "row " << row << ", block " << block;
                EXPECT_LE(best[block], normal[block]) << "row " << row << ", block " << block;
            }
        }
    }
}

TEST(Bc7Encoder, ColorsOnTwoLinesHaveSmallErrorsInEachPartition) {
    for (const bool has_alpha : {false, true}) {
        const Image image = part_of(mixed_colors(has_alpha), {0, 8, 512, 4});
        for (const BlockQuality quality : all_qualities) {
            // Modes of one subset have mean squared errors of 101 without alpha, 191 with it.
            const bool is_searched = !has_alpha || quality != BlockQuality::fast;
            const double limit = !is_searched ? 201.0 : has_alpha ? 45.0 : 8.0;
            EXPECT_LT(squared_error(image, quality) / (512 * 4 * 4), limit) << has_alpha;
        }
    }
}

TEST(Bc7Encoder, BetterQualitiesHaveSmallerErrors) {
    // Smooth colors; and masks that do not depend on each other, which need separate indices.
    Image smooth = make_image(32, 32, 3, 32, ColorSpace::data);
    Image masks = smooth;
    for (std::size_t i = 0; i < 32 * 32; ++i) {
        const auto x = static_cast<float>(i % 32) / 32.0F;
        const auto y = static_cast<float>(i / 32) / 32.0F;
        float* const color = &smooth.as<float>()[3 * i];
        color[0] = x;
        color[1] = 0.5F * (x + y);
        color[2] = 1.0F - x;
        float* const mask = &masks.as<float>()[3 * i];
        mask[0] = x;
        mask[1] = y;
        mask[2] = 1.0F;
    }
    for (const Image* image : {&smooth, &masks}) {
        const double fast = squared_error(*image, BlockQuality::fast);
        const double normal = squared_error(*image, BlockQuality::normal);
        EXPECT_LE(normal, fast);
        EXPECT_LE(squared_error(*image, BlockQuality::best), normal);
    }
    // Colors of a block are almost on a line of 16 values.
    EXPECT_LT(squared_error(smooth, BlockQuality::normal) / (32 * 32 * 3), 2.0);
    EXPECT_LT(squared_error(masks, BlockQuality::normal),
              0.25 * squared_error(masks, BlockQuality::fast));
}

// BC1 and BC3.

TEST(Bc1Decoder, OrderOfTheEndpointsSelectsThirdsOrTransparentBlack) {
    // Red (31, 0, 0) and blue (0, 0, 31), and the indices 0 to 3.
    const auto block = [](unsigned first, unsigned second) {
        std::vector<Bits> fields = {{first, 16}, {second, 16}};
        for (unsigned t = 0; t < 16; ++t)
            fields.push_back({t % 4, 2});
        return block_of(8, fields);
    };
    const auto first_four = [](const Blocks& blocks, BlockFormat format, std::size_t channels) {
        const auto samples = samples_of<std::uint8_t>(decode_blocks(blocks, format, 4, 4));
        return std::vector<std::uint8_t>(samples.begin(),
                                         samples.begin() + static_cast<long>(4 * channels));
    };
    EXPECT_THAT(first_four(block(0xF800, 0x001F), BlockFormat::bc1, 3),
                ElementsAre(255, 0, 0, 0, 0, 255, 170, 0, 85, 85, 0, 170));
    EXPECT_THAT(first_four(block(0x001F, 0xF800), BlockFormat::bc1, 3),
                ElementsAre(0, 0, 255, 255, 0, 0, 127, 0, 127, 0, 0, 0));
    EXPECT_THAT(first_four(block(0x001F, 0xF800), BlockFormat::bc1a, 4),
                ElementsAre(0, 0, 255, 255, 255, 0, 0, 255, 127, 0, 127, 255, 0, 0, 0, 0));
    // In BC3 the order has no meaning.
    Blocks bc3 = bc4_block(255, 255);
    const Blocks colors = block(0x001F, 0xF800);
    bc3.insert(bc3.end(), colors.begin(), colors.end());
    EXPECT_EQ(samples_of<std::uint8_t>(decode_blocks(bc3, BlockFormat::bc3, 4, 4))[8], 85);
}

TEST(Bc1Encoder, SingleColorsHaveAnErrorOfAtMostTwoCodes) {
    for (const BlockQuality quality : all_qualities) {
        for (int code = 0; code < 256; code += 5) {
            const auto level = static_cast<std::uint8_t>(code);
            std::vector<std::uint8_t> samples;
            for (int t = 0; t < 16; ++t)
                samples.insert(samples.end(),
                               {level, static_cast<std::uint8_t>(255 - code), level});
            const Image image = image_of(4, 4, 3, ColorSpace::data, samples);
            const Image decoded = decode_blocks(encode_blocks(image, BlockFormat::bc1, quality),
                                                BlockFormat::bc1, 4, 4);
            const auto result = samples_of<std::uint8_t>(decoded);
            for (std::size_t i = 0; i < result.size(); ++i)
                EXPECT_NEAR(result[i], samples[i], 2) << code;
        }
    }
}

/// Colors with texture, and alpha that is 0 in some texels.
Image colors_with_alpha(int width, int height) {
    Image image = make_image(width, height, 4, 8, ColorSpace::srgb);
    const auto samples = image.as<std::uint8_t>();
    std::uint32_t state = 3;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        state = 1664525U * state + 1013904223U;
        const std::size_t texel = i / 4;
        const auto base = static_cast<std::uint32_t>(60 + 3 * (texel % 40) + 10 * (i % 4));
        samples[i] = static_cast<std::uint8_t>(i % 4 == 3 ? (texel % 7 == 0 ? 0 : 255)
                                                          : base + (state >> 28U));
    }
    return image;
}

double squared_error(const Image& image, BlockFormat format, BlockQuality quality) {
    const Image decoded =
        decode_blocks(encode_blocks(image, format, quality), format, image.width, image.height);
    const auto a = samples_of<std::uint8_t>(image);
    const auto b = samples_of<std::uint8_t>(decoded);
    const auto channels = static_cast<std::size_t>(image.channels);
    const auto decoded_channels = static_cast<std::size_t>(decoded.channels);
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const int difference = a[i] - b[i / channels * decoded_channels + i % channels];
        sum += difference * difference;
    }
    return sum / static_cast<double>(a.size());
}

TEST(Bc1Encoder, BetterQualityHasNoLargerError) {
    Image image = colors_with_alpha(37, 22);
    const double bc3 = squared_error(image, BlockFormat::bc3, BlockQuality::normal);
    EXPECT_LE(squared_error(image, BlockFormat::bc3, BlockQuality::best), bc3);
    EXPECT_LT(bc3, squared_error(image, BlockFormat::bc3, BlockQuality::fast));
    drop_alpha(image);
    const double bc1 = squared_error(image, BlockFormat::bc1, BlockQuality::normal);
    EXPECT_LE(squared_error(image, BlockFormat::bc1, BlockQuality::best), bc1);
    EXPECT_LT(bc1, squared_error(image, BlockFormat::bc1, BlockQuality::fast));
    EXPECT_LT(bc1, 40.0);
    EXPECT_LT(squared_error(image, BlockFormat::bc7, BlockQuality::normal), bc1);
}

TEST(Bc1Encoder, TransparentTexelsStayTransparent) {
    const Image image = colors_with_alpha(20, 12);
    for (const BlockQuality quality : all_qualities) {
        const Image decoded = decode_blocks(encode_blocks(image, BlockFormat::bc1a, quality),
                                            BlockFormat::bc1a, 20, 12);
        const auto a = samples_of<std::uint8_t>(image);
        const auto b = samples_of<std::uint8_t>(decoded);
        for (std::size_t i = 3; i < a.size(); i += 4)
            ASSERT_EQ(a[i], b[i]) << i;
    }
}

TEST(Bc1Encoder, OtherChannelsAreRefused) {
    const Image image = colors_with_alpha(4, 4);
    EXPECT_EQ(message_of<InvalidInput>(
                  [&] { encode_blocks(image, BlockFormat::bc1, BlockQuality::fast); }),
              "bc1 has 3 channels, not 4");
}

}  // namespace
}  // namespace relief
