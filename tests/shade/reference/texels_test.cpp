// SPDX-License-Identifier: Apache-2.0
// Lookups of small textures by hand.
#include "reference/lookups.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace relief::reference {
namespace {

constexpr TextureWrap all_wraps[] = {TextureWrap::repeat, TextureWrap::clamp, TextureWrap::mirror};

/// One row of grey: 0, 1, 2, 3.
Texels ramp() {
    Image image = make_image(4, 1, 1, 32, ColorSpace::data);
    image.samples = std::vector<float>{0, 1, 2, 3};
    return Texels(image);
}

TEST(Texels, GoOnBeyondTheBorderAsAsked) {
    const int indices[] = {-9, -5, -4, -1, 0, 3, 4, 7, 8, 11};
    const int repeated[] = {3, 3, 0, 3, 0, 3, 0, 3, 0, 3};
    const int clamped[] = {0, 0, 0, 0, 0, 3, 3, 3, 3, 3};
    const int mirrored[] = {0, 3, 3, 0, 0, 3, 3, 0, 0, 3};
    for (std::size_t i = 0; i < std::size(indices); ++i) {
        SCOPED_TRACE(indices[i]);
        EXPECT_EQ(wrapped(indices[i], 4, TextureWrap::repeat), repeated[i]);
        EXPECT_EQ(wrapped(indices[i], 4, TextureWrap::clamp), clamped[i]);
        EXPECT_EQ(wrapped(indices[i], 4, TextureWrap::mirror), mirrored[i]);
    }
}

TEST(Texels, StayWithinTheTextureHoweverFarAway) {
    for (const TextureWrap wrap : all_wraps) {
        for (const double index : {1e15, -1e15, 1e300, -1e300}) {
            const int found = wrapped(index, 3, wrap);
            EXPECT_TRUE(found >= 0 && found < 3) << found;
        }
    }
}

TEST(Texels, AreExactAtTheirCentresAndLinearBetween) {
    const Texels texels = ramp();
    const auto at = [&](double u, TextureWrap wrap) {
        return texels.bilinear({u, 0.5}, wrap, wrap).r;
    };
    for (const TextureWrap wrap : all_wraps) {
        EXPECT_EQ(at(0.125, wrap), 0.0);
        EXPECT_EQ(at(0.875, wrap), 3.0);
        EXPECT_NEAR(at(0.4375, wrap), 1.25, 1e-15);
    }
    // A quarter of a texel left of the first centre.
    EXPECT_NEAR(at(0.0625, TextureWrap::repeat), 0.75, 1e-15);
    EXPECT_EQ(at(0.0625, TextureWrap::clamp), 0.0);
    EXPECT_EQ(at(0.0625, TextureWrap::mirror), 0.0);
    EXPECT_NEAR(at(1.25, TextureWrap::mirror), 2.5, 1e-15);
}

TEST(Texels, TheNearestIsThatWhichHoldsThePlace) {
    const Texels texels = ramp();
    Trace trace;
    const auto at = [&](double u) {
        return texels.nearest({u, 0.5}, TextureWrap::repeat, TextureWrap::repeat, trace).r;
    };
    EXPECT_EQ(at(0.24), 0.0);
    EXPECT_EQ(at(0.26), 1.0);
    EXPECT_EQ(at(-0.01), 3.0);
    EXPECT_EQ(at(1.26), 1.0);
}

TEST(Texels, VGrowsDownwards) {
    Image image = make_image(1, 2, 1, 32, ColorSpace::data);
    image.samples = std::vector<float>{7, 9};
    const Texels texels(image);
    EXPECT_EQ(texels.bilinear({0.5, 0.25}, TextureWrap::clamp, TextureWrap::clamp).r, 7.0);
    EXPECT_EQ(texels.bilinear({0.5, 0.75}, TextureWrap::clamp, TextureWrap::clamp).r, 9.0);
}

TEST(Texels, AreDecodedBeforeTheyAreFilteredAndAlphaIsNot) {
    Image image = make_image(2, 1, 4, 8, ColorSpace::srgb);
    image.samples = std::vector<std::uint8_t>{255, 255, 255, 255, 0, 0, 0, 51};
    const glm::dvec4 between =
        Texels(image).bilinear({0.5, 0.5}, TextureWrap::clamp, TextureWrap::clamp);
    EXPECT_NEAR(between.r, 0.5, 1e-7);
    EXPECT_NEAR(between.a, 0.6, 1e-7);
}

TEST(Texels, AreRgbaWhateverTheImageHolds) {
    const auto of = [](std::vector<float> samples) {
        Image image = make_image(1, 1, static_cast<int>(samples.size()), 32, ColorSpace::linear);
        image.samples = std::move(samples);
        return Texels(image).at(0, 0);
    };
    EXPECT_EQ(of({5}), glm::dvec4(5, 5, 5, 1));
    EXPECT_EQ(of({5, 2}), glm::dvec4(5, 5, 5, 2));
    EXPECT_EQ(of({5, 6, 7}), glm::dvec4(5, 6, 7, 1));
    EXPECT_EQ(of({5, 6, 7, 8}), glm::dvec4(5, 6, 7, 8));
}

TEST(Texels, AtNoPlaceAreNotANumber) {
    Trace trace;
    const glm::dvec2 nowhere(std::numeric_limits<double>::quiet_NaN(), 0.5);
    for (const TextureWrap wrap : all_wraps) {
        EXPECT_TRUE(std::isnan(ramp().bilinear(nowhere, wrap, wrap).r));
        EXPECT_TRUE(std::isnan(ramp().nearest(nowhere, wrap, wrap, trace).r));
    }
}

}  // namespace
}  // namespace relief::reference
