// SPDX-License-Identifier: Apache-2.0
// Reading files. Missing files, folders and read errors have different messages. Files are not
// mapped into memory: a mapped file that becomes shorter would give a signal instead of an error.
//
// Writing goes to temporary files that are renamed. Files in progress are in a list of fixed size,
// because a signal handler can neither lock nor allocate.
#include "files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <span>
#include <utility>

#include "large_memory.h"
#include "parallel.h"
#include "progress_stage.h"
#include "relief/mesh/report.h"

namespace relief {
namespace {

/// Records that a file is read. \throws FileError if it is missing or a folder
void note_and_check(const std::filesystem::path& file) {
    note_file(file);
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(file, error);
    if (status.type() == std::filesystem::file_type::not_found)
        throw FileError(file, "no such file");
    if (error) throw FileError(file, fmt::format("cannot be opened: {}", error.message()));
    if (!std::filesystem::is_regular_file(status)) throw FileError(file, "is not a file");
}

}  // namespace

std::string read_file(const std::filesystem::path& file) {
    note_and_check(file);
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw FileError(file, fmt::format("cannot be opened: {}", std::strerror(errno)));
    const std::size_t size = std::filesystem::file_size(file);
    require_memory_for(file, size);
    std::string bytes;
    bytes.reserve(size);
    expect_filling(bytes.data(), size);
    bytes.resize(size);
    constexpr std::size_t piece = 1 << 22;
    ProgressStage stage("reading", size);
    for (std::size_t begin = 0; begin < size; begin += piece) {
        const std::size_t length = std::min(piece, size - begin);
        stream.read(&bytes[begin], static_cast<std::streamsize>(length));
        const auto got = static_cast<std::size_t>(stream.gcount());
        if (got != length) {
            throw FileError(
                file, fmt::format("could be read only up to byte {} of {}", begin + got, size));
        }
        stage.advance(length);
    }
    return bytes;
}

FileContents::FileContents(const std::filesystem::path& file) {
    constexpr std::size_t piece = 1 << 22;
    const RandomAccessFile opened(file);
    size_ = static_cast<std::size_t>(opened.size());
    require_memory_for(file, size_);
    bytes_ = std::make_unique_for_overwrite<char[]>(size_);
    expect_filling(bytes_.get(), size_);
    ProgressStage stage("reading", size_);
    parallel_for((size_ + piece - 1) / piece, 1, [&](std::size_t first, std::size_t last) {
        const std::size_t begin = first * piece;
        const std::size_t end = std::min(last * piece, size_);
        opened.read(begin, std::as_writable_bytes(std::span(&bytes_[begin], end - begin)));
        stage.advance(end - begin);
    });
}

RandomAccessFile::RandomAccessFile(std::filesystem::path file) : path_(std::move(file)) {
    note_and_check(path_);
    descriptor_ = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor_ < 0)
        throw FileError(path_, fmt::format("cannot be opened: {}", std::strerror(errno)));
    struct stat facts {};
    if (::fstat(descriptor_, &facts) == 0) size_ = static_cast<std::uint64_t>(facts.st_size);
}

RandomAccessFile::~RandomAccessFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

void RandomAccessFile::read(std::uint64_t offset, std::span<std::byte> to) const {
    while (!to.empty()) {
        const ssize_t got = ::pread(descriptor_, to.data(), to.size(), static_cast<off_t>(offset));
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) {
            throw FileError(path_,
                            fmt::format("could be read only up to byte {} of {}{}", offset, size_,
                                        got < 0 ? fmt::format(": {}", std::strerror(errno)) : ""));
        }
        offset += static_cast<std::uint64_t>(got);
        to = to.subspan(static_cast<std::size_t>(got));
    }
}

std::string lower_extension(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    return extension;
}

std::size_t utf8_length(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned first = byte(0);
    if (first < 0x80) return 1;
    const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
    if (first < 0xC2 || first > 0xF4 || length > text.size()) return 0;
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xC0U) != 0x80) return 0;
    }
    // No second form of a shorter character, no surrogate, nothing above U+10FFFF.
    const unsigned second = byte(1);
    const bool is_wrong = (first == 0xE0 && second < 0xA0) || (first == 0xED && second > 0x9F) ||
                          (first == 0xF0 && second < 0x90) || (first == 0xF4 && second > 0x8F);
    return is_wrong ? 0 : length;
}

bool is_utf8(std::string_view text) {
    while (!text.empty()) {
        const std::size_t length = utf8_length(text);
        if (length == 0) return false;
        text.remove_prefix(length);
    }
    return true;
}

std::string utf8_name(std::string name, std::string_view element, std::size_t index,
                      Report& report) {
    if (is_utf8(name)) return name;
    report.add("name that is not UTF-8", element, index, "is read as Latin-1");
    std::string converted;
    for (const char letter : name) {  // The codes of Latin-1 are those of Unicode.
        const auto code = static_cast<unsigned char>(letter);
        if (code < 0x80) {
            converted += letter;
        } else {
            converted += static_cast<char>(0xC0 | code >> 6);
            converted += static_cast<char>(0x80 | (code & 0x3F));
        }
    }
    return converted;
}

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
    std::error_code missing;  // The working folder was deleted: the file cannot be created either.
    const std::string path = std::filesystem::absolute(file, missing).string();
    if (missing || path.size() >= PATH_MAX) return max_listed;
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

namespace {

/// Returns the file that is replaced: `file`, or the file that it links to, which need not exist.
std::filesystem::path target_of(const std::filesystem::path& file) {
    constexpr int max_links = 40;
    std::filesystem::path target = file;
    std::error_code error;
    for (int links = 0; std::filesystem::is_symlink(target, error); ++links) {
        if (links == max_links) throw FileError(file, "is a link that leads back to itself");
        // An absolute link replaces the folder.
        target = target.parent_path() / std::filesystem::read_symlink(target, error);
    }
    return target;
}

/// Returns a random name in the folder of the target, with its extension.
std::filesystem::path random_name_beside(const std::filesystem::path& target) {
    constexpr std::size_t max_extension = 16;
    std::string extension = target.extension().string();
    if (extension.size() > max_extension) extension.clear();
    std::uint64_t number = 0;
    while (::getrandom(&number, sizeof number, 0) < 0 && errno == EINTR) {
    }
    return std::filesystem::path(target).replace_filename(
        fmt::format(".relief-{:016x}{}", number, extension));
}

/// Creates an empty file; an existing file or a link is never opened. \return its descriptor
int create_exclusively(const std::filesystem::path& file) {
    constexpr ::mode_t everybody = 0666;  // Reduced by the umask.
    return ::open(file.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, everybody);
}

/// Gives the temporary file the mode and the owner of the file that it replaces.
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

bool is_same_file(const std::filesystem::path& path, int descriptor) {
    struct stat named {};
    struct stat opened {};
    return ::lstat(path.c_str(), &named) == 0 && ::fstat(descriptor, &opened) == 0 &&
           named.st_dev == opened.st_dev && named.st_ino == opened.st_ino;
}

}  // namespace

FileReplacement::FileReplacement(std::filesystem::path file)
    : file_(std::move(file)), target_(target_of(file_)), place_(max_listed) {
    const std::filesystem::path folder =
        target_.has_parent_path() ? target_.parent_path() : std::filesystem::path(".");
    std::error_code unknown;
    if (!std::filesystem::is_directory(folder, unknown)) {
        throw FileError(file_, fmt::format("the folder {} does not exist", folder.string()));
    }
    const std::filesystem::file_status status = std::filesystem::status(target_, unknown);
    if (std::filesystem::is_directory(status)) throw FileError(file_, "is a folder");
    // Renaming would replace /dev/null, or the pipe behind /dev/stdout, by a file.
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
        throw FileError(file_, "is a device or a pipe, which would be replaced by a file");
    wait_if_ending();
    constexpr int max_attempts = 100;
    for (int attempt = 0; attempt < max_attempts && descriptor_ < 0; ++attempt) {
        temporary_ = random_name_beside(target_);
        place_ = add_to_list(temporary_);  // A signal may arrive as soon as the file exists.
        descriptor_ = create_exclusively(temporary_);
        if (descriptor_ >= 0) return;
        const int error = errno;
        remove_from_list(place_);
        if (error != EEXIST)
            throw FileError(file_, fmt::format("cannot be written: {}", std::strerror(error)));
    }
    throw FileError(file_, "cannot be written: no temporary file can be made beside it");
}

FileReplacement::~FileReplacement() {
    if (!committed_ && is_same_file(temporary_, descriptor_)) ::unlink(temporary_.c_str());
    if (descriptor_ >= 0) ::close(descriptor_);
    remove_from_list(place_);
}

std::filesystem::path FileReplacement::written_path() const {
    std::filesystem::path path = fmt::format("/proc/self/fd/{}", descriptor_);
    return ::access(path.c_str(), W_OK) == 0 ? path : temporary_;
}

void FileReplacement::complete() {
    if (is_complete_) return;
    copy_mode_and_owner(target_, descriptor_);
    // Some file systems cannot synchronize, which is no error.
    if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != ENOTSUP)
        throw FileError(file_, fmt::format("cannot be written: {}", std::strerror(errno)));
    is_complete_ = true;
}

void FileReplacement::commit() {
    complete();
    wait_if_ending();
    if (!is_same_file(temporary_, descriptor_))
        throw FileError(file_, "cannot be written: another program replaced the temporary file");
    std::error_code error;
    std::filesystem::rename(temporary_, target_, error);
    if (error) throw FileError(file_, "cannot be written: " + error.message());
    committed_ = true;
}

void FileReplacement::commit_with(FileReplacement& other) {
    complete();
    other.complete();
    // The old file has the name of the temporary one until the other file is committed.
    const auto exchange = [&] {
        return ::renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD, target_.c_str(),
                           RENAME_EXCHANGE) == 0;
    };
    wait_if_ending();
    const bool holds_old = is_same_file(temporary_, descriptor_) && exchange();
    const bool is_new = !holds_old && errno == ENOENT;
    if (!holds_old) commit();
    try {
        other.commit();
    } catch (...) {
        if (holds_old) exchange();
        if (is_new) ::unlink(target_.c_str());
        throw;
    }
    if (holds_old) ::unlink(temporary_.c_str());
    committed_ = true;
}

void write_all(const FileReplacement& replacement, std::span<const std::byte> bytes) {
    std::ofstream stream(replacement.written_path(), std::ios::binary);
    stream.write(reinterpret_cast<const char*>(bytes.data()),
                 static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream) {
        throw FileError(replacement.file(),
                        fmt::format("cannot be written: {}", std::strerror(errno)));
    }
}

void replace_file(const std::filesystem::path& file, std::span<const std::byte> bytes) {
    FileReplacement replacement(file);
    write_all(replacement, bytes);
    replacement.commit();
}

}  // namespace relief
