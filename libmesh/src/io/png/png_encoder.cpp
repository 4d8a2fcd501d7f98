// SPDX-License-Identifier: Apache-2.0
// Writing PNG: samples -> big-endian rows -> filtered rows -> deflate -> chunks. The rows are cut
// into pieces of some size that has nothing to do with the number of threads; each has a filter, is
// deflated by itself, with the end of the one before as what may be repeated, and becomes a chunk;
// together they are one stream. The caller has checked the image. Source: [ISO/IEC 15948].
// Tests: tests/mesh/io/png/png_test.cpp, image/image_rows_test.cpp.
#include "io/png/png_encoder.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

#include "io/png/deflate.h"
#include "io/png/deflate_encoder.h"
#include "io/png/png_chunk.h"
#include "io/png/png_filter.h"
#include "io/png/png_filter_choice.h"
#include "parallel.h"

namespace relief {
namespace {

constexpr std::size_t bytes_per_piece = std::size_t{1} << 20;
constexpr std::size_t bytes_at_once = std::size_t{1} << 26;
constexpr std::size_t bytes_per_trial = std::size_t{1} << 16;

std::string header_of(const ImageShape& shape) {
    static constexpr std::array type_of_channels{0, 0, 4, 2, 6};
    std::string header;
    append_big32(header, static_cast<std::uint32_t>(shape.width));
    append_big32(header, static_cast<std::uint32_t>(shape.height));
    header += static_cast<char>(shape.bits);
    header += static_cast<char>(type_of_channels[static_cast<std::size_t>(shape.channels)]);
    return header + std::string(3, '\0');  // Deflate, the five filters, not interlaced.
}

/// All that stands before the samples.
std::string start_of_file(const ImageShape& shape, const std::map<std::string, std::string>& text) {
    using namespace std::string_literals;
    std::string file = "\x89PNG\r\n\x1A\n";
    append_chunk(file, "IHDR", header_of(shape));
    if (shape.color_space == ColorSpace::srgb) {
        append_chunk(file, "sRGB", "\0"s);            // Perceptual intent.
        append_chunk(file, "gAMA", "\0\0\xB1\x8F"s);  // 1/2.2, for readers that know no sRGB.
    }
    for (const auto& [key, value] : text)
        append_chunk(file, "tEXt", key + '\0' + value.substr(0, value.find('\0')));
    return file;
}

/// A row's samples as bytes, in PNG's order: the high byte first.
void copy_row(const std::byte* samples, int bits, std::span<std::uint8_t> row) {
    std::memcpy(row.data(), samples, row.size());
    if (bits == 8) return;
    std::uint8_t* const bytes = row.data();
    for (std::size_t i = 0; i < row.size(); i += 2)
        std::swap(bytes[i], bytes[i + 1]);
}

std::string_view text_of(std::span<const std::uint8_t> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Some rows, filtered alike and deflated together.
struct Piece {
    std::size_t first = 0;  ///< Row of the batch.
    std::size_t end = 0;
    FilterChoice choice;
    std::uint32_t checksum = 0;  ///< Of the filtered rows.
    std::vector<std::uint8_t> packed;
    std::string chunk;
};

}  // namespace

struct PngEncoder::Implementation {
    ImageShape shape;
    WriteEffort effort;
    Output output;
    std::size_t row_size;  ///< In bytes.
    std::size_t step;      ///< From a sample to the same of the texel on the left.
    std::size_t piece_rows;
    std::size_t batch_rows;
    std::size_t rows_done = 0;
    std::vector<std::byte> pending;      ///< Rows of a batch that is not full.
    std::vector<std::byte> above;        ///< The last row of the batch before.
    std::vector<std::uint8_t> filtered;  ///< A window of the batch before, then a batch.
    std::size_t window = 0;              ///< How many bytes of it there are.
    std::uint32_t checksum = 1;          ///< Adler-32 of all rows so far.

    /// A row of the batch, or the one above it, which may be -1.
    void copy_row_above(const std::byte* rows, std::size_t row, std::span<std::uint8_t> to) const {
        if (row > 0) return copy_row(rows + (row - 1) * row_size, shape.bits, to);
        if (!above.empty()) return copy_row(above.data(), shape.bits, to);
        std::fill(to.begin(), to.end(), std::uint8_t{0});
    }

    /// By some rows in the middle.
    [[nodiscard]] FilterChoice choice_for(const std::byte* rows, const Piece& piece) const {
        const std::size_t count =
            std::min(piece.end - piece.first, std::max<std::size_t>(bytes_per_trial / row_size, 2));
        const std::size_t first = piece.first + (piece.end - piece.first - count) / 2;
        std::vector<std::uint8_t> tried((count + 1) * row_size);
        for (std::size_t row = 0; row <= count; ++row)
            copy_row_above(rows, first + row, std::span(tried).subspan(row * row_size, row_size));
        return choose_filter(tried, row_size, step, effort);
    }

    void filter(const std::byte* rows, Piece& piece) {
        piece.choice = choice_for(rows, piece);
        std::vector<std::uint8_t> upper(row_size), row(row_size);
        copy_row_above(rows, piece.first, upper);
        std::uint8_t* const start = filtered.data() + window + piece.first * (row_size + 1);
        std::uint8_t* line = start;
        for (std::size_t y = piece.first; y < piece.end; ++y, line += row_size + 1) {
            copy_row(rows + y * row_size, shape.bits, row);
            line[0] = piece.choice.filter;
            apply_filter(piece.choice.filter, step, row, upper, {line + 1, row_size});
            std::swap(row, upper);
        }
        piece.checksum = adler32(std::as_bytes(std::span(start, line)));
    }

    /// \param begin, end   of the stream: put before and behind what this piece gives
    void pack(Piece& piece, std::string_view begin, std::string_view end, bool is_last) const {
        const std::size_t from = window + piece.first * (row_size + 1);
        const std::size_t to = window + piece.end * (row_size + 1);
        const std::size_t known = std::min(from, deflate_window);
        deflate_piece(std::span(filtered).subspan(from - known, to - from + known), known, effort,
                      piece.choice.repetitions, is_last, piece.packed);
        std::string data(begin);
        data += text_of(piece.packed);
        data += end;
        append_chunk(piece.chunk, "IDAT", data);
    }

    /// A batch, or what is left.
    void encode(const std::byte* rows, std::size_t count) {
        const bool is_first = rows_done == 0;
        rows_done += count;
        const bool is_end = rows_done == static_cast<std::size_t>(shape.height);
        std::vector<Piece> pieces((count + piece_rows - 1) / piece_rows);
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            pieces[i].first = i * piece_rows;
            pieces[i].end = std::min(count, (i + 1) * piece_rows);
        }
        filtered.resize(window + count * (row_size + 1));
        parallel_for(pieces.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                filter(rows, pieces[i]);
        });
        for (const Piece& piece : pieces) {
            checksum = adler32_of_both(checksum, piece.checksum,
                                       (piece.end - piece.first) * (row_size + 1));
        }
        std::string sum;
        append_big32(sum, checksum);
        parallel_for(pieces.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const bool is_last = is_end && i + 1 == pieces.size();
                pack(pieces[i], is_first && i == 0 ? zlib_header : "", is_last ? sum : "", is_last);
            }
        });
        for (const Piece& piece : pieces)
            output(piece.chunk);
        keep_end_of(rows, count);
    }

    void keep_end_of(const std::byte* rows, std::size_t count) {
        above.assign(rows + (count - 1) * row_size, rows + count * row_size);
        const std::size_t kept = std::min(filtered.size(), deflate_window);
        std::copy(filtered.end() - static_cast<std::ptrdiff_t>(kept), filtered.end(),
                  filtered.begin());
        window = kept;
    }
};

PngEncoder::PngEncoder(const ImageShape& shape, const std::map<std::string, std::string>& text,
                       WriteEffort effort, Output output) {
    const auto step = static_cast<std::size_t>(shape.channels * shape.bits / 8);
    const std::size_t row_size = static_cast<std::size_t>(shape.width) * step;
    const std::size_t piece_rows = std::max<std::size_t>(bytes_per_piece / (row_size + 1), 1);
    const std::size_t pieces = std::clamp<std::size_t>(
        bytes_at_once / (piece_rows * (row_size + 1)), 1, 4 * thread_count());
    implementation_.reset(new Implementation{shape,
                                             effort,
                                             std::move(output),
                                             row_size,
                                             step,
                                             piece_rows,
                                             pieces * piece_rows,
                                             0,
                                             {},
                                             {},
                                             {},
                                             0,
                                             1});
    implementation_->output(start_of_file(shape, text));
}

PngEncoder::~PngEncoder() = default;

void PngEncoder::write(const std::byte* rows, std::size_t count) {
    if (count == 0) return;
    Implementation& self = *implementation_;
    const auto height = static_cast<std::size_t>(self.shape.height);
    while (count > 0) {
        const std::size_t held = self.pending.size() / self.row_size;
        const std::size_t wanted = std::min(self.batch_rows, height - self.rows_done);
        const std::size_t taken = std::min(count, wanted - held);
        if (taken == wanted) {
            self.encode(rows, wanted);
        } else {
            self.pending.insert(self.pending.end(), rows, rows + taken * self.row_size);
            if (held + taken == wanted) {
                self.encode(self.pending.data(), wanted);
                self.pending.clear();
            }
        }
        rows += taken * self.row_size;
        count -= taken;
    }
    if (self.rows_done < height) return;
    std::string end;
    append_chunk(end, "IEND", "");
    self.output(end);
}

std::string encode_png(const Image& image, const std::map<std::string, std::string>& text) {
    std::string file;
    PngEncoder encoder({image.width, image.height, image.channels, image.bits(), image.color_space},
                       text, WriteEffort::normal, [&](std::string_view bytes) { file += bytes; });
    std::visit(
        [&](const auto& all) {
            encoder.write(std::as_bytes(std::span(all)).data(),
                          static_cast<std::size_t>(image.height));
        },
        image.samples);
    return file;
}

}  // namespace relief
