// SPDX-License-Identifier: Apache-2.0
// Files larger than what one thread reads at a time, and those that cannot be read.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "file_bytes.h"
#include "relief/mesh/error.h"

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

}  // namespace
}  // namespace relief
