// SPDX-License-Identifier: Apache-2.0
// Which source reads a file, by its first bytes. Tests: tests/mesh/io/image/image_rows_test.cpp.
#include "io/image/streamed_rows.h"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>

#include "io/image/image_file_container.h"
#include "io/image/module_source.h"
#include "io/png/png_source.h"
#include "random_access_file.h"

namespace relief {

std::unique_ptr<RowSource> open_streamed_rows(const std::filesystem::path& file) {
    std::array<char, 16> start{};
    {
        const RandomAccessFile opened(file);
        const auto size = std::min<std::uint64_t>(opened.size(), start.size());
        opened.read(0, std::as_writable_bytes(std::span(start)).first(size));
    }
    const char* const format = format_by_signature({start.data(), start.size()});
    const std::string_view kind = format == nullptr ? "" : format;
    if (kind == "png") return open_png_rows(file);
    if (kind == "tiff" || kind == "openexr") return open_module_rows(file);
    return nullptr;
}

}  // namespace relief
