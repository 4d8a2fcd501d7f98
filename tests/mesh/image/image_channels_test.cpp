// SPDX-License-Identifier: Apache-2.0
#include "relief/mesh/image_channels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "relief/mesh/error.h"
#include "support/message_of.h"
#include "support/samples.h"

namespace relief {
namespace {

using test::message_of;
using test::samples_of;
using testing::ElementsAre;
using testing::FloatEq;

Image image_of(int channels, int bits, Image::Samples samples) {
    Image image = make_image(2, 1, channels, bits, ColorSpace::data);
    image.samples = std::move(samples);
    return image;
}

TEST(ImageChannels, ComeOutAsFloat) {
    const Image bytes = image_of(4, 8, std::vector<std::uint8_t>{1, 2, 3, 51, 5, 6, 7, 255});
    EXPECT_THAT(samples_of<float>(channel_of(bytes, 3)), ElementsAre(0.2F, 1.0F));
    const Image words = image_of(2, 16, std::vector<std::uint16_t>{13107, 9, 0, 9});
    EXPECT_THAT(samples_of<float>(channel_of(words, 0)), ElementsAre(0.2F, 0.0F));
    const Image floats = image_of(3, 32, std::vector<float>{1, 2, 3, 4, 5, 6});
    EXPECT_THAT(samples_of<float>(channel_of(floats, 1)), ElementsAre(2.0F, 5.0F));
    EXPECT_EQ(message_of<InvalidInput>([&] { channel_of(floats, 3); }),
              "there is no channel 4, but only 3");
}

TEST(ImageChannels, AlphaComesBackAsItWas) {
    for (const int bits : {8, 16, 32}) {
        const Image image = make_image(2, 1, 3, bits, ColorSpace::data);
        const Image alpha = image_of(1, 32, std::vector<float>{0.2F, 1.0F});
        Image both = with_alpha(image, alpha);
        EXPECT_EQ(both.channels, 4);
        EXPECT_THAT(samples_of<float>(channel_of(both, 3)), ElementsAre(FloatEq(0.2F), 1.0F));
        drop_alpha(both);
        EXPECT_EQ(both.samples, image.samples);
        EXPECT_EQ(both.channels, 3);
    }
}

TEST(ImageChannels, CodesOfAlphaAreTheNearest) {
    const Image image = image_of(3, 8, std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6});
    const auto alphas = [&](float a, float b) {
        return samples_of<std::uint8_t>(
            with_alpha(image, image_of(1, 32, std::vector<float>{a, b})));
    };
    EXPECT_THAT(alphas(0.5F, -3.0F), ElementsAre(1, 2, 3, 128, 4, 5, 6, 0));
    EXPECT_THAT(alphas(NAN, INFINITY), ElementsAre(1, 2, 3, 0, 4, 5, 6, 255));
}

TEST(ImageChannels, RefuseOtherImages) {
    const Image alpha = image_of(1, 32, std::vector<float>{0.2F, 1.0F});
    Image wide = make_image(3, 1, 3, 8, ColorSpace::data);
    EXPECT_EQ(message_of<InvalidInput>([&] { with_alpha(wide, alpha); }),
              "an alpha of 2 x 1 does not go with an image of 3 x 1");
    EXPECT_EQ(message_of<InvalidInput>([&] { with_alpha(alpha, alpha); }),
              "alpha goes with 3 channels, not 1");
    EXPECT_EQ(message_of<InvalidInput>([&] { drop_alpha(wide); }),
              "no alpha to drop from 3 channels");
}

}  // namespace
}  // namespace relief
