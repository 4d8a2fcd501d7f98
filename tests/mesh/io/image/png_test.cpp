// SPDX-License-Identifier: Apache-2.0
// PNG files: Deflate streams, the decoder against the image module, the encoder, filters and
// animations.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "io/image/row_codec.h"
#include "io/png/png_format.h"
#include "mesh/io/image/module_reference.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/report.h"
#include "support/labels.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::detail;

namespace {

using ByteValues = std::vector<std::uint8_t>;
using test::big32;
using test::by_module;
using test::directly;
using test::expect_same;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr WriteEffort efforts[] = {WriteEffort::fast, WriteEffort::normal, WriteEffort::small};

/// Returns a zlib stream of pieces that end at these positions.
std::string packed(const ByteValues& bytes, std::vector<std::size_t> ends, WriteEffort effort,
                   Repetitions repetitions) {
    ends.push_back(bytes.size());
    ByteValues stream;
    std::size_t begin = 0;
    for (const std::size_t end : ends) {
        const std::size_t known = std::min(begin, deflate_window);
        deflate_piece(std::span(bytes).subspan(begin - known, end - begin + known), known, effort,
                      repetitions, end == bytes.size(), stream);
        begin = end;
    }
    std::string file(zlib_header);
    file.append(stream.begin(), stream.end());
    append_big32(file, adler32(std::as_bytes(std::span(bytes))));
    return file;
}

/// Decompresses with libdeflate as the reference.
ByteValues unpacked(const std::string& stream, std::size_t size) {
    ByteValues bytes(size);
    EXPECT_TRUE(
        inflate(std::as_bytes(std::span(stream)), std::as_writable_bytes(std::span(bytes))));
    return bytes;
}

ByteValues noise(std::size_t size, unsigned values) {
    ByteValues bytes(size);
    std::mt19937 random(5);
    for (std::uint8_t& byte : bytes)
        byte = static_cast<std::uint8_t>(random() % values);
    return bytes;
}

/// Runs, noise, and repetitions.
ByteValues mixture(std::size_t size) {
    ByteValues bytes;
    std::mt19937 random(9);
    while (bytes.size() < size) {
        const std::size_t count = 1 + random() % 700;
        switch (random() % 3) {
            case 0:
                bytes.insert(bytes.end(), count, static_cast<std::uint8_t>(random()));
                break;
            case 1:
                for (std::size_t i = 0; i < count; ++i)
                    bytes.push_back(static_cast<std::uint8_t>(random() % 32));
                break;
            default:
                if (bytes.empty()) break;
                const std::size_t back = 1 + random() % bytes.size();
                for (std::size_t i = 0; i < count; ++i)
                    bytes.push_back(bytes[bytes.size() - back]);
        }
    }
    bytes.resize(size);
    return bytes;
}

TEST(DeflatePiece, ComesBackByteForByte) {
    std::vector<ByteValues> all{{},
                                {7},
                                ByteValues(100000, 0),
                                noise(200000, 256),
                                noise(200000, 2),
                                noise(65535, 256),
                                noise(65536, 17),
                                mixture(300000)};
    ByteValues ramp(70000);
    std::iota(ramp.begin(), ramp.end(), std::uint8_t{0});
    all.push_back(ramp);
    for (const ByteValues& bytes : all) {
        for (const WriteEffort effort : efforts) {
            for (const Repetitions repetitions : {Repetitions::sought, Repetitions::ignored}) {
                EXPECT_EQ(unpacked(packed(bytes, {}, effort, repetitions), bytes.size()), bytes);
                const std::size_t size = bytes.size();
                const std::vector<std::size_t> cuts{0, size / 7, size / 7, size / 3,
                                                    size - size / 9};
                if (size > 100) {
                    EXPECT_EQ(unpacked(packed(bytes, cuts, effort, repetitions), size), bytes);
                }
            }
        }
    }
}

TEST(DeflatePiece, EncodesEveryLengthAndDistance) {
    // A word, noise up to the distance, and the first bytes of the word again.
    const ByteValues word = noise(300, 256);
    ByteValues bytes = word;
    std::mt19937 random(3);
    for (std::size_t i = 0; i < 700; ++i) {
        const std::size_t length = 4 + i % 255;
        const std::size_t back =
            i < 300 ? 1 + i : 1 + random() % std::min(deflate_window, bytes.size());
        for (std::size_t k = 0; k < length; ++k)
            bytes.push_back(bytes[bytes.size() - back]);
        for (std::size_t k = 0; k < 97; ++k)
            bytes.push_back(static_cast<std::uint8_t>(random()));
    }
    for (const WriteEffort effort : efforts)
        EXPECT_EQ(unpacked(packed(bytes, {}, effort, Repetitions::sought), bytes.size()), bytes);
}

TEST(DeflatePiece, NoiseIsStoredAndRunsAreTiny) {
    for (const WriteEffort effort : efforts) {
        const ByteValues random = noise(1 << 20, 256);
        // 17 stored blocks have 5 bytes before them; 2 + 4 bytes belong to zlib.
        EXPECT_LE(packed(random, {}, effort, Repetitions::sought).size(),
                  random.size() + 17 * 5 + 12);
        const ByteValues run(1 << 20, 9);
        EXPECT_LT(packed(run, {}, effort, Repetitions::sought).size(), 4096U);
    }
}

TEST(DeflatePiece, WithoutRepetitionsBytesTakeTheirEntropy) {
    // 16 equally frequent values: 4 bits per byte, but 5 for one of them, whose code the end of a
    // block uses. Each of 17 blocks has a header of about 40 bytes.
    const ByteValues bytes = noise(1 << 20, 16);
    const std::size_t size = packed(bytes, {}, WriteEffort::fast, Repetitions::ignored).size();
    const std::size_t least = bytes.size() * (4 * 16 + 1) / 16 / 8;
    EXPECT_GT(size, least);
    EXPECT_LT(size, least + 17 * 60);
    EXPECT_NEAR(static_cast<double>(estimated_bits(bytes, Repetitions::ignored)),
                4.0625 * static_cast<double>(bytes.size()),
                0.001 * static_cast<double>(bytes.size()));
}

TEST(DeflatePiece, ReferencesThePreviousPiece) {
    ByteValues bytes = noise(20000, 256);
    bytes.insert(bytes.end(), bytes.begin(), bytes.end());
    const std::string one = packed(bytes, {20000}, WriteEffort::normal, Repetitions::sought);
    EXPECT_LT(one.size(), 20600U);
    EXPECT_EQ(unpacked(one, bytes.size()), bytes);
}

TEST(DeflatePiece, MoreEffortIsNotLarger) {
    const ByteValues bytes = mixture(1 << 20);
    const auto size = [&](WriteEffort effort) {
        return packed(bytes, {}, effort, Repetitions::sought).size();
    };
    EXPECT_LE(size(WriteEffort::normal), size(WriteEffort::fast));
    EXPECT_LE(size(WriteEffort::small), size(WriteEffort::normal));
}

TEST(HuffmanCode, HasTheLengthsOfAShortestCode) {
    // By hand: 1 + 1 -> 2, 2 + 2 -> 4, 4 + 4 -> 8, 8 + 8 -> 16.
    const std::vector<std::uint32_t> counts{8, 4, 2, 1, 1, 0};
    std::vector<std::uint8_t> lengths(counts.size());
    huffman_lengths(counts, 15, lengths);
    EXPECT_EQ(lengths, (std::vector<std::uint8_t>{1, 2, 3, 4, 4, 0}));
    std::vector<std::uint16_t> codes(counts.size());
    huffman_codes(lengths, codes);
    // 0, 10, 110, 1110, 1111, with the first bits lowest.
    EXPECT_EQ(codes, (std::vector<std::uint16_t>{0, 1, 3, 7, 15, 0}));
}

TEST(HuffmanCode, KeepsItsLimitAndFillsItsRoom) {
    // The Fibonacci numbers give the deepest tree: 30 symbols, 29 bits.
    std::vector<std::uint32_t> counts{1, 1};
    while (counts.size() < 30)
        counts.push_back(counts[counts.size() - 1] + counts[counts.size() - 2]);
    for (const int most : {7, 14, 15}) {
        std::vector<std::uint8_t> lengths(counts.size());
        huffman_lengths(counts, most, lengths);
        double room = 0;
        for (const std::uint8_t length : lengths) {
            EXPECT_GE(length, 1);
            EXPECT_LE(length, most);
            room += std::ldexp(1.0, -length);
        }
        EXPECT_EQ(room, 1.0);
    }
}

TEST(HuffmanCode, AlwaysHasTwoSymbols) {
    std::vector<std::uint8_t> lengths(4);
    huffman_lengths(std::vector<std::uint32_t>{0, 0, 0, 0}, 15, lengths);
    EXPECT_EQ(lengths, (std::vector<std::uint8_t>{1, 1, 0, 0}));
    huffman_lengths(std::vector<std::uint32_t>{5, 0, 0, 0}, 15, lengths);
    EXPECT_EQ(lengths, (std::vector<std::uint8_t>{1, 1, 0, 0}));
    huffman_lengths(std::vector<std::uint32_t>{0, 0, 7, 0}, 15, lengths);
    EXPECT_EQ(lengths, (std::vector<std::uint8_t>{1, 0, 1, 0}));
}

TEST(Adler32, CombinesTwoParts) {
    const ByteValues bytes = noise(300000, 256);
    const auto all = std::as_bytes(std::span(bytes));
    for (const std::size_t cut :
         {std::size_t{0}, std::size_t{1}, std::size_t{65521}, std::size_t{299999}, bytes.size()}) {
        EXPECT_EQ(
            adler32_of_both(adler32(all.first(cut)), adler32(all.subspan(cut)), bytes.size() - cut),
            adler32(all));
    }
}

/// Inflates to `size` bytes, with `given` bytes of the stream and `taken` bytes of the result at a
/// time. The result is empty on failure.
std::string inflated(const std::string& stream, std::size_t size, std::size_t given,
                     std::size_t taken) {
    std::size_t at = 0;
    InflateStream inflate([&] {
        const std::size_t first = at;
        at = std::min(at + given, stream.size());
        return std::as_bytes(std::span(stream).subspan(first, at - first));
    });
    std::string bytes(size, '\0');
    for (std::size_t to = 0; to < size; to += taken) {
        const std::size_t count = std::min(taken, size - to);
        if (!inflate.fill(std::as_writable_bytes(std::span(bytes).subspan(to, count)))) return {};
    }
    return inflate.is_complete() ? bytes : "";
}

std::string text() {
    std::string all;
    for (int i = 0; i < 20000; ++i)
        all += std::to_string(i * i % 977);
    return all;
}

TEST(InflateStream, HasTheSameBytesForAnyChunks) {
    const std::string bytes = text();
    const std::string stream = test::zlib_stream(bytes);
    for (const std::size_t given :
         {std::size_t{1}, std::size_t{7}, std::size_t{5000}, stream.size()})
        for (const std::size_t taken : {std::size_t{1}, std::size_t{1000}, bytes.size()})
            EXPECT_TRUE(inflated(stream, bytes.size(), given, taken) == bytes);
}

TEST(InflateStream, NoticesDamageAndAnotherLength) {
    const std::string bytes = text();
    const std::string stream = test::zlib_stream(bytes);
    EXPECT_EQ(inflated(stream, bytes.size() + 1, 5000, 5000), "");
    EXPECT_EQ(inflated(stream, bytes.size() - 1, 5000, 5000), "");
    EXPECT_EQ(inflated(stream.substr(0, stream.size() - 1), bytes.size(), 5000, 5000), "");
    EXPECT_EQ(inflated("", bytes.size(), 5000, 5000), "");
    for (std::size_t at = 0; at < stream.size(); at += stream.size() / 40) {
        std::string changed = stream;
        changed[at] ^= 4;
        EXPECT_EQ(inflated(changed, bytes.size(), 5000, 5000), "") << at;
    }
}

using namespace std::string_literals;

std::span<const std::byte> bytes_of(const std::string& text) {
    return std::as_bytes(std::span(text));
}

std::string chunk(const std::string& type, const std::string& data) {
    return big32(static_cast<std::uint32_t>(data.size())) + type + data +
           big32(crc32(bytes_of(type + data)));
}

/// A PNG in parts, each of which can be damaged.
struct Parts {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    int bits = 8;
    int type = 2;
    char interlaced = 0;
    std::string before_data;  ///< PLTE and tRNS chunks.
    std::string rows;         ///< Each row follows its filter type.

    [[nodiscard]] std::string file() const {
        const std::string data = test::zlib_stream(rows);
        return "\x89PNG\r\n\x1A\n" +
               chunk("IHDR", big32(width) + big32(height) + static_cast<char>(bits) +
                                 static_cast<char>(type) + "\0\0"s + interlaced) +
               before_data + chunk("IDAT", data.substr(0, data.size() / 2)) +
               chunk("IDAT", data.substr(data.size() / 2)) + chunk("IEND", "");
    }
};

/// Rows of random bytes under alternating filters. Indices of a palette always stay below 2^bits.
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

TEST(PlainPngs, AreReadAsByLibpng) {
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

TEST_LABELS(not_sanitized);
TEST(PlainPngs, AmongRealFilesReadAsLibpngReadsThem) {
    RELIEF_NEEDS_SHARED(data, "data");
    const test::Comparison comparison = test::compare_all(data, ".png");
    EXPECT_GT(comparison.direct, 50U);
    EXPECT_GT(comparison.direct, 4 * comparison.left);
}

TEST(PlainPngs, UnusualAndDamagedFilesGoToTheImageModule) {
    Parts good = parts(7, 6, 8, 2);
    ASSERT_TRUE(directly(good.file()));
    Parts bad = good;
    bad.before_data = chunk("tRNS", "\0\1\0\2\0\3"s);
    EXPECT_FALSE(directly(bad.file())) << "one transparent color";
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
            continue;  // The scan before decoding detected a wrong length or type.
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

TEST(PngWriter, RoundTrips) {
    std::mt19937 random(5);
    for (int channels = 1; channels <= 4; ++channels) {
        for (const int bits : {8, 16}) {
            // More rows than one piece of filtering.
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

TEST(PngWriter, ChunksDescribeTheImage) {
    const Image srgb = make_image(2, 1, 3, 8, ColorSpace::srgb);
    const std::string file = encode_png(srgb, {{"relief:a", "up"}, {"b", "cut\0off"s}});
    EXPECT_THAT(file, HasSubstr(chunk("IHDR", big32(2) + big32(1) + "\x08\x02\0\0\0"s) +
                                chunk("sRGB", "\0"s) + chunk("gAMA", big32(45455)) +
                                chunk("tEXt", "b\0cut"s) + chunk("tEXt", "relief:a\0up"s)));
    Image data = srgb;
    data.color_space = ColorSpace::data;
    EXPECT_THAT(encode_png(data, {}), testing::Not(HasSubstr("sRGB")));
}

TEST(PngFilter, PaethPredictsFromTheNearestNeighbor) {
    // Left 10, above 20, upper left 12: the plane gives 18, which is nearest to 20.
    const std::vector<std::uint8_t> above{12, 20}, row{10, 25};
    std::vector<std::uint8_t> filtered(2);
    apply_filter(paeth_filter, 1, row, above, filtered);
    EXPECT_THAT(filtered, testing::ElementsAre(254, 5));  // 10 - 12 modulo 256, 25 - 20.
    ASSERT_TRUE(undo_filter(paeth_filter, 1, filtered, above));
    EXPECT_EQ(filtered, row);
}

TEST(PngFilter, EveryFilterIsInvertedForAnyVectorWidth) {
    std::mt19937 random(11);
    for (const std::size_t step : {1U, 2U, 3U, 4U, 6U, 8U}) {
        for (const std::size_t texels : {1U, 2U, 5U, 67U, 200U}) {
            std::vector<std::uint8_t> above(step * texels), row(step * texels);
            for (std::size_t i = 0; i < row.size(); ++i) {
                above[i] = static_cast<std::uint8_t>(random());
                // Half of the bytes are close, so that ties and both signs of differences occur.
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

constexpr std::size_t row_bytes = 3000;  // 500 texels of three 16-bit samples.
constexpr std::size_t filter_step = 6;

/// 30 rows and the one above, from `value(row, byte)`.
template <typename Value>
std::vector<std::uint8_t> rows_of(Value value) {
    std::vector<std::uint8_t> rows;
    for (std::size_t y = 0; y < 31; ++y) {
        for (std::size_t i = 0; i < row_bytes; ++i)
            rows.push_back(static_cast<std::uint8_t>(value(y, i)));
    }
    return rows;
}

TEST(FilterChoice, NoiseIsLeftAloneAndNotSearched) {
    std::mt19937 random(1);
    const auto rows = rows_of([&](std::size_t, std::size_t) { return random(); });
    for (const WriteEffort effort : {WriteEffort::fast, WriteEffort::normal, WriteEffort::small})
        EXPECT_EQ(choose_filter(rows, row_bytes, filter_step, effort).repetitions,
                  Repetitions::ignored);
}

TEST(FilterChoice, PredictsFromAboveIfRowsAreSimilar) {
    std::mt19937 random(2);
    std::vector<std::size_t> above(row_bytes);
    for (std::size_t& value : above)
        value = random();
    const auto rows = rows_of([&](std::size_t, std::size_t i) { return above[i] += random() % 8; });
    const FilterChoice choice = choose_filter(rows, row_bytes, filter_step, WriteEffort::normal);
    EXPECT_EQ(choice.filter, 2);
}

TEST(FilterChoice, PredictsFromTheLeftIfColumnsAreSimilar) {
    std::mt19937 random(3);
    std::vector<std::size_t> last(filter_step);
    const auto rows = rows_of([&](std::size_t, std::size_t i) {
        if (i < filter_step) last[i] = random();
        return last[i % filter_step] += random() % 8;
    });
    const FilterChoice choice = choose_filter(rows, row_bytes, filter_step, WriteEffort::normal);
    EXPECT_EQ(choice.filter, 1);
}

TEST(FilterChoice, FewTexelsInAnyOrderStayAsTheyAre) {
    // Every texel is one of 16 with six random bytes: repetitions that differences would destroy.
    std::mt19937 random(4);
    std::vector<std::size_t> texels(16 * filter_step);
    for (std::size_t& value : texels)
        value = random();
    std::size_t texel = 0;
    const auto rows = rows_of([&](std::size_t, std::size_t i) {
        if (i % filter_step == 0) texel = random() % 16;
        return texels[texel * filter_step + i % filter_step];
    });
    const FilterChoice choice = choose_filter(rows, row_bytes, filter_step, WriteEffort::normal);
    EXPECT_EQ(choice.filter, 0);
    EXPECT_EQ(choice.repetitions, Repetitions::sought);
}

Image frame(std::uint8_t value, int width = 5) {
    Image image = make_image(width, 3, 3, 8, ColorSpace::srgb);
    std::uint8_t next = value;
    for (std::uint8_t& sample : std::get<std::vector<std::uint8_t>>(image.samples))
        sample = next += 3;
    return image;
}

struct Chunk {
    std::string type;
    std::string data;
};

std::uint32_t number(const std::string& data, std::size_t at, std::size_t bytes) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i)
        value = value << 8U | static_cast<unsigned char>(data.at(at + i));
    return value;
}

std::vector<Chunk> chunks_of(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    std::vector<Chunk> chunks;
    for (std::size_t at = 8; at < text.size();) {
        const std::uint32_t length = number(text, at, 4);
        chunks.push_back({text.substr(at + 4, 4), text.substr(at + 8, length)});
        at += 12 + length;
    }
    return chunks;
}

/// Returns a frame as a separate PNG: the header of the file and the data of the frame.
Image frame_by_itself(const std::vector<Chunk>& chunks, std::size_t index) {
    std::string png = "\x89PNG\r\n\x1A\n";
    append_chunk(png, "IHDR", chunks.at(0).data);
    std::size_t seen = 0;
    for (const Chunk& chunk : chunks) {
        seen += static_cast<std::size_t>(chunk.type == "fcTL");
        if (seen != index + 1) continue;
        if (chunk.type == "IDAT") append_chunk(png, "IDAT", chunk.data);
        if (chunk.type == "fdAT") append_chunk(png, "IDAT", chunk.data.substr(4));
    }
    append_chunk(png, "IEND", "");
    return read_image(std::as_bytes(std::span(png)), "frame", ImageUse::color);
}

TEST(AnimatedPng, HoldsEveryFrameInOrder) {
    const test::TemporaryDirectory folder;
    AnimatedPng animation(folder / "a.png", 3, 0.04);
    const std::array<std::uint8_t, 3> values{10, 60, 200};
    for (const std::uint8_t value : values)
        animation.add(frame(value));
    EXPECT_FALSE(std::filesystem::exists(folder / "a.png"));
    animation.finish();

    const std::vector<Chunk> chunks = chunks_of(folder / "a.png");
    std::vector<std::uint32_t> sequence;
    for (const Chunk& chunk : chunks) {
        if (chunk.type == "fcTL" || chunk.type == "fdAT")
            sequence.push_back(number(chunk.data, 0, 4));
        if (chunk.type == "acTL") {
            EXPECT_EQ(number(chunk.data, 0, 4), 3U);
        }
        if (chunk.type == "fcTL") {
            EXPECT_EQ(number(chunk.data, 4, 4), 5U);    // Width.
            EXPECT_EQ(number(chunk.data, 20, 2), 40U);  // Of 1000: 0.04 s.
            EXPECT_EQ(number(chunk.data, 22, 2), 1000U);
        }
    }
    EXPECT_THAT(sequence, ElementsAre(0, 1, 2, 3, 4));  // Without gaps, over both kinds.
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_EQ(frame_by_itself(chunks, i).samples, frame(values.at(i)).samples);
    // Readers without animation support see the first frame.
    EXPECT_EQ(read_image(folder / "a.png", ImageUse::color).samples, frame(10).samples);
}

TEST(AnimatedPng, KeepsTheOldFileIfUnfinished) {
    const test::TemporaryDirectory folder;
    std::ofstream(folder / "a.png") << "old";
    {
        AnimatedPng animation(folder / "a.png", 2, 0.1);
        animation.add(frame(1));
        EXPECT_THROW(animation.finish(), InvalidInput);  // One frame is missing.
    }
    EXPECT_EQ(std::filesystem::file_size(folder / "a.png"), 3U);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(AnimatedPng, RefusesFramesOfAnotherShape) {
    const test::TemporaryDirectory folder;
    AnimatedPng animation(folder / "a.png", 1, 0.1);
    EXPECT_THROW(animation.add(make_image(5, 3, 3, 32, ColorSpace::linear)), InvalidInput);
    animation.add(frame(1));
    EXPECT_THROW(animation.add(frame(2)), InvalidInput);
    AnimatedPng two(folder / "b.png", 2, 0.1);
    two.add(frame(1));
    EXPECT_THROW(two.add(frame(2, 6)), InvalidInput);
    EXPECT_THROW(AnimatedPng(folder / "c.png", 0, 0.1), InvalidInput);
    EXPECT_THROW(AnimatedPng(folder / "c.png", 1, 66.0), InvalidInput);
    EXPECT_THROW(AnimatedPng(folder / "missing/c.png", 1, 0.1), FileError);
}

}  // namespace
}  // namespace relief
