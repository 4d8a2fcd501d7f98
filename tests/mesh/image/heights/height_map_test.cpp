// SPDX-License-Identifier: Apache-2.0
// Heights out of images: every channel by hand, alpha and what it hides.
#include "relief/mesh/height_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "image/height_holes.h"
#include "relief/mesh/error.h"
#include "support/message_of.h"
#include "support/samples.h"

namespace relief {
namespace {

using test::message_of;
using test::samples_of;
using testing::Each;
using testing::ElementsAre;
using testing::FloatNear;

Image rgba16(std::vector<std::uint16_t> samples) {
    Image image = make_image(static_cast<int>(samples.size() / 4), 1, 4, 16, ColorSpace::data);
    image.samples = std::move(samples);
    return image;
}

TEST(HeightField, GreyIsItselfRgbItsMeanAndAlphaIsLeftOut) {
    Image gray = make_image(2, 1, 2, 8, ColorSpace::data);
    gray.samples = std::vector<std::uint8_t>{51, 7, 255, 0};
    EXPECT_THAT(samples_of<float>(height_field(gray)), ElementsAre(0.2F, 1.0F));
    Image rgb = make_image(1, 1, 4, 16, ColorSpace::data);
    rgb.samples = std::vector<std::uint16_t>{65535, 0, 13107, 9};
    EXPECT_THAT(samples_of<float>(height_field(rgb)), ElementsAre(0.4F));
    Image floats = make_image(1, 1, 3, 32, ColorSpace::data);
    floats.samples = std::vector<float>{-3.0F, 0.0F, 9.0F};
    EXPECT_THAT(samples_of<float>(height_field(floats)), ElementsAre(2.0F));
}

TEST(HeightField, AGreyPictureStoredAsRgbGivesTheHeightsOfTheGreyOne) {
    Image gray = make_image(256, 1, 1, 8, ColorSpace::data);
    Image rgb = make_image(256, 1, 3, 8, ColorSpace::srgb);
    for (std::size_t code = 0; code < 256; ++code) {
        gray.as<std::uint8_t>()[code] = static_cast<std::uint8_t>(code);
        for (std::size_t channel = 0; channel < 3; ++channel)
            rgb.as<std::uint8_t>()[code * 3 + channel] = static_cast<std::uint8_t>(code);
    }
    EXPECT_EQ(height_field(rgb).samples, height_field(gray).samples);
}

TEST(HeightField, AnEmptyImageIsRefused) {
    EXPECT_THROW(height_field(Image{}), InvalidInput);
}

TEST(HeightField, TakesTheChannelThatIsAskedFor) {
    const Image image = rgba16({65535, 0, 13107, 26214});
    EXPECT_THAT(samples_of<float>(height_field(image, HeightChannel::red)), ElementsAre(1.0F));
    EXPECT_THAT(samples_of<float>(height_field(image, HeightChannel::green)), ElementsAre(0.0F));
    EXPECT_THAT(samples_of<float>(height_field(image, HeightChannel::blue)), ElementsAre(0.2F));
    EXPECT_THAT(samples_of<float>(height_field(image, HeightChannel::alpha)), ElementsAre(0.4F));
}

TEST(HeightField, LuminanceIsOfDecodedColours) {
    Image image = make_image(4, 1, 3, 8, ColorSpace::data);
    // Pure colours give Rec. 709's weights; grey of code 188 is half as bright as white.
    image.samples = std::vector<std::uint8_t>{255, 0, 0, 0, 255, 0, 0, 0, 255, 188, 188, 188};
    EXPECT_THAT(samples_of<float>(height_field(image, HeightChannel::luminance)),
                ElementsAre(0.2126F, 0.7152F, 0.0722F, FloatNear(0.5029F, 1e-4F)));
    Image floats = make_image(1, 1, 3, 32, ColorSpace::data);
    floats.samples = std::vector<float>{2.0F, 2.0F, 2.0F};
    EXPECT_THAT(samples_of<float>(height_field(floats, HeightChannel::luminance)),
                ElementsAre(2.0F))
        << "float samples are linear already";
}

TEST(HeightField, GreyHasOneHeightWhateverIsAskedButNoColours) {
    Image gray = make_image(1, 1, 2, 8, ColorSpace::data);
    gray.samples = std::vector<std::uint8_t>{51, 102};
    for (const HeightChannel channel :
         {HeightChannel::mean, HeightChannel::luminance, HeightChannel::red})
        EXPECT_THAT(samples_of<float>(height_field(gray, channel)), ElementsAre(0.2F));
    EXPECT_THAT(samples_of<float>(height_field(gray, HeightChannel::alpha)), ElementsAre(0.4F));
    EXPECT_EQ(message_of<InvalidInput>([&] { height_field(gray, HeightChannel::blue); }),
              "a grey image has no blue channel to take heights from");
    const Image rgb = make_image(1, 1, 3, 8, ColorSpace::data);
    EXPECT_EQ(message_of<InvalidInput>([&] { height_field(rgb, HeightChannel::alpha); }),
              "the image has no alpha channel to take heights from");
}

TEST(HeightMap, KeepsTheSamplesOfAGreyImage) {
    Image gray = make_image(2, 1, 1, 16, ColorSpace::data);
    gray.samples = std::vector<std::uint16_t>{1, 65535};
    const HeightMap map = height_map(std::move(gray));
    EXPECT_THAT(samples_of<std::uint16_t>(map.heights), ElementsAre(1, 65535));
    EXPECT_TRUE(map.alpha.empty());
    EXPECT_TRUE(map.transparent.empty());
}

TEST(HeightMap, SaysWhichTexelsAreTransparent) {
    const HeightMap map = height_map(rgba16({0, 0, 0, 0, 9, 9, 9, 1, 9, 9, 9, 65535}));
    EXPECT_THAT(samples_of<std::uint16_t>(map.alpha), ElementsAre(0, 1, 65535));
    EXPECT_THAT(map.transparent, ElementsAre(1, 0, 0));
    EXPECT_EQ(map.transparent_count(), 1U);
    EXPECT_TRUE(height_map(rgba16({0, 0, 0, 1})).transparent.empty());
    EXPECT_TRUE(height_map(rgba16({0, 0, 0, 0}), HeightChannel::alpha).transparent.empty())
        << "alpha that is the height hides nothing";
}

TEST(FilledHoles, OneFiniteHeightInACornerFillsTheWholeMap) {
    for (const std::size_t corner : {0, 2, 3, 5}) {
        Image heights = make_image(3, 2, 1, 32, ColorSpace::data);
        for (float& height : heights.as<float>())
            height = std::numeric_limits<float>::quiet_NaN();
        heights.as<float>()[corner] = 0.5F;
        for (const Wrap wrap : {Wrap::repeat, Wrap::mirror, Wrap::clamp}) {
            Report report;
            EXPECT_THAT(filled_holes(heights, wrap, report), Each(0.5F)) << corner;
            EXPECT_EQ(report.count("non-finite height"), 5U);
        }
    }
}

TEST(FilledHoles, TransparentTexelsTakeTheHeightsBesideThemAsFarAsAKernelReaches) {
    // A plateau of 5 in a sea of garbage that is transparent.
    Image heights = make_image(9, 9, 1, 32, ColorSpace::data);
    std::vector<std::uint8_t> transparent(81, 1);
    const auto at = [](int x, int y) { return static_cast<std::size_t>(9 * y + x); };
    for (std::size_t i = 0; i < 81; ++i)
        heights.as<float>()[i] = std::numeric_limits<float>::infinity();
    for (int y = 3; y < 6; ++y) {
        for (int x = 3; x < 6; ++x) {
            heights.as<float>()[at(x, y)] = 5.0F;
            transparent[at(x, y)] = 0;
        }
    }
    Report report;
    const std::vector<float> filled = filled_holes(heights, Wrap::clamp, report, {transparent, 2});
    EXPECT_TRUE(report.empty()) << "transparent texels are no fault";
    EXPECT_EQ(filled[at(1, 1)], 5.0F);
    EXPECT_EQ(filled[at(4, 7)], 5.0F);
    EXPECT_EQ(filled[at(0, 4)], 0.0F) << "no kernel of this radius finds it";
    // A hole on the surface is filled all the same, and counted.
    heights.as<float>()[at(4, 4)] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(filled_holes(heights, Wrap::clamp, report, {transparent, 2})[at(4, 4)], 5.0F);
    EXPECT_EQ(report.count("non-finite height"), 1U);
}

}  // namespace
}  // namespace relief
