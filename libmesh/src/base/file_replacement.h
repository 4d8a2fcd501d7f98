// SPDX-License-Identifier: Apache-2.0
/// \file
/// Writing a file so that a failure leaves no half file and the old one unharmed.
/// Tests: tests/mesh/base/file_replacement_test.cpp.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace relief {

/// A file being written beside the one it will replace.
///
/// Write to temporary(), then commit(); without commit(), the destructor removes what was written.
/// The temporary name keeps the extension, by which writers choose their format.
class FileReplacement {
  public:
    /// \throws FileError if the folder does not exist, or `file` is a folder, a device or a pipe
    explicit FileReplacement(std::filesystem::path file);
    ~FileReplacement();
    FileReplacement(const FileReplacement&) = delete;
    FileReplacement& operator=(const FileReplacement&) = delete;

    [[nodiscard]] const std::filesystem::path& temporary() const { return temporary_; }

    /// Renames over the old file. \throws FileError
    void commit();

  private:
    std::filesystem::path file_;
    std::filesystem::path temporary_;
    bool committed_ = false;
    std::size_t place_;  ///< In the list of those that a signal removes.
};

/// From now on a program that is ended by SIGINT, SIGTERM or SIGHUP first removes what it has
/// written beside: no half file and no temporary one stays. It still dies by the signal.
///
/// For programs, once, before they start threads: a library does not take signals from its user. A
/// signal that is ignored stays so. Up to 128 files at once are known; of more, some would stay.
void remove_temporaries_on_signals();

/// Replaces a file by these bytes. \throws FileError
void replace_file(const std::filesystem::path& file, std::span<const std::byte> bytes);

}  // namespace relief
