// SPDX-License-Identifier: Apache-2.0
// Decodes plain PNG files, at once from memory or by rows from a file. Rows are inflated and
// unfiltered in bands, in parallel: one band is unfiltered while the next one is inflated. Source:
// [ISO/IEC 15948].
#include "io/png/png_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include "files.h"
#include "io/image/image_file_container.h"
#include "io/image/image_module_client.h"
#include "large_memory.h"
#include "parallel.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/report.h"

namespace relief::detail {
namespace {

using Bytes = std::span<const std::byte>;

constexpr int palette_type = 3;

int code_at(Bytes bytes, std::size_t at) {
    return std::to_integer<int>(bytes[at]);
}

/// The data of some chunks; empty if they are absent.
struct PngChunks {
    std::span<const std::byte> header;
    std::span<const std::byte> palette;
    std::span<const std::byte> transparency;
};

struct Chunks : PngChunks {
    std::vector<std::byte> packed;
};

/// Returns the chunks of a PNG; nullopt if a checksum is wrong or their order is unusual.
std::optional<Chunks> chunks_of(Bytes stripped) {
    constexpr std::size_t signature = 8;
    constexpr std::size_t frame = 12;  // Length, type and checksum around a chunk's data.
    Chunks chunks;
    chunks.packed.reserve(stripped.size());
    for (std::size_t at = signature; stripped.size() - at >= frame;) {
        const std::size_t length = big32(stripped, at);
        if (length > stripped.size() - at - frame) return std::nullopt;
        const Bytes data = stripped.subspan(at + 8, length);
        if (crc32(stripped.subspan(at + 4, length + 4)) != big32(stripped, at + 8 + length))
            return std::nullopt;
        const Bytes type_bytes = stripped.subspan(at + 4, 4);
        const std::string_view type(reinterpret_cast<const char*>(type_bytes.data()), 4);
        if ((type == "IHDR") != (at == signature)) return std::nullopt;
        if (type == "IHDR") chunks.header = data;
        if (type == "PLTE") {
            if (!chunks.palette.empty() || !chunks.packed.empty()) return std::nullopt;
            chunks.palette = data;
        }
        if (type == "tRNS") {
            if (!chunks.transparency.empty() || !chunks.packed.empty()) return std::nullopt;
            chunks.transparency = data;
        }
        if (type == "IDAT") chunks.packed.insert(chunks.packed.end(), data.begin(), data.end());
        if (type == "IEND") return chunks;
        at += length + frame;
    }
    return std::nullopt;
}

/// RGB, or RGBA if an entry is not opaque; nullopt if the chunks contradict each other.
std::optional<std::vector<std::uint8_t>> palette_from(const PngChunks& chunks, int bits) {
    const std::size_t count = chunks.palette.size() / 3;
    const std::size_t opaque_from = chunks.transparency.size();
    if (count == 0 || count * 3 != chunks.palette.size() || count > std::size_t{1} << bits ||
        opaque_from > count) {
        return std::nullopt;
    }
    std::vector<std::uint8_t> palette;
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t k = 0; k < 3; ++k)
            palette.push_back(static_cast<std::uint8_t>(chunks.palette[3 * i + k]));
        if (opaque_from > 0) {
            palette.push_back(i < opaque_from ? static_cast<std::uint8_t>(chunks.transparency[i])
                                              : std::uint8_t{255});
        }
    }
    return palette;
}

bool is_allowed(int type, int bits) {
    if (bits == 8) return true;
    if (bits == 16) return type != palette_type;
    return (type == 0 || type == palette_type) && (bits == 1 || bits == 2 || bits == 4);
}

/// Converts a row of samples of 1, 2, 4 or 8 bits to 8 bits, and palette indices to texels.
bool unpack_small(const PlainPng& png, const std::uint8_t* stored, std::uint8_t* samples) {
    const auto bits = static_cast<unsigned>(png.stored_bits);
    const unsigned mask = (1U << bits) - 1U;
    const auto channels = static_cast<std::size_t>(png.channels);
    for (unsigned x = 0; x < static_cast<unsigned>(png.width); ++x) {
        const unsigned bit = x * bits;
        const unsigned value = stored[bit / 8] >> (8 - bits - bit % 8) & mask;
        if (png.palette.empty()) {
            *samples++ = static_cast<std::uint8_t>(value * 255U / mask);
            continue;
        }
        if ((value + 1) * channels > png.palette.size()) return false;
        samples = std::copy_n(png.palette.data() + value * channels, channels, samples);
    }
    return true;
}

/// Converts one unfiltered row of the stream to samples in native byte order.
/// \return false if a palette index is out of range
bool unpack_row(const PlainPng& png, std::span<const std::uint8_t> stored, std::byte* samples) {
    auto* const bytes = reinterpret_cast<std::uint8_t*>(samples);
    if (png.stored_bits < 8 || !png.palette.empty()) return unpack_small(png, stored.data(), bytes);
    std::memcpy(bytes, stored.data(), stored.size());
    if (png.stored_bits == 16) {
        for (std::size_t i = 0; i < stored.size(); i += 2)
            std::swap(bytes[i], bytes[i + 1]);  // PNG stores the high byte first.
    }
    return true;
}

/// Returns the properties of a plain PNG; nullopt if it is not plain. `packed` stays empty.
std::optional<PlainPng> plain_png(const PngChunks& chunks) {
    const Bytes header = chunks.header;
    if (header.size() != 13) return std::nullopt;
    static constexpr std::array channels_of_type{1, 0, 3, 1, 2, 0, 4};
    const std::uint64_t width = big32(header, 0);
    const std::uint64_t height = big32(header, 4);
    const int type = code_at(header, 9);
    PlainPng png;
    png.stored_bits = code_at(header, 8);
    if (type >= static_cast<int>(channels_of_type.size()) || !is_allowed(type, png.stored_bits))
        return std::nullopt;
    png.stored_channels = channels_of_type[static_cast<std::size_t>(type)];
    const bool is_usual = code_at(header, 10) == 0 && code_at(header, 11) == 0;
    const bool is_interlaced = code_at(header, 12) != 0;
    constexpr std::uint64_t largest = std::numeric_limits<int>::max();
    if (png.stored_channels == 0 || !is_usual || is_interlaced || width == 0 || height == 0 ||
        width > largest || height > largest) {
        return std::nullopt;
    }
    png.channels = png.stored_channels;
    if (type == palette_type) {
        auto palette = palette_from(chunks, png.stored_bits);
        if (!palette) return std::nullopt;
        png.palette = std::move(*palette);
        png.channels = chunks.transparency.empty() ? 3 : 4;
    } else if (!chunks.transparency.empty()) {
        return std::nullopt;
    }
    png.width = static_cast<int>(width);
    png.height = static_cast<int>(height);
    return png;
}

/// Inflates, unfilters and converts the whole stream.
template <typename Sample>
std::optional<Image::Samples> decoded_as(const PlainPng& png) {
    const std::size_t size = png.stored_row_size();
    const auto rows = static_cast<std::size_t>(png.height);
    std::vector<std::uint8_t> bytes((size + 1) * rows);
    if (!inflate(png.packed, std::as_writable_bytes(std::span(bytes)))) return std::nullopt;
    std::vector<Sample> samples;
    reserve_to_fill(samples, png.row_size() / sizeof(Sample) * rows);
    samples.resize(png.row_size() / sizeof(Sample) * rows);
    const std::vector<std::uint8_t> zeros(size, 0);
    std::span<const std::uint8_t> above = zeros;
    std::byte* to = std::as_writable_bytes(std::span(samples)).data();
    for (std::size_t y = 0; y < rows; ++y, to += png.row_size()) {
        std::uint8_t* const line = bytes.data() + y * (size + 1);
        const std::span row(line + 1, size);
        if (!undo_filter(line[0], png.step(), row, above)) return std::nullopt;
        if (!unpack_row(png, row, to)) return std::nullopt;
        above = row;
    }
    return samples;
}

}  // namespace

std::size_t PlainPng::stored_row_size() const {
    return (static_cast<std::size_t>(width) *
                static_cast<std::size_t>(stored_bits * stored_channels) +
            7) /
           8;
}

std::size_t PlainPng::row_size() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(channels * bits() / 8);
}

std::size_t PlainPng::step() const {
    return std::max<std::size_t>(static_cast<std::size_t>(stored_bits * stored_channels) / 8, 1);
}

std::optional<PlainPng> open_plain_png(std::span<const std::byte> stripped) {
    std::optional<Chunks> chunks = chunks_of(stripped);
    if (!chunks) return std::nullopt;
    std::optional<PlainPng> png = plain_png(*chunks);
    constexpr std::size_t max_texels = max_image_samples / 4;
    if (!png ||
        static_cast<std::size_t>(png->width) > max_texels / static_cast<std::size_t>(png->height)) {
        return std::nullopt;
    }
    png->packed = std::move(chunks->packed);
    return png;
}

std::optional<Image::Samples> decode(const PlainPng& png) {
    if (png.stored_bits == 16) return decoded_as<std::uint16_t>(png);
    return decoded_as<std::uint8_t>(png);
}

namespace {

constexpr std::size_t unpacked_per_band = std::size_t{1} << 20;
constexpr std::size_t bytes_per_feed = std::size_t{1} << 17;
constexpr std::uint64_t max_kept_chunk = 1 << 16;

/// The chunks around the data.
struct Layout {
    std::vector<std::byte> header, palette, transparency;
    std::map<std::string, std::string> text;
    std::uint64_t data_at = 0;     ///< Offset of the first IDAT chunk.
    std::uint64_t compressed = 0;  ///< Bytes in all IDAT chunks.
    bool is_usual = true;          ///< True if all chunks are in order and have correct checksums.
};

/// Returns the data of a chunk; `is_right` tells whether its checksum is correct.
std::vector<std::byte> data_of(const RandomAccessFile& file, const PngChunkPlace& chunk,
                               bool& is_right) {
    std::vector<std::byte> whole(std::size_t{chunk.length} + 8);
    file.read(chunk.at + 4, whole);
    is_right = crc32(std::span(whole).first(chunk.length + 4)) == big32(whole, chunk.length + 4);
    return {whole.begin() + 4, whole.end() - 4};
}

/// Keeps a palette or its transparency. It must be unique, before the data, and of plausible size.
void keep(const RandomAccessFile& file, const PngChunkPlace& chunk, Layout& layout,
          std::vector<std::byte>& kept) {
    bool is_right = false;
    if (kept.empty() && layout.data_at == 0 && chunk.length <= max_kept_chunk)
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
        if (is_header && chunk.length >= 13 && chunk.length <= max_kept_chunk) {
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

/// The bytes of all IDAT chunks, read in parts. The sequence ends at the first error.
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
    /// Opens the next chunk that holds data.
    bool open_chunk() {
        std::array<std::byte, 8> start{};
        for (;;) {
            if (next_ + 12 > file_.size()) return false;
            file_.read(next_, start);
            left_ = big32(start, 0);
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
        return big32(stored, 0) == checksum_;
    }

    const RandomAccessFile& file_;
    std::uint64_t next_;      ///< Offset of the next chunk.
    std::uint64_t at_ = 0;    ///< Offset of the next byte of this chunk,
    std::uint64_t left_ = 0;  ///< and the number of bytes that are left.
    std::uint32_t checksum_ = 0;
    std::vector<std::byte> buffer_;
};

/// Consecutive rows, each after its filter byte.
struct RowBand {
    std::vector<std::byte> bytes;
    std::size_t rows = 0;
    std::size_t taken = 0;  ///< Rows that were returned.
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
            if (!fallback_ && (!has_row() || !unpack_row(png_, next_line(), rows))) ask_module();
            if (fallback_) return fallback_->read(rows, count);
        }
    }

    void skip(std::size_t count) override {
        std::vector<std::byte> row(png_.row_size());
        for (; count > 0; --count)
            read(row.data(), 1);
    }

  private:
    /// Returns true if there is an unfiltered row; decodes the next band if needed.
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

    /// Lets the module decode the rows from the next one on.
    void ask_module() {
        const std::size_t texels =
            static_cast<std::size_t>(png_.width) * static_cast<std::size_t>(png_.height);
        if (texels > max_image_samples / static_cast<std::size_t>(png_.channels)) {
            throw FileError(file_->path(), fmt::format("the rows from {} to the end, {}, are "
                                                       "damaged",
                                                       next_, png_.height - 1));
        }
        fallback_ = rows_of_image(read_by_module(file_->path()), info_);
        fallback_->skip(next_);
    }

    std::unique_ptr<RandomAccessFile> file_;
    PlainPng png_;
    ImageInfo info_;
    std::size_t line_;  ///< Bytes of a row with its filter byte.
    std::size_t band_rows_;
    DataChunks chunks_;
    InflateStream stream_;
    std::vector<std::uint8_t> above_;  ///< The last unfiltered row.
    RowBand ready_, coming_;
    std::size_t inflated_rows_ = 0;
    std::size_t next_ = 0;
    std::unique_ptr<RowSource> fallback_;
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

}  // namespace relief::detail
