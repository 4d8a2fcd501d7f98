// SPDX-License-Identifier: Apache-2.0
// Whole files and parts of files in memory, their replacement by a new file, and large pages.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/stat.h>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>

#include "files.h"
#include "large_memory.h"
#include "relief/mesh/report.h"
#include "support/invariants.h"
#include "support/shared_data.h"

namespace relief {
namespace {

TEST(FileContents, AreThoseOfTheFileWhateverItsSize) {
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

TEST(RandomAccessFile, MissingFilesAndFoldersAreSaidToBeSo) {
    const test::TemporaryDirectory folder;
    EXPECT_THAT(test::message_of<FileError>([&] { RandomAccessFile(folder / "none"); }),
                testing::HasSubstr("no such file"));
    EXPECT_THAT(test::message_of<FileError>([&] { RandomAccessFile{folder.path()}; }),
                testing::HasSubstr("is not a file"));
}

std::string text_of(const std::filesystem::path& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::size_t file_count(const std::filesystem::path& folder) {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(FileReplacement, AnAbandonedFileLeavesTheOldOneAndNothingElse) {
    const test::TemporaryDirectory folder;
    std::ofstream(folder / "a.txt") << "old";
    {
        const FileReplacement replacement(folder / "a.txt");
        EXPECT_EQ(replacement.temporary().extension(), ".txt");
        std::ofstream(replacement.temporary()) << "half";
        EXPECT_EQ(file_count(folder.path()), 2U);
    }
    EXPECT_EQ(text_of(folder / "a.txt"), "old");
    EXPECT_EQ(file_count(folder.path()), 1U);
}

TEST(FileReplacement, CommitReplaces) {
    const test::TemporaryDirectory folder;
    std::ofstream(folder / "a.txt") << "old";
    const std::string text = "new";
    replace_file(folder / "a.txt", std::as_bytes(std::span(text)));
    EXPECT_EQ(text_of(folder / "a.txt"), "new");
    EXPECT_EQ(file_count(folder.path()), 1U);
}

TEST(FileReplacement, AFileIsCommittedWithAnotherOrNotAtAll) {
    for (const bool replaces : {false, true}) {
        const test::TemporaryDirectory folder;
        if (replaces) std::ofstream(folder / "a.mtl") << "old";
        const auto commit = [&](const char* other) {
            FileReplacement materials(folder / "a.mtl");
            FileReplacement obj(folder / "a.obj");
            write_all(materials, std::as_bytes(std::span("new")));
            write_all(obj, std::as_bytes(std::span("new")));
            if (other != nullptr) std::filesystem::create_directory(folder / other);
            materials.commit_with(obj);
        };
        EXPECT_THAT(test::message_of<FileError>([&] { commit("a.obj"); }),
                    testing::HasSubstr("a.obj: cannot be written: Is a directory"));
        EXPECT_EQ(text_of(folder / "a.mtl"), replaces ? "old" : "");
        EXPECT_EQ(file_count(folder.path()), replaces ? 2U : 1U);
        std::filesystem::remove(folder / "a.obj");
        commit(nullptr);
        EXPECT_EQ(text_of(folder / "a.mtl"), std::string("new\0", 4));
        EXPECT_EQ(text_of(folder / "a.obj"), std::string("new\0", 4));
        EXPECT_EQ(file_count(folder.path()), 2U);
    }
}

TEST(FileReplacement, TheModeOfAReplacedFileIsKept) {
    const test::TemporaryDirectory folder;
    const std::string text = "new";
    for (const ::mode_t mode : {0600U, 0664U, 0751U}) {
        std::ofstream(folder / "a.txt") << "old";
        ASSERT_EQ(::chmod((folder / "a.txt").c_str(), mode), 0);
        replace_file(folder / "a.txt", std::as_bytes(std::span(text)));
        struct stat facts {};
        ASSERT_EQ(::stat((folder / "a.txt").c_str(), &facts), 0);
        EXPECT_EQ(facts.st_mode & 07777U, mode);
        EXPECT_EQ(text_of(folder / "a.txt"), "new");
    }
}

TEST(FileReplacement, ALinkIsFollowedAndStays) {
    const test::TemporaryDirectory folder;
    std::filesystem::create_directory(folder / "target");
    std::ofstream(folder / "target/a.txt") << "old";
    std::filesystem::create_symlink("target/a.txt", folder / "link.txt");
    std::filesystem::create_symlink("target/b.txt", folder / "new.txt");
    const std::string text = "new";
    replace_file(folder / "link.txt", std::as_bytes(std::span(text)));
    replace_file(folder / "new.txt", std::as_bytes(std::span(text)));
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.txt"));
    EXPECT_EQ(text_of(folder / "target/a.txt"), "new");
    EXPECT_EQ(text_of(folder / "target/b.txt"), "new");
    EXPECT_EQ(file_count(folder / "target"), 2U);
    EXPECT_EQ(file_count(folder.path()), 3U);
}

TEST(FileReplacement, ATemporaryFileThatIsReplacedByALinkIsRefused) {
    const test::TemporaryDirectory folder;
    std::ofstream(folder / "a.txt") << "old";
    std::ofstream(folder / "victim.txt") << "victim";
    FileReplacement replacement(folder / "a.txt");
    std::filesystem::remove(replacement.temporary());
    std::filesystem::create_symlink("victim.txt", replacement.temporary());
    write_all(replacement, std::as_bytes(std::span("new")));
    EXPECT_THAT(test::message_of<FileError>([&] { replacement.commit(); }),
                testing::HasSubstr("another program replaced the temporary file"));
    EXPECT_EQ(text_of(folder / "a.txt"), "old");
    EXPECT_EQ(text_of(folder / "victim.txt"), "victim");
}

TEST(FileReplacement, NamesOfTheLargestLengthAreWritten) {
    const test::TemporaryDirectory folder;
    const std::string name = std::string(251, 'a') + ".txt";
    const std::string text = "new";
    replace_file(folder / name, std::as_bytes(std::span(text)));
    EXPECT_EQ(text_of(folder / name), "new");
    EXPECT_THAT(test::message_of<FileError>(
                    [&] { replace_file(folder / ("a" + name), std::as_bytes(std::span(text))); }),
                testing::HasSubstr("File name too long"));
    EXPECT_EQ(file_count(folder.path()), 1U);
}

TEST(FileReplacement, AMissingFolderAndAFolderInTheWayAreFileErrors) {
    const test::TemporaryDirectory folder;
    EXPECT_THROW(FileReplacement(folder / "none/a.txt"), FileError);
    EXPECT_THROW(FileReplacement(folder.path()), FileError);
}

TEST(FileReplacement, ADeviceOrPipeIsAFileErrorAndStays) {
    // The test makes its own pipe, because a user who may rename in /dev would lose a device on
    // failure.
    const test::TemporaryDirectory folder;
    const std::filesystem::path pipe = folder / "pipe.txt";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    const std::string text = "new";
    EXPECT_THROW(replace_file(pipe, std::as_bytes(std::span(text))), FileError);
    EXPECT_TRUE(std::filesystem::is_fifo(pipe));
    std::filesystem::create_symlink(pipe, folder / "link.txt");
    EXPECT_THROW(FileReplacement(folder / "link.txt"), FileError);
    EXPECT_EQ(file_count(folder.path()), 2U);
}

TEST(LargeMemory, AdviceLeavesWhatIsThere) {
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
