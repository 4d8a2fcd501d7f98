// SPDX-License-Identifier: Apache-2.0
/// \file
/// Reading files as a whole or in parts, with errors that tell the reason; text and numbers in
/// their bytes. Writing is in file_replacement.h; files of an open FileSet are read as they will
/// be.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "relief/export.h"

namespace RELIEF_API relief {

class Report;

namespace detail {

/// Returns the bytes of a file, as text. \throws FileError if it is missing, a folder or unreadable
std::string read_file(const std::filesystem::path& file);

/// The bytes of a large file, read on all threads into memory that is not cleared first.
class FileContents {
  public:
    /// \throws FileError as read_file()
    explicit FileContents(const std::filesystem::path& file);

    [[nodiscard]] std::string_view text() const { return {bytes_.get(), size_}; }

  private:
    std::unique_ptr<char[]> bytes_;
    std::size_t size_ = 0;
};

/// A file that is opened for reading, whose parts can be read in any order and in parallel.
class RandomAccessFile {
  public:
    /// \throws FileError if it is missing, a folder or unreadable
    explicit RandomAccessFile(std::filesystem::path file);
    ~RandomAccessFile();
    RandomAccessFile(const RandomAccessFile&) = delete;
    RandomAccessFile& operator=(const RandomAccessFile&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    /// Returns the size in bytes when it was opened.
    [[nodiscard]] std::uint64_t size() const { return size_; }

    [[nodiscard]] int descriptor() const { return descriptor_; }

    /// Fills `to` with the bytes from an offset on. \throws FileError if this fails, or if the file
    /// is too short
    void read(std::uint64_t offset, std::span<std::byte> to) const;

  private:
    std::filesystem::path path_;
    int descriptor_ = -1;
    std::uint64_t size_ = 0;
};

/// Returns the extension in lower case with its dot (".obj"); empty if there is none.
std::string lower_extension(const std::filesystem::path& file);

// Names may be any bytes, but JSON holds UTF-8 only.

/// Returns the bytes of the first character of a text in UTF-8 [RFC 3629]; 0 if it is none.
std::size_t utf8_length(std::string_view text);
bool is_utf8(std::string_view text);

/// Returns a name in UTF-8. One that is not is converted from Latin-1, with a finding for the
/// element that has it.
std::string utf8_name(std::string name, std::string_view element, std::size_t index,
                      Report& report);

// Bytes of a file.

inline std::string_view text_of(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Returns the big-endian number at an offset.
inline std::uint32_t big32(std::span<const std::byte> bytes, std::size_t offset = 0) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
        value = value << 8 | std::to_integer<std::uint32_t>(bytes[offset + i]);
    return value;
}

}  // namespace detail
}  // namespace relief
