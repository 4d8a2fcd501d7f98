// SPDX-License-Identifier: Apache-2.0
// FLIP: against its definition, against the authors' program, and what must hold for any metric.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "flip_brute_force.h"
#include "relief/mesh/error.h"
#include "relief/mesh/threads.h"
#include "relief/shade/image_compare.h"

namespace relief {
namespace {

using Codes = std::function<unsigned(unsigned x, unsigned y, unsigned channel)>;

/// 0 to 255, as a fixed hash of the place.
unsigned noise(unsigned x, unsigned y, unsigned channel, unsigned seed) {
    std::uint32_t hash =
        x * 374761393U + y * 668265263U + channel * 2246822519U + seed * 3266489917U;
    hash = (hash ^ (hash >> 13U)) * 1274126177U;
    return (hash ^ (hash >> 16U)) & 255U;
}

unsigned ramps(unsigned x, unsigned y, unsigned channel) {
    return (2U * x + 3U * y + 60U * channel) % 256U;
}

unsigned grainy_ramps(unsigned x, unsigned y, unsigned channel) {
    return std::min(255U, ramps(x, y, channel) + noise(x, y, channel, 7) / 8U);
}

unsigned moved_ramps(unsigned x, unsigned y, unsigned channel) {
    return ramps(x + 1, y, channel);
}

Codes noise_of(unsigned seed) {
    return [seed](unsigned x, unsigned y, unsigned channel) { return noise(x, y, channel, seed); };
}

Image picture(int width, int height, const Codes& codes) {
    Image image = make_image(width, height, 3, 8, ColorSpace::srgb);
    std::size_t i = 0;
    for (unsigned y = 0; y < static_cast<unsigned>(height); ++y) {
        for (unsigned x = 0; x < static_cast<unsigned>(width); ++x) {
            for (unsigned c = 0; c < 3; ++c)
                image.as<std::uint8_t>()[i++] = static_cast<std::uint8_t>(codes(x, y, c));
        }
    }
    return image;
}

/// A linear float picture of one colour; as many channels as values.
Image plain(std::vector<float> color, int width = 12, int height = 9) {
    Image image = make_image(width, height, static_cast<int>(color.size()), 32, ColorSpace::linear);
    for (std::size_t i = 0; i < image.sample_count(); ++i)
        image.as<float>()[i] = color[i % color.size()];
    return image;
}

float map_at(const FlipDifference& difference, std::size_t x, std::size_t y) {
    return difference.map.as<float>()[y * static_cast<std::size_t>(difference.map.width) + x];
}

TEST(Flip, GivesTheNumbersOfItsAuthorsProgram) {
    // Printed by version 1.7 of the authors' C++ program for these pictures of 96 x 80 pixels. It
    // works in float with 4e-7 of rounding in each lightness, which the exponents raise.
    constexpr double rounding = 2e-5;
    const auto expect = [](const Codes& reference, const Codes& test, double pixels_per_degree,
                           double mean, double max, double middle, double corner) {
        const FlipDifference difference =
            flip_difference(picture(96, 80, reference), picture(96, 80, test), pixels_per_degree);
        EXPECT_NEAR(difference.mean, mean, rounding);
        EXPECT_NEAR(difference.max, max, rounding);
        EXPECT_NEAR(map_at(difference, 50, 40), middle, rounding);
        EXPECT_NEAR(map_at(difference, 95, 79), corner, rounding);
    };
    const double usual = default_pixels_per_degree;
    expect(noise_of(1), noise_of(2), usual, 0.4398127, 0.969753, 0.619667, 0.628800);
    expect(ramps, grainy_ramps, usual, 0.2934516, 0.436778, 0.302091, 0.333837);
    expect(ramps, moved_ramps, usual, 0.1460653, 0.804802, 0.092005, 0.083920);
    expect(ramps, grainy_ramps, 30, 0.3068858, 0.552595, 0.262061, 0.328351);
    expect(ramps, moved_ramps, 120, 0.1397213, 0.547950, 0.180056, 0.128828);
}

TEST(Flip, FiltersInPassesGiveWhatFiltersAsSquaresGive) {
    // Taller than a band of rows, so that a wrong halo would show.
    const Image a = picture(23, 57, noise_of(3));
    const Image b = picture(23, 57, noise_of(4));
    for (const double pixels_per_degree : {12.0, 40.0, default_pixels_per_degree}) {
        const FlipDifference difference = flip_difference(a, b, pixels_per_degree);
        const std::vector<double> expected = test::flip_brute_force(a, b, pixels_per_degree);
        double worst = 0.0;
        for (std::size_t i = 0; i < expected.size(); ++i) {
            worst = std::max(
                worst, std::abs(expected[i] - static_cast<double>(difference.map.as<float>()[i])));
        }
        // Float against double: where features hardly differ, the square root of their difference
        // turns 1e-8 of rounding into 1e-4.
        EXPECT_LT(worst, 1e-4) << pixels_per_degree;
    }
}

TEST(Flip, IsExactlyZeroForEqualPicturesOnly) {
    const Image a = picture(40, 30, noise_of(1));
    const FlipDifference none = flip_difference(a, a);
    EXPECT_EQ(none.mean, 0.0);
    EXPECT_EQ(none.max, 0.0);
    Image b = a;
    b.as<std::uint8_t>()[3 * (15 * 40 + 20)] ^= 8U;
    const FlipDifference some = flip_difference(a, b);
    EXPECT_GT(some.mean, 0.0);
    EXPECT_GT(map_at(some, 20, 15), 0.0F);
    EXPECT_EQ(map_at(some, 20 + 11, 15), 0.0F) << "beyond the filters' reach of 10";
}

TEST(Flip, IsTheSameBothWaysRoundBitForBit) {
    const Image a = picture(50, 60, ramps);
    const Image b = picture(50, 60, noise_of(5));
    const FlipDifference there = flip_difference(a, b);
    const FlipDifference back = flip_difference(b, a);
    EXPECT_EQ(there.map.samples, back.map.samples);
    EXPECT_EQ(there.mean, back.mean);
}

TEST(Flip, BlackAgainstWhiteIsWhatTheFormulaSaysAndGreenAgainstBlueIsOne) {
    // One colour each: filters change nothing, there are no features, and the lightness differs by
    // 100. Of the largest distance 203.3 (between green and blue), to the power of 0.7:
    const double bent = std::pow(100.0 / 203.3, 0.7);
    const double expected = 0.95 + 0.05 * (bent - 0.4) / 0.6;
    const FlipDifference extreme = flip_difference(plain({0, 0, 0}), plain({1, 1, 1}));
    EXPECT_NEAR(extreme.mean, expected, 1e-4);
    EXPECT_NEAR(extreme.mean, extreme.max, 1e-6) << "the same in every pixel but for rounding";
    EXPECT_NEAR(flip_difference(plain({0, 1, 0}), plain({0, 0, 1})).mean, 1.0, 1e-5);
}

TEST(Flip, StaysWithinItsRangeAndGrowsWithContrast) {
    double before = 0.0;
    for (const float light : {0.21F, 0.22F, 0.25F, 0.3F, 0.5F, 0.8F, 1.0F}) {
        const double error =
            flip_difference(plain({0.2F, 0.2F, 0.2F}), plain({light, light, light})).mean;
        EXPECT_GT(error, before);
        before = error;
    }
    // Hard edges in all directions against their negative: the strongest features there are.
    const Codes checks = [](unsigned x, unsigned y, unsigned) {
        return (x / 9 + y / 9) % 2 == 0 ? 255U : 0U;
    };
    const Codes negative = [&](unsigned x, unsigned y, unsigned c) {
        return 255U - checks(x, y, c);
    };
    const FlipDifference hardest =
        flip_difference(picture(60, 60, checks), picture(60, 60, negative));
    EXPECT_GT(hardest.max, 0.9);
    for (const float error : hardest.map.as<float>()) {
        ASSERT_GE(error, 0.0F);
        ASSERT_LE(error, 1.0F);
    }
}

TEST(Flip, FineGrainFadesWithDistanceAndABlurredEdgeShows) {
    const Codes checks = [](unsigned x, unsigned y, unsigned) {
        return (x + y) % 2 == 0 ? 140U : 110U;
    };
    const Codes inverse = [&](unsigned x, unsigned y, unsigned c) {
        return 250U - checks(x, y, c);
    };
    const auto error_at = [&](double pixels_per_degree) {
        return flip_difference(picture(48, 48, checks), picture(48, 48, inverse), pixels_per_degree)
            .mean;
    };
    EXPECT_LT(error_at(30), 0.7 * error_at(15));
    EXPECT_LT(error_at(100), 0.2 * error_at(15));

    const Codes sharp = [](unsigned x, unsigned, unsigned) { return x < 24 ? 60U : 200U; };
    const Codes soft = [](unsigned x, unsigned, unsigned) {
        return x < 20 ? 60U : (x < 28 ? 60U + (x - 20U) * 18U : 200U);
    };
    const FlipDifference blurred = flip_difference(picture(48, 20, sharp), picture(48, 20, soft));
    EXPECT_GT(map_at(blurred, 23, 10), 0.2F);
    EXPECT_EQ(map_at(blurred, 4, 10), 0.0F);
}

TEST(Flip, TheNumberOfThreadsChangesNoBit) {
    const Image a = picture(70, 200, noise_of(1));
    const Image b = picture(70, 200, noise_of(2));
    const FlipDifference all = flip_difference(a, b);
    set_thread_limit(1);
    const FlipDifference one = flip_difference(a, b);
    set_thread_limit(0);
    EXPECT_EQ(all.map.samples, one.map.samples);
    EXPECT_EQ(all.mean, one.mean);
}

TEST(Flip, BitsChannelsAndCodingOfOnePictureDoNotMatter) {
    const Codes gray = [](unsigned x, unsigned y, unsigned) { return ramps(x, y, 0); };
    const Image bytes = picture(30, 20, gray);
    Image words = make_image(30, 20, 1, 16, ColorSpace::srgb);
    for (std::size_t i = 0; i < words.sample_count(); ++i) {
        words.as<std::uint16_t>()[i] =
            static_cast<std::uint16_t>(257U * bytes.as<std::uint8_t>()[3 * i]);
    }
    EXPECT_EQ(flip_difference(bytes, words).max, 0.0);
    EXPECT_EQ(flip_difference(bytes, to_linear(bytes)).max, 0.0);
}

TEST(Flip, WhatAScreenCannotShowIsCut) {
    const float inf = std::numeric_limits<float>::infinity();
    EXPECT_EQ(flip_difference(plain({1, 1, 1}), plain({2, inf, 1e30F})).max, 0.0);
    EXPECT_EQ(flip_difference(plain({0, 0, 0}), plain({-1, -inf, -0.0F})).max, 0.0);
}

TEST(Flip, NoNumberAgainstANumberIsTheLargestErrorInItsPixel) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    Image a = plain({0, 0, 0});
    Image b = a;
    a.as<float>()[3 * 5 + 1] = nan;
    for (const FlipDifference& difference : {flip_difference(a, b), flip_difference(b, a)}) {
        EXPECT_EQ(map_at(difference, 5, 0), 1.0F);
        EXPECT_EQ(map_at(difference, 4, 0), 0.0F) << "shown as black, which is what is there";
        EXPECT_DOUBLE_EQ(difference.mean, 1.0 / 108.0);
    }
    b.as<float>()[3 * 5 + 1] = nan;
    EXPECT_EQ(flip_difference(a, b).max, 0.0);
    b.as<float>()[3 * 5 + 2] = nan;
    EXPECT_EQ(map_at(flip_difference(a, b), 5, 0), 1.0F);
}

TEST(Flip, CoverageCountsOverBlackAndOverWhite) {
    // Black that covers and nothing at all are the same over black, and opposites over white.
    const double extreme = flip_difference(plain({0, 0, 0}), plain({1, 1, 1})).mean;
    EXPECT_NEAR(flip_difference(plain({0, 0, 0, 1}), plain({0, 0, 0, 0})).mean, extreme, 1e-6);
    EXPECT_NEAR(flip_difference(plain({1, 1}), plain({1, 0})).mean, extreme, 1e-6);
    EXPECT_EQ(flip_difference(plain({1, 0, 0, 0}), plain({0, 1, 0, 0})).max, 0.0)
        << "nothing shows of either";
    EXPECT_EQ(flip_difference(plain({0.5F, 0, 0, 1}), plain({0.5F, 0, 0})).max, 0.0);
}

TEST(Flip, APictureOfOnePixelHasAnError) {
    EXPECT_NEAR(flip_difference(plain({0, 1, 0}, 1, 1), plain({0, 0, 1}, 1, 1)).mean, 1.0, 1e-5);
}

TEST(Flip, WhatCannotBeComparedIsRefused) {
    const auto message = [](const Image& a, const Image& b, double ppd) -> std::string {
        try {
            (void)flip_difference(a, b, ppd);
            return "accepted";
        } catch (const InvalidInput& error) {
            return error.what();
        }
    };
    const Image image = plain({0, 0, 0});
    EXPECT_EQ(message(image, plain({0, 0, 0}, 9, 12), 60),
              "pictures of 12 x 9 and 9 x 12 pixels cannot be compared");
    EXPECT_EQ(message(image, make_image(12, 9, 3, 8, ColorSpace::data), 60),
              "FLIP compares colours, and one image holds data");
    EXPECT_EQ(message(Image{}, image, 60), "FLIP compares pictures, and one has no pixels");
    EXPECT_EQ(message(image, image, 9), "9 pixels per degree: FLIP takes 10 to 1000");
    EXPECT_EQ(message(image, image, std::nan("")), "nan pixels per degree: FLIP takes 10 to 1000");
    EXPECT_EQ(message(image, image, 1000), "accepted");
}

}  // namespace
}  // namespace relief
