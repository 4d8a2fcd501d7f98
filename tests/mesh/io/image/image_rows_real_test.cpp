// SPDX-License-Identifier: Apache-2.0
// Files of other people's making, whole and damaged: read by rows they give what reading them whole
// from memory gives, samples or error, word for word.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "io/png/deflate.h"
#include "io/png/png_chunk.h"
#include "module_reference.h"
#include "relief/mesh/error.h"
#include "relief/mesh/image_rows.h"
#include "support/shared_data.h"

namespace relief {
namespace {

using test::contents_of;

/// An image's samples, or why there are none.
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
        const std::string bytes = contents_of(file);
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

/// How many of the files below a folder were images.
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
    EXPECT_EQ(compare_all(folder), 6);
}

// ---------------------------------------------------------------------------------------------
// Damage on the way

/// A PNG of several chunks and bands, 3 MB of noise.
std::string noisy_png(const std::filesystem::path& file) {
    Image image = make_image(1000, 500, 3, 16, ColorSpace::data);
    std::uint32_t state = 1;
    for (std::uint16_t& sample : image.as<std::uint16_t>()) {
        state = state * 1664525U + 1013904223U;
        sample = static_cast<std::uint16_t>(state >> 12);
    }
    write_image(file, image);
    return contents_of(file);
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

/// A PNG of grey bytes with this stream.
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

TEST(ImageRowsDamaged, CutTiffAndExrFilesFailByRowsAsTheyDoWhole) {
    const test::TemporaryDirectory folder;
    Image words = make_image(300, 900, 3, 16, ColorSpace::data);
    Image floats = make_image(300, 900, 3, 32, ColorSpace::data);
    for (std::size_t at = 0; at < words.sample_count(); ++at) {
        words.as<std::uint16_t>()[at] = static_cast<std::uint16_t>(at * at * 7919 >> 5);
        floats.as<float>()[at] = static_cast<float>(words.as<std::uint16_t>()[at]);
    }
    for (const char* name : {"a.tif", "a.exr"}) {
        write_image(folder / name, name == std::string("a.tif") ? words : floats);
        const std::string whole = contents_of(folder / name);
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

// ---------------------------------------------------------------------------------------------
// Tiles

/// A TIFF of 40 x 50 grey bytes in tiles of 16 x 16, not compressed.
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
    entry(259, 3, 1, 1);  // Not compressed.
    entry(262, 3, 1, 1);  // Grey.
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

TEST(ImageRows, OfATiledTiffComeInOrder) {
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

TEST(ImageRows, WhatCannotBeReadByRowsSaysSo) {
    RELIEF_NEEDS_SHARED(decoder, "data/textures/decoder");
    EXPECT_FALSE(ImageRowReader(decoder / "png/basi0g16.png").is_streamed()) << "interlaced";
    EXPECT_FALSE(ImageRowReader(decoder / "jpg/magnum_rgb.jpg").is_streamed());
    EXPECT_TRUE(ImageRowReader(decoder / "png/basn2c16.png").is_streamed());
    EXPECT_TRUE(ImageRowReader(decoder / "exr/rgb16f-tiled.exr").is_streamed());
}

}  // namespace
}  // namespace relief
