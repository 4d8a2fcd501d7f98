// SPDX-License-Identifier: Apache-2.0
// The peak memory for images that are read and written by rows. The program is separate, because
// its peak includes libraries and all threads.
#include "relief/mesh/image_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "relief/mesh/execution.h"
#include "relief/mesh/normal_map_file.h"
#include "support/labels.h"
#include "support/peak_memory.h"
#include "support/shared_data.h"

namespace relief {
namespace {

FILE_LABELS(alone);

/// Fills rows with slopes and noise.
void fill_row(std::vector<std::uint16_t>& row, int y) {
    std::uint32_t state = static_cast<std::uint32_t>(y) * 2654435761U;
    for (std::size_t i = 0; i < row.size(); ++i) {
        state = state * 1664525U + 1013904223U;
        row[i] = static_cast<std::uint16_t>(i * 9 + static_cast<unsigned>(y) * 5 + (state >> 24));
    }
}

void write_large(const std::filesystem::path& file, int width, int height) {
    ImageRowWriter writer(file, {width, height, 1, 16, ColorSpace::data});
    std::vector<std::uint16_t> row(static_cast<std::size_t>(width));
    for (int y = 0; y < height; ++y) {
        fill_row(row, y);
        writer.write(std::as_bytes(std::span(row)));
    }
    writer.finish();
}

/// Converts gray to RGB, as normal maps are made from heights, and checks every row.
void copy_as_rgb(const std::filesystem::path& from, const std::filesystem::path& to) {
    ImageRowReader reader(from);
    const ImageInfo info = reader.info();
    ImageRowWriter writer(to, {info.width, info.height, 3, 16, ColorSpace::data});
    std::vector<std::uint16_t> gray(static_cast<std::size_t>(info.width)), expected = gray;
    std::vector<std::uint16_t> color(gray.size() * 3);
    for (int y = 0; y < info.height; ++y) {
        reader.read(std::as_writable_bytes(std::span(gray)));
        fill_row(expected, y);
        ASSERT_EQ(gray, expected);
        for (std::size_t i = 0; i < color.size(); ++i)
            color[i] = gray[i / 3];
        writer.write(std::as_bytes(std::span(color)));
    }
    writer.finish();
}

TEST(ImageRowsMemory, IsBoundedForAnyHeight) {
    const test::TemporaryDirectory folder;
    set_thread_limit(2);  // Each thread has 4 pieces in work.
    for (const char* extension : {".png", ".tif"}) {
        const auto from = folder / ("from" + std::string(extension));
        const auto to = folder / ("to" + std::string(extension));
        write_large(from, 4096, 128);
        copy_as_rgb(from, to);
        const double small = test::peak_megabytes();
        write_large(from, 4096, 4096);
        copy_as_rgb(from, to);
        // The samples are 34 MB gray and 101 MB in color. The small image already filled the
        // buffers of a batch of pieces, except for a part that depends on the size.
        EXPECT_LT(test::peak_megabytes() - small, 60.0) << extension;
    }
}

/// Writes a normal map of 8 bits with noise.
void write_normal_map(const std::filesystem::path& file, int width, int height) {
    ImageWriteOptions fast;
    fast.effort = WriteEffort::fast;
    ImageRowWriter writer(file, {width, height, 3, 8, ColorSpace::data}, {}, fast);
    std::vector<std::uint8_t> row(static_cast<std::size_t>(width) * 3);
    std::uint32_t state = 1;
    for (int y = 0; y < height; ++y) {
        for (std::size_t i = 0; i < row.size(); ++i) {
            state = state * 1664525U + 1013904223U;
            row[i] = static_cast<std::uint8_t>(i % 3 == 2 ? 250U : 112U + (state >> 27));
        }
        writer.write(std::as_bytes(std::span(row)));
    }
    writer.finish();
}

TEST(NormalMapMemory, ResizingIsBoundedForAnyHeight) {
    const test::TemporaryDirectory folder;
    set_thread_limit(2);
    const auto convert = [&](int height) {
        write_normal_map(folder / "map.png", 2048, height);
        NormalMapConversion conversion;
        conversion.width = 1024;
        conversion.height = height / 2;
        conversion.format.bits = 8;
        conversion.write.effort = WriteEffort::fast;
        conversion.texels_per_band = 1 << 17;
        convert_normal_map_file({folder / "map.png", nullptr, FlatCode::half, false},
                                folder / "small.png", conversion);
        return test::peak_megabytes();
    };
    const double small = convert(256);
    // In memory, decoded normals, their slopes and the result would have 97 MB more.
    EXPECT_LT(convert(2048) - small, 40.0);
}

}  // namespace
}  // namespace relief
