// SPDX-License-Identifier: Apache-2.0
// Whole image files: formats, samples, text, color tags and options. Container fields are read
// before decoding, and the direct JPEG decoder agrees with the image module.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/resource.h>
#include <unistd.h>
#include <chrono>
#include <cmath>
#include <csignal>
#include <fstream>
#include <limits>
#include <string>
#include <string_view>
#include <thread>

#include "io/image/image_file_container.h"
#include "io/png/png_format.h"
#include "mesh/io/image/module_reference.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/limits.h"
#include "relief/mesh/report.h"
#include "support/invariants.h"
#include "support/labels.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::detail;

namespace {

using test::big32;
using test::by_module;
using test::directly;
using test::message_of;
using test::TemporaryDirectory;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

/// Pseudorandom codes, including alpha.
template <typename Sample>
Image pattern(int width, int height, int channels, ColorSpace color_space) {
    Image image = make_image(width, height, channels, sizeof(Sample) * 8, color_space);
    std::uint32_t state = 7;
    for (Sample& sample : image.as<Sample>()) {
        state = state * 1664525U + 1013904223U;
        if constexpr (std::is_same_v<Sample, float>)
            sample = std::ldexp(static_cast<float>(state >> 8), -20) - 4.0F;
        else
            sample = static_cast<Sample>(state >> 13);
    }
    return image;
}

Image read_back(const std::filesystem::path& file, ImageUse use = ImageUse::data) {
    return read_image(file, use);
}

void expect_same_image(const Image& found, const Image& expected) {
    EXPECT_EQ(found.width, expected.width);
    EXPECT_EQ(found.height, expected.height);
    EXPECT_EQ(found.channels, expected.channels);
    EXPECT_EQ(found.bits(), expected.bits());
    EXPECT_EQ(found.color_space, expected.color_space);
    EXPECT_TRUE(found.samples == expected.samples);
}

std::string complaint_about_reading(const std::filesystem::path& file) {
    return test::message_of<FileError>([&] { read_image(file, ImageUse::data); });
}

TEST(ImageFile, PngKeepsEvery8And16BitSampleOfEveryChannelCount) {
    const TemporaryDirectory folder;
    for (int channels = 1; channels <= 4; ++channels) {
        const Image bytes = pattern<std::uint8_t>(31, 17, channels, ColorSpace::data);
        write_image(folder / "a.png", bytes);
        expect_same_image(read_back(folder / "a.png"), bytes);
        const Image words = pattern<std::uint16_t>(17, 31, channels, ColorSpace::data);
        write_image(folder / "a.png", words);
        expect_same_image(read_back(folder / "a.png"), words);
    }
}

TEST(ImageFile, TiffKeepsEverySampleOf8And16BitsAndFloat) {
    const TemporaryDirectory folder;
    for (int channels = 1; channels <= 4; ++channels) {
        const Image bytes = pattern<std::uint8_t>(31, 17, channels, ColorSpace::data);
        write_image(folder / "a.tif", bytes);
        expect_same_image(read_back(folder / "a.tif"), bytes);
        const Image words = pattern<std::uint16_t>(17, 31, channels, ColorSpace::data);
        write_image(folder / "a.tiff", words);
        expect_same_image(read_back(folder / "a.tiff"), words);
        const Image floats = pattern<float>(17, 31, channels, ColorSpace::data);
        write_image(folder / "f.TIF", floats);
        expect_same_image(read_back(folder / "f.TIF"), floats);
    }
}

TEST(ImageFile, ExrKeepsAllFloatsAndChannels) {
    const TemporaryDirectory folder;
    for (int channels = 1; channels <= 4; ++channels) {
        Image floats = pattern<float>(40, 37, channels, ColorSpace::data);
        floats.as<float>()[1] = std::numeric_limits<float>::infinity();
        floats.as<float>()[2] = 1e-42F;
        floats.as<float>()[3] = -0.0F;
        write_image(folder / "a.exr", floats);
        expect_same_image(read_back(folder / "a.exr"), floats);
    }
}

TEST(ImageFile, HdrKeepsColorsWithinOnePartIn128OfTheLargestChannel) {
    const TemporaryDirectory folder;
    Image colors = make_image(64, 4, 3, 32, ColorSpace::linear);
    for (std::size_t at = 0; at < colors.sample_count(); ++at)
        colors.as<float>()[at] = 0.001F + static_cast<float>(at * at % 1000) / 90.0F;
    write_image(folder / "a.hdr", colors);
    const Image back = read_back(folder / "a.hdr", ImageUse::color);
    EXPECT_EQ(back.color_space, ColorSpace::linear);
    for (std::size_t at = 0; at < colors.sample_count(); at += 3) {
        const float* texel = &colors.as<float>()[at];
        const float largest = std::max({texel[0], texel[1], texel[2]});
        for (std::size_t channel = 0; channel < 3; ++channel)
            EXPECT_NEAR(back.as<float>()[at + channel], texel[channel], largest / 128.0F);
    }
}

TEST(ImageFile, JpegComesCloseToASmoothPicture) {
    const TemporaryDirectory folder;
    Image smooth = make_image(64, 48, 3, 8, ColorSpace::srgb);
    for (std::size_t at = 0; at < smooth.sample_count(); ++at)
        smooth.as<std::uint8_t>()[at] = static_cast<std::uint8_t>(60 + at / 3 % 64 * 2 + at % 3);
    write_image(folder / "a.jpg", smooth);
    const Image back = read_back(folder / "a.jpg", ImageUse::color);
    ASSERT_EQ(back.sample_count(), smooth.sample_count());
    for (std::size_t at = 0; at < smooth.sample_count(); ++at)
        EXPECT_NEAR(back.as<std::uint8_t>()[at], smooth.as<std::uint8_t>()[at], 4);
}

TEST(ImageFile, TheUseDecidesTheColorSpaceNotTheFile) {
    const TemporaryDirectory folder;
    Image srgb = pattern<std::uint8_t>(4, 4, 3, ColorSpace::srgb);
    write_image(folder / "a.png", srgb);
    expect_same_image(read_back(folder / "a.png", ImageUse::color), srgb);
    srgb.color_space = ColorSpace::data;
    expect_same_image(read_back(folder / "a.png", ImageUse::data), srgb);
    const Image linear = pattern<float>(4, 4, 3, ColorSpace::linear);
    write_image(folder / "a.exr", linear);
    expect_same_image(read_back(folder / "a.exr", ImageUse::color), linear);
}

TEST(ImageFile, TransparentTexelsKeepTheirColor) {
    const TemporaryDirectory folder;
    Image image = make_image(2, 1, 4, 8, ColorSpace::data);
    image.samples = std::vector<std::uint8_t>{200, 100, 50, 64, 10, 20, 30, 0};
    for (const char* name : {"a.png", "a.tif"}) {
        write_image(folder / name, image);
        expect_same_image(read_back(folder / name), image);
    }
}

TEST(ImageFile, LargeImagesAreReadInSteps) {
    // 24 MB of samples need more than one step of 16 MB.
    const TemporaryDirectory folder;
    const Image words = pattern<std::uint16_t>(1500, 2000, 4, ColorSpace::data);
    write_image(folder / "a.tif", words);
    expect_same_image(read_back(folder / "a.tif"), words);
}

TEST(ImageFile, BytesInMemoryReadLikeTheirFile) {
    const TemporaryDirectory folder;
    const Image image = pattern<std::uint16_t>(9, 5, 3, ColorSpace::data);
    write_image(folder / "a.png", image);
    const std::string bytes = test::read_bytes(folder / "a.png");
    expect_same_image(
        read_image(std::as_bytes(std::span(bytes)), "image 3 of a.glb", ImageUse::data), image);
    try {
        read_image(std::as_bytes(std::span(bytes).first(40)), "image 3 of a.glb", ImageUse::data);
        FAIL() << "half a file was read";
    } catch (const FileError& error) {
        EXPECT_THAT(error.what(), HasSubstr("image 3 of a.glb: is cut short"));
    }
}

TEST(ImageFile, TheSameImageGivesTheSameBytes) {
    const TemporaryDirectory folder;
    const Image image = pattern<float>(20, 20, 3, ColorSpace::linear);
    const Image coded = pattern<std::uint8_t>(20, 20, 3, ColorSpace::srgb);
    const std::vector<std::string> names = {"a.png", "a.jpg", "a.tif", "a.exr", "a.hdr"};
    const auto write_all = [&] {
        std::vector<std::string> files;
        for (const std::string& name : names) {
            const bool holds_float = name == "a.exr" || name == "a.hdr";
            write_image(folder / name, holds_float ? image : coded, {{"relief:content", "test"}});
            files.push_back(test::read_bytes(folder / name));
        }
        return files;
    };
    const std::vector<std::string> first = write_all();
    // File dates have a resolution of one second.
    std::this_thread::sleep_for(std::chrono::milliseconds(1050));
    const std::vector<std::string> second = write_all();
    for (std::size_t i = 0; i < names.size(); ++i)
        EXPECT_EQ(second[i], first[i]) << names[i];
}

TEST(ImageFile, MetadataComesBackFromPngTiffAndExr) {
    const TemporaryDirectory folder;
    const std::map<std::string, std::string> metadata{{"relief:green", "up"},
                                                      {"relief:flat", "128"}};
    write_image(folder / "a.png", pattern<std::uint8_t>(4, 4, 3, ColorSpace::data), metadata);
    write_image(folder / "a.tif", pattern<std::uint16_t>(4, 4, 3, ColorSpace::data), metadata);
    write_image(folder / "a.exr", pattern<float>(4, 4, 3, ColorSpace::data), metadata);
    for (const char* name : {"a.png", "a.tif", "a.exr"}) {
        const ImageInfo info = read_image_info(folder / name);
        for (const auto& [key, value] : metadata)
            EXPECT_EQ(info.metadata.at(key), value) << name;
    }
    EXPECT_THAT(read_image_info(folder / "a.png").metadata, testing::ContainerEq(metadata));
}

TEST(ImageFile, InfoMatchesTheImage) {
    const TemporaryDirectory folder;
    write_image(folder / "a.png", pattern<std::uint16_t>(7, 5, 2, ColorSpace::data));
    const ImageInfo info = read_image_info(folder / "a.png");
    EXPECT_EQ(info.width, 7);
    EXPECT_EQ(info.height, 5);
    EXPECT_EQ(info.channels, 2);
    EXPECT_EQ(info.bits, 16);
    EXPECT_THAT(info.metadata, IsEmpty());
}

TEST(ImageFile, UnsupportedContentIsRefusedAndKeepsTheOldFile) {
    const TemporaryDirectory folder;
    const Image bytes = pattern<std::uint8_t>(4, 4, 3, ColorSpace::srgb);
    const Image alpha = pattern<std::uint8_t>(4, 4, 4, ColorSpace::srgb);
    const Image words = pattern<std::uint16_t>(4, 4, 3, ColorSpace::data);
    const Image floats = pattern<float>(4, 4, 3, ColorSpace::linear);
    const Image gray = pattern<float>(4, 4, 1, ColorSpace::linear);
    Image linear_bytes = bytes;
    linear_bytes.color_space = ColorSpace::linear;
    Image coded_floats = floats;
    coded_floats.color_space = ColorSpace::srgb;
    Image short_of_one = bytes;
    short_of_one.width = 5;
    const std::pair<const char*, const Image*> wrong[] = {
        {"a.png", &floats},       {"a.jpg", &floats},       {"a.jpg", &words},
        {"a.jpg", &alpha},        {"a.exr", &bytes},        {"a.hdr", &words},
        {"a.hdr", &gray},         {"a.png", &linear_bytes}, {"a.tif", &linear_bytes},
        {"a.exr", &coded_floats}, {"a.tif", &coded_floats}, {"a.png", &short_of_one}};
    for (const auto& [name, image] : wrong) {
        std::ofstream(folder / name) << "old";
        EXPECT_THROW(write_image(folder / name, *image), InvalidInput) << name;
        EXPECT_EQ(test::read_bytes(folder / name), "old") << name;
    }
    EXPECT_THROW(write_image(folder / "a.png", bytes, {{"", "x"}}), InvalidInput);
    EXPECT_THROW(write_image(folder / "a.png", bytes, {{std::string(80, 'k'), "x"}}), InvalidInput);
    EXPECT_THROW(write_image(folder / "a.gif", bytes), FileError);
    EXPECT_THROW(write_image(folder / "a", bytes), FileError);
    EXPECT_THROW(write_image(folder / "nowhere" / "a.png", bytes), FileError);
}

TEST(ImageFile, AFailingDiskLeavesTheOldFileAndNoHalfOne) {
    const TemporaryDirectory folder;
    const Image image = pattern<std::uint16_t>(200, 200, 3, ColorSpace::data);
    const Image floats = pattern<float>(200, 200, 3, ColorSpace::linear);
    const auto old_action = std::signal(SIGXFSZ, SIG_IGN);
    rlimit before{};
    ::getrlimit(RLIMIT_FSIZE, &before);
    for (const char* name : {"a.png", "a.tif", "a.exr", "a.hdr"}) {
        std::ofstream(folder / name) << "old";
        const bool holds_float = name == std::string("a.exr") || name == std::string("a.hdr");
        const rlimit small{20000, before.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &small);
        EXPECT_THROW(write_image(folder / name, holds_float ? floats : image), FileError) << name;
        ::setrlimit(RLIMIT_FSIZE, &before);
        EXPECT_EQ(test::read_bytes(folder / name), "old") << name;
    }
    std::signal(SIGXFSZ, old_action);
    const auto files = std::filesystem::directory_iterator(folder.path());
    EXPECT_EQ(std::distance(begin(files), end(files)), 4);
}

TEST(ImageFile, ReportsMissingFilesAndFolders) {
    const TemporaryDirectory folder;
    EXPECT_THAT(complaint_about_reading(folder / "none.png"), HasSubstr("no such file"));
    EXPECT_THAT(complaint_about_reading(folder.path()), HasSubstr("is not a file"));
    std::ofstream(folder / "empty.png").flush();
    EXPECT_THAT(complaint_about_reading(folder / "empty.png"), HasSubstr("is empty"));
}

/// Every truncation of a written file must be detected.
TEST(ImageFile, CutFilesAreErrorsInEveryFormat) {
    const TemporaryDirectory folder;
    const Image image = pattern<std::uint8_t>(40, 40, 3, ColorSpace::srgb);
    const Image floats = pattern<float>(40, 40, 3, ColorSpace::linear);
    for (const char* name : {"a.png", "a.jpg", "a.tif", "a.exr", "a.hdr"}) {
        const bool holds_float = name == std::string("a.exr") || name == std::string("a.hdr");
        write_image(folder / name, holds_float ? floats : image);
        const std::string whole = test::read_bytes(folder / name);
        for (const double share : {0.02, 0.3, 0.6, 0.9}) {
            const auto size = static_cast<std::size_t>(static_cast<double>(whole.size()) * share);
            std::ofstream(folder / name, std::ios::binary) << whole.substr(0, size);
            EXPECT_NE(complaint_about_reading(folder / name), "no error") << name << " " << share;
        }
    }
}

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
    append_chunk(file, "sRGB", std::string(1, '\0'));  // Too late to have an effect.
    return file;
}

TEST(ColorTag, ReadsTheFile) {
    EXPECT_EQ(tag_of(png_with("sRGB", std::string(1, '\0'))), "sRGB");
    EXPECT_EQ(tag_of(png_with("iCCP", "x")), "ICC profile");
    EXPECT_EQ(tag_of(png_with("gAMA", std::string("\0\0\xB1\x8F", 4))), "gamma 0.45455");
    EXPECT_EQ(tag_of(png_with("gAMA", std::string("\0\x01\x86\xA0", 4))), "");
    EXPECT_EQ(tag_of(png_with("tEXt", "a")), "");
}

TEST(ColorTag, IsEmptyForTruncatedAndOtherFiles) {
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

/// An image with edges and gentle slopes, written at an odd size.
std::string jpeg_file(int channels) {
    const test::TemporaryDirectory folder;
    Image image = make_image(37, 21, channels, 8, ColorSpace::srgb);
    std::size_t i = 0;
    for (std::uint8_t& sample : image.as<std::uint8_t>()) {
        sample = static_cast<std::uint8_t>(i / 5 % 37 < 11 ? 250 : i * 3 % 256);
        ++i;
    }
    write_image(folder / "a.jpg", image);
    return test::read_bytes(folder / "a.jpg");
}

TEST(PlainJpegs, GrayAndColoredReadAsTheModuleReadsThem) {
    for (const int channels : {1, 3}) {
        const std::string file = jpeg_file(channels);
        test::expect_same(directly(file), by_module(file), std::to_string(channels));
        EXPECT_EQ(directly(file)->channels, channels);
    }
}

TEST_LABELS(not_sanitized);
TEST(PlainJpegs, AmongRealFilesReadAsTheModuleReadsThem) {
    RELIEF_NEEDS_SHARED(data, "data");
    const test::Comparison comparison = test::compare_all(data, ".jpg");
    EXPECT_GT(comparison.direct, 10U);
    EXPECT_GT(comparison.direct, comparison.left);
}

TEST(PlainJpegs, CmykIsLeftToTheImageModule) {
    RELIEF_NEEDS_SHARED(file, "data/textures/decoder/jpg/magnum_cmyk.jpg");
    EXPECT_FALSE(directly(test::read_bytes(file)));
}

TEST(PlainJpegs, OneWhoseDataStopHalfwayIsLeftToTheImageModule) {
    const std::string whole = jpeg_file(3);
    const std::size_t scan = whole.find("\xFF\xDA");
    const std::string cut = whole.substr(0, (scan + whole.size()) / 2) + "\xFF\xD9";
    EXPECT_FALSE(directly(cut));
}

using namespace std::string_literals;

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

/// A chunk with a checksum of zeros, which this reader does not check.
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
    EXPECT_THAT(complaint_about("RIFF\4\0\0\0WAVE"s),
                HasSubstr("is not an image that relief reads"));
    EXPECT_THAT(complaint_about("hello"),
                HasSubstr("image: is not an image that relief reads: PNG"));
    EXPECT_THAT(complaint_about(""), HasSubstr("is empty"));
}

TEST(ImageContainer, PngKeepsOnlyChunksOfSamples) {
    const std::string kept = png_header(1, 1) + unchecked_chunk("PLTE", "abc");
    const std::string data =
        unchecked_chunk("tRNS", "a") + unchecked_chunk("IDAT", "12345") + png_end;
    const std::string file = png_start + kept + unchecked_chunk("gAMA", "1234") +
                             unchecked_chunk("iCCP", "profile") + unchecked_chunk("eXIf", "II*") +
                             data + "rest";
    EXPECT_EQ(stripped(file), png_start + kept + data);
}

TEST(ImageContainer, PngKeepsPlainText) {
    const ImageContainer container =
        examine(png_start + png_header(1, 1) + unchecked_chunk("tEXt", "relief:green\0up"s) +
                unchecked_chunk("iTXt", "Titel\0\0\0de\0Titel\0Vase"s) +
                unchecked_chunk("iTXt", "packed\0\1\0\0\0xyz"s) +
                unchecked_chunk("tEXt", "no zero") + unchecked_chunk("tEXt", "\0no key"s) +
                unchecked_chunk("iTXt", "cut\0\0"s) + unchecked_chunk("IDAT", "12345") + png_end);
    EXPECT_THAT(container.text, ElementsAre(Pair("Titel", "Vase"), Pair("relief:green", "up")));
}

TEST(ImageContainer, TruncatedPngIsRefusedWithTheOffset) {
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
    // 100 bytes of deflate hold at most 103,200 bytes. A row of 1000 gray samples has 1000.
    EXPECT_EQ(announcing(1000, 100, 8, 0), "no error");
    EXPECT_THAT(announcing(1000, 200, 8, 0), HasSubstr("announces 1000 x 200 texels, which its"));
    EXPECT_EQ(announcing(1000, 800, 1, 0), "no error");
    EXPECT_THAT(announcing(1000, 100, 16, 6), HasSubstr("cannot hold"));
    EXPECT_THAT(announcing(0xFFFFFFFF, 0xFFFFFFFF, 16, 6), HasSubstr("cannot hold"));
    EXPECT_THAT(announcing(0, 5, 8, 0), HasSubstr("is empty: 0 x 5 texels"));
    EXPECT_THAT(announcing(5, 5, 8, 1), HasSubstr("PNG has no color type 1"));
    EXPECT_THAT(complaint_about(png_start + unchecked_chunk("IDAT", "12345") + png_end),
                HasSubstr("has no IHDR chunk"));
}

TEST(ImageContainer, JpegLosesItsMetadataButKeepsHowColorsAreCoded) {
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

TEST(ImageContainer, TgaIsDetectedByNameOrFooter) {
    std::string header(18, '\0');
    header[2] = 2;   // True color without compression.
    header[12] = 2;  // Width.
    header[14] = 1;  // Height.
    header[16] = 24;
    EXPECT_STREQ(examine(header + "bgrbgr", "a.TGA").format, "targa");
    EXPECT_STREQ(examine(header + "bgrbgr" + "TRUEVISION-XFILE.\0"s).format, "targa");
    EXPECT_THAT(complaint_about(header + "bgrbgr", "a.png"), HasSubstr("is not an image"));
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

/// Restores the limits of the process.
class InputLimitsTest : public testing::Test {
  protected:
    ~InputLimitsTest() override { set_input_limits({}); }
    TemporaryDirectory folder_;
};

TEST_F(InputLimitsTest, AreThreeQuartersOfTheMemoryAtMost) {
    set_input_limits({});
    const std::uint64_t pages = static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES));
    const std::uint64_t all = pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
    EXPECT_LE(input_limits().memory, all / 4 * 3);
    EXPECT_GT(input_limits().memory, 0U);
    EXPECT_EQ(input_limits().pixels, 0U);
}

TEST_F(InputLimitsTest, RefuseLargeImagesBeforeDecoding) {
    const std::filesystem::path png = folder_ / "a.png";
    const std::filesystem::path jpeg = folder_ / "a.jpg";
    const std::filesystem::path exr = folder_ / "a.exr";
    write_image(png, make_image(2000, 1000, 3, 8, ColorSpace::data));
    write_image(jpeg, make_image(2000, 1000, 3, 8, ColorSpace::srgb));
    write_image(exr, make_image(2000, 1000, 3, 32, ColorSpace::linear));
    const auto refusal = [](const std::filesystem::path& file) {
        return message_of<FileError>([&] { read_image(file, ImageUse::data); });
    };
    set_input_limits({6'000'000, 2'000'000, false});
    EXPECT_EQ(read_image(png, ImageUse::data).width, 2000);
    EXPECT_EQ(read_image(jpeg, ImageUse::data).width, 2000);
    // 2000 x 1000 x 3 floats.
    EXPECT_THAT(refusal(exr), HasSubstr("a.exr: needs 22.9 MiB of memory, but the limit is 5.7"));
    set_input_limits({5'999'999, 0, false});
    EXPECT_THAT(refusal(png), HasSubstr("a.png: needs 5.7 MiB of memory, but the limit is 5.7"));
    EXPECT_THAT(refusal(jpeg), HasSubstr("a.jpg: needs 5.7 MiB of memory"));
    set_input_limits({0, 1'999'999, false});
    for (const auto& file : {png, jpeg, exr})
        EXPECT_THAT(refusal(file), HasSubstr("has 2000 x 1000 texels, but the limit is 1999999"));
}

TEST_F(InputLimitsTest, CountOneRowOfImagesThatAreReadByRows) {
    const std::filesystem::path exr = folder_ / "a.exr";
    write_image(exr, make_image(1000, 2000, 1, 32, ColorSpace::linear));
    const std::filesystem::path png = folder_ / "a.png";
    write_image(png, make_image(1000, 2000, 1, 16, ColorSpace::data));
    set_input_limits({1'000'000, 0, false});
    EXPECT_EQ(ImageRowReader(png).info().height, 2000);
    set_input_limits({1999, 0, false});
    EXPECT_THAT(message_of<FileError>([&] { ImageRowReader{png}; }),
                HasSubstr("needs 0.0 MiB of memory"));
    set_input_limits({0, 1'999'999, false});
    EXPECT_THAT(message_of<FileError>([&] { ImageRowReader{png}; }),
                HasSubstr("has 1000 x 2000 texels"));
    EXPECT_THAT(message_of<FileError>([&] { ImageRowReader{exr}; }),
                HasSubstr("has 1000 x 2000 texels"));
}

TEST_F(InputLimitsTest, HoldForImagesThatAreMadeAndForFiles) {
    set_input_limits({1'000'000, 0, false});
    EXPECT_EQ(make_image(1000, 1000, 1, 8, ColorSpace::data).height, 1000);
    EXPECT_EQ(message_of<InvalidInput>([] { make_image(1001, 1000, 1, 8, ColorSpace::data); }),
              "needs 1.0 MiB of memory, but the limit is 1.0");
    const std::filesystem::path large = folder_ / "large.png";
    std::ofstream(large).close();
    std::filesystem::resize_file(large, 1'000'001);
    EXPECT_THAT(message_of<FileError>([&] { read_image_info(large); }),
                HasSubstr("needs 1.0 MiB of memory"));
}

}  // namespace
}  // namespace relief
