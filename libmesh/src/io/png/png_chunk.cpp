// SPDX-License-Identifier: Apache-2.0
// Numbers and chunks of PNG files, appended. Tests: tests/mesh/io/png/png_test.cpp.
#include "io/png/png_chunk.h"

#include <span>

#include "io/png/deflate.h"

namespace relief {

void append_big16(std::string& to, std::uint32_t value) {
    to += static_cast<char>(value >> 8);
    to += static_cast<char>(value);
}

void append_big32(std::string& to, std::uint32_t value) {
    append_big16(to, value >> 16);
    append_big16(to, value);
}

void append_chunk(std::string& file, std::string_view type, std::string_view data) {
    append_big32(file, static_cast<std::uint32_t>(data.size()));
    const std::size_t checked_from = file.size();
    file += type;
    file += data;
    append_big32(file, crc32(std::as_bytes(std::span(file).subspan(checked_from))));
}

}  // namespace relief
