// SPDX-License-Identifier: Apache-2.0
// Reading files. Missing files, folders and read errors have different messages. Files are not
// mapped into memory: a mapped file that becomes shorter would give a signal instead of an error.
#include "file_bytes.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <span>
#include <utility>

#include "large_memory.h"
#include "parallel.h"
#include "progress_stage.h"
#include "relief/mesh/report.h"
#include "require_memory.h"

namespace relief {
namespace {

/// Records that a file is read. \throws FileError if it is missing or a folder
void note_and_check(const std::filesystem::path& file) {
    note_file(file);
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(file, error);
    if (!std::filesystem::exists(status)) throw FileError(file, "no such file");
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

}  // namespace relief
