// SPDX-License-Identifier: Apache-2.0
// Files written beside and renamed. Those that are being written stand in a list of fixed places,
// which a signal handler can walk: it may neither lock nor allocate. Tests:
// tests/mesh/base/file_replacement_test.cpp, tests/tools/interruption_test.cpp.
#include "file_replacement.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstring>
#include <fstream>

#include "relief/mesh/error.h"

namespace relief {
namespace {

/// A file that is being written, for the handler.
struct ListedFile {
    enum State { free, changing, held };
    std::atomic<int> state = free;
    std::array<char, PATH_MAX> path;
};

constexpr std::size_t most_listed = 128;
std::array<ListedFile, most_listed> listed_files;
std::atomic<bool> is_ending = false;
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

/// Waits for the end where one has begun: nothing new is to be written then.
void wait_if_ending() {
    while (is_ending)
        ::pause();
}

/// Where a file is listed; place_count where there is no room.
std::size_t enter(const std::filesystem::path& file) {
    const std::string path = std::filesystem::absolute(file).string();
    if (path.size() >= PATH_MAX) return most_listed;
    for (std::size_t at = 0; at < most_listed; ++at) {
        int expected = ListedFile::free;
        if (!listed_files[at].state.compare_exchange_strong(expected, ListedFile::changing))
            continue;
        std::memcpy(listed_files[at].path.data(), path.c_str(), path.size() + 1);
        listed_files[at].state = ListedFile::held;
        return at;
    }
    return most_listed;
}

void leave(std::size_t place) {
    if (place < most_listed) listed_files[place].state = ListedFile::free;
}

/// Removes what is listed.
void remove_all() {
    for (const ListedFile& place : listed_files) {
        if (place.state == ListedFile::held) ::unlink(place.path.data());
    }
}

/// Only what may be called in a signal handler.
void end_cleanly(int signal) {
    const int error = errno;
    is_ending = true;
    remove_all();
    // Other threads still run, and one that was about to begin its file has done so by then.
    constexpr int milliseconds = 5;
    ::poll(nullptr, 0, milliseconds);
    remove_all();
    std::signal(signal, SIG_DFL);
    std::raise(signal);  // Takes effect on return, as it is blocked in here.
    errno = error;
}

}  // namespace

void remove_temporaries_on_signals() {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction now {};
        if (::sigaction(signal, nullptr, &now) != 0 || now.sa_handler == SIG_IGN) continue;
        struct sigaction clean {};
        clean.sa_handler = end_cleanly;
        for (const int other : {SIGINT, SIGTERM, SIGHUP})
            ::sigaddset(&clean.sa_mask, other);
        ::sigaction(signal, &clean, nullptr);
    }
}

FileReplacement::FileReplacement(std::filesystem::path file)
    : file_(std::move(file)), place_(most_listed) {
    const std::filesystem::path folder =
        file_.has_parent_path() ? file_.parent_path() : std::filesystem::path(".");
    if (!std::filesystem::is_directory(folder)) {
        throw FileError(file_, fmt::format("the folder {} does not exist", folder.string()));
    }
    if (std::filesystem::is_directory(file_)) throw FileError(file_, "is a folder");
    // Renaming would put a file in the place of /dev/null, or of the pipe behind /dev/stdout.
    if (std::filesystem::exists(file_) && !std::filesystem::is_regular_file(file_))
        throw FileError(file_, "is a device or a pipe, which would be replaced by a file");
    // Unique among the processes and threads that may write here at once.
    static std::atomic<unsigned> counter = 0;
    temporary_ = folder / fmt::format(".{}.{}-{}{}", file_.stem().string(), ::getpid(), counter++,
                                      file_.extension().string());
    wait_if_ending();
    place_ = enter(temporary_);
}

FileReplacement::~FileReplacement() {
    std::error_code ignored;
    if (!committed_) std::filesystem::remove(temporary_, ignored);
    leave(place_);
}

void FileReplacement::commit() {
    wait_if_ending();
    std::error_code error;
    std::filesystem::rename(temporary_, file_, error);
    if (error) throw FileError(file_, "cannot be written: " + error.message());
    committed_ = true;
}

void replace_file(const std::filesystem::path& file, std::span<const std::byte> bytes) {
    FileReplacement replacement(file);
    std::ofstream stream(replacement.temporary(), std::ios::binary);
    stream.write(reinterpret_cast<const char*>(bytes.data()),
                 static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream) throw FileError(file, fmt::format("cannot be written: {}", std::strerror(errno)));
    replacement.commit();
}

}  // namespace relief
