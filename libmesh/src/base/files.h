// SPDX-License-Identifier: Apache-2.0
/// \file
/// Reading files as a whole or in parts, with errors that tell the reason; text and numbers in
/// their bytes; writing a file such that a failure leaves the old file intact and no partial file.
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

/// A temporary file beside the file that it will replace.
///
/// Write to written_path(), which exists and is empty, then call commit(). Without commit(), the
/// destructor removes the temporary file. Its name is random and keeps the extension, from which
/// writers choose the format. A symbolic link is followed: the file that it names is replaced. The
/// mode and, where the system permits it, the owner of a replaced file are kept; other hard links
/// to it keep the old contents.
class FileReplacement {
  public:
    /// \throws FileError if the folder does not exist, or `file` is a folder, a device or a pipe
    explicit FileReplacement(std::filesystem::path file);
    ~FileReplacement();
    FileReplacement(const FileReplacement&) = delete;
    FileReplacement& operator=(const FileReplacement&) = delete;

    [[nodiscard]] const std::filesystem::path& file() const { return file_; }
    /// The name of the temporary file.
    [[nodiscard]] const std::filesystem::path& temporary() const { return temporary_; }
    /// A path to the temporary file that stays its own if another program replaces the name by a
    /// link: that of the open descriptor in /proc. Without /proc it is temporary().
    [[nodiscard]] std::filesystem::path written_path() const;

    /// Waits until the temporary file is on the disk, so that commit() only renames it.
    /// \throws FileError
    void complete();

    /// Calls complete() if needed, and renames the temporary file. \throws FileError
    void commit();

    /// Commits this file and then another that belongs to it. If the other one fails, the old file
    /// comes back, unless the file system cannot exchange two files. \throws FileError
    void commit_with(FileReplacement& other);

  private:
    std::filesystem::path file_;
    std::filesystem::path target_;  ///< `file_`, or the file that the link `file_` names.
    std::filesystem::path temporary_;
    int descriptor_ = -1;
    bool is_complete_ = false;
    bool committed_ = false;
    std::size_t place_;  ///< Index in the list of files that a signal removes.
};

/// Makes SIGINT, SIGTERM and SIGHUP remove all temporary files before they end the program.
///
/// Programs call this once, before they start threads; a library must not handle the signals of its
/// user. Ignored signals stay ignored. At most 128 files at a time are known; further ones would
/// remain.
void remove_temporaries_on_signals();

/// Writes all bytes to a new temporary file. \throws FileError
void write_all(const FileReplacement& replacement, std::span<const std::byte> bytes);

/// Replaces the contents of a file. \throws FileError
void replace_file(const std::filesystem::path& file, std::span<const std::byte> bytes);

}  // namespace relief
