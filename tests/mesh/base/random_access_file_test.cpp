// SPDX-License-Identifier: Apache-2.0
// Parts of a file, and what cannot be read of it.
#include "random_access_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <fstream>

#include "relief/mesh/error.h"
#include "support/message_of.h"
#include "support/shared_data.h"

namespace relief {
namespace {

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

}  // namespace
}  // namespace relief
