// SPDX-License-Identifier: Apache-2.0
// Reading files. Missing files, folders and read errors have different messages. Files are not
// mapped into memory: a mapped file that becomes shorter would give a signal instead of an error.
#include "files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <span>
#include <utility>

#include "file_replacement.h"
#include "large_memory.h"
#include "operating_system.h"
#include "parallel.h"
#include "progress_stage.h"
#include "relief/mesh/report.h"

namespace relief::detail {
namespace {

/// Records that a file is read. \return the file to open \throws FileError if it is missing or a
/// folder
std::filesystem::path note_and_check(const std::filesystem::path& file) {
    note_file(file);
    std::filesystem::path opened = staged_file(file);
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(opened, error);
    if (status.type() == std::filesystem::file_type::not_found)
        throw FileError(file, "no such file");
    if (error) throw FileError(file, fmt::format("cannot be opened: {}", error.message()));
    if (!std::filesystem::is_regular_file(status)) throw FileError(file, "is not a file");
    return opened;
}

}  // namespace

std::string read_file(const std::filesystem::path& file) {
    const std::filesystem::path opened = note_and_check(file);
    std::ifstream stream(opened, std::ios::binary);
    if (!stream) throw FileError(file, fmt::format("cannot be opened: {}", std::strerror(errno)));
    const std::size_t size = std::filesystem::file_size(opened);
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
    bytes_.reset(new char[size_]);  // libc++ 14 has no std::make_unique_for_overwrite().
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
    const std::filesystem::path opened = note_and_check(path_);
    const OpenFile result = open_to_read(opened);
    if (result.error != 0)
        throw FileError(path_, fmt::format("cannot be opened: {}", error_text(result.error)));
    descriptor_ = result.descriptor;
    size_ = size_of(descriptor_);
}

RandomAccessFile::~RandomAccessFile() {
    if (descriptor_ >= 0) close_descriptor(descriptor_);
}

void RandomAccessFile::read(std::uint64_t offset, std::span<std::byte> to) const {
    while (!to.empty()) {
        const auto [got, error] = read_at(descriptor_, to, offset);
        if (got == 0) {
            throw FileError(path_, fmt::format("could be read only up to byte {} of {}{}", offset,
                                               size_, error != 0 ? ": " + error_text(error) : ""));
        }
        offset += got;
        to = to.subspan(got);
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

}  // namespace relief::detail
