// SPDX-License-Identifier: Apache-2.0
// Errors of pictures, where they are known.
#include "drawn/picture_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "relief/mesh/error.h"

namespace relief {
namespace {

/// Codes of one grey.
Image grey(int code, int size = 32) {
    Image image = make_image(size, size, 3, 8, ColorSpace::srgb);
    for (std::uint8_t& sample : image.as<std::uint8_t>())
        sample = static_cast<std::uint8_t>(code);
    return image;
}

TEST(PictureError, OfTheSamePictureIsNone) {
    const Image picture = grey(100);
    const PictureError error = picture_error(to_linear(picture), picture);
    EXPECT_EQ(error.figures.count, 32U * 32U);
    EXPECT_EQ(error.figures.max, 0.0);
    EXPECT_EQ(error.figures.psnr.value(), std::numeric_limits<double>::infinity());
}

TEST(PictureError, IsInDecibelsOfCodes) {
    // Ten codes of 255 everywhere.
    const PictureError error = picture_error(to_linear(grey(100)), grey(110));
    EXPECT_NEAR(error.figures.psnr.value(), 20.0 * std::log10(255.0 / 10.0), 0.01);
    // All pixels alike: every figure is the same.
    EXPECT_NEAR(error.figures.rms, error.figures.max, 1e-3);
    EXPECT_NEAR(error.figures.mean, error.figures.p99, 1e-3);
    EXPECT_GT(error.figures.mean, 0.02);
}

TEST(PictureError, OfBlackForWhiteIsNearlyAllThereIs) {
    const PictureError error = picture_error(to_linear(grey(255)), grey(0));
    EXPECT_GT(error.figures.mean, 0.95);
    EXPECT_LE(error.figures.max, 1.0);
    EXPECT_NEAR(error.figures.psnr.value(), 0.0, 1e-4);
}

TEST(PictureError, IsOfWhatAScreenShows) {
    // Less than half a code everywhere: the same codes.
    Image truth = to_linear(grey(100));
    for (float& sample : truth.as<float>())
        sample = linear_from_srgb(100.4F / 255.0F);
    EXPECT_EQ(picture_error(truth, grey(100)).figures.max, 0.0);
    // One sample in three is one code off.
    Image picture = grey(100);
    for (std::size_t i = 0; i < picture.sample_count(); i += 3)
        picture.as<std::uint8_t>()[i] = 101;
    const ErrorFigures figures = picture_error(truth, picture).figures;
    EXPECT_NEAR(figures.psnr.value(), 20.0 * std::log10(255.0 * std::sqrt(3.0)), 1e-6);
    EXPECT_GT(figures.mean, 0.0);
}

TEST(Averaged, IsTheMeanOfEachSquare) {
    Image image = make_image(4, 2, 1, 32, ColorSpace::linear);
    for (std::size_t i = 0; i < 8; ++i)
        image.as<float>()[i] = static_cast<float>(i * i);
    const Image mean = averaged(image, 2);
    ASSERT_EQ(mean.width, 2);
    ASSERT_EQ(mean.height, 1);
    EXPECT_EQ(mean.as<float>()[0], (0.0F + 1.0F + 16.0F + 25.0F) / 4.0F);
    EXPECT_EQ(mean.as<float>()[1], (4.0F + 9.0F + 36.0F + 49.0F) / 4.0F);
    EXPECT_THROW(averaged(image, 3), InvalidInput);
}

TEST(WithoutAlpha, KeepsTheColours) {
    Image image = make_image(2, 1, 4, 8, ColorSpace::srgb);
    for (std::size_t i = 0; i < 8; ++i)
        image.as<std::uint8_t>()[i] = static_cast<std::uint8_t>(i);
    const Image colors = without_alpha(image);
    EXPECT_EQ(colors.channels, 3);
    EXPECT_EQ(std::get<std::vector<std::uint8_t>>(colors.samples),
              (std::vector<std::uint8_t>{0, 1, 2, 4, 5, 6}));
}

}  // namespace
}  // namespace relief
