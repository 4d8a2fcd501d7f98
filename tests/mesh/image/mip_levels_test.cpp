// SPDX-License-Identifier: Apache-2.0
// Mip levels: sizes, means of what is covered, in light where colours are coded.
#include "relief/mesh/mip_levels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "relief/mesh/error.h"
#include "relief/mesh/threads.h"

namespace relief {
namespace {

using testing::ElementsAre;

template <typename Sample>
Image image_of(int width, int height, int channels, ColorSpace color_space,
               std::vector<Sample> samples) {
    return {width, height, channels, color_space, std::move(samples)};
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
    EXPECT_THAT(levels[0].as<std::uint8_t>(), ElementsAre(6, 25, 100, 2));  // 25.25, 100.25, 2.25
    // Out of 25.25 and 2.25 it is 13.75; out of 25 and 2 it would be 13.5. And 53.125.
    EXPECT_THAT(levels[1].as<std::uint8_t>(), ElementsAre(53, 14));
}

TEST(MipLevels, OddSizesShareTheTexelsThatLieAcrossABorder) {
    // Of 5 texels each of 2 takes two and a half: (a + b + c/2) / 2.5.
    const auto row = mip_levels(image_of<float>(5, 1, 1, ColorSpace::data, {1, 2, 4, 8, 16}));
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
        // Rounding of floats near 500, five levels deep.
        EXPECT_NEAR(static_cast<double>(levels.back().as<float>()[0]), mean, 1e-3)
            << width << " x " << height;
    }
}

TEST(MipLevels, CodedColoursAreAveragedAsLightAndAlphaIsNot) {
    for (const int channels : {3, 4}) {
        Image image = make_image(2, 1, channels, 8, ColorSpace::srgb);
        for (int c = 0; c < channels; ++c)
            image.as<std::uint8_t>()[static_cast<std::size_t>(c)] = 255;
        const auto level = mip_levels(image)[0];
        EXPECT_EQ(level.as<std::uint8_t>()[0], 188);  // Half the light is code 187.5.
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

TEST(MipLevels, EveryPlainColourStaysItself) {
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

}  // namespace
}  // namespace relief
