// SPDX-License-Identifier: Apache-2.0
// Converts normal map files by bands of rows: samples are decoded, resized with a window of the
// rows around them, and encoded.
//
// A first pass over the rows finds the codes of flat texels, and keeps the last rows of a map that
// repeats. Each operation has a report of its own; they are merged in the order of the operations,
// as if each had been applied to the whole map.
#include "relief/mesh/normal_map_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "image/normal_bands.h"
#include "io/maps/height_bands.h"
#include "progress_stage.h"
#include "relief/mesh/statistics.h"

namespace relief {
using namespace relief::detail;

namespace {

/// Adds findings of a band, whose texels count from its own first texel.
void add_band(const Report& of_band, int first_row, int width, Report& report) {
    const std::size_t first_texel =
        static_cast<std::size_t>(first_row) * static_cast<std::size_t>(width);
    for (Finding finding : of_band.findings()) {
        for (std::size_t& texel : finding.first)
            texel += first_texel;
        report.add(finding);
    }
}

int rows_per_band(int width, std::size_t texels) {
    constexpr std::size_t max_rows = 1 << 16;
    return static_cast<int>(
        std::clamp(texels / static_cast<std::size_t>(width), std::size_t{1}, max_rows));
}

/// Adds the time of `work` in milliseconds.
template <typename Work>
auto timed(double& milliseconds, const Work& work) {
    decltype(work()) result;
    milliseconds += 1e3 * seconds_of([&] { result = work(); });
    return result;
}

/// The rows of samples of a source, from the top.
class SampleRows {
  public:
    explicit SampleRows(const NormalMapSource& source) : source_(source) {
        if (source.image == nullptr) reader_ = std::make_unique<ImageRowReader>(source.file);
    }

    [[nodiscard]] ImageInfo info() const {
        if (reader_) return reader_->info();
        const Image& image = *source_.image;
        return {image.width, image.height, image.channels, image.bits(), {}};
    }
    [[nodiscard]] int next_row() const { return next_; }

    /// Reads the next rows; fewer at the end.
    Image read(int rows) {
        check_cancelled();
        const ImageInfo shape = info();
        const int count = std::min(rows, shape.height - next_);
        const int first = std::exchange(next_, next_ + count);
        if (!reader_) return part_of(*source_.image, {0, first, shape.width, count});
        Image band = make_image(shape.width, count, shape.channels, shape.bits, ColorSpace::data);
        std::visit(
            [&](auto& samples) { reader_->read(std::as_writable_bytes(std::span(samples))); },
            band.samples);
        if (source_.is_signed && shape.bits == 32) remove_signs(band);
        return band;
    }

    void skip(int rows) {
        next_ += rows;
        if (reader_) reader_->skip(rows);
    }

  private:
    const NormalMapSource& source_;
    std::unique_ptr<ImageRowReader> reader_;
    int next_ = 0;
};

/// Consecutive rows of a map.
struct NormalBand {
    Image normals;               ///< Unit, y as it is stored after the mapping of axes.
    std::optional<Image> alpha;  ///< One float channel.
};

/// The reports of operations on the whole source, in their order.
struct Reports {
    Report lengths, decoded, slopes, resized, strength, blended, encoded;

    void merge_into(Report& report, const std::optional<DetailLayer>& detail) const {
        for (const Report* const one : {&lengths, &decoded, &slopes, &resized, &strength})
            report.merge(*one);
        if (detail) report.merge(detail->report);
        report.merge(blended);
        report.merge(encoded);
    }
};

/// Decodes the rows of a source from the top.
class DecodedRows {
  public:
    /// \param tail_rows  the number of last rows that tail() returns
    DecodedRows(const NormalMapSource& source, const NormalMapConversion& conversion, int tail_rows,
                Reports& reports, BumpFileTimes& times)
        : source_(source),
          conversion_(conversion),
          reports_(reports),
          times_(times),
          rows_(source),
          info_(rows_.info()) {
        // The first pass reads these channels.
        if (conversion.rebuild_z) {
            check_xy_channels(info_.channels, *conversion.rebuild_z);
        } else if (info_.channels < 3) {
            throw InvalidInput(
                fmt::format("a normal map has 3 or 4 channels, not {}", info_.channels));
        }
        const bool has_alpha = info_.channels >= 4 && conversion.keeps_alpha;
        has_alpha_ = has_alpha && !(conversion.rebuild_z && conversion.rebuild_z->x == 3);
        survey(tail_rows);
    }

    [[nodiscard]] const ImageInfo& info() const { return info_; }
    [[nodiscard]] bool has_alpha() const { return has_alpha_; }
    [[nodiscard]] int next_row() const { return rows_.next_row(); }
    [[nodiscard]] const NormalBand& tail() const { return tail_; }
    [[nodiscard]] const std::vector<RowLengths>& lengths() const { return lengths_; }

    /// Decodes the next rows; fewer at the end.
    NormalBand next(int rows) {
        const int first = rows_.next_row();
        const Image samples = timed(times_.read, [&] { return rows_.read(rows); });
        return timed(times_.convert, [&] { return decoded(samples, first); });
    }

  private:
    [[nodiscard]] XyChannels xy() const { return conversion_.rebuild_z.value_or(XyChannels{}); }

    /// Counts the codes of flat texels, and decodes the last rows.
    void survey(int tail_rows) {
        const bool needs_codes = info_.bits != 32 && source_.flat == FlatCode::half;
        if (source_.image != nullptr && needs_codes)
            codes_ = flat_texel_codes(*source_.image, xy().x, xy().y);
        const bool counts = source_.image == nullptr && needs_codes;
        if (!counts && tail_rows == 0) return;
        Image tail;
        FlatCodeCount count;
        times_.read += 1e3 * seconds_of([&] {
                           SampleRows rows(source_);
                           const int first_of_tail = info_.height - tail_rows;
                           const auto read_to = [&](int end) {
                               Image band = rows.read(end - rows.next_row());
                               if (counts) count.add(band, xy().x, xy().y);
                               return band;
                           };
                           if (!counts) rows.skip(first_of_tail);
                           while (rows.next_row() < first_of_tail)
                               read_to(std::min(rows.next_row() + band_rows(), first_of_tail));
                           if (tail_rows > 0) tail = read_to(info_.height);
                       });
        if (counts) codes_ = count.codes();
        if (tail_rows > 0) tail_ = timed(times_.convert, [&] { return decoded(tail, -1); });
    }

    [[nodiscard]] int band_rows() const {
        return rows_per_band(info_.width, conversion_.texels_per_band);
    }

    /// \param first_row  -1 for rows that are decoded once more, and therefore not reported
    NormalBand decoded(const Image& samples, int first_row) {
        NormalBand band;
        Report of_lengths, of_decoding;
        if (conversion_.rebuild_z) {
            band.normals = decode_xy_rows(samples, xy(), source_.flat, codes_, of_decoding);
        } else {
            if (first_row >= 0) append_row_lengths(samples, source_.flat, lengths_, of_lengths);
            band.normals = decode_normal_rows(samples, source_.flat, codes_, of_decoding);
        }
        if (first_row >= 0) {
            add_band(of_lengths, first_row, info_.width, reports_.lengths);
            add_band(of_decoding, first_row, info_.width, reports_.decoded);
        }
        if (has_alpha_) band.alpha = channel_of(samples, 3);
        if (conversion_.axes != same_axes) map_normal_axes(band.normals, conversion_.axes);
        return band;
    }

    const NormalMapSource& source_;
    const NormalMapConversion& conversion_;
    Reports& reports_;
    BumpFileTimes& times_;
    SampleRows rows_;
    ImageInfo info_;
    bool has_alpha_ = false;
    FlatCodes codes_;
    NormalBand tail_;
    std::vector<RowLengths> lengths_;
};

/// Rows of floats that move over a map. The first and last rows of a map that repeats stay.
class FloatWindow {
  public:
    void append(const Image& rows) { rows_.append(rows); }
    void keep_tail(const Image& rows) { tail_.append(rows); }
    /// Drops rows before `row`, but keeps the first `head_rows` of the map.
    void drop_before(int row, int head_rows) {
        const int count = std::clamp(row - begin_, 0, rows_.count());
        for (int i = begin_; i < std::min(begin_ + count, head_rows); ++i)
            head_.append_row(rows_, i - begin_);
        rows_.drop(count);
        begin_ += count;
    }
    [[nodiscard]] FloatRows rows(int height) const {
        return [this, height](std::size_t row) { return at(static_cast<int>(row), height); };
    }

  private:
    [[nodiscard]] const float* at(int row, int height) const {
        if (row >= begin_ && row < begin_ + rows_.count())
            return static_cast<const float*>(rows_.at(row - begin_));
        if (row < head_.count()) return static_cast<const float*>(head_.at(row));
        return static_cast<const float*>(tail_.at(row - (height - tail_.count())));
    }

    KeptRows rows_, head_, tail_;
    int begin_ = 0;
};

/// The numbers of first and last rows that rows at the other border of a map need.
struct Overlap {
    int head = 0;
    int tail = 0;
};

Overlap overlap_of(const Resampling& resampling, int source_height, int height, Wrap wrap) {
    Overlap overlap;
    if (wrap != Wrap::repeat) return overlap;
    for (int row = 0; row < height; ++row) {
        const ResampledAxis::Reach reach = resampling.reach(row);
        overlap.tail = std::max(overlap.tail, -reach.begin);
        overlap.head = std::max(overlap.head, reach.end - source_height);
    }
    return {std::min(overlap.head, source_height), std::min(overlap.tail, source_height)};
}

/// Resizes decoded rows from the top.
class ResizedRows {
  public:
    ResizedRows(DecodedRows& source, const Resampling& resampling, const Overlap& overlap,
                const NormalMapConversion& conversion, Reports& reports, BumpFileTimes& times)
        : source_(source),
          resampling_(resampling),
          overlap_(overlap),
          conversion_(conversion),
          reports_(reports),
          times_(times) {
        if (overlap.tail == 0) return;
        normals_.keep_tail(source.tail().normals);
        if (has_slopes())
            slopes_.keep_tail(slopes_to_average(source.tail().normals, IgnoredReport()));
        if (source.has_alpha()) alpha_.keep_tail(*source.tail().alpha);
    }

    NormalBand next(int rows) {
        const int height = source_.info().height;
        const int first = next_;
        const int count = std::min(rows, conversion_.height - first);
        move_to(std::clamp(resampling_.reach(first).begin, 0, height - 1),
                std::clamp(resampling_.reach(first + count - 1).end, 1, height));
        next_ += count;
        return timed(times_.convert, [&] {
            NormalBand band;
            band.normals = make_image(conversion_.width, count, 3, 32, ColorSpace::data);
            Report of_band;
            resize_normal_rows(resampling_, conversion_.resize.domain, normals_.rows(height),
                               slopes_.rows(height), first, band.normals, of_band);
            add_band(of_band, first, conversion_.width, reports_.resized);
            if (source_.has_alpha()) {
                band.alpha = make_image(conversion_.width, count, 1, 32, ColorSpace::data);
                resize_sample_rows(resampling_, alpha_.rows(height), first, *band.alpha);
            }
            return band;
        });
    }

  private:
    [[nodiscard]] bool has_slopes() const {
        return conversion_.resize.domain == ResizeDomain::slopes;
    }

    /// Brings rows [begin, end) of the source into memory. The mirrored and repeated texels of
    /// border rows are in the window, too, or in the kept first and last rows.
    void move_to(int begin, int end) {
        const int step = rows_per_band(source_.info().width, conversion_.texels_per_band);
        for (FloatWindow* const window : {&normals_, &slopes_, &alpha_})
            window->drop_before(begin, overlap_.head);
        while (source_.next_row() < end) {
            const int first = source_.next_row();
            const NormalBand band = source_.next(std::min(step, end - first));
            times_.convert += 1e3 * seconds_of([&] { append(band, first); });
        }
    }

    void append(const NormalBand& band, int first) {
        normals_.append(band.normals);
        if (has_slopes()) {
            Report of_band;
            slopes_.append(slopes_to_average(band.normals, of_band));
            add_band(of_band, first, source_.info().width, reports_.slopes);
        }
        if (source_.has_alpha()) alpha_.append(*band.alpha);
    }

    DecodedRows& source_;
    const Resampling& resampling_;
    Overlap overlap_;
    const NormalMapConversion& conversion_;
    Reports& reports_;
    BumpFileTimes& times_;
    FloatWindow normals_, slopes_, alpha_;
    int next_ = 0;
};

using relief::detail::shape_of;

ImageShape shape_of(const NormalMapConversion& conversion, bool has_alpha) {
    return {conversion.width,       conversion.height, has_alpha ? 4 : 3,
            conversion.format.bits, ColorSpace::data,  {}};
}

void write_band(ImageRowWriter& writer, const Image& band) {
    std::visit([&](const auto& samples) { writer.write(std::as_bytes(std::span(samples))); },
               band.samples);
}

/// Writes the bands that `next_band(first row, rows)` returns.
template <typename NextBand>
void write_bands(const std::filesystem::path& file, const ImageShape& shape, int band_rows,
                 const NormalMapConversion& conversion, BumpFileTimes& times, Report& report,
                 const std::function<void(double)>& progress, const NextBand& next_band) {
    ImageRowWriter writer(file, shape, conversion.metadata, conversion.write);
    for (int first = 0; first < shape.height; first += band_rows) {
        const Image band = next_band(first, std::min(band_rows, shape.height - first));
        times.write += 1e3 * seconds_of([&] { write_band(writer, band); });
        if (progress) progress(static_cast<double>(first + band.height) / shape.height);
    }
    times.write += 1e3 * seconds_of([&] { writer.finish(report); });
}

ConvertedMapFile convert_codes(const NormalMapSource& source, const std::filesystem::path& file,
                               const NormalMapConversion& conversion, Report& report,
                               const std::function<void(double)>& progress) {
    ConvertedMapFile result;
    SampleRows rows(source);
    const ImageInfo info = rows.info();
    const bool drops_alpha = info.channels == 4 && !conversion.keeps_alpha;
    const ImageShape shape = {info.width, info.height,      drops_alpha ? 3 : info.channels,
                              info.bits,  ColorSpace::data, {}};
    Report of_axes, of_writing;
    write_bands(file, shape, rows_per_band(info.width, conversion.texels_per_band), conversion,
                result.times, of_writing, progress, [&](int first, int count) {
                    Image band = timed(result.times.read, [&] { return rows.read(count); });
                    result.times.convert +=
                        1e3 * seconds_of([&] {
                            Report of_band;
                            if (conversion.axes != same_axes)
                                map_axes(band, conversion.axes, source.flat, of_band);
                            add_band(of_band, first, info.width, of_axes);
                            if (drops_alpha) drop_alpha(band);
                        });
                    return band;
                });
    report.merge(of_axes);
    report.merge(of_writing);
    return result;
}

/// The bands of a converted map, before they are encoded.
class ConvertedBands {
  public:
    ConvertedBands(const NormalMapSource& source, const NormalMapConversion& conversion,
                   BumpFileTimes& times)
        : conversion_(sized(source, conversion)),
          times_(times),
          decoded_(source, conversion_, prepare_resizing(SampleRows(source).info()), reports_,
                   times) {
        if (resampling_)
            resized_.emplace(decoded_, *resampling_, overlap_, conversion_, reports_, times);
    }

    /// The conversion, with the sizes of the result.
    [[nodiscard]] const NormalMapConversion& conversion() const { return conversion_; }
    [[nodiscard]] bool has_alpha() const { return decoded_.has_alpha(); }
    [[nodiscard]] int band_rows() const { return band_rows_; }
    [[nodiscard]] Reports& reports() { return reports_; }

    /// \param first_row  of the next rows
    NormalBand next(int first_row, int count) {
        NormalBand band = resized_ ? resized_->next(count) : decoded_.next(count);
        times_.convert += 1e3 * seconds_of([&] { change(band, first_row); });
        return band;
    }

    /// The lengths of the vectors of the source, unless z was computed.
    [[nodiscard]] std::optional<LengthRange> lengths() const {
        if (conversion_.rebuild_z) return std::nullopt;
        return range_of(decoded_.lengths());
    }

  private:
    static NormalMapConversion sized(const NormalMapSource& source, NormalMapConversion result) {
        if (result.width != 0 || result.height != 0) return result;
        const ImageInfo info = SampleRows(source).info();
        result.width = info.width;
        result.height = info.height;
        return result;
    }

    /// \return the number of last rows of the source that its first rows need
    int prepare_resizing(const ImageInfo& info) {
        band_rows_ = rows_per_band(conversion_.width, conversion_.texels_per_band);
        if (conversion_.width == info.width && conversion_.height == info.height &&
            conversion_.resize.repeat == glm::dvec2(1.0)) {
            return 0;
        }
        check_resize(conversion_.width, conversion_.height, conversion_.resize);
        resampling_.emplace(info.width, info.height, conversion_.width, conversion_.height,
                            conversion_.resize);
        overlap_ =
            overlap_of(*resampling_, info.height, conversion_.height, conversion_.resize.wrap.y);
        // The rows of a band also have no more texels of the source than a band.
        const double scale = static_cast<double>(info.height) / conversion_.height;
        const int of_source = rows_per_band(info.width, conversion_.texels_per_band);
        band_rows_ = std::clamp(static_cast<int>(of_source / scale), 1, band_rows_);
        return overlap_.tail;
    }

    /// Applies the operations after resizing.
    void change(NormalBand& band, int first_row) {
        Report of_strength, of_blending;
        if (conversion_.strength) scale_slopes(band.normals, *conversion_.strength, of_strength);
        add_band(of_strength, first_row, conversion_.width, reports_.strength);
        if (!conversion_.detail) return;
        blend_normal_rows(band.normals, first_row, conversion_.detail->normals,
                          conversion_.detail->blend, of_blending);
        add_band(of_blending, first_row, conversion_.width, reports_.blended);
    }

    NormalMapConversion conversion_;
    BumpFileTimes& times_;
    Reports reports_;
    std::optional<Resampling> resampling_;
    Overlap overlap_;
    int band_rows_ = 1;
    DecodedRows decoded_;
    std::optional<ResizedRows> resized_;
};

}  // namespace

void remove_signs(Image& map) {
    const auto channels = static_cast<std::size_t>(map.channels);
    const std::span<float> samples = map.as<float>();
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (i % channels < 3) samples[i] = (samples[i] + 1.0F) / 2.0F;
    }
}

ConvertedMapFile convert_normal_map_file(const NormalMapSource& source,
                                         const std::filesystem::path& file,
                                         const NormalMapConversion& given, Report& report,
                                         const std::function<void(double)>& progress) {
    if (given.keeps_codes) return convert_codes(source, file, given, report, progress);
    ConvertedMapFile result;
    ConvertedBands bands(source, given, result.times);
    const NormalMapConversion& conversion = bands.conversion();
    NormalMapFormat format = conversion.format;
    format.green = Green::up;
    Report of_writing;
    write_bands(file, shape_of(conversion, bands.has_alpha()), bands.band_rows(), conversion,
                result.times, of_writing, progress, [&](int first, int count) {
                    const NormalBand band = bands.next(first, count);
                    return timed(result.times.convert, [&] {
                        Image codes = encode_normal_rows(band.normals, format, first,
                                                         bands.reports().encoded);
                        return band.alpha ? with_alpha(codes, *band.alpha) : codes;
                    });
                });
    result.lengths = bands.lengths();
    bands.reports().merge_into(report, conversion.detail);
    report.merge(of_writing);
    return result;
}

EncodedMapFile encode_normal_map_file(const NormalMapSource& source,
                                      const NormalMapConversion& conversion,
                                      const NormalTextureOptions& options, Report& report,
                                      const std::function<void(double)>& progress) {
    EncodedMapFile result;
    ConvertedBands bands(source, conversion, result.times);
    const int width = bands.conversion().width;
    const int height = bands.conversion().height;
    NormalTextureEncoder encoder(width, height, bands.has_alpha(), options);
    for (int first = 0; first < height; first += bands.band_rows()) {
        const NormalBand band = bands.next(first, std::min(bands.band_rows(), height - first));
        result.times.convert += 1e3 * seconds_of([&] {
                                    encoder.add(band.normals, band.alpha ? &*band.alpha : nullptr);
                                });
        if (progress) progress(static_cast<double>(first + band.normals.height) / height);
    }
    bands.reports().merge_into(report, conversion.detail);
    result.times.convert += 1e3 * seconds_of([&] { result.encoded = encoder.finish(report); });
    result.lengths = bands.lengths();
    return result;
}

}  // namespace relief
