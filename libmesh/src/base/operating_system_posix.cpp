// SPDX-License-Identifier: Apache-2.0
// Linux and macOS.
#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <string>
#include <system_error>

#include "operating_system.h"
#include "relief/mesh/execution.h"

namespace relief {

FileStamp stamp_of(const std::filesystem::path& file) {
    struct stat facts {};
    if (::stat(file.c_str(), &facts) != 0) return {};
#if defined(__APPLE__)
    const timespec& changed = facts.st_mtimespec;
#else
    const timespec& changed = facts.st_mtim;
#endif
    return {static_cast<std::int64_t>(changed.tv_sec) * 1'000'000'000 + changed.tv_nsec,
            static_cast<std::uint64_t>(facts.st_size), static_cast<std::uint64_t>(facts.st_ino)};
}

namespace detail {
namespace {

constexpr int ending_signals[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXCPU};

sigset_t all_ending_signals() {
    sigset_t all;
    sigemptyset(&all);  // Macros on macOS.
    for (const int signal : ending_signals)
        sigaddset(&all, signal);
    return all;
}

}  // namespace

std::string error_text(int error) {
    return std::system_category().message(error);
}

std::uint64_t memory_of_machine() {
    constexpr std::uint64_t unknown = std::uint64_t{1} << 33;
    const long pages = ::sysconf(_SC_PHYS_PAGES);
    const long page_size = ::sysconf(_SC_PAGESIZE);
    std::uint64_t bytes = pages > 0 && page_size > 0 ? static_cast<std::uint64_t>(pages) *
                                                           static_cast<std::uint64_t>(page_size)
                                                     : unknown;
    std::ifstream group("/sys/fs/cgroup/memory.max");
    std::uint64_t of_group = 0;  // The file has the word "max" if there is no limit.
    if (group >> of_group) bytes = std::min(bytes, of_group);
    return bytes;
}

// Open files.

OpenFile open_to_read(const std::filesystem::path& file) {
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
    return {descriptor, descriptor < 0 ? errno : 0};
}

OpenFile create_exclusively(const std::filesystem::path& file) {
    constexpr ::mode_t everybody = 0666;  // Reduced by the umask.
    const int descriptor =
        ::open(file.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, everybody);
    return {descriptor, descriptor < 0 ? errno : 0};
}

bool is_name_in_use(int error) {
    return error == EEXIST;
}

void close_descriptor(int descriptor) noexcept {
    ::close(descriptor);
}

std::uint64_t size_of(int descriptor) {
    struct stat facts {};
    return ::fstat(descriptor, &facts) == 0 ? static_cast<std::uint64_t>(facts.st_size) : 0;
}

ReadResult read_at(int descriptor, std::span<std::byte> to, std::uint64_t offset) {
    ssize_t size = -1;
    do {
        size = ::pread(descriptor, to.data(), to.size(), static_cast<off_t>(offset));
    } while (size < 0 && errno == EINTR);
    if (size < 0) return {0, errno};
    return {static_cast<std::size_t>(size), 0};
}

int synchronize(int descriptor) noexcept {
    return ::fsync(descriptor) != 0 && errno != EINVAL && errno != ENOTSUP ? errno : 0;
}

std::optional<std::filesystem::path> path_of_descriptor(int descriptor) {
    std::filesystem::path path = "/proc/self/fd/" + std::to_string(descriptor);
    if (::access(path.c_str(), W_OK) != 0) return std::nullopt;
    return path;
}

void copy_mode_and_owner(const std::filesystem::path& from, int to) {
    struct stat old {};
    struct stat now {};
    if (::stat(from.c_str(), &old) != 0 || ::fstat(to, &now) != 0) return;
    // Only privileged programs may change owners. A change clears the bits that set identifiers.
    const bool is_same = old.st_uid == now.st_uid && old.st_gid == now.st_gid;
    const bool changed = !is_same && ::fchown(to, old.st_uid, old.st_gid) == 0;
    constexpr ::mode_t all_bits = 07777;
    constexpr ::mode_t permissions = 0777;
    ::fchmod(to, old.st_mode & (is_same || changed ? all_bits : permissions));
}

bool is_same_file(const std::filesystem::path& name, int descriptor) noexcept {
    struct stat named {};
    struct stat opened {};
    return ::lstat(name.c_str(), &named) == 0 && ::fstat(descriptor, &opened) == 0 &&
           named.st_dev == opened.st_dev && named.st_ino == opened.st_ino;
}

// Names of files.

int rename_file(const std::filesystem::path& from, const std::filesystem::path& to) noexcept {
    return ::rename(from.c_str(), to.c_str()) == 0 ? 0 : errno;
}

int link_file(const std::filesystem::path& file, const std::filesystem::path& second) noexcept {
    return ::link(file.c_str(), second.c_str()) == 0 ? 0 : errno;
}

bool is_missing(int error) {
    return error == ENOENT;
}

int remove_file(const std::filesystem::path& file) noexcept {
    return ::unlink(file.c_str()) == 0 ? 0 : errno;
}

int require_no_folder(const std::filesystem::path& entry) noexcept {
    struct stat facts {};
    if (::lstat(entry.c_str(), &facts) != 0) return errno;
    return S_ISDIR(facts.st_mode) ? EISDIR : 0;
}

// Signals.

SignalMask block_ending_signals() noexcept {
    const sigset_t all = all_ending_signals();
    SignalMask before;
    ::pthread_sigmask(SIG_BLOCK, &all, &before);
    return before;
}

void restore_signals(const SignalMask& before) noexcept {
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

namespace {

void (*clean_before_end)() = nullptr;

/// The signal handler; it calls only async-signal-safe functions.
void end_cleanly(int signal) {
    const int error = errno;
    clean_before_end();
    std::signal(signal, SIG_DFL);
    std::raise(signal);  // The signal is blocked here, so it takes effect on return.
    errno = error;
}

}  // namespace

void call_before_end(void (*clean)()) {
    clean_before_end = clean;
    for (const int signal : ending_signals) {
        struct sigaction now {};
        if (::sigaction(signal, nullptr, &now) != 0 || now.sa_handler == SIG_IGN) continue;
        struct sigaction ending {};
        ending.sa_handler = end_cleanly;
        ending.sa_mask = all_ending_signals();
        ::sigaction(signal, &ending, nullptr);
    }
}

void sleep_one_millisecond() noexcept {
    ::poll(nullptr, 0, 1);
}

}  // namespace detail
}  // namespace relief
