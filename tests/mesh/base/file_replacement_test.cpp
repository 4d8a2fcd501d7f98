// SPDX-License-Identifier: Apache-2.0
// Replacing files alone and in sets: the old files after a failure, the new ones after success, and
// no temporary ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <span>
#include <string>

#include "file_replacement.h"
#include "files.h"
#include "operating_system.h"
#include "parallel.h"
#include "relief/mesh/report.h"
#include "support/invariants.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::detail;

namespace {

using relief::detail::text_of;

std::string text_of(const std::filesystem::path& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::size_t file_count(const std::filesystem::path& folder) {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(FileReplacement, AbandonedFileLeavesOnlyTheOldOne) {
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

using Contents = std::map<std::string, std::string>;

/// The files of a folder. Folders have the text "folder".
Contents contents_of(const std::filesystem::path& folder) {
    Contents contents;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        contents[entry.path().filename().string()] =
            entry.is_directory() ? "folder" : text_of(entry.path());
    }
    return contents;
}

void write_new(const std::filesystem::path& file) {
    replace_file(file, std::as_bytes(std::span("new", 3)));
}

TEST(FileSet, ReplacesAllFilesInCommit) {
    const test::TemporaryDirectory folder;
    std::ofstream(folder / "a") << "old";
    FileSet set;
    write_new(folder / "a");
    write_new(folder / "b");
    EXPECT_EQ(text_of(folder / "a"), "old");
    EXPECT_FALSE(std::filesystem::exists(folder / "b"));
    set.commit();
    EXPECT_EQ(contents_of(folder.path()), (Contents{{"a", "new"}, {"b", "new"}}));
    write_new(folder / "c");  // The set has ended.
    EXPECT_EQ(text_of(folder / "c"), "new");
}

TEST(FileSet, WithoutCommitLeavesTheOldFiles) {
    const test::TemporaryDirectory folder;
    std::ofstream(folder / "a") << "old";
    {
        const FileSet set;
        write_new(folder / "a");
        write_new(folder / "b");
    }
    EXPECT_EQ(contents_of(folder.path()), (Contents{{"a", "old"}}));
}

TEST(FileSet, AFailureAtAnyFileRestoresTheOthers) {
    const std::string names = "abcd";
    for (const char failing : names) {
        const test::TemporaryDirectory folder;
        std::ofstream(folder / "a") << "old a";
        std::ofstream(folder / "c") << "old c";
        Contents expected = {{"a", "old a"}, {"c", "old c"}};
        const std::string blocked(1, failing);
        {
            FileSet set;
            for (const char name : names)
                write_new(folder / std::string(1, name));
            std::filesystem::remove(folder / blocked);
            std::filesystem::create_directory(folder / blocked);
            expected[blocked] = "folder";
            EXPECT_THAT(test::message_of<FileError>([&] { set.commit(); }),
                        testing::EndsWith(blocked + ": cannot be written: " +
                                          error_text(require_no_folder(folder / blocked))));
        }
        EXPECT_EQ(contents_of(folder.path()), expected) << failing;
    }
}

TEST(FileSet, ASetWithinAnotherIsCommittedWithIt) {
    const test::TemporaryDirectory folder;
    FileSet outer;
    write_new(folder / "a");
    {
        FileSet inner;
        write_new(folder / "b");
        inner.commit();
    }
    {
        const FileSet abandoned;
        write_new(folder / "c");
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "b"));
    outer.commit();
    EXPECT_EQ(contents_of(folder.path()), (Contents{{"a", "new"}, {"b", "new"}}));
}

TEST(FileSet, IsReadAsItWillBe) {
    const test::TemporaryDirectory folder;
    std::ofstream(folder / "a") << "old";
    std::filesystem::create_directory(folder / "below");
    FileSet set;
    write_new(folder / "a");
    write_new(folder / "b");
    EXPECT_EQ(read_file(folder / "a"), "new");
    EXPECT_EQ(read_file(folder / "below/../b"), "new");
    EXPECT_EQ(FileContents(folder / "b").text(), "new");
    replace_file(folder / "b", std::as_bytes(std::span("newer", 5)));
    EXPECT_EQ(read_file(folder / "b"), "newer");
    set.commit();
    EXPECT_EQ(contents_of(folder.path()),
              (Contents{{"a", "new"}, {"b", "newer"}, {"below", "folder"}}));
}

TEST(FileSet, HasTheFilesOfItsParallelLoops) {
    constexpr std::size_t count = 100;
    const test::TemporaryDirectory folder;
    FileSet set;
    parallel_for(count, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            write_new(folder / ("in set " + std::to_string(i)));
    });
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
        ASSERT_TRUE(entry.path().filename().string().starts_with(".relief-")) << entry.path();
    EXPECT_EQ(file_count(folder.path()), count);
    set.commit();
    EXPECT_EQ(contents_of(folder.path()).size(), count);
    EXPECT_EQ(text_of(folder / "in set 99"), "new");
}

TEST(FileSet, PiecesOfALoopHaveSeparateFiles) {
    const test::TemporaryDirectory folder;
    std::atomic<std::size_t> failures = 0;
    // Nested loops let a thread take a piece of the outer loop while it waits in another one.
    parallel_for(16, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            FileSet set;
            const std::string name = "piece " + std::to_string(i);
            parallel_for(8, 1, [&](std::size_t first, std::size_t last) {
                for (std::size_t j = first; j < last; ++j)
                    write_new(folder / (name + " " + std::to_string(j)));
            });
            if (i % 2 == 0) set.commit();
            if (std::filesystem::exists(folder / (name + " 7")) != (i % 2 == 0)) ++failures;
        }
    });
    EXPECT_EQ(failures, 0U);
    EXPECT_EQ(file_count(folder.path()), 64U);
}

}  // namespace
}  // namespace relief
