// SPDX-License-Identifier: Apache-2.0
/// \file
/// Reading a whole file into memory, with an error that says why it could not be done.
/// Tests: tests/mesh/io/mesh/mesh_file_test.cpp, tests/mesh/base/file_contents_test.cpp.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace relief {

/// The bytes of a file, as text. \throws FileError if it is missing, a folder or unreadable
std::string read_file(const std::filesystem::path& file);

/// The bytes of a file that may be large, for reading alone: on all threads, into memory that was
/// not cleared before.
class FileContents {
  public:
    /// \throws FileError as read_file()
    explicit FileContents(const std::filesystem::path& file);

    [[nodiscard]] std::string_view text() const { return {bytes_.get(), size_}; }

  private:
    std::unique_ptr<char[]> bytes_;
    std::size_t size_ = 0;
};

/// An extension in lower case with its dot, ".obj"; empty where there is none.
std::string lower_extension(const std::filesystem::path& file);

}  // namespace relief
