// SPDX-License-Identifier: Apache-2.0
// What is found out of encoded images before decoding: format, wholeness, size, text. The bytes are
// put together by hand here, so that each field is known.
#include "io/image/image_file_container.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "module_reference.h"
#include "relief/mesh/error.h"
#include "support/message_of.h"

namespace relief {
namespace {

using namespace std::string_literals;
using test::big32;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

ImageContainer examine(const std::string& bytes, const std::string& name = "image") {
    return examine_image(std::as_bytes(std::span(bytes)), name);
}

std::string complaint_about(const std::string& bytes, const std::string& name = "image") {
    return test::message_of<FileError>([&] { examine(bytes, name); });
}

std::string stripped(const std::string& bytes) {
    const ImageContainer container = examine(bytes);
    return {reinterpret_cast<const char*>(container.stripped.data()), container.stripped.size()};
}

std::string big16(std::uint32_t value) {
    return big32(value).substr(2);
}

/// A chunk with a checksum of zeros: nobody looks at it here.
std::string unchecked_chunk(const std::string& type, const std::string& data) {
    return big32(static_cast<std::uint32_t>(data.size())) + type + data + big32(0);
}

std::string png_header(std::uint32_t width, std::uint32_t height, char bits = 8, char type = 0) {
    return unchecked_chunk("IHDR", big32(width) + big32(height) + std::string{bits, type, 0, 0, 0});
}

const std::string png_start = "\x89PNG\r\n\x1A\n";
const std::string png_end = unchecked_chunk("IEND", "");

std::string jpeg_segment(char marker, const std::string& data) {
    return "\xFF"s + marker + big16(static_cast<std::uint32_t>(data.size() + 2)) + data;
}

std::string jpeg_frame(std::uint32_t width, std::uint32_t height) {
    return jpeg_segment('\xC0', "\x08"s + big16(height) + big16(width) + "\x01\x01\x11\x00"s);
}

const std::string jpeg_scan = jpeg_segment('\xDA', "\x01\x01\x00\x00\x3F\x00"s) + "coded\xFF\x00.";

TEST(ImageContainer, TheFirstBytesDecideTheFormat) {
    EXPECT_STREQ(examine("II*\0...."s).format, "tiff");
    EXPECT_STREQ(examine("MM\0+...."s).format, "tiff");
    EXPECT_THAT(complaint_about("\x76\x2F\x31\x01", "a.png"), HasSubstr("within its header"));
    EXPECT_STREQ(examine("#?RADIANCE\n").format, "hdr");
    EXPECT_STREQ(examine("P6 1 1 255 abc").format, "pnm");
    EXPECT_STREQ(examine("RIFF\4\0\0\0WEBPVP8 "s).format, "webp");
    EXPECT_THAT(complaint_about("RIFF\4\0\0\0WAVE"s), HasSubstr("is no image that relief reads"));
    EXPECT_THAT(complaint_about("hello"), HasSubstr("image: is no image that relief reads: PNG"));
    EXPECT_THAT(complaint_about(""), HasSubstr("is empty"));
}

TEST(ImageContainer, PngKeepsOnlyWhatDefinesItsSamples) {
    const std::string kept = png_header(1, 1) + unchecked_chunk("PLTE", "abc");
    const std::string data =
        unchecked_chunk("tRNS", "a") + unchecked_chunk("IDAT", "12345") + png_end;
    const std::string file = png_start + kept + unchecked_chunk("gAMA", "1234") +
                             unchecked_chunk("iCCP", "profile") + unchecked_chunk("eXIf", "II*") +
                             data + "rest";
    EXPECT_EQ(stripped(file), png_start + kept + data);
}

TEST(ImageContainer, PngTextIsKeptWhereItIsPlain) {
    const ImageContainer container =
        examine(png_start + png_header(1, 1) + unchecked_chunk("tEXt", "relief:green\0up"s) +
                unchecked_chunk("iTXt", "Titel\0\0\0de\0Titel\0Vase"s) +
                unchecked_chunk("iTXt", "packed\0\1\0\0\0xyz"s) +
                unchecked_chunk("tEXt", "no zero") + unchecked_chunk("tEXt", "\0no key"s) +
                unchecked_chunk("iTXt", "cut\0\0"s) + unchecked_chunk("IDAT", "12345") + png_end);
    EXPECT_THAT(container.text, ElementsAre(Pair("Titel", "Vase"), Pair("relief:green", "up")));
}

TEST(ImageContainer, ACutPngIsRefusedWithThePlaceOfTheCut) {
    const std::string file =
        png_start + png_header(1, 1) + unchecked_chunk("IDAT", "12345") + png_end;
    EXPECT_EQ(complaint_about(file), "no error");
    for (std::size_t size = png_start.size(); size < file.size(); ++size)
        EXPECT_THAT(complaint_about(file.substr(0, size)), HasSubstr("is cut short")) << size;
    EXPECT_THAT(complaint_about(png_start + big32(100) + "IDAT" + big32(0)),
                HasSubstr("the chunk at byte 8 ends 100 bytes after the file"));
    EXPECT_THAT(complaint_about(png_start + big32(0xFFFFFFFF) + "IDAT" + big32(0)),
                HasSubstr("is cut short"));
}

TEST(ImageContainer, APngThatAnnouncesMoreThanItHoldsIsRefused) {
    const auto announcing = [](std::uint32_t width, std::uint32_t height, char bits, char type) {
        return complaint_about(png_start + png_header(width, height, bits, type) +
                               unchecked_chunk("IDAT", std::string(100, 'x')) + png_end);
    };
    // 100 bytes of deflate hold at most 103,200; a row of 1000 grey samples takes 1000.
    EXPECT_EQ(announcing(1000, 100, 8, 0), "no error");
    EXPECT_THAT(announcing(1000, 200, 8, 0), HasSubstr("announces 1000 x 200 texels, which its"));
    EXPECT_EQ(announcing(1000, 800, 1, 0), "no error");
    EXPECT_THAT(announcing(1000, 100, 16, 6), HasSubstr("cannot hold"));
    EXPECT_THAT(announcing(0xFFFFFFFF, 0xFFFFFFFF, 16, 6), HasSubstr("cannot hold"));
    EXPECT_THAT(announcing(0, 5, 8, 0), HasSubstr("is empty: 0 x 5 texels"));
    EXPECT_THAT(announcing(5, 5, 8, 1), HasSubstr("PNG has no colour type 1"));
    EXPECT_THAT(complaint_about(png_start + unchecked_chunk("IDAT", "12345") + png_end),
                HasSubstr("has no IHDR chunk"));
}

TEST(ImageContainer, JpegLosesItsMetadataButKeepsHowColoursAreCoded) {
    const std::string jfif = jpeg_segment('\xE0', "JFIF");
    const std::string adobe = jpeg_segment('\xEE', "Adobe");
    const std::string rest = jpeg_frame(8, 8) + jpeg_scan + "\xFF\xD0.." + "\xFF\xD9";
    const std::string file = "\xFF\xD8" + jfif + jpeg_segment('\xE1', "Exif") + adobe +
                             jpeg_segment('\xE2', "ICC_PROFILE") + jpeg_segment('\xFE', "comment") +
                             rest;
    EXPECT_STREQ(examine(file).format, "jpeg");
    EXPECT_EQ(stripped(file), "\xFF\xD8" + jfif + adobe + rest);
}

TEST(ImageContainer, ACutJpegIsRefused) {
    const std::string file = "\xFF\xD8" + jpeg_frame(8, 8) + jpeg_scan + "\xFF\xD9";
    EXPECT_EQ(complaint_about(file), "no error");
    for (std::size_t size = 3; size < file.size(); ++size)
        EXPECT_THAT(complaint_about(file.substr(0, size)), HasSubstr("is cut short")) << size;
    EXPECT_THAT(complaint_about("\xFF\xD8\xFF\xDA\0\1\xFF\xD9"s), HasSubstr("is cut short"));
}

TEST(ImageContainer, AJpegThatAnnouncesMoreThanItHoldsIsRefused) {
    const auto announcing = [](std::uint32_t width, std::uint32_t height) {
        return complaint_about("\xFF\xD8" + jpeg_frame(width, height) + jpeg_scan + "\xFF\xD9");
    };
    EXPECT_EQ(announcing(256, 256), "no error");
    EXPECT_THAT(announcing(65500, 65500), HasSubstr("announces 65500 x 65500 texels"));
    EXPECT_THAT(announcing(8, 0), HasSubstr("is empty"));
    EXPECT_THAT(complaint_about("\xFF\xD8\xFF\xD9"), HasSubstr("has no frame"));
}

TEST(ImageContainer, TgaGoesByItsNameOrFooterAndIsChecked) {
    std::string header(18, '\0');
    header[2] = 2;   // True colour, not compressed.
    header[12] = 2;  // Width.
    header[14] = 1;  // Height.
    header[16] = 24;
    EXPECT_STREQ(examine(header + "bgrbgr", "a.TGA").format, "targa");
    EXPECT_STREQ(examine(header + "bgrbgr" + "TRUEVISION-XFILE.\0"s).format, "targa");
    EXPECT_THAT(complaint_about(header + "bgrbgr", "a.png"), HasSubstr("is no image"));
    header[13] = 1;  // 258 texels of 3 bytes.
    EXPECT_THAT(complaint_about(header + "bgrbgr", "a.tga"),
                HasSubstr("announces 258 x 1 texels, which its 24 bytes cannot hold"));
    EXPECT_THAT(complaint_about("abc", "a.tga"), HasSubstr("is cut short"));
    header[13] = 0;
    header[3] = 126;  // Without a color map, its first entry has no meaning.
    EXPECT_EQ(complaint_about(header + "bgrbgr", "a.tga"), "no error");
    header[2] = 1;
    EXPECT_THAT(complaint_about(header + "bgrbgr", "a.tga"),
                HasSubstr("has a color map that starts at entry 126"));
}

std::string little32(std::uint32_t value) {
    const std::string big = big32(value);
    return {big.rbegin(), big.rend()};
}

std::string exr_attribute(const std::string& name, const std::string& value) {
    return name + "\0type\0"s + little32(static_cast<std::uint32_t>(value.size())) + value;
}

std::string exr_header(std::int32_t last_column, std::int32_t last_row, const std::string& more) {
    return "\x76\x2F\x31\x01\2\0\0\0"s +
           exr_attribute("dataWindow", little32(0) + little32(0) +
                                           little32(static_cast<std::uint32_t>(last_column)) +
                                           little32(static_cast<std::uint32_t>(last_row))) +
           more + '\0';
}

TEST(ImageContainer, AnExrWhoseTablesOrTilesCannotBeIsRefused) {
    const std::string tiles = exr_attribute("tiles", little32(64) + little32(64) + '\0');
    EXPECT_STREQ(examine(exr_header(63, 63, tiles)).format, "openexr");
    EXPECT_STREQ(examine(exr_header(63, 63, "")).format, "openexr");
    EXPECT_THAT(complaint_about(exr_header(63, 1 << 20, "")), HasSubstr("cannot hold"));
    EXPECT_THAT(complaint_about(exr_header(1 << 20, 63, tiles)), HasSubstr("cannot hold"));
    EXPECT_THAT(complaint_about(exr_header(-1, 63, "")), HasSubstr("is empty: 0 x 64"));
    EXPECT_THAT(complaint_about(exr_header(0x7FFFFFFF, 0x7FFFFFFF, tiles)),
                HasSubstr("announces 2147483648 x 2147483648 texels"));
    EXPECT_THAT(
        complaint_about(exr_header(9, 9, exr_attribute("tiles", little32(69094) + little32(4616)))),
        HasSubstr("announces tiles of 69094 x 4616 texels"));
    EXPECT_THAT(
        complaint_about(exr_header(9, 9, exr_attribute("tiles", little32(0) + little32(4)))),
        HasSubstr("announces tiles of 0 x 4"));
    const std::string whole = exr_header(63, 63, tiles);
    for (std::size_t size = 4; size < whole.size() - 1; ++size)
        EXPECT_THAT(complaint_about(whole.substr(0, size)), HasSubstr("is cut short")) << size;
    EXPECT_THAT(complaint_about("\x76\x2F\x31\x01\2\0\0\0\0"s), HasSubstr("has no data window"));
}

}  // namespace
}  // namespace relief
