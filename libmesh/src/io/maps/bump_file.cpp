// SPDX-License-Identifier: Apache-2.0
// Converts height map files to bump map files by bands of some million texels.
//
// The rows of a band are computed on all threads. While the band is written, the rows of the next
// one are read. Plain normal maps are computed in place; for other contents, three codes or two
// slopes per texel are computed first, a few rows at a time, and then converted. A map in memory is
// its own source of rows. Its holes are filled when the first one is found; the bands before it do
// not depend on any.
#include "relief/mesh/bump_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <type_traits>
#include <utility>
#include <vector>

#include "bump/bump_rows.h"
#include "image/height_holes.h"
#include "image/normal_coding.h"
#include "image/texel_loops.h"
#include "io/maps/height_bands.h"
#include "parallel.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/map_description.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"

namespace relief {
using namespace relief::detail;

namespace {

/// Returns a sample of any type; 1.0 is white.
double value_at(const void* row, int bits, std::size_t x) {
    if (bits == 8) return static_cast<const std::uint8_t*>(row)[x] / largest_sample<std::uint8_t>;
    if (bits == 16)
        return static_cast<const std::uint16_t*>(row)[x] / largest_sample<std::uint16_t>;
    return static_cast<double>(static_cast<const float*>(row)[x]);
}

/// Encodes numbers from 0 to 1, and counts values outside.
template <typename Sample>
class UnitCoding {
  public:
    UnitCoding(const char* kind, Report& report) : kind_(kind), report_(report) {}

    Sample operator()(double value, std::size_t texel) {
        if constexpr (std::is_same_v<Sample, float>) return static_cast<float>(value);
        // This form is also true for NaN.
        if (!(value >= 0.0 && value <= 1.0)) {
            report_.add(kind_, "texel", texel, "is written as the nearest of 0 and 1");
            value = value > 1.0 ? 1.0 : 0.0;
        }
        return static_cast<Sample>(value * largest_sample<Sample> + 0.5);
    }

  private:
    const char* kind_;
    Report& report_;
};

/// Computes parts of a band.
class BandMaker {
  public:
    BandMaker(const BumpBandSource& source, const BumpOptions& options,
              const BumpFileFormat& format)
        : source_(source),
          options_(options),
          format_(format),
          shape_(shape_of(format, source.heights.width, source.heights.height)) {}

    bool make(int first, int last, std::byte* rows, Report& report) const {
        if (format_.content == BumpContent::slope_moments)
            return make_moments(first, last, reinterpret_cast<float*>(rows));
        if (shape_.bits == 8) return make_normals<std::uint8_t>(first, last, rows, report);
        if (shape_.bits == 16) return make_normals<std::uint16_t>(first, last, rows, report);
        return make_normals<float>(first, last, rows, report);
    }

  private:
    [[nodiscard]] std::size_t width() const {
        return static_cast<std::size_t>(source_.heights.width);
    }

    template <typename Sample>
    bool make_normals(int first, int last, std::byte* rows, Report& report) const {
        auto* const samples = reinterpret_cast<Sample*>(rows);
        const bool is_plain = shape_.channels == 3 && !format_.xy_only && !source_.transparent;
        std::vector<Sample> scratch;
        if (!is_plain) scratch.resize(width() * 3 * static_cast<std::size_t>(last - first));
        Sample* const codes = is_plain ? samples : scratch.data();
        const BumpTarget target{
            BumpResult::codes, format_.normals,
            [&](int row) { return codes + static_cast<std::size_t>(row - first) * 3 * width(); }};
        if (!make_bump_rows(source_.heights, options_, target, first, last)) return false;
        if (is_plain) return true;
        const std::size_t row_size = width() * static_cast<std::size_t>(shape_.channels);
        for (int row = first; row < last; ++row) {
            const auto index = static_cast<std::size_t>(row - first);
            convert_row(row, codes + index * 3 * width(), samples + index * row_size, report);
        }
        return true;
    }

    /// Converts three codes per texel to the samples of the file.
    template <typename Sample>
    void convert_row(int row, Sample* codes, Sample* samples, Report& report) const {
        if (source_.transparent) flatten(source_.transparent(row), codes);
        const auto channels = static_cast<std::size_t>(shape_.channels);
        for (std::size_t x = 0; x < width(); ++x) {
            Sample* const texel = samples + x * channels;
            texel[0] = codes[3 * x];
            texel[1] = codes[3 * x + 1];
            texel[2] = format_.xy_only ? Sample{} : codes[3 * x + 2];
        }
        if (format_.alpha == MapAlpha::height) add_height(row, samples, report);
        if (format_.alpha == MapAlpha::keep) add_alpha(row, samples, report);
    }

    template <typename Sample>
    void flatten(const std::uint8_t* transparent, Sample* codes) const {
        const NormalCoding<Sample> coding{format_.normals.flat};
        const Sample zero = coding.encoded(0.0);
        const Sample one = coding.encoded(1.0);
        for (std::size_t x = 0; x < width(); ++x) {
            if (transparent[x] == 0) continue;
            codes[3 * x] = codes[3 * x + 1] = zero;
            codes[3 * x + 2] = one;
        }
    }

    template <typename Sample>
    void add_height(int row, Sample* samples, Report& report) const {
        const void* const heights = source_.heights.row(row);
        UnitCoding<Sample> coded("height outside 0 to 1", report);
        for (std::size_t x = 0; x < width(); ++x) {
            const double height = value_at(heights, source_.heights.bits, x);
            const double kept = options_.strength < 0.0 ? 1.0 - height : height;
            samples[4 * x + 3] = coded(kept, static_cast<std::size_t>(row) * width() + x);
        }
    }

    template <typename Sample>
    void add_alpha(int row, Sample* samples, Report& report) const {
        const void* const alpha = source_.alpha ? source_.alpha(row) : nullptr;
        UnitCoding<Sample> coded("alpha outside 0 to 1", report);
        for (std::size_t x = 0; x < width(); ++x) {
            const double value = alpha ? value_at(alpha, source_.alpha_bits, x) : 1.0;
            samples[4 * x + 3] = coded(value, static_cast<std::size_t>(row) * width() + x);
        }
    }

    bool make_moments(int first, int last, float* samples) const {
        const std::size_t row_size = 2 * width();
        std::vector<float> slopes(row_size * static_cast<std::size_t>(last - first));
        const BumpTarget target{BumpResult::slopes, {}, [&](int row) {
                                    return slopes.data() +
                                           static_cast<std::size_t>(row - first) * row_size;
                                }};
        if (!make_bump_rows(source_.heights, options_, target, first, last)) return false;
        const float green = format_.normals.green == Green::up ? 1.0F : -1.0F;
        for (int row = first; row < last; ++row) {
            const void* const heights = source_.heights.row(row);
            const std::uint8_t* const transparent =
                source_.transparent ? source_.transparent(row) : nullptr;
            const float* const slope = static_cast<const float*>(target.row(row));
            for (std::size_t x = 0; x < width(); ++x, samples += 6) {
                const bool is_flat = transparent && transparent[x] != 0;
                const double height = value_at(heights, source_.heights.bits, x);
                const float dx = is_flat ? 0.0F : slope[2 * x];
                const float dy = is_flat ? 0.0F : slope[2 * x + 1] * green;
                samples[0] = static_cast<float>(height * options_.strength);
                samples[1] = dx;
                samples[2] = dy;
                samples[3] = dx * dx;
                samples[4] = dy * dy;
                samples[5] = dx * dy;
            }
        }
        return true;
    }

    const BumpBandSource& source_;
    const BumpOptions& options_;
    const BumpFileFormat& format_;
    ImageShape shape_;
};

}  // namespace

ImageShape detail::shape_of(const BumpFileFormat& format, int width, int height) {
    if (format.content == BumpContent::slope_moments)
        return {width,
                height,
                6,
                32,
                ColorSpace::data,
                {"b0_h", "b1_dhds", "b2_dhdt", "b3_dhds2", "b4_dhdt2", "b5_dh2dsdt"}};
    const int channels = format.alpha == MapAlpha::none ? 3 : 4;
    return {width, height, channels, format.normals.bits, ColorSpace::data, {}};
}

bool detail::make_bump_band(const BumpBandSource& source, const BumpOptions& options,
                            const BumpFileFormat& format, int first, int last,
                            std::span<std::byte> rows, Report& report) {
    const BandMaker maker(source, options, format);
    const auto count = static_cast<std::size_t>(last - first);
    const std::size_t row_bytes = rows.size() / count;
    const std::size_t grain = std::max<std::size_t>(
        1, bump_texels_per_piece / static_cast<std::size_t>(source.heights.width));
    std::atomic<bool> finite = true;
    Report band_report;
    parallel_for_reporting(
        count, grain, band_report, [&](std::size_t begin, std::size_t end, Report& piece_report) {
            if (!maker.make(first + static_cast<int>(begin), first + static_cast<int>(end),
                            rows.data() + begin * row_bytes, piece_report))
                finite = false;
        });
    if (finite) report.merge(band_report);
    return finite;
}

namespace {

double milliseconds_of(const std::function<void()>& work) {
    return 1e3 * seconds_of(work);
}

int radius_of(const BumpOptions& options) {
    return gradient_kernel(*options.kernel, options.gaussian_radius).radius;
}

const void* row_of(const Image& image, int row) {
    const auto offset = static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width);
    return std::visit(
        [offset](const auto& samples) { return static_cast<const void*>(&samples[offset]); },
        image.samples);
}

/// The source of the rows of heights.
class BandSource {
  public:
    virtual ~BandSource() = default;
    /// Returns the input of make_bump_band() for rows [first, last).
    virtual const BumpBandSource& band(int first, int last) = 0;
    /// Reads rows that the band after `last` needs and that are not in memory. Called while a band
    /// is written.
    virtual void read_ahead(int last) = 0;
    /// Called once, if a height of rows [first, last) or around them is not finite.
    virtual void fill_holes(int first, int last, Report& report) = 0;
};

class MemorySource final : public BandSource {
  public:
    MemorySource(const HeightMap& map, const BumpOptions& options, Report& report)
        : map_(map), options_(options), heights_(&map.heights) {
        if (!map.transparent.empty()) fill(report);
        const std::size_t width = static_cast<std::size_t>(map.heights.width);
        source_.heights = {map.heights.width, map.heights.height, heights_->bits(),
                           [this](int row) { return row_of(*heights_, row); }};
        if (!map.alpha.empty()) {
            source_.alpha = [&map](int row) { return row_of(map.alpha, row); };
            source_.alpha_bits = map.alpha.bits();
        }
        if (!map.transparent.empty()) {
            source_.transparent = [&map, width](int row) {
                return map.transparent.data() + static_cast<std::size_t>(row) * width;
            };
        }
    }
    const BumpBandSource& band(int, int) override { return source_; }
    void read_ahead(int) override {}
    void fill_holes(int, int, Report& report) override { fill(report); }

  private:
    void fill(Report& report) {
        Image floats = to_float(map_.heights);
        floats.samples =
            filled_holes(floats, *options_.wrap, report, {map_.transparent, radius_of(options_)});
        whole_ = std::move(floats);
        heights_ = &whole_;
        source_.heights.bits = 32;
    }

    const HeightMap& map_;
    const BumpOptions& options_;
    const Image* heights_;
    Image whole_;
    BumpBandSource source_;
};

class FileSource final : public BandSource {
  public:
    FileSource(const HeightMapFile& file, const BumpOptions& options)
        : file_(file), window_(file, radius_of(options), *options.wrap) {
        const ImageInfo& info = file.info();
        source_.heights = {info.width, info.height, 32,
                           [this](int row) { return window_.row(row); }};
    }
    const BumpBandSource& band(int first, int last) override {
        window_.move_to(first, last);
        source_.heights.bits = window_.bits();
        if (window_.has_alpha()) {
            source_.alpha = [this](int row) { return window_.alpha_row(row); };
            source_.alpha_bits = window_.alpha_bits();
        }
        return source_;
    }
    void read_ahead(int last) override { window_.read_ahead(last); }
    void fill_holes(int first, int last, Report&) override {
        throw FileError(file_.path(),
                        fmt::format("rows {} to {} hold heights that are not finite, which are "
                                    "filled only in maps that fit into {} MiB",
                                    first, last - 1, file_.choice().max_memory >> 20));
    }

  private:
    const HeightMapFile& file_;
    HeightWindow window_;
    BumpBandSource source_;
};

void make_band(BandSource& source, const BumpOptions& options, const BumpFileFormat& format,
               int first, int last, std::span<std::byte> rows, Report& report) {
    if (make_bump_band(source.band(first, last), options, format, first, last, rows, report))
        return;
    source.fill_holes(first, last, report);
    make_bump_band(source.band(first, last), options, format, first, last, rows, report);
}

std::map<std::string, std::string> metadata_of(const BumpFileFormat& format) {
    std::map<std::string, std::string> metadata = format.metadata;
    MapDescription description = read_description(normal_map_metadata(format.normals));
    if (format.content == BumpContent::slope_moments) {
        description.kind = MapKind::slope_moments;
        description.flat.reset();
    }
    description.xy_only = format.xy_only;
    if (format.alpha == MapAlpha::height) description.alpha = AlphaContent::height;
    metadata.merge(write_description(description, format.normals.bits));
    return metadata;
}

void check(const BumpFileFormat& format) {
    if (format.content == BumpContent::normals) return;
    if (format.xy_only || format.alpha != MapAlpha::none)
        throw InvalidInput("slope moments have neither z nor alpha");
}

/// Like resolve_options(), for a map that may be too large for memory.
BumpOptions settled(const HeightMapFile& source, BumpOptions options) {
    if (options.kernel && options.wrap) return options;
    std::vector<ImagePart> parts;
    if (!options.kernel) parts = parts_to_analyze(source.info().width, source.info().height);
    const HeightMapFile::Survey survey = source.survey(parts);
    if (!options.wrap) options.wrap = survey.tiling.wraps();
    if (!options.kernel) {
        const KernelChoice choice = choose_kernel(survey.parts, options);
        options.kernel = choice.kernel;
        options.gaussian_radius = choice.gaussian_radius;
    }
    return options;
}

/// Computes and writes all bands. \return the times without opening and finishing the files
BumpFileTimes write_bands(BandSource& bands, const HeightMapFile& source,
                          const BumpOptions& options, const BumpFileFormat& format,
                          ImageRowWriter& writer, Report& report,
                          const std::function<void(double)>& progress) {
    BumpFileTimes times;
    const int height = source.info().height;
    const int band_rows = source.rows_per_band();
    std::vector<std::byte> rows(writer.row_bytes() * static_cast<std::size_t>(band_rows));
    for (int first = 0; first < height; first += band_rows) {
        const int last = std::min(first + band_rows, height);
        const std::span<std::byte> band =
            std::span(rows).first(writer.row_bytes() * static_cast<std::size_t>(last - first));
        times.convert +=
            milliseconds_of([&] { make_band(bands, options, format, first, last, band, report); });
        const auto write = [&] { times.write += milliseconds_of([&] { writer.write(band); }); };
        const auto read_ahead = [&] {
            times.read +=
                milliseconds_of([&] { bands.read_ahead(std::min(last + band_rows, height)); });
        };
        parallel_tasks({write, read_ahead}, false);
        if (progress) progress(static_cast<double>(last) / height);
    }
    return times;
}

}  // namespace

BumpFileTimes write_bump_file(const HeightMapFile& source, const BumpOptions& given,
                              const std::filesystem::path& file, const BumpFileFormat& format,
                              Report& report, const std::function<void(double)>& progress) {
    check(format);
    check_bump(given);
    const BumpOptions options = settled(source, given);
    const ImageInfo& info = source.info();
    ImageRowWriter writer(file, shape_of(format, info.width, info.height), metadata_of(format),
                          format.write);
    std::unique_ptr<BandSource> bands;
    const double opening = milliseconds_of([&] {
        if (source.is_streamed())
            bands = std::make_unique<FileSource>(source, options);
        else
            bands = std::make_unique<MemorySource>(source.map(), options, report);
    });
    BumpFileTimes times = write_bands(*bands, source, options, format, writer, report, progress);
    times.read += opening;
    times.write += milliseconds_of([&] { writer.finish(report); });
    return times;
}

}  // namespace relief
