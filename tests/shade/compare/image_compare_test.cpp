// SPDX-License-Identifier: Apache-2.0
// Differences of pictures, by hand.
#include "relief/shade/image_compare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "relief/mesh/error.h"

namespace relief {
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
    b.as<std::uint8_t>()[2] = 4;  // Same pixel.
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
    b.as<std::uint8_t>()[0] = 51;  // A fifth: 20 log10(5) decibels.
    EXPECT_NEAR(compare(a, b).psnr, 13.979400086720377, 1e-12);
    EXPECT_NEAR(compare(of_floats({0.0F}), of_floats({0.5F})).psnr, 6.020599913279624, 1e-12);
    EXPECT_EQ(compare(a, a).psnr, infinity);
    EXPECT_EQ(compare(of_floats({0.0F}), of_floats({std::nanf("")})).psnr, -infinity);
}

TEST(ImageCompare, IsTheSameBothWaysAndNothingForTheSame) {
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

}  // namespace
}  // namespace relief
