// SPDX-License-Identifier: Apache-2.0
// Differences between images and angles between images of directions, by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "relief/mesh/report.h"
#include "relief/shade/image_compare.h"

namespace relief {
using namespace relief::shade;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Image of_floats(std::vector<float> samples) {
    Image image = make_image(static_cast<int>(samples.size()), 1, 1, 32, ColorSpace::linear);
    image.samples = std::move(samples);
    return image;
}

TEST(ImageCompare, BytesDifferInStepsOfTheirRange) {
    Image a = make_image(2, 2, 3, 8, ColorSpace::srgb);
    Image b = a;
    b.as<std::uint8_t>()[0] = 3;
    b.as<std::uint8_t>()[2] = 4;  // Changes the same pixel.
    a.as<std::uint8_t>()[11] = 255;
    const ImageDifference difference = compare(a, b);
    EXPECT_EQ(difference.max, 255.0);
    EXPECT_DOUBLE_EQ(difference.mean, (3.0 + 4.0 + 255.0) / 12.0);
    EXPECT_DOUBLE_EQ(difference.rms, std::sqrt((9.0 + 16.0 + 255.0 * 255.0) / 12.0));
    EXPECT_EQ(difference.differing_pixels, 2U);
}

TEST(ImageCompare, TheSignalToNoiseRatioIsAgainstThePeakOfTheSamples) {
    Image a = make_image(1, 1, 1, 8, ColorSpace::srgb);
    Image b = a;
    b.as<std::uint8_t>()[0] = 51;  // One fifth: 20 log10(5) decibels.
    EXPECT_NEAR(compare(a, b).psnr, 13.979400086720377, 1e-12);
    EXPECT_NEAR(compare(of_floats({0.0F}), of_floats({0.5F})).psnr, 6.020599913279624, 1e-12);
    EXPECT_EQ(compare(a, a).psnr, infinity);
    EXPECT_EQ(compare(of_floats({0.0F}), of_floats({std::nanf("")})).psnr, -infinity);
}

TEST(ImageCompare, IsSymmetricAndZeroForEqualImages) {
    Image a = make_image(1, 2, 1, 16, ColorSpace::data);
    Image b = a;
    b.as<std::uint16_t>()[1] = 65535;
    EXPECT_EQ(compare(a, b).max, 65535.0);
    EXPECT_EQ(compare(b, a).max, 65535.0);
    const ImageDifference none = compare(b, b);
    EXPECT_EQ(none.max, 0.0);
    EXPECT_EQ(none.mean, 0.0);
    EXPECT_EQ(none.rms, 0.0);
    EXPECT_EQ(none.differing_pixels, 0U);
}

TEST(ImageCompare, NoNumberAgainstANumberIsInfinitelyFar) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(compare(of_floats({nan, 1}), of_floats({nan, 1})).max, 0.0);
    EXPECT_EQ(compare(of_floats({nan, 1}), of_floats({nan, 1})).differing_pixels, 0U);
    for (const ImageDifference& difference : {compare(of_floats({nan, 1}), of_floats({0, 1})),
                                              compare(of_floats({0, 1}), of_floats({nan, 1}))}) {
        EXPECT_EQ(difference.max, infinity);
        EXPECT_EQ(difference.mean, infinity);
        EXPECT_EQ(difference.rms, infinity);
        EXPECT_EQ(difference.differing_pixels, 1U);
    }
}

TEST(ImageCompare, EqualInfinitiesDoNotDiffer) {
    const float inf = std::numeric_limits<float>::infinity();
    EXPECT_EQ(compare(of_floats({inf, -inf}), of_floats({inf, -inf})).max, 0.0);
    EXPECT_EQ(compare(of_floats({inf}), of_floats({-inf})).max, infinity);
    EXPECT_EQ(compare(of_floats({inf}), of_floats({3})).max, infinity);
}

TEST(ImageCompare, FloatsThatDifferByLessThanAnythingStillDiffer) {
    const float tiny = std::numeric_limits<float>::denorm_min();
    const ImageDifference difference = compare(of_floats({0, 0}), of_floats({0, tiny}));
    EXPECT_EQ(difference.differing_pixels, 1U);
    EXPECT_EQ(difference.max, static_cast<double>(tiny));
    EXPECT_EQ(compare(of_floats({0.0F}), of_floats({-0.0F})).differing_pixels, 0U);
}

TEST(ImageCompare, ImagesOfDifferentKindsAreRefusedWithBothKinds) {
    const Image a = make_image(2, 3, 1, 8, ColorSpace::data);
    EXPECT_THROW(compare(a, make_image(3, 2, 1, 8, ColorSpace::data)), InvalidInput);
    EXPECT_THROW(compare(a, make_image(2, 3, 2, 8, ColorSpace::data)), InvalidInput);
    try {
        (void)compare(a, make_image(2, 3, 1, 16, ColorSpace::data));
        FAIL() << "was accepted";
    } catch (const InvalidInput& error) {
        EXPECT_STREQ(error.what(),
                     "images cannot be compared: 2 x 3 pixels, 1 channels of 8 bits against 2 x 3 "
                     "pixels, 1 channels of 16 bits");
    }
}

Image of_directions(const std::vector<glm::vec3>& directions) {
    Image image = make_image(static_cast<int>(directions.size()), 1, 3, 32, ColorSpace::data);
    for (std::size_t i = 0; i < directions.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c)
            image.as<float>()[3 * i + c] = directions[i][static_cast<int>(c)];
    }
    return image;
}

glm::vec3 tilted(double degrees) {
    const double angle = glm::radians(degrees);
    return {std::sin(angle), 0, std::cos(angle)};
}

TEST(AngleDifference, IsInDegreesForAnyLengths) {
    const AngleDifference difference =
        angle_difference(of_directions({{0, 0, 1}, {0, 0, 1e-30F}, {0, 3, 0}, {1, 0, 0}}),
                         of_directions({tilted(30), {1e30F, 0, 0}, {0, 5, 0}, {-2, 0, 0}}));
    const auto map = difference.map.as<float>();
    EXPECT_NEAR(map[0], 30.0F, 1e-5F);
    EXPECT_EQ(map[1], 90.0F);
    EXPECT_EQ(map[2], 0.0F);
    EXPECT_EQ(map[3], 180.0F);
    EXPECT_NEAR(difference.angles.mean, 75.0, 1e-5);
    EXPECT_EQ(difference.angles.max, 180.0);
    EXPECT_EQ(difference.angles.undefined, 0U);
}

TEST(AngleDifference, DistinguishesTinyAnglesFromZero) {
    // The cosine of this angle is 1 in float. In double, only the last bit differs from 1.
    const AngleDifference difference =
        angle_difference(of_directions({{0, 0, 1}}), of_directions({{1e-8F, 0, 1}}));
    EXPECT_NEAR(difference.angles.max, glm::degrees(1e-8), 1e-14);
}

TEST(AngleDifference, ThePercentileLeavesOneTexelInAHundredAbove) {
    std::vector<glm::vec3> straight(200, {0, 0, 1});
    std::vector<glm::vec3> bent;
    for (int i = 0; i < 200; ++i)
        bent.push_back(tilted(0.5 * ((i * 77) % 200)));
    const AngleDifference difference =
        angle_difference(of_directions(straight), of_directions(bent));
    // Of the 200 angles 0, 0.5, ..., 99.5, 198 do not exceed 98.5.
    EXPECT_NEAR(difference.angles.p99, 98.5, 1e-4);
    EXPECT_NEAR(difference.angles.max, 99.5, 1e-4);
    EXPECT_NEAR(difference.angles.mean, 49.75, 1e-4);
}

TEST(AngleDifference, NoDirectionIsOppositeToAnyAndEqualToNone) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float inf = std::numeric_limits<float>::infinity();
    const AngleDifference difference =
        angle_difference(of_directions({{0, 0, 0}, {0, nan, 1}, {0, 0, 1}, {0, 0, 1}}),
                         of_directions({{0, 0, 1}, {inf, 0, 0}, {0, 0, 0}, {0, 0, 1}}));
    const auto map = difference.map.as<float>();
    EXPECT_EQ(map[0], 180.0F);
    EXPECT_EQ(map[1], 0.0F);
    EXPECT_EQ(map[2], 180.0F);
    EXPECT_EQ(map[3], 0.0F);
    EXPECT_EQ(difference.angles.undefined, 3U);
    EXPECT_EQ(difference.angles.mean, 90.0);
}

TEST(AngleDifference, CodesOfANormalMapAreRefusedWithTheRemedy) {
    const Image codes = make_image(2, 2, 3, 8, ColorSpace::data);
    const Image directions = make_image(2, 2, 3, 32, ColorSpace::data);
    try {
        (void)angle_difference(directions, codes);
        FAIL() << "was accepted";
    } catch (const InvalidInput& error) {
        EXPECT_STREQ(error.what(),
                     "angles are between directions in three float channels, not 3 channels of 8 "
                     "bits; decode_normal_map reads normal maps");
    }
    EXPECT_THROW(angle_difference(directions, make_image(2, 3, 3, 32, ColorSpace::data)),
                 InvalidInput);
    EXPECT_THROW(angle_difference(Image{}, Image{}), InvalidInput);
}

}  // namespace
}  // namespace relief
