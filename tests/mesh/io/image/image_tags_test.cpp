// SPDX-License-Identifier: Apache-2.0
// Tags that would make a colour of a data map.
#include <gtest/gtest.h>

#include <fstream>

#include "io/png/png_chunk.h"
#include "relief/mesh/error.h"
#include "relief/mesh/image_tags.h"
#include "support/shared_data.h"

namespace relief {
namespace {

std::string tag_of(const std::string& bytes) {
    const test::TemporaryDirectory folder;
    std::ofstream(folder / "map.png", std::ios::binary) << bytes;
    return color_tag(folder / "map.png");
}

std::string png_with(std::string_view type, std::string_view data) {
    std::string file = "\x89PNG\r\n\x1a\n";
    append_chunk(file, "IHDR", std::string(13, '\1'));
    append_chunk(file, "pHYs", std::string(9, '\0'));
    append_chunk(file, type, data);
    append_chunk(file, "IDAT", "");
    append_chunk(file, "sRGB", std::string(1, '\0'));  // Too late to count.
    return file;
}

TEST(ColorTag, NamesWhatAFileSays) {
    EXPECT_EQ(tag_of(png_with("sRGB", std::string(1, '\0'))), "sRGB");
    EXPECT_EQ(tag_of(png_with("iCCP", "x")), "ICC profile");
    EXPECT_EQ(tag_of(png_with("gAMA", std::string("\0\0\xB1\x8F", 4))), "gamma 0.45455");
    EXPECT_EQ(tag_of(png_with("gAMA", std::string("\0\x01\x86\xA0", 4))), "");
    EXPECT_EQ(tag_of(png_with("tEXt", "a")), "");
}

TEST(ColorTag, IsEmptyForWhatIsCutShortOrNoPng) {
    const std::string whole = png_with("sRGB", std::string(1, '\0'));
    for (std::size_t size = 0; size < whole.find("sRGB") + 4; ++size)
        EXPECT_EQ(tag_of(whole.substr(0, size)), "") << size;
    EXPECT_EQ(tag_of("\xFF\xD8\xFF"), "");
    EXPECT_THROW(color_tag("missing.png"), FileError);
}

TEST(ColorTag, IsThatOfRealMaps) {
    RELIEF_NEEDS_SHARED(folder, "data/textures");
    EXPECT_EQ(color_tag(folder / "sand_ambientcg/sand_normal.png"), "sRGB");
    EXPECT_EQ(color_tag(folder / "parallax_cube_bevy/cube_normal.png"), "ICC profile");
    EXPECT_EQ(color_tag(folder / "cheese_godot/texture_cheese_normal.png"), "");
}

}  // namespace
}  // namespace relief
