// SPDX-License-Identifier: Apache-2.0
/// \file
/// Reading parts of a file that may be larger than memory.
/// Tests: tests/mesh/base/random_access_file_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

namespace relief {

/// A file opened for reading.
class RandomAccessFile {
  public:
    /// \throws FileError if it is missing, a folder or unreadable
    explicit RandomAccessFile(std::filesystem::path file);
    ~RandomAccessFile();
    RandomAccessFile(const RandomAccessFile&) = delete;
    RandomAccessFile& operator=(const RandomAccessFile&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    /// In bytes, when it was opened.
    [[nodiscard]] std::uint64_t size() const { return size_; }

    /// Fills `to` from a place on. \throws FileError if that cannot be done, or the file ends
    /// before
    void read(std::uint64_t from, std::span<std::byte> to) const;

  private:
    std::filesystem::path path_;
    int descriptor_ = -1;
    std::uint64_t size_ = 0;
};

}  // namespace relief
