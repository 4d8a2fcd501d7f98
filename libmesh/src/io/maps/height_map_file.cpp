// SPDX-License-Identifier: Apache-2.0
// Height maps of files: in memory, or read by bands of rows.
//
// A window of rows moves over a file: rows are stored consecutively and moved to the front. The
// last rows of a map that repeats are read first, by a separate reader.
#include "io/maps/height_bands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "image/height_holes.h"
#include "image/seam_survey.h"
#include "relief/mesh/bump_file.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

int whole_height(const HeightMapFile& file) {
    return file.info().height;
}

/// Returns the last rows of a map.
HeightMap last_rows(const HeightMapFile& file, int count) {
    HeightBandReader reader(file);
    reader.skip(whole_height(file) - count);
    return reader.read(count);
}

}  // namespace

HeightBandReader::HeightBandReader(const HeightMapFile& file) : file_(file), reader_(file.path()) {}

HeightMap HeightBandReader::read(int rows) {
    const ImageInfo& info = reader_.info();
    const int first = reader_.next_row();
    const int count = std::min(rows, info.height - first);
    Image band = make_image(info.width, count, info.channels, info.bits, ColorSpace::data);
    std::visit([&](auto& samples) { reader_.read(std::as_writable_bytes(std::span(samples))); },
               band.samples);
    HeightMap map = height_map(std::move(band), file_.choice().channel);
    if (file_.choice().ignore_alpha) map.transparent.clear();
    const auto hole = std::find(map.transparent.begin(), map.transparent.end(), 1);
    if (hole != map.transparent.end()) {
        const auto texel = hole - map.transparent.begin();
        throw FileError(
            file_.path(),
            fmt::format(
                "the texel in column {}, row {} is transparent, which is understood only in "
                "maps that fit into {} MiB",
                texel % info.width, first + texel / info.width, file_.choice().max_memory >> 20));
    }
    return map;
}

void KeptRows::append(const Image& rows) {
    bits_ = rows.bits();
    row_bytes_ =
        static_cast<std::size_t>(rows.width) * static_cast<std::size_t>(rows.channels * bits_ / 8);
    std::visit(
        [&](const auto& samples) {
            const auto bytes = std::as_bytes(std::span(samples));
            bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
        },
        rows.samples);
}

void KeptRows::append_row(const KeptRows& other, int index) {
    bits_ = other.bits_;
    row_bytes_ = other.row_bytes_;
    const auto* const row = static_cast<const std::byte*>(other.at(index));
    bytes_.insert(bytes_.end(), row, row + row_bytes_);
}

void KeptRows::drop(int count) {
    bytes_.erase(
        bytes_.begin(),
        bytes_.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(count) * row_bytes_));
}

int KeptRows::count() const {
    return static_cast<int>(bytes_.size() / row_bytes_);
}

const void* KeptRows::at(int index) const {
    return bytes_.data() + static_cast<std::size_t>(index) * row_bytes_;
}

HeightWindow::HeightWindow(const HeightMapFile& file, int radius, const Wraps& wrap)
    : reader_(file), height_(whole_height(file)), radius_(radius) {
    if (wrap.y != Wrap::repeat) return;
    const int count = std::min(radius, height_);
    tail_.append(last_rows(file, count).heights);
    head_.append(HeightBandReader(file).read(count).heights);
}

int HeightWindow::needed_end(int last) const {
    return std::min(last + radius_, height_);
}

void HeightWindow::append(const HeightMap& rows) {
    heights_.append(rows.heights);
    if (!rows.alpha.empty()) alpha_.append(rows.alpha);
}

void HeightWindow::read_ahead(int last) {
    const int end = begin_ + heights_.count();
    ahead_ = end < needed_end(last) ? reader_.read(needed_end(last) - end) : HeightMap{};
}

void HeightWindow::move_to(int first, int last) {
    const int dropped_rows = std::max(first - radius_ - begin_, 0);
    heights_.drop(dropped_rows);
    if (has_alpha()) alpha_.drop(dropped_rows);
    begin_ += dropped_rows;
    if (!ahead_.heights.empty()) append(ahead_);
    ahead_ = {};
    read_ahead(last);
    if (!ahead_.heights.empty()) append(ahead_);
    ahead_ = {};
}

const void* HeightWindow::row(int place) const {
    if (place >= begin_ && place < begin_ + heights_.count()) return heights_.at(place - begin_);
    if (place < head_.count()) return head_.at(place);
    return tail_.at(place - (height_ - tail_.count()));
}

namespace {

/// Bytes of the file's samples, and of heights that are computed from colors.
std::size_t bytes_in_memory(const ImageInfo& info) {
    const std::size_t texels =
        static_cast<std::size_t>(info.width) * static_cast<std::size_t>(info.height);
    const auto channels = static_cast<std::size_t>(info.channels);
    const std::size_t heights = info.channels == 1 ? 0 : texels * sizeof(float);
    return texels * channels * static_cast<std::size_t>(info.bits / 8) + heights;
}

/// Copies parts of a map from bands of its rows.
class PartCollector {
  public:
    PartCollector(std::span<const ImagePart> parts, int bits) : places_(parts) {
        for (const ImagePart& part : parts)
            parts_.push_back(make_image(part.width, part.height, 1, bits, ColorSpace::data));
    }

    /// \param first  the row of the map at which the band begins
    void add(const Image& band, int first) {
        for (std::size_t i = 0; i < places_.size(); ++i) {
            const ImagePart& place = places_[i];
            const int begin = std::max(place.y, first);
            const int end = std::min(place.y + place.height, first + band.height);
            if (begin >= end) continue;
            const Image rows = part_of(band, {place.x, begin - first, place.width, end - begin});
            copy_rows(rows, begin - place.y, parts_[i]);
        }
    }
    [[nodiscard]] std::vector<Image> parts() && { return std::move(parts_); }

  private:
    static void copy_rows(const Image& rows, int first, Image& to) {
        std::visit(
            [&]<typename Sample>(std::vector<Sample>& samples) {
                const std::span<const Sample> from = rows.as<Sample>();
                std::copy(from.begin(), from.end(),
                          samples.begin() + static_cast<std::ptrdiff_t>(first) * rows.width);
            },
            to.samples);
    }

    std::span<const ImagePart> places_;
    std::vector<Image> parts_;
};

void add_rows(SeamSurvey& survey, const Image& band) {
    std::visit(
        [&]<typename Sample>(const std::vector<Sample>& samples) {
            const auto width = static_cast<std::size_t>(band.width);
            const std::span<const Sample> all(samples);
            for (std::size_t row = 0; row < static_cast<std::size_t>(band.height); ++row)
                survey.add_row(all.subspan(row * width, width));
        },
        band.samples);
}

/// Returns the map in float, with NaN for transparent texels.
Image without_hidden(const HeightMap& map) {
    Image floats = to_float(map.heights);
    const std::span<float> heights = floats.as<float>();
    for (std::size_t texel = 0; texel < heights.size(); ++texel) {
        if (map.transparent[texel] != 0) heights[texel] = std::numeric_limits<float>::quiet_NaN();
    }
    return floats;
}

/// Replaces heights of transparent texels by values that continue the surface, rounded like the
/// file's heights so that the number of used bits does not change. Heights beside alpha are floats.
void fill_hidden(const Image& transparent, int file_bits, Image& part) {
    constexpr int reach = 128;  // The size of the parts from which a kernel is chosen.
    const double largest = std::ldexp(1.0, file_bits) - 1.0;
    const std::span<const std::uint8_t> hidden = transparent.as<std::uint8_t>();
    Report ignored;  // The conversion counts holes.
    const std::vector<float> filled = filled_holes(part, Wrap::clamp, ignored, {hidden, reach});
    const std::span<float> heights = part.as<float>();
    for (std::size_t texel = 0; texel < heights.size(); ++texel) {
        if (hidden[texel] == 0) continue;
        const auto height = static_cast<double>(filled[texel]);
        heights[texel] = file_bits == 32
                             ? filled[texel]
                             : static_cast<float>(std::round(height * largest) / largest);
    }
}

/// Analyzes a map in memory; the colors of transparent texels are ignored.
HeightMapFile::Survey survey_of(const HeightMap& map, int file_bits,
                                std::span<const ImagePart> places) {
    HeightMapFile::Survey survey;
    survey.colored_fraction = map.colored_fraction;
    survey.partial_alpha_fraction = map.partial_alpha_fraction;
    for (const ImagePart& place : places)
        survey.parts.push_back(part_of(map.heights, place));
    if (map.transparent.empty()) {
        survey.tiling = detect_tiling(map.heights);
        return survey;
    }
    survey.tiling = detect_tiling(without_hidden(map));
    const Image transparent{map.heights.width, map.heights.height, 1, ColorSpace::data,
                            map.transparent};
    for (std::size_t i = 0; i < places.size(); ++i)
        fill_hidden(part_of(transparent, places[i]), file_bits, survey.parts[i]);
    return survey;
}

}  // namespace

HeightMapFile::HeightMapFile(const std::filesystem::path& file, const HeightMapOptions& choice)
    : path_(file), choice_(choice) {
    info_ = read_image_info(file);
    is_streamed_ = bytes_in_memory(info_) > choice.max_memory;
    if (is_streamed_) return;
    map_ = height_map(read_image(file, ImageUse::data), choice.channel);
    if (choice.ignore_alpha) map_.transparent.clear();
}

int HeightMapFile::rows_per_band() const {
    const std::size_t rows = choice_.texels_per_band / static_cast<std::size_t>(info_.width);
    return static_cast<int>(
        std::clamp<std::size_t>(rows, 1, static_cast<std::size_t>(info_.height)));
}

HeightMapFile::Survey HeightMapFile::survey(std::span<const ImagePart> parts) const {
    if (!is_streamed_) return survey_of(map_, info_.bits, parts);
    Survey survey;
    SeamSurvey seams(info_.width, info_.height);
    PartCollector collector(parts, info_.channels == 1 ? info_.bits : 32);
    HeightBandReader reader(*this);
    const int band_rows = rows_per_band();
    for (int first = 0; first < info_.height; first += band_rows) {
        const HeightMap band = reader.read(band_rows);
        add_rows(seams, band.heights);
        collector.add(band.heights, first);
        const double share = static_cast<double>(band.heights.height) / info_.height;
        survey.colored_fraction += share * band.colored_fraction;
        survey.partial_alpha_fraction += share * band.partial_alpha_fraction;
    }
    survey.tiling = seams.tiling();
    survey.parts = std::move(collector).parts();
    return survey;
}

}  // namespace relief
