// SPDX-License-Identifier: Apache-2.0
// Deflate streams: prefix codes, the encoder, checksums, and decompression in parts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <string>

#include "io/png/deflate_encoder.h"
#include "io/png/inflate.h"
#include "io/png/png_format.h"
#include "module_reference.h"

namespace relief {
namespace {

using ByteValues = std::vector<std::uint8_t>;

constexpr WriteEffort efforts[] = {WriteEffort::fast, WriteEffort::normal, WriteEffort::small};

/// A zlib stream of pieces that end at these places.
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

/// What libdeflate makes of it, which is known to work.
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

/// Runs, noise, and what came before again.
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

TEST(DeflatePiece, EveryLengthAndDistanceIsSaid) {
    // A word of its own, noise up to the distance, and the word's first bytes again.
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

TEST(DeflatePiece, NoiseTakesHardlyMoreThanItselfAndRunsNextToNothing) {
    for (const WriteEffort effort : efforts) {
        const ByteValues random = noise(1 << 20, 256);
        // 17 stored blocks have 5 bytes before them; 2 + 4 bytes are zlib's.
        EXPECT_LE(packed(random, {}, effort, Repetitions::sought).size(),
                  random.size() + 17 * 5 + 12);
        const ByteValues run(1 << 20, 9);
        EXPECT_LT(packed(run, {}, effort, Repetitions::sought).size(), 4096U);
    }
}

TEST(DeflatePiece, WithoutRepetitionsBytesTakeTheirEntropy) {
    // 16 values alike: 4 bits a byte, but 5 for one of them, from which the end of a block takes
    // its code; a header of some 40 bytes for each of 17 blocks.
    const ByteValues bytes = noise(1 << 20, 16);
    const std::size_t size = packed(bytes, {}, WriteEffort::fast, Repetitions::ignored).size();
    const std::size_t least = bytes.size() * (4 * 16 + 1) / 16 / 8;
    EXPECT_GT(size, least);
    EXPECT_LT(size, least + 17 * 60);
    EXPECT_NEAR(static_cast<double>(estimated_bits(bytes, Repetitions::ignored)),
                4.0625 * static_cast<double>(bytes.size()),
                0.001 * static_cast<double>(bytes.size()));
}

TEST(DeflatePiece, WhatWentBeforeIsPointedBackTo) {
    ByteValues bytes = noise(20000, 256);
    bytes.insert(bytes.end(), bytes.begin(), bytes.end());
    const std::string one = packed(bytes, {20000}, WriteEffort::normal, Repetitions::sought);
    EXPECT_LT(one.size(), 20600U);
    EXPECT_EQ(unpacked(one, bytes.size()), bytes);
}

TEST(DeflatePiece, MoreEffortIsNoLarger) {
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
    // 0, 10, 110, 1110, 1111, their first bits lowest.
    EXPECT_EQ(codes, (std::vector<std::uint16_t>{0, 1, 3, 7, 15, 0}));
}

TEST(HuffmanCode, KeepsItsLimitAndFillsItsRoom) {
    // Fibonacci's numbers make the deepest tree: 30 symbols, 29 bits.
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

TEST(Adler32, OfTwoPartsIsThatOfTheWhole) {
    const ByteValues bytes = noise(300000, 256);
    const auto all = std::as_bytes(std::span(bytes));
    for (const std::size_t cut :
         {std::size_t{0}, std::size_t{1}, std::size_t{65521}, std::size_t{299999}, bytes.size()}) {
        EXPECT_EQ(
            adler32_of_both(adler32(all.first(cut)), adler32(all.subspan(cut)), bytes.size() - cut),
            adler32(all));
    }
}

/// Inflates to `size` bytes, `given` of the stream and `taken` of the result at a time; nothing
/// where it cannot.
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

TEST(InflateStream, GivesTheSameBytesHoweverItIsFed) {
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

}  // namespace

}  // namespace relief
