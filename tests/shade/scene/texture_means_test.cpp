// SPDX-License-Identifier: Apache-2.0
// Means of images, by hand.
#include "scene/scene_import.h"

#include <gtest/gtest.h>

#include <cmath>

namespace relief {
namespace {

TEST(MeanColor, OfDataIsTheMeanOfTheNumbers) {
    Image image = make_image(2, 1, 3, 8, ColorSpace::data);
    image.samples = std::vector<std::uint8_t>{0, 255, 51, 255, 255, 102};
    const glm::vec3 mean = mean_color(image);
    EXPECT_FLOAT_EQ(mean.x, 0.5F);
    EXPECT_FLOAT_EQ(mean.y, 1.0F);
    EXPECT_FLOAT_EQ(mean.z, 0.3F);
}

TEST(MeanColor, OfColoursIsTakenInLinearLight) {
    Image image = make_image(2, 1, 3, 16, ColorSpace::srgb);
    image.samples = std::vector<std::uint16_t>{0, 0, 0, 65535, 65535, 65535};
    EXPECT_FLOAT_EQ(mean_color(image).x, 0.5F);  // Black and white: half of the light.
    image.samples = std::vector<std::uint16_t>(6, 32768);
    EXPECT_NEAR(mean_color(image).x, linear_from_srgb(32768.0F / 65535), 1e-6F);
}

TEST(MeanColor, OfGreyIsGrey) {
    Image image = make_image(1, 2, 2, 8, ColorSpace::data);
    image.samples = std::vector<std::uint8_t>{51, 0, 153, 255};
    EXPECT_FLOAT_EQ(mean_color(image).x, 0.4F);
    EXPECT_FLOAT_EQ(mean_color(image).z, 0.4F);
}

TEST(MeanColor, LeavesOutWhatIsNotFinite) {
    Image image = make_image(2, 1, 3, 32, ColorSpace::linear);
    image.samples = std::vector<float>{std::nanf(""), 2, INFINITY, 0.25F, 4, -INFINITY};
    EXPECT_EQ(mean_color(image), glm::vec3(0.25F, 3, 1));
    EXPECT_EQ(mean_color(Image{}), glm::vec3(1.0F));
}

}  // namespace
}  // namespace relief
