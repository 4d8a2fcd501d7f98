// SPDX-License-Identifier: Apache-2.0
// A height map in memory, or its file in hand; what is asked about either is answered from rows in
// order. Tests: tests/mesh/io/maps/bump_file_test.cpp.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "image/heights/height_holes.h"
#include "image/heights/seam_survey.h"
#include "io/maps/height_window.h"
#include "relief/mesh/bump_file.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

/// Of the file's samples, and of heights made of colours.
std::size_t bytes_in_memory(const ImageInfo& info) {
    const std::size_t texels =
        static_cast<std::size_t>(info.width) * static_cast<std::size_t>(info.height);
    const auto channels = static_cast<std::size_t>(info.channels);
    const std::size_t heights = info.channels == 1 ? 0 : texels * sizeof(float);
    return texels * channels * static_cast<std::size_t>(info.bits / 8) + heights;
}

/// Takes parts of a map out of bands of its rows.
class PartCollector {
  public:
    PartCollector(std::span<const ImagePart> parts, int bits) : places_(parts) {
        for (const ImagePart& part : parts)
            parts_.push_back(make_image(part.width, part.height, 1, bits, ColorSpace::data));
    }

    /// \param first  the row of the map that the band begins with
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

/// The map in float, with NaN for what a transparent texel hides.
Image without_hidden(const HeightMap& map) {
    Image floats = to_float(map.heights);
    const std::span<float> heights = floats.as<float>();
    for (std::size_t texel = 0; texel < heights.size(); ++texel) {
        if (map.transparent[texel] != 0) heights[texel] = std::numeric_limits<float>::quiet_NaN();
    }
    return floats;
}

/// Puts what the surface beside suggests in the place of hidden heights, rounded as those of the
/// file are: the bits that the map uses stay what they are. Heights beside alpha are floats.
void fill_hidden(const Image& transparent, int file_bits, Image& part) {
    constexpr int reach = 128;  // As wide as parts that a kernel is chosen by.
    const double largest = std::exp2(file_bits) - 1.0;
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

/// What a map in memory shows, whatever colours its transparent texels hide.
HeightMapFile::Survey survey_of(const HeightMap& map, int file_bits,
                                std::span<const ImagePart> places) {
    HeightMapFile::Survey survey;
    survey.colored_share = map.colored_share;
    survey.partial_alpha_share = map.partial_alpha_share;
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

HeightMapFile::HeightMapFile(const std::filesystem::path& file, const HeightMapChoice& choice)
    : path_(file), choice_(choice) {
    info_ = read_image_info(file);
    is_streamed_ = bytes_in_memory(info_) > choice.most_memory;
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
        survey.colored_share += share * band.colored_share;
        survey.partial_alpha_share += share * band.partial_alpha_share;
    }
    survey.tiling = seams.tiling();
    survey.parts = std::move(collector).parts();
    return survey;
}

}  // namespace relief
