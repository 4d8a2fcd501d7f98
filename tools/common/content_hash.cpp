// SPDX-License-Identifier: Apache-2.0
#include "common/content_hash.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <span>

#include "files.h"
#include "relief/mesh/report.h"

namespace relief::tools {

void ContentHash::add_text(std::string_view text) {
    for (std::uint64_t size = text.size(), i = 0; i < 8; ++i, size >>= 8) {
        const char byte = static_cast<char>(size & 0xFF);
        add({&byte, 1});
    }
    add(text);
}

std::string ContentHash::text() const {
    return fmt::format("{:016x}", hash_);
}

std::string file_hash(const std::filesystem::path& file) {
    try {
        constexpr std::size_t block_size = 1'000'000;
        const relief::detail::RandomAccessFile contents(file);
        ContentHash hash;
        std::string block;
        for (std::uint64_t at = 0; at < contents.size(); at += block.size()) {
            block.resize(static_cast<std::size_t>(
                std::min<std::uint64_t>(block_size, contents.size() - at)));
            contents.read(at, std::as_writable_bytes(std::span(block)));
            hash.add(block);
        }
        return hash.text();
    } catch (const FileError&) {
        return "missing";
    }
}

}  // namespace relief::tools
