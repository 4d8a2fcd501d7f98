// SPDX-License-Identifier: Apache-2.0
// The direct way for JPEG against the image module, and what is left to that.
#include "io/image/jpeg_decoder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "module_reference.h"
#include "relief/mesh/image_file.h"
#include "support/shared_data.h"

namespace relief {
namespace {

using test::by_module;
using test::directly;

/// A picture with edges and soft slopes, written at an odd size.
std::string jpeg_file(int channels) {
    const test::TemporaryDirectory folder;
    Image image = make_image(37, 21, channels, 8, ColorSpace::srgb);
    std::size_t i = 0;
    for (std::uint8_t& sample : image.as<std::uint8_t>()) {
        sample = static_cast<std::uint8_t>(i / 5 % 37 < 11 ? 250 : i * 3 % 256);
        ++i;
    }
    write_image(folder / "a.jpg", image);
    return test::contents_of(folder / "a.jpg");
}

TEST(PlainJpegs, GreyAndColouredReadAsTheModuleReadsThem) {
    for (const int channels : {1, 3}) {
        const std::string file = jpeg_file(channels);
        test::expect_same(directly(file), by_module(file), std::to_string(channels));
        EXPECT_EQ(directly(file)->channels, channels);
    }
}

TEST(PlainJpegs, AmongRealFilesReadAsTheModuleReadsThem) {
    RELIEF_NEEDS_SHARED(data, "data");
    const test::Comparison comparison = test::compare_all(data, ".jpg");
    EXPECT_GT(comparison.direct, 10U);
    EXPECT_GT(comparison.direct, comparison.left);
}

TEST(PlainJpegs, CmykIsLeftToTheImageModule) {
    RELIEF_NEEDS_SHARED(file, "data/textures/decoder/jpg/magnum_cmyk.jpg");
    EXPECT_FALSE(directly(test::contents_of(file)));
}

TEST(PlainJpegs, OneWhoseDataStopHalfwayIsLeftToTheImageModule) {
    const std::string whole = jpeg_file(3);
    const std::size_t scan = whole.find("\xFF\xDA");
    const std::string cut = whole.substr(0, (scan + whole.size()) / 2) + "\xFF\xD9";
    EXPECT_FALSE(directly(cut));
}

}  // namespace
}  // namespace relief
