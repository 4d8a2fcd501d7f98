// SPDX-License-Identifier: Apache-2.0
// BC6H: blocks of every mode against hand-computed values, and properties of encoded ones.
// tests/shade/gl/block_decoding_test.cpp compares the decoder with OpenGL.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "image/bc6h_format.h"
#include "image/half_float.h"
#include "mesh/image/block_fields.h"
#include "relief/mesh/block_compression.h"
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
using testing::HasSubstr;

constexpr BlockFormat both_formats[] = {BlockFormat::bc6h, BlockFormat::bc6h_sfloat};

// Decoding.

/// A block whose first endpoint is (1, 2, 4), plus the highest bit of each channel. The second one
/// is larger by 1 in each channel, the third one smaller by 1, and the fourth one by 2.
struct ModeBlock {
    unsigned number;  ///< From 1.
    Bits selector;
    int bits;  ///< Of the first endpoint.
    unsigned subsets;
    std::vector<Bits> ends;  ///< In the order of the format.
};

// A difference of -1 has all bits, and -2 all but the lowest.
const std::vector<ModeBlock> mode_blocks = {
    {1,
     {0, 2},
     10,
     2,
     {{1, 1},
      {1, 1},
      {1, 1},
      {513, 10},
      {514, 10},
      {516, 10},
      {1, 5},
      {1, 1},
      {15, 4},
      {1, 5},
      {0, 1},
      {14, 4},
      {1, 5},
      {1, 1},
      {15, 4},
      {31, 5},
      {1, 1},
      {30, 5},
      {1, 1}}},
    {2, {1, 2}, 7, 2, {{1, 1},  {1, 1}, {1, 1},  {65, 7}, {0, 1},  {1, 1},  {1, 1}, {66, 7},
                       {1, 1},  {1, 1}, {1, 1},  {68, 7}, {1, 1},  {1, 1},  {1, 1}, {1, 6},
                       {15, 4}, {1, 6}, {14, 4}, {1, 6},  {15, 4}, {63, 6}, {62, 6}}},
    {3,
     {2, 5},
     11,
     2,
     {{1, 10},
      {2, 10},
      {4, 10},
      {1, 5},
      {1, 1},
      {15, 4},
      {1, 4},
      {1, 1},
      {0, 1},
      {14, 4},
      {1, 4},
      {1, 1},
      {1, 1},
      {15, 4},
      {31, 5},
      {1, 1},
      {30, 5},
      {1, 1}}},
    {4, {6, 5}, 11, 2, {{1, 10}, {2, 10}, {4, 10}, {1, 4},  {1, 1}, {1, 1}, {15, 4},
                        {1, 5},  {1, 1},  {14, 4}, {1, 4},  {1, 1}, {1, 1}, {15, 4},
                        {15, 4}, {0, 1},  {1, 1},  {14, 4}, {1, 1}, {1, 1}}},
    {5, {10, 5}, 11, 2, {{1, 10}, {2, 10}, {4, 10}, {1, 4},  {1, 1}, {1, 1}, {15, 4},
                         {1, 4},  {1, 1},  {0, 1},  {14, 4}, {1, 5}, {1, 1}, {15, 4},
                         {15, 4}, {1, 1},  {1, 1},  {14, 4}, {1, 1}, {1, 1}}},
    {6,
     {14, 5},
     9,
     2,
     {{257, 9},
      {1, 1},
      {258, 9},
      {1, 1},
      {260, 9},
      {1, 1},
      {1, 5},
      {1, 1},
      {15, 4},
      {1, 5},
      {0, 1},
      {14, 4},
      {1, 5},
      {1, 1},
      {15, 4},
      {31, 5},
      {1, 1},
      {30, 5},
      {1, 1}}},
    {7,
     {18, 5},
     8,
     2,
     {{129, 8},
      {1, 1},
      {1, 1},
      {130, 8},
      {1, 1},
      {1, 1},
      {132, 8},
      {1, 1},
      {1, 1},
      {1, 6},
      {15, 4},
      {1, 5},
      {0, 1},
      {14, 4},
      {1, 5},
      {1, 1},
      {15, 4},
      {63, 6},
      {62, 6}}},
    {8, {22, 5}, 8, 2, {{129, 8}, {0, 1}, {1, 1},  {130, 8}, {1, 1},  {1, 1},  {132, 8},
                        {1, 1},   {1, 1}, {1, 5},  {1, 1},   {15, 4}, {1, 6},  {14, 4},
                        {1, 5},   {1, 1}, {15, 4}, {31, 5},  {1, 1},  {30, 5}, {1, 1}}},
    {9, {26, 5}, 8, 2, {{129, 8}, {1, 1}, {1, 1},  {130, 8}, {1, 1},  {1, 1},  {132, 8},
                        {1, 1},   {1, 1}, {1, 5},  {1, 1},   {15, 4}, {1, 5},  {0, 1},
                        {14, 4},  {1, 6}, {15, 4}, {31, 5},  {1, 1},  {30, 5}, {1, 1}}},
    // No differences: the ends are 33, 34, 36; 34, 35, 37; 32, 33, 35; and 31, 32, 34.
    {10, {30, 5}, 6, 2, {{33, 6}, {0, 1},  {0, 1},  {1, 1},  {0, 1}, {34, 6}, {1, 1}, {1, 1},
                         {0, 1},  {0, 1},  {36, 6}, {1, 1},  {0, 1}, {1, 1},  {0, 1}, {34, 6},
                         {1, 4},  {35, 6}, {0, 4},  {37, 6}, {3, 4}, {32, 6}, {31, 6}}},
    {11, {3, 5}, 10, 1, {{513, 10}, {514, 10}, {516, 10}, {514, 10}, {515, 10}, {517, 10}}},
    {12,
     {7, 5},
     11,
     1,
     {{1, 10}, {2, 10}, {4, 10}, {1, 9}, {1, 1}, {1, 9}, {1, 1}, {1, 9}, {1, 1}}},
    // The highest bit comes first.
    {13,
     {11, 5},
     12,
     1,
     {{1, 10}, {2, 10}, {4, 10}, {1, 8}, {1, 2}, {1, 8}, {1, 2}, {1, 8}, {1, 2}}},
    {14,
     {15, 5},
     16,
     1,
     {{1, 10}, {2, 10}, {4, 10}, {1, 4}, {1, 6}, {1, 4}, {1, 6}, {1, 4}, {1, 6}}}};

/// Texels 1 and 9 have the largest index, and all others 0. Partition 13 is the upper and the
/// lower half.
Blocks block_of_mode(const ModeBlock& mode) {
    std::vector<Bits> fields = {mode.selector};
    fields.insert(fields.end(), mode.ends.begin(), mode.ends.end());
    if (mode.subsets == 2) fields.push_back({13, 5});
    for (unsigned t = 0; t < 16; ++t) {
        const bool is_anchor = t == 0 || (mode.subsets == 2 && t == 15);
        const unsigned count = (mode.subsets == 2 ? 3U : 4U) - (is_anchor ? 1U : 0U);
        fields.push_back({t % 8 == 1 ? (1U << count) - 1 : 0, count});
    }
    SCOPED_TRACE(mode.number);
    return block_of(16, fields);
}

/// The half float that a stored endpoint stands for: the middle of its step, except for 0 and the
/// largest numbers. \param end  of any size; only its bits are stored
float value_of_end(int end, int bits, bool is_signed) {
    const int count = 1 << bits;
    int stored = ((end % count) + count) % count;
    if (is_signed && stored >= count / 2) stored -= count;
    const int size = std::abs(stored);
    const int largest = (is_signed ? count / 2 : count) - 1;
    const double step = 65536.0 / count;
    double code = bits == 16 || size == 0 ? size * step : (size + 0.5) * step;
    if (size >= largest) code = is_signed ? 32767.0 : 65535.0;
    const auto half = static_cast<std::uint16_t>(code * 31.0 / (is_signed ? 32.0 : 64.0));
    const float value = detail::float_from_half(half);
    return stored < 0 ? -value : value;
}

TEST(Bc6hDecoder, EveryModeHasTheStatedEndpoints) {
    for (const ModeBlock& mode : mode_blocks) {
        for (const BlockFormat format : both_formats) {
            const auto samples =
                samples_of<float>(decode_blocks(block_of_mode(mode), format, 4, 4));
            const bool has_sign = format == BlockFormat::bc6h_sfloat;
            // The texels of the endpoints.
            constexpr std::array<std::size_t, 4> texels = {0, 1, 8, 9};
            constexpr std::array<int, 4> offsets = {0, 1, -1, -2};
            for (std::size_t end = 0; end < 2 * mode.subsets; ++end) {
                for (std::size_t c = 0; c < 3; ++c) {
                    const int first = (1 << (mode.bits - 1)) + (1 << c);
                    EXPECT_EQ(samples[3 * texels[end] + c],
                              value_of_end(first + offsets[end], mode.bits, has_sign))
                        << "mode " << mode.number << ", " << enum_name(format) << ", endpoint "
                        << end << ", channel " << c;
                }
            }
        }
    }
}

TEST(Bc6hDecoder, ValuesBetweenEndpointsAreLinearInCodes) {
    // Mode 11 from 0 to 1023: codes 0 and 65535. Index 5 of 16 has the weight 21 of 64:
    // (21 * 65535 + 32) / 64 = 21504, and 21504 * 31 / 64 = 10416 = 0x28B0: (1 + 176/1024) * 2^-5.
    Blocks block = block_of_mode(
        {11, {3, 5}, 10, 1, {{0, 10}, {0, 10}, {0, 10}, {1023, 10}, {1023, 10}, {1023, 10}}});
    block[8] = std::byte{0x05 << 4};  // Bits 68 to 71: texel 1.
    const auto samples = samples_of<float>(decode_blocks(block, BlockFormat::bc6h, 4, 4));
    EXPECT_EQ(samples[3], (1.0F + 176.0F / 1024.0F) / 32.0F);
    EXPECT_EQ(samples[0], 0.0F);
    // Texel 9 has the last index. 65535 * 31 / 64 = 31743, the largest half float.
    EXPECT_EQ(samples[27], 65504.0F);
}

TEST(Bc6hDecoder, ReservedModesAreBlack) {
    for (const int mode : {0x13, 0x17, 0x1B, 0x1F}) {
        Blocks block(16, std::byte{0xFF});
        block[0] = static_cast<std::byte>(0xE0 | mode);
        EXPECT_THAT(samples_of<float>(decode_blocks(block, BlockFormat::bc6h, 4, 4)), Each(0.0F))
            << mode;
    }
}

// Encoding.

/// Rows of 64 blocks: noise of 20 octaves; a gradient with a sun; two gradients in the subsets of a
/// partition; and gray noise of few steps around a value.
Image hdr_colors(bool has_negative) {
    Image image = make_image(4 * 64, 16, 3, 32, ColorSpace::linear);
    const std::span<float> samples = image.as<float>();
    std::uint32_t state = 1;
    for (std::size_t y = 0; y < 16; ++y) {
        for (std::size_t x = 0; x < 4 * 64; ++x) {
            const std::size_t texel = 4 * (y % 4) + x % 4;
            const bool is_second = (detail::bptc_partitions_2[x / 4 % 32] >> texel & 1U) == 1;
            const float from_sun = (static_cast<float>(x) - 100.0F) / 8.0F;
            const float small_steps = static_cast<float>(x / 4 % 32) / 300.0F;
            for (std::size_t c = 0; c < 3; ++c) {
                state = 1664525U * state + 1013904223U;
                const auto noise = static_cast<float>(state >> 8U) / 16777216.0F;
                const auto channel = static_cast<float>(c + 1);
                const auto along = static_cast<float>(texel) / 16.0F;
                float value = std::ldexp(1.0F + noise, static_cast<int>(20.0F * noise) - 10);
                if (y / 4 == 1)
                    value = 0.3F * channel + 500.0F / (1.0F + from_sun * from_sun * channel);
                if (y / 4 == 2)
                    value = is_second ? 3.0F + along * channel * small_steps
                                      : 0.2F + 0.1F * along * small_steps / channel;
                if (y / 4 == 3) value = 1.5F + small_steps * noise + 0.001F * channel;
                const bool is_negative = has_negative && (x / 64 % 2 == 1) == (c == 1);
                samples[(y * 256 + x) * 3 + c] = is_negative ? -value : value;
            }
        }
    }
    return image;
}

/// The code of 16 bits in whose middle a half float is decoded.
float code_of(float value, bool is_signed) {
    bool is_clamped = false;
    const float position = detail::half_from_float(std::abs(value), is_clamped);
    const float code = (position + 0.5F) * (is_signed ? 32.0F : 64.0F) / 31.0F;
    return value < 0.0F ? -code : code;
}

using EncodingsOfRow = std::vector<detail::Bc6hEncoding>;

/// The encodings of a row of 64 blocks, whose values are half floats.
EncodingsOfRow encodings_of(const Image& image, std::size_t row, BlockQuality quality,
                            bool is_signed) {
    EncodingsOfRow all;
    for (std::size_t first = 0; first < 64; first += detail::bptc_lanes) {
        detail::Bc6hColors colors{};
        colors.count = detail::bptc_lanes;
        colors.is_signed = is_signed;
        for (std::size_t lane = 0; lane < colors.count; ++lane) {
            for (std::size_t t = 0; t < 16; ++t) {
                const std::size_t texel = (4 * row + t / 4) * 256 + 4 * (first + lane) + t % 4;
                for (std::size_t c = 0; c < 3; ++c) {
                    colors.channel[c][t][lane] =
                        code_of(image.as<float>()[3 * texel + c], is_signed) / detail::bc6h_unit;
                }
                colors.weight[t][lane] = 1.0F;
            }
        }
        detail::Bc6hEncodings encodings;
        detail::choose_bc6h_encodings(colors, quality, encodings);
        all.insert(all.end(), encodings.begin(), encodings.end());
    }
    return all;
}

/// The same values as half floats.
Image with_half_floats(Image image) {
    for (float& value : image.as<float>()) {
        bool is_clamped = false;
        value = detail::float_from_half(detail::half_from_float(value, is_clamped));
    }
    return image;
}

TEST(Bc6hEncoder, BlocksDecodeWithTheErrorThatTheSearchComputes) {
    for (const bool has_sign : {false, true}) {
        const Image image = with_half_floats(hdr_colors(has_sign));
        const BlockFormat format = has_sign ? BlockFormat::bc6h_sfloat : BlockFormat::bc6h;
        for (const BlockQuality quality : all_qualities) {
            std::array<int, 14> modes{};
            const Image decoded = decode_blocks(encode_blocks(image, format, quality), format,
                                                image.width, image.height);
            for (std::size_t row = 0; row < 4; ++row) {
                const EncodingsOfRow encodings = encodings_of(image, row, quality, has_sign);
                for (std::size_t block = 0; block < 64; ++block) {
                    ++modes[encodings[block].mode];
                    double squares = 0.0;
                    for (std::size_t i = 0; i < 48; ++i) {
                        const std::size_t texel = (4 * row + i / 12) * 256 + 4 * block + i / 3 % 4;
                        const float rest =
                            code_of(image.as<float>()[3 * texel + i % 3], has_sign) -
                            code_of(decoded.as<float>()[3 * texel + i % 3], has_sign);
                        squares += static_cast<double>(rest) * static_cast<double>(rest);
                    }
                    const double predicted =
                        std::sqrt(static_cast<double>(encodings[block].error)) * 256.0;
                    // A half float stands for up to three codes, so that each of the 48 values has
                    // another error of up to 1.6.
                    EXPECT_NEAR(std::sqrt(squares), predicted, 1.6 * std::sqrt(48.0))
                        << "row " << row << ", block " << block;
                }
            }
            EXPECT_GE(14 - std::count(modes.begin(), modes.end(), 0), 8)
                << testing::PrintToString(modes);
        }
    }
}

TEST(Bc6hEncoder, NoBlockHasALargerErrorWithABetterQuality) {
    for (const bool has_sign : {false, true}) {
        const Image image = hdr_colors(has_sign);
        for (std::size_t row = 0; row < 4; ++row) {
            const auto fast = encodings_of(image, row, BlockQuality::fast, has_sign);
            const auto normal = encodings_of(image, row, BlockQuality::normal, has_sign);
            const auto best = encodings_of(image, row, BlockQuality::best, has_sign);
            for (std::size_t block = 0; block < 64; ++block) {
                EXPECT_LE(normal[block].error, fast[block].error) << row << ", " << block;
                EXPECT_LE(best[block].error, normal[block].error) << row << ", " << block;
            }
        }
    }
}

TEST(Bc6hEncoder, BlocksOfOneHalfFloatAreExact) {
    for (const bool has_sign : {false, true}) {
        const BlockFormat format = has_sign ? BlockFormat::bc6h_sfloat : BlockFormat::bc6h;
        std::vector<float> values;
        for (unsigned half = 0; half <= 0x7BFF; half += half < 64 ? 1 : 61) {
            const float value = detail::float_from_half(static_cast<std::uint16_t>(half));
            values.push_back(value);
            if (has_sign) values.push_back(-value);
        }
        values.push_back(65504.0F);
        Image image = make_image(static_cast<int>(4 * values.size()), 4, 1, 32, ColorSpace::data);
        for (std::size_t i = 0; i < image.sample_count(); ++i)
            image.as<float>()[i] = values[i / 4 % values.size()];
        const Image decoded =
            decode_blocks(encode_blocks(image, format, BlockQuality::fast), format, image.width, 4);
        for (std::size_t i = 0; i < decoded.sample_count(); ++i)
            ASSERT_EQ(decoded.as<float>()[i], image.as<float>()[i / 3]) << enum_name(format);
    }
}

/// The largest error relative to the value.
double largest_relative_error(const Image& image, BlockFormat format) {
    const Image decoded = decode_blocks(encode_blocks(image, format, BlockQuality::normal), format,
                                        image.width, image.height);
    double largest = 0.0;
    for (std::size_t i = 0; i < image.sample_count(); ++i) {
        const auto exact = static_cast<double>(image.as<float>()[i]);
        const double rest = static_cast<double>(decoded.as<float>()[i]) - exact;
        largest = std::max(largest, std::abs(rest / exact));
    }
    return largest;
}

TEST(Bc6hEncoder, SmoothLightHasSmallRelativeErrorsAtAnyBrightness) {
    for (const float brightness : {0.001F, 1.0F, 1000.0F}) {
        Image image = make_image(32, 32, 3, 32, ColorSpace::linear);
        for (std::size_t i = 0; i < image.sample_count(); ++i) {
            const auto x = static_cast<float>(i / 3 % 32) / 32.0F;
            const auto y = static_cast<float>(i / 96) / 32.0F;
            image.as<float>()[i] = brightness * (1.0F + x + 0.5F * y * static_cast<float>(i % 3));
        }
        // The colors of a block vary along x and y by up to a tenth each, and a line follows one.
        EXPECT_LT(largest_relative_error(image, BlockFormat::bc6h), 0.03) << brightness;
        EXPECT_LT(largest_relative_error(image, BlockFormat::bc6h_sfloat), 0.03) << brightness;
    }
}

TEST(Bc6hEncoder, ErrorsOfOneChannelAreAbsolute) {
    // A steep ramp with noise: dark texels count less than bright ones.
    Image heights = make_image(64, 64, 1, 32, ColorSpace::data);
    Image colors = make_image(64, 64, 3, 32, ColorSpace::data);
    std::uint32_t state = 7;
    for (std::size_t i = 0; i < 64 * 64; ++i) {
        state = 1664525U * state + 1013904223U;
        const float value = static_cast<float>(state >> 8U) / 16777216.0F;
        heights.as<float>()[i] = value;
        for (std::size_t c = 0; c < 3; ++c)
            colors.as<float>()[3 * i + c] = value;
    }
    const auto squared_error = [&](const Image& image) {
        const Image decoded =
            decode_blocks(encode_blocks(image, BlockFormat::bc6h, BlockQuality::normal),
                          BlockFormat::bc6h, 64, 64);
        double sum = 0.0;
        for (std::size_t i = 0; i < 64 * 64; ++i) {
            const double rest = static_cast<double>(decoded.as<float>()[3 * i]) -
                                static_cast<double>(heights.as<float>()[i]);
            sum += rest * rest;
        }
        return sum;
    };
    EXPECT_LT(squared_error(heights), 0.8 * squared_error(colors));
}

TEST(Bc6hEncoder, ValuesBeyondTheRangeAreCounted) {
    const float infinity = std::numeric_limits<float>::infinity();
    const Image image =
        image_of<float>(2, 2, 3, ColorSpace::linear,
                        {1.0F, -1.0F, 2.0F, 70000.0F, 1.0F, 1.0F, infinity, 1.0F, 1.0F, 1.0F, 1.0F,
                         std::numeric_limits<float>::quiet_NaN()});
    Report report;
    const auto blocks = encode_blocks(image, BlockFormat::bc6h, BlockQuality::best, report);
    ASSERT_EQ(report.findings().size(), 2U);
    EXPECT_EQ(report.findings()[0].count + report.findings()[1].count, 4U);
    Report with_sign;
    encode_blocks(image, BlockFormat::bc6h_sfloat, BlockQuality::best, with_sign);
    std::size_t beyond = 0;
    for (const Finding& finding : with_sign.findings())
        beyond += finding.kind == "texel beyond half's range" ? finding.count : 0;
    EXPECT_EQ(beyond, 1U);
}

TEST(Bc6hEncoder, IntegersAreFromZeroToOne) {
    const Image image =
        image_of<std::uint8_t>(4, 4, 1, ColorSpace::data, std::vector<std::uint8_t>(16, 51));
    const Image decoded = decode_blocks(encode_blocks(image, BlockFormat::bc6h, BlockQuality::fast),
                                        BlockFormat::bc6h, 4, 4);
    EXPECT_THAT(samples_of<float>(decoded), Each(testing::FloatNear(0.2F, 0.0001F)));
}

TEST(Bc6hEncoder, RefusesOtherChannels) {
    const Image two = make_image(4, 4, 2, 32, ColorSpace::data);
    EXPECT_THAT(message_of<InvalidInput>(
                    [&] { encode_blocks(two, BlockFormat::bc6h, BlockQuality::fast); }),
                HasSubstr("bc6h has 1 or 3 channels, not 2"));
}

std::uint64_t bc6h_fingerprint() {
    std::uint64_t hash = 1469598103934665603ULL;
    for (const BlockQuality quality : all_qualities) {
        for (const BlockFormat format : both_formats) {
            hash = test::hash_after(hash, encode_blocks(hdr_colors(true), format, quality));
        }
    }
    return hash;
}

TEST(Bc6hEncoder, TheBytesAreTheSameForAnyThreadsProcessorAndCompiler) {
    constexpr std::uint64_t expected = 1828898568621155053ULL;
    test::expect_everywhere(bc6h_fingerprint, expected);
}

}  // namespace
}  // namespace relief
