// SPDX-License-Identifier: Apache-2.0
// Animated PNG: the chunks by hand, every frame taken out again and read by itself, and the file as
// plain readers see it.
#include "relief/mesh/animated_png.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <fstream>

#include "io/png/png_chunk.h"
#include "relief/mesh/error.h"
#include "relief/mesh/image_file.h"
#include "support/shared_data.h"

namespace relief {
namespace {

using testing::ElementsAre;

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

/// A frame as a PNG of its own: the file's header and the frame's data.
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
    // Readers that know nothing of animation see the first frame.
    EXPECT_EQ(read_image(folder / "a.png", ImageUse::color).samples, frame(10).samples);
}

TEST(AnimatedPng, LeavesTheOldFileWhereItIsNotFinished) {
    const test::TemporaryDirectory folder;
    std::ofstream(folder / "a.png") << "old";
    {
        AnimatedPng animation(folder / "a.png", 2, 0.1);
        animation.add(frame(1));
        EXPECT_THROW(animation.finish(), InvalidInput);  // One is missing.
    }
    EXPECT_EQ(std::filesystem::file_size(folder / "a.png"), 3U);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(AnimatedPng, RefusesWhatDoesNotFit) {
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
