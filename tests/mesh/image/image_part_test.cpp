// SPDX-License-Identifier: Apache-2.0
// Rectangles of images, by hand.
#include "relief/mesh/image_part.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "relief/mesh/error.h"
#include "support/samples.h"

namespace relief {
namespace {

using test::samples_of;
using testing::ElementsAre;

/// 3 x 2 texels of two channels: 0 1 | 2 3 | 4 5, then 6 7 | 8 9 | 10 11.
Image numbered() {
    Image image = make_image(3, 2, 2, 8, ColorSpace::srgb);
    for (std::size_t i = 0; i < 12; ++i)
        image.as<std::uint8_t>()[i] = static_cast<std::uint8_t>(i);
    return image;
}

TEST(ImagePart, HoldsTheTexelsOfTheRectangle) {
    const Image part = part_of(numbered(), {1, 0, 2, 2});
    EXPECT_THAT(samples_of<std::uint8_t>(part), ElementsAre(2, 3, 4, 5, 8, 9, 10, 11));
    EXPECT_EQ(part.color_space, ColorSpace::srgb);
    EXPECT_THAT(samples_of<std::uint8_t>(part_of(numbered(), {2, 1, 1, 1})), ElementsAre(10, 11));
    EXPECT_EQ(part_of(numbered(), {0, 0, 3, 2}).samples, numbered().samples);
}

TEST(ImagePart, BeyondTheImageThereIsNone) {
    for (const ImagePart& part : {ImagePart{-1, 0, 2, 1}, ImagePart{0, 1, 1, 2},
                                  ImagePart{2, 0, 2, 1}, ImagePart{0, 0, 0, 1}, ImagePart{}})
        EXPECT_THROW(part_of(numbered(), part), InvalidInput);
}

}  // namespace
}  // namespace relief
