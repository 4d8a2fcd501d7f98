// SPDX-License-Identifier: Apache-2.0
// Whole files and parts of files in memory, and large pages.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>

#include "files.h"
#include "large_memory.h"
#include "relief/mesh/report.h"
#include "support/invariants.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::detail;

namespace {

TEST(FileContents, EqualTheFileOfAnySize) {
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / "relief-file-contents-test";
    for (const std::size_t size : {0U, 1U, 4194304U, 9000001U}) {
        std::string bytes(size, '\0');
        for (std::size_t i = 0; i < size; ++i)
            bytes[i] = static_cast<char>(i * 7 + i / 251);
        std::ofstream(file, std::ios::binary) << bytes;
        EXPECT_TRUE(FileContents(file).text() == bytes) << size;
        EXPECT_TRUE(read_file(file) == bytes) << size;
    }
    std::filesystem::remove(file);
}

TEST(FileContents, SayWhyTheyCannotBeRead) {
    const auto message_of = [](const auto& read) -> std::string {
        try {
            read();
        } catch (const FileError& error) {
            return error.what();
        }
        return "";
    };
    for (const std::filesystem::path& file :
         {std::filesystem::path("no/such/file"), std::filesystem::temp_directory_path()}) {
        const std::string expected = message_of([&] { return read_file(file); });
        EXPECT_NE(expected, "");
        EXPECT_EQ(message_of([&] { return FileContents(file); }), expected);
    }
}

TEST(RandomAccessFile, GivesThePartsThatAreAskedFor) {
    const test::TemporaryDirectory folder;
    std::ofstream(folder / "a") << "0123456789";
    const RandomAccessFile file(folder / "a");
    EXPECT_EQ(file.size(), 10U);
    std::array<char, 3> part{};
    file.read(7, std::as_writable_bytes(std::span(part)));
    EXPECT_THAT(part, testing::ElementsAre('7', '8', '9'));
    file.read(0, std::as_writable_bytes(std::span(part)));
    EXPECT_THAT(part, testing::ElementsAre('0', '1', '2'));
    EXPECT_THAT(
        test::message_of<FileError>([&] { file.read(8, std::as_writable_bytes(std::span(part))); }),
        testing::HasSubstr("could be read only up to byte 10 of 10"));
}

TEST(RandomAccessFile, ReportsMissingFilesAndFolders) {
    const test::TemporaryDirectory folder;
    EXPECT_THAT(test::message_of<FileError>([&] { RandomAccessFile(folder / "none"); }),
                testing::HasSubstr("no such file"));
    EXPECT_THAT(test::message_of<FileError>([&] { RandomAccessFile{folder.path()}; }),
                testing::HasSubstr("is not a file"));
}

TEST(LargeMemory, AdviceKeepsTheContent) {
    std::vector<std::uint8_t> bytes(std::size_t{9} << 20);
    for (std::size_t i = 0; i < bytes.size(); ++i)
        bytes[i] = static_cast<std::uint8_t>(i % 251);
    expect_filling(bytes.data() + 1, bytes.size() - 2);
    for (std::size_t i = 0; i < bytes.size(); ++i)
        ASSERT_EQ(bytes[i], i % 251);
}

TEST(LargeMemory, AnySizeMayBeReserved) {
    for (const std::size_t count : {std::size_t{0}, std::size_t{7}, std::size_t{3} << 20}) {
        std::vector<int> values;
        reserve_to_fill(values, count);
        EXPECT_GE(values.capacity(), count);
        EXPECT_TRUE(values.empty());
    }
    expect_filling(nullptr, 0);
}

}  // namespace
}  // namespace relief
