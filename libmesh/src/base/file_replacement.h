// SPDX-License-Identifier: Apache-2.0
/// \file
/// Replacing files, alone or in sets: after a failure or a signal, all files of a set are old or
/// all are new, and no temporary file is left.
///
/// A new file is written beside the old one with a temporary name. When all files of a set are
/// complete, each old file gets a second name, and each new file is renamed. If a step fails, the
/// old files get their names back. Signals that end the program wait during these steps
/// (remove_temporaries_on_signals()). Only a crash, SIGKILL or a power failure between two renames
/// leaves a mixture, with the old files under names that begin with ".relief-".
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "operating_system.h"
#include "relief/export.h"

namespace RELIEF_API relief {
namespace detail {

class StagedFile;

/// A new file that will replace an old one.
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

    [[nodiscard]] const std::filesystem::path& file() const;
    /// The name of the temporary file.
    [[nodiscard]] const std::filesystem::path& temporary() const;
    /// A path to the temporary file that stays its own if another program replaces the name by a
    /// link: that of the open descriptor in /proc. On systems without /proc it is temporary().
    [[nodiscard]] std::filesystem::path written_path() const;

    /// Waits until the temporary file is on the disk, and replaces the old file: at once, or with
    /// the FileSet of this thread. \throws FileError
    void commit();

  private:
    std::shared_ptr<StagedFile> staged_;
};

/// Files that replace old ones together or not at all.
///
/// While a set exists, all files that its thread and the loops of its thread commit join it.
/// Reading one of them by its final name gives the new contents (staged_file()). A set within
/// another one adds its files to the outer one.
class FileSet {
  public:
    FileSet();
    /// Without commit(), the new files are removed.
    ~FileSet();
    FileSet(const FileSet&) = delete;
    FileSet& operator=(const FileSet&) = delete;

    /// Replaces all files and ends the set, or adds the files to the outer set. \throws FileError
    /// after which the old files have their names again; if even this fails, it tells where they
    /// are
    void commit();

  private:
    friend class FileReplacement;
    friend std::filesystem::path staged_file(const std::filesystem::path& file);
    void add(std::shared_ptr<StagedFile> file);

    FileSet* outer_;
    bool is_open_ = true;
    std::mutex mutex_;
    std::vector<std::shared_ptr<StagedFile>> files_;
};

/// The set of this thread; null if there is none. Parallel loops pass it on to their threads.
extern constinit thread_local FileSet* current_file_set;

/// Returns the temporary file with the new contents of `file`, if it is in the current set;
/// otherwise `file`. The functions of files.h read this file.
std::filesystem::path staged_file(const std::filesystem::path& file);

/// Delays the signals of remove_temporaries_on_signals() during its lifetime, in all threads.
///
/// Meanwhile, this thread must not allocate memory, throw, or take a lock that other code holds:
/// the signal may have interrupted that code in another thread.
class SignalDelay {
  public:
    SignalDelay();
    ~SignalDelay();
    SignalDelay(const SignalDelay&) = delete;
    SignalDelay& operator=(const SignalDelay&) = delete;

  private:
    SignalMask before_;
};

/// Makes SIGINT, SIGTERM, SIGHUP, SIGQUIT and SIGXCPU (on Windows: Ctrl+C, Ctrl+Break and closing
/// the console) remove all temporary files before they end the program.
///
/// Programs call this once, before they start threads; a library must not handle the signals of its
/// user. Ignored signals stay ignored.
void remove_temporaries_on_signals();

/// Returns the number of files that this program has replaced or created.
std::size_t replaced_file_count();

/// Writes all bytes to a new temporary file. \throws FileError
void write_all(const FileReplacement& replacement, std::span<const std::byte> bytes);

/// Replaces the contents of a file. \throws FileError
void replace_file(const std::filesystem::path& file, std::span<const std::byte> bytes);

}  // namespace detail
}  // namespace relief
