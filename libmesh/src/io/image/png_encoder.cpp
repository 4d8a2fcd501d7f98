// SPDX-License-Identifier: Apache-2.0
// Writing PNG: samples -> big-endian rows -> Paeth's filter -> deflate -> chunks. Rows are filtered
// in parallel; one stream holds them all. The caller has checked the image. Source: [ISO/IEC
// 15948]. Tests: tests/mesh/io/image/png_test.cpp.
#include "io/image/png_encoder.h"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "io/image/deflate.h"
#include "io/image/png_chunk.h"
#include "io/image/png_filter.h"
#include "parallel.h"

namespace relief {
namespace {

constexpr std::size_t bytes_per_piece = std::size_t{1} << 22;
constexpr std::size_t largest_chunk = std::size_t{1} << 30;  // PNG's own limit is twice that.

std::string header_of(const Image& image) {
    static constexpr std::array type_of_channels{0, 0, 4, 2, 6};
    std::string header;
    append_big32(header, static_cast<std::uint32_t>(image.width));
    append_big32(header, static_cast<std::uint32_t>(image.height));
    header += static_cast<char>(image.bits());
    header += static_cast<char>(type_of_channels[static_cast<std::size_t>(image.channels)]);
    return header + std::string(3, '\0');  // Deflate, the five filters, not interlaced.
}

/// A row's samples as bytes, in PNG's order.
void copy_row(const Image& image, std::size_t y, std::span<std::uint8_t> row) {
    const std::size_t first =
        y * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels);
    if (image.bits() == 8) {
        const auto samples = image.as<std::uint8_t>().subspan(first, row.size());
        std::copy(samples.begin(), samples.end(), row.begin());
        return;
    }
    const auto samples = image.as<std::uint16_t>().subspan(first, row.size() / 2);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        row[2 * i] = static_cast<std::uint8_t>(samples[i] >> 8);
        row[2 * i + 1] = static_cast<std::uint8_t>(samples[i]);
    }
}

/// All rows filtered, each behind a byte that names the filter.
struct FilteredRows {
    std::unique_ptr<std::uint8_t[]> bytes;
    std::size_t size = 0;
};

FilteredRows filtered_rows(const Image& image) {
    const auto height = static_cast<std::size_t>(image.height);
    const auto step = static_cast<std::size_t>(image.channels * image.bits() / 8);
    const std::size_t row_size = static_cast<std::size_t>(image.width) * step;
    FilteredRows filtered;
    filtered.size = (row_size + 1) * height;
    filtered.bytes = std::make_unique_for_overwrite<std::uint8_t[]>(filtered.size);
    parallel_for(height, bytes_per_piece / row_size + 1, [&](std::size_t begin, std::size_t end) {
        std::vector<std::uint8_t> above(row_size, 0), row(row_size);
        if (begin > 0) copy_row(image, begin - 1, above);
        for (std::size_t y = begin; y < end; ++y) {
            copy_row(image, y, row);
            std::uint8_t* const line = filtered.bytes.get() + y * (row_size + 1);
            line[0] = paeth_filter;
            apply_paeth(step, row, above, std::span(line + 1, row_size));
            std::swap(row, above);
        }
    });
    return filtered;
}

}  // namespace

std::string encode_png(const Image& image, const std::map<std::string, std::string>& text) {
    using namespace std::string_literals;
    constexpr int level = 4;
    std::string file = "\x89PNG\r\n\x1A\n";
    append_chunk(file, "IHDR", header_of(image));
    if (image.color_space == ColorSpace::srgb) {
        append_chunk(file, "sRGB", "\0"s);            // Perceptual intent.
        append_chunk(file, "gAMA", "\0\0\xB1\x8F"s);  // 1/2.2, for readers that know no sRGB.
    }
    for (const auto& [key, value] : text)
        append_chunk(file, "tEXt", key + '\0' + value.substr(0, value.find('\0')));
    const FilteredRows filtered = filtered_rows(image);
    const Packed packed =
        deflate(std::as_bytes(std::span(filtered.bytes.get(), filtered.size)), level);
    const std::string_view data(reinterpret_cast<const char*>(packed.bytes.get()), packed.size);
    for (std::size_t begin = 0; begin < data.size(); begin += largest_chunk)
        append_chunk(file, "IDAT", data.substr(begin, largest_chunk));
    append_chunk(file, "IEND", "");
    return file;
}

}  // namespace relief
