// SPDX-License-Identifier: Apache-2.0
// Encodes PNG files, at once or by rows, and animated ones (APNG).
//
// Rows are encoded in batches, the parts of a batch in parallel. The compressed bytes depend
// neither on the number of threads nor on how rows are grouped. Each part gets the filter that
// suits its rows (png_format.h).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "file_replacement.h"
#include "files.h"
#include "io/image/row_codec.h"
#include "io/png/png_format.h"
#include "parallel.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

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

/// Returns the file up to the samples.
std::string start_of_file(const ImageShape& shape, const std::map<std::string, std::string>& text) {
    using namespace std::string_literals;
    std::string file = "\x89PNG\r\n\x1A\n";
    append_chunk(file, "IHDR", header_of(shape));
    if (shape.color_space == ColorSpace::srgb) {
        append_chunk(file, "sRGB", "\0"s);            // Perceptual intent.
        append_chunk(file, "gAMA", "\0\0\xB1\x8F"s);  // 1/2.2, for readers that ignore sRGB.
    }
    for (const auto& [key, value] : text)
        append_chunk(file, "tEXt", key + '\0' + value.substr(0, value.find('\0')));
    return file;
}

/// The samples of a row as bytes in PNG's order: the high byte first.
void copy_row(const std::byte* samples, int bits, std::span<std::uint8_t> row) {
    std::memcpy(row.data(), samples, row.size());
    if (bits == 8) return;
    std::uint8_t* const bytes = row.data();
    for (std::size_t i = 0; i < row.size(); i += 2)
        std::swap(bytes[i], bytes[i + 1]);
}

/// Consecutive rows with the same filter, which are deflated together.
struct Piece {
    std::size_t first = 0;  ///< Row of the batch.
    std::size_t end = 0;
    FilterChoice choice;
    std::uint32_t checksum = 0;  ///< Of the filtered rows.
    std::vector<std::uint8_t> packed;
    std::string chunk;
};

/// Encodes a PNG file: header, an sRGB chunk if the image is sRGB-coded, a tEXt chunk for each
/// entry, and all samples. Rows are encoded on all threads; the bytes do not depend on how rows are
/// grouped.
class PngEncoder {
  public:
    /// Receives the next bytes of the file.
    using Output = std::function<void(std::string_view bytes)>;

    /// \param shape  has 1 to 4 channels, 8 or 16 bits, and at most 2^30 bytes a row
    PngEncoder(const ImageShape& shape, const std::map<std::string, std::string>& text,
               WriteEffort effort, Output output);

    /// Encodes the next rows; there must not be too many. The end of the file follows the last one.
    void write(const std::byte* rows, std::size_t count);

  private:
    /// The row above a row of the batch.
    void copy_row_above(const std::byte* rows, std::size_t row, std::span<std::uint8_t> to) const {
        if (row > 0) return copy_row(rows + (row - 1) * row_size_, shape_.bits, to);
        if (!above_.empty()) return copy_row(above_.data(), shape_.bits, to);
        std::fill(to.begin(), to.end(), std::uint8_t{0});
    }

    /// Chooses the filter by some rows in the middle.
    [[nodiscard]] FilterChoice choice_for(const std::byte* rows, const Piece& piece) const {
        const std::size_t count = std::min(piece.end - piece.first,
                                           std::max<std::size_t>(bytes_per_trial / row_size_, 2));
        const std::size_t first = piece.first + (piece.end - piece.first - count) / 2;
        std::vector<std::uint8_t> tried((count + 1) * row_size_);
        for (std::size_t row = 0; row <= count; ++row)
            copy_row_above(rows, first + row, std::span(tried).subspan(row * row_size_, row_size_));
        return choose_filter(tried, row_size_, step_, effort_);
    }

    void filter(const std::byte* rows, Piece& piece) {
        piece.choice = choice_for(rows, piece);
        std::vector<std::uint8_t> upper(row_size_), row(row_size_);
        copy_row_above(rows, piece.first, upper);
        std::uint8_t* const start = filtered_.data() + window_ + piece.first * (row_size_ + 1);
        std::uint8_t* line = start;
        for (std::size_t y = piece.first; y < piece.end; ++y, line += row_size_ + 1) {
            copy_row(rows + y * row_size_, shape_.bits, row);
            line[0] = piece.choice.filter;
            apply_filter(piece.choice.filter, step_, row, upper, {line + 1, row_size_});
            std::swap(row, upper);
        }
        piece.checksum = adler32(std::as_bytes(std::span(start, line)));
    }

    /// \param begin, end  bytes of the stream before and after those of this part
    void pack(Piece& piece, std::string_view begin, std::string_view end, bool is_last) const {
        const std::size_t from = window_ + piece.first * (row_size_ + 1);
        const std::size_t to = window_ + piece.end * (row_size_ + 1);
        const std::size_t known = std::min(from, deflate_window);
        deflate_piece(std::span(filtered_).subspan(from - known, to - from + known), known, effort_,
                      piece.choice.repetitions, is_last, piece.packed);
        std::string data(begin);
        data += text_of(std::as_bytes(std::span(piece.packed)));
        data += end;
        append_chunk(piece.chunk, "IDAT", data);
    }

    /// Encodes a batch, or the rows that are left.
    void encode(const std::byte* rows, std::size_t count) {
        const bool is_first = rows_done_ == 0;
        rows_done_ += count;
        const bool is_end = rows_done_ == static_cast<std::size_t>(shape_.height);
        std::vector<Piece> pieces((count + piece_rows_ - 1) / piece_rows_);
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            pieces[i].first = i * piece_rows_;
            pieces[i].end = std::min(count, (i + 1) * piece_rows_);
        }
        filtered_.resize(window_ + count * (row_size_ + 1));
        parallel_for(pieces.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                filter(rows, pieces[i]);
        });
        for (const Piece& piece : pieces) {
            checksum_ = adler32_of_both(checksum_, piece.checksum,
                                        (piece.end - piece.first) * (row_size_ + 1));
        }
        std::string sum;
        append_big32(sum, checksum_);
        parallel_for(pieces.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const bool is_last = is_end && i + 1 == pieces.size();
                pack(pieces[i], is_first && i == 0 ? zlib_header : "", is_last ? sum : "", is_last);
            }
        });
        for (const Piece& piece : pieces)
            output_(piece.chunk);
        keep_end_of(rows, count);
    }

    void keep_end_of(const std::byte* rows, std::size_t count) {
        above_.assign(rows + (count - 1) * row_size_, rows + count * row_size_);
        const std::size_t kept = std::min(filtered_.size(), deflate_window);
        std::copy(filtered_.end() - static_cast<std::ptrdiff_t>(kept), filtered_.end(),
                  filtered_.begin());
        window_ = kept;
    }

    ImageShape shape_;
    WriteEffort effort_;
    Output output_;
    std::size_t step_;      ///< Bytes between the same samples of neighboring texels.
    std::size_t row_size_;  ///< In bytes.
    std::size_t piece_rows_;
    std::size_t batch_rows_ = 0;
    std::size_t rows_done_ = 0;
    std::vector<std::byte> pending_;      ///< Rows of an incomplete batch.
    std::vector<std::byte> above_;        ///< The last row of the batch before.
    std::vector<std::uint8_t> filtered_;  ///< A window of the batch before, then a batch.
    std::size_t window_ = 0;              ///< Bytes in that window.
    std::uint32_t checksum_ = 1;          ///< Adler-32 of all rows so far.
};

PngEncoder::PngEncoder(const ImageShape& shape, const std::map<std::string, std::string>& text,
                       WriteEffort effort, Output output)
    : shape_(shape),
      effort_(effort),
      output_(std::move(output)),
      step_(static_cast<std::size_t>(shape.channels * shape.bits / 8)),
      row_size_(static_cast<std::size_t>(shape.width) * step_),
      piece_rows_(std::max<std::size_t>(bytes_per_piece / (row_size_ + 1), 1)) {
    const std::size_t pieces = std::clamp<std::size_t>(
        bytes_at_once / (piece_rows_ * (row_size_ + 1)), 1, 4 * thread_count());
    batch_rows_ = pieces * piece_rows_;
    output_(start_of_file(shape, text));
}

void PngEncoder::write(const std::byte* rows, std::size_t count) {
    if (count == 0) return;
    const auto height = static_cast<std::size_t>(shape_.height);
    while (count > 0) {
        const std::size_t held = pending_.size() / row_size_;
        const std::size_t wanted = std::min(batch_rows_, height - rows_done_);
        const std::size_t taken = std::min(count, wanted - held);
        if (taken == wanted) {
            encode(rows, wanted);
        } else {
            pending_.insert(pending_.end(), rows, rows + taken * row_size_);
            if (held + taken == wanted) {
                encode(pending_.data(), wanted);
                pending_.clear();
            }
        }
        rows += taken * row_size_;
        count -= taken;
    }
    if (rows_done_ < height) return;
    std::string end;
    append_chunk(end, "IEND", "");
    output_(end);
}

}  // namespace

std::string detail::encode_png(const Image& image, const std::map<std::string, std::string>& text) {
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

namespace {

class PngSink final : public RowSink {
  public:
    explicit PngSink(const RowSinkPlan& plan)
        : file_(plan.file),
          out_(plan.written, std::ios::binary),
          encoder_(plan.shape, plan.metadata, plan.options.effort, [this](std::string_view bytes) {
              out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
              check();
          }) {}

    void write(const std::byte* rows, int count) override {
        encoder_.write(rows, static_cast<std::size_t>(count));
    }

    void finish() override {
        out_.close();
        check();
    }

  private:
    void check() const {
        if (!out_)
            throw FileError(file_, fmt::format("cannot be written: {}", std::strerror(errno)));
    }

    std::filesystem::path file_;
    std::ofstream out_;
    PngEncoder encoder_;  ///< Last, because its constructor writes.
};

}  // namespace

std::unique_ptr<RowSink> detail::make_png_sink(const RowSinkPlan& plan) {
    return std::make_unique<PngSink>(plan);
}

namespace {

constexpr std::size_t signature_size = 8;

std::uint32_t read_u32(std::string_view text) {
    std::uint32_t value = 0;
    for (const char c : text.substr(0, 4))
        value = value << 8U | static_cast<unsigned char>(c);
    return value;
}

/// Calls visit(name, content, whole chunk) for each chunk of a PNG file.
template <typename Visit>
void for_each_chunk(std::string_view png, Visit visit) {
    for (std::size_t at = signature_size; at < png.size();) {
        const std::size_t length = read_u32(png.substr(at));
        visit(png.substr(at + 4, 4), png.substr(at + 8, length), png.substr(at, length + 12));
        at += length + 12;
    }
}

}  // namespace

struct AnimatedPng::Implementation {
    FileReplacement replacement;
    std::filesystem::path file;
    std::ofstream out;
    std::uint32_t frames;
    std::uint32_t milliseconds;
    std::uint32_t added = 0;
    std::uint32_t sequence = 0;
    std::optional<Image> shape;  ///< The first frame without its samples.

    void write(std::string_view bytes) {
        out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        if (!out) throw FileError(file, "cannot be written");
    }

    /// Returns the position and duration of the next frame.
    std::string frame_control(const Image& frame) {
        std::string content;
        append_big32(content, sequence++);
        append_big32(content, static_cast<std::uint32_t>(frame.width));
        append_big32(content, static_cast<std::uint32_t>(frame.height));
        append_big32(content, 0);
        append_big32(content, 0);
        append_big16(content, milliseconds);
        append_big16(content, 1000);
        append_big16(content, 0);  // The frame stays, and the next one replaces it.
        std::string control;
        append_chunk(control, "fcTL", content);
        return control;
    }

    /// Writes the first frame, which readers without animation show too.
    void write_first(const Image& frame, std::string_view png) {
        std::string counts;
        append_big32(counts, frames);
        append_big32(counts, 0);  // Repeats forever.
        write(png.substr(0, signature_size));
        bool in_data = false;
        for_each_chunk(png, [&](std::string_view name, std::string_view, std::string_view whole) {
            if (name == "IEND") return;
            if (name == "IDAT" && !in_data) {
                std::string animation;
                append_chunk(animation, "acTL", counts);
                write(animation);
                write(frame_control(frame));
                in_data = true;
            }
            write(whole);
        });
    }

    void write_further(const Image& frame, std::string_view png) {
        write(frame_control(frame));
        for_each_chunk(png, [&](std::string_view name, std::string_view content, std::string_view) {
            if (name != "IDAT") return;
            std::string numbered;
            append_big32(numbered, sequence++);
            numbered += content;
            std::string data;
            append_chunk(data, "fdAT", numbered);
            write(data);
        });
    }
};

AnimatedPng::AnimatedPng(const std::filesystem::path& file, std::uint32_t frames, double seconds) {
    if (frames == 0) throw InvalidInput("an animation of 0 frames");
    if (!(seconds >= 0.0 && seconds <= 65.0)) {
        throw InvalidInput(fmt::format(
            "the duration of a frame is {} seconds, but must be within [0, 65]", seconds));
    }
    implementation_.reset(
        new Implementation{FileReplacement(file),
                           file,
                           {},
                           frames,
                           static_cast<std::uint32_t>(std::lround(1000.0 * seconds)),
                           0,
                           0,
                           {}});
    implementation_->out.open(implementation_->replacement.written_path(), std::ios::binary);
    if (!implementation_->out) throw FileError(file, "cannot be written");
}

AnimatedPng::~AnimatedPng() = default;

void AnimatedPng::add(const Image& frame) {
    Implementation& self = *implementation_;
    if (self.added == self.frames) {
        throw InvalidInput(
            fmt::format("one frame more than the {} that were announced", self.frames));
    }
    if (self.shape &&
        (frame.width != self.shape->width || frame.height != self.shape->height ||
         frame.channels != self.shape->channels || frame.bits() != self.shape->bits() ||
         frame.color_space != self.shape->color_space)) {
        throw InvalidInput(
            fmt::format("frame {} has another size or format than the first one", self.added));
    }
    if (frame.bits() == 32) throw InvalidInput("PNG cannot store float samples");
    const std::string png = encode_png(frame, {});
    if (self.added == 0) {
        self.shape = make_image(1, 1, frame.channels, frame.bits(), frame.color_space);
        self.shape->width = frame.width;
        self.shape->height = frame.height;
        self.write_first(frame, png);
    } else {
        self.write_further(frame, png);
    }
    ++self.added;
}

void AnimatedPng::finish() {
    Implementation& self = *implementation_;
    if (self.added < self.frames) {
        throw InvalidInput(
            fmt::format("{} frames of {} are missing", self.frames - self.added, self.frames));
    }
    std::string end;
    append_chunk(end, "IEND", "");
    self.write(end);
    self.out.close();
    if (!self.out) throw FileError(self.file, "cannot be written");
    self.replacement.commit();
}

}  // namespace relief
