// SPDX-License-Identifier: Apache-2.0
// Real and broken image files, read as a whole and by rows: an image or a FileError that names the
// file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <chrono>
#include <fstream>
#include <sstream>

#include "io/image/image_module_client.h"
#include "io/png/png_format.h"
#include "mesh/io/image/module_reference.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/report.h"
#include "support/images.h"
#include "support/labels.h"
#include "support/peak_memory.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::detail;

namespace {

using test::read_bytes;
using test::samples_of;
using testing::ElementsAre;
using testing::ElementsAreArray;

/// Returns size, channels and bits of an image in one line.
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
    // Palettes become RGB, and with transparent entries RGB and alpha.
    EXPECT_EQ(shape_of(read_data(png / "magnum_rgb-palette1.png")), "256 x 256 x 3, 8");
    EXPECT_EQ(shape_of(read_data(png / "tm3n3p02.png")), "32 x 32 x 4, 8");
    EXPECT_EQ(shape_of(read_data(png / "tbrn2c08.png")), "32 x 32 x 4, 8");
}

TEST(ImageFileReal, FourBitsUseTheFullRange) {
    RELIEF_NEEDS_SHARED(png, "data/textures/decoder/png");
    EXPECT_THAT(samples_of<std::uint8_t>(read_data(png / "magnum_gray4.png")),
                ElementsAre(0x88, 0x00, 0xFF, 0xFF, 0x88, 0x00));
}

TEST(ImageFileReal, SixteenBitSamplesArriveExactly) {
    RELIEF_NEEDS_SHARED(png, "data/textures/decoder/png");
    EXPECT_THAT(samples_of<std::uint16_t>(read_data(png / "magnum_gray16.png")),
                ElementsAre(5000, 6000, 3000, 4000, 1000, 2000));
}

TEST(ImageFileReal, ColorTagsChangeNoSample) {
    RELIEF_NEEDS_SHARED(png, "data/textures/decoder/png");
    // The same picture with an sRGB chunk, and as linear with a gAMA chunk of 1.
    EXPECT_EQ(read_data(png / "magnum_rgba-srgb.png").samples,
              read_data(png / "magnum_rgba-linear.png").samples);
    // This depth map has a gray ICC profile.
    RELIEF_NEEDS_SHARED(cube, "data/textures/parallax_cube_bevy/cube_depth.png");
    EXPECT_EQ(shape_of(read_data(cube)), "348 x 348 x 1, 8");
}

TEST(ImageFileReal, CmykJpegMatchesItsRgbVersion) {
    RELIEF_NEEDS_SHARED(jpg, "data/textures/decoder/jpg");
    const Image cmyk = read_data(jpg / "magnum_cmyk.jpg");
    const Image rgb = read_data(jpg / "magnum_rgb.jpg");
    ASSERT_EQ(shape_of(cmyk), shape_of(rgb));
    for (std::size_t at = 0; at < rgb.sample_count(); ++at)
        EXPECT_NEAR(cmyk.as<std::uint8_t>()[at], rgb.as<std::uint8_t>()[at], 2);
}

TEST(ImageFileReal, ExrReturnsItsDataWindow) {
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
    // A half has 11 significant bits: the 13 lowest bits of a float stay zero.
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
    // OpenImageIO does not read the old run-length coding: an error, never half a picture.
    EXPECT_THROW(read_data(hdr / "old-rle.hdr"), FileError);
}

/// The outcome for a file. A crash ends the test program, which is also a failure.
struct FileOutcome {
    bool error = false;   ///< True for a FileError, false for an image.
    std::string printed;  ///< Output to stdout or stderr.
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

TEST_LABELS(alone);
TEST(ImageFileBroken, EveryHostileFileEndsInAnErrorOrAnImage) {
    RELIEF_NEEDS_SHARED(folder, "data/broken/image");
    image_module("the memory that it takes");  // The measurement excludes the module.
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
    // Images with hostile metadata, and one with a fault after its samples.
    EXPECT_THAT(images,
                ElementsAre("corrupt-xmp-deep-nesting.jpg", "crash-5158.bmp", "exif-utf8-type.png",
                            "this_is_png.jpg", "xmp-list-blowup.png"));
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

/// The samples of an image, or the reason for their absence.
struct ReadRows {
    std::string error;
    std::string shape;
    std::vector<std::byte> samples;
    int rows_read = 0;

    friend bool operator==(const ReadRows& a, const ReadRows& b) {
        return a.error == b.error && a.shape == b.shape && a.samples == b.samples;
    }
};

std::string shape_of(int width, int height, int channels, int bits) {
    return std::to_string(width) + " x " + std::to_string(height) + " x " +
           std::to_string(channels) + ", " + std::to_string(bits);
}

ReadRows read_whole(const std::filesystem::path& file) {
    ReadRows outcome;
    try {
        const std::string bytes = read_bytes(file);
        const Image image =
            read_image(std::as_bytes(std::span(bytes)), file.string(), ImageUse::data);
        outcome.shape = shape_of(image.width, image.height, image.channels, image.bits());
        std::visit(
            [&](const auto& all) {
                const auto held = std::as_bytes(std::span(all));
                outcome.samples.assign(held.begin(), held.end());
            },
            image.samples);
    } catch (const FileError& error) {
        outcome.error = error.what();
    }
    return outcome;
}

ReadRows read_by_rows(const std::filesystem::path& file) {
    ReadRows outcome;
    try {
        ImageRowReader reader(file);
        const ImageInfo& info = reader.info();
        std::vector<std::byte> samples(reader.row_bytes() * static_cast<std::size_t>(info.height));
        for (int y = 0; y < info.height; ++y) {
            reader.read(std::span(samples).subspan(static_cast<std::size_t>(y) * reader.row_bytes(),
                                                   reader.row_bytes()));
            ++outcome.rows_read;
        }
        outcome.shape = shape_of(info.width, info.height, info.channels, info.bits);
        outcome.samples = std::move(samples);
    } catch (const FileError& error) {
        outcome.error = error.what();
    }
    return outcome;
}

/// Compares all files below a folder and returns the number of images.
int compare_all(const std::filesystem::path& folder) {
    int images = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (!entry.is_regular_file()) continue;
        const ReadRows whole = read_whole(entry.path());
        const ReadRows by_rows = read_by_rows(entry.path());
        EXPECT_EQ(by_rows.error, whole.error);
        EXPECT_TRUE(by_rows == whole) << entry.path();
        if (whole.error.empty()) ++images;
    }
    return images;
}

TEST(ImageRowsReal, EveryRealFileReadsTheSame) {
    RELIEF_NEEDS_SHARED(folder, "data/textures");
    EXPECT_GT(compare_all(folder), 50);
}

TEST(ImageRowsReal, EveryBrokenFileIsTheSameErrorOrImage) {
    RELIEF_NEEDS_SHARED(folder, "data/broken/image");
    EXPECT_EQ(compare_all(folder), 5);
}

/// A PNG of several chunks and bands with 3 MB of noise.
std::string noisy_png(const std::filesystem::path& file) {
    Image image = make_image(1000, 500, 3, 16, ColorSpace::data);
    std::uint32_t state = 1;
    for (std::uint16_t& sample : image.as<std::uint16_t>()) {
        state = state * 1664525U + 1013904223U;
        sample = static_cast<std::uint16_t>(state >> 12);
    }
    write_image(file, image);
    return read_bytes(file);
}

void replace(const std::filesystem::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
}

TEST(ImageRowsDamaged, AWrongBitOrAMissingEndIsTheSameErrorAfterTheRowsBeforeIt) {
    const test::TemporaryDirectory folder;
    const std::filesystem::path file = folder / "a.png";
    const std::string whole = noisy_png(file);
    EXPECT_EQ(read_by_rows(file).rows_read, 500);
    std::string changed = whole;
    changed[whole.size() * 3 / 4] ^= 1;
    replace(file, changed);
    const ReadRows outcome = read_by_rows(file);
    EXPECT_EQ(outcome.error, read_whole(file).error);
    EXPECT_THAT(outcome.error, testing::HasSubstr("damaged"));
    EXPECT_GT(outcome.rows_read, 100) << "rows before the damage are good";
    EXPECT_LT(outcome.rows_read, 400);
    replace(file, whole.substr(0, whole.size() / 2));
    EXPECT_EQ(read_by_rows(file).error, read_whole(file).error);
    EXPECT_EQ(read_by_rows(file).rows_read, 0) << "noticed on opening";
}

/// A PNG of gray bytes with this stream.
std::string png_of(std::uint32_t width, std::uint32_t height, const std::string& stream) {
    std::string header;
    append_big32(header, width);
    append_big32(header, height);
    std::string file = "\x89PNG\r\n\x1A\n";
    append_chunk(file, "IHDR", header + std::string("\x08\0\0\0\0", 5));
    append_chunk(file, "IDAT", stream);
    append_chunk(file, "IEND", "");
    return file;
}

TEST(ImageRowsDamaged, AStreamThatIsTooShortTooLongOrHasAWrongSumIsJudgedAlike) {
    const test::TemporaryDirectory folder;
    const std::filesystem::path file = folder / "a.png";
    const std::string rows(101 * 50, '\0');
    const std::string good = test::zlib_stream(rows);
    std::string wrong_sum = good;
    wrong_sum.back() ^= 1;
    std::string wrong_filter = rows;
    wrong_filter[101 * 49] = 9;
    const std::string streams[] = {good,
                                   wrong_sum,
                                   test::zlib_stream(rows.substr(0, 101 * 49)),
                                   test::zlib_stream(rows + rows),
                                   good.substr(0, good.size() - 4),
                                   good + "behind",
                                   test::zlib_stream(wrong_filter),
                                   ""};
    for (const std::string& stream : streams) {
        replace(file, png_of(100, 50, stream));
        const ReadRows whole = read_whole(file);
        const ReadRows by_rows = read_by_rows(file);
        EXPECT_EQ(by_rows.error, whole.error);
        EXPECT_TRUE(by_rows == whole) << "stream " << &stream - streams;
    }
    replace(file, png_of(100, 50, good));
    EXPECT_EQ(read_by_rows(file).rows_read, 50);
}

TEST(ImageRowsDamaged, TruncatedTiffAndExrFailAsWholeImages) {
    const test::TemporaryDirectory folder;
    Image words = make_image(300, 900, 3, 16, ColorSpace::data);
    Image floats = make_image(300, 900, 3, 32, ColorSpace::data);
    for (std::size_t at = 0; at < words.sample_count(); ++at) {
        words.as<std::uint16_t>()[at] = static_cast<std::uint16_t>(at * at * 7919 >> 5);
        floats.as<float>()[at] = static_cast<float>(words.as<std::uint16_t>()[at]);
    }
    for (const char* name : {"a.tif", "a.exr"}) {
        write_image(folder / name, name == std::string("a.tif") ? words : floats);
        const std::string whole = read_bytes(folder / name);
        for (const std::size_t tenths : {1U, 5U, 9U}) {
            replace(folder / name, whole.substr(0, whole.size() * tenths / 10));
            const ReadRows outcome = read_by_rows(folder / name);
            EXPECT_NE(outcome.error, "") << name;
            EXPECT_EQ(outcome.error, read_whole(folder / name).error);
        }
    }
}

TEST(ImageRowsDamaged, AnErrorWhileRowsGoFromFileToFileLeavesNoOutput) {
    const test::TemporaryDirectory folder;
    std::string changed = noisy_png(folder / "a.png");
    changed[changed.size() / 2] ^= 1;
    replace(folder / "a.png", changed);
    const auto copy = [&] {
        ImageRowReader reader(folder / "a.png");
        ImageRowWriter writer(folder / "b.png", {1000, 500, 3, 16, ColorSpace::data});
        std::vector<std::byte> row(reader.row_bytes());
        for (int y = 0; y < 500; ++y) {
            reader.read(row);
            writer.write(row);
        }
        writer.finish();
    };
    EXPECT_THROW(copy(), FileError);
    const auto files = std::filesystem::directory_iterator(folder.path());
    EXPECT_EQ(std::distance(begin(files), end(files)), 1);
}

/// An uncompressed TIFF of 40 x 50 gray bytes in tiles of 16 x 16.
std::string tiled_tiff(const std::vector<std::uint8_t>& samples) {
    constexpr std::uint32_t width = 40, height = 50, tile = 16, across = 3, down = 4;
    constexpr std::uint32_t entries = 10,
                            data_at = 8 + 2 + entries * 12 + 4 + 2 * 4 * across * down;
    std::string file("II*\0\x08\0\0\0", 8);
    const auto little = [&](std::uint32_t value, int bytes) {
        for (int i = 0; i < bytes; ++i)
            file += static_cast<char>(value >> (8 * i));
    };
    const auto entry = [&](std::uint32_t tag, std::uint32_t type, std::uint32_t count,
                           std::uint32_t value) {
        little(tag, 2);
        little(type, 2);
        little(count, 4);
        little(value, 4);
    };
    little(entries, 2);
    entry(256, 3, 1, width);
    entry(257, 3, 1, height);
    entry(258, 3, 1, 8);
    entry(259, 3, 1, 1);  // No compression.
    entry(262, 3, 1, 1);  // Gray.
    entry(277, 3, 1, 1);
    entry(322, 3, 1, tile);
    entry(323, 3, 1, tile);
    entry(324, 4, across * down, data_at - 2 * 4 * across * down);
    entry(325, 4, across * down, data_at - 4 * across * down);
    little(0, 4);
    for (std::uint32_t i = 0; i < across * down; ++i)
        little(data_at + i * tile * tile, 4);
    for (std::uint32_t i = 0; i < across * down; ++i)
        little(tile * tile, 4);
    for (std::uint32_t i = 0; i < across * down * tile * tile; ++i) {
        const std::uint32_t x = i / (tile * tile) % across * tile + i % tile;
        const std::uint32_t y = i / (tile * tile) / across * tile + i / tile % tile;
        file += static_cast<char>(x < width && y < height ? samples[y * width + x] : 0);
    }
    return file;
}

TEST(ImageRows, TiledTiffYieldsRowsInOrder) {
    const test::TemporaryDirectory folder;
    std::vector<std::uint8_t> samples(40 * 50);
    for (std::size_t i = 0; i < samples.size(); ++i)
        samples[i] = static_cast<std::uint8_t>(i * i >> 3);
    replace(folder / "a.tif", tiled_tiff(samples));
    ImageRowReader reader(folder / "a.tif");
    EXPECT_TRUE(reader.is_streamed());
    reader.skip(5);
    std::vector<std::uint8_t> rows(40 * 30);
    reader.read(std::as_writable_bytes(std::span(rows)));
    EXPECT_TRUE(std::equal(rows.begin(), rows.end(), samples.begin() + 5 * 40));
    EXPECT_TRUE(read_by_rows(folder / "a.tif") == read_whole(folder / "a.tif"));
}

TEST(ImageRows, ReportsFormatsWithoutRows) {
    RELIEF_NEEDS_SHARED(decoder, "data/textures/decoder");
    EXPECT_FALSE(ImageRowReader(decoder / "png/basi0g16.png").is_streamed()) << "interlaced";
    EXPECT_FALSE(ImageRowReader(decoder / "jpg/magnum_rgb.jpg").is_streamed());
    EXPECT_TRUE(ImageRowReader(decoder / "png/basn2c16.png").is_streamed());
    EXPECT_TRUE(ImageRowReader(decoder / "exr/rgb16f-tiled.exr").is_streamed());
}

}  // namespace

}  // namespace relief
