// SPDX-License-Identifier: Apache-2.0
#include "file_replacement.h"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "relief/mesh/error.h"

namespace relief {

FileReplacement::FileReplacement(std::filesystem::path file) : file_(std::move(file)) {
    const std::filesystem::path folder =
        file_.has_parent_path() ? file_.parent_path() : std::filesystem::path(".");
    if (!std::filesystem::is_directory(folder)) {
        throw FileError(file_, fmt::format("the folder {} does not exist", folder.string()));
    }
    if (std::filesystem::is_directory(file_)) throw FileError(file_, "is a folder");
    // Unique among the processes and threads that may write here at once.
    static std::atomic<unsigned> counter = 0;
    temporary_ = folder / fmt::format(".{}.{}-{}{}", file_.stem().string(), ::getpid(), counter++,
                                      file_.extension().string());
}

FileReplacement::~FileReplacement() {
    std::error_code ignored;
    if (!committed_) std::filesystem::remove(temporary_, ignored);
}

void FileReplacement::commit() {
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
