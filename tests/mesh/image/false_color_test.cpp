// SPDX-License-Identifier: Apache-2.0
// Heat pictures: larger is brighter, and no number is no colour of heat.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "relief/mesh/error.h"
#include "relief/mesh/false_color.h"

namespace relief {
namespace {

using Pixel = std::array<int, 3>;

Pixel shown(float value, double brightest) {
    Image values = make_image(1, 1, 1, 32, ColorSpace::data);
    values.as<float>()[0] = value;
    const Image picture = false_color_image(values, brightest);
    const auto codes = picture.as<std::uint8_t>();
    return {codes[0], codes[1], codes[2]};
}

double luminance(const Pixel& pixel) {
    const auto light = [](int code) {
        return static_cast<double>(linear_from_srgb(static_cast<float>(code) / 255.0F));
    };
    return 0.2126 * light(pixel[0]) + 0.7152 * light(pixel[1]) + 0.0722 * light(pixel[2]);
}

TEST(HeatPicture, GetsBrighterAllTheWay) {
    double before = -1.0;
    for (int i = 0; i <= 100; ++i) {
        const double now = luminance(shown(static_cast<float>(i) * 0.01F * 7.0F, 7.0));
        EXPECT_GT(now, before) << i;
        before = now;
    }
}

TEST(HeatPicture, EndsAtItsEnds) {
    EXPECT_EQ(shown(0, 2), (Pixel{0, 0, 4}));
    EXPECT_EQ(shown(-3, 2), (Pixel{0, 0, 4}));
    EXPECT_EQ(shown(1, 2), (Pixel{183, 55, 121}));
    EXPECT_EQ(shown(2, 2), (Pixel{252, 253, 191}));
    EXPECT_EQ(shown(INFINITY, 2), (Pixel{252, 253, 191}));
    EXPECT_EQ(shown(NAN, 2), (Pixel{0, 255, 0}));
}

TEST(HeatPicture, TakesOneFloatChannelAndAPositiveEnd) {
    EXPECT_THROW(false_color_image(make_image(2, 2, 3, 32, ColorSpace::data), 1), InvalidInput);
    EXPECT_THROW(false_color_image(make_image(2, 2, 1, 8, ColorSpace::data), 1), InvalidInput);
    EXPECT_THROW(false_color_image(Image{}, 1), InvalidInput);
    EXPECT_THROW(false_color_image(make_image(2, 2, 1, 32, ColorSpace::data), 0), InvalidInput);
    EXPECT_THROW(false_color_image(make_image(2, 2, 1, 32, ColorSpace::data), std::nan("")),
                 InvalidInput);
}

}  // namespace
}  // namespace relief
