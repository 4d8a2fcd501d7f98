// SPDX-License-Identifier: Apache-2.0
// Replacing files: links, modes, pipes and limits of names of Linux and macOS.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>

#include "file_replacement.h"
#include "relief/mesh/report.h"
#include "support/invariants.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::detail;

namespace {

std::size_t entry_count(const std::filesystem::path& folder) {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
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
        EXPECT_EQ(test::read_bytes(folder / "a.txt"), "new");
    }
}

TEST(FileReplacement, NamesOfTheLargestLengthAreWritten) {
    const test::TemporaryDirectory folder;
    const std::string name = std::string(251, 'a') + ".txt";
    const std::string text = "new";
    replace_file(folder / name, std::as_bytes(std::span(text)));
    EXPECT_EQ(test::read_bytes(folder / name), "new");
    EXPECT_THAT(test::message_of<FileError>(
                    [&] { replace_file(folder / ("a" + name), std::as_bytes(std::span(text))); }),
                testing::HasSubstr("File name too long"));
    EXPECT_EQ(entry_count(folder.path()), 1U);
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
    EXPECT_EQ(entry_count(folder.path()), 2U);
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
    EXPECT_EQ(test::read_bytes(folder / "target/a.txt"), "new");
    EXPECT_EQ(test::read_bytes(folder / "target/b.txt"), "new");
    EXPECT_EQ(entry_count(folder / "target"), 2U);
    EXPECT_EQ(entry_count(folder.path()), 3U);
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
    EXPECT_EQ(test::read_bytes(folder / "a.txt"), "old");
    EXPECT_EQ(test::read_bytes(folder / "victim.txt"), "victim");
}

}  // namespace
}  // namespace relief
