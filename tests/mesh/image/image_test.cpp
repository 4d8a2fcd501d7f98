// SPDX-License-Identifier: Apache-2.0
// Images in memory: the sRGB transfer function, channels, rectangles, mip levels and heat maps.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include "relief/mesh/execution.h"
#include "relief/mesh/image.h"
#include "relief/mesh/report.h"
#include "support/images.h"
#include "support/invariants.h"

namespace relief {
namespace {

using test::image_of;
using test::message_of;
using test::samples_of;
using testing::ElementsAre;
using testing::FloatEq;

/// A gray row with every code of a bit depth.
template <typename Code>
Image all_codes(ColorSpace color_space) {
    constexpr int count = std::numeric_limits<Code>::max() + 1;
    Image image = make_image(count, 1, 1, sizeof(Code) * 8, color_space);
    std::iota(image.as<Code>().begin(), image.as<Code>().end(), Code{0});
    return image;
}

TEST(Image, NewImageIsZeroAndHasItsSize) {
    const Image image = make_image(3, 2, 4, 16, ColorSpace::srgb);
    EXPECT_EQ(image.bits(), 16);
    EXPECT_EQ(image.sample_count(), 24U);
    EXPECT_EQ(image.samples, (Image::Samples(std::vector<std::uint16_t>(24, 0))));
}

TEST(Image, SizesChannelsAndDepthsThatDoNotExistAreRefused) {
    EXPECT_THROW(make_image(0, 1, 1, 8, ColorSpace::data), InvalidInput);
    EXPECT_THROW(make_image(1, -1, 1, 8, ColorSpace::data), InvalidInput);
    EXPECT_THROW(make_image(1, 1, 0, 8, ColorSpace::data), InvalidInput);
    EXPECT_THROW(make_image(1, 1, 5, 8, ColorSpace::data), InvalidInput);
    EXPECT_THROW(make_image(1, 1, 1, 24, ColorSpace::data), InvalidInput);
}

TEST(Image, ToFloatDividesByTheLargestCodeOnly) {
    const Image bytes = image_of<std::uint8_t>(3, {0, 51, 255}, ColorSpace::srgb);
    EXPECT_THAT(samples_of<float>(to_float(bytes)), ElementsAre(0.0F, 51.0F / 255.0F, 1.0F));
    EXPECT_EQ(to_float(bytes).color_space, ColorSpace::srgb);
    const Image words = image_of<std::uint16_t>(3, {0, 13107, 65535});
    EXPECT_THAT(samples_of<float>(to_float(words)), ElementsAre(0.0F, 0.2F, 1.0F));
}

TEST(Image, SrgbHasTheValuesOfTheStandard) {
    // IEC 61966-2-1: code 0.5 is 0.21404 of light, and the linear piece has slope 12.92.
    EXPECT_NEAR(linear_from_srgb(0.5F), 0.214041144, 1e-8);
    EXPECT_NEAR(srgb_from_linear(0.18F), 0.461356, 1e-6);
    EXPECT_FLOAT_EQ(linear_from_srgb(0.04F), 0.04F / 12.92F);
    EXPECT_EQ(srgb_from_linear(0.0F), 0.0F);
    EXPECT_NEAR(srgb_from_linear(1.0F), 1.0, 1e-7);
}

TEST(Image, SrgbIsOddAndExtendsAboveOne) {
    EXPECT_EQ(linear_from_srgb(-0.5F), -linear_from_srgb(0.5F));
    EXPECT_EQ(srgb_from_linear(-0.001F), -srgb_from_linear(0.001F));
    EXPECT_NEAR(srgb_from_linear(4.0F), 1.055 * std::pow(4.0, 1.0 / 2.4) - 0.055, 1e-6);
}

TEST(Image, Every8BitCodeSurvivesDecodingAndEncoding) {
    const Image codes = all_codes<std::uint8_t>(ColorSpace::srgb);
    const Image linear = to_linear(codes);
    EXPECT_EQ(linear.color_space, ColorSpace::linear);
    EXPECT_EQ(to_srgb(linear, 8).samples, codes.samples);
}

TEST(Image, Every16BitCodeSurvivesDecodingAndEncoding) {
    const Image codes = all_codes<std::uint16_t>(ColorSpace::srgb);
    EXPECT_EQ(to_srgb(to_linear(codes), 16).samples, codes.samples);
}

TEST(Image, Every8BitCodeSurvivesAsFloatInBetween) {
    const Image codes = all_codes<std::uint8_t>(ColorSpace::srgb);
    EXPECT_EQ(to_srgb(to_linear(to_float(codes)), 8).samples, codes.samples);
}

TEST(Image, AlphaIsNeverDecodedNorEncoded) {
    const Image coded = image_of<std::uint8_t>(4, {128, 128, 128, 128}, ColorSpace::srgb);
    const Image linear = to_linear(coded);
    EXPECT_NEAR(linear.as<float>()[0], 0.215861, 1e-6);
    EXPECT_EQ(linear.as<float>()[3], 128.0F / 255.0F);
    EXPECT_EQ(to_srgb(linear, 8).samples, coded.samples);
    const Image gray = image_of<std::uint8_t>(2, {128, 128, 0, 7}, ColorSpace::srgb);
    EXPECT_EQ(samples_of<float>(to_linear(gray))[1], 128.0F / 255.0F);
    EXPECT_EQ(samples_of<float>(to_linear(gray))[3], 7.0F / 255.0F);
}

TEST(Image, DataAndLinearImagesAreNeverDecoded) {
    for (const ColorSpace space : {ColorSpace::data, ColorSpace::linear}) {
        const Image image = image_of<std::uint8_t>(1, {128}, space);
        EXPECT_EQ(samples_of<float>(to_linear(image))[0], 128.0F / 255.0F);
        EXPECT_EQ(to_linear(image).color_space, space);
    }
}

TEST(Image, EncodingClampsAsADisplayDoesAndNanIsBlack) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const Image wild = image_of<float>(
        1, {-1.0F, 2.0F, std::numeric_limits<float>::quiet_NaN(), infinity, -infinity},
        ColorSpace::linear);
    EXPECT_THAT(samples_of<std::uint8_t>(to_srgb(wild, 8)), ElementsAre(0, 255, 0, 255, 0));
}

TEST(Image, OnlyLinearFloatIsEncodedAndOnlyTo8Or16Bits) {
    EXPECT_THROW(to_srgb(make_image(1, 1, 1, 32, ColorSpace::data), 8), InvalidInput);
    EXPECT_THROW(to_srgb(make_image(1, 1, 1, 8, ColorSpace::linear), 8), InvalidInput);
    EXPECT_THROW(to_srgb(make_image(1, 1, 1, 32, ColorSpace::linear), 32), InvalidInput);
}

TEST(ImageChannels, ComeOutAsFloat) {
    const Image bytes = image_of(4, std::vector<std::uint8_t>{1, 2, 3, 51, 5, 6, 7, 255});
    EXPECT_THAT(samples_of<float>(channel_of(bytes, 3)), ElementsAre(0.2F, 1.0F));
    const Image words = image_of(2, std::vector<std::uint16_t>{13107, 9, 0, 9});
    EXPECT_THAT(samples_of<float>(channel_of(words, 0)), ElementsAre(0.2F, 0.0F));
    const Image floats = image_of(3, std::vector<float>{1, 2, 3, 4, 5, 6});
    EXPECT_THAT(samples_of<float>(channel_of(floats, 1)), ElementsAre(2.0F, 5.0F));
    EXPECT_EQ(message_of<InvalidInput>([&] { channel_of(floats, 3); }),
              "there is no channel 4, but only 3");
}

TEST(ImageChannels, AlphaComesBackAsItWas) {
    for (const int bits : {8, 16, 32}) {
        const Image image = make_image(2, 1, 3, bits, ColorSpace::data);
        const Image alpha = image_of(1, std::vector<float>{0.2F, 1.0F});
        Image both = with_alpha(image, alpha);
        EXPECT_EQ(both.channels, 4);
        EXPECT_THAT(samples_of<float>(channel_of(both, 3)), ElementsAre(FloatEq(0.2F), 1.0F));
        drop_alpha(both);
        EXPECT_EQ(both.samples, image.samples);
        EXPECT_EQ(both.channels, 3);
    }
}

TEST(ImageChannels, CodesOfAlphaAreTheNearest) {
    const Image image = image_of(3, std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6});
    const auto alphas = [&](float a, float b) {
        return samples_of<std::uint8_t>(with_alpha(image, image_of(1, std::vector<float>{a, b})));
    };
    EXPECT_THAT(alphas(0.5F, -3.0F), ElementsAre(1, 2, 3, 128, 4, 5, 6, 0));
    EXPECT_THAT(alphas(NAN, INFINITY), ElementsAre(1, 2, 3, 0, 4, 5, 6, 255));
}

TEST(ImageChannels, RefuseOtherImages) {
    const Image alpha = image_of(1, std::vector<float>{0.2F, 1.0F});
    Image wide = make_image(3, 1, 3, 8, ColorSpace::data);
    EXPECT_EQ(message_of<InvalidInput>([&] { with_alpha(wide, alpha); }),
              "an alpha of 2 x 1 does not go with an image of 3 x 1");
    EXPECT_EQ(message_of<InvalidInput>([&] { with_alpha(alpha, alpha); }),
              "alpha goes with 3 channels, not 1");
    EXPECT_EQ(message_of<InvalidInput>([&] { drop_alpha(wide); }),
              "no alpha to drop from 3 channels");
}

/// 3 x 2 texels of two channels: 0 1
/// 2 3
/// 4 5, then 6 7
/// 8 9
/// 10 11.
Image numbered() {
    Image image = make_image(3, 2, 2, 8, ColorSpace::srgb);
    for (std::size_t i = 0; i < 12; ++i)
        image.as<std::uint8_t>()[i] = static_cast<std::uint8_t>(i);
    return image;
}

TEST(ImagePart, HoldsTheTexelsOfTheRectangle) {
    const Image part = part_of(numbered(), {1, 0, 2, 2});
    EXPECT_THAT(samples_of<std::uint8_t>(part), ElementsAre(2, 3, 4, 5, 8, 9, 10, 11));
    EXPECT_EQ(part.color_space, ColorSpace::srgb);
    EXPECT_THAT(samples_of<std::uint8_t>(part_of(numbered(), {2, 1, 1, 1})), ElementsAre(10, 11));
    EXPECT_EQ(part_of(numbered(), {0, 0, 3, 2}).samples, numbered().samples);
}

TEST(ImagePart, BeyondTheImageThereIsNone) {
    for (const ImagePart& part : {ImagePart{-1, 0, 2, 1}, ImagePart{0, 1, 1, 2},
                                  ImagePart{2, 0, 2, 1}, ImagePart{0, 0, 0, 1}, ImagePart{}})
        EXPECT_THROW(part_of(numbered(), part), InvalidInput);
}

TEST(MipLevels, HalveDownToOneTexel) {
    std::vector<std::pair<int, int>> sizes;
    for (const Image& level : mip_levels(make_image(20, 3, 2, 8, ColorSpace::data)))
        sizes.emplace_back(level.width, level.height);
    EXPECT_THAT(sizes,
                ElementsAre(std::pair(10, 1), std::pair(5, 1), std::pair(2, 1), std::pair(1, 1)));
    EXPECT_TRUE(mip_levels(make_image(1, 1, 3, 8, ColorSpace::data)).empty());
    EXPECT_THROW(mip_levels(Image{}), InvalidInput);
}

TEST(MipLevels, EvenSizesAverageFourTexelsChannelByChannel) {
    const auto levels = mip_levels(image_of<std::uint8_t>(
        4, 2, 2, ColorSpace::data, {0, 10, 4, 20, 100, 1, 200, 2, 8, 30, 12, 41, 50, 3, 51, 3}));
    EXPECT_THAT(levels[0].as<std::uint8_t>(), ElementsAre(6, 25, 100, 2));  // 25.25, 100.25, 2.25.
    // The mean of 25.25 and 2.25 is 13.75; of 25 and 2 it would be 13.5. The other value is 53.125.
    EXPECT_THAT(levels[1].as<std::uint8_t>(), ElementsAre(53, 14));
}

TEST(MipLevels, OddSizesWeightTexelsByCoverage) {
    // Each of 2 texels covers two and a half of 5: (a + b + c/2) / 2.5.
    const auto row = mip_levels(image_of<float>(1, {1, 2, 4, 8, 16}));
    EXPECT_FLOAT_EQ(row[0].as<float>()[0], (1 + 2 + 2) / 2.5F);
    EXPECT_FLOAT_EQ(row[0].as<float>()[1], (2 + 8 + 16) / 2.5F);
    const auto column =
        mip_levels(image_of<std::uint16_t>(1, 3, 1, ColorSpace::data, {600, 30000, 65535}));
    EXPECT_THAT(column[0].as<std::uint16_t>(), ElementsAre(32045));
}

TEST(MipLevels, KeepTheMeanOfAnySize) {
    std::mt19937 random(3);
    for (const auto& [width, height] : {std::pair(17, 9), {33, 1}, {12, 30}, {7, 7}}) {
        Image image = make_image(width, height, 1, 32, ColorSpace::data);
        double sum = 0.0;
        for (float& sample : image.as<float>()) {
            sample = static_cast<float>(random() % 1000);
            sum += static_cast<double>(sample);
        }
        const auto levels = mip_levels(image);
        const double mean = sum / static_cast<double>(image.sample_count());
        // The rounding of floats near 500 over five levels.
        EXPECT_NEAR(static_cast<double>(levels.back().as<float>()[0]), mean, 1e-3)
            << width << " x " << height;
    }
}

TEST(MipLevels, AverageColorsInLinearLightAndAlphaAsStored) {
    for (const int channels : {3, 4}) {
        Image image = make_image(2, 1, channels, 8, ColorSpace::srgb);
        for (int c = 0; c < channels; ++c)
            image.as<std::uint8_t>()[static_cast<std::size_t>(c)] = 255;
        const auto level = mip_levels(image)[0];
        EXPECT_EQ(level.as<std::uint8_t>()[0], 188);  // Half of the light has code 187.5.
        if (channels == 4) {
            EXPECT_EQ(level.as<std::uint8_t>()[3], 128);
        }
    }
    Image deep = make_image(2, 1, 3, 16, ColorSpace::srgb);
    deep.samples = std::vector<std::uint16_t>{0, 1, 65535, 0, 1, 0};
    const auto level = mip_levels(deep)[0];
    EXPECT_EQ(level.as<std::uint16_t>()[1], 1);
    EXPECT_NEAR(level.as<std::uint16_t>()[2], 65535 * srgb_from_linear(0.5F), 1.0);
}

TEST(MipLevels, KeepPlainColors) {
    for (const ColorSpace space : {ColorSpace::data, ColorSpace::srgb}) {
        for (int code = 0; code < 256; ++code) {
            const std::vector<std::uint8_t> samples(6 * 4 * 4, static_cast<std::uint8_t>(code));
            for (const Image& level : mip_levels(image_of(6, 4, 4, space, samples))) {
                for (const std::uint8_t sample : level.as<std::uint8_t>())
                    ASSERT_EQ(sample, code);
            }
        }
    }
}

TEST(MipLevels, AreTheSameForAnyNumberOfThreads) {
    Image image = make_image(700, 501, 3, 8, ColorSpace::srgb);
    std::mt19937 random(11);
    for (std::uint8_t& sample : image.as<std::uint8_t>())
        sample = static_cast<std::uint8_t>(random());
    const auto on_all = mip_levels(image);
    set_thread_limit(1);
    const auto on_one = mip_levels(image);
    set_thread_limit(0);
    for (std::size_t i = 0; i < on_all.size(); ++i)
        EXPECT_EQ(on_all[i].samples, on_one[i].samples) << i;
}

using Pixel = std::array<int, 3>;

Pixel shown(float value, double brightest) {
    Image values = make_image(1, 1, 1, 32, ColorSpace::data);
    values.as<float>()[0] = value;
    const Image picture = false_color_image(values, brightest);
    const auto codes = picture.as<std::uint8_t>();
    return {codes[0], codes[1], codes[2]};
}

double luminance(const Pixel& pixel) {
    const auto light = [](int code) {
        return static_cast<double>(linear_from_srgb(static_cast<float>(code) / 255.0F));
    };
    return 0.2126 * light(pixel[0]) + 0.7152 * light(pixel[1]) + 0.0722 * light(pixel[2]);
}

TEST(HeatPicture, GetsBrighterAllTheWay) {
    double before = -1.0;
    for (int i = 0; i <= 100; ++i) {
        const double now = luminance(shown(static_cast<float>(i) * 0.01F * 7.0F, 7.0));
        EXPECT_GT(now, before) << i;
        before = now;
    }
}

TEST(HeatPicture, EndsAtItsEnds) {
    EXPECT_EQ(shown(0, 2), (Pixel{0, 0, 4}));
    EXPECT_EQ(shown(-3, 2), (Pixel{0, 0, 4}));
    EXPECT_EQ(shown(1, 2), (Pixel{183, 55, 121}));
    EXPECT_EQ(shown(2, 2), (Pixel{252, 253, 191}));
    EXPECT_EQ(shown(INFINITY, 2), (Pixel{252, 253, 191}));
    EXPECT_EQ(shown(NAN, 2), (Pixel{0, 255, 0}));
}

TEST(HeatPicture, NeedsOneFloatChannelAndAPositiveMaximum) {
    EXPECT_THROW(false_color_image(make_image(2, 2, 3, 32, ColorSpace::data), 1), InvalidInput);
    EXPECT_THROW(false_color_image(make_image(2, 2, 1, 8, ColorSpace::data), 1), InvalidInput);
    EXPECT_THROW(false_color_image(Image{}, 1), InvalidInput);
    EXPECT_THROW(false_color_image(make_image(2, 2, 1, 32, ColorSpace::data), 0), InvalidInput);
    EXPECT_THROW(false_color_image(make_image(2, 2, 1, 32, ColorSpace::data), std::nan("")),
                 InvalidInput);
}

}  // namespace
}  // namespace relief
