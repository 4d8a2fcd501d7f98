// SPDX-License-Identifier: Apache-2.0
/// \file
/// The operating system beyond the standard library: open files, names of files, signals and the
/// memory of the machine.
///
/// operating_system_posix.cpp is for Linux and macOS, operating_system_windows.cpp for Windows.
/// Paths reach the system in its own characters, so Windows reads names in every script. Errors are
/// numbers of the system (errno, or GetLastError() on Windows); 0 is none. Functions that are
/// noexcept allocate no memory. Both files also define stamp_of() of relief/mesh/execution.h.
#pragma once

#if !defined(_WIN32)
#include <csignal>
#endif
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace relief::detail {

/// Returns the text of an error.
std::string error_text(int error);

/// Returns the bytes of memory of the machine, or of the control group (version 2) of this process;
/// 8 GiB if they are unknown.
std::uint64_t memory_of_machine();

// Open files.

struct OpenFile {
    int descriptor = -1;  ///< -1 after an error.
    int error = 0;
};

OpenFile open_to_read(const std::filesystem::path& file);

/// Creates an empty file. An existing file or link is never opened: is_name_in_use(error).
OpenFile create_exclusively(const std::filesystem::path& file);
bool is_name_in_use(int error);

void close_descriptor(int descriptor) noexcept;

/// Returns the bytes of a file; 0 if they are unknown.
std::uint64_t size_of(int descriptor);

struct ReadResult {
    std::size_t size = 0;  ///< 0 at the end of the file and after an error.
    int error = 0;
};

/// Reads up to `to.size()` bytes at an offset.
ReadResult read_at(int descriptor, std::span<std::byte> to, std::uint64_t offset);

/// Waits until a file is on the disk. File systems that cannot do this return no error.
int synchronize(int descriptor) noexcept;

/// Returns a path that names the open file even if its own name is given to another one. No value
/// on systems without /proc.
std::optional<std::filesystem::path> path_of_descriptor(int descriptor);

/// Gives an open file the mode and, if permitted, the owner of another one. On Windows, new files
/// have the permissions of their folder.
void copy_mode_and_owner(const std::filesystem::path& from, int to);

/// Returns true if the name is that of the open file; links are not followed.
bool is_same_file(const std::filesystem::path& name, int descriptor) noexcept;

// Names of files. Links are not followed.

/// Renames a file, or replaces another one. An error leaves both as they are.
int rename_file(const std::filesystem::path& from, const std::filesystem::path& to) noexcept;

/// Gives a file a second name. The error for a missing file is is_missing().
int link_file(const std::filesystem::path& file, const std::filesystem::path& second) noexcept;
bool is_missing(int error);

int remove_file(const std::filesystem::path& file) noexcept;

/// Returns the error of an entry that is missing or a folder.
int require_no_folder(const std::filesystem::path& entry) noexcept;

// Signals.

#if defined(_WIN32)
/// Console events come on a thread of their own, so no thread needs to block them.
struct SignalMask {};
#else
using SignalMask = sigset_t;
#endif

/// Blocks the signals that end programs (SIGINT, SIGTERM, SIGHUP, SIGQUIT and SIGXCPU) in this
/// thread. \return the mask for restore_signals()
SignalMask block_ending_signals() noexcept;
void restore_signals(const SignalMask& before) noexcept;

/// Calls a function before one of these signals, unless it is ignored, ends the program; on
/// Windows, before Ctrl+C or Ctrl+Break, or closing the console. It runs in a signal handler or on
/// another thread.
void call_before_end(void (*clean)());

/// Can be called in signal handlers.
void sleep_one_millisecond() noexcept;

}  // namespace relief::detail
