// SPDX-License-Identifier: Apache-2.0
// Image files of other people's making: sample types, palettes, windows, tags; and hostile ones,
// which must end in an error or an image, quickly and without much memory.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <chrono>
#include <fstream>
#include <sstream>

#include "io/image/image_file_module.h"
#include "relief/mesh/error.h"
#include "relief/mesh/image_file.h"
#include "support/peak_memory.h"
#include "support/samples.h"
#include "support/shared_data.h"

namespace relief {
namespace {

using test::samples_of;
using testing::ElementsAre;
using testing::ElementsAreArray;

/// Size, channels and bits of an image in one line.
std::string shape_of(const Image& image) {
    std::ostringstream text;
    text << image.width << " x " << image.height << " x " << image.channels << ", " << image.bits();
    return text.str();
}

Image read_data(const std::filesystem::path& file) {
    return read_image(file, ImageUse::data);
}

TEST(ImageFileReal, PngOfEverySampleTypeHasTheShapeThatTheHeaderPromises) {
    RELIEF_NEEDS_SHARED(png, "data/textures/decoder/png");
    EXPECT_EQ(shape_of(read_data(png / "basi0g16.png")), "32 x 32 x 1, 16");
    EXPECT_EQ(shape_of(read_data(png / "basn2c16.png")), "32 x 32 x 3, 16");
    EXPECT_EQ(shape_of(read_data(png / "basn6a16.png")), "32 x 32 x 4, 16");
    EXPECT_EQ(shape_of(read_data(png / "magnum_ga.png")), "3 x 2 x 2, 8");
    // Palettes become RGB, with transparent entries RGB and alpha.
    EXPECT_EQ(shape_of(read_data(png / "magnum_rgb-palette1.png")), "256 x 256 x 3, 8");
    EXPECT_EQ(shape_of(read_data(png / "tm3n3p02.png")), "32 x 32 x 4, 8");
    EXPECT_EQ(shape_of(read_data(png / "tbrn2c08.png")), "32 x 32 x 4, 8");
}

TEST(ImageFileReal, FourBitsWidenOverTheWholeRange) {
    RELIEF_NEEDS_SHARED(png, "data/textures/decoder/png");
    EXPECT_THAT(samples_of<std::uint8_t>(read_data(png / "magnum_gray4.png")),
                ElementsAre(0x88, 0x00, 0xFF, 0xFF, 0x88, 0x00));
}

TEST(ImageFileReal, SixteenBitSamplesArriveExactly) {
    RELIEF_NEEDS_SHARED(png, "data/textures/decoder/png");
    EXPECT_THAT(samples_of<std::uint16_t>(read_data(png / "magnum_gray16.png")),
                ElementsAre(5000, 6000, 3000, 4000, 1000, 2000));
}

TEST(ImageFileReal, ColourTagsOfAFileChangeNoSample) {
    RELIEF_NEEDS_SHARED(png, "data/textures/decoder/png");
    // The same picture with an sRGB chunk, and as linear with a gAMA chunk of 1.
    EXPECT_EQ(read_data(png / "magnum_rgba-srgb.png").samples,
              read_data(png / "magnum_rgba-linear.png").samples);
    // A grey ICC profile hangs on this depth map.
    RELIEF_NEEDS_SHARED(cube, "data/textures/parallax_cube_bevy/cube_depth.png");
    EXPECT_EQ(shape_of(read_data(cube)), "348 x 348 x 1, 8");
}

TEST(ImageFileReal, CmykJpegBecomesTheColoursOfItsRgbTwin) {
    RELIEF_NEEDS_SHARED(jpg, "data/textures/decoder/jpg");
    const Image cmyk = read_data(jpg / "magnum_cmyk.jpg");
    const Image rgb = read_data(jpg / "magnum_rgb.jpg");
    ASSERT_EQ(shape_of(cmyk), shape_of(rgb));
    for (std::size_t at = 0; at < rgb.sample_count(); ++at)
        EXPECT_NEAR(cmyk.as<std::uint8_t>()[at], rgb.as<std::uint8_t>()[at], 2);
}

TEST(ImageFileReal, ExrGivesItsDataWindowWhereverThatLies) {
    RELIEF_NEEDS_SHARED(exr, "data/textures/decoder/exr");
    const Image plain = read_data(exr / "rgb16f.exr");
    EXPECT_THAT(plain.as<float>(), ElementsAre(6, 7, 8, 3, 4, 5, 0, 1, 2));
    for (const char* name : {"rgb16f-custom-windows.exr", "rgb16f-tiled.exr", "rgb16f-ripmap.exr"})
        EXPECT_EQ(read_data(exr / name).samples, plain.samples) << name;
}

TEST(ImageFileReal, ExrIntegersAreDividedByTheirMaximum) {
    RELIEF_NEEDS_SHARED(file, "data/textures/decoder/exr/rg32ui.exr");
    const Image image = read_data(file);
    EXPECT_EQ(shape_of(image), "2 x 2 x 2, 32");
    EXPECT_FLOAT_EQ(image.as<float>()[0], 21845.0F / 4294967295.0F);
}

TEST(ImageFileReal, HalfFloatsArriveExactlyAsFloats) {
    RELIEF_NEEDS_SHARED(file, "data/textures/oiio_bump_normal/normal.exr");
    const Image image = read_data(file);
    EXPECT_EQ(shape_of(image), "128 x 128 x 3, 32");
    // A half has 11 significant bits: the 13 lowest of a float stay zero.
    for (const float sample : image.as<float>())
        ASSERT_EQ(std::bit_cast<std::uint32_t>(sample) & 0x1FFFU, 0U);
}

TEST(ImageFileReal, TheContentDecidesNotTheName) {
    RELIEF_NEEDS_SHARED(file, "data/broken/image/draco/this_is_png.jpg");
    EXPECT_EQ(shape_of(read_data(file)), "256 x 256 x 3, 8");
}

TEST(ImageFileReal, HdrOfTheUsualCodingsIsRead) {
    RELIEF_NEEDS_SHARED(hdr, "data/env/hdr-decoder");
    EXPECT_EQ(shape_of(read_data(hdr / "rgbr4x4.hdr")), "4 x 4 x 3, 32");
    EXPECT_EQ(shape_of(read_data(hdr / "image1.hdr")), "128 x 85 x 3, 32");
    // OpenImageIO knows no old run-length coding: an error, never half a picture.
    EXPECT_THROW(read_data(hdr / "old-rle.hdr"), FileError);
}

// ---------------------------------------------------------------------------------------------

/// What became of a file. A crash would end the test program, and that is a failure as well.
struct FileOutcome {
    bool error = false;   ///< A FileError; otherwise an image.
    std::string printed;  ///< What somebody wrote to stdout or stderr.
    double seconds = 0.0;
};

FileOutcome outcome_of(const std::filesystem::path& file) {
    FileOutcome outcome;
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const auto start = std::chrono::steady_clock::now();
    try {
        read_data(file);
    } catch (const FileError&) {
        outcome.error = true;
    }
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    outcome.seconds = time.count();
    outcome.printed =
        testing::internal::GetCapturedStderr() + testing::internal::GetCapturedStdout();
    return outcome;
}

TEST(ImageFileBroken, EveryHostileFileEndsInAnErrorOrAnImage) {
    RELIEF_NEEDS_SHARED(folder, "data/broken/image");
    image_module("the memory that it takes");  // Is not what is measured.
    const double peak_before = test::peak_megabytes();
    std::vector<std::string> images;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (!entry.is_regular_file()) continue;
        const FileOutcome outcome = outcome_of(entry.path());
        EXPECT_EQ(outcome.printed, "") << entry.path();
        EXPECT_LT(outcome.seconds, 5.0) << entry.path();
        EXPECT_LT(test::peak_megabytes() - peak_before, 100.0) << entry.path();
        if (!outcome.error) images.push_back(entry.path().filename().string());
    }
    std::sort(images.begin(), images.end());
    // Whole pictures with hostile extras, and two whose faults lie beyond their samples.
    EXPECT_THAT(images,
                ElementsAre("corrupt-xmp-deep-nesting.jpg", "crash-5158.bmp", "crash1708.tga",
                            "exif-utf8-type.png", "this_is_png.jpg", "xmp-list-blowup.png"));
}

/// Bytes of small real files, changed one at a time.
TEST(ImageFileBroken, AChangedByteAnywhereEndsInAnErrorOrAnImage) {
    RELIEF_NEEDS_SHARED(folder, "data/textures/decoder");
    const test::TemporaryDirectory temporary;
    for (const char* name : {"png/basn6a16.png", "png/tbgn3p08.png", "jpg/magnum_rgb.jpg",
                             "exr/rgb16f.exr", "exr/rgb16f-tiled.exr", "tga/magnum_rgb.tga"}) {
        std::ifstream stream(folder / name, std::ios::binary);
        const std::string whole{std::istreambuf_iterator<char>(stream), {}};
        for (std::size_t trial = 0; trial < 12; ++trial) {
            std::string changed = whole;
            changed[trial * (whole.size() - 1) / 11] ^= static_cast<char>(1 << (trial % 8));
            const std::filesystem::path file = temporary / std::filesystem::path(name).filename();
            std::ofstream(file, std::ios::binary) << changed;
            EXPECT_EQ(outcome_of(file).printed, "") << name << " " << trial;
        }
    }
}

}  // namespace
}  // namespace relief
