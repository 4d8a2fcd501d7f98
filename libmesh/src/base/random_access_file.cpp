// SPDX-License-Identifier: Apache-2.0
// Parts of files by pread, which moves no position that anybody shares. Not mapped into memory: a
// file that gets shorter meanwhile is then an error instead of a signal. Tests:
// tests/mesh/base/random_access_file_test.cpp.
#include "random_access_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "progress_stage.h"
#include "relief/mesh/error.h"

namespace relief {

RandomAccessFile::RandomAccessFile(std::filesystem::path file) : path_(std::move(file)) {
    note_file(path_);
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path_, error);
    if (!std::filesystem::exists(status)) throw FileError(path_, "no such file");
    if (!std::filesystem::is_regular_file(status)) throw FileError(path_, "is not a file");
    descriptor_ = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor_ < 0)
        throw FileError(path_, fmt::format("cannot be opened: {}", std::strerror(errno)));
    struct stat facts {};
    if (::fstat(descriptor_, &facts) == 0) size_ = static_cast<std::uint64_t>(facts.st_size);
}

RandomAccessFile::~RandomAccessFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

void RandomAccessFile::read(std::uint64_t from, std::span<std::byte> to) const {
    while (!to.empty()) {
        const ssize_t got = ::pread(descriptor_, to.data(), to.size(), static_cast<off_t>(from));
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) {
            throw FileError(path_,
                            fmt::format("could be read only up to byte {} of {}{}", from, size_,
                                        got < 0 ? fmt::format(": {}", std::strerror(errno)) : ""));
        }
        from += static_cast<std::uint64_t>(got);
        to = to.subspan(static_cast<std::size_t>(got));
    }
}

}  // namespace relief
