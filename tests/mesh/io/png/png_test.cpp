// SPDX-License-Identifier: Apache-2.0
// The direct way for PNG against an independent decoder, libpng, by way of the image module: on
// every kind of PNG put together here by hand, and on every PNG among the real data.
#include "io/png/png_decoder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "io/png/deflate.h"
#include "io/png/png_encoder.h"
#include "io/png/png_filter.h"
#include "module_reference.h"
#include "relief/mesh/error.h"
#include "relief/mesh/image_file.h"
#include "support/shared_data.h"

namespace relief {
namespace {

using namespace std::string_literals;
using test::big32;
using test::by_module;
using test::directly;
using test::expect_same;
using testing::HasSubstr;

std::span<const std::byte> bytes_of(const std::string& text) {
    return std::as_bytes(std::span(text));
}

std::string chunk(const std::string& type, const std::string& data) {
    return big32(static_cast<std::uint32_t>(data.size())) + type + data +
           big32(crc32(bytes_of(type + data)));
}

/// A PNG in parts, so that each can be spoiled.
struct Parts {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    int bits = 8;
    int type = 2;
    char interlaced = 0;
    std::string before_data;  ///< PLTE and tRNS chunks.
    std::string rows;         ///< Each behind its filter type.

    [[nodiscard]] std::string file() const {
        const std::string data = test::zlib_stream(rows);
        return "\x89PNG\r\n\x1A\n" +
               chunk("IHDR", big32(width) + big32(height) + static_cast<char>(bits) +
                                 static_cast<char>(type) + "\0\0"s + interlaced) +
               before_data + chunk("IDAT", data.substr(0, data.size() / 2)) +
               chunk("IDAT", data.substr(data.size() / 2)) + chunk("IEND", "");
    }
};

/// Rows of random bytes under filters in turn. Indices of a palette stay below 2^bits in any case.
Parts parts(std::uint32_t width, std::uint32_t height, int bits, int type) {
    static constexpr unsigned channels_of_type[] = {1, 0, 3, 1, 2, 0, 4};
    Parts result{width, height, bits, type, 0, "", ""};
    std::mt19937 random(width * 100 + height * 10 + static_cast<unsigned>(bits + type));
    const unsigned row = (width * channels_of_type[type] * static_cast<unsigned>(bits) + 7) / 8;
    for (unsigned y = 0; y < height; ++y) {
        result.rows += static_cast<char>((y + width) % 5);
        for (unsigned i = 0; i < row; ++i)
            result.rows += static_cast<char>(random());
    }
    return result;
}

std::string palette(int bits) {
    std::string colors;
    for (int i = 0; i < 3 * (1 << bits); ++i)
        colors += static_cast<char>(7 * i + 1);
    return chunk("PLTE", colors);
}

TEST(PlainPngs, OfEveryKindAndFilterReadAsLibpngReadsThem) {
    for (const auto& [width, height] : {std::pair(1U, 1U), {7U, 6U}, {33U, 11U}}) {
        for (const int type : {0, 2, 3, 4, 6}) {
            for (const int bits : {1, 2, 4, 8, 16}) {
                if (bits < 8 && type != 0 && type != 3) continue;
                if (bits == 16 && type == 3) continue;
                Parts png = parts(width, height, bits, type);
                if (type == 3) png.before_data = palette(bits);
                const std::string what = std::to_string(width) + " wide, type " +
                                         std::to_string(type) + ", bits " + std::to_string(bits);
                expect_same(directly(png.file()), by_module(png.file()), what);
                if (type != 3) continue;
                png.before_data += chunk("tRNS", "\x80\x00"s);
                expect_same(directly(png.file()), by_module(png.file()), what + ", transparent");
                EXPECT_EQ(directly(png.file())->channels, 4);
            }
        }
    }
}

TEST(PlainPngs, AmongRealFilesReadAsLibpngReadsThem) {
    RELIEF_NEEDS_SHARED(data, "data");
    const test::Comparison comparison = test::compare_all(data, ".png");
    EXPECT_GT(comparison.direct, 50U);
    EXPECT_GT(comparison.direct, 4 * comparison.left);
}

TEST(PlainPngs, WhatIsOddOrDamagedIsLeftToTheImageModule) {
    Parts good = parts(7, 6, 8, 2);
    ASSERT_TRUE(directly(good.file()));
    Parts bad = good;
    bad.before_data = chunk("tRNS", "\0\1\0\2\0\3"s);
    EXPECT_FALSE(directly(bad.file())) << "one transparent colour";
    bad = good;
    bad.interlaced = 1;
    EXPECT_FALSE(directly(bad.file())) << "interlaced";
    bad = good;
    bad.rows[0] = 5;
    EXPECT_FALSE(directly(bad.file())) << "no such filter";
    bad = good;
    bad.rows.pop_back();
    EXPECT_FALSE(directly(bad.file())) << "a byte too few";
    bad = good;
    bad.rows += "x";
    EXPECT_FALSE(directly(bad.file())) << "a byte too many";
    bad = good;
    bad.before_data = palette(1) + palette(1);
    EXPECT_FALSE(directly(bad.file())) << "two palettes";
    Parts indexed = parts(7, 6, 4, 3);
    EXPECT_FALSE(directly(indexed.file())) << "no palette";
    indexed.before_data = palette(1);
    EXPECT_FALSE(directly(indexed.file())) << "an index beyond the palette";
    indexed.before_data = palette(5);
    EXPECT_FALSE(directly(indexed.file())) << "more entries than indices";
    for (const auto& [bits, type] : {std::pair(3, 0), {4, 2}, {16, 3}, {32, 0}})
        EXPECT_FALSE(directly(parts(7, 6, bits, type).file())) << bits << " bits of " << type;
}

TEST(PlainPngs, OneWrongBitAnywhereIsNoticed) {
    const std::string whole = parts(7, 6, 8, 2).file();
    const std::size_t end = whole.size() - 12;  // The last chunk is empty.
    std::size_t tried = 0;
    for (std::size_t at = 8; at < end; ++at) {
        std::string changed = whole;
        changed[at] ^= static_cast<char>(1 << at % 8);
        try {
            EXPECT_FALSE(directly(changed)) << "byte " << at;
            ++tried;
        } catch (const FileError&) {
            continue;  // A length or type that the walk before decoding noticed.
        }
    }
    EXPECT_GT(tried, 100U);
}

TEST(PlainPngs, ADamagedOneIsRefusedInLibpngsWords) {
    std::string file = parts(7, 6, 8, 2).file();
    file[file.find("IDAT") + 5] ^= 1;
    try {
        read_image(bytes_of(file), "map.png", ImageUse::data);
        FAIL() << "was read";
    } catch (const FileError& error) {
        EXPECT_THAT(error.what(), HasSubstr("map.png: rows 0 to 5 of 6 are damaged: PNG: "));
    }
}

TEST(PngWriter, WhatItWritesReadsAsWritten) {
    std::mt19937 random(5);
    for (int channels = 1; channels <= 4; ++channels) {
        for (const int bits : {8, 16}) {
            // More rows than are filtered as one piece.
            Image image = make_image(13, 150, channels, bits, ColorSpace::data);
            std::visit(
                [&](auto& samples) {
                    for (auto& sample : samples)
                        sample = static_cast<std::decay_t<decltype(sample)>>(random());
                },
                image.samples);
            const std::string file = encode_png(image, {});
            expect_same(by_module(file), image, "by libpng");
            expect_same(directly(file), image, "directly");
        }
    }
}

TEST(PngWriter, ChunksSayWhatTheImageIs) {
    const Image srgb = make_image(2, 1, 3, 8, ColorSpace::srgb);
    const std::string file = encode_png(srgb, {{"relief:a", "up"}, {"b", "cut\0off"s}});
    EXPECT_THAT(file, HasSubstr(chunk("IHDR", big32(2) + big32(1) + "\x08\x02\0\0\0"s) +
                                chunk("sRGB", "\0"s) + chunk("gAMA", big32(45455)) +
                                chunk("tEXt", "b\0cut"s) + chunk("tEXt", "relief:a\0up"s)));
    Image data = srgb;
    data.color_space = ColorSpace::data;
    EXPECT_THAT(encode_png(data, {}), testing::Not(HasSubstr("sRGB")));
}

TEST(PngFilter, PaethTakesTheNeighbourNearestToTheirPlane) {
    // Left 10, above 20, upper left 12: the plane gives 18, nearest to 20.
    const std::vector<std::uint8_t> above{12, 20}, row{10, 25};
    std::vector<std::uint8_t> filtered(2);
    apply_filter(paeth_filter, 1, row, above, filtered);
    EXPECT_THAT(filtered, testing::ElementsAre(254, 5));  // 10 - 12 modulo 256, 25 - 20.
    ASSERT_TRUE(undo_filter(paeth_filter, 1, filtered, above));
    EXPECT_EQ(filtered, row);
}

TEST(PngFilter, EveryFilterIsUndoneWhateverTheVectors) {
    std::mt19937 random(11);
    for (const std::size_t step : {1U, 2U, 3U, 4U, 6U, 8U}) {
        for (const std::size_t texels : {1U, 2U, 5U, 67U, 200U}) {
            std::vector<std::uint8_t> above(step * texels), row(step * texels);
            for (std::size_t i = 0; i < row.size(); ++i) {
                above[i] = static_cast<std::uint8_t>(random());
                // Half of them near, so that ties and both signs of differences occur.
                row[i] = static_cast<std::uint8_t>(i % 2 == 0 ? random() : above[i] + random() % 3);
            }
            for (std::uint8_t filter = 0; filter < filter_count; ++filter) {
                std::vector<std::vector<std::uint8_t>> found;
                for (const char* bits : {"128", "256", "512"}) {
                    ::setenv("RELIEF_VECTOR_BITS", bits, 1);
                    std::vector<std::uint8_t> filtered(row.size());
                    apply_filter(filter, step, row, above, filtered);
                    found.push_back(filtered);
                    ASSERT_TRUE(undo_filter(filter, step, filtered, above));
                    EXPECT_EQ(filtered, row) << "filter " << int{filter} << ", step " << step;
                }
                ::unsetenv("RELIEF_VECTOR_BITS");
                EXPECT_EQ(found[0], found[1]);
                EXPECT_EQ(found[0], found[2]);
            }
        }
    }
}

}  // namespace
}  // namespace relief
