// SPDX-License-Identifier: Apache-2.0
// An image gives the same pixels from its file, from its bytes, and decoded.
#include "relief/shade/image_source.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "relief/mesh/error.h"
#include "support/shared_data.h"

namespace relief {
namespace {

Image small_picture() {
    Image image = make_image(2, 1, 3, 8, ColorSpace::srgb);
    image.samples = std::vector<std::uint8_t>{1, 2, 3, 250, 251, 252};
    return image;
}

TEST(ImageSource, GivesTheSameFromFileBytesAndMemory) {
    const test::TemporaryDirectory folder;
    const std::filesystem::path file = folder / "picture.png";
    write_image(file, small_picture());
    std::ifstream stream(file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    const auto* begin = reinterpret_cast<const std::byte*>(text.data());
    const std::vector<std::byte> bytes(begin, begin + text.size());
    for (const ImageSource& source :
         {ImageSource{"file", file}, {"bytes", bytes}, {"memory", small_picture()}}) {
        SCOPED_TRACE(source.name);
        const Image color = decode(source, ImageUse::color);
        EXPECT_EQ(color.samples, small_picture().samples);
        EXPECT_EQ(color.color_space, ColorSpace::srgb);
        const Image data = decode(source, ImageUse::data);
        EXPECT_EQ(data.samples, small_picture().samples);
        EXPECT_EQ(data.color_space, ColorSpace::data);
    }
}

TEST(ImageSource, ThatIsMissingOrBrokenThrows) {
    EXPECT_THROW((void)decode({"a", std::filesystem::path("/nowhere.png")}, ImageUse::color),
                 FileError);
    EXPECT_THROW((void)decode({"b", std::vector<std::byte>(7)}, ImageUse::color), FileError);
}

}  // namespace
}  // namespace relief
