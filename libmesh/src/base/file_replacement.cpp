// SPDX-License-Identifier: Apache-2.0
// Temporary files that are renamed. Files in progress are in a list of fixed size, because a signal
// handler can neither lock nor allocate.
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

#include "relief/mesh/report.h"

namespace relief {
namespace {

/// A file in progress, for the signal handler.
struct ListedFile {
    enum State { free, changing, held };
    std::atomic<int> state = free;
    std::array<char, PATH_MAX> path;
};

constexpr std::size_t max_listed = 128;
std::array<ListedFile, max_listed> listed_files;
std::atomic<bool> is_ending = false;
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

/// Waits for the end of the program if it is ending: no new files must be written then.
void wait_if_ending() {
    while (is_ending)
        ::pause();
}

/// Adds a file to the list. \return its index, or max_listed if the list is full
std::size_t add_to_list(const std::filesystem::path& file) {
    const std::string path = std::filesystem::absolute(file).string();
    if (path.size() >= PATH_MAX) return max_listed;
    for (std::size_t at = 0; at < max_listed; ++at) {
        int expected = ListedFile::free;
        if (!listed_files[at].state.compare_exchange_strong(expected, ListedFile::changing))
            continue;
        std::memcpy(listed_files[at].path.data(), path.c_str(), path.size() + 1);
        listed_files[at].state = ListedFile::held;
        return at;
    }
    return max_listed;
}

void remove_from_list(std::size_t place) {
    if (place < max_listed) listed_files[place].state = ListedFile::free;
}

/// Removes all listed files.
void remove_all() {
    for (const ListedFile& place : listed_files) {
        if (place.state == ListedFile::held) ::unlink(place.path.data());
    }
}

/// The signal handler; it calls only async-signal-safe functions.
void end_cleanly(int signal) {
    const int error = errno;
    is_ending = true;
    remove_all();
    // Other threads still run; one that was creating its file has done so after this delay.
    constexpr int milliseconds = 5;
    ::poll(nullptr, 0, milliseconds);
    remove_all();
    std::signal(signal, SIG_DFL);
    std::raise(signal);  // The signal is blocked here, so it takes effect on return.
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
    : file_(std::move(file)), place_(max_listed) {
    const std::filesystem::path folder =
        file_.has_parent_path() ? file_.parent_path() : std::filesystem::path(".");
    if (!std::filesystem::is_directory(folder)) {
        throw FileError(file_, fmt::format("the folder {} does not exist", folder.string()));
    }
    if (std::filesystem::is_directory(file_)) throw FileError(file_, "is a folder");
    // Renaming would replace /dev/null, or the pipe behind /dev/stdout, by a file.
    if (std::filesystem::exists(file_) && !std::filesystem::is_regular_file(file_))
        throw FileError(file_, "is a device or a pipe, which would be replaced by a file");
    // Unique among all processes and threads that may write here at the same time.
    static std::atomic<unsigned> counter = 0;
    temporary_ = folder / fmt::format(".{}.{}-{}{}", file_.stem().string(), ::getpid(), counter++,
                                      file_.extension().string());
    wait_if_ending();
    place_ = add_to_list(temporary_);
}

FileReplacement::~FileReplacement() {
    std::error_code ignored;
    if (!committed_) std::filesystem::remove(temporary_, ignored);
    remove_from_list(place_);
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
