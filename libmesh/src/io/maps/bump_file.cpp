// SPDX-License-Identifier: Apache-2.0
// Bands of some million texels: made on all threads, then handed to the writer, while the rows of
// the next are read. A map in memory is its own source of rows; holes in it are filled when the
// first is met, and everything before did not depend on any.
// Tests: tests/mesh/io/maps/bump_file_test.cpp.
#include "relief/mesh/bump_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "image/heights/height_holes.h"
#include "io/maps/bump_bands.h"
#include "io/maps/height_window.h"
#include "parallel.h"
#include "relief/mesh/error.h"
#include "relief/mesh/kernel_choice.h"
#include "relief/mesh/timing.h"

namespace relief {
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

/// Where the rows of heights come from.
class BandSource {
  public:
    virtual ~BandSource() = default;
    /// What make_bump_band() needs for rows [first, last).
    virtual const BumpBandSource& band(int first, int last) = 0;
    /// Reads what the band behind `last` will need, if it is not in memory. Called meanwhile.
    virtual void read_ahead(int last) = 0;
    /// Called once, where a height of rows [first, last) or around them is not finite.
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
                                    first, last - 1, file_.choice().most_memory >> 20));
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
    if (format.content == BumpContent::slope_moments) {
        metadata["relief:content"] = "slope moments";
        metadata["relief:green"] = format.normals.green == Green::up ? "up" : "down";
        return metadata;
    }
    metadata.merge(normal_map_metadata(format.normals));
    if (format.xy_only) metadata["relief:channels"] = "xy";
    if (format.alpha == MapAlpha::height) metadata["relief:alpha"] = "height";
    return metadata;
}

void check(const BumpFileFormat& format) {
    if (format.content == BumpContent::normals) return;
    if (format.xy_only || format.alpha != MapAlpha::none)
        throw InvalidInput("slope moments have neither z nor alpha");
}

/// As settled_options(), of a map that may be too large for memory.
BumpOptions settled(const HeightMapFile& source, BumpOptions options) {
    if (options.kernel && options.wrap) return options;
    std::vector<ImagePart> parts;
    if (!options.kernel) parts = parts_to_look_at(source.info().width, source.info().height);
    const HeightMapFile::Survey survey = source.survey(parts);
    if (!options.wrap) options.wrap = survey.tiling.wraps();
    if (!options.kernel) {
        const KernelChoice choice = choose_kernel(survey.parts, options);
        options.kernel = choice.kernel;
        options.gaussian_radius = choice.gaussian_radius;
    }
    return options;
}

/// Makes all bands and hands them to the writer. \return without the time to open and to finish
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
