// SPDX-License-Identifier: Apache-2.0
// Images read and written by rows have the same samples and errors as whole images, for every
// division into rows.
#include "relief/mesh/image_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <fstream>
#include <limits>

#include "mesh/io/image/module_reference.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/report.h"
#include "support/invariants.h"
#include "support/labels.h"
#include "support/sanitized.h"
#include "support/shared_data.h"

namespace relief {
namespace {

using test::read_bytes;
using test::TemporaryDirectory;
using testing::HasSubstr;

using Bytes = std::vector<std::byte>;

/// Pseudorandom codes.
Bytes pattern(const ImageShape& shape) {
    const std::size_t count = static_cast<std::size_t>(shape.width) *
                              static_cast<std::size_t>(shape.height) *
                              static_cast<std::size_t>(shape.channels);
    Bytes bytes;
    std::uint32_t state = 7;
    for (std::size_t i = 0; i < count; ++i) {
        state = state * 1664525U + 1013904223U;
        const std::uint32_t bits =
            shape.bits == 32
                ? std::bit_cast<std::uint32_t>(std::ldexp(static_cast<float>(state >> 8), -20))
                : state >> 13;
        for (int at = 0; at < shape.bits; at += 8)
            bytes.push_back(static_cast<std::byte>(bits >> at));
    }
    return bytes;
}

Bytes bytes_of_samples(const Image& image) {
    return std::visit(
        [](const auto& all) {
            const auto bytes = std::as_bytes(std::span(all));
            return Bytes(bytes.begin(), bytes.end());
        },
        image.samples);
}

/// Writes 1 row, then 2, then 3, ...
void write_in_pieces(const std::filesystem::path& file, const ImageShape& shape,
                     const Bytes& samples, const ImageWriteOptions& options = {}) {
    ImageRowWriter writer(file, shape, {{"relief:content", "test"}}, options);
    std::size_t at = 0;
    for (std::size_t rows = 1; at < samples.size(); ++rows) {
        const std::size_t size = std::min(rows * writer.row_bytes(), samples.size() - at);
        writer.write(std::span(samples).subspan(at, size));
        at += size;
    }
    writer.finish();
}

/// Reads `rows` at a time, or the remaining ones.
Bytes read_in_pieces(const std::filesystem::path& file, int rows) {
    ImageRowReader reader(file);
    Bytes samples(reader.row_bytes() * static_cast<std::size_t>(reader.info().height));
    while (reader.next_row() < reader.info().height) {
        const auto first = static_cast<std::size_t>(reader.next_row()) * reader.row_bytes();
        const auto count = std::min(rows, reader.info().height - reader.next_row());
        reader.read(std::span(samples).subspan(
            first, static_cast<std::size_t>(count) * reader.row_bytes()));
    }
    return samples;
}

struct Kind {
    const char* name;
    int bits;
};
constexpr Kind exact_kinds[] = {{"a.png", 8},  {"a.png", 16}, {"a.tif", 8},
                                {"a.tif", 16}, {"a.tif", 32}, {"a.exr", 32}};

TEST(ImageRows, EverySampleArrivesHoweverTheRowsAreCut) {
    const TemporaryDirectory folder;
    for (const Kind kind : exact_kinds) {
        for (const auto& [width, height] :
             {std::pair{1, 1}, {3, 17}, {1, 50}, {50, 1}, {31, 130}}) {
            for (int channels = 1; channels <= 4; ++channels) {
                const ImageShape shape{width, height, channels, kind.bits, ColorSpace::data};
                const Bytes samples = pattern(shape);
                write_in_pieces(folder / kind.name, shape, samples);
                EXPECT_TRUE(bytes_of_samples(read_image(folder / kind.name, ImageUse::data)) ==
                            samples);
                for (const int rows : {1, 7, 1000})
                    EXPECT_TRUE(read_in_pieces(folder / kind.name, rows) == samples) << kind.name;
                EXPECT_EQ(ImageRowReader(folder / kind.name).info().metadata.at("relief:content"),
                          "test");
            }
        }
    }
}

TEST(ImageRows, WholeImagesAndRowsGiveTheSameFile) {
    const TemporaryDirectory folder;
    for (const Kind kind : exact_kinds) {
        const ImageShape shape{700, test::is_sanitized ? 100 : 300, 3, kind.bits, ColorSpace::data};
        const Bytes samples = pattern(shape);
        write_in_pieces(folder / kind.name, shape, samples);
        const std::string by_rows = read_bytes(folder / kind.name);
        write_image(folder / kind.name, read_image(folder / kind.name, ImageUse::data),
                    {{"relief:content", "test"}});
        EXPECT_TRUE(read_bytes(folder / kind.name) == by_rows) << kind.name;
    }
}

/// 5 MB of rising and falling slopes with noise: several pieces, some with repetitions.
Bytes smooth_text(const ImageShape& shape) {
    Bytes bytes;
    std::uint32_t state = 3;
    for (int y = 0; y < shape.height; ++y) {
        for (int i = 0; i < shape.width * shape.channels; ++i) {
            state = state * 1664525U + 1013904223U;
            const int noise = y < shape.height / 2 ? static_cast<int>(state >> 28) : 0;
            const int value = (i * 37 + y * 11) % 5000 * 13 + noise;
            bytes.push_back(static_cast<std::byte>(value));
            bytes.push_back(static_cast<std::byte>(value >> 8));
        }
    }
    return bytes;
}

TEST(ImageRows, TheNumberOfThreadsChangesNoByteAndLibpngReadsThemAll) {
    const TemporaryDirectory folder;
    const ImageShape shape{900, test::is_sanitized ? 300 : 1000, 3, 16, ColorSpace::data};
    const Bytes samples = smooth_text(shape);
    for (const WriteEffort effort : {WriteEffort::fast, WriteEffort::normal, WriteEffort::small}) {
        std::string first;
        for (const unsigned threads : {1U, 2U, 7U}) {
            set_thread_limit(threads);
            write_in_pieces(folder / "a.png", shape, samples, {.effort = effort});
            const std::string file = read_bytes(folder / "a.png");
            if (first.empty()) first = file;
            EXPECT_TRUE(file == first) << threads << " threads";
        }
        set_thread_limit(0);
        const std::optional<Image> by_libpng = test::by_module(first);
        ASSERT_TRUE(by_libpng);
        EXPECT_TRUE(bytes_of_samples(*by_libpng) == samples);
    }
}

TEST_LABELS(not_sanitized);
TEST(ImageRows, MoreEffortMakesSmallerPngAndTiffFilesOfTheSameSamples) {
    const TemporaryDirectory folder;
    const ImageShape shape{900, 1000, 3, 16, ColorSpace::data};
    const Bytes samples = smooth_text(shape);
    for (const char* name : {"a.png", "a.tif"}) {
        const auto size = [&](WriteEffort effort) {
            write_in_pieces(folder / name, shape, samples, {.effort = effort});
            EXPECT_TRUE(bytes_of_samples(read_image(folder / name, ImageUse::data)) == samples);
            return std::filesystem::file_size(folder / name);
        };
        const auto fast = size(WriteEffort::fast);
        const auto normal = size(WriteEffort::normal);
        const auto small = size(WriteEffort::small);
        EXPECT_LE(normal, fast + fast / 20) << name;  // The result of greedy searches varies.
        EXPECT_LT(small, normal) << name;
    }
}

TEST(ImageRows, SkippedRowsAreNotMissed) {
    const TemporaryDirectory folder;
    for (const Kind kind : exact_kinds) {
        const ImageShape shape{40, 200, 3, kind.bits, ColorSpace::data};
        const Bytes samples = pattern(shape);
        write_in_pieces(folder / kind.name, shape, samples);
        ImageRowReader reader(folder / kind.name);
        const std::size_t row = reader.row_bytes();
        Bytes rows(2 * row);
        for (const int skipped : {3, 0, 150}) {
            reader.skip(skipped);
            const auto first = static_cast<std::size_t>(reader.next_row()) * row;
            reader.read(rows);
            EXPECT_TRUE(std::equal(rows.begin(), rows.end(),
                                   samples.begin() + static_cast<std::ptrdiff_t>(first)));
        }
        EXPECT_EQ(reader.next_row(), 159);
        EXPECT_THROW(reader.skip(42), InvalidInput);
        EXPECT_THROW(reader.skip(-1), InvalidInput);
        EXPECT_THROW(reader.read(std::span(rows).first(row + 1)), InvalidInput);
        reader.skip(40);
        EXPECT_THROW(reader.read(rows), InvalidInput);
    }
}

TEST(ImageRows, WithoutFinishTheOldFileStays) {
    const TemporaryDirectory folder;
    const ImageShape shape{40, 200, 3, 8, ColorSpace::data};
    const Bytes samples = pattern(shape);
    for (const char* name : {"a.png", "a.tif"}) {
        std::ofstream(folder / name) << "old";
        {
            ImageRowWriter writer(folder / name, shape);
            writer.write(std::span(samples).first(120 * 150));
            EXPECT_THROW(writer.finish(), InvalidInput) << "rows are missing";
            EXPECT_THROW(writer.write(samples), InvalidInput) << "more rows than there are";
            EXPECT_THROW(writer.write(std::span(samples).first(50)), InvalidInput);
        }
        EXPECT_EQ(read_bytes(folder / name), "old");
    }
    const auto files = std::filesystem::directory_iterator(folder.path());
    EXPECT_EQ(std::distance(begin(files), end(files)), 2);
}

TEST(ImageRows, TiffBeyondFourGigabytesIsBigTiff) {
    const TemporaryDirectory folder;
    const auto signature_of = [&](int height) {
        ImageRowWriter writer(folder / "a.tif", {40000, height, 3, 16, ColorSpace::data});
        writer.write(Bytes(writer.row_bytes() * 64));
        for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
            return read_bytes(entry.path()).substr(0, 4);
        return std::string();
    };
    EXPECT_EQ(signature_of(10000), std::string("II*\0", 4)) << "2.4 GB";
    EXPECT_EQ(signature_of(20000), std::string("II+\0", 4)) << "4.8 GB";
}

TEST(ImageRows, SizesThatNoFileCanHoldAreRefused) {
    const TemporaryDirectory folder;
    for (const ImageShape& shape :
         {ImageShape{0, 1, 1, 8}, ImageShape{1, -1, 1, 8}, ImageShape{1, 1, 5, 8},
          ImageShape{1, 1, 1, 12}, ImageShape{1 << 30, 1 << 30, 1, 8}}) {
        EXPECT_THROW(ImageRowWriter(folder / "a.png", shape), InvalidInput);
    }
}

std::vector<float> written_as_half(const std::filesystem::path& file, std::vector<float> values,
                                   Report& report) {
    Image image = make_image(static_cast<int>(values.size()), 1, 1, 32, ColorSpace::data);
    image.samples = std::move(values);
    write_image(file, image, {}, {.half = true}, report);
    const Image back = read_image(file, ImageUse::data);
    return {back.as<float>().begin(), back.as<float>().end()};
}

TEST(ImageRows, HalvesRoundToTheNearestAndTheirRangeEndsFinite) {
    const TemporaryDirectory folder;
    constexpr float infinity = std::numeric_limits<float>::infinity();
    Report report;
    // A half has 11 significant bits: above 2048, odd numbers lie in the middle and round to even.
    EXPECT_THAT(written_as_half(folder / "a.exr",
                                {0.5F, -2049.0F, 2051.0F, 65504.0F, 65519.9F, 65520.0F, -1e30F,
                                 infinity, -infinity, 6e-8F},
                                report),
                testing::ElementsAre(0.5F, -2048.0F, 2052.0F, 65504.0F, 65504.0F, 65504.0F,
                                     -65504.0F, infinity, -infinity, std::ldexp(1.0F, -24)));
    ASSERT_EQ(report.findings().size(), 1U);
    const Finding& found = report.findings()[0];
    EXPECT_EQ(found.kind, "texel beyond half's range");
    EXPECT_EQ(found.count, 2U);
    EXPECT_THAT(found.first, testing::ElementsAre(5, 6));
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(std::isnan(written_as_half(folder / "a.exr", {nan}, report)[0]));
    EXPECT_EQ(report.count("texel beyond half's range"), 2U) << "NaN is no number too large";
}

TEST(ImageRows, HalvesTakeHalfTheRoomAndOnlyExrHasThem) {
    const TemporaryDirectory folder;
    const ImageShape shape{128, 128, 3, 32, ColorSpace::data};
    const Bytes samples = pattern(shape);
    write_in_pieces(folder / "float.exr", shape, samples);
    write_in_pieces(folder / "half.exr", shape, samples, {.half = true});
    EXPECT_LT(std::filesystem::file_size(folder / "half.exr"),
              std::filesystem::file_size(folder / "float.exr") * 6 / 10);
    EXPECT_THROW(ImageRowWriter(folder / "a.tif", shape, {}, {.half = true}), InvalidInput);
}

}  // namespace
}  // namespace relief
