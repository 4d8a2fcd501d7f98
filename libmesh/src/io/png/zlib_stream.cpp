// SPDX-License-Identifier: Apache-2.0
#include "zlib_stream.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "io/png/png_format.h"
#include "parallel.h"

namespace relief::detail {

std::string zlib_stream(std::span<const std::byte> bytes) {
    constexpr std::size_t piece_size = 1 << 20;
    const std::span<const std::uint8_t> all(reinterpret_cast<const std::uint8_t*>(bytes.data()),
                                            bytes.size());
    std::vector<std::vector<std::uint8_t>> pieces(
        std::max<std::size_t>((all.size() + piece_size - 1) / piece_size, 1));
    parallel_for(pieces.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t from = i * piece_size;
            const std::size_t to = std::min(from + piece_size, all.size());
            const std::size_t known = std::min(from, deflate_window);
            deflate_piece(all.subspan(from - known, to - from + known), known, WriteEffort::normal,
                          Repetitions::sought, i + 1 == pieces.size(), pieces[i]);
        }
    });
    std::string stream(zlib_header);
    for (const std::vector<std::uint8_t>& piece : pieces)
        stream.append(piece.begin(), piece.end());
    append_big32(stream, adler32(bytes));
    return stream;
}

}  // namespace relief::detail
