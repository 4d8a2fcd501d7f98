// SPDX-License-Identifier: Apache-2.0
// Plain PNG files by rows: chunks, their checksums checked -> inflated in bands -> unfiltered ->
// samples. While one band is unfiltered, the next is inflated. What is found damaged on the way is
// left to the image module to judge, as with whole images: it reads the file from its beginning,
// which is why such a file may not be larger than images that are read whole. Source: [ISO/IEC
// 15948]. Tests: tests/mesh/io/image/image_rows_test.cpp.
#include "io/png/png_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>
#include <vector>

#include "io/image/image_file_container.h"
#include "io/image/module_source.h"
#include "io/png/deflate.h"
#include "io/png/inflate_stream.h"
#include "io/png/png_decoder.h"
#include "io/png/png_filter.h"
#include "parallel.h"
#include "random_access_file.h"
#include "relief/mesh/error.h"
#include "relief/mesh/image_rows.h"

namespace relief {
namespace {

constexpr std::size_t unpacked_per_band = std::size_t{1} << 20;
constexpr std::size_t bytes_per_feed = std::size_t{1} << 17;
constexpr std::uint64_t largest_kept_chunk = 1 << 16;

/// What stands before and around the data.
struct Layout {
    std::vector<std::byte> header, palette, transparency;
    std::map<std::string, std::string> text;
    std::uint64_t data_at = 0;     ///< The first IDAT chunk.
    std::uint64_t compressed = 0;  ///< Bytes in all of them.
    bool is_usual = true;          ///< Whether all is in its place, and its checksums are right.
};

/// The data of a chunk, and whether its checksum is right.
std::vector<std::byte> data_of(const RandomAccessFile& file, const PngChunkPlace& chunk,
                               bool& is_right) {
    std::vector<std::byte> whole(std::size_t{chunk.length} + 8);
    file.read(chunk.at + 4, whole);
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < 4; ++i)
        sum = sum << 8 | std::to_integer<std::uint32_t>(whole[chunk.length + 4 + i]);
    is_right = crc32(std::span(whole).first(chunk.length + 4)) == sum;
    return {whole.begin() + 4, whole.end() - 4};
}

/// A palette or its transparency: once, before the data, and not beyond any size that it can have.
void keep(const RandomAccessFile& file, const PngChunkPlace& chunk, Layout& layout,
          std::vector<std::byte>& kept) {
    bool is_right = false;
    if (kept.empty() && layout.data_at == 0 && chunk.length <= largest_kept_chunk)
        kept = data_of(file, chunk, is_right);
    layout.is_usual &= is_right;
}

Layout layout_of(const RandomAccessFile& file) {
    constexpr std::uint64_t signature = 8;
    Layout layout;
    const auto read = [&](std::uint64_t from, std::span<std::byte> to) { file.read(from, to); };
    walk_png(file.size(), read, file.path(), [&](const PngChunkPlace& chunk) {
        bool is_right = true;
        const bool is_header = chunk.type == "IHDR";
        layout.is_usual &= is_header == (chunk.at == signature);
        if (is_header && chunk.length >= 13 && chunk.length <= largest_kept_chunk) {
            layout.header = data_of(file, chunk, is_right);
            layout.is_usual &= is_right;
        }
        if (chunk.type == "PLTE") keep(file, chunk, layout, layout.palette);
        if (chunk.type == "tRNS") keep(file, chunk, layout, layout.transparency);
        if (chunk.type == "tEXt" || chunk.type == "iTXt") {
            const std::vector<std::byte> data = data_of(file, chunk, is_right);
            keep_png_text(chunk.type, {reinterpret_cast<const char*>(data.data()), data.size()},
                          layout.text);
        }
        if (chunk.type == "IDAT") {
            if (layout.data_at == 0) layout.data_at = chunk.at;
            layout.compressed += chunk.length;
        }
    });
    if (layout.header.empty()) throw FileError(file.path(), "has no IHDR chunk");
    check_png_size(layout.header, layout.compressed, file.size(), file.path());
    return layout;
}

/// The bytes of all IDAT chunks, some at a time. What is wrong with them ends them.
class DataChunks {
  public:
    DataChunks(const RandomAccessFile& file, std::uint64_t first) : file_(file), next_(first) {}

    std::span<const std::byte> next() {
        while (left_ == 0) {
            if (!open_chunk()) return {};
        }
        const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(left_, bytes_per_feed));
        buffer_.resize(size);
        file_.read(at_, buffer_);
        checksum_ = crc32_of_more(checksum_, buffer_);
        at_ += size;
        left_ -= size;
        if (left_ == 0 && !ends_right()) return {};
        return buffer_;
    }

  private:
    /// The next chunk that holds data.
    bool open_chunk() {
        std::array<std::byte, 8> start{};
        for (;;) {
            if (next_ + 12 > file_.size()) return false;
            file_.read(next_, start);
            left_ = 0;
            for (std::size_t i = 0; i < 4; ++i)
                left_ = left_ << 8 | std::to_integer<std::uint64_t>(start[i]);
            at_ = next_ + 8;
            next_ = at_ + left_ + 4;
            if (std::memcmp(start.data() + 4, "IEND", 4) == 0) return false;
            if (std::memcmp(start.data() + 4, "IDAT", 4) == 0) break;
        }
        checksum_ = crc32(std::span(start).subspan(4));
        return left_ > 0 || ends_right();
    }

    bool ends_right() {
        std::array<std::byte, 4> stored{};
        file_.read(at_, stored);
        std::uint32_t sum = 0;
        for (const std::byte byte : stored)
            sum = sum << 8 | std::to_integer<std::uint32_t>(byte);
        return sum == checksum_;
    }

    const RandomAccessFile& file_;
    std::uint64_t next_;      ///< The next chunk.
    std::uint64_t at_ = 0;    ///< What is read next of this one,
    std::uint64_t left_ = 0;  ///< and how much there is.
    std::uint32_t checksum_ = 0;
    std::vector<std::byte> buffer_;
};

/// Some rows, each behind the byte that names its filter.
struct RowBand {
    std::vector<std::byte> bytes;
    std::size_t rows = 0;
    std::size_t taken = 0;  ///< Rows that have been handed out.
    bool is_intact = true;
};

class PngSource final : public RowSource {
  public:
    PngSource(std::unique_ptr<RandomAccessFile> file, PlainPng png, const Layout& layout)
        : file_(std::move(file)),
          png_(std::move(png)),
          info_{png_.width, png_.height, png_.channels, png_.bits(), layout.text},
          line_(png_.stored_row_size() + 1),
          band_rows_(std::max<std::size_t>(unpacked_per_band / line_, 1)),
          chunks_(*file_, layout.data_at),
          stream_([this] { return chunks_.next(); }),
          above_(line_ - 1) {}

    [[nodiscard]] const ImageInfo& info() const override { return info_; }
    [[nodiscard]] bool is_streamed() const override { return true; }

    void read(std::byte* rows, std::size_t count) override {
        for (; count > 0; --count, ++next_, rows += png_.row_size()) {
            if (!judge_ && (!has_row() || !unpack_row(png_, next_line(), rows))) ask_module();
            if (judge_) return judge_->read(rows, count);
        }
    }

    void skip(std::size_t count) override {
        std::vector<std::byte> row(png_.row_size());
        for (; count > 0; --count)
            read(row.data(), 1);
    }

  private:
    /// Whether there is a row that is unfiltered; else the next band is made so.
    bool has_row() {
        if (ready_.taken == ready_.rows) advance();
        return ready_.is_intact;
    }

    std::span<const std::uint8_t> next_line() {
        const std::byte* const line = ready_.bytes.data() + ready_.taken++ * line_;
        return {reinterpret_cast<const std::uint8_t*>(line + 1), line_ - 1};
    }

    void advance() {
        if (inflated_rows_ == 0) inflate_band();
        std::swap(ready_, coming_);
        if (!ready_.is_intact) return;
        parallel_tasks({[this] { inflate_band(); }, [this] { unfilter(); }},
                       ready_.bytes.size() < unpacked_per_band / 8);
    }

    void inflate_band() {
        const std::size_t left = static_cast<std::size_t>(png_.height) - inflated_rows_;
        coming_.rows = std::min(band_rows_, left);
        coming_.taken = 0;
        if (coming_.rows == 0) return;
        coming_.bytes.resize(coming_.rows * line_);
        inflated_rows_ += coming_.rows;
        coming_.is_intact =
            stream_.fill(coming_.bytes) && (coming_.rows < left || stream_.is_complete());
    }

    void unfilter() {
        for (std::size_t y = 0; y < ready_.rows; ++y) {
            auto* const line = reinterpret_cast<std::uint8_t*>(ready_.bytes.data() + y * line_);
            const std::span row(line + 1, line_ - 1);
            const std::uint8_t* const upper = y == 0 ? above_.data() : line + 1 - line_;
            ready_.is_intact &= undo_filter(line[0], png_.step(), row, {upper, line_ - 1});
        }
        const auto* const last =
            reinterpret_cast<const std::uint8_t*>(ready_.bytes.data() + ready_.rows * line_);
        above_.assign(last - (line_ - 1), last);
    }

    /// From the row on that is next, the module reads.
    void ask_module() {
        const std::size_t texels =
            static_cast<std::size_t>(png_.width) * static_cast<std::size_t>(png_.height);
        if (texels > max_image_samples / static_cast<std::size_t>(png_.channels)) {
            throw FileError(file_->path(), fmt::format("the rows from {} to the end, {}, are "
                                                       "damaged",
                                                       next_, png_.height - 1));
        }
        judge_ = rows_of_image(read_by_module(file_->path()), info_);
        judge_->skip(next_);
    }

    std::unique_ptr<RandomAccessFile> file_;
    PlainPng png_;
    ImageInfo info_;
    std::size_t line_;  ///< Bytes of a row and its filter.
    std::size_t band_rows_;
    DataChunks chunks_;
    InflateStream stream_;
    std::vector<std::uint8_t> above_;  ///< The last row that was unfiltered.
    RowBand ready_, coming_;
    std::size_t inflated_rows_ = 0;
    std::size_t next_ = 0;
    std::unique_ptr<RowSource> judge_;
};

}  // namespace

std::unique_ptr<RowSource> open_png_rows(const std::filesystem::path& path) {
    auto file = std::make_unique<RandomAccessFile>(path);
    const Layout layout = layout_of(*file);
    if (!layout.is_usual) return nullptr;
    std::optional<PlainPng> png = plain_png({layout.header, layout.palette, layout.transparency});
    if (!png) return nullptr;
    check_streamed_size({png->width, png->height, png->channels, png->bits(), {}}, path);
    return std::make_unique<PngSource>(std::move(file), std::move(*png), layout);
}

}  // namespace relief
