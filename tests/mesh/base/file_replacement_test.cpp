// SPDX-License-Identifier: Apache-2.0
// Writing beside and renaming: the old file lives until the new one is whole.
#include "file_replacement.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <iterator>

#include "relief/mesh/error.h"
#include "support/shared_data.h"

namespace relief {
namespace {

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

TEST(FileReplacement, AMissingFolderAndAFolderInTheWayAreFileErrors) {
    const test::TemporaryDirectory folder;
    EXPECT_THROW(FileReplacement(folder / "none/a.txt"), FileError);
    EXPECT_THROW(FileReplacement(folder.path()), FileError);
}

TEST(FileReplacement, ADeviceOrPipeIsAFileErrorAndStays) {
    // A pipe of its own, since who may rename in /dev would lose a device if this failed.
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

}  // namespace
}  // namespace relief
