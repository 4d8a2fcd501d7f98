// SPDX-License-Identifier: Apache-2.0
// Images in memory and the sRGB transfer function, against the standard's numbers.
#include "relief/mesh/image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "relief/mesh/error.h"
#include "support/samples.h"

namespace relief {
namespace {

using test::samples_of;
using testing::ElementsAre;

/// Every code of a depth, in one grey row.
template <typename Code>
Image all_codes(ColorSpace color_space) {
    constexpr int count = std::numeric_limits<Code>::max() + 1;
    Image image = make_image(count, 1, 1, sizeof(Code) * 8, color_space);
    std::iota(image.as<Code>().begin(), image.as<Code>().end(), Code{0});
    return image;
}

template <typename Sample>
Image image_of(int width, int channels, ColorSpace color_space, std::vector<Sample> samples) {
    Image image = make_image(width, 1, channels, sizeof(Sample) * 8, color_space);
    image.samples = std::move(samples);
    return image;
}

TEST(Image, ANewImageIsZeroAndAsLargeAsItSays) {
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

TEST(Image, ToFloatDividesByTheLargestCodeAndConvertsNoColour) {
    const Image bytes = image_of<std::uint8_t>(1, 3, ColorSpace::srgb, {0, 51, 255});
    EXPECT_THAT(samples_of<float>(to_float(bytes)), ElementsAre(0.0F, 51.0F / 255.0F, 1.0F));
    EXPECT_EQ(to_float(bytes).color_space, ColorSpace::srgb);
    const Image words = image_of<std::uint16_t>(1, 3, ColorSpace::data, {0, 13107, 65535});
    EXPECT_THAT(samples_of<float>(to_float(words)), ElementsAre(0.0F, 0.2F, 1.0F));
}

TEST(Image, SrgbHasTheValuesOfTheStandard) {
    // IEC 61966-2-1: half coded is 0.21404 of light; the linear piece has slope 12.92.
    EXPECT_NEAR(linear_from_srgb(0.5F), 0.214041144, 1e-8);
    EXPECT_NEAR(srgb_from_linear(0.18F), 0.461356, 1e-6);
    EXPECT_FLOAT_EQ(linear_from_srgb(0.04F), 0.04F / 12.92F);
    EXPECT_EQ(srgb_from_linear(0.0F), 0.0F);
    EXPECT_NEAR(srgb_from_linear(1.0F), 1.0, 1e-7);
}

TEST(Image, SrgbIsOddBelowZeroAndGoesOnAboveOne) {
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
    const Image coded = image_of<std::uint8_t>(1, 4, ColorSpace::srgb, {128, 128, 128, 128});
    const Image linear = to_linear(coded);
    EXPECT_NEAR(linear.as<float>()[0], 0.215861, 1e-6);
    EXPECT_EQ(linear.as<float>()[3], 128.0F / 255.0F);
    EXPECT_EQ(to_srgb(linear, 8).samples, coded.samples);
    const Image gray = image_of<std::uint8_t>(2, 2, ColorSpace::srgb, {128, 128, 0, 7});
    EXPECT_EQ(samples_of<float>(to_linear(gray))[1], 128.0F / 255.0F);
    EXPECT_EQ(samples_of<float>(to_linear(gray))[3], 7.0F / 255.0F);
}

TEST(Image, DataAndLinearImagesAreNeverDecoded) {
    for (const ColorSpace space : {ColorSpace::data, ColorSpace::linear}) {
        const Image image = image_of<std::uint8_t>(1, 1, space, {128});
        EXPECT_EQ(samples_of<float>(to_linear(image))[0], 128.0F / 255.0F);
        EXPECT_EQ(to_linear(image).color_space, space);
    }
}

TEST(Image, EncodingClampsAsADisplayDoesAndNanIsBlack) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const Image wild = image_of<float>(
        5, 1, ColorSpace::linear,
        {-1.0F, 2.0F, std::numeric_limits<float>::quiet_NaN(), infinity, -infinity});
    EXPECT_THAT(samples_of<std::uint8_t>(to_srgb(wild, 8)), ElementsAre(0, 255, 0, 255, 0));
}

TEST(Image, OnlyLinearFloatIsEncodedAndOnlyTo8Or16Bits) {
    EXPECT_THROW(to_srgb(make_image(1, 1, 1, 32, ColorSpace::data), 8), InvalidInput);
    EXPECT_THROW(to_srgb(make_image(1, 1, 1, 8, ColorSpace::linear), 8), InvalidInput);
    EXPECT_THROW(to_srgb(make_image(1, 1, 1, 32, ColorSpace::linear), 32), InvalidInput);
}

}  // namespace
}  // namespace relief
